// SPDX-License-Identifier: MIT
// Light propagation and what hosts do wrong: options out of range, surfels with NaN, too little
// memory.
#include "field_scenes.h"
#include "lpv_volumes.h"
#include "test_small_bake.h"

#include "base/memory.h"

#include <float.h>
#include <stdio.h>

TEST_CONTEXT(2);

static void expect(alp_result result, alp_result code, const char *word)
{
    assert_int_equal(result, code);
    if (strstr(alp_context_message(context), word) == NULL) {
        fail_msg("no '%s' in: %s", word, alp_context_message(context));
    }
}

static alp_lpv_options small_options(uint32_t side)
{
    return lpv_cube(side, 1.0);
}

static alp_lpv *open_small(uint32_t side)
{
    return lpv_open(context, small_options(side));
}

// --- options -------------------------------------------------------------------------------------

TEST(options_out_of_range_are_refused)
{
    enum { BAD = 19 };
    static const char *const words[BAD] = {
        "_default()", "0 cells",    "513 cells",  "0 cells",    "0 m",
        "lpv",        "nan m",      "inf m",      "centre",     "centre",
        "centre",     "0 cascades", "9 cascades", "iterations", "unknown mode 3",
        "mode -1",    "0 bounces",  "2 bounces",  "513 cells"};
    alp_lpv_options bad[BAD];
    for (int i = 0; i < BAD; i++) {
        bad[i] = small_options(4);
    }
    bad[0].struct_size--;
    bad[1].size[0] = 0;
    bad[2].size[1] = 513;
    bad[3].size[2] = 0;
    bad[4].cell = 0.0;
    bad[5].cell = -1.0;
    bad[6].cell = (double)NAN;
    bad[7].cell = HUGE_VAL;
    bad[8].centre[0] = (double)NAN;
    bad[9].centre[1] = HUGE_VAL;
    bad[10].centre[2] = 1e300;
    bad[11].cascades = 0;
    bad[12].cascades = 9;
    bad[13].iterations = 4097;
    bad[14].mode = ALP_LPV_MODE_COUNT;
    bad[15].mode = (alp_lpv_mode)-1;
    bad[16].bounces = 0;
    bad[17].bounces = 2;
    bad[18].size[2] = 513;
    for (int i = 0; i < BAD; i++) {
        alp_lpv *lpv = (alp_lpv *)&bad;
        expect(alp_lpv_create(context, &bad[i], &lpv), ALP_ERROR_INVALID_ARGUMENT, words[i]);
        assert_null(lpv);
    }
    alp_lpv *lpv = NULL;
    assert_int_equal(alp_lpv_create(NULL, NULL, &lpv), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_lpv_create(context, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    alp_field *field = NULL;
    assert_int_equal(alp_field_create_lpv(NULL, &field), ALP_ERROR_INVALID_ARGUMENT);
    alp_lpv_destroy(NULL);
}

/// 0 iterations stand for the longest side of one grid, and for 8 of several.
TEST(iterations_have_a_default)
{
    static const uint32_t expected[2] = {9, 8};
    for (uint32_t i = 0; i < 2; i++) {
        alp_lpv_options o = small_options(4);
        alp_lpv *lpv = NULL;
        o.size[2] = 9;
        o.cascades = i + 1;
        o.iterations = 0;
        ASSERT_OK(context, alp_lpv_create(context, &o, &lpv));
        assert_int_equal(alp_lpv_iterations(lpv), expected[i]);
        alp_lpv_destroy(lpv);
    }
}

TEST(options_of_scenes_are_refused)
{
    enum { BAD = 5 };
    static const char *const words[BAD] = {"_default()", "3 texels", "4097 texels", "points",
                                           "sun"};
    alp_scene *scene = test_load(context, "builtin:furnace");
    alp_lpv *lpv = open_small(4);
    alp_lpv_scene_options bad[BAD];
    for (int i = 0; i < BAD; i++) {
        bad[i] = alp_lpv_scene_options_default();
    }
    bad[0].struct_size = 0;
    bad[1].map_size = 3;
    bad[2].map_size = 4097;
    bad[3].points = (1u << 24) + 1;
    bad[4].lighting.sun.illuminance = NAN;
    for (int i = 0; i < BAD; i++) {
        expect(alp_lpv_light_scene(lpv, scene, &bad[i], NULL), ALP_ERROR_INVALID_ARGUMENT,
               words[i]);
    }
    assert_int_equal(alp_lpv_light_scene(NULL, scene, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_lpv_light_scene(lpv, NULL, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
}

TEST(an_eye_that_is_nowhere_moves_nothing)
{
    const double inside[3] = {3.0, -2.0, 1.0}, ahead[3] = {0.0, 0.0, -5.0};
    const double bad[] = {(double)NAN, HUGE_VAL, -HUGE_VAL, 1e300};
    alp_lpv *lpv = open_small(8);
    ASSERT_OK(context, alp_lpv_follow(lpv, inside, ahead));
    const alpi_lpv_grid before = lpv->grids[0];
    const double eye[3] = {lpv->eye[0], lpv->eye[1], lpv->eye[2]};
    for (int i = 0; i < 21; i++) { // four values in the eye, three in the direction
        double e[3] = {1.0, 2.0, 3.0}, f[3] = {1.0, 0.0, 0.0};
        *(i < 12 ? &e[i % 3] : &f[i % 3]) = bad[i / 3 % 4];
        assert_int_equal(alp_lpv_follow(lpv, e, f), ALP_ERROR_INVALID_ARGUMENT);
        assert_memory_equal(before.corner, lpv->grids[0].corner, sizeof before.corner);
        assert_memory_equal(eye, lpv->eye, sizeof eye);
    }
    alp_lpv_destroy(lpv);
}

/// Grids far from the origin lie where they are said to, and hold light there.
TEST(a_grid_far_away_holds_light)
{
    alp_lpv *lpv = open_small(8);
    const double eye[3] = {1e6, 0.0, -1e6}, nowhere[3] = {0.0, 0.0, 0.0};
    ASSERT_OK(context, alp_lpv_follow(lpv, eye, nowhere));
    alp_lpv_begin(lpv);
    const float p[1][3] = {{1e6f, 0.0f, -1e6f}}, n[1][3] = {{0.0f, 1.0f, 0.0f}};
    const alp_lpv_surfels s = {.count = 1, .positions = p, .normals = n, .flux = n};
    ASSERT_OK(context, alp_lpv_add_light(lpv, ALP_LPV_ALL_CASCADES, &s));
    ASSERT_OK(context, alp_lpv_propagate(lpv));
    float here[1][3], far[1][3];
    const float beside[1][3] = {{1e6f + 3.0f, 0.0f, -1e6f}};
    alp_lpv_fluence(lpv, 1, p, here);
    alp_lpv_fluence(lpv, 1, beside, far);
    assert_true(far[0][1] > 0.0f && here[0][1] > 4.0f * far[0][1]);
    alp_lpv_destroy(lpv);
}

// --- sizes and memory ----------------------------------------------------------------------------

TEST(a_grid_of_one_cell_works)
{
    for (int mode = 0; mode < ALP_LPV_MODE_COUNT; mode++) {
        for (uint32_t cascades = 1; cascades <= 2; cascades++) {
            alp_lpv_options o = small_options(1);
            o.mode = (alp_lpv_mode)mode;
            o.cascades = cascades;
            o.iterations = 5;
            alp_lpv *lpv = NULL;
            ASSERT_OK(context, alp_lpv_create(context, &o, &lpv));
            alp_lpv_begin(lpv);
            const float p[1][3] = {{0.2f, 0.3f, 0.2f}}, n[1][3] = {{0.0f, 0.0f, 1.0f}};
            const float area = 0.5f;
            const alp_lpv_surfels s = {
                .count = 1, .positions = p, .normals = n, .flux = n, .areas = &area};
            ASSERT_OK(context, alp_lpv_add_light(lpv, ALP_LPV_ALL_CASCADES, &s));
            ASSERT_OK(context, alp_lpv_add_blockers(lpv, ALP_LPV_ALL_CASCADES, &s));
            ASSERT_OK(context, alp_lpv_propagate(lpv));
            alp_field *field = NULL;
            ASSERT_OK(context, alp_field_create_lpv(lpv, &field));
            const float at[3][3] = {{0.2f, 0.3f, 0.2f}, {-9.0f, 0.0f, 0.0f}, {0.0f, 90.0f, 0.0f}};
            const float down[3][3] = {{0.0f, 0.0f, -1.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};
            float e[3][3], l[3][3], f[3][3];
            alp_field_irradiance(field, 3, at, down, e);
            alp_lpv_radiance(lpv, 3, at, down, l);
            alp_lpv_fluence(lpv, 3, at, f);
            for (int i = 0; i < 9; i++) {
                assert_true(isfinite(e[i / 3][i % 3]) && e[i / 3][i % 3] >= 0.0f);
                assert_true(isfinite(l[i / 3][i % 3]) && l[i / 3][i % 3] >= 0.0f);
                assert_true(isfinite(f[i / 3][i % 3]) && f[i / 3][i % 3] >= 0.0f);
            }
            assert_true(e[0][2] > 0.0f);
            alp_field_destroy(field);
            alp_lpv_destroy(lpv);
        }
    }
}

/// All memory is that of options, apart from the volume's own struct.
TEST(memory_is_as_stated)
{
    for (int i = 0; i < 4; i++) {
        alp_lpv_options o = small_options(5 + (uint32_t)i);
        o.size[1] = 3;
        o.cascades = i % 2 == 0 ? 1 : 3;
        o.blockers = i < 2;
        alp_lpv *lpv = NULL;
        const uint64_t before = alpi_memory_held(context);
        ASSERT_OK(context, alp_lpv_create(context, &o, &lpv));
        const uint64_t held = alpi_memory_held(context) - before;
        assert_true(held == alp_lpv_memory(&o) + sizeof(alp_lpv));
        alp_lpv_destroy(lpv);
        assert_true(alpi_memory_held(context) == before);
    }
}

TEST(a_limit_of_memory_names_both_figures)
{
    alp_lpv_options o = small_options(512);
    alp_lpv *lpv = NULL;
    char needed[64], limit[64];
    o.memory_limit = 3000000000u;
    snprintf(needed, sizeof needed, "needs %.0f MB", (double)alp_lpv_memory(&o) / 1e6);
    snprintf(limit, sizeof limit, "limit is %.0f MB", (double)o.memory_limit / 1e6);
    assert_true(alp_lpv_memory(&o) > 25769803776u); // 192 × 512³
    expect(alp_lpv_create(context, &o, &lpv), ALP_ERROR_LIMIT, needed);
    expect(alp_lpv_create(context, &o, &lpv), ALP_ERROR_LIMIT, limit);
    assert_null(lpv);
    o = small_options(6);
    o.memory_limit = alp_lpv_memory(&o) - 1;
    assert_int_equal(alp_lpv_create(context, &o, &lpv), ALP_ERROR_LIMIT);
    assert_null(lpv);
    o.memory_limit++;
    ASSERT_OK(context, alp_lpv_create(context, &o, &lpv));
    alp_lpv_destroy(lpv);
}

// --- surfels -------------------------------------------------------------------------------------

enum { SURFELS = 40 };

typedef struct surfel_list {
    float positions[SURFELS][3], normals[SURFELS][3], flux[SURFELS][3], albedo[SURFELS][3];
    float areas[SURFELS], radii[SURFELS];
} surfel_list;

static alp_lpv_surfels view_of(const surfel_list *l)
{
    return (alp_lpv_surfels){.count = SURFELS,
                             .positions = (const float(*)[3])l->positions,
                             .normals = (const float(*)[3])l->normals,
                             .flux = (const float(*)[3])l->flux,
                             .areas = l->areas,
                             .albedo = (const float(*)[3])l->albedo,
                             .radii = l->radii};
}

static surfel_list good_surfels(void)
{
    surfel_list l;
    memset(&l, 0, sizeof l);
    for (int i = 0; i < SURFELS; i++) {
        for (int k = 0; k < 3; k++) {
            l.positions[i][k] = (float)((i * (k + 3) + k) % 7) - 3.0f;
            l.flux[i][k] = 0.1f + (float)(i % 5) + (float)k;
            l.albedo[i][k] = 0.1f * (float)(i % 4 + k);
        }
        l.normals[i][i % 3] = i % 2 == 0 ? 1.0f : -1.0f;
        l.areas[i] = 0.05f + 0.01f * (float)i;
    }
    return l;
}

/// Adds surfels to a volume of its own, as light or as blockers, and keeps what was injected.
static uint64_t inject(const surfel_list *list, bool blockers, float *values, size_t count)
{
    alp_lpv *lpv = open_small(8);
    const alp_lpv_surfels s = view_of(list);
    if (blockers) {
        ASSERT_OK(context, alp_lpv_add_blockers(lpv, ALP_LPV_ALL_CASCADES, &s));
    } else {
        ASSERT_OK(context, alp_lpv_add_light(lpv, ALP_LPV_ALL_CASCADES, &s));
    }
    const uint64_t skipped = alp_lpv_skipped(lpv);
    const alpi_lpv_grid *g = &lpv->grids[0];
    memcpy(values, blockers ? g->nodes : g->injected, count * sizeof *values);
    alp_lpv_begin(lpv);
    assert_true(alp_lpv_skipped(lpv) == 0);
    alp_lpv_destroy(lpv);
    return skipped;
}

enum { VALUES = 9 * 9 * 9 * ALPI_LPV_NODE_TERMS, LIGHT_VALUES = 8 * 8 * 8 * ALPI_LPV_ROWS };

/// A surfel that is broken counts as one without flux and area, and is counted. The others stay.
static void expect_skip(const surfel_list *broken, int index, bool blockers, bool skips)
{
    static float values[2][LIGHT_VALUES];
    const size_t count = blockers ? VALUES : LIGHT_VALUES;
    surfel_list without = good_surfels();
    without.areas[index] = 0.0f;
    memset(without.flux[index], 0, sizeof without.flux[index]);
    assert_true(inject(&without, blockers, values[0], count) == 0);
    assert_true(inject(broken, blockers, values[1], count) == (skips ? 1u : 0u));
    if (skips) {
        assert_memory_equal(values[0], values[1], count * sizeof(float));
    }
}

TEST(surfels_with_bad_values_are_left_out)
{
    const float bad[4] = {NAN, HUGE_VALF, -HUGE_VALF, -1.0f};
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            surfel_list l = good_surfels();
            l.positions[7 + k][k] = bad[i];
            expect_skip(&l, 7 + k, false, i < 3);
            expect_skip(&l, 7 + k, true, i < 3);
            l = good_surfels();
            l.normals[12 + k][k] = 2.0f * bad[i]; // of length 2, too
            expect_skip(&l, 12 + k, false, true);
            expect_skip(&l, 12 + k, true, true);
            l = good_surfels();
            l.flux[20 + k][k] = bad[i];
            expect_skip(&l, 20 + k, false, true);
            expect_skip(&l, 20 + k, true, false); // blockers have no flux
            l = good_surfels();
            l.albedo[30 + k][k] = bad[i];
            expect_skip(&l, 30 + k, true, true);
            expect_skip(&l, 30 + k, false, false);
        }
        surfel_list l = good_surfels();
        l.areas[0] = bad[i];
        expect_skip(&l, 0, true, true);
        expect_skip(&l, 0, false, false);
        l = good_surfels();
        l.radii[SURFELS - 1] = bad[i];
        expect_skip(&l, SURFELS - 1, false, i < 3);
        expect_skip(&l, SURFELS - 1, true, i < 3);
    }
    surfel_list l = good_surfels();
    memset(l.normals[5], 0, sizeof l.normals[5]);
    expect_skip(&l, 5, false, true);
    expect_skip(&l, 5, true, true);
}

TEST(surfels_outside_of_the_grid_do_nothing)
{
    static float values[LIGHT_VALUES];
    surfel_list l = good_surfels();
    const float far[4] = {4.6f, -4.6f, 1e30f, -FLT_MAX};
    for (int i = 0; i < SURFELS; i++) {
        l.positions[i][i % 3] = far[i % 4];
    }
    for (int blockers = 0; blockers < 2; blockers++) {
        const size_t count = blockers ? VALUES : LIGHT_VALUES;
        assert_true(inject(&l, blockers != 0, values, count) == 0);
        for (size_t i = 0; i < count; i++) {
            assert_true(values[i] == 0.0f);
        }
    }
}

TEST(surfels_without_what_they_need_are_refused)
{
    const surfel_list l = good_surfels();
    alp_lpv *lpv = open_small(8);
    alp_lpv_surfels s = view_of(&l);
    const alp_lpv_surfels none = {.count = 0};
    ASSERT_OK(context, alp_lpv_add_light(lpv, ALP_LPV_ALL_CASCADES, &none));
    ASSERT_OK(context, alp_lpv_add_light(lpv, 0, &none));
    ASSERT_OK(context, alp_lpv_add_blockers(lpv, ALP_LPV_ALL_CASCADES, &none));
    expect(alp_lpv_add_light(lpv, 1, &s), ALP_ERROR_INVALID_ARGUMENT, "light for cascade 1 of 1");
    expect(alp_lpv_add_blockers(lpv, 1, &s), ALP_ERROR_INVALID_ARGUMENT,
           "blockers for cascade 1 of 1");
    s.flux = NULL;
    expect(alp_lpv_add_light(lpv, 0, &s), ALP_ERROR_INVALID_ARGUMENT, "flux");
    ASSERT_OK(context, alp_lpv_add_blockers(lpv, ALP_LPV_ALL_CASCADES, &s));
    s.areas = NULL;
    expect(alp_lpv_add_blockers(lpv, ALP_LPV_ALL_CASCADES, &s), ALP_ERROR_INVALID_ARGUMENT,
           "areas");
    alp_lpv_destroy(lpv);
    alp_lpv_options o = small_options(4);
    o.blockers = false;
    ASSERT_OK(context, alp_lpv_create(context, &o, &lpv));
    s = view_of(&l);
    expect(alp_lpv_add_blockers(lpv, ALP_LPV_ALL_CASCADES, &s), ALP_ERROR_INVALID_ARGUMENT,
           "blockers");
    alp_lpv_destroy(lpv);
}

/// Grey is the albedo of blockers without one; radii may be left out.
TEST(arrays_that_may_be_left_out_have_their_default)
{
    static float values[2][VALUES];
    for (int i = 0; i < 2; i++) {
        surfel_list l = good_surfels();
        alp_lpv *lpv = open_small(8);
        for (int k = 0; k < SURFELS; k++) {
            l.albedo[k][0] = l.albedo[k][1] = l.albedo[k][2] = 0.5f;
        }
        alp_lpv_surfels s = view_of(&l);
        if (i == 1) {
            s.albedo = NULL;
            s.radii = NULL;
        }
        ASSERT_OK(context, alp_lpv_add_blockers(lpv, ALP_LPV_ALL_CASCADES, &s));
        memcpy(values[i], lpv->grids[0].nodes, sizeof values[i]);
        alp_lpv_destroy(lpv);
    }
    assert_memory_equal(values[0], values[1], sizeof values[0]);
}

// --- scenes --------------------------------------------------------------------------------------

TEST(a_scene_without_light_is_refused)
{
    alp_scene *scene = field_room(context, (vec3){1.0f, 1.0f, 1.0f}, 0.5f, 0.0f);
    alp_lpv *lpv = open_small(4);
    alp_lpv_scene_options o = alp_lpv_scene_options_default();
    expect(alp_lpv_light_scene(lpv, scene, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT, "light");
    o.lighting.sky.kind = ALP_SKY_CONSTANT; // a volume has no sky
    expect(alp_lpv_light_scene(lpv, scene, &o, NULL), ALP_ERROR_INVALID_ARGUMENT, "light");
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
}

/// A lamp inside a block: its rays meet the backs of faces alone, which are black.
TEST(a_lamp_in_a_wall_is_dark)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    const vec3 white = {0.9f, 0.9f, 0.9f}, none = {0.0f, 0.0f, 0.0f};
    alpi_builder_start(&b, context, "wall in a room");
    alpi_builder_surface(&b, "all", alpi_builder_material(&b, "white", white, none));
    alpi_builder_box(&b, (vec3){4.0f, 4.0f, 4.0f}, none, ALPI_FACE_ALL);
    alpi_builder_box(&b, (vec3){1.5f, 0.1f, 0.1f}, (vec3){2.5f, 3.9f, 3.9f}, ALPI_FACE_ALL);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    alp_lpv_options o = alp_lpv_options_for_scene(scene, 12, 1);
    alp_lpv *lpv = NULL;
    ASSERT_OK(context, alp_lpv_create(context, &o, &lpv));
    alp_lamp lamp = alp_lamp_default();
    lamp.intensity = 10.0f;
    lamp.position[0] = lamp.position[1] = lamp.position[2] = 2.0f;
    alp_lpv_scene_options s = alp_lpv_scene_options_default();
    s.lighting.lamps = &lamp;
    s.lighting.lamp_count = 1;
    s.map_size = 32;
    s.points = 4096;
    alp_lpv_report report;
    ASSERT_OK(context, alp_lpv_light_scene(lpv, scene, &s, &report));
    ASSERT_NEAR(report.flux[0], 0.0, 0.0);
    lamp.position[0] = 1.0f; // in the room: the same lamp lights it
    ASSERT_OK(context, alp_lpv_light_scene(lpv, scene, &s, &report));
    assert_true(report.flux[0] > 10.0);
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
}

TEST(look_ups_nowhere_are_finite)
{
    alp_lpv *lpv = open_small(8);
    const surfel_list l = good_surfels();
    const alp_lpv_surfels s = view_of(&l);
    ASSERT_OK(context, alp_lpv_add_light(lpv, ALP_LPV_ALL_CASCADES, &s));
    ASSERT_OK(context, alp_lpv_propagate(lpv));
    alp_field *field = NULL;
    ASSERT_OK(context, alp_field_create_lpv(lpv, &field));
    const float p[4][3] = {
        {NAN, 0.0f, 0.0f}, {0.0f, HUGE_VALF, 0.0f}, {0.0f, 0.0f, -FLT_MAX}, {0.0f, 0.0f, 0.0f}};
    const float n[4][3] = {
        {0.0f, 1.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, NAN, 0.0f}};
    float e[4][3], radiance[4][3], fluence[4][3];
    alp_field_irradiance(field, 4, p, n, e);
    alp_lpv_radiance(lpv, 4, p, n, radiance);
    alp_lpv_fluence(lpv, 4, p, fluence);
    for (int i = 0; i < 12; i++) {
        assert_true(isfinite(e[i / 3][i % 3]) && e[i / 3][i % 3] >= 0.0f);
        assert_true(isfinite(radiance[i / 3][i % 3]) && radiance[i / 3][i % 3] >= 0.0f);
        assert_true(isfinite(fluence[i / 3][i % 3]) && fluence[i / 3][i % 3] >= 0.0f);
    }
    alp_field_destroy(field);
    alp_lpv_destroy(lpv);
}

// --- each allocation fails once ------------------------------------------------------------------

static alp_result light_cornell(alp_context *own, const alp_scene *scene)
{
    alp_lpv_options o = alp_lpv_options_for_scene(scene, 6, 2);
    alp_lpv_scene_options s = alp_lpv_scene_options_default();
    alp_lamp lamps[2] = {alp_lamp_default(), alp_lamp_default()};
    const alp_camera camera = {
        .position = {0.2f, 0.2f, 0.2f}, .up = {0.0f, 1.0f, 0.0f}, .vertical_fov = 0.8f};
    alp_lpv *lpv = NULL;
    alp_field *field = NULL;
    lamps[0].intensity = lamps[1].intensity = 0.1f;
    lamps[0].position[0] = lamps[0].position[1] = lamps[0].position[2] = 0.3f;
    lamps[1].kind = ALP_LIGHT_SPOT;
    s.lighting.lamps = lamps;
    s.lighting.lamp_count = 2;
    s.lighting.sun.illuminance = 1.0f;
    s.lighting.sun.elevation = 0.5f;
    s.map_size = 8;
    s.points = 64;
    alp_result result = alp_lpv_create(own, &o, &lpv);
    assert_true((lpv != NULL) == (result == ALP_OK));
    for (int i = 0; i < 2 && result == ALP_OK; i++) {
        result = alp_lpv_light_scene(lpv, scene, &s, NULL);
        s.points = 0;
        s.camera = &camera;
    }
    if (result == ALP_OK) {
        result = alp_field_create_lpv(lpv, &field);
        assert_true((field != NULL) == (result == ALP_OK));
    }
    alp_field_destroy(field);
    alp_lpv_destroy(lpv);
    return result;
}

static alp_result run_with(test_memory *memory)
{
    const long failing = memory->failing;
    memory->failing = -1;
    alp_context *own = test_memory_context(memory, 1);
    alp_scene *scene = test_load(own, "builtin:cornell");
    memory->failing = failing;
    atomic_store(&memory->count, 0);
    const alp_result result = light_cornell(own, scene);
    if (result != ALP_OK) {
        assert_int_equal(result, ALP_ERROR_OUT_OF_MEMORY);
        assert_non_null(strstr(alp_context_message(own), "memory"));
    }
    alp_scene_destroy(scene);
    alp_context_destroy(own);
    assert_int_equal(atomic_load(&memory->live), 0);
    return result;
}

TEST(volumes_without_memory)
{
    test_memory whole = {.failing = -1};
    assert_int_equal(run_with(&whole), ALP_OK);
    const long total = atomic_load(&whole.count);
    assert_in_range(total, 30, 2000);
    for (long i = 0; i < total; i += TEST_STEP) {
        test_memory memory = {.failing = i};
        if (run_with(&memory) == ALP_OK) {
            fail_msg("allocation %ld of %ld failed, and nothing noticed", i, total);
        }
    }
    print_message("%ld allocations failed in turn\n", total);
}
