// SPDX-License-Identifier: MIT
// Kept hits that are relit: closed forms, the same bits however they were made, and the light of
// alpi_sphere_gather.
#include "test_lit.h"

#include "base/random.h"
#include "scene/builtin/mesh_builder.h"
#include "transport/sphere/sphere_hits.h"

#include <stdatomic.h>
#include <stdlib.h>

TEST_CONTEXT(1);

enum { FACE = 16, HITS = 6 * FACE * FACE };
static const float Y0 = 0.28209479f, Y1 = 0.48860251f;
static const float ALBEDO = 0.64f; // (204/255)²: hits keep it exactly

static alpi_sphere_relight relight_of(const test_lit *lit)
{
    return (alpi_sphere_relight){.context = lit->scene->context,
                                 .scene = lit->scene,
                                 .tracer = lit->tracer,
                                 .lighting = lit->lighting,
                                 .seed = 1};
}

static alpi_sphere_light light_at(const alpi_sphere_relight *how, vec3 point, uint32_t key,
                                  bool direct)
{
    alpi_sphere_hits_point at = {
        .point = point, .key = key, .face = FACE, .reach = 4.0f, .direct = direct};
    ASSERT_OK(how->context, alpi_sphere_hits_gather(how, &at, 1, NULL));
    return at.value;
}

/// Means over keys, with the standard errors of these.
static alpi_sphere_light mean_light(const alpi_sphere_relight *how, vec3 point, uint32_t keys)
{
    alpi_sphere_light mean = {0};
    double sums[27] = {0.0}, squares[27] = {0.0};
    for (uint32_t key = 0; key < keys; key++) {
        const alpi_sphere_light one = light_at(how, point, key, false);
        for (int i = 0; i < 27; i++) {
            sums[i] += (double)one.light.c[i / 3][i % 3];
            squares[i] += (double)one.light.c[i / 3][i % 3] * (double)one.light.c[i / 3][i % 3];
        }
    }
    for (int i = 0; i < 27; i++) {
        const double m = sums[i] / keys;
        mean.light.c[i / 3][i % 3] = (float)m;
        mean.variance.c[i / 3][i % 3] = (float)(fmax(squares[i] / keys - m * m, 0.0) / (keys - 1));
    }
    return mean;
}

/// A quad of `half` metres to either side at height 0, seen from above.
static alp_scene *floor_scene(float half, float albedo, bool double_sided)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    const vec3 black = {0.0f, 0.0f, 0.0f}, color = {albedo, albedo, albedo};
    alpi_builder_start(&b, context, "floor");
    alpi_builder_surface(&b, "floor", alpi_builder_material(&b, "floor", color, black));
    alpi_builder_quad(&b, (const vec3[4]){{-half, 0.0f, half},
                                          {half, 0.0f, half},
                                          {half, 0.0f, -half},
                                          {-half, 0.0f, -half}});
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    scene->materials[0].double_sided = double_sided;
    return scene;
}

static alp_lighting_options sun_at(float elevation, float azimuth)
{
    alp_lighting_options o = alp_lighting_options_default();
    o.sun.illuminance = 3.0f;
    o.sun.elevation = elevation;
    o.sun.azimuth = azimuth;
    return o;
}

// --- closed forms --------------------------------------------------------------------------------

TEST(constant_sky_is_exact)
{
    alp_lighting_options o = alp_lighting_options_default();
    o.sky.kind = ALP_SKY_CONSTANT;
    o.sky.up[0] = o.sky.up[1] = o.sky.up[2] = 2.0f;
    test_lit lit = test_lit_open(floor_scene(1e-4f, 0.0f, false), &o);
    const alpi_sphere_relight how = relight_of(&lit);
    const alpi_sphere_light v = light_at(&how, (vec3){0.0f, 3.0f, 0.0f}, 5, false);
    ASSERT_NEAR(v.light.c[0][0], 2.0 * 2.0 * sqrt(ALPI_PI), 1e-5);
    for (int i = 1; i < ALPI_SH9_COUNT; i++) {
        ASSERT_NEAR(v.light.c[i][1], 0.0, 0.05);
    }
    assert_true(v.behind == 0.0f && v.back_distance == INFINITY);
    test_lit_close(&lit);
}

/// L = ρ E⊥ sin(elevation) / π from below; the sun itself if wanted.
TEST(floor_in_the_sun)
{
    const alp_lighting_options o = sun_at(0.6f, 0.0f);
    test_lit lit = test_lit_open(floor_scene(2000.0f, ALBEDO, false), &o);
    const alpi_sphere_relight how = relight_of(&lit);
    const vec3 point = {0.0f, 1.0f, 0.0f}, sun = {0.0f, sinf(0.6f), cosf(0.6f)};
    const alpi_sphere_light v = light_at(&how, point, 5, false);
    const double radiance = (double)(ALBEDO * 3.0f * sinf(0.6f)) / ALPI_PI;
    ASSERT_NEAR(v.light.c[0][0], 2.0 * ALPI_PI * radiance * (double)Y0, 2e-3 * radiance);
    ASSERT_NEAR(v.light.c[1][1], -ALPI_PI * radiance * (double)Y1, 1e-2 * radiance);
    ASSERT_NEAR(v.light.c[2][1], 0.0, 1e-2 * radiance);
    ASSERT_NEAR(v.light.c[8][1], 0.0, 2e-2 * radiance);
    ASSERT_NEAR(v.front_distance, 1.0, 0.01);
    const alpi_sphere_light with = light_at(&how, point, 5, true);
    float basis[ALPI_SH9_COUNT];
    alpi_sh9_basis(sun, basis);
    for (int i = 0; i < ALPI_SH9_COUNT; i++) {
        ASSERT_NEAR(with.light.c[i][0] - v.light.c[i][0], 3.0f * basis[i], 2e-3);
    }
    test_lit_close(&lit);
}

/// Double-sided surfaces are lit on the side that is met; the backs of others are black.
TEST(sides)
{
    const alp_lighting_options o = sun_at(0.6f, 0.0f);
    const vec3 below = {0.0f, -1.0f, 0.0f};
    for (int sides = 1; sides <= 2; sides++) {
        test_lit lit = test_lit_open(floor_scene(2000.0f, ALBEDO, sides == 2), &o);
        const alpi_sphere_relight how = relight_of(&lit);
        const alpi_sphere_light v = light_at(&how, below, 5, false);
        assert_true(v.light.c[0][0] == 0.0f); // the sun is on the other side
        ASSERT_NEAR(v.behind, sides == 2 ? 0.0 : 0.5, 1e-3);
        ASSERT_NEAR(sides == 2 ? v.front_distance : v.back_distance, 1.0, 0.01);
        if (sides == 1) {
            assert_true(v.back_direction[1] > 0.99f);
        }
        test_lit_close(&lit);
    }
}

/// Hits are far away: none is shadowed by its own surface, none is lit through it.
TEST(far_hits_lie_on_their_side)
{
    const alp_lighting_options o = sun_at(0.1f, 0.7f);
    test_lit lit = test_lit_open(floor_scene(2000.0f, ALBEDO, true), &o);
    const alpi_sphere_relight how = relight_of(&lit);
    const double radiance = (double)(ALBEDO * 3.0f * sinf(0.1f)) / ALPI_PI;
    const double solid_angle = 4.0 * asin(4.0 / 6.25); // of the floor from above
    alpi_sphere_light v = mean_light(&how, (vec3){0.0f, 1500.0f, 0.0f}, 16);
    ASSERT_NEAR(v.light.c[0][0], solid_angle * radiance * (double)Y0, 0.005 * radiance);
    v = mean_light(&how, (vec3){0.0f, -1500.0f, 0.0f}, 16);
    assert_true(v.light.c[0][0] == 0.0f);
    test_lit_close(&lit);
}

/// Radiance 1 from walls that glow, whatever the direction.
TEST(glowing_room_is_exact)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    const vec3 black = {0.0f, 0.0f, 0.0f}, one = {1.0f, 1.0f, 1.0f};
    alpi_builder_start(&b, context, "room");
    alpi_builder_surface(&b, "walls", alpi_builder_material(&b, "walls", black, one));
    alpi_builder_box(&b, (vec3){1.0f, 1.0f, 1.0f}, (vec3){-1.0f, -1.0f, -1.0f}, ALPI_FACE_ALL);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    test_lit lit = test_lit_open(scene, NULL);
    alpi_sphere_relight how = relight_of(&lit);
    alpi_sphere_light v = light_at(&how, (vec3){0.3f, 0.1f, 0.0f}, 5, false);
    ASSERT_NEAR(v.light.c[0][2], 2.0 * sqrt(ALPI_PI), 1e-5);
    how.aimed = lit.lighting; // found by other rays now, once
    v = light_at(&how, (vec3){0.3f, 0.1f, 0.0f}, 5, false);
    ASSERT_NEAR(v.light.c[0][2], 2.0 * sqrt(ALPI_PI), 0.05);
    test_lit_close(&lit);
}

/// Half the light goes through a pane: the sky seen through it, and the sun's on the floor.
TEST(panes_let_light_through)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    const vec3 black = {0.0f, 0.0f, 0.0f}, one = {1.0f, 1.0f, 1.0f};
    alp_lighting_options o = sun_at(1.2f, 0.0f);
    o.sky.kind = ALP_SKY_CONSTANT;
    alpi_builder_start(&b, context, "glass");
    alpi_builder_surface(&b, "glass", alpi_builder_material(&b, "glass", one, black));
    alpi_builder_box(&b, (vec3){-1.0f, -1.0f, -1.0f}, (vec3){1.0f, 1.0f, 1.0f}, ALPI_FACE_ALL);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    scene->materials[0].alpha_mode = ALPI_ALPHA_BLEND;
    scene->materials[0].base_color[3] = 0.5f;
    scene->materials[0].double_sided = true;
    test_lit lit = test_lit_open(scene, &o);
    const alpi_sphere_relight how = relight_of(&lit);
    const alpi_sphere_light v = mean_light(&how, (vec3){0.2f, 0.1f, -0.3f}, 32);
    // The sky through the pane; and the sun, dimmed by half, on the floor, whose pane reflects half
    // of its albedo of .95: L = .5 · .95 · .5 E / π over its solid angle.
    alpi_sphere_light far = v;
    const double sky = 2.0 * sqrt(ALPI_PI) * 0.5;
    assert_true((double)v.light.c[0][0] > sky);
    far = mean_light(&how, (vec3){0.2f, 30.0f, -0.3f}, 4);
    ASSERT_NEAR(far.light.c[0][0], 2.0 * sqrt(ALPI_PI), 0.02); // outside
    alp_lighting_options no_sun = o;
    no_sun.sun.illuminance = 0.0f;
    alpi_lighting *dark = NULL;
    ASSERT_OK(context, alpi_lighting_create(scene, &no_sun, &dark));
    alpi_sphere_relight without = how;
    without.lighting = dark;
    const alpi_sphere_light w = mean_light(&without, (vec3){0.2f, 0.1f, -0.3f}, 32);
    ASSERT_NEAR(w.light.c[0][0], sky, 4.0 * sqrt((double)w.variance.c[0][0]) + 1e-3);
    // From the centre the floor fills a sixth of the sphere.
    const vec3 centre = {0.0f, 0.0f, 0.0f};
    const alpi_sphere_light a = mean_light(&how, centre, 64), c = mean_light(&without, centre, 64);
    const double e = 3.0 * (double)sinf(1.2f), wall = 3.0 * (double)cosf(1.2f);
    const double expected =
        (0.5 * 0.95 / ALPI_PI) * 0.5 * (e + wall) * (4.0 * ALPI_PI / 6.0) * (double)Y0;
    ASSERT_NEAR(a.light.c[0][0] - c.light.c[0][0], expected, 0.05 * expected);
    alpi_lighting_destroy(context, dark);
    test_lit_close(&lit);
}

// --- the same bits -------------------------------------------------------------------------------

typedef struct call_counter {
    atomic_uint *calls;
} call_counter;

/// E by place and normal: a function of these alone.
static void bounce_test(const void *user, uint32_t count, const vec3 *points, const vec3 *normals,
                        vec3 *irradiance)
{
    assert_true(count > 0 && count <= ALPI_PACKET);
    for (uint32_t i = 0; i < count; i++) {
        const float x = 1.0f + 0.5f * sinf(0.1f * points[i].x + 0.07f * points[i].z) + normals[i].y;
        irradiance[i] = (vec3){x, x + 0.1f * normals[i].x, 0.5f * x};
    }
    if (user != NULL) {
        const call_counter *counter = user;
        atomic_fetch_add(counter->calls, count);
    }
}

static alpi_lighting *clear_day(const alp_scene *scene, float elevation, float azimuth)
{
    alpi_lighting *lighting = NULL;
    alp_lighting_options o = sun_at(elevation, azimuth);
    o.sky.kind = ALP_SKY_CLEAR;
    o.sun.illuminance = 1e4f;
    ASSERT_OK(scene->context, alpi_lighting_create_quietly(scene, &o, &lighting));
    return lighting;
}

enum { POINTS = 9 };

static vec3 point_of(const alp_scene *scene, uint32_t i)
{
    const vec3 low = scene->bounds_min, high = scene->bounds_max;
    const float x = alpi_unit_float(alpi_hash32(2 * i)),
                z = alpi_unit_float(alpi_hash32(2 * i + 1));
    return (vec3){low.x + x * (high.x - low.x), high.y - 0.1f * (float)i,
                  low.z + z * (high.z - low.z)};
}

typedef struct hits_bits {
    alpi_sphere_light anew[POINTS], relit[POINTS], kept[POINTS];
    float moments[POINTS][ALPI_SPHERE_MOMENTS][2];
    alpi_sphere_hit hits[POINTS][HITS];
} hits_bits;

static void gather_all(const alpi_sphere_relight *how, hits_bits *bits, bool keep, bool traced,
                       alpi_sphere_light *values)
{
    alpi_sphere_hits_point points[POINTS];
    for (uint32_t i = 0; i < POINTS; i++) {
        points[i] = (alpi_sphere_hits_point){.point = point_of(how->scene, i),
                                             .key = 3 * i,
                                             .face = i % 2 == 0 ? FACE : 4,
                                             .hits = keep ? bits->hits[i] : NULL,
                                             .traced = traced,
                                             .moments = keep ? bits->moments[i] : NULL,
                                             .reach = 4.0f,
                                             .direct = i % 3 == 0};
    }
    ASSERT_OK(how->context, alpi_sphere_hits_gather(how, points, POINTS, NULL));
    for (uint32_t i = 0; i < POINTS; i++) {
        values[i] = points[i].value;
    }
}

/// Traces under one sun, relights under another, and traces anew there.
static void make_bits(uint32_t workers, const void *name, void *bytes)
{
    hits_bits *bits = bytes;
    alp_context *own = test_context(workers);
    test_lit lit = test_lit_open(test_load(own, name), NULL);
    alpi_lighting *morning = clear_day(lit.scene, 0.2f, 1.0f);
    alpi_lighting *noon = clear_day(lit.scene, 1.1f, -0.6f);
    alpi_sphere_relight how = relight_of(&lit);
    how.lighting = morning;
    how.bounce = bounce_test;
    how.bounce_cell_scale = 0.1f;
    gather_all(&how, bits, true, false, bits->kept);
    how.lighting = noon;
    gather_all(&how, bits, true, true, bits->relit);
    gather_all(&how, bits, false, false, bits->anew);
    alpi_lighting_destroy(own, morning);
    alpi_lighting_destroy(own, noon);
    test_lit_close(&lit);
    alp_context_destroy(own);
}

static void check_bits(const char *name)
{
    hits_bits *bits = test_any_workers(make_bits, name, sizeof *bits);
    assert_memory_equal(bits->relit, bits->anew, sizeof bits->anew);
    assert_memory_not_equal(bits->kept, bits->anew, sizeof bits->anew);
    assert_true(bits->moments[1][9][0] > 0.0f);
    free(bits);
}

TEST(relit_as_traced_anew_by_any_workers)
{
    check_bits("builtin:terrain,triangles=20000");
}

TEST(relit_as_traced_anew_in_a_room)
{
    check_bits("builtin:windows"); // with panes
}

// --- light of surfaces ---------------------------------------------------------------------------

/// The path tracer at points, on a context of its own: loops do not nest.
typedef struct truth {
    alpi_reference reference;
} truth;

static void find_truth(const truth *t, uint32_t count, const vec3 *points, const vec3 *normals,
                       vec3 *irradiance)
{
    alpi_reference_value values[ALPI_PACKET];
    test_lit_irradiance(&t->reference, points, normals, 0.0f, count, values);
    for (uint32_t i = 0; i < count; i++) {
        irradiance[i] = vec3_load(values[i].mean);
    }
}

static void bounce_truth(const void *user, uint32_t count, const vec3 *points, const vec3 *normals,
                         vec3 *irradiance)
{
    find_truth(user, count, points, normals, irradiance);
}

/// The radiance of surfaces by the same.
static void reflect_truth(const void *user, const alpi_surface_point *at, uint32_t count,
                          vec3 *radiance)
{
    const truth *t = user;
    const alp_scene *scene = t->reference.scene;
    vec3 points[ALPI_PACKET] = {{0.0f, 0.0f, 0.0f}}, normals[ALPI_PACKET] = {{0.0f, 0.0f, 0.0f}};
    for (uint32_t i = 0; i < count; i++) {
        vec3 c[3];
        alpi_triangle_corners(scene, at[i].triangle, c);
        vec3 n = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
        n = vec3_scale(n, vec3_dot(n, at[i].toward) < 0.0f ? -1.0f : 1.0f);
        const vec3 p = vec3_mad(vec3_mad(c[0], at[i].b1, vec3_sub(c[1], c[0])), at[i].b2,
                                vec3_sub(c[2], c[0]));
        points[i] = vec3_mad(p, 1e-6f, n);
        normals[i] = n;
    }
    find_truth(t, count, points, normals, radiance);
    for (uint32_t i = 0; i < count; i++) {
        const vec3 a = alpi_surface_albedo(scene, at[i].triangle, at[i].b1, at[i].b2);
        const float k = 1.0f / (float)ALPI_PI;
        radiance[i] =
            (vec3){k * a.x * radiance[i].x, k * a.y * radiance[i].y, k * a.z * radiance[i].z};
    }
}

/// A lamp, an emissive surface, and all bounces: as alpi_sphere_gather that is told all light of
/// surfaces.
TEST_SLOW(room_is_lit_as_by_the_reference)
{
    enum { KEYS = 16 };
    alp_context *own = test_context(1);
    alp_lighting_options o = alp_lighting_options_default();
    alp_lamp lamp = alp_lamp_default();
    lamp.intensity = 0.2f;
    lamp.position[0] = lamp.position[1] = 0.4f;
    lamp.position[2] = 0.25f;
    o.lamps = &lamp;
    o.lamp_count = 1;
    test_lit lit = test_lit_open(test_load(own, "builtin:cornell"), &o);
    alpi_lighting *without = NULL;
    ASSERT_OK(own, alpi_lighting_create_without_lamps(lit.scene, &o, &without));
    const truth all = {test_lit_reference(&lit, ALPI_REFERENCE_BOUNCE_LIMIT, 32)};
    truth bounced = all;
    bounced.reference.direct = without;
    const vec3 point = {0.2f, 0.35f, 0.15f};
    alpi_sphere_relight how = relight_of(&lit);
    how.context = context;
    how.bounce = bounce_truth;
    how.bounce_user = &bounced;
    const alpi_sphere_light ours = mean_light(&how, point, KEYS);
    const alpi_sphere_rays rays = {.context = context,
                                   .from = {.scene = lit.scene,
                                            .tracer = lit.tracer,
                                            .lighting = lit.lighting,
                                            .light = {.reflected = reflect_truth, .user = &all},
                                            .emitters = true},
                                   .face = FACE,
                                   .replicates = KEYS,
                                   .seed = 1};
    alpi_sphere_light theirs;
    const float places[1][3] = {{point.x, point.y, point.z}};
    const alpi_sphere_job job = {.rays = &rays, .points = places, .count = 1, .values = &theirs};
    ASSERT_OK(context, alpi_sphere_gather(&job, NULL));
    for (int i = 0; i < 27; i++) {
        const double a = (double)ours.light.c[i / 3][i % 3];
        const double b = (double)theirs.light.c[i / 3][i % 3];
        const double noise =
            sqrt((double)ours.variance.c[i / 3][i % 3] + (double)theirs.variance.c[i / 3][i % 3]);
        const double scale = (double)theirs.light.c[0][i % 3];
        ASSERT_NEAR(a, b, 0.01 * scale + 3.0 * noise);
        assert_true(i >= 3 || noise < 0.02 * scale);
    }
    alpi_lighting_destroy(own, without);
    test_lit_close(&lit);
    alp_context_destroy(own);
}

/// Neighbouring hits that share a call: far fewer calls, nearly the same light.
TEST(shared_bounces_change_little)
{
    test_lit lit = test_lit_open(test_load(context, "builtin:terrain,triangles=20000"), NULL);
    atomic_uint calls[2] = {0, 0};
    double worst = 0.0;
    for (uint32_t k = 0; k < POINTS; k++) {
        alpi_sphere_light v[2];
        for (int shared = 0; shared < 2; shared++) {
            const call_counter counter = {&calls[shared]};
            alpi_sphere_relight how = relight_of(&lit);
            how.bounce = bounce_test;
            how.bounce_user = &counter;
            how.bounce_cell_scale = shared == 1 ? 1.0f : 0.0f;
            how.bounce_cell_least = shared == 1 ? 1.0f : 0.0f;
            v[shared] = light_at(&how, point_of(lit.scene, k), k, false);
        }
        for (int i = 0; i < ALPI_SH9_COUNT; i++) {
            worst = fmax(worst, fabs((double)(v[1].light.c[i][0] - v[0].light.c[i][0])) /
                                    (double)v[0].light.c[0][0]);
        }
    }
    assert_true(calls[1] < calls[0]);
    assert_true(worst < 0.01);
    test_lit_close(&lit);
}

// --- many lamps ----------------------------------------------------------------------------------

/// Lamps above a floor that are drawn give what each of them gives alone.
TEST(many_lamps_are_drawn_without_bias)
{
    enum { LAMPS = 24, TOGETHER = 6, KEYS = 24 };
    alp_lamp lamps[LAMPS];
    for (uint32_t i = 0; i < LAMPS; i++) {
        lamps[i] = alp_lamp_default();
        lamps[i].intensity = i % 3 == 0 ? 2.0f : 0.3f;
        lamps[i].position[0] = 8.0f * alpi_unit_float(alpi_hash32(2 * i)) - 4.0f;
        lamps[i].position[1] = 1.0f;
        lamps[i].position[2] = 8.0f * alpi_unit_float(alpi_hash32(2 * i + 1)) - 4.0f;
    }
    const vec3 point = {0.0f, 2.0f, 0.0f};
    alp_scene *scene = floor_scene(5.0f, ALBEDO, false);
    test_lit lit = test_lit_open(scene, NULL);
    double expected[4] = {0.0}, error[4] = {0.0};
    for (uint32_t first = 0; first < LAMPS; first += TOGETHER) {
        alp_lighting_options o = alp_lighting_options_default();
        alpi_lighting *some = NULL;
        o.lamps = lamps + first;
        o.lamp_count = TOGETHER;
        ASSERT_OK(context, alpi_lighting_create(scene, &o, &some));
        alpi_sphere_relight how = relight_of(&lit);
        how.lighting = some;
        const alpi_sphere_light v = mean_light(&how, point, KEYS);
        for (int i = 0; i < 4; i++) {
            expected[i] += (double)v.light.c[i][0];
            error[i] += (double)v.variance.c[i][0];
        }
        alpi_lighting_destroy(context, some);
    }
    alp_lighting_options o = alp_lighting_options_default();
    alpi_lighting *all = NULL;
    o.lamps = lamps;
    o.lamp_count = LAMPS;
    ASSERT_OK(context, alpi_lighting_create(scene, &o, &all));
    alpi_sphere_relight how = relight_of(&lit);
    how.lighting = all;
    const alpi_sphere_light v = mean_light(&how, point, KEYS);
    for (int i = 0; i < 4; i++) {
        const double noise = sqrt((double)v.variance.c[i][0] + error[i]);
        ASSERT_NEAR(v.light.c[i][0], expected[i], 4.0 * noise);
        assert_true(noise < 0.02 * expected[0]);
    }
    alpi_lighting_destroy(context, all);
    test_lit_close(&lit);
}

// --- errors --------------------------------------------------------------------------------------

/// The variance that a point states is that of its values over keys, or somewhat more.
TEST(variance_is_that_over_keys)
{
    enum { KEYS = 64 };
    test_lit lit = test_lit_open(test_load(context, "builtin:terrain,triangles=20000"), NULL);
    alpi_lighting *day = clear_day(lit.scene, 0.5f, 0.3f);
    alpi_sphere_relight how = relight_of(&lit);
    how.lighting = day;
    double stated = 0.0, found = 0.0;
    for (uint32_t k = 0; k < 3; k++) {
        const vec3 point = point_of(lit.scene, k);
        const alpi_sphere_light mean = mean_light(&how, point, KEYS);
        for (uint32_t key = 0; key < KEYS; key++) {
            const alpi_sphere_light v = light_at(&how, point, key, false);
            for (int i = 0; i < ALPI_SH9_COUNT; i++) {
                stated += (double)v.variance.c[i][1] / KEYS;
            }
        }
        for (int i = 0; i < ALPI_SH9_COUNT; i++) {
            found += (double)mean.variance.c[i][1] * KEYS;
        }
    }
    assert_true(stated > 0.8 * found && stated < 8.0 * found);
    alpi_lighting_destroy(context, day);
    test_lit_close(&lit);
}
