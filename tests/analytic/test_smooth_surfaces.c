// SPDX-License-Identifier: MIT
// Coarse meshes with smooth normals stand for smooth surfaces: an open one is open everywhere, also
// beside the edges of its facets, and nothing else changes.
#include "atlas/atlas.h"
#include "base/memory.h"
#include "test_support.h"
#include "transport/occlusion/occlusion.h"

#include <math.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

enum { VERTEX_LIMIT = 20000 };
static float positions[VERTEX_LIMIT][3], normals[VERTEX_LIMIT][3];
static uint32_t triangles[2 * VERTEX_LIMIT][3];
static alp_mesh mesh;

static void start_mesh(void)
{
    mesh = (alp_mesh){.name = "smooth",
                      .positions = positions[0],
                      .normals = normals[0],
                      .indices = triangles[0],
                      .base_color = {0.5f, 0.5f, 0.5f},
                      .double_sided = true};
}

static void add_vertex(double x, double y, double z, double side)
{
    const double length = sqrt(x * x + y * y + z * z), p[3] = {x, y, z};
    assert_true(mesh.vertex_count < VERTEX_LIMIT);
    for (int k = 0; k < 3; k++) {
        positions[mesh.vertex_count][k] = (float)(p[k] / length);
        normals[mesh.vertex_count][k] = (float)(side * p[k] / length);
    }
    mesh.vertex_count++;
}

static void add_triangle(uint32_t a, uint32_t b, uint32_t c, double side)
{
    const uint32_t corners[3] = {a, side > 0.0 ? b : c, side > 0.0 ? c : b};
    memcpy(triangles[mesh.triangle_count++], corners, sizeof corners);
}

/// Unit sphere in segments × rings from the −y pole up to the height `cut`, seen from outside
/// (side 1) or inside (−1).
static void make_sphere(uint32_t segments, uint32_t rings, double cut, double side)
{
    start_mesh();
    for (uint32_t r = 0; r <= rings; r++) {
        const double theta = acos(-1.0) - (PI - acos(cut)) * r / rings;
        for (uint32_t s = 0; s < segments; s++) { // shared across the seam; poles once a segment
            const double phi = 2.0 * PI * s / segments, w = r == 0 ? 0.0 : sin(theta);
            add_vertex(w * sin(phi), cos(theta), w * cos(phi), side);
        }
    }
    for (uint32_t r = 0; r < rings; r++) {
        for (uint32_t s = 0; s < segments; s++) {
            const uint32_t a = r * segments + s, b = r * segments + (s + 1) % segments;
            add_triangle(a, b, b + segments, side); // those at a closed pole have no area
            add_triangle(a, b + segments, a + segments, side);
        }
    }
}

/// Icosahedron, each face cut into n² parts.
static void make_icosphere(uint32_t n)
{
    const double g = (1.0 + sqrt(5.0)) / 2.0;
    const double v[12][3] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                             {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                             {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    static const int faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                     {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                     {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                     {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    start_mesh();
    for (int f = 0; f < 20; f++) {
        const double *a = v[faces[f][0]], *b = v[faces[f][1]], *c = v[faces[f][2]];
        const uint32_t first = mesh.vertex_count;
        for (uint32_t i = 0; i <= n; i++) {
            for (uint32_t j = 0; j <= i; j++) {
                const double wb = (double)(i - j) / n, wc = (double)j / n, wa = 1.0 - wb - wc;
                add_vertex(wa * a[0] + wb * b[0] + wc * c[0], wa * a[1] + wb * b[1] + wc * c[1],
                           wa * a[2] + wb * b[2] + wc * c[2], 1.0);
            }
        }
        for (uint32_t i = 0; i < n; i++) {
            for (uint32_t j = 0; j <= i; j++) {
                const uint32_t at = first + i * (i + 1) / 2 + j, below = at + i + 1;
                add_triangle(at, below, below + 1, 1.0);
                if (j < i) {
                    add_triangle(at, below + 1, at + 1, 1.0);
                }
            }
        }
    }
}

typedef struct result {
    double least, most, mean;
} result;

/// Accessibility of the mesh's texels without a limit.
static result bake(alp_context *context, uint32_t samples, uint8_t flags)
{
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, &mesh, 1, &scene));
    alp_atlas_options atlas_options = alp_atlas_options_default();
    atlas_options.mode = ALP_ATLAS_CHARTS;
    atlas_options.size = 96;
    alp_atlas *atlas = NULL;
    alpi_texels texels;
    ASSERT_OK(context, alp_atlas_create(scene, &atlas_options, &atlas));
    ASSERT_OK(context, alpi_texels_create(atlas, &texels));
    memset(texels.flags, flags, texels.count);
    alp_occlusion_options options = alp_occlusion_options_default();
    options.distance = INFINITY;
    options.samples = samples;
    alpi_tracer *tracer = NULL;
    alpi_occlusion_setup setup;
    ASSERT_OK(context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    ASSERT_OK(context, alpi_occlusion_prepare(scene, tracer, &options, &setup));
    float *values = calloc(texels.count, sizeof *values);
    assert_non_null(values);
    const alpi_receivers receivers = alpi_texels_receivers(&texels);
    ASSERT_OK(context, alpi_occlusion_gather(&setup, &receivers, NULL, texels.count, values));
    result out = {.least = HUGE_VAL, .most = -HUGE_VAL};
    double area = 0.0;
    for (uint32_t i = 0; i < texels.count; i++) {
        out.least = fmin(out.least, (double)values[i]);
        out.most = fmax(out.most, (double)values[i]);
        out.mean += (double)texels.areas[i] * (double)values[i];
        area += (double)texels.areas[i];
    }
    out.mean /= area;
    free(values);
    alpi_occlusion_release(&setup);
    alpi_texels_destroy(context, &texels);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
    return out;
}

/// No texel sees the mesh that it is of, but for a ray within rounding of the horizon: of 12 seeds
/// of the coarsest sphere three have one, of 1.5 million each.
static void assert_open(alp_context *context)
{
    const result all = bake(context, 256, 0);
    ASSERT_NEAR(all.mean, 1.0, 2e-6);
    ASSERT_NEAR(all.least, 1.0, 1.0 / 256.0);
}

TEST_WITH_CONTEXT(coarse_spheres_are_open, 2)
{
    static const uint32_t shapes[][2] = {{5, 4}, {6, 4}, {8, 6}, {12, 8}, {24, 12}, {16, 5}};
    for (int i = 0; i < 6; i++) {
        make_sphere(shapes[i][0], shapes[i][1], 1.0, 1.0);
        assert_open(context);
    }
    for (uint32_t n = 1; n <= 4; n++) {
        make_icosphere(n);
        assert_open(context);
        // What it was before, so that this test would see it.
        assert_true(bake(context, 256, ALPI_TEXEL_NO_LIFT).least < 0.99);
    }
}

TEST_WITH_CONTEXT(a_bowl_keeps_its_closed_form, 2)
{
    // Oracle 10: a sphere seen from inside through its cut at height z is (1 − z) / 2 open at every
    // point. Facets cost .003 (physics), 1,024 samples of a texel up to .03.
    const double cuts[] = {0.0, 0.5, -0.3};
    for (int i = 0; i < 3; i++) {
        make_sphere(64, 32, cuts[i], -1.0);
        const result lifted = bake(context, 1024, 0),
                     plain = bake(context, 1024, ALPI_TEXEL_NO_LIFT);
        ASSERT_NEAR(lifted.mean, (1.0 - cuts[i]) / 2.0, 0.003);
        ASSERT_NEAR(lifted.least, (1.0 - cuts[i]) / 2.0, 0.04);
        ASSERT_NEAR(lifted.most, (1.0 - cuts[i]) / 2.0, 0.04);
        ASSERT_NEAR(lifted.mean, plain.mean, 0.0); // nothing to lift
    }
}
