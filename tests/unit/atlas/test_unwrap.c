// SPDX-License-Identifier: MIT
// Charts of shapes whose unwrapping is known, and of shapes that have none: few, little stretched,
// never flipped, never folded.
#include "atlas_scenes.h"

#include "base/hash.h"
#include "base/memory.h"
#include "base/random.h"

#include <math.h>
#include <stdlib.h>

// What alp_atlas_info states as the bound of the worst triangle.
static const double STATED_STRETCH = 2.0;

/// A lattice of rows × columns squares of two triangles.
typedef struct sheet {
    uint32_t rows, columns, extra;
    void (*place)(double row, double column, uint32_t extra, float position[3]);
} sheet;

static alp_scene *scene_of_sheet(alp_context *context, const sheet *s)
{
    const uint32_t wide = s->columns + 1, vertices = wide * (s->rows + 1);
    float(*positions)[3] = calloc(vertices, sizeof *positions);
    uint32_t(*indices)[3] = calloc(2 * (size_t)s->rows * s->columns, sizeof *indices);
    assert_true(positions != NULL && indices != NULL);
    for (uint32_t v = 0; v < vertices; v++) {
        s->place((double)(v / wide) / s->rows, (double)(v % wide) / s->columns, s->extra,
                 positions[v]);
    }
    uint32_t count = 0;
    for (uint32_t r = 0; r < s->rows; r++) {
        for (uint32_t c = 0; c < s->columns; c++) {
            const uint32_t at = r * wide + c;
            const uint32_t two[2][3] = {{at, at + wide, at + wide + 1},
                                        {at, at + wide + 1, at + 1}};
            memcpy(indices[count], two, sizeof two);
            count += 2;
        }
    }
    alp_scene *scene = scene_of(context, (const float(*)[3])positions, NULL, vertices,
                                (const uint32_t(*)[3])indices, count);
    free(positions);
    free(indices);
    return scene;
}

/// An angle that ends where it began, to the bit.
static double angle_at(double share)
{
    return (share < 1.0 ? share : 0.0) * 2.0 * ALPI_PI;
}

static void place_on_cylinder(double row, double column, uint32_t extra, float p[3])
{
    (void)extra;
    p[0] = (float)cos(angle_at(column));
    p[1] = (float)(4.0 * row);
    p[2] = (float)sin(angle_at(column));
}

static void place_on_cone(double row, double column, uint32_t extra, float p[3])
{
    (void)extra;
    p[0] = (float)(row * cos(angle_at(column)));
    p[1] = (float)(2.0 - 2.0 * row);
    p[2] = (float)(row * sin(angle_at(column)));
}

static void place_on_torus(double row, double column, uint32_t extra, float p[3])
{
    (void)extra;
    const double radius = 3.0 + cos(angle_at(row));
    p[0] = (float)(radius * cos(angle_at(column)));
    p[1] = (float)sin(angle_at(row));
    p[2] = (float)(radius * sin(angle_at(column)));
}

static void place_on_moebius(double row, double column, uint32_t extra, float p[3])
{
    (void)extra;
    const double angle = angle_at(column), half = column * ALPI_PI, wide = row - 0.5;
    const double radius = 2.0 + wide * (column < 1.0 ? cos(half) : -1.0);
    p[0] = (float)(radius * cos(angle));
    p[1] = (float)(wide * (column < 1.0 ? sin(half) : 0.0));
    p[2] = (float)(radius * sin(angle));
}

/// Keyed noise of some octaves: hills, overhangs and needles.
static void place_at_random(double row, double column, uint32_t seed, float p[3])
{
    const uint32_t key = (uint32_t)(1000.0 * row) * 1009u + (uint32_t)(1000.0 * column);
    const double rough = seed % 3 == 0 ? 0.02 : seed % 3 == 1 ? 0.08 : 0.3;
    for (uint32_t i = 0; i < 3; i++) {
        p[i] = (float)(rough * (keyed(key, 17 * seed + i) - 0.5));
    }
    p[0] += (float)column;
    p[1] += (float)(0.4 * sin(5.0 * row + seed) * cos(4.0 * column));
    p[2] += (float)row;
}

// --- what is asked of an atlas -------------------------------------------------------------------

/// L2 stretch of a triangle at the density `density` (texels per metre).
static double stretch_of(const alp_atlas *atlas, uint32_t triangle, double density)
{
    vec3 c[3];
    alpi_triangle_corners(atlas->scene, triangle, c);
    const float(*uv)[2] = (const float(*)[2])atlas->corner_uvs[triangle];
    const double twice = 2.0 * texel_area(atlas, triangle), size = atlas->info.width;
    const float p[3][3] = {
        {c[0].x, c[0].y, c[0].z}, {c[1].x, c[1].y, c[1].z}, {c[2].x, c[2].y, c[2].z}};
    double squares = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        double s = 0.0, t = 0.0; // derivatives of the position
        for (int k = 0; k < 3; k++) {
            const float *next = uv[(k + 1) % 3], *last = uv[(k + 2) % 3];
            s += (double)p[k][axis] * size * ((double)next[1] - (double)last[1]) / twice;
            t += (double)p[k][axis] * size * ((double)last[0] - (double)next[0]) / twice;
        }
        squares += s * s + t * t;
    }
    return sqrt(0.5 * squares) * density;
}

/// Checks all that holds of every atlas; the worst stretch.
static double check_atlas(const alp_atlas *atlas)
{
    const alp_scene *scene = atlas->scene;
    double laid = 0.0, worst = 0.0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        assert_int_equal(atlas->triangle_charts[t] == ALPI_NONE, !scene->triangle_usable[t]);
        if (scene->triangle_usable[t]) {
            assert_true(atlas->triangle_charts[t] < atlas->info.charts);
            assert_true(texel_area(atlas, t) > 0.0);
            laid += texel_area(atlas, t);
        }
    }
    const double density = sqrt(laid / scene->area);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        if (scene->triangle_usable[t]) {
            worst = fmax(worst, stretch_of(atlas, t, density));
        }
    }
    assert_true(worst <= STATED_STRETCH);
    assert_int_equal(overlapping_texels(atlas), 0);
    return worst;
}

typedef struct expected {
    uint32_t least, most; // charts
    double stretch;
} expected;

static void check_sheet(const sheet *s, expected e)
{
    alp_context *context = test_context(2);
    alp_scene *scene = scene_of_sheet(context, s);
    alp_atlas *atlas = charts_of_size(context, scene, 512);
    const double worst = check_atlas(atlas);
    assert_in_range(atlas->info.charts, e.least, e.most);
    assert_true(worst <= e.stretch);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

TEST(a_cylinder_is_unrolled)
{
    // It closes on itself: two charts at least. Their triangles are congruent: nothing is stretched
    // but by the solver's rounding.
    check_sheet(&(sheet){8, 32, 0, place_on_cylinder}, (expected){2, 2, 1.005});
    check_sheet(&(sheet){1, 64, 0, place_on_cylinder}, (expected){2, 2, 1.005});
}

TEST(a_cone_is_unrolled)
{
    // Quarters that fill little of their boxes stay as they are projected: leaning 45° at most,
    // √((1 + 1 / cos² 45°) / 2).
    check_sheet(&(sheet){12, 32, 0, place_on_cone}, (expected){2, 4, 1.2248});
}

TEST(a_torus_is_cut_into_few)
{
    // Eight charts of more than an eighth of it would have to fill their boxes well.
    check_sheet(&(sheet){24, 72, 0, place_on_torus}, (expected){4, 16, 1.75});
}

TEST(a_twisted_band_is_cut)
{
    // One side only: it has to be cut where it turns its back to itself.
    check_sheet(&(sheet){4, 60, 0, place_on_moebius}, (expected){1, 6, 1.3});
}

TEST_WITH_CONTEXT(a_sphere_has_few, 2)
{
    alp_scene *scene = scene_sphere(context, 24, 48);
    alp_atlas *atlas = charts_of_size(context, scene, 512);
    check_atlas(atlas);
    assert_in_range(atlas->info.charts, 2, 14);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

TEST_SLOW_WITH_CONTEXT(a_spiral_does_not_fold, 2)
{
    for (uint32_t turns = 2; turns <= 11; turns += 9) {
        alp_scene *scene = scene_spiral(context, turns);
        alp_atlas *atlas = charts_of_size(context, scene, 1024);
        check_atlas(atlas);
        assert_in_range(atlas->info.charts, turns / 2, 4 * turns); // a ring cannot have two turns
        alp_atlas_destroy(atlas);
        alp_scene_destroy(scene);
    }
}

TEST_WITH_CONTEXT(random_sheets_hold, 2)
{
    for (uint32_t seed = 0; seed<12; seed += TEST_STEP> 1 ? 11 : 2) {
        alp_scene *scene = scene_of_sheet(context, &(sheet){6 + seed, 20, seed, place_at_random});
        alp_atlas *atlas = charts_of_size(context, scene, seed % 4 == 0 ? 512 : 128);
        check_atlas(atlas);
        alp_atlas_destroy(atlas);
        alp_scene_destroy(scene);
    }
}

TEST(workers_change_nothing)
{
    alp_context *contexts[2];
    alp_scene *scenes[2];
    alp_atlas *atlases[2];
    for (int i = 0; i < 2; i++) {
        contexts[i] = test_context(i == 0 ? 1 : 5);
        scenes[i] = scene_of_sheet(contexts[i], &(sheet){40, 40, 1, place_at_random});
        atlases[i] = charts_of_size(contexts[i], scenes[i], 256);
    }
    assert_memory_equal(atlases[0]->corner_uvs, atlases[1]->corner_uvs,
                        scenes[0]->triangle_count * sizeof *atlases[0]->corner_uvs);
    for (int i = 0; i < 2; i++) {
        alp_atlas_destroy(atlases[i]);
        alp_scene_destroy(scenes[i]);
        alp_context_destroy(contexts[i]);
    }
}

/// Hills and an overhang, of quotients: the same bits wherever floating point is IEEE 754's.
static void place_exactly(double row, double column, uint32_t extra, float p[3])
{
    (void)extra;
    const double x = 4.0 * column - 2.0, z = 4.0 * row - 2.0;
    p[0] = (float)(x + 0.75 * z / (1.0 + 4.0 * x * x));
    p[1] = (float)(2.0 / (1.0 + x * x + 2.0 * z * z) - 0.5 * x * z / (1.0 + z * z));
    p[2] = (float)z;
}

TEST_WITH_CONTEXT(every_machine_makes_the_same, 2)
{
    alp_scene *scene = scene_of_sheet(context, &(sheet){60, 60, 0, place_exactly});
    alp_atlas *atlas = charts_of_size(context, scene, 256);
    const size_t bytes = scene->triangle_count * sizeof *atlas->corner_uvs;
    // As gcc 12 and clang 14 make it; who changes how charts are made changes it too.
    assert_true(alpi_hash_bytes(ALPI_HASH_START, atlas->corner_uvs, bytes) == 0x6d6357accf5f335eu);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

// --- an L, fans, sheets that lie on each other ---------------------------------------------------

static uint32_t charts_of_corners(const float (*corners)[3], uint32_t triangles)
{
    uint32_t(*indices)[3] = calloc(triangles, sizeof *indices);
    assert_non_null(indices);
    for (uint32_t i = 0; i < 3 * triangles; i++) {
        indices[i / 3][i % 3] = i;
    }
    alp_context *context = test_context(1);
    alp_scene *scene =
        scene_of(context, corners, NULL, 3 * triangles, (const uint32_t(*)[3])indices, triangles);
    alp_atlas *atlas = charts_of_size(context, scene, 256);
    check_atlas(atlas);
    const uint32_t charts = atlas->info.charts;
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    free(indices);
    return charts;
}

TEST(an_l_is_two_walls)
{
    // Floor and wall: light steps at the edge between them.
    static const float corners[12][3] = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {0, 0, 0},
                                         {1, 0, 1}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0},
                                         {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    assert_int_equal(charts_of_corners(corners, 4), 2);
}

TEST(a_fan_of_many_falls_apart)
{
    // Five triangles at one edge, three of them one way: none can say who goes on into whom.
    float corners[15][3] = {{0}};
    for (uint32_t i = 0; i < 5; i++) {
        const double angle = 0.2 + 1.2 * i;
        corners[3 * i + i % 2][1] = 1.0f;
        corners[3 * i + 2][0] = (float)cos(angle);
        corners[3 * i + 2][2] = (float)sin(angle);
    }
    assert_int_equal(charts_of_corners((const float(*)[3])corners, 5), 5);
}

TEST(sheets_on_each_other_stay_whole)
{
    // A square of two triangles, four times: twice as it is, twice from behind. Eight triangles
    // share its diagonal.
    static const float square[2][3][3] = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}},
                                          {{1, 1, 0}, {0, 1, 0}, {0, 0, 0}}};
    float corners[24][3];
    for (uint32_t i = 0; i < 8; i++) {
        for (uint32_t k = 0; k < 3; k++) {
            memcpy(corners[3 * i + k], square[i % 2][i < 4 ? k : 2 - k], sizeof corners[0]);
        }
    }
    assert_int_equal(charts_of_corners((const float(*)[3])corners, 4), 2);
    assert_int_equal(charts_of_corners((const float(*)[3])corners, 8), 4);
}

TEST_WITH_CONTEXT(loose_triangles_have_a_chart_each, 2)
{
    alp_scene *scene = scene_confetti(context, 300);
    alp_atlas *atlas = charts_of_size(context, scene, 512);
    check_atlas(atlas);
    assert_int_equal(atlas->info.charts, scene->usable_count);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}

TEST(slivers_keep_a_width)
{
    // Thinner than a float can say on the page: 1e-8 of it, and each with a neighbour.
    float corners[60][3] = {{0}};
    for (uint32_t i = 0; i < 10; i++) {
        const float y = (float)i, high = 1e-7f * (float)(i + 1);
        const float six[6][3] = {{0, y, 0},        {9, y, 0}, {4, y + high, 0},
                                 {4, y + high, 0}, {9, y, 0}, {9, y + 0.9f, 0}};
        memcpy(corners[6 * i], six, sizeof six);
    }
    charts_of_corners((const float(*)[3])corners, 20);
}

// --- meshes that repeat --------------------------------------------------------------------------

enum { COPIES = 4, SIDE = 6, COPY_VERTICES = (SIDE + 1) * (SIDE + 1) };

/// Places a copy: 1 turned and twice as large, 2 stretched, 3 mirrored.
static void place_copy(uint32_t copy, const float p[3], float out[3])
{
    const float far = 10.0f * (float)copy;
    out[0] = copy == 1 ? 2.0f * p[2] : copy == 3 ? -p[0] : p[0];
    out[1] = copy == 1 ? 2.0f * p[1] : copy == 2 ? 3.0f * p[1] : p[1];
    out[2] = far + (copy == 1 ? -2.0f * p[0] : p[2]);
}

static alp_scene *scene_of_copies(alp_context *context)
{
    static float positions[COPIES][COPY_VERTICES][3];
    static uint32_t indices[COPIES][2 * SIDE * SIDE][3];
    alp_mesh meshes[COPIES];
    for (uint32_t c = 0; c < COPIES; c++) {
        for (uint32_t v = 0; v < COPY_VERTICES; v++) {
            float p[3];
            place_at_random((double)(v / (SIDE + 1)) / SIDE, (double)(v % (SIDE + 1)) / SIDE, 1, p);
            place_copy(c, p, positions[c][v]);
        }
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            const uint32_t at = i / SIDE * (SIDE + 1) + i % SIDE, below = at + SIDE + 1;
            const uint32_t two[2][3] = {{at, below, below + 1}, {at, below + 1, at + 1}};
            memcpy(indices[c][2 * i], two, sizeof two);
            for (int k = 0; c == 3 && k < 2; k++) { // as a reader does for mirrored nodes
                indices[c][2 * i + (uint32_t)k][1] = two[k][2];
                indices[c][2 * i + (uint32_t)k][2] = two[k][1];
            }
        }
        meshes[c] = (alp_mesh){.vertex_count = COPY_VERTICES,
                               .positions = &positions[c][0][0],
                               .triangle_count = 2 * SIDE * SIDE,
                               .indices = &indices[c][0][0]};
    }
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, COPIES, &scene));
    for (uint32_t c = 0; c < COPIES; c++) { // four nodes that show one mesh
        scene->surfaces[c].mesh = scene->surfaces[c].primitive = 0;
        scene->surfaces[c].mirrored = c == 3;
    }
    return scene;
}

TEST_WITH_CONTEXT(a_mesh_that_repeats_is_cut_alike, 2)
{
    alp_scene *scene = scene_of_copies(context);
    alp_atlas *atlas = charts_of_size(context, scene, 512);
    check_atlas(atlas);
    const uint32_t n = 2 * SIDE * SIDE;
    bool stretched_alike = true;
    for (uint32_t t = 0; t < n; t++) {
        // Twice as large, four times the texels: but for page coordinates in floats, 2⁻²⁴ of 512
        // texels on triangles of some texels' width.
        const double area = texel_area(atlas, t);
        ASSERT_NEAR(texel_area(atlas, n + t), 4.0 * area, 1e-3 * area + 1e-3);
        for (uint32_t u = 0; u < n; u++) {
            assert_int_equal(atlas->triangle_charts[n + t] == atlas->triangle_charts[n + u],
                             atlas->triangle_charts[t] == atlas->triangle_charts[u]);
        }
        for (uint32_t c = 1; c < COPIES; c++) { // each has a region of its own
            assert_true(atlas->triangle_charts[c * n + t] != atlas->triangle_charts[t]);
        }
        stretched_alike =
            stretched_alike && fabs(texel_area(atlas, 2 * n + t) - area) < 1e-3 * area;
    }
    assert_false(stretched_alike);
    alp_atlas_destroy(atlas);
    alp_scene_destroy(scene);
}
