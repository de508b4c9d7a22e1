// SPDX-License-Identifier: MIT
// COLLADA of a few megabytes on which work that grows as the square would take minutes or
// gigabytes: read in seconds, or refused with the limit's number. No time is measured: the runner's
// limit for a test is what it must stay below.
#include "test_collada.h"

#include "formats/text/text_edits.h"

#include <string.h>

enum { MANY = 100000 };

#define SHOW(instances)                                                                            \
    "<library_visual_scenes><visual_scene id='s'>" instances                                       \
    "</visual_scene></library_visual_scenes>" TEST_COLLADA_SCENE

/// A text that is being made, in its context.
typedef struct fixture {
    alp_context *context;
    alpi_bytes text;
    alp_scene *scene;
} fixture;

static fixture start(const char *begin)
{
    fixture f = {.context = test_context(1)};
    f.text = alpi_bytes_create(f.context);
    alpi_bytes_print(&f.text, "%s", begin);
    return f;
}

static void print_times(fixture *f, uint32_t count, const char *text)
{
    for (uint32_t i = 0; i < count; i++) {
        alpi_bytes_print(&f->text, "%s", text);
    }
}

static alp_result read(fixture *f, const char *end)
{
    alpi_bytes_print(&f->text, "%s", end);
    alpi_bytes_add(&f->text, "", 1);
    assert_false(f->text.failed);
    return test_collada_scene(f->context, (const char *)f->text.bytes, &f->scene);
}

static void finish(fixture *f)
{
    alp_scene_destroy(f->scene);
    alpi_bytes_destroy(&f->text);
    alp_context_destroy(f->context);
}

#define FIRST_PART                                                                                 \
    "<library_geometries><geometry id='g'><mesh><source id='p'><float_array id='pa' count='9'>0 "  \
    "0 "                                                                                           \
    "0 1 0 0 1 1 0</float_array><technique_common><accessor source='#pa' count='3' stride='3'/>"   \
    "</technique_common></source><vertices id='v'><input semantic='POSITION' source='#p'/>"        \
    "</vertices>"

/// As many materials bound as there are primitives, and as many coordinate sets at one of them.
TEST_SLOW(bindings)
{
    fixture f = start(
        "<library_images><image id='i'><init_from>none.png</init_from></image></library_images>"
        "<library_effects><effect id='e'><profile_COMMON><technique><lambert><diffuse><texture "
        "texture='i' texcoord='uv7'/></diffuse></lambert></technique></profile_COMMON></effect>"
        "</library_effects><library_materials><material id='m'><instance_effect url='#e'/>"
        "</material></library_materials>" FIRST_PART);
    for (int i = 0; i < MANY; i++) {
        alpi_bytes_print(&f.text,
                         "<triangles material='m%d'>" TEST_COLLADA_INPUT "<p>0 1 2</p></triangles>",
                         i % 2 ? i : 0);
    }
    alpi_bytes_print(&f.text, "</mesh></geometry></library_geometries>"
                              "<library_visual_scenes><visual_scene id='s'><node>"
                              "<instance_geometry url='#g'><bind_material><technique_common>");
    for (int i = MANY; i-- > 0;) {
        alpi_bytes_print(&f.text, "<instance_material symbol='m%d' target='#m'%s>", i,
                         i == 0 ? "" : "/");
    }
    for (int i = 0; i < MANY; i++) {
        alpi_bytes_print(&f.text, "<bind_vertex_input semantic='uv%d' input_set='0'/>", i + 8);
    }
    ASSERT_OK(f.context, read(&f, "</instance_material></technique_common></bind_material>"
                                  "</instance_geometry></node></visual_scene>"
                                  "</library_visual_scenes>" TEST_COLLADA_SCENE));
    assert_int_equal(f.scene->surface_count, MANY);
    for (uint32_t s = 0; s < MANY; s++) {
        assert_int_not_equal(f.scene->surfaces[s].material, ALPI_NONE);
    }
    finish(&f);
}

/// Each of them names its line.
TEST(warnings)
{
    fixture f = start("<library_geometries><geometry id='g'><mesh><source id='p'><float_array "
                      "id='pa' count='9'>0 0 0 1 0 0 1 1 0</float_array><technique_common>"
                      "<accessor source='#pa' count='3' stride='3'/></technique_common></source>"
                      "<vertices id='v'><input semantic='POSITION' source='#p'/></vertices>");
    print_times(&f, MANY,
                "<triangles>" TEST_COLLADA_INPUT "<p>0 1 2 0</p></triangles>\n"); // one left over
    ASSERT_OK(f.context, read(&f, "</mesh></geometry></library_geometries>" TEST_COLLADA_SHOWN));
    assert_int_equal(f.scene->triangle_count, MANY);
    finish(&f);
}

/// Many sources of one long array: it is read once.
TEST_SLOW(shared_array)
{
    fixture f = start("<library_geometries><geometry id='g'><mesh><source id='a'><float_array "
                      "id='fa' count='300000'>");
    print_times(&f, 300000, "0 ");
    alpi_bytes_print(&f.text, "</float_array></source>");
    for (int i = 0; i < MANY / 2; i++) {
        alpi_bytes_print(&f.text,
                         "<source id='s%d'><technique_common><accessor source='#fa' count='100000' "
                         "stride='3'/></technique_common></source><vertices id='v%d'><input "
                         "semantic='POSITION' source='#s%d'/></vertices><triangles><input "
                         "semantic='VERTEX' source='#v%d' offset='0'/><p>0 1 2</p></triangles>",
                         i, i, i, i);
    }
    ASSERT_OK(f.context, read(&f, "</mesh></geometry></library_geometries>" TEST_COLLADA_SHOWN));
    assert_int_equal(f.scene->surface_count, MANY / 2);
    finish(&f);
}

/// A geometry that is no mesh, long, and shown often.
TEST(no_mesh)
{
    fixture f = start("<library_geometries><geometry id='g'>");
    print_times(&f, MANY, "<extra/>");
    alpi_bytes_print(&f.text, "</geometry></library_geometries>"
                              "<library_visual_scenes><visual_scene id='s'><node>");
    print_times(&f, MANY, "<instance_geometry url='#g'/>");
    ASSERT_OK(f.context,
              read(&f, "</node></visual_scene></library_visual_scenes>" TEST_COLLADA_SCENE));
    finish(&f);
}

/// Many empty primitives, shown many times: refused before they are counted one by one.
TEST(parts_times_places)
{
    fixture f = start(FIRST_PART);
    print_times(&f, MANY, "<lines/><triangles/>");
    alpi_bytes_print(&f.text, "</mesh></geometry></library_geometries>"
                              "<library_visual_scenes><visual_scene id='s'><node>");
    print_times(&f, MANY, "<instance_geometry url='#g'/>");
    assert_int_equal(read(&f, "</node></visual_scene></library_visual_scenes>" TEST_COLLADA_SCENE),
                     ALP_ERROR_LIMIT);
    assert_non_null(strstr(alp_context_message(f.context), "4194304"));
    finish(&f);
}

/// Twenty nodes that each show the next twice, and the last is long or is a million places.
TEST(doubling)
{
    for (int kind = 0; kind < 3; kind++) {
        fixture f = start("<library_nodes>");
        for (int i = 0; i < 20; i++) {
            alpi_bytes_print(
                &f.text,
                "<node id='a%d'><instance_node url='#a%d'/><instance_node url=' #a%d'/>"
                "</node>",
                i, i + 1, i + 1);
        }
        alpi_bytes_print(&f.text, "<node id='a20'>%s", kind == 0 ? "<scale>" : "");
        print_times(&f,
                    kind == 0   ? MANY
                    : kind == 1 ? 20
                                : 5,
                    kind == 0   ? "    "
                    : kind == 1 ? "<extra/>"
                                : "<instance_light url='#l'/>");
        alpi_bytes_print(&f.text, "%s</node></library_nodes>", kind == 0 ? "1 1 1</scale>" : "");
        assert_int_equal(read(&f, SHOW("<node><instance_node url='#a0'/></node>")),
                         ALP_ERROR_LIMIT);
        assert_non_null(strstr(alp_context_message(f.context), "16777216"));
        finish(&f);
    }
}

/// A skin that is looked into for each place, behind very many other elements.
TEST(long_controller)
{
    fixture f = start("<library_controllers><controller id='c'>");
    print_times(&f, MANY, "<extra></extra>");
    alpi_bytes_print(&f.text, "<skin source='#g'/></controller></library_controllers>" FIRST_PART
                              "</mesh></geometry></library_geometries>"
                              "<library_visual_scenes><visual_scene id='s'><node>");
    print_times(&f, MANY, "<instance_controller url='#c'/>");
    assert_int_equal(read(&f, "</node></visual_scene></library_visual_scenes>" TEST_COLLADA_SCENE),
                     ALP_ERROR_LIMIT);
    finish(&f);
}

TEST(inputs_and_attributes)
{
    fixture f = start("<library_geometries><geometry id='g'><mesh><vertices id='v'>");
    print_times(&f, MANY, "<input semantic='TANGENT' source='#p'/>");
    alpi_bytes_print(&f.text, "</vertices>");
    print_times(&f, MANY, "<triangles>" TEST_COLLADA_INPUT "</triangles>");
    test_log_clear();
    assert_int_equal(read(&f, "</mesh></geometry></library_geometries>" TEST_COLLADA_SHOWN),
                     ALP_OK);
    assert_int_equal(f.scene->triangle_count, 0);
    assert_int_equal(test_log_has("bad-faces"), 1);
    assert_non_null(strstr(test_log_text(), "more than 64 inputs"));
    assert_non_null(strstr(test_log_text(), "more primitives that are left out: 99984"));
    finish(&f);
    f = start("<node");
    for (int i = 0; i < MANY; i++) {
        alpi_bytes_print(&f.text, " a%d=''", i);
    }
    assert_int_equal(read(&f, "/>"), ALP_ERROR_LIMIT);
    assert_non_null(strstr(alp_context_message(f.context), "100000 attributes, more than 100"));
    finish(&f);
}
