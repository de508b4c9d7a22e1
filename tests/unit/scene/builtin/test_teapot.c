// SPDX-License-Identifier: MIT
// The teapot: patches of the published set, closed but for the known gaps; and the closed shell of
// the room it stands in.
#include "test_support.h"

#include "scene/builtin/teapot.h"

#include <math.h>
#include <stdlib.h>

enum { SEGMENTS = 5 };

/// The teapot alone, in published units.
static alp_scene *teapot(alp_context *context, uint32_t segments)
{
    alpi_builder builder;
    alpi_builder_start(&builder, context, "teapot");
    alpi_builder_surface(&builder, "teapot",
                         alpi_builder_material(&builder, "china", (vec3){0.5f, 0.5f, 0.5f},
                                               (vec3){0.0f, 0.0f, 0.0f}));
    alpi_builder_teapot(&builder,
                        &(alpi_teapot){.height = ALPI_TEAPOT_HEIGHT, .segments = segments});
    alp_scene *scene = NULL;
    ASSERT_OK(context, alpi_builder_finish(&builder, &scene));
    return scene;
}

/// Control points of ten of the published patches, z up, as listed: rim, body, lower body, knob,
/// lid, bottom, and the halves with y ≤ 0 of handle and spout.
static const double PUBLISHED[][16][3] = {
    {{1.4, 0, 2.4},
     {1.4, -0.784, 2.4},
     {0.784, -1.4, 2.4},
     {0, -1.4, 2.4},
     {1.3375, 0, 2.53125},
     {1.3375, -0.749, 2.53125},
     {0.749, -1.3375, 2.53125},
     {0, -1.3375, 2.53125},
     {1.4375, 0, 2.53125},
     {1.4375, -0.805, 2.53125},
     {0.805, -1.4375, 2.53125},
     {0, -1.4375, 2.53125},
     {1.5, 0, 2.4},
     {1.5, -0.84, 2.4},
     {0.84, -1.5, 2.4},
     {0, -1.5, 2.4}},
    {{1.5, 0, 2.4},
     {1.5, -0.84, 2.4},
     {0.84, -1.5, 2.4},
     {0, -1.5, 2.4},
     {1.75, 0, 1.875},
     {1.75, -0.98, 1.875},
     {0.98, -1.75, 1.875},
     {0, -1.75, 1.875},
     {2, 0, 1.35},
     {2, -1.12, 1.35},
     {1.12, -2, 1.35},
     {0, -2, 1.35},
     {2, 0, 0.9},
     {2, -1.12, 0.9},
     {1.12, -2, 0.9},
     {0, -2, 0.9}},
    {{-2, 0, 0.9},
     {-2, 1.12, 0.9},
     {-1.12, 2, 0.9},
     {0, 2, 0.9},
     {-2, 0, 0.45},
     {-2, 1.12, 0.45},
     {-1.12, 2, 0.45},
     {0, 2, 0.45},
     {-1.5, 0, 0.225},
     {-1.5, 0.84, 0.225},
     {-0.84, 1.5, 0.225},
     {0, 1.5, 0.225},
     {-1.5, 0, 0.15},
     {-1.5, 0.84, 0.15},
     {-0.84, 1.5, 0.15},
     {0, 1.5, 0.15}},
    {{0, 0, 3.15},
     {0, 0, 3.15},
     {0, 0, 3.15},
     {0, 0, 3.15},
     {0.8, 0, 3.15},
     {0.8, -0.45, 3.15},
     {0.45, -0.8, 3.15},
     {0, -0.8, 3.15},
     {0, 0, 2.85},
     {0, 0, 2.85},
     {0, 0, 2.85},
     {0, 0, 2.85},
     {0.2, 0, 2.7},
     {0.2, -0.112, 2.7},
     {0.112, -0.2, 2.7},
     {0, -0.2, 2.7}},
    {{0.2, 0, 2.7},
     {0.2, -0.112, 2.7},
     {0.112, -0.2, 2.7},
     {0, -0.2, 2.7},
     {0.4, 0, 2.55},
     {0.4, -0.224, 2.55},
     {0.224, -0.4, 2.55},
     {0, -0.4, 2.55},
     {1.3, 0, 2.55},
     {1.3, -0.728, 2.55},
     {0.728, -1.3, 2.55},
     {0, -1.3, 2.55},
     {1.3, 0, 2.4},
     {1.3, -0.728, 2.4},
     {0.728, -1.3, 2.4},
     {0, -1.3, 2.4}},
    {{0, 0, 0},
     {0, 0, 0},
     {0, 0, 0},
     {0, 0, 0},
     {1.425, 0, 0},
     {1.425, 0.798, 0},
     {0.798, 1.425, 0},
     {0, 1.425, 0},
     {1.5, 0, 0.075},
     {1.5, 0.84, 0.075},
     {0.84, 1.5, 0.075},
     {0, 1.5, 0.075},
     {1.5, 0, 0.15},
     {1.5, 0.84, 0.15},
     {0.84, 1.5, 0.15},
     {0, 1.5, 0.15}},
    {{-1.6, 0, 2.025},
     {-1.6, -0.3, 2.025},
     {-1.5, -0.3, 2.25},
     {-1.5, 0, 2.25},
     {-2.3, 0, 2.025},
     {-2.3, -0.3, 2.025},
     {-2.5, -0.3, 2.25},
     {-2.5, 0, 2.25},
     {-2.7, 0, 2.025},
     {-2.7, -0.3, 2.025},
     {-3, -0.3, 2.25},
     {-3, 0, 2.25},
     {-2.7, 0, 1.8},
     {-2.7, -0.3, 1.8},
     {-3, -0.3, 1.8},
     {-3, 0, 1.8}},
    {{-2.7, 0, 1.8},
     {-2.7, -0.3, 1.8},
     {-3, -0.3, 1.8},
     {-3, 0, 1.8},
     {-2.7, 0, 1.575},
     {-2.7, -0.3, 1.575},
     {-3, -0.3, 1.35},
     {-3, 0, 1.35},
     {-2.5, 0, 1.125},
     {-2.5, -0.3, 1.125},
     {-2.65, -0.3, 0.9375},
     {-2.65, 0, 0.9375},
     {-2, 0, 0.9},
     {-2, -0.3, 0.9},
     {-1.9, -0.3, 0.6},
     {-1.9, 0, 0.6}},
    {{1.7, 0, 1.425},
     {1.7, -0.66, 1.425},
     {1.7, -0.66, 0.6},
     {1.7, 0, 0.6},
     {2.6, 0, 1.425},
     {2.6, -0.66, 1.425},
     {3.1, -0.66, 0.825},
     {3.1, 0, 0.825},
     {2.3, 0, 2.1},
     {2.3, -0.25, 2.1},
     {2.4, -0.25, 2.025},
     {2.4, 0, 2.025},
     {2.7, 0, 2.4},
     {2.7, -0.25, 2.4},
     {3.3, -0.25, 2.4},
     {3.3, 0, 2.4}},
    {{2.7, 0, 2.4},
     {2.7, -0.25, 2.4},
     {3.3, -0.25, 2.4},
     {3.3, 0, 2.4},
     {2.8, 0, 2.475},
     {2.8, -0.25, 2.475},
     {3.525, -0.25, 2.49375},
     {3.525, 0, 2.49375},
     {2.9, 0, 2.475},
     {2.9, -0.15, 2.475},
     {3.45, -0.15, 2.5125},
     {3.45, 0, 2.5125},
     {2.8, 0, 2.4},
     {2.8, -0.15, 2.4},
     {3.2, -0.15, 2.4},
     {3.2, 0, 2.4}},
};
enum { PUBLISHED_COUNT = sizeof PUBLISHED / sizeof *PUBLISHED };

/// One coordinate of a Bézier curve by repeated interpolation (de Casteljau).
static double curve(double a, double b, double c, double d, double t)
{
    double ab = a + t * (b - a), bc = b + t * (c - b), cd = c + t * (d - c);
    double abc = ab + t * (bc - ab), bcd = bc + t * (cd - bc);
    return abc + t * (bcd - abc);
}

static void evaluate(const double p[16][3], double u, double v, double point[3])
{
    for (int k = 0; k < 3; k++) {
        double row[4];
        for (int i = 0; i < 4; i++) {
            row[i] = curve(p[4 * i][k], p[4 * i + 1][k], p[4 * i + 2][k], p[4 * i + 3][k], v);
        }
        point[k] = curve(row[0], row[1], row[2], row[3], u);
    }
}

static double distance_to_vertices(const alp_scene *scene, const double point[3])
{
    double least = 1e30;
    for (uint32_t v = 0; v < scene->vertex_count; v++) {
        const float *p = scene->positions[v]; // published (x, y, z) is our (x, z, −y)
        double dx = (double)p[0] - point[0], dy = (double)p[1] - point[2],
               dz = (double)p[2] + point[1];
        least = fmin(least, sqrt(dx * dx + dy * dy + dz * dz));
    }
    return least;
}

TEST_WITH_CONTEXT(it_is_the_published_one, 1)
{
    alp_scene *scene = teapot(context, SEGMENTS);
    for (int patch = 0; patch < PUBLISHED_COUNT; patch++) {
        for (int i = 0; i <= SEGMENTS; i++) {
            for (int j = 0; j <= SEGMENTS; j++) {
                double point[3];
                evaluate(PUBLISHED[patch], (double)i / SEGMENTS, (double)j / SEGMENTS, point);
                ASSERT_NEAR(distance_to_vertices(scene, point), 0.0, 1e-6);
            }
        }
    }
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(its_size_is_known, 1)
{
    const uint32_t n = 10;
    alp_scene *scene = teapot(context, n);
    alp_scene_info info = alp_scene_get_info(scene);
    assert_int_equal(info.vertices, ALPI_TEAPOT_PATCHES * (n + 1) * (n + 1));
    // Four patches meet at each of two poles with triangles instead of quads.
    assert_int_equal(info.triangles, ALPI_TEAPOT_PATCHES * 2 * n * n - 8 * n);
    assert_int_equal(info.usable_triangles, info.triangles);
    ASSERT_NEAR(info.bounds_min[0], -3.0, 1e-6);  // handle
    ASSERT_NEAR(info.bounds_max[0], 3.434, 3e-3); // spout
    ASSERT_NEAR(info.bounds_min[1], 0.0, 1e-6);
    ASSERT_NEAR(info.bounds_max[1], 3.15, 1e-6);
    ASSERT_NEAR(info.bounds_min[2], -2.0, 1e-6);
    ASSERT_NEAR(info.bounds_max[2], 2.0, 1e-6);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(normals_are_those_of_the_surface, 1)
{
    alp_scene *scene = teapot(context, 40);
    int poles = 0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        vec3 c[3];
        alpi_triangle_corners(scene, t, c);
        for (int k = 0; k < 3; k++) {
            vec3 normal = vec3_load(scene->normals[scene->triangles[t][k]]);
            if (c[k].x == 0.0f && c[k].z == 0.0f) {
                ASSERT_NEAR(normal.y, c[k].y > 1.0f ? 1.0 : -1.0, 1e-5);
                poles++;
            }
        }
    }
    assert_true(poles > 0);
    alp_scene_destroy(scene);
}

// --- edges ---------------------------------------------------------------------------------------

/// An edge between exact positions, the smaller end first; `turned`: it ran the other way.
typedef struct edge {
    float ends[2][3];
    int turned;
} edge;

static int compare_points(const float a[3], const float b[3])
{
    for (int k = 0; k < 3; k++) {
        if (a[k] < b[k] || a[k] > b[k]) {
            return a[k] < b[k] ? -1 : 1;
        }
    }
    return 0;
}

static int compare_edges(const void *a, const void *b)
{
    const edge *left = a, *right = b;
    int first = compare_points(left->ends[0], right->ends[0]);
    return first ? first : compare_points(left->ends[1], right->ends[1]);
}

/// Edges of the surfaces [first, last] that are not matched by exactly one edge the other way.
static uint32_t count_open_edges(const alp_scene *scene, uint32_t first, uint32_t last)
{
    edge *edges = calloc((size_t)scene->triangle_count * 3, sizeof *edges);
    assert_non_null(edges);
    size_t count = 0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        bool wanted = scene->triangle_surface[t] >= first && scene->triangle_surface[t] <= last;
        for (int k = 0; wanted && k < 3; k++) {
            const float *a = scene->positions[scene->triangles[t][k]];
            const float *b = scene->positions[scene->triangles[t][(k + 1) % 3]];
            edge *e = &edges[count++];
            e->turned = compare_points(a, b) > 0;
            memcpy(e->ends[e->turned], a, sizeof e->ends[0]);
            memcpy(e->ends[!e->turned], b, sizeof e->ends[0]);
        }
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    uint32_t open = 0;
    for (size_t i = 0; i < count;) {
        size_t end = i;
        int balance = 0;
        for (; end < count && compare_edges(&edges[i], &edges[end]) == 0; end++) {
            balance += edges[end].turned ? 1 : -1;
        }
        open += end - i != 2 || balance != 0;
        i = end;
    }
    free(edges);
    return open;
}

TEST_WITH_CONTEXT(patches_meet_in_the_same_floats, 1)
{
    for (uint32_t n = 4; n <= 13; n += 3) { // one segment would flatten the tubes
        alp_scene *scene = teapot(context, n);
        // Body and lid end in a ring of four patches each; handle and spout have two ends of two.
        assert_int_equal(count_open_edges(scene, 0, 0), (4 + 4 + 2 * 2 + 2 * 2) * n);
        alp_scene_destroy(scene);
    }
}

TEST_WITH_CONTEXT(the_room_is_closed, 1)
{
    alp_scene *scene = NULL;
    ASSERT_OK(context, alpi_builtin_create(context, "teapot-room", &scene));
    uint32_t last = 0; // the shell of room and hall are the surfaces up to the doorway
    while (last < scene->surface_count && strcmp(scene->surfaces[last].name, "doorway") != 0) {
        last++;
    }
    assert_true(last < scene->surface_count);
    assert_int_equal(count_open_edges(scene, 0, last), 0);
    uint32_t pot = 0;
    while (strcmp(scene->surfaces[pot].name, "teapot") != 0) {
        pot++;
    }
    // Turned, scaled and moved, the same patch edges still meet.
    assert_int_equal(count_open_edges(scene, pot, pot), 160);
    alp_scene_destroy(scene);
}
