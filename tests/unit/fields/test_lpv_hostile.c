// SPDX-License-Identifier: MIT
// Light propagation and values that are valid floats but break sums: huge and tiny ones, albedo
// above 1, arrays that are missing, cameras that look nowhere.
#include "field_scenes.h"
#include "lpv_volumes.h"

#include <float.h>

TEST_CONTEXT(2);

static void expect_refusal(alp_result result, const char *word)
{
    assert_int_equal(result, ALP_ERROR_INVALID_ARGUMENT);
    if (strstr(alp_context_message(context), word) == NULL) {
        fail_msg("no '%s' in: %s", word, alp_context_message(context));
    }
}

// --- surfels -------------------------------------------------------------------------------------

static const float place[1][3] = {{0.3f, 0.1f, 0.2f}}, up[1][3] = {{0.0f, 1.0f, 0.0f}};
static const float one = 1.0f;

TEST(surfels_without_places_are_refused)
{
    const alp_lpv_surfels whole = {
        .count = 1, .positions = place, .normals = up, .flux = up, .areas = &one};
    alp_lpv *lpv = lpv_open(context, lpv_cube(4, 1.0));
    alp_lpv_surfels s = whole;
    s.positions = NULL;
    expect_refusal(alp_lpv_add_light(lpv, ALP_LPV_ALL_CASCADES, &s), "light without positions");
    expect_refusal(alp_lpv_add_blockers(lpv, ALP_LPV_ALL_CASCADES, &s),
                   "blockers without positions");
    s = whole;
    s.normals = NULL;
    expect_refusal(alp_lpv_add_light(lpv, ALP_LPV_ALL_CASCADES, &s), "light without normals");
    expect_refusal(alp_lpv_add_blockers(lpv, ALP_LPV_ALL_CASCADES, &s), "blockers without normals");
    alp_lpv_destroy(lpv);
}

/// White walls at most: blockers that reflect more than they get would make light grow.
TEST(an_albedo_above_one_is_left_out)
{
    const float albedo[3][1][3] = {
        {{1.0f, 1.0f, 1.0f}}, {{1.001f, 0.5f, 0.5f}}, {{0.5f, 0.5f, 60.0f}}};
    for (int i = 0; i < 3; i++) {
        alp_lpv *lpv = lpv_open(context, lpv_cube(4, 1.0));
        const alp_lpv_surfels s = {
            .count = 1, .positions = place, .normals = up, .areas = &one, .albedo = albedo[i]};
        ASSERT_OK(context, alp_lpv_add_blockers(lpv, ALP_LPV_ALL_CASCADES, &s));
        assert_true(alp_lpv_skipped(lpv) == (i == 0 ? 0u : 1u));
        alp_lpv_destroy(lpv);
    }
}

static void assert_finite(const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(values[i])) {
            fail_msg("value %zu of %zu is %g", i, count, (double)values[i]);
        }
    }
}

/// Lights and blockers of all sizes in one place, and all that is read there.
static void expect_finite(alp_lpv_mode mode, double cell, float flux, float area)
{
    enum { COUNT = 64 };
    float p[COUNT][3], n[COUNT][3], f[COUNT][3], areas[COUNT];
    for (int i = 0; i < COUNT; i++) {
        for (int k = 0; k < 3; k++) {
            p[i][k] = (float)(cell * (i % 5 - 2) * 0.6);
            n[i][k] = i / 2 % 3 == k ? (i % 2 == 0 ? 1.0f : -1.0f) : 0.0f;
            f[i][k] = flux;
        }
        areas[i] = area;
    }
    alp_lpv_options o = lpv_cube(8, cell);
    o.mode = mode;
    alp_lpv *lpv = lpv_open(context, o);
    const alp_lpv_surfels s = {.count = COUNT,
                               .positions = (const float(*)[3])p,
                               .normals = (const float(*)[3])n,
                               .flux = (const float(*)[3])f,
                               .areas = areas};
    ASSERT_OK(context, alp_lpv_add_light(lpv, ALP_LPV_ALL_CASCADES, &s));
    ASSERT_OK(context, alp_lpv_add_blockers(lpv, ALP_LPV_ALL_CASCADES, &s));
    ASSERT_OK(context, alp_lpv_propagate(lpv));
    const alpi_lpv_grid *g = &lpv->grids[0];
    assert_finite(g->nodes, alpi_lpv_nodes(g->size) * ALPI_LPV_NODE_TERMS);
    assert_finite(g->faces, alpi_lpv_nodes(g->size) * 3 * ALPI_LPV_AXIS_ROWS);
    assert_finite(g->light, alpi_lpv_wide_cells(g->size) * ALPI_LPV_ROWS);
    assert_finite(g->sum, alpi_lpv_cells(g->size) * ALPI_LPV_ROWS);
    alp_field *field = NULL;
    float e[COUNT][3];
    ASSERT_OK(context, alp_field_create_lpv(lpv, &field));
    alp_field_irradiance(field, COUNT, s.positions, s.normals, e);
    assert_finite(e[0], 3 * (size_t)COUNT);
    alp_lpv_radiance(lpv, COUNT, s.positions, s.normals, e);
    assert_finite(e[0], 3 * (size_t)COUNT);
    alp_lpv_fluence(lpv, COUNT, s.positions, e);
    assert_finite(e[0], 3 * (size_t)COUNT);
    alp_field_destroy(field);
    alp_lpv_destroy(lpv);
}

/// No float leads to a value that is not finite, in cells of any size.
TEST(no_surfel_makes_nan)
{
    static const float values[] = {0.0f, FLT_MIN, 1e-30f, 1.0f, 1e15f, 9e19f, 1e30f, FLT_MAX};
    static const double cells[] = {1e-6, 1.0, 1e6};
    for (int mode = 0; mode < ALP_LPV_MODE_COUNT; mode++) {
        for (size_t i = 0; i < 8 * 8 * 3; i++) {
            expect_finite((alp_lpv_mode)mode, cells[i / 64], values[i % 8], values[i / 8 % 8]);
        }
    }
}

/// An area or a flux that would overflow is left out and counted.
TEST(surfels_that_overflow_are_counted)
{
    const float huge[1][3] = {{1e30f, 0.0f, 0.0f}}, area = 1e30f;
    const alp_lpv_surfels s = {
        .count = 1, .positions = place, .normals = up, .flux = huge, .areas = &area};
    alp_lpv *lpv = lpv_open(context, lpv_cube(4, 1e-6));
    ASSERT_OK(context, alp_lpv_add_light(lpv, ALP_LPV_ALL_CASCADES, &s));
    assert_true(alp_lpv_skipped(lpv) == 1);
    ASSERT_OK(context, alp_lpv_add_blockers(lpv, ALP_LPV_ALL_CASCADES, &s));
    assert_true(alp_lpv_skipped(lpv) == 2);
    alp_lpv_destroy(lpv);
}

/// E of a light scales with it by the same factor, in both modes: damping depends on ratios alone.
TEST(fields_scale_with_their_light)
{
    enum { POINTS = 40, FACTORS = 4 };
    static const int powers[FACTORS] = {0, 40, -60, 60}; // of two: the same bits
    float p[POINTS][3], n[POINTS][3], e[FACTORS][POINTS][3];
    for (int i = 0; i < POINTS; i++) {
        for (int k = 0; k < 3; k++) {
            p[i][k] = (float)(i * (2 * k + 3) % 11) * 0.4f - 2.0f;
        }
        vec3_store(n[i], field_tilted(0.08 * i, 0.7 * i));
    }
    for (int mode = 0; mode < ALP_LPV_MODE_COUNT; mode++) {
        for (int i = 0; i < FACTORS; i++) {
            alp_lpv_options o = lpv_cube(12, 1.0);
            o.mode = (alp_lpv_mode)mode;
            alp_lpv *lpv = lpv_open(context, o);
            alp_field *field = NULL;
            lpv_add_one(context, lpv, place[0], up[0], ldexpf(1.0f, powers[i]));
            ASSERT_OK(context, alp_lpv_propagate(lpv));
            ASSERT_OK(context, alp_field_create_lpv(lpv, &field));
            alp_field_irradiance(field, POINTS, (const float(*)[3])p, (const float(*)[3])n, e[i]);
            for (int k = 0; k < 3 * POINTS; k++) {
                assert_true(e[i][k / 3][k % 3] == ldexpf(e[0][k / 3][k % 3], powers[i]));
            }
            alp_field_destroy(field);
            alp_lpv_destroy(lpv);
        }
    }
}

// --- cameras -------------------------------------------------------------------------------------

static alp_scene *make_floor(float half)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    const vec3 grey = {0.5f, 0.5f, 0.5f}, glow = {1.0f, 1.0f, 1.0f};
    alpi_builder_start(&b, context, "floor");
    alpi_builder_surface(&b, "floor", alpi_builder_material(&b, "floor", grey, glow));
    alpi_builder_quad(
        &b,
        (const vec3[4]){{-half, 0, half}, {half, 0, half}, {half, 0, -half}, {-half, 0, -half}});
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

static const alp_camera from_above = {
    .position = {0.0f, 2.0f, 0.0f}, .up = {0.0f, 0.0f, -1.0f}, .vertical_fov = 0.9272952f};

TEST(cameras_that_see_nothing_are_refused)
{
    enum { BAD = 9 };
    alp_camera bad[BAD];
    float aspects[BAD];
    alp_scene *scene = make_floor(4.0f);
    alp_lpv *lpv = lpv_open(context, lpv_cube(8, 1.0));
    for (int i = 0; i < BAD; i++) {
        bad[i] = from_above;
        aspects[i] = 1.0f;
    }
    bad[0].vertical_fov = NAN;
    bad[1].vertical_fov = 0.0f;
    bad[2].vertical_fov = 4.0f;
    bad[3].position[1] = NAN;
    bad[4].target[1] = 2.0f; // at the position
    bad[5].up[2] = 0.0f;
    bad[5].up[1] = 1.0f; // along the view
    bad[6].target[0] = HUGE_VALF;
    aspects[7] = 0.0f;
    aspects[8] = NAN;
    for (int i = 0; i < BAD; i++) {
        for (uint32_t points = 0; points <= 16; points += 16) {
            alp_lpv_scene_options o = alp_lpv_scene_options_default();
            o.points = points;
            o.camera = &bad[i];
            o.camera_aspect = aspects[i];
            expect_refusal(alp_lpv_light_scene(lpv, scene, &o, NULL), "camera");
        }
    }
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
}

/// A camera 2 m above a floor sees 2 m along its up and aspect × 2 m across.
TEST(a_camera_sees_by_its_aspect_and_up)
{
    alp_scene *scene = make_floor(20.0f);
    for (int turned = 0; turned < 2; turned++) {
        alp_camera camera = from_above;
        alp_lpv_scene_options o = alp_lpv_scene_options_default();
        alp_lpv *lpv = lpv_open(context, lpv_cube(16, 0.5));
        if (turned == 1) {
            camera.up[0] = 1.0f;
            camera.up[2] = 0.0f;
        }
        o.points = 0;
        o.camera = &camera;
        o.camera_aspect = 3.0f;
        ASSERT_OK(context, alp_lpv_light_scene(lpv, scene, &o, NULL));
        double area = 0.0, reach[2] = {0.0, 0.0};
        for (size_t z = 0; z < 17; z++) {
            for (size_t x = 0; x < 17; x++) {
                const float *row = lpv->grids[0].nodes + (z * 17 + 8) * 17 * ALPI_LPV_NODE_TERMS;
                const double seen = 4.0 * 0.25 * (double)row[x * ALPI_LPV_NODE_TERMS];
                area += seen;
                reach[0] = seen > 0.02 ? fmax(reach[0], fabs(0.5 * (double)x - 4.0)) : reach[0];
                reach[1] = seen > 0.02 ? fmax(reach[1], fabs(0.5 * (double)z - 4.0)) : reach[1];
            }
        }
        ASSERT_NEAR(area, 2.0 * 6.0, 0.05);
        ASSERT_NEAR(reach[turned], 3.0, 0.01);
        ASSERT_NEAR(reach[1 - turned], 1.0, 0.01);
        alp_lpv_destroy(lpv);
    }
    alp_scene_destroy(scene);
}

/// An emissive cube of 10 cm in cells of 1 m gives all its light.
TEST(small_lamps_light_coarse_grids)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    const vec3 black = {0.0f, 0.0f, 0.0f}, glow = {2.0f, 2.0f, 2.0f};
    alpi_builder_start(&b, context, "small lamp");
    alpi_builder_surface(&b, "lamp", alpi_builder_material(&b, "lamp", black, glow));
    alpi_builder_box(&b, (vec3){0.1f, 0.1f, 0.1f}, (vec3){0.2f, 0.2f, 0.2f}, ALPI_FACE_ALL);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    alp_lpv_options options = lpv_cube(8, 1.0);
    options.cascades = 2;
    alp_lpv *lpv = lpv_open(context, options);
    alp_lpv_report report;
    ASSERT_OK(context, alp_lpv_light_scene(lpv, scene, NULL, &report));
    const double flux = FIELD_PI * 2.0 * 0.06; // π L A
    for (int c = 0; c < 2; c++) {
        ASSERT_NEAR(lpv_flux(&lpv->grids[c], lpv->grids[c].injected) / flux, 1.0, 1e-3);
    }
    alp_lpv_destroy(lpv);
    alp_scene_destroy(scene);
}
