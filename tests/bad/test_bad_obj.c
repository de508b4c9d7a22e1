// SPDX-License-Identifier: MIT
// The crafted and collected broken OBJ files: refused with a message that names file and line, or
// read with finite data.
#include "test_gltf.h"
#include "test_obj.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/// The rows of EXPECT.tsv beside the crafted files, with our result for each.
static const struct {
    const char *file, *words; // of the error; NULL: it is read
    uint32_t triangles;
    double area;
    const char *warning;
} files[] = {
    {"crafted/concave_ngon.obj", NULL, 4, 3.0, NULL},
    {"crafted/crlf_tabs_continuation.obj", NULL, 1, 0.5, NULL},
    {"crafted/relative_indices.obj", NULL, 2, 1.0, NULL},
    {"crafted/missing_mtl.obj", NULL, 1, 0.5, "mtllib"},
    {"crafted/empty.obj", "empty.obj: nothing to bake", 0, 0, NULL},
    {"crafted/index_too_big.obj", "line 4: f: vertex 9 of 3", 0, 0, NULL},
    {"crafted/index_zero.obj", "line 4: f: \"0\" is no corner", 0, 0, NULL},
    {"crafted/nan.obj", "line 1: v: \"nan\"", 0, 0, NULL},
    {"third_party/test-nan.obj", "line 12: v: \"nan\"", 0, 0, NULL},
    {"third_party/issue-140-zero-face-idx.obj", "line 16: f: \"0/0/0\"", 0, 0, NULL},
    {"third_party/invalid-face-definition.obj", NULL, 0, 0.0, "bad-faces"},
};

TEST_WITH_CONTEXT(every_file, 1)
{
    if (test_shared("scenes") == NULL) {
        skip();
    }
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        alp_scene *scene = NULL;
        test_log_clear();
        const char *path = test_path(test_shared("scenes/broken"), files[i].file);
        const alp_result result = alp_scene_load(context, path, &scene);
        if (files[i].words != NULL) {
            assert_int_equal(result, ALP_ERROR_INVALID_DATA);
            assert_null(scene);
            test_message_has(context, files[i].words);
            continue;
        }
        ASSERT_OK(context, result);
        assert_int_equal(scene->triangle_count, files[i].triangles);
        ASSERT_NEAR(scene->area, files[i].area, 1e-12);
        for (uint32_t v = 0; v < scene->vertex_count; v++) {
            assert_true(vec3_is_finite(vec3_load(scene->positions[v])));
            ASSERT_NEAR(vec3_length(vec3_load(scene->normals[v])), 1.0, 1e-6);
        }
        assert_true(files[i].warning == NULL || test_log_has(files[i].warning));
        if (scene->triangle_count == 0) {
            assert_int_equal(alp_bake(scene, NULL, NULL, NULL), ALP_ERROR_INVALID_DATA);
            test_message_has(context, "nothing to bake");
        }
        alp_scene_destroy(scene);
    }
}

/// The table above has every OBJ of EXPECT.tsv.
TEST(table_is_complete)
{
    const char *table = test_shared("scenes/broken/crafted/EXPECT.tsv");
    if (table == NULL) {
        skip();
    }
    size_t size;
    char *text = (char *)test_read_file(table, &size);
    int found = 0;
    for (char *rest = text, *line; (line = strtok_r(rest, "\n", &rest)) != NULL;) {
        char *fields = line, name[256];
        snprintf(name, sizeof name, "crafted/%s", strtok_r(fields, "\t", &fields));
        if (strstr(name, ".obj") == NULL) {
            continue;
        }
        bool known = false;
        for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
            known = known || strcmp(files[i].file, name) == 0;
        }
        if (!known) {
            fail_msg("%s is not in the table", name);
        }
        found++;
    }
    free(text);
    assert_in_range(found, 8, 1000);
}
