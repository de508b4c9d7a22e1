// SPDX-License-Identifier: MIT
// <extra>s of Maya, 3ds Max and Blender: how a texture repeats, both sides, normal maps.
#include "test_collada.h"

#include "base/file.h"
#include "base/memory.h"
#include "formats/formats.h"

#include <alpenglow/alpenglow.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// A triangle with coordinates; more text in <texture>, <technique>, <effect> and <geometry>.
typedef struct extras {
    const char *texture, *technique, *effect, *geometry;
} extras;

static const char *inside_with(extras more)
{
    static char inside[8192];
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
    return inside;
}

static alp_scene *read_with(alp_context *context, extras more)
{
    alp_scene *scene = NULL;
    ASSERT_OK(context, test_collada_scene(context, inside_with(more), &scene));
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
        {{"", "", "", "<extra/>" EXTRA("<double_sided>true</double_sided>")}, true},
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

// --- into other formats --------------------------------------------------------------------------

#define GLOSS                                                                                      \
    "<library_effects><effect id='e'><profile_COMMON><technique sid='t'><phong><diffuse><color>1 " \
    "0 0 1</color></diffuse><specular><color>0.5 0.25 0 1</color></specular><shininess><float>6"   \
    "</float></shininess><reflective><color>1 1 1 1</color></reflective></phong>" BUMP(            \
        " bumptype='HEIGHTFIELD'") "</technique></profile_COMMON></effect></library_effects>"      \
                                   "<library_materials><material id='m'><instance_effect "         \
                                   "url='#e'/></material></library_materials>"                     \
                                   "<library_animations><animation/></library_animations>"

/// Text of the scene's file in a format, with a map on its triangle; released with alpi_release.
static char *write_and_read(const alp_scene *scene, const char *folder, const char *name,
                            const char *read)
{
    static const float uvs[1][3][2] = {{{0.1f, 0.1f}, {0.9f, 0.1f}, {0.9f, 0.9f}}};
    static const uint8_t *const pngs[] = {(const uint8_t *)"x"};
    static const size_t sizes[] = {1};
    const alpi_mesh_patch patch = {
        .page_count = 1, .corner_uvs = uvs, .page_pngs = pngs, .page_png_sizes = sizes};
    uint8_t *bytes = NULL;
    size_t size = 0;
    ASSERT_OK(scene->context,
              alpi_scene_write_patched(scene, &patch, test_path(folder, name), true));
    ASSERT_OK(scene->context,
              alpi_file_read(scene->context, test_path(folder, read), 1 << 20, &bytes, &size));
    return (char *)bytes; // a zero byte is behind them
}

/// Gloss goes where the format has a place; each kind that has none is told once. A document of
/// its own format keeps all.
TEST_WITH_CONTEXT(conversions, 1)
{
    alp_scene *scene = NULL;
    ASSERT_OK(context, test_collada_scene(
                           context,
                           GLOSS TEST_COLLADA_SQUARE("<triangles material='m' count='1'>" //
                                                     TEST_COLLADA_INPUT "<p>0 1 2</p></triangles>")
                               TEST_COLLADA_SHOWN,
                           &scene));
    assert_true(scene->materials[0].shine.has_specular);
    ASSERT_NEAR(scene->materials[0].shine.specular[1], 0.25, 0.0);
    ASSERT_NEAR(scene->materials[0].shine.roughness, 0.70710678, 1e-6); // (2 / 8)^(1/4)
    test_log_clear();
    char *text = write_and_read(scene, test_folder(), "a.gltf", "a.gltf");
    assert_non_null(strstr(text, "\"roughnessFactor\":0.7071"));
    assert_non_null(strstr(text, "\"specularColorFactor\":[0.5,0.25,0]"));
    assert_non_null(strstr(text, "\"KHR_materials_specular\""));
    alpi_release(context, text);
    assert_non_null(strstr(test_log_text(), "bump map of heights: 1"));
    assert_non_null(strstr(test_log_text(), "reflect an environment: 1"));
    assert_non_null(strstr(test_log_text(), "animations: 1"));
    assert_null(strstr(test_log_text(), "or gloss"));
    text = write_and_read(scene, test_folder(), "a.obj", "a.mtl");
    assert_non_null(strstr(text, "Ks 0.5 0.25 0\nNs 6\nPr 0.7071"));
    alpi_release(context, text);
    test_log_clear();
    text = write_and_read(scene, test_folder(), "a.dae", "a.dae");
    assert_non_null(strstr(text, "<shininess>"));
    assert_int_equal(test_log_has("conversion"), 0);
    alpi_release(context, text);
    alp_scene_destroy(scene);
}

/// A scene of lights alone becomes a glTF without a buffer.
TEST_WITH_CONTEXT(a_scene_without_triangles_is_converted, 1)
{
    alp_scene *scene = NULL;
    ASSERT_OK(context,
              test_collada_scene(context,
                                 "<library_lights><light id='l'><technique_common><directional>"
                                 "<color>1 1 1</color></directional></technique_common></light>"
                                 "</library_lights><library_visual_scenes><visual_scene id='s'>"
                                 "<node><instance_light url='#l'/></node></visual_scene>"
                                 "</library_visual_scenes>" TEST_COLLADA_SCENE,
                                 &scene));
    assert_int_equal(scene->triangle_count, 0);
    alp_scene *again = NULL;
    const char *folder = test_folder();
    alpi_release(context, write_and_read(scene, folder, "lights.glb", "lights.glb"));
    ASSERT_OK(context, alp_scene_load(context, test_path(folder, "lights.glb"), &again));
    assert_int_equal(again->light_count, 1);
    alp_scene_destroy(again);
    alp_scene_destroy(scene);
}

/// Writes a grey picture of one pixel.
static void write_picture(alp_context *context, const char *folder, const char *name)
{
    alp_image *image = NULL;
    const alp_image_info info = {1, 1, 3, ALP_COMPONENT_U8};
    ASSERT_OK(context, alp_image_create(context, info, &image));
    memset(alp_image_bytes(image), 128, 3);
    ASSERT_OK(context, alp_image_save(image, test_path(folder, name), true));
    alp_image_destroy(image);
}

/// A normal map is decoded for the file that it goes into.
TEST_WITH_CONTEXT(converted_normal_maps, 1)
{
    char folder[256];
    size_t size;
    alp_scene *scene = NULL, *again = NULL;
    snprintf(folder, sizeof folder, "%s", test_folder());
    write_picture(context, folder, "i.png");
    write_picture(context, folder, "b.png");
    char *text = test_collada_text(inside_with((extras){"", BUMP(""), "", ""}), &size);
    ASSERT_OK(context, alpi_file_write(context, test_path(folder, "n.dae"), true, text, size));
    free(text);
    ASSERT_OK(context, alp_scene_load(context, test_path(folder, "n.dae"), &scene));
    assert_null(scene->images[scene->materials[0].normal_texture.image]);
    alpi_release(context, write_and_read(scene, folder, "n.glb", "n.glb"));
    ASSERT_OK(context, alp_scene_load(context, test_path(folder, "n.glb"), &again));
    const uint32_t image = again->materials[0].normal_texture.image;
    assert_int_not_equal(image, ALPI_NONE);
    ASSERT_OK(context, alp_scene_load_normal_maps(again));
    assert_non_null(again->normal_maps[image]);
    alp_scene_destroy(again);
    alp_scene_destroy(scene);
}
