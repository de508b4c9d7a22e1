// SPDX-License-Identifier: MIT
// COLLADA documents → scenes, on small documents with closed forms: areas, units and axes, the
// order of transforms, numbers, materials, lights and cameras; what is refused and how.
#include "test_collada.h"
#include "test_gltf.h"

#include "base/memory.h"
#include "formats/collada/collada_numbers.h"
#include "formats/collada/collada_read.h"
#include "formats/text/utf16.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static alp_scene *read_good(alp_context *context, const char *inside)
{
    alp_scene *scene = NULL;
    ASSERT_OK(context, test_collada_scene(context, inside, &scene));
    return scene;
}

/// Reads geometry "g" with these primitives and gives its area and triangles.
static void check_area(const char *inside, uint32_t triangles, double area)
{
    alp_context *context = test_context(1);
    alp_scene *scene = read_good(context, inside);
    assert_int_equal(scene->triangle_count, triangles);
    ASSERT_NEAR(scene->area, area, 1e-12);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

TEST(primitives)
{
    check_area(TEST_COLLADA_SQUARE("<triangles count='2'>" TEST_COLLADA_INPUT
                                   "<p>0 1 2 0 2 3</p></triangles>") TEST_COLLADA_SHOWN,
               2, 1.0);
    check_area(TEST_COLLADA_SQUARE("<polylist count='1'>" TEST_COLLADA_INPUT
                                   "<vcount>4</vcount><p>0 1 2 3</p></polylist>")
                   TEST_COLLADA_SHOWN,
               2, 1.0);
    check_area(TEST_COLLADA_SQUARE("<tristrips count='1'>" TEST_COLLADA_INPUT
                                   "<p>0 1 3 2</p></tristrips>") TEST_COLLADA_SHOWN,
               2, 1.0);
    check_area(TEST_COLLADA_SQUARE("<trifans count='1'>" TEST_COLLADA_INPUT
                                   "<p>0 1 2 3</p><p>0 1 2</p></trifans>") TEST_COLLADA_SHOWN,
               3, 1.5);
    check_area(TEST_COLLADA_SQUARE("<polygons count='2'>" TEST_COLLADA_INPUT
                                   "<p>0 1 2 3</p><p>0 1 2</p></polygons>") TEST_COLLADA_SHOWN,
               3, 1.5);
    check_area(TEST_COLLADA_SQUARE("<lines count='1'>" TEST_COLLADA_INPUT "<p>0 1</p></lines>")
                   TEST_COLLADA_SHOWN,
               0, 0.0);
    // 3 × 3 with a hole of 1 × 1; the pentagon 1 × 1 with a notch of 1/4
    check_area(TEST_COLLADA_MESH("0 0 0 3 0 0 3 3 0 0 3 0 1 1 0 2 1 0 2 2 0 1 2 0", "24", "8",
                                 "<polygons count='1'>" TEST_COLLADA_INPUT
                                 "<ph><p>0 1 2 3</p><h>4 5 6 7</h></ph></polygons>")
                   TEST_COLLADA_SHOWN,
               8, 8.0);
    check_area(TEST_COLLADA_MESH("0 0 0 1 0 0 1 1 0 0.5 0.5 0 0 1 0", "15", "5",
                                 "<polylist count='1'>" TEST_COLLADA_INPUT
                                 "<vcount>5</vcount><p>0 1 2 3 4</p></polylist>")
                   TEST_COLLADA_SHOWN,
               3, 0.75);
}

/// Every second triangle of a strip turns the other way: all normals are +z.
TEST_WITH_CONTEXT(strips_keep_their_side, 1)
{
    alp_scene *scene =
        read_good(context, TEST_COLLADA_SQUARE("<tristrips count='1'>" TEST_COLLADA_INPUT
                                               "<p>0 1 3 2</p></tristrips>") TEST_COLLADA_SHOWN);
    for (uint32_t v = 0; v < scene->vertex_count; v++) {
        ASSERT_NEAR(scene->normals[v][2], 1.0, 0.0);
    }
    alp_scene_destroy(scene);
}

#define TRIANGLE                                                                                   \
    TEST_COLLADA_MESH("1 2 3 4 2 3 1 6 3", "9", "3",                                               \
                      "<triangles count='1'>" TEST_COLLADA_INPUT "<p>0 1 2</p></triangles>")
#define NODE(transforms)                                                                           \
    "<library_visual_scenes><visual_scene id='s'><node id='n'>" transforms "<instance_geometry "   \
    "url='#g'/></node></visual_scene></library_visual_scenes>" TEST_COLLADA_SCENE

/// Where corner (1, 2, 3) comes to lie.
static void check_corner(const char *inside, double x, double y, double z)
{
    alp_context *context = test_context(1);
    alp_scene *scene = read_good(context, inside);
    const double expected[3] = {x, y, z};
    for (int k = 0; k < 3; k++) { // floats of this size are rounded at 1e-6
        ASSERT_NEAR(scene->positions[scene->triangles[0][0]][k], expected[k],
                    2e-7 * (1.0 + fabs(expected[k])));
    }
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

TEST(axes_and_units)
{
    static const char plain[] = TRIANGLE NODE("");
    check_corner(plain, 1, 2, 3);
    check_corner("<asset><up_axis>Y_UP</up_axis></asset>" TRIANGLE NODE(""), 1, 2, 3);
    check_corner("<asset><up_axis>Z_UP</up_axis></asset>" TRIANGLE NODE(""), 1, 3, -2);
    check_corner("<asset><up_axis>X_UP</up_axis></asset>" TRIANGLE NODE(""), -2, 1, 3);
    check_corner("<asset><unit meter='0.0254'/><up_axis> Z_UP </up_axis></asset>" TRIANGLE NODE(""),
                 0.0254, 0.0762, -0.0508);
    check_corner("<asset><unit meter='0,010000'/></asset>" TRIANGLE NODE(""), 0.01, 0.02, 0.03);
    check_corner("<asset><unit name='meter'/></asset>" TRIANGLE NODE(""), 1, 2, 3);
}

TEST(transforms)
{
    check_corner(TRIANGLE NODE("<translate>10 20 30</translate>"), 11, 22, 33);
    check_corner(TRIANGLE NODE("<scale>2 3 4</scale>"), 2, 6, 12);
    check_corner(TRIANGLE NODE("<rotate>0 0 1 90</rotate>"), -2, 1, 3);
    check_corner(TRIANGLE NODE("<rotate>1 0 0 90</rotate>"), 1, -3, 2);
    check_corner(TRIANGLE NODE("<rotate>1 1 1 120</rotate>"), 3, 1, 2);
    check_corner(TRIANGLE NODE("<matrix>1 0 0 5 0 1 0 6 0 0 1 7 0 0 0 1</matrix>"), 6, 8, 10);
    // the last one stands nearest to the geometry
    check_corner(TRIANGLE NODE("<translate>10 0 0</translate><rotate>0 0 1 90</rotate>"), 8, 1, 3);
    check_corner(TRIANGLE NODE("<rotate>0 0 1 90</rotate><translate>10 0 0</translate>"), -2, 11,
                 3);
    // x goes by tan 45° · y
    check_corner(TRIANGLE NODE("<skew>45 0 1 0 1 0 0</skew>"), 3, 2, 3);
    // eye at (5, 0, 0), looks along −x: its −z is the world's −x, its x the world's −z
    check_corner(TRIANGLE NODE("<lookat>5 0 0 0 0 0 0 1 0</lookat>"), 8, 2, -1);
    // a node in a node, and in between by instance_node
    check_corner(TRIANGLE "<library_nodes><node id='m'><scale>2 2 2</scale><instance_geometry "
                          "url='#g'/></node></library_nodes><library_visual_scenes><visual_scene "
                          "id='s'><node><translate>1 0 0</translate><node><translate>0 1 0"
                          "</translate><instance_node url='#m'/></node></node></visual_scene>"
                          "</library_visual_scenes>" TEST_COLLADA_SCENE,
                 3, 5, 6);
    // a skin stands in its bind shape
    check_corner(TRIANGLE
                 "<library_controllers><controller id='c'><skin source='#g'><bind_shape_matrix>2 0 "
                 "0 0 0 2 0 0 0 0 2 0 0 0 0 1</bind_shape_matrix></skin></controller>"
                 "</library_controllers><library_visual_scenes><visual_scene id='s'><node>"
                 "<translate>1 0 0</translate><instance_controller url='#c'/></node>"
                 "</visual_scene></library_visual_scenes>" TEST_COLLADA_SCENE,
                 3, 4, 6);
    assert_true(test_log_has("skin"));
}

/// A mirrored node turns the winding back, so that normals of the winding stay outside.
TEST_WITH_CONTEXT(mirrored, 1)
{
    alp_scene *scene = read_good(context, TRIANGLE NODE("<scale>1 1 -1</scale>"));
    assert_true(scene->surfaces[0].mirrored);
    ASSERT_NEAR(scene->normals[0][2], -1.0, 0.0);
    alp_scene_destroy(scene);
}

// --- numbers -------------------------------------------------------------------------------------

TEST(numbers)
{
    static const char *const texts[] = {"0",
                                        "-0.0",
                                        "1",
                                        "+1.5",
                                        ".5",
                                        "5.",
                                        "1e3",
                                        "1E-3",
                                        "1.25e+2",
                                        "123456789",
                                        "0.1",
                                        "3.4028235e38",
                                        "1e-45",
                                        "1e-400",
                                        "12345678901234567890123",
                                        "0.000000000000000000012345",
                                        "1e22",
                                        "1e23",
                                        "9.999999747378752e-05",
                                        "16777217"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        const char *at = texts[i];
        double value = (double)NAN;
        assert_true(alpi_text_number(&at, &value));
        assert_int_equal(*at, '\0');
        const double expected = strtod(texts[i], NULL);       // the tests run in the C locale
        ASSERT_NEAR(value, expected, 4e-16 * fabs(expected)); // two roundings of a double
    }
    uint64_t seed = 1;
    for (int round = 0; round < 20000; round++) { // as floats the same, whatever the digits
        seed = seed * 6364136223846793005u + 1442695040888963407u; // Knuth's MMIX
        char text[64];
        const double number = ldexp((double)(seed >> 11), (int)(seed % 120) - 110);
        snprintf(text, sizeof text, "%.*g", 1 + (int)(seed >> 60), number);
        const char *at = text;
        double value = (double)NAN;
        assert_true(alpi_text_number(&at, &value));
        ASSERT_NEAR(value, strtod(text, NULL), 4e-16 * number);
    }
    static const char *const comma = "0,25 ";
    const char *at = comma;
    double value = 0.0;
    assert_true(alpi_text_number(&at, &value) && *at == '\0');
    ASSERT_NEAR(value, 0.25, 0.0);
    at = "-INF";
    assert_true(alpi_text_number(&at, &value) && value < 0.0 && isinf(value));
    at = "NaN";
    assert_true(alpi_text_number(&at, &value) && isnan(value));
    static const char *const bad[] = {"", "x", "-", ".", "1x", "e5", "1.2.3", "0x10", "--1"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        at = bad[i];
        assert_false(alpi_text_number(&at, &value));
        assert_ptr_equal(at, bad[i]);
    }
}

// --- materials, lights, cameras ------------------------------------------------------------------

#define EFFECT(shader)                                                                             \
    "<library_effects><effect id='e'><profile_COMMON><technique sid='t'>" shader                   \
    "</technique></profile_COMMON></effect></library_effects><library_materials><material id='m' " \
    "name='red'><instance_effect url='#e'/></material></library_materials>"
#define BOUND                                                                                      \
    "<library_visual_scenes><visual_scene id='s'><node id='n'><instance_geometry url='#g'>"        \
    "<bind_material><technique_common><instance_material symbol='S' target='#m'/>"                 \
    "</technique_common></bind_material></instance_geometry></node></visual_scene>"                \
    "</library_visual_scenes>" TEST_COLLADA_SCENE
#define PAINTED                                                                                    \
    TEST_COLLADA_SQUARE("<triangles material='S' count='1'>" TEST_COLLADA_INPUT                    \
                        "<p>0 1 2</p></triangles>")

static alpi_material read_material(const char *inside)
{
    alp_context *context = test_context(1);
    alp_scene *scene = read_good(context, inside);
    assert_int_equal(scene->material_count, 1);
    assert_int_equal(scene->surfaces[0].material, 0);
    assert_string_equal(scene->materials[0].name, "red");
    alpi_material material = scene->materials[0];
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    return material;
}

TEST(materials)
{
    alpi_material m = read_material(
        EFFECT("<phong><emission><color>1 2 3 1</color></emission><diffuse><color>0.25 0.5 0.75 1"
               "</color></diffuse><transparent><color>0 0 0 1</color></transparent><transparency>"
               "<float>0.5</float></transparency></phong>") PAINTED BOUND);
    ASSERT_NEAR(m.base_color[0], 0.25, 0.0);
    ASSERT_NEAR(m.base_color[2], 0.75, 0.0);
    ASSERT_NEAR(m.emission[1], 2.0, 0.0);
    ASSERT_NEAR(m.base_color[3], 0.5, 0.0); // A_ONE: alpha × transparency
    assert_int_equal(m.alpha_mode, ALPI_ALPHA_BLEND);
    m = read_material(EFFECT("<lambert><transparent opaque='RGB_ZERO'><color>0.25 0.25 0.25 1"
                             "</color></transparent></lambert>") PAINTED BOUND);
    ASSERT_NEAR(m.base_color[3], 0.75, 0.0); // what is not let through
    m = read_material(EFFECT("<blinn><transparent><color>1 1 1 1</color></transparent>"
                             "<transparency><float>0</float></transparency></blinn>")
                          PAINTED BOUND);
    ASSERT_NEAR(m.base_color[3], 1.0, 0.0); // as some exporters write what is opaque
    assert_int_equal(m.alpha_mode, ALPI_ALPHA_OPAQUE);
    assert_true(test_log_has("alpha"));
    m = read_material(EFFECT("<constant><emission><color>1 1 1 1</color></emission></constant>"
                             "<extra><technique profile='X'><double_sided>1</double_sided>"
                             "</technique></extra>") PAINTED BOUND);
    ASSERT_NEAR(m.base_color[0], 0.0, 0.0);
    assert_true(m.double_sided);
}

#define UV_SOURCE(id)                                                                              \
    "<source id='" id "'><float_array id='" id "-a' count='6'>0 0 1 0 1 0.25</float_array>"        \
    "<technique_common><accessor source='#" id "-a' count='3' stride='2'><param name='S' "         \
    "type='float'/><param name='T' type='float'/></accessor></technique_common></source>"

/// Sets are numbered by the file as it likes; ours follow one another. t counts from below.
TEST_WITH_CONTEXT(coordinate_sets, 1)
{
    alp_scene *scene =
        read_good(context, TEST_COLLADA_SQUARE(UV_SOURCE("a") UV_SOURCE(
                               "b") "<triangles count='1'>" TEST_COLLADA_INPUT
                                    "<input semantic='TEXCOORD' source='#b' offset='2' set='7'/>"
                                    "<input semantic='TEXCOORD' source='#a' offset='1' set='3'/>"
                                    "<p>0 0 2 1 1 1 2 2 0</p></triangles>") TEST_COLLADA_SHOWN);
    assert_int_equal(scene->surfaces[0].uv_sets, 2);
    const uint32_t *t = scene->triangles[0];
    ASSERT_NEAR(scene->uvs[0][t[2]][0], 1.0, 0.0);
    ASSERT_NEAR(scene->uvs[0][t[2]][1], 0.75, 0.0);
    ASSERT_NEAR(scene->uvs[1][t[0]][1], 0.75, 0.0);
    ASSERT_NEAR(scene->uvs[1][t[2]][1], 1.0, 0.0);
    alp_scene_destroy(scene);
}

#define BOUND_TO_SET(sources, inputs, set)                                                         \
    "<library_images><image id='i'><init_from>i.png</init_from></image></library_images>"          \
    "<library_effects><effect id='e'><profile_COMMON><newparam sid='u'><surface type='2D'>"        \
    "<init_from>i</init_from></surface></newparam><newparam sid='w'><sampler2D><source>u</source>" \
    "</sampler2D></newparam><technique sid='t'><lambert><diffuse><texture texture='w' texcoord"    \
    "='C'/></diffuse></lambert></technique></profile_COMMON></effect></library_effects>"           \
    "<library_materials><material id='m'><instance_effect url='#e'/></material>"                   \
    "</library_materials>" TEST_COLLADA_SQUARE(                                                    \
        sources "<triangles material='S' count='1'>" TEST_COLLADA_INPUT inputs                     \
                "<p>0 0 1 1 2 2</p>"                                                               \
                "</triangles>") "<library_visual_scenes><visual_scene "                            \
                                "id='s'><node><instance_geometry url='#g'>"                        \
                                "<bind_material><technique_common><instance_material symbol='S' "  \
                                "target='#m'>"                                                     \
                                "<bind_vertex_input semantic='C' input_semantic='TEXCOORD' "       \
                                "input_set='" set "'/>"                                            \
                                "</instance_material></technique_common></bind_material></"        \
                                "instance_geometry></node>"                                        \
                                "</visual_scene></library_visual_scenes>" TEST_COLLADA_SCENE

/// A texture bound to a set that is not there reads the only one, as of exporters that count from
/// 1; of two nothing says which, so it is left out and told.
TEST_WITH_CONTEXT(sets_that_are_not_there, 1)
{
    test_log_clear();
    alp_scene *scene = read_good(
        context,
        BOUND_TO_SET(UV_SOURCE("a"), "<input semantic='TEXCOORD' source='#a' offset='1'/>", "1"));
    assert_int_equal(scene->materials[0].base_color_texture.image, 0);
    assert_int_equal(scene->materials[0].base_color_texture.uv_set, 0);
    assert_int_equal(test_log_has("uv-set"), 0);
    alp_scene_destroy(scene);
    scene = read_good(context,
                      BOUND_TO_SET(UV_SOURCE("a"),
                                   "<input semantic='TEXCOORD' source='#a' offset='1' set='0'/>"
                                   "<input semantic='TEXCOORD' source='#a' offset='1' set='1'/>",
                                   "2"));
    assert_int_equal(scene->materials[0].base_color_texture.image, ALPI_NONE);
    assert_int_equal(test_log_has("uv-set"), 1);
    assert_non_null(strstr(test_log_text(), "test.dae: line 2, <bind_vertex_input>"));
    alp_scene_destroy(scene);
}

#define PLACED(thing)                                                                              \
    "<library_visual_scenes><visual_scene id='s'><node><translate>0 0 2</translate>" thing         \
    "</node><node><instance_geometry "                                                             \
    "url='#g'/></node></visual_scene></library_visual_scenes>" TEST_COLLADA_SCENE
#define LIGHT(kind)                                                                                \
    "<library_lights><light id='l'><technique_common>" kind                                        \
    "</technique_common></light></library_lights>" TRIANGLE PLACED("<instance_light url='#l'/>")

static alpi_light read_light(const char *inside)
{
    alp_context *context = test_context(1);
    alp_scene *scene = read_good(context, inside);
    assert_int_equal(scene->light_count, 1);
    alpi_light light = scene->lights[0];
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    return light;
}

/// The triangle's box is 3 × 4 × 0: half its diagonal is 2.5.
TEST_WITH_CONTEXT(lights, 1)
{
    alpi_light light = read_light(LIGHT("<directional><color>1 0.5 0</color></directional>"));
    assert_int_equal(light.kind, ALP_LIGHT_DIRECTIONAL);
    ASSERT_NEAR(light.intensity, ALPI_PI, 1e-6);
    ASSERT_NEAR(light.color.y, 0.5, 0.0);
    ASSERT_NEAR(light.direction.z, -1.0, 0.0);
    // c = 1: E = π at 2.5 m asks for I = π · 2.5²
    light = read_light(LIGHT("<point><color>1 1 1</color></point>"));
    ASSERT_NEAR(light.intensity, ALPI_PI * 6.25, 1e-5);
    ASSERT_NEAR(light.position.z, 2.0, 0.0);
    assert_true(test_log_has("light-units"));
    // 1 / (4 d²) is ours, at any distance
    light = read_light(LIGHT("<spot><color>1 1 1</color><constant_attenuation>0"
                             "</constant_attenuation><quadratic_attenuation>4"
                             "</quadratic_attenuation><falloff_angle>60</falloff_angle></spot>"));
    ASSERT_NEAR(light.intensity, ALPI_PI / 4.0, 1e-6);
    ASSERT_NEAR(light.outer_cone, ALPI_PI / 6.0, 1e-6);
    ASSERT_NEAR(light.inner_cone, light.outer_cone, 0.0);
    alp_scene *scene = read_good(context, LIGHT("<ambient><color>1 1 1</color></ambient>"));
    assert_int_equal(scene->light_count, 0);
    assert_non_null(strstr(test_log_text(), "<ambient>"));
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(cameras, 1)
{
    alp_scene *scene = read_good(
        context, "<library_cameras><camera id='c'><optics><technique_common><perspective><xfov>90"
                 "</xfov><aspect_ratio>2</aspect_ratio></perspective></technique_common></optics>"
                 "</camera></library_cameras>" TRIANGLE PLACED("<instance_camera url='#c'/>"));
    assert_int_equal(scene->camera_count, 1);
    ASSERT_NEAR(scene->cameras[0].vertical_fov, 2.0 * atan(0.5), 1e-6);
    ASSERT_NEAR(scene->cameras[0].position[2], 2.0, 0.0);
    ASSERT_NEAR(scene->cameras[0].target[2], 1.0, 0.0);
    alp_scene_destroy(scene);
}

// --- encodings -----------------------------------------------------------------------------------

TEST_WITH_CONTEXT(utf16, 1)
{
    size_t size;
    char *text = test_collada_text(TRIANGLE NODE(""), &size);
    memcpy(strstr(text, "utf-8"), "UTF16", 5);
    for (int form = 0; form < 4; form++) { // little, big, without a mark
        unsigned char wide[8192];
        const size_t mark = form < 2 ? 1 : 0;
        assert_in_range(size, 1, sizeof wide / 2 - 1);
        wide[form % 2] = 0xff;
        wide[1 - form % 2] = 0xfe;
        for (size_t i = 0; i < size; i++) {
            wide[2 * (i + mark) + (size_t)(form % 2)] = (unsigned char)text[i];
            wide[2 * (i + mark) + (size_t)(1 - form % 2)] = 0;
        }
        alp_scene *scene = NULL;
        ASSERT_OK(context, test_collada_bytes(context, wide, 2 * (size + mark), &scene));
        assert_int_equal(scene->triangle_count, 1);
        alp_scene_destroy(scene);
    }
    free(text);
}

/// The same warning as of other formats, which the doctor knows.
TEST_WITH_CONTEXT(crossed_faces, 1)
{
    test_log_clear();
    alp_scene_destroy(read_good(context,
                                TEST_COLLADA_MESH("0 0 0 4 0 0 0 1 0 3 3 0", "12", "4",
                                                  "<polylist count='1'>" TEST_COLLADA_INPUT
                                                  "<vcount>4</vcount><p>0 1 2 3</p></polylist>")
                                    TEST_COLLADA_SHOWN));
    assert_int_equal(test_log_has("crossed-faces"), 1);
}

/// A manifest names the document that counts, perhaps an element in it, as an address has it.
TEST_WITH_CONTEXT(manifests, 1)
{
    static const char *const roots[] = {"./sub/b.dae", "./sub/b.dae#x", " sub/b.dae#x ",
                                        "sub/%62.dae"};
    size_t size;
    char *text = test_collada_text(TRIANGLE TEST_COLLADA_SHOWN, &size);
    for (size_t i = 0; i < sizeof roots / sizeof *roots; i++) {
        char *manifest =
            alpi_format(context, "<?xml version=\"1.0\"?>\n<dae_root>%s</dae_root>", roots[i]);
        const char *const files[][2] = {
            {"a.dae", "another document"}, {"manifest.xml", manifest}, {"sub/b.dae", text}};
        uint8_t *zip = test_collada_zip(files, 3, &size);
        alp_scene *scene = NULL;
        ASSERT_OK(context, test_collada_bytes(context, zip, size, &scene));
        assert_int_equal(scene->triangle_count, 1);
        alp_scene_destroy(scene);
        free(zip);
        alpi_release(context, manifest);
    }
    free(text);
}
