// SPDX-License-Identifier: MIT
// Files of people: references to nothing, empty geometries, inputs that cannot be read, bytes of
// another encoding. Each costs its element and a warning; the rest is read, and baked.
#include "test_collada.h"

#include "base/file.h"
#include "formats/formats.h"

#include <alpenglow/alpenglow.h>

#include <stdio.h>
#include <stdlib.h>

#define TRIANGLE "<triangles material='S' count='1'>" TEST_COLLADA_INPUT "<p>0 1 2</p></triangles>"
#define NODE(things)                                                                               \
    "<library_visual_scenes><visual_scene id='s'><node id='n'>" things                             \
    "</node></visual_scene></library_visual_scenes>" TEST_COLLADA_SCENE
#define SHOWN "<instance_geometry url='#g'/>"
#define BOUND(target)                                                                              \
    "<instance_geometry url='#g'><bind_material><technique_common><instance_material symbol='S' "  \
    "target='" target "'/></technique_common></bind_material></instance_geometry>"

/// Writes the scene with a map on its triangles.
static void write_with_map(const alp_scene *scene, const char *path)
{
    static const float uvs[4][3][2] = {{{0.1f, 0.1f}, {0.9f, 0.1f}, {0.9f, 0.9f}}};
    static const uint8_t *const pngs[] = {(const uint8_t *)"x"};
    static const size_t sizes[] = {1};
    const alpi_mesh_patch patch = {
        .page_count = 1, .corner_uvs = uvs, .page_pngs = pngs, .page_png_sizes = sizes};
    assert_in_range(scene->triangle_count, 1, 4);
    ASSERT_OK(scene->context, alpi_scene_write_patched(scene, &patch, path, true));
}

/// A reference to nothing costs what refers, and names what is missing. The document can be
/// written.
TEST_WITH_CONTEXT(references_to_nothing, 1)
{
    static const struct {
        const char *inside, *words;
    } cases[] = {
        {NODE(SHOWN "<instance_camera url='#C'/>"), "<instance_camera>: \"#C\" is no <camera>"},
        {NODE(SHOWN "<instance_light url='#L'/>"), "\"#L\" is no <light>"},
        {NODE(SHOWN "<instance_node url='#N'/>"), "\"#N\" is no <node>"},
        {NODE(SHOWN "<instance_geometry url='#G'/>"), "\"#G\" is no <geometry>"},
        {NODE(SHOWN "<instance_controller url='#K'/>"), "\"#K\" is no <controller>"},
        {NODE(SHOWN "<instance_camera/>"), "\"\" is no <camera>"},
        {NODE(SHOWN "<instance_camera url='#g'/>"), "\"#g\" is no <camera>"}, // of another kind
        {"<library_controllers><controller id='k'><skin source='#G'/></controller>"
         "</library_controllers>" NODE(SHOWN "<instance_controller url='#k'/>"),
         "<skin>: \"#G\" is no <geometry>"},
        {NODE(BOUND("#M")), "<instance_material>: \"#M\" is no <material>"},
        {"<library_materials><material id='m'><instance_effect url='#E'/></material>"
         "</library_materials>" NODE(BOUND("#m")),
         "<instance_effect>: \"#E\" is no <effect>"},
        // shown by way of <instance_node>, which the writer writes out
        {"<library_nodes><node id='k'>" SHOWN "<instance_node url='#N'/></node></library_nodes>"
         "<library_visual_scenes><visual_scene id='s'><node><instance_node url='#k'/></node><node>"
         "<translate>5 0 0</translate><instance_node url='#k'/></node></visual_scene>"
         "</library_visual_scenes>" TEST_COLLADA_SCENE,
         "this reference first: 2"},
    };
    const char *path = test_path(test_folder(), "out.dae");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char inside[4096];
        alp_scene *scene = NULL, *again = NULL;
        snprintf(inside, sizeof inside, "%s%s", TEST_COLLADA_SQUARE(TRIANGLE), cases[i].inside);
        test_log_clear();
        ASSERT_OK(context, test_collada_scene(context, inside, &scene));
        assert_int_equal(test_log_has("missing"), 1);
        assert_non_null(strstr(test_log_text(), cases[i].words));
        assert_int_equal(scene->camera_count + scene->light_count, 0);
        write_with_map(scene, path);
        ASSERT_OK(context, alp_scene_load(context, path, &again));
        assert_int_equal(again->triangle_count, scene->triangle_count);
        alp_scene_destroy(again);
        alp_scene_destroy(scene);
    }
}

/// A thousand references to one thing are told once; things past the limit are counted.
TEST_WITH_CONTEXT(many_references, 1)
{
    static char inside[200000];
    size_t at = (size_t)sprintf(inside, "%s<library_visual_scenes><visual_scene id='s'><node>",
                                TEST_COLLADA_SQUARE(TRIANGLE));
    for (int i = 0; i < 1000; i++) {
        at += (size_t)sprintf(inside + at, "<instance_light url='#l%d'/>", i < 980 ? 0 : i);
    }
    sprintf(inside + at, "</node></visual_scene></library_visual_scenes>%s", TEST_COLLADA_SCENE);
    alp_scene *scene = NULL;
    test_log_clear();
    ASSERT_OK(context, test_collada_scene(context, inside, &scene));
    assert_non_null(strstr(test_log_text(), "\"#l0\" is no <light>"));
    assert_non_null(strstr(test_log_text(), "first: 980"));
    assert_non_null(strstr(test_log_text(), "\"#l994\""));
    assert_null(strstr(test_log_text(), "\"#l995\""));
    assert_non_null(strstr(test_log_text(), "not in the document: 5"));
    alp_scene_destroy(scene);
}

#define EMPTY_SOURCE                                                                               \
    "<source id='e'><float_array id='ea' count='0'/><technique_common><accessor source='#ea' "     \
    "count='0' stride='0'/></technique_common></source>"

/// A bad primitive among good ones, with a source that is broken; both ways of writing pass it by.
TEST_WITH_CONTEXT(one_bad_primitive, 1)
{
    static const char *const bad[] = {"<p>0 1 -1</p>", "<p>0 1 9</p>", "<p>x</p>"};
    const char *path = test_path(test_folder(), "out.dae");
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char inside[4096];
        alp_scene *scene = NULL, *again = NULL;
        snprintf(inside, sizeof inside, "%s%s%s%s",
                 "<library_geometries><geometry id='g'><mesh><source id='p'><float_array id='pa' "
                 "count='9'>0 0 0 1 0 0 1 1 0</float_array><technique_common><accessor "
                 "source='#pa' count='3' stride='3'/></technique_common></source><vertices id='v'>"
                 "<input semantic='POSITION' source='#p'/></vertices><triangles "
                 "count='1'>" TEST_COLLADA_INPUT,
                 bad[i], "</triangles>" TRIANGLE "</mesh></geometry></library_geometries>",
                 NODE(SHOWN));
        test_log_clear();
        ASSERT_OK(context, test_collada_scene(context, inside, &scene));
        assert_int_equal(scene->triangle_count, 1);
        assert_int_equal(scene->surfaces[0].primitive, 1);
        assert_int_equal(test_log_has("bad-faces"), 1);
        write_with_map(scene, path);
        ASSERT_OK(context, alp_scene_load(context, path, &again));
        assert_int_equal(again->triangle_count, 1);
        assert_int_equal(again->surfaces[0].uv_sets, 1);
        alp_scene_destroy(again);
        alp_scene_destroy(scene);
    }
}

/// Normals, colours and coordinates that are not there, hold no numbers or are too few.
TEST_WITH_CONTEXT(bad_inputs, 1)
{
    static const struct {
        const char *inputs, *words;
    } cases[] = {
        {"<input semantic='NORMAL' source='#none' offset='0'/>", "has no NORMAL"},
        {"<input semantic='TEXCOORD' source='#none' offset='0'/>", "has no TEXCOORD"},
        {"<input semantic='COLOR' source='#none' offset='0'/>", "has no COLOR"},
        {"<input semantic='NORMAL' source='#e' offset='0'/>", "lie outside"},
        {"<input semantic='NORMAL' source='#x' offset='0'/>", "has no NORMAL"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char inside[4096], primitive[1024];
        snprintf(primitive, sizeof primitive,
                 "<triangles count='1'>" TEST_COLLADA_INPUT "%s<p>0 1 2</p></triangles>",
                 cases[i].inputs);
        snprintf(inside, sizeof inside,
                 TEST_COLLADA_SQUARE("<source id='x'><float_array id='xa'>0 y 1</float_array>"
                                     "<technique_common><accessor source='#xa' count='1' "
                                     "stride='3'/></technique_common></source>" EMPTY_SOURCE "%s")
                     NODE(SHOWN),
                 primitive);
        alp_scene *scene = NULL;
        test_log_clear();
        ASSERT_OK(context, test_collada_scene(context, inside, &scene));
        assert_int_equal(scene->triangle_count, 1);
        assert_true(scene->surfaces[0].normals_generated);
        ASSERT_NEAR(scene->normals[0][2], 1.0, 0.0);
        assert_int_equal(scene->surfaces[0].uv_sets, 0);
        assert_int_equal(test_log_has("bad-input"), 1);
        assert_non_null(strstr(test_log_text(), cases[i].words));
        alp_scene_destroy(scene);
    }
}

/// A geometry of nothing, an effect and a lamp with words for numbers.
TEST_WITH_CONTEXT(broken_elements, 1)
{
    alp_scene *scene = NULL;
    test_log_clear();
    ASSERT_OK(
        context,
        test_collada_scene(
            context,
            TEST_COLLADA_SQUARE(
                TRIANGLE) "<library_geometries><geometry id='h'><mesh>" //
            EMPTY_SOURCE "<vertices id='hv'><input semantic='POSITION' "
                          "source='#e'/></vertices><triangles "
                          "count='0'><input semantic='VERTEX' source='#hv' "
                          "offset='0'/><p/></triangles>"
                          "</mesh></geometry></library_geometries><library_effects><effect id='f'>"
                          "<profile_COMMON><technique sid='t'><lambert><diffuse><color>red</color>"
                          "</diffuse></lambert></technique></profile_COMMON></effect></"
                          "library_effects>"
                          "<library_materials><material id='m'><instance_effect "
                          "url='#f'/></material>"
                          "</library_materials><library_lights><light "
                          "id='l'><technique_common><point>"
                          "<color>bright</color></point></technique_common></light></"
                          "library_lights>" //
            NODE(BOUND("#m") "<instance_geometry url='#h'/><instance_light url='#l'/>"),
            &scene));
    assert_int_equal(scene->triangle_count, 1);
    assert_int_equal(scene->light_count, 0);
    ASSERT_NEAR(scene->materials[0].base_color[0], 0.5, 0.0);
    assert_int_equal(test_log_has("empty-geometry"), 1);
    assert_int_equal(test_log_has("effect"), 1);
    assert_int_equal(test_log_has("bad-fixture"), 1);
    alp_scene_destroy(scene);
}

// --- encodings -----------------------------------------------------------------------------------

/// Name of the only surface of a document with this declaration and node name.
static void check_name(alp_context *context, const char *encoding, const char *name,
                       const char *expected, bool warns)
{
    char text[4096];
    size_t size;
    char *inside = test_collada_text(TEST_COLLADA_SQUARE(TRIANGLE), &size);
    const char *root = strstr(inside, "<COLLADA");
    const size_t body = (size_t)(strstr(inside, "</COLLADA>") - root);
    snprintf(text, sizeof text,
             "<?xml version=\"1.0\"%s?>\n%.*s<library_visual_scenes><visual_scene id=\"s\"><node "
             "name=\"%s\"><instance_geometry url=\"#g\"/></node></visual_scene>"
             "</library_visual_scenes><scene><instance_visual_scene "
             "url=\"#s\"/></scene></COLLADA>",
             encoding, (int)body, root, name);
    alp_scene *scene = NULL;
    test_log_clear();
    ASSERT_OK(context, test_collada_bytes(context, text, strlen(text), &scene));
    assert_string_equal(scene->surfaces[0].name, expected);
    assert_int_equal(test_log_has("encoding"), warns);
    if (warns) {
        const char *path = test_path(test_folder(), "out.dae");
        alp_scene *again = NULL;
        write_with_map(scene, path);
        test_log_clear();
        ASSERT_OK(context, alp_scene_load(context, path, &again));
        assert_string_equal(again->surfaces[0].name, expected);
        alp_scene_destroy(again);
    }
    alp_scene_destroy(scene);
    free(inside);
}

/// ü is C3 BC in UTF-8 and FC in Latin-1.
TEST_WITH_CONTEXT(encodings, 1)
{
    static const char utf8[] = " encoding=\"utf-8\"", latin1[] = " encoding=\"ISO-8859-1\"";
    check_name(context, utf8, "T\xc3\xbcr", "T\xc3\xbcr", false);
    check_name(context, "", "T\xc3\xbcr", "T\xc3\xbcr", false);
    check_name(context, latin1, "T\xfcr", "T\xc3\xbcr", false);
    check_name(context, utf8, "T\xfcr", "T\xc3\xbcr", true);
    assert_false(test_log_has("encoding")); // what was written is UTF-8 throughout
    check_name(context, "", "T\xfcr", "T\xc3\xbcr", true);
    check_name(context, utf8, "\xc3\xbc\xfc", "\xc3\xbc\xc3\xbc", true); // both in one file
    check_name(context, utf8, "\xe2\x82", "\xc3\xa2\xc2\x82", true);     // cut short
    check_name(context, utf8, "\xed\xa0\x80", "\xc3\xad\xc2\xa0\xc2\x80", true);
    check_name(context, utf8, "\xc0\xaf", "\xc3\x80\xc2\xaf", true); // longer than it must be
    check_name(context, " encoding=\"utf-16\"", "T\xc3\xbcr", "T\xc3\xbcr", true);
}

/// The warning names line, column and byte.
TEST_WITH_CONTEXT(place_of_bytes, 1)
{
    static const char text[] = "<?xml version=\"1.0\"?>\n<COLLADA>\n <a>\xe4\xf6</a></COLLADA>";
    alp_scene *scene = NULL;
    test_log_clear();
    ASSERT_OK(context, test_collada_bytes(context, text, sizeof text - 1, &scene));
    assert_non_null(strstr(test_log_text(), "line 3, column 5: the byte 0xE4 is no UTF-8"));
    assert_non_null(strstr(test_log_text(), "Latin-1: 2"));
    alp_scene_destroy(scene);
}

// --- files of the issue --------------------------------------------------------------------------

TEST_WITH_CONTEXT(reported_files, 1)
{
    static const struct {
        const char *file, *code;
        uint32_t triangles;
    } cases[] = {{"dae_nocam.dae", "missing", 2},     {"dae_noeffect.dae", "missing", 2},
                 {"dae_nomat.dae", "missing", 2},     {"dae_stride0.dae", "empty-geometry", 2},
                 {"dae_neg_idx.dae", "bad-faces", 0}, {"dae_badutf.dae", "encoding", 2}};
    if (test_shared("scenes/reports") == NULL) {
        skip();
    }
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char relative[128];
        alp_scene *scene = NULL;
        snprintf(relative, sizeof relative, "scenes/reports/%s", cases[i].file);
        test_log_clear();
        ASSERT_OK(context, alp_scene_load(context, test_shared(relative), &scene));
        assert_int_equal(scene->triangle_count, cases[i].triangles);
        assert_int_equal(test_log_has(cases[i].code), 1);
        alp_scene_destroy(scene);
    }
}

/// Coordinates of a national grid are those near the origin, to the last bit.
TEST_WITH_CONTEXT(reported_far_file, 1)
{
    alp_scene *far = NULL, *near = NULL;
    if (test_shared("scenes/reports") == NULL) {
        skip();
    }
    ASSERT_OK(context,
              alp_scene_load(context, test_shared("scenes/reports/dae_far_utm.dae"), &far));
    ASSERT_OK(context,
              alp_scene_load(context, test_shared("scenes/reports/far_utm.near.obj"), &near));
    assert_int_equal(far->triangle_count, near->triangle_count);
    ASSERT_NEAR(far->area, near->area, 1e-6 * near->area); // float positions
    assert_in_range((int)(-far->origin[2]), 5712300, 5712400);
    alp_scene_destroy(near);
    alp_scene_destroy(far);
}
