// SPDX-License-Identifier: MIT
// The ambience volume sampled by rays: closed forms, relighting, budgets, solids, the same bits for
// any number of workers, and each allocation that fails.
#include "ambience_world.h"
#include "field_scenes.h"

#include "fields/truth.h"
#include "transport/sphere/sphere_hits.h"

TEST_CONTEXT(2);

typedef struct live {
    alp_scene *scene;
    alp_ambience *ambience;
    alp_ambience_sampler *sampler;
    alp_ambience_camera camera;
    double time;
} live;

static live open_live(alp_scene *scene, const alp_ambience_options *options,
                      const alp_ambience_sampler_options *sampling)
{
    live l = {.scene = scene};
    l.ambience = world_open(scene->context, options);
    ASSERT_OK(scene->context, alp_ambience_sampler_create(l.ambience, scene, sampling, &l.sampler));
    return l;
}

static void close_live(live *l)
{
    alp_ambience_sampler_destroy(l->sampler);
    alp_ambience_destroy(l->ambience);
    alp_scene_destroy(l->scene);
}

static alp_ambience_work step_live(live *l, double step, uint32_t samples)
{
    alp_ambience_work work = {0};
    alp_context *own = l->ambience->context;
    l->time += step;
    ASSERT_OK(own, alp_ambience_update(l->ambience, l->time));
    ASSERT_OK(own, alp_ambience_sample(l->sampler, &l->camera, samples, 0.0, &work));
    return work;
}

static void read_live(const live *l, vec3 p, vec3 n, float e[3])
{
    const double place[1][3] = {{(double)p.x, (double)p.y, (double)p.z}};
    const float normal[1][3] = {{n.x, n.y, n.z}};
    float found[1][3];
    const alp_ambience_snapshot *s = alp_ambience_begin_read(l->ambience);
    alp_ambience_irradiance(s, 1, place, normal, found);
    memcpy(e, found[0], sizeof found[0]);
    alp_ambience_end_read(l->ambience, s);
}

static alp_ambience_options room_options(double size, uint32_t depth)
{
    alp_ambience_options o = alp_ambience_options_default();
    o.size = size;
    o.depth = depth;
    o.lifetime = 1.0;
    o.fade = 0.2;
    return o;
}

/// Oracle 14: in a furnace, E = M / (1 − ρ). Light that bounces more than once comes from the
/// volume itself: it arrives with renewals.
TEST(a_furnace_converges_through_the_volume)
{
    const float albedo = 0.5f, emission = 1.0f;
    alp_scene *room = field_room(context, (vec3){4.0f, 4.0f, 4.0f}, albedo, emission);
    const alp_ambience_options o = room_options(4.5, 1);
    live l = open_live(room, &o, NULL);
    for (int k = 0; k < 3; k++) {
        const float low = k == 0   ? room->bounds_min.x
                          : k == 1 ? room->bounds_min.y
                                   : room->bounds_min.z;
        const float high = k == 0   ? room->bounds_max.x
                           : k == 1 ? room->bounds_max.y
                                    : room->bounds_max.z;
        l.ambience->options.centre[k] = l.camera.position[k] = 0.5 * (double)(low + high);
    }
    float e[3];
    const vec3 middle = {(float)l.camera.position[0], (float)l.camera.position[1],
                         (float)l.camera.position[2]};
    (void)step_live(&l, 0.0, 100);
    (void)step_live(&l, 0.1, 100);
    read_live(&l, middle, (vec3){0.0f, 1.0f, 0.0f}, e);
    const double one = FIELD_PI * (double)emission;
    assert_true((double)e[1] >= 0.99 * one && (double)e[1] <= 1.6 * one); // not all bounces yet
    for (int i = 0; i < 200; i++) {
        (void)step_live(&l, 0.1, 100);
    }
    read_live(&l, middle, (vec3){0.6f, 0.8f, 0.0f}, e);
    ASSERT_NEAR(e[1], one / (1.0 - (double)albedo), 0.01 * one / 0.5);
    close_live(&l);
}

/// A sky of even radiance over nothing: E = π L everywhere, from the first sample on.
TEST(an_even_sky_is_exact)
{
    alp_ambience_sampler_options s = alp_ambience_sampler_options_default();
    s.lighting.sky.kind = ALP_SKY_CONSTANT;
    for (int k = 0; k < 3; k++) {
        s.lighting.sky.up[k] = 2.0f;
    }
    alp_ambience_options o = alp_ambience_options_default();
    o.centre[0] = 0.37; // no anchor lies on a speck
    live l = open_live(field_specks(context), &o, &s);
    float e[3];
    for (int i = 0; i < 5; i++) {
        (void)step_live(&l, 0.1, 50);
    }
    read_live(&l, (vec3){0.3f, -0.2f, 0.4f}, (vec3){0.0f, 0.0f, -1.0f}, e);
    ASSERT_NEAR(e[2], 2.0 * FIELD_PI, 0.04); // c00 is exact, c1 noisy
    close_live(&l);
}

/// ∫ L Y00 of what a sky sends.
static double integrate_sky(const alp_scene *scene, const alp_lighting_options *options)
{
    enum { ROWS = 512 };
    alpi_lighting *lighting = NULL;
    double sum = 0.0;
    ASSERT_OK(scene->context, alpi_lighting_create(scene, options, &lighting));
    for (int i = 0; i < 2 * ROWS * ROWS; i++) {
        const double step = FIELD_PI / ROWS;
        const double theta = (i / (2 * ROWS) + 0.5) * step, phi = (i % (2 * ROWS) + 0.5) * step;
        const vec3 d = {(float)(sin(theta) * cos(phi)), (float)cos(theta),
                        (float)(sin(theta) * sin(phi))};
        sum += ALP_SH_Y0 * (double)alpi_lighting_escaped(lighting, d).x * sin(theta) * step * step;
    }
    alpi_lighting_destroy(scene->context, lighting);
    return sum;
}

/// A dim sky with one bright pixel, which holds most of its light: rays are aimed at it.
TEST(a_bright_spot_of_the_sky_is_found)
{
    enum { WIDTH = 32, HEIGHT = 16 };
    const alp_image_info info = {WIDTH, HEIGHT, 3, ALP_COMPONENT_FLOAT};
    alp_image *image = NULL;
    alp_ambience_options o = alp_ambience_options_default();
    alp_ambience_sampler_options s = alp_ambience_sampler_options_default();
    ASSERT_OK(context, alp_image_create(context, info, &image));
    float *pixels = image->pixels;
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++) {
        pixels[i] = i / 3 == 4 * WIDTH + 9 ? 1000.0f : 0.5f;
    }
    o.centre[0] = 0.37; // no anchor lies on a speck
    s.lighting.sky.kind = ALP_SKY_IMAGE;
    s.lighting.sky.image = image;
    live l = open_live(field_specks(context), &o, &s);
    const double p[3] = {0.3, -0.2, 0.4}, exact = integrate_sky(l.scene, &s.lighting);
    for (int i = 0; i < 2; i++) { // of the first lighting, and of another
        ASSERT_OK(context, alp_ambience_sampler_warm(l.sampler, &l.camera, 0.0, 1));
        const alp_ambience_snapshot *now = alp_ambience_begin_read(l.ambience);
        alp_sh9 light;
        alp_ambience_coefficients(now, p, &light);
        alp_ambience_end_read(l.ambience, now);
        ASSERT_NEAR(light.c[0][0], exact, 0.02 * exact);
        ASSERT_OK(context, alp_ambience_sampler_set_lighting(l.sampler, &s.lighting));
    }
    close_live(&l);
    alp_image_destroy(image);
}

static alp_ambience_sampler_options sunny(float azimuth)
{
    alp_ambience_sampler_options s = alp_ambience_sampler_options_default();
    s.lighting.sky.kind = ALP_SKY_CONSTANT;
    for (int k = 0; k < 3; k++) {
        s.lighting.sky.up[k] = 1000.0f;
    }
    s.lighting.sun.illuminance = 50000.0f;
    s.lighting.sun.elevation = 0.8f;
    s.lighting.sun.azimuth = azimuth;
    return s;
}

/// After the sun turned, kept hits are relit, not traced, and give the light of a volume that was
/// sampled under the new sun.
TEST_SLOW(kept_hits_are_relit_when_the_sun_moves)
{
    alp_ambience_options o = room_options(27.0, 2);
    o.anchor_limit = 600;
    const alp_ambience_sampler_options before = sunny(0.5f), after = sunny(2.5f);
    live turned = open_live(test_load(context, "builtin:terrain"), &o, &before);
    live fresh = open_live(test_load(context, "builtin:terrain"), &o, &after);
    turned.camera.position[1] = fresh.camera.position[1] = 6.0;
    for (int i = 0; i < 30; i++) {
        (void)step_live(&turned, 0.02, 40);
        (void)step_live(&fresh, 0.02, 40);
    }
    const uint32_t held = alp_ambience_get_info(turned.ambience).anchors;
    ASSERT_OK(context, alp_ambience_sampler_set_lighting(turned.sampler, &after.lighting));
    uint32_t relit = 0, traced = 0;
    for (int i = 0; i < 30; i++) {
        const alp_ambience_work work = step_live(&turned, 0.02, 40);
        relit += work.relit;
        traced += work.samples;
        (void)step_live(&fresh, 0.02, 40);
    }
    assert_true(relit >= held);
    assert_int_equal(traced, 0);
    for (int i = 0; i < 300; i++) { // several bounces and renewals
        (void)step_live(&turned, 0.05, 100);
        (void)step_live(&fresh, 0.05, 100);
    }
    for (int i = 0; i < 10; i++) {
        float a[3], b[3];
        const vec3 p = {-4.0f + (float)i, 5.0f + 0.3f * (float)i, 2.0f};
        read_live(&turned, p, (vec3){0.0f, -1.0f, 0.0f}, a);
        read_live(&fresh, p, (vec3){0.0f, -1.0f, 0.0f}, b);
        ASSERT_NEAR(a[1], b[1], 0.01 * (double)b[1]);
    }
    close_live(&turned);
    close_live(&fresh);
}

/// A lamp that is switched off leaves no light after relighting and the fade.
TEST(a_lamp_leaves_no_trail)
{
    alp_lamp lamp = alp_lamp_default();
    alp_ambience_sampler_options s = alp_ambience_sampler_options_default();
    const alp_ambience_options o = room_options(4.5, 1);
    alp_lighting_options dim = alp_lighting_options_default();
    float lit[3], dark[3];
    lamp.intensity = 10.0f;
    s.lighting.lamps = &lamp;
    s.lighting.lamp_count = 1;
    s.bounces = false;
    live l = open_live(field_room(context, (vec3){4.0f, 4.0f, 4.0f}, 0.5f, 0.001f), &o, &s);
    const vec3 p = vec3_scale(vec3_add(l.scene->bounds_min, l.scene->bounds_max), 0.5f);
    lamp.position[0] = p.x;
    lamp.position[1] = p.y;
    lamp.position[2] = p.z;
    ASSERT_OK(context, alp_ambience_sampler_set_lighting(l.sampler, &s.lighting));
    for (int k = 0; k < 3; k++) {
        l.camera.position[k] = l.ambience->options.centre[k] = (double)(k == 0   ? p.x
                                                                        : k == 1 ? p.y
                                                                                 : p.z);
    }
    for (int i = 0; i < 20; i++) {
        (void)step_live(&l, 0.05, 100);
    }
    read_live(&l, p, (vec3){0.0f, 1.0f, 0.0f}, lit);
    assert_true(lit[0] > 0.1f);
    ASSERT_OK(context, alp_ambience_sampler_set_lighting(l.sampler, &dim));
    for (int i = 0; i < 7; i++) { // a step until it is relit, four of the fade
        (void)step_live(&l, 0.05, 100);
    }
    read_live(&l, p, (vec3){0.0f, 1.0f, 0.0f}, dark);
    ASSERT_NEAR(dark[0], FIELD_PI * 0.001, 1e-4);
    close_live(&l);
}

TEST(no_anchor_with_light_lies_in_a_solid)
{
    const alp_ambience_options o = room_options(9.0, 3);
    live l = open_live(test_load(context, "builtin:cornell"), &o, NULL);
    l.camera.position[0] = l.camera.position[1] = l.camera.position[2] = 0.27;
    for (int i = 0; i < 20; i++) {
        (void)step_live(&l, 0.02, 200);
    }
    const alp_ambience_info info = alp_ambience_get_info(l.ambience);
    assert_true(info.solids > 0);
    for (uint32_t i = 0; i < l.ambience->anchor_end; i++) {
        const alpi_anchor *at = &l.ambience->anchors[i];
        double place[3];
        alpi_sphere_hits_point p = {.key = 99, .face = 16};
        alpi_lighting *lighting = NULL;
        alpi_tracer *tracer = NULL;
        if (at->state != ALPI_ANCHOR_LIT || i % 7 != 0) {
            continue;
        }
        alpi_anchor_place(l.ambience, at, place);
        p.point = (vec3){(float)place[0], (float)place[1], (float)place[2]};
        ASSERT_OK(context, alpi_tracer_for_scene(l.scene, NULL, NULL, &tracer, NULL));
        ASSERT_OK(context, alpi_lighting_create(l.scene, NULL, &lighting));
        const alpi_sphere_relight how = {
            .context = context, .scene = l.scene, .tracer = tracer, .lighting = lighting};
        ASSERT_OK(context, alpi_sphere_hits_gather(&how, &p, 1, NULL));
        assert_true(p.value.behind <= 1.2f * ALPI_FREE_BACKS);
        alpi_lighting_destroy(context, lighting);
    }
    close_live(&l);
}

TEST(a_budget_is_kept)
{
    live l = open_live(test_load(context, "builtin:cornell"), NULL, NULL);
    alp_ambience_sampler_options s = l.sampler != NULL ? alp_ambience_sampler_options_default()
                                                       : (alp_ambience_sampler_options){0};
    for (int i = 0; i < 20; i++) {
        const alp_ambience_work work = step_live(&l, 0.1, 10);
        // A first sample costs a quarter, a relit one a half.
        assert_true(work.rays <= 10ull * 6 * s.face * s.face + 6 * s.face * s.face);
        assert_true(work.relit <= 20);
    }
    assert_int_equal(step_live(&l, 0.1, 0).samples, 0);
    alp_ambience_work work;
    assert_int_equal(alp_ambience_sample(l.sampler, &l.camera, 1, -1.0, &work),
                     ALP_ERROR_INVALID_ARGUMENT);
    close_live(&l);
}

TEST(samplers_refuse_bad_options)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_ambience *a = world_open(context, NULL);
    alp_ambience_sampler_options bad[4];
    for (int i = 0; i < 4; i++) {
        bad[i] = alp_ambience_sampler_options_default();
    }
    bad[0].struct_size = 1;
    bad[1].face = 15;
    bad[2].first_face = 0;
    bad[3].face = 68;
    for (int i = 0; i < 4; i++) {
        alp_ambience_sampler *s = NULL;
        assert_int_equal(alp_ambience_sampler_create(a, scene, &bad[i], &s),
                         ALP_ERROR_INVALID_ARGUMENT);
        assert_null(s);
    }
    alp_ambience_sampler_destroy(NULL);
    alp_ambience_destroy(a);
    alp_scene_destroy(scene);
}

TEST(warming_up_later_names_the_times)
{
    live l = open_live(test_load(context, "builtin:cornell"), NULL, NULL);
    ASSERT_OK(context, alp_ambience_update(l.ambience, 5.0));
    assert_int_equal(alp_ambience_sampler_warm(l.sampler, &l.camera, 5.5, 1),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(alp_context_message(context), "at 5.5 s of a volume that began at 5 s"));
    ASSERT_OK(context, alp_ambience_update(l.ambience, 6.0));
    assert_int_equal(alp_ambience_sampler_warm(l.sampler, &l.camera, 6.0, 1),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(alp_context_message(context), "began at 5 s and is at 6 s"));
    close_live(&l);
}

/// A second one would share hits and ground with the first.
TEST(a_volume_has_one_sampler_at_a_time)
{
    alp_ambience_options o = room_options(27.0, 2);
    o.flat = true;
    live l = open_live(test_load(context, "builtin:cornell"), &o, NULL);
    alp_ambience_sampler *second = NULL;
    (void)step_live(&l, 0.0, 10);
    assert_int_equal(alp_ambience_sampler_create(l.ambience, l.scene, NULL, &second),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_null(second);
    assert_true(l.ambience->options.height_user == l.sampler);
    alp_ambience_sampler_destroy(l.sampler);
    ASSERT_OK(context, alp_ambience_sampler_create(l.ambience, l.scene, NULL, &l.sampler));
    assert_true(l.ambience->options.height_user == l.sampler);
    close_live(&l);
}

// --- workers -------------------------------------------------------------------------------------

typedef struct live_bits {
    float light[64][9][3];
    uint32_t anchors, solids, nodes;
} live_bits;

static void fly_bits(uint32_t workers, const void *what, void *bytes)
{
    (void)what;
    live_bits *bits = bytes;
    alp_context *own = test_context(workers);
    const alp_ambience_options o = room_options(1.0, 2);
    live l = open_live(test_load(own, "builtin:cornell"), &o, NULL);
    l.camera.position[0] = l.camera.position[1] = l.camera.position[2] = 0.3;
    l.camera.velocity[0] = 0.2;
    for (int i = 0; i < 8; i++) {
        l.camera.position[0] += 0.02;
        (void)step_live(&l, 0.1, 12);
    }
    const alp_ambience_snapshot *s = alp_ambience_begin_read(l.ambience);
    for (int i = 0; i < 64; i++) {
        const double p[3] = {0.05 + 0.01 * i, 0.1 + 0.005 * i, 0.2};
        alp_sh9 light;
        alp_ambience_coefficients(s, p, &light);
        memcpy(bits->light[i], light.c, sizeof light.c);
    }
    alp_ambience_end_read(l.ambience, s);
    const alp_ambience_info info = alp_ambience_get_info(l.ambience);
    bits->anchors = info.anchors;
    bits->solids = info.solids;
    bits->nodes = info.nodes;
    close_live(&l);
    alp_context_destroy(own);
}

TEST(any_number_of_workers_gives_the_same_bits)
{
    live_bits *bits = test_any_workers(fly_bits, NULL, sizeof *bits);
    assert_true(bits->anchors > 10);
    free(bits);
}

// --- memory --------------------------------------------------------------------------------------

/// @return whether all went well
static bool fly_without_memory(const alp_scene *scene)
{
    const alp_ambience_options o = room_options(1.0, 2);
    const alp_ambience_camera camera = {.position = {0.3, 0.3, 0.3}};
    alp_ambience *a = NULL;
    alp_ambience_sampler *sampler = NULL;
    alp_field *field = NULL;
    alp_result result = alp_ambience_create(scene->context, &o, &a);
    assert_true((a != NULL) == (result == ALP_OK));
    if (result == ALP_OK) {
        result = alp_ambience_sampler_create(a, scene, NULL, &sampler);
        assert_true((sampler != NULL) == (result == ALP_OK));
    }
    for (int i = 0; i < 4 && result == ALP_OK; i++) {
        result = alp_ambience_update(a, 0.4 * i);
        if (result == ALP_OK) {
            result = alp_ambience_sample(sampler, &camera, 6, 0.0, NULL);
        }
    }
    if (result == ALP_OK) {
        result = alp_field_create_ambience(a, &field);
    }
    assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
    if (a != NULL) { // whatever failed, readers find a snapshot
        const alp_ambience_snapshot *s = alp_ambience_begin_read(a);
        assert_non_null(s);
        alp_ambience_end_read(a, s);
    }
    alp_field_destroy(field);
    alp_ambience_sampler_destroy(sampler);
    alp_ambience_destroy(a);
    return result == ALP_OK;
}

TEST(each_allocation_may_fail)
{
    int left = 1 << 30;
    alp_context *failing = test_context_failing(&left);
    alp_scene *scene = test_load(failing, "builtin:cornell");
    alpi_tracer *tracer = NULL;
    ASSERT_OK(failing, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    bool done = false;
    int count = 0;
    for (; !done; count += TEST_STEP) {
        left = count;
        done = fly_without_memory(scene);
    }
    left = 1 << 30;
    assert_true(count > 30);
    alp_scene_destroy(scene);
    alp_context_destroy(failing);
}
