// SPDX-License-Identifier: MIT
// <extra>s of Maya, 3ds Max and Blender: how a texture repeats, both sides, normal maps.
#include "test_collada.h"

#include "base/file.h"
#include "formats/collada/collada_scene.h"
#include "formats/images/images.h"

#include <alpenglow/geometry.h>

#include <stdio.h>
#include <string.h>

/// A triangle with coordinates; more text in <texture>, <technique>, <effect> and <geometry>.
typedef struct extras {
    const char *texture, *technique, *effect, *geometry;
} extras;

static alp_scene *read_with(alp_context *context, extras more)
{
    static char inside[8192];
    alp_scene *scene = NULL;
    snprintf(
        inside, sizeof inside,
        "<library_images><image id='i'><init_from>i.png</init_from></image><image id='b'>"
        "<init_from>b.png</init_from></image></library_images><library_effects><effect id='e'>"
        "<profile_COMMON><technique sid='t'><lambert><diffuse><texture texture='i' texcoord='C'>"
        "%s</texture></diffuse></lambert>%s</technique></profile_COMMON>%s</effect>"
        "</library_effects><library_materials><material id='m'><instance_effect url='#e'/>"
        "</material></library_materials><library_geometries><geometry id='g'><mesh><source id='p'>"
        "<float_array id='pa'>0 0 0 1 0 0 1 1 0</float_array><technique_common><accessor "
        "source='#pa' count='3' stride='3'/></technique_common></source><source id='u'>"
        "<float_array id='ua'>0 0 1 0 1 0.25</float_array><technique_common><accessor "
        "source='#ua' count='3' stride='2'/></technique_common></source><vertices id='v'><input "
        "semantic='POSITION' source='#p'/></vertices><triangles material='m' count='1'><input "
        "semantic='VERTEX' source='#v' offset='0'/><input semantic='TEXCOORD' source='#u' "
        "offset='0'/><p>0 1 2</p></triangles></mesh>%s</geometry></library_geometries>"
        "<library_visual_scenes><visual_scene id='s'><node><instance_geometry url='#g'/></node>"
        "</visual_scene></library_visual_scenes>" TEST_COLLADA_SCENE,
        more.texture, more.technique, more.effect, more.geometry);
    ASSERT_OK(context, test_collada_scene(context, inside, &scene));
    assert_int_equal(scene->material_count, 1);
    return scene;
}

#define EXTRA(text) "<extra><technique profile='MAYA'>" text "</technique></extra>"

/// As three.js: u' = repeat u + offset, both from the bottom left.
TEST_WITH_CONTEXT(repeats, 1)
{
    alp_scene *scene =
        read_with(context, (extras){EXTRA("<wrapU sid='w'>TRUE</wrapU><wrapV>0</wrapV><repeatU>2"
                                          "</repeatU><repeatV>3</repeatV><offsetU>0.5</offsetU>"
                                          "<offsetV> 0.1 </offsetV>"),
                                    "", "", ""});
    const alpi_texture *texture = &scene->materials[0].base_color_texture;
    const vec2 at = alpi_texture_transform(texture, (vec2){0.25f, 0.75f}); // 1/4 from the bottom
    ASSERT_NEAR(at.x, 1.0, 1e-6);
    ASSERT_NEAR(1.0 - (double)at.y, 3.0 * 0.25 + 0.1, 1e-6);
    assert_int_equal(texture->wrap_u, ALPI_WRAP_REPEAT);
    assert_int_equal(texture->wrap_v, ALPI_WRAP_CLAMP);
    alp_scene_destroy(scene);
    scene = read_with(context, (extras){EXTRA("<repeatU>4</repeatU><mirrorV>true</mirrorV>"
                                              "<repeatV>nonsense</repeatV>"),
                                        "", "", ""});
    texture = &scene->materials[0].base_color_texture;
    ASSERT_NEAR(texture->scale[0], 4.0, 0.0);
    ASSERT_NEAR(texture->scale[1], 1.0, 0.0);
    ASSERT_NEAR(texture->offset[1], 0.0, 0.0);
    assert_int_equal(texture->wrap_u, ALPI_WRAP_REPEAT); // nothing says otherwise
    assert_int_equal(texture->wrap_v, ALPI_WRAP_MIRROR);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(both_sides, 1)
{
    static const struct {
        extras more;
        bool both;
    } cases[] = {
        {{"", "", "", ""}, false},
        {{"", "", "", EXTRA("<double_sided>1</double_sided>")}, true},
        {{"", "", "", EXTRA("<double_sided>0</double_sided>")}, false},
        {{"", "", EXTRA("<double_sided> TRUE</double_sided>"), ""}, true},
        {{"", EXTRA("<shadow>1</shadow>") EXTRA("<double_sided>1</double_sided>"), "", ""}, true},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_scene *scene = read_with(context, cases[i].more);
        assert_int_equal(scene->materials[0].double_sided, cases[i].both);
        alp_scene_destroy(scene);
    }
}

/// One material of two geometries, of which one is double-sided, is two.
TEST_WITH_CONTEXT(sides_of_geometries, 1)
{
    static const char geometry[] =
        "<geometry id='%s'><mesh><source id='p%s'><float_array id='a%s'>0 0 0 1 0 0 1 1 0"
        "</float_array><technique_common><accessor source='#a%s' count='3' stride='3'/>"
        "</technique_common></source><vertices id='v%s'><input semantic='POSITION' source='#p%s'/>"
        "</vertices><triangles material='m' count='1'><input semantic='VERTEX' source='#v%s' "
        "offset='0'/><p>0 1 2</p></triangles></mesh>%s</geometry>";
    char inside[4096], first[1024], second[1024];
    alp_scene *scene = NULL;
    snprintf(first, sizeof first, geometry, "g", "g", "g", "g", "g", "g", "g", "");
    snprintf(second, sizeof second, geometry, "h", "h", "h", "h", "h", "h", "h",
             EXTRA("<double_sided>1</double_sided>"));
    snprintf(inside, sizeof inside,
             "<library_effects><effect id='e'><profile_COMMON><technique sid='t'><lambert/>"
             "</technique></profile_COMMON></effect></library_effects><library_materials>"
             "<material id='m'><instance_effect url='#e'/></material></library_materials>"
             "<library_geometries>%s%s</library_geometries><library_visual_scenes><visual_scene "
             "id='s'><node><instance_geometry url='#g'/><instance_geometry url='#h'/>"
             "<instance_geometry url='#g'/></node></visual_scene></library_visual_scenes>"
             "%s",
             first, second, TEST_COLLADA_SCENE);
    ASSERT_OK(context, test_collada_scene(context, inside, &scene));
    assert_int_equal(scene->material_count, 2);
    assert_false(alpi_surface_is_double_sided(scene, 0));
    assert_true(alpi_surface_is_double_sided(scene, 1));
    assert_int_equal(scene->surfaces[2].material, scene->surfaces[0].material);
    alp_scene_destroy(scene);
}

#define BUMP(attribute)                                                                            \
    "<extra><technique profile='FCOLLADA'><bump" attribute                                         \
    "><texture texture='b' texcoord='C'/></bump></technique></extra>"

/// Normal maps as Blender and three.js have them; heights are none.
TEST_WITH_CONTEXT(normal_maps, 1)
{
    static const char *const normals[] = {BUMP(""), BUMP(" bumptype='NORMALMAP'")};
    for (size_t i = 0; i < sizeof normals / sizeof *normals; i++) {
        alp_scene *scene = read_with(context, (extras){"", normals[i], "", ""});
        const uint32_t image = scene->materials[0].normal_texture.image;
        assert_int_not_equal(image, ALPI_NONE);
        assert_int_not_equal(image, scene->materials[0].base_color_texture.image);
        test_log_clear();
        ASSERT_OK(context, alp_scene_load_normal_maps(scene)); // it is not there: a warning
        assert_int_equal(test_log_has("image"), 1);
        assert_non_null(strstr(test_log_text(), "b.png"));
        alp_scene_destroy(scene);
    }
    alp_scene *scene = read_with(context, (extras){"", BUMP(" bumptype='HEIGHTFIELD'"), "", ""});
    assert_int_equal(scene->materials[0].normal_texture.image, ALPI_NONE);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(reported_files, 1)
{
    if (test_shared("scenes/reports") == NULL) {
        skip();
    }
    alp_scene *scene = test_load(context, test_shared("scenes/reports/dae_ds_geo.dae"));
    assert_true(alpi_surface_is_double_sided(scene, 0));
    alp_scene_destroy(scene);
    scene = test_load(context, test_shared("scenes/reports/dae_maya_repeat.dae"));
    const alpi_texture *texture = &scene->materials[0].base_color_texture;
    ASSERT_NEAR(texture->scale[0], 2.0, 0.0);
    ASSERT_NEAR(texture->scale[1], 2.0, 0.0);
    alp_scene_destroy(scene);
}
