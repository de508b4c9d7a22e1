// SPDX-License-Identifier: MIT
// COLLADA that is wrong or means harm: a clear error that names the line, and nothing else opened.
#include "test_collada.h"
#include "test_gltf.h"

#include "formats/collada/collada_read.h"

#include <stdio.h>
#include <stdlib.h>

#define TRIANGLES(p) "<triangles count='1'>" TEST_COLLADA_INPUT "<p>" p "</p></triangles>"

TEST_WITH_CONTEXT(wrong_documents, 1)
{
    static const struct {
        const char *inside, *words;
    } cases[] = {
        {"<asset><unit meter='big'/></asset>", "meter=\"big\" is no length"},
        {"<library_visual_scenes><visual_scene id='s'><node id='a'><instance_node url='#a'/></node>"
         "</visual_scene></library_visual_scenes>" TEST_COLLADA_SCENE,
         "<node> \"a\": contains itself"},
        {"<library_nodes><node id='a'><instance_node url='#b'/></node><node id='b'><instance_node "
         "url='#a'/></node></library_nodes><library_visual_scenes><visual_scene id='s'><node>"
         "<instance_node "
         "url='#a'/></node></visual_scene></library_visual_scenes>" TEST_COLLADA_SCENE,
         "contains itself"},
        {"<library_visual_scenes><visual_scene id='s'><node><matrix>1 2 3</matrix></node>"
         "</visual_scene></library_visual_scenes>" TEST_COLLADA_SCENE,
         "holds 3 numbers, must hold 16"},
        {"<library_visual_scenes><visual_scene id='s'><node><rotate>0 0 1 1e999</rotate></node>"
         "</visual_scene></library_visual_scenes>" TEST_COLLADA_SCENE,
         "not finite"},
        {"<library_controllers><controller id='c'><skin source='#c'/></controller>"
         "</library_controllers><library_visual_scenes><visual_scene id='s'><node>"
         "<instance_controller "
         "url='#c'/></node></visual_scene></library_visual_scenes>" TEST_COLLADA_SCENE,
         "circle"},
        {"<node>", "may be truncated"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_scene *scene = NULL;
        assert_int_equal(test_collada_scene(context, cases[i].inside, &scene),
                         ALP_ERROR_INVALID_DATA);
        assert_null(scene);
        test_message_has(context, cases[i].words);
        test_message_has(context, "test.dae: ");
    }
}

/// A primitive that cannot be read costs itself and a warning with the cause.
TEST_WITH_CONTEXT(bad_primitives, 1)
{
    static const struct {
        const char *inside, *words;
    } cases[] = {
        {TEST_COLLADA_SQUARE(TRIANGLES("0 1 400")) TEST_COLLADA_SHOWN,
         "line 2, <triangles>: corner 2 uses vertex 400, there are 4"},
        {TEST_COLLADA_SQUARE(TRIANGLES("0 1 -2")) TEST_COLLADA_SHOWN, "\"-2\""},
        {TEST_COLLADA_SQUARE(TRIANGLES("0 1 2.5")) TEST_COLLADA_SHOWN, "\"2.5\""},
        {TEST_COLLADA_SQUARE(TRIANGLES("0 1 99999999999999999999")) TEST_COLLADA_SHOWN, "index"},
        {TEST_COLLADA_SQUARE("<polylist count='1'>" TEST_COLLADA_INPUT
                             "<vcount>5</vcount><p>0 1 2 3</p></polylist>") TEST_COLLADA_SHOWN,
         "asks for 5 corners, <p> holds 4"},
        {TEST_COLLADA_SQUARE("<polygons>" TEST_COLLADA_INPUT "<ph><h>0 1 2</h></ph></polygons>")
             TEST_COLLADA_SHOWN,
         "one <p> and then its holes"},
        {TEST_COLLADA_SQUARE("<triangles count='1'><input semantic='VERTEX' source='#none' "
                             "offset='0'/><p>0 1 2</p></triangles>") TEST_COLLADA_SHOWN,
         "source=\"#none\" names nothing"},
        {TEST_COLLADA_SQUARE("<triangles count='1'><input semantic='VERTEX' source='#pa' "
                             "offset='0'/><p>0 1 2</p></triangles>") TEST_COLLADA_SHOWN,
         "names a <float_array> where a <vertices> must be"},
        {TEST_COLLADA_MESH("0 0 0 1 0 x 1 1 0", "9", "3", TRIANGLES("0 1 2")) TEST_COLLADA_SHOWN,
         "\"x\" (0 lines further) is no number"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_scene *scene = NULL;
        test_log_clear();
        ASSERT_OK(context, test_collada_scene(context, cases[i].inside, &scene));
        assert_int_equal(scene->triangle_count, 0);
        assert_int_equal(test_log_has("bad-faces"), 1);
        assert_non_null(strstr(test_log_text(), cases[i].words));
        assert_non_null(strstr(test_log_text(), "left out"));
        alp_scene_destroy(scene);
    }
}

/// Text as it stands, not inside <COLLADA>.
static alp_result read_text(alp_context *context, const char *text)
{
    alp_scene *scene = NULL;
    alp_result result = test_collada_bytes(context, text, strlen(text), &scene);
    alp_scene_destroy(scene);
    return result;
}

TEST_WITH_CONTEXT(other_text, 1)
{
    assert_int_equal(read_text(context, ""), ALP_ERROR_INVALID_DATA);
    test_message_has(context, "empty");
    assert_int_equal(read_text(context, "no XML"), ALP_ERROR_INVALID_DATA);
    assert_int_equal(read_text(context, "<html/>"), ALP_ERROR_INVALID_DATA);
    test_message_has(context, "no COLLADA");
    assert_int_equal(read_text(context, "<COLLADA version=\"1.3.1\"/>"), ALP_ERROR_UNSUPPORTED);
    assert_int_equal(read_text(context, "<?xml version=\"1.0\" encoding=\"UTF-7\"?><COLLADA/>"),
                     ALP_ERROR_UNSUPPORTED);
    test_message_has(context, "UTF-7");
}

/// The first cause of text that is no XML, its place and a remedy; not those that follow from it.
TEST_WITH_CONTEXT(causes, 1)
{
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"<COLLADA>\n<a>x & y</a></COLLADA>", "XML, line 2 column 7: a bare \"&\"; write &amp;"},
        {"<COLLADA>\n<a>x &y z</a></COLLADA>", "line 2 column 8: a bare \"&\""},
        {"<COLLADA>\n<a b='x & y'/></COLLADA>", "line 2 column 10: a bare \"&\""},
        {"<COLLADA><a>&nbsp;</a></COLLADA>", "an entity that XML does not have"},
        {"<COLLADA><a b='x < y'/></COLLADA>", "a bare \"<\" in an attribute; write &lt;"},
        {"<COLLADA><a>x < y</a></COLLADA>", "begins no element; write &lt;"},
        {"<COLLADA><a>\x01</a></COLLADA>", "a control character"},
        {"<COLLADA><a b='1' b='2'/></COLLADA>", "is there twice"},
        {"<?xml version='1.0' encoding='shift_jis'?><COLLADA>\xff\xfe</COLLADA>",
         "not of the encoding that the file states; save it as UTF-8"},
        {"\n<?xml version='1.0'?><COLLADA/>", "not at the very beginning"},
        {"COLLADA", "so it is no XML"},
        {"<COLLADA><a>", "it may be truncated"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(read_text(context, cases[i].text), ALP_ERROR_INVALID_DATA);
        test_message_has(context, cases[i].words);
    }
}

/// A billion laughs, a file of the machine, a file of the net: refused where they are declared.
TEST_WITH_CONTEXT(entities, 1)
{
    static const char *const texts[] = {
        "<!DOCTYPE COLLADA [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;&a;\">]><COLLADA>&b;</COLLADA>",
        "<!DOCTYPE COLLADA [<!ENTITY x SYSTEM \"file:///etc/passwd\">]><COLLADA>&x;</COLLADA>",
        "<!DOCTYPE COLLADA [<!ENTITY % x SYSTEM \"http://localhost/x\"> %x;]><COLLADA/>"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        assert_int_equal(read_text(context, texts[i]), ALP_ERROR_UNSUPPORTED);
        test_message_has(context, "line 1");
    }
    // named from outside: it is not opened, so nothing is missed
    ASSERT_OK(context,
              read_text(context, "<!DOCTYPE COLLADA SYSTEM \"http://localhost/x\"><COLLADA/>"));
}

TEST_WITH_CONTEXT(nesting, 1)
{
    enum { DEEP = 100000 };
    char *text = malloc(DEEP * 3 + 32);
    assert_non_null(text);
    size_t at = (size_t)sprintf(text, "<COLLADA>");
    for (int i = 0; i < DEEP; i++) {
        memcpy(text + at, "<a>", 3);
        at += 3;
    }
    text[at] = '\0';
    assert_int_equal(read_text(context, text), ALP_ERROR_LIMIT);
    test_message_has(context, "1000");
    free(text);
}

/// Thirty nodes that each show the next twice: a thousand million at the end.
TEST_WITH_CONTEXT(doubling, 1)
{
    static char text[8000];
    size_t at = (size_t)sprintf(text, "<library_nodes>");
    for (int i = 0; i < 30; i++) {
        at += (size_t)sprintf(text + at,
                              "<node id='a%d'><instance_node url='#a%d'/><instance_node "
                              "url='#a%d'/></node>",
                              i, i + 1, i + 1);
    }
    sprintf(text + at,
            "<node id='a30'/></library_nodes><library_visual_scenes><visual_scene id='s'><node>"
            "<instance_node url='#a0'/></node></visual_scene></library_visual_scenes>%s",
            TEST_COLLADA_SCENE);
    alp_scene *scene = NULL;
    assert_int_equal(test_collada_scene(context, text, &scene), ALP_ERROR_LIMIT);
    test_message_has(context, "4194304");
}

/// What EXPECT.tsv says of the crafted files.
TEST(crafted)
{
    static const struct {
        const char *file;
        alp_result result;
        uint32_t triangles;
        double area;
    } cases[] = {
        {"index_out_of_range.dae", ALP_OK, 0, 0.0}, // with a warning
        {"missing_source.dae", ALP_OK, 0, 0.0},
        {"truncated.dae", ALP_ERROR_INVALID_DATA, 0, 0.0},
        {"no_geometry.dae", ALP_OK, 0, 0.0},
        {"polygons_with_hole.dae", ALP_OK, 8, 8.0},
        {"polylist_mixed.dae", ALP_OK, 6, 4.5}, // 1/2 + 1 + 3
        {"tristrips_trifans.dae", ALP_OK, 4, 2.0},
        {"z_up_inches.dae", ALP_OK, 2, 0.254 * 0.254},
    };
    if (test_shared("scenes") == NULL) {
        skip();
    }
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char relative[128];
        snprintf(relative, sizeof relative, "scenes/broken/crafted/%s", cases[i].file);
        alp_context *context = test_context(1);
        alp_scene *scene = NULL;
        assert_int_equal(alp_scene_load(context, test_shared(relative), &scene), cases[i].result);
        if (cases[i].result == ALP_OK) {
            assert_int_equal(scene->triangle_count, cases[i].triangles);
            ASSERT_NEAR(scene->area, cases[i].area, 1e-6 * cases[i].area); // floats
        } else {
            test_message_has(context, "line ");
        }
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}
