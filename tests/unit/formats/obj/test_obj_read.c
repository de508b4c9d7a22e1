// SPDX-License-Identifier: MIT
// OBJ statements: what they make of a scene, in closed forms; what is refused, with its line.
#include "test_gltf.h"
#include "test_obj.h"

#include "formats/obj/obj.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

/// All the ways to say the same triangle.
TEST_WITH_CONTEXT(ways_to_say_it, 1)
{
    static const char *const texts[] = {
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3", // no line end
        "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n",
        "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r", // as Macs once ended lines
        "\xef\xbb\xbfv\t0  0\t0 \n\n  v 1 0 0\nv 0 1 0\t\n   f  1\t2 3  \n",
        "# v 9 9 9 \\\nv 0 0 0 # a\nv 1 0 0 # b\nv 0 1 0\nf 1 2 3 # f 3 2 1\n",
        "v 0 0 \\\n0\nv 1 \\\r\n 0 0\nv 0 1 0\nf 1 \\\n2 \\\n\\\n3\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n",
        "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n",                    // before its vertices
        "v 0 0 0 1.0\nv 1 0 0 0.5 0.25 1\nv 0 1 0 nan\nf 1 2 3\n", // weights and colours
        "v +0 -0 0.\nv 1e0 .0 0E5\nv 0 10.0e-1 0\nfo 1/ 2/ 3//\n",
        "vt 0 0\nvn 0 0 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2/1 3/1/1\n",
        "s 1\ng\no\nusemtl\nmtllib\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\ns off\nend\n"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        alp_scene *scene = test_obj_scene(context, texts[i]);
        assert_int_equal(scene->triangle_count, 1);
        assert_int_equal(scene->surface_count, 1);
        assert_string_equal(scene->surfaces[0].name, "test");
        assert_int_equal(scene->surfaces[0].material, ALPI_NONE);
        static const float wanted[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        for (int k = 0; k < 3; k++) {
            const uint32_t v = scene->triangles[0][k];
            for (int axis = 0; axis < 3; axis++) {
                ASSERT_NEAR(scene->positions[v][axis], wanted[k][axis], 0.0);
                ASSERT_NEAR(scene->normals[v][axis], axis == 2, 0.0);
            }
        }
        alp_scene_destroy(scene);
    }
}

/// v counts from the bottom, and one set serves as the first and as the second.
TEST_WITH_CONTEXT(normals_and_coordinates, 1)
{
    alp_scene *scene =
        test_obj_scene(context, SQUARE "vt 0.25 0.125 7\nvt 1\nvt -2 1.5\nvn 0 0 2\nvn 0 1 0\n"
                                       "f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4//2\n");
    assert_int_equal(scene->vertex_count, 4); // alike in all three indices
    assert_int_equal(scene->surfaces[0].uv_sets, 2);
    assert_false(scene->surfaces[0].normals_generated);
    static const float uvs[4][2] = {{0.25f, 0.875f}, {1.0f, 1.0f}, {-2.0f, -0.5f}, {0, 0}};
    for (int v = 0; v < 4; v++) {
        for (int set = 0; set < 2; set++) {
            ASSERT_NEAR(scene->uvs[set][v][0], uvs[v][0], 0.0);
            ASSERT_NEAR(scene->uvs[set][v][1], uvs[v][1], 0.0);
        }
        ASSERT_NEAR(scene->normals[v][v < 3 ? 2 : 1], 1.0, 0.0);
        assert_int_equal(scene->vertex_source[v], v);
    }
    alp_scene_destroy(scene);
    // a corner without a normal makes its face flat, with vertices of its own, and no other
    scene = test_obj_scene(context, SQUARE "vn 0 1 0\nf 1//1 2//1 3//1\nf 1//1 3//1 4\n");
    assert_int_equal(scene->vertex_count, 6);
    ASSERT_NEAR(scene->normals[0][1], 1.0, 0.0);
    ASSERT_NEAR(scene->normals[3][2], 1.0, 0.0);
    assert_true(scene->surfaces[0].normals_generated);
    assert_null(scene->uvs[0]);
    alp_scene_destroy(scene);
}

/// Negative indices count from what there is at that line.
TEST_WITH_CONTEXT(relative_indices, 1)
{
    alp_scene *scene = test_obj_scene(
        context, "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf -3/-1/-1 -2/-1/-1 -1/-1/-1\n"
                 "v 5 0 0\nv 6 0 0\nv 5 1 0\nvt 1 1\nvn 0 0 1\nf -3/-1/-1 -2/-1/-1 -1/-1/-1\n");
    ASSERT_NEAR(scene->positions[scene->triangles[1][0]][0], 5.0, 0.0);
    ASSERT_NEAR(scene->uvs[0][scene->triangles[1][0]][0], 1.0, 0.0);
    ASSERT_NEAR(scene->area, 1.0, 0.0);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(many_corners, 1)
{
    static const struct {
        const char *text;
        uint32_t triangles;
        double area;
    } cases[] = {
        {SQUARE "f 1 2 3 4\n", 2, 1.0},
        {"v 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\nf 1 2 3 4 5 6\n", 4, 3.0},
        {"v 0 0 0\nv 0 4 4\nv 0 1 0\nv 0 4 -4\nf 1 2 3 4\n", 2, 4.0}, // an arrow in x = 0
        {SQUARE "vn 0 0 1\nvt 0 0\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf 4 3 2 1\n", 4, 2.0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_scene *scene = test_obj_scene(context, cases[i].text);
        assert_int_equal(scene->triangle_count, cases[i].triangles);
        assert_int_equal(scene->usable_count, cases[i].triangles);
        ASSERT_NEAR(scene->area, cases[i].area, 1e-12);
        alp_scene_destroy(scene);
    }
    // one face of 20 thousand corners on one long line, a circle: area of a regular n-gon
    enum { CORNERS = 20000 };
    char *text = malloc((size_t)CORNERS * 64), *at = text;
    for (int i = 0; i < CORNERS; i++) {
        at += sprintf(at, "v %.9g %.9g 0\n", cos(2.0 * ALPI_PI * i / CORNERS),
                      sin(2.0 * ALPI_PI * i / CORNERS));
    }
    at += sprintf(at, "f");
    for (int i = 1; i <= CORNERS; i++) {
        at += sprintf(at, " %d", i);
    }
    alp_scene *scene = test_obj_scene(context, text);
    assert_int_equal(scene->triangle_count, CORNERS - 2);
    // corners are rounded to 2^-25, an edge of 3e-4 by that much: 1e-4 of the excess, far less of
    // the whole
    ASSERT_NEAR(scene->area, 0.5 * CORNERS * sin(2.0 * ALPI_PI / CORNERS), 1e-6);
    alp_scene_destroy(scene);
    free(text);
}

/// Surfaces are what is alike in object, group and material, in the order of first use.
TEST_WITH_CONTEXT(objects_and_groups, 1)
{
    static const char text[] =
        SQUARE "f 1 2 3\no My chair\nf 1 2 3\ng legs\nusemtl red wood\nf 1 2 3\nf 1 3 4\n"
               "usemtl blue\nf 1 2 3\ng default\nf 1 3 4\no table\ng table\nf 1 2 3\n"
               "o My chair\ng legs\nusemtl red wood\nf 2 3 4\ng a  b\nf 1 2 3\n";
    static const struct {
        const char *name;
        uint32_t triangles, node, primitive;
    } wanted[] = {{"test", 1, 0, 0},          {"My chair", 1, 1, 0}, {"My chair/legs", 3, 2, 0},
                  {"My chair/legs", 1, 2, 1}, {"My chair", 1, 1, 1}, {"table", 1, 3, 0},
                  {"My chair/a  b", 1, 4, 0}};
    test_log_clear();
    alp_scene *scene = test_obj_scene(context, text);
    assert_int_equal(scene->surface_count, sizeof wanted / sizeof *wanted);
    uint32_t triangle = 0;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const alpi_surface *surface = &scene->surfaces[s];
        assert_string_equal(surface->name, wanted[s].name);
        assert_int_equal(surface->triangle_count, wanted[s].triangles);
        assert_int_equal(surface->first_triangle, triangle);
        assert_int_equal(surface->node, wanted[s].node);
        assert_int_equal(surface->primitive, wanted[s].primitive);
        for (uint32_t t = 0; t < surface->triangle_count; t++) {
            assert_int_equal(scene->triangle_surface[triangle++], s);
        }
    }
    assert_true(test_log_has("material")); // neither is anywhere
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(left_out, 1)
{
    test_log_clear();
    alp_scene *scene = test_obj_scene(
        context, SQUARE "p 1\nl 1 2 3\nf 1\nf 1 2\nf\nf 1 2 3\ncurv 0 1 \\\n 1 2 3\nvp 0 1\n");
    assert_int_equal(scene->triangle_count, 1);
    assert_non_null(strstr(test_log_text(), "2 statements of lines and points"));
    assert_non_null(strstr(test_log_text(), "3 faces of less than three corners"));
    assert_non_null(
        strstr(test_log_text(), "2 statements have no part in the bake, such as \"curv\""));
    assert_true(test_log_has("unit"));
    alp_scene_destroy(scene);
    test_log_clear(); // only points
    scene = test_obj_scene(context, SQUARE "p 1 2 3\n");
    assert_int_equal(scene->triangle_count, 0);
    assert_true(test_log_has("no-triangles"));
    alp_scene_destroy(scene);
    test_log_clear(); // finite, but too far out for a ray
    scene = test_obj_scene(context, SQUARE "v 1e30 0 0\nv -1e38 3e38 0\nf 1 2 3\nf 1 5 6\n");
    assert_int_equal(scene->usable_count, 1);
    assert_true(test_log_has("bad-coordinates"));
    alp_scene_destroy(scene);
}

/// Faces that name coordinates or normals of which the file has none are read without.
TEST_WITH_CONTEXT(missing_data, 1)
{
    static const struct {
        const char *text, *words;
    } cases[] = {
        {SQUARE "vn 0 1 0\nf 1/1/1 2/2/1 3/3/1\n",
         "texture coordinates (vt), of which the file has none: 1;"},
        {SQUARE "vt 0 0\nf 1/1/1 2/1/2 3/1/3\nf 1/1/7 3 4\n",
         "normals (vn), of which the file has none: 2;"},
        {SQUARE "f 1/-1 2/-2 3/-3\n", "texture coordinates (vt), of which the file has none: 1;"},
        {SQUARE "f 1//-1 2//-1 3//-1\n", "normals (vn), of which the file has none: 1;"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        test_log_clear();
        alp_scene *scene = test_obj_scene(context, cases[i].text);
        assert_non_null(strstr(test_log_text(), cases[i].words));
        ASSERT_NEAR(scene->area, i == 1 ? 1.0 : 0.5, 1e-12);
        assert_int_equal(scene->uvs[0] != NULL, i == 1);
        ASSERT_NEAR(fabsf(scene->normals[0][i == 0 ? 1 : 2]), 1.0, 0.0);
        alp_scene_destroy(scene);
    }
}

/// Three numbers behind a position are a colour for screens; of four the last is an alpha.
TEST_WITH_CONTEXT(colours_of_vertices, 1)
{
    test_log_clear();
    alp_scene *scene = test_obj_scene(
        context, "v 0 0 0 0.5\nv 1 0 0 1 0.5 0\nv 0 1 0 0.25 0.5 1 0.1\nv 0 0 1 nan\nf 1 2 3\n"
                 "f 1 2 4\n");
    const float wanted[4][3] = {
        {1, 1, 1}, {1, 0.21404114f, 0}, {0.05087609f, 0.21404114f, 1}, {1, 1, 1}};
    assert_non_null(scene->colors);
    for (uint32_t t = 0; t < 2; t++) {
        for (int k = 0; k < 3; k++) {
            const float *color = scene->colors[scene->triangles[t][k]];
            const float *want = wanted[t == 1 && k == 2 ? 3 : k];
            for (int c = 0; c < 3; c++) {
                ASSERT_NEAR(color[c], want[c], 1e-6); // IEC 61966-2-1
            }
            ASSERT_NEAR(color[3], 1.0, 0.0);
        }
    }
    // without a material the colour is the albedo
    ASSERT_NEAR(alpi_surface_albedo(scene, 0, 1.0f, 0.0f).y, 0.21404114f, 1e-6);
    assert_false(test_log_has("vertex-colors"));
    alp_scene_destroy(scene);
    scene = test_obj_scene(context, "v 0 0 0 255 0 51\nv 1 0 0 0 0 0\nv 0 1 0 0 0 0\nf 1 2 3\n");
    ASSERT_NEAR(scene->colors[0][0], 1.0, 1e-6);
    ASSERT_NEAR(scene->colors[0][2], 0.03310477f, 1e-6); // 0.2
    assert_true(test_log_has("vertex-colors"));
    alp_scene_destroy(scene);
    scene = test_obj_scene(context, SQUARE "f 1 2 3\n");
    assert_null(scene->colors);
    alp_scene_destroy(scene);
}

/// UTF-16 with a mark or without one, of both orders.
TEST_WITH_CONTEXT(wide_texts, 1)
{
    static const char text[] = "o caf\xc3\xa9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    static const uint16_t name[] = {'o', ' ', 'c', 'a', 'f', 0xe9};
    for (int i = 0; i < 4; i++) {
        uint8_t wide[256];
        size_t size = 0;
        const bool big = i & 1, marked = (i & 2) != 0;
        for (size_t k = marked ? 0 : 1; k <= sizeof text - 2; k++) { // 0: the mark
            const size_t at = k - 1;
            const uint16_t unit = k == 0 ? 0xfeff : at < 6 ? name[at] : (uint16_t)text[at + 1];
            wide[size++] = (uint8_t)(big ? unit >> 8 : unit);
            wide[size++] = (uint8_t)(big ? unit : unit >> 8);
        }
        alp_scene *scene = NULL;
        ASSERT_OK(context, alpi_obj_scene_from_bytes(context, "wide.obj", wide, size, &scene));
        ASSERT_NEAR(scene->area, 0.5, 0.0);
        assert_string_equal(scene->surfaces[0].name, "caf\xc3\xa9");
        alp_scene_destroy(scene);
    }
}

TEST_WITH_CONTEXT(refused, 1)
{
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"", "test.obj: nothing to bake: it holds no vertices"},
        {"\x7f"
         "ELF\x02\x01\n\n",
         "is it an OBJ file?"},
        {"v 1 2\n", "line 1: v has too few numbers"},
        {"\n\nv 1 nan 2\n", "line 3: v: \"nan\" is no finite decimal number"},
        {"v 1 2 -inf\n", "line 1: v: \"-inf\" is no"},
        {"v 1e400 1 0\n", "line 1: v: \"1e400\" is beyond 3.4e38"},
        {"v 0 -1e39 0\n", "line 1: v: \"-1e39\" is beyond 3.4e38"},
        {SQUARE "vt 0 1e39\n", "line 5: vt: \"1e39\" is beyond"},
        {"v 1,5 2 3\n", "line 1: v: \"1,5\" is no"},
        {"v 0x1 2 3\n", "line 1: v: \"0x1\" is no"},
        {"v 1.#IND 2 3\n", "line 1: v: \"1.#IND\" is no"},
        {SQUARE "vt\n", "line 5: vt has too few"},
        {SQUARE "vt 0 inf\n", "line 5: vt: \"inf\""},
        {SQUARE "f 1 2 5\n", "line 5: f: vertex 5 of 4"},
        {SQUARE "f 0 1 2\n", "line 5: f: \"0\" is no corner"},
        {SQUARE "f 1 2 -5\n", "line 5: f: \"-5\" is no corner"},
        {SQUARE "vt 0 0\nf 1/1 2/1 3/2\n", "line 6: f: texture coordinate 2 of 1"},
        {SQUARE "vn 0 0 1\nf 1//1 2//1 3//2\n", "line 6: f: normal 2 of 1"},
        {SQUARE "f 1/-1 2/-1 3/-1\nvt 0 0\n", "line 5: f: a texture coordinate before the first"},
        {SQUARE "f 1/0 2 3\n", "\"1/0\" is no corner"},
        {SQUARE "f 1/2/3/4 2 3\n", "\"1/2/3/4\" is no corner"},
        {SQUARE "f a b c\n", "\"a\" is no corner"},
        {SQUARE "f 1 2 3x\n", "\"3x\" is no corner"},
        {SQUARE "f 99999999999999999999 1 2\n", "is no corner"},
        {SQUARE "f 1 2 \\\n3 \\\n- 4\n", "line 7: f: \"-\" is no corner"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_scene *scene = NULL;
        assert_int_equal(test_obj_read(context, NULL, cases[i].text, &scene),
                         ALP_ERROR_INVALID_DATA);
        assert_null(scene);
        test_message_has(context, cases[i].words);
        test_message_has(context, "test.obj: ");
    }
}

/// A bad normal costs itself: its corners have the normal of their triangle, others keep theirs.
TEST_WITH_CONTEXT(bad_normals, 1)
{
    static const char *const bad[] = {"a b c", "nan 0 0", "0 1", ""};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char text[256];
        snprintf(text, sizeof text, SQUARE "vn %s\nvn 1 0 0\nf 1//1 2//2 3//2\n", bad[i]);
        test_log_clear();
        alp_scene *scene = test_obj_scene(context, text);
        assert_int_equal(scene->usable_count, 1);
        const float *own = scene->normals[scene->triangles[0][0]];
        vec3 c[3];
        alpi_triangle_corners(scene, 0, c);
        vec3 flat = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 0.0f, 0.0f});
        ASSERT_NEAR(vec3_dot(vec3_load(own), flat), 1.0, 1e-6);
        ASSERT_NEAR(scene->normals[scene->triangles[0][1]][0], 1.0, 0.0);
        assert_non_null(strstr(test_log_text(), "bad-normals test.obj: line 5: vn"));
        alp_scene_destroy(scene);
    }
}

/// The same bytes again and again: fan-in of vertices, names and surfaces is not quadratic.
TEST_WITH_CONTEXT(many_names, 1)
{
    enum { COUNT = 50000 };
    char *text = malloc((size_t)COUNT * 64 + 128), *at = text;
    at += sprintf(at, SQUARE "vn 0 0 1\n");
    for (int i = 0; i < COUNT; i++) {
        at += sprintf(at, "vt %d 0\ng name%d\nusemtl m%d\nf 1/-1/1 2/-1/1 3/-1/1\n", i, i % 1000,
                      i % 7);
    }
    alp_scene *scene = test_obj_scene(context, text);
    assert_int_equal(scene->surface_count, 7000);
    assert_int_equal(scene->triangle_count, COUNT);
    assert_int_equal(scene->vertex_count, 3 * COUNT); // one position, all coordinates differ
    alp_scene_destroy(scene);
    free(text);
}
