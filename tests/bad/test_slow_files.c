// SPDX-License-Identifier: MIT
// Short files that once asked for minutes: what is named again and again is done once, counted, or
// refused. Without that each of these takes more than a minute, and the test times out.
#include "test_collada.h"
#include "test_gltf.h"
#include "test_obj.h"

#include "base/memory.h"
#include "formats/text/text_edits.h"

#include <stdlib.h>

static void repeat(alpi_bytes *text, const char *piece, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        alpi_bytes_print(text, "%s", piece);
    }
}

static const char *end_text(alpi_bytes *text)
{
    alpi_bytes_add(text, "", 1);
    assert_false(text->failed);
    return (const char *)text->bytes;
}

/// libxml2 tells of every "--" in a comment, and each takes as long as all before it.
TEST_WITH_CONTEXT(an_open_comment, 1)
{
    alpi_bytes text = alpi_bytes_create(context);
    repeat(&text, "<!--", 250000);
    alp_scene *scene = NULL;
    assert_int_equal(test_collada_scene(context, end_text(&text), &scene), ALP_ERROR_INVALID_DATA);
    test_message_has(context, "XML, line ");
    alpi_bytes_destroy(&text);
}

/// A library of 20,000 materials that is named 40,000 times, by one name and by many.
TEST_WITH_CONTEXT(a_library_of_many_names, 1)
{
    const char *folder = test_folder();
    alpi_bytes library = alpi_bytes_create(context), text = alpi_bytes_create(context);
    for (int i = 0; i < 20000; i++) {
        alpi_bytes_print(&library, "newmtl m%d\nKd 1 0 0\n", i);
    }
    test_write_text(test_path(folder, "a.mtl"), end_text(&library));
    alpi_bytes_print(&text, "v 0 0 0\nv 1 0 0\nv 0 1 0\nmtllib");
    repeat(&text, " a.mtl", 20000);
    for (size_t i = 0; i < 200; i++) {
        alpi_bytes_print(&text, "\nmtllib ");
        repeat(&text, "./", i);
        repeat(&text, " ./a.mtl", 100);
    }
    alpi_bytes_print(&text, "\nusemtl m7\nf 1 2 3\n");
    alp_scene *scene = NULL;
    ASSERT_OK(context, test_obj_read(context, folder, end_text(&text), &scene));
    assert_int_equal(scene->triangle_count, 1);
    ASSERT_NEAR(scene->materials[scene->surfaces[0].material].base_color[0], 1, 0);
    alp_scene_destroy(scene);
    alpi_bytes_destroy(&text);
    alpi_bytes_destroy(&library);
}

#define POINTS "'accessors':[{'componentType':5126,'type':'VEC3','count':3}]"
#define STEPS "take more than 268435456 steps"

/// One skin of 4096 joints for each of 100,000 nodes.
TEST_SLOW_WITH_CONTEXT(a_skin_for_all, 1)
{
    alpi_bytes text = alpi_bytes_create(context);
    alpi_bytes_print(&text, "{'asset':{'version':'2.0'}," POINTS ",'meshes':[{'primitives':[{"
                            "'attributes':{'POSITION':0}}]}],'skins':[{'joints':[0");
    repeat(&text, ",0", 4095);
    alpi_bytes_print(&text, "]}],'nodes':[{}");
    repeat(&text, ",{'mesh':0,'skin':0}", 100000);
    alpi_bytes_print(&text, "]}");
    alp_scene *scene = NULL;
    assert_int_equal(test_gltf_scene(context, end_text(&text), NULL, 0, &scene), ALP_ERROR_LIMIT);
    test_message_has(context, STEPS);
    alpi_bytes_destroy(&text);
}
