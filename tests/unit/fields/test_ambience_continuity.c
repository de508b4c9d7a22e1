// SPDX-License-Identifier: MIT
// Light of the ambience volume is continuous in time and space, along random ways of a camera. E at
// fixed points changes by 1 % of the mean from frame to frame at most, and by .1 % along 1 mm.
// Behind a wall without thickness, light fades within centimetres: .1 % along .01 mm.
//
// AMBIENCE_PATHS sets the number of analytic paths, AMBIENCE_RAY_PATHS that of paths by rays:
//
//     paths                         % a frame   % along 1 mm
//     2,000 analytic                .53         .0041
//     2,000 analytic, by the wall   .63         2.1 (.015 along .01 mm)
//     20 by rays                    .66         .058
#include "ambience_world.h"

#include "scene/builtin/builtin_terrain.h"

TEST_CONTEXT(2);

enum { FRAMES = 30, POINTS = 4, NORMALS = 6 };
static const double FRAME = 1.0 / 60.0;

typedef struct walk {
    double length;      // of a step, metres
    double frame, step; // largest changes of E over the mean: from frame to frame, and of a step
    double millimetre;  // the same along 1 mm
} walk;

/// Points that are watched, and E there in the last frame.
typedef struct watch {
    double points[POINTS][3];
    float before[POINTS][NORMALS];
} watch;

static float irradiance_at(const alp_ambience_snapshot *s, const double p[3], int normal)
{
    const double place[1][3] = {{p[0], p[1], p[2]}};
    const float way = normal % 2 == 0 ? 1.0f : -1.0f;
    const float n[1][3] = {
        {normal / 2 == 0 ? way : 0.0f, normal / 2 == 1 ? way : 0.0f, normal / 2 == 2 ? way : 0.0f}};
    float e[1][3];
    alp_ambience_irradiance(s, 1, place, n, e);
    return e[0][0];
}

static void watch_frame(alp_ambience *a, int frame, float mean, watch *w, walk *most)
{
    const alp_ambience_snapshot *s = alp_ambience_begin_read(a);
    for (int i = 0; i < POINTS; i++) {
        double beside[3] = {w->points[i][0], w->points[i][1], w->points[i][2]};
        double far[3] = {beside[0], beside[1], beside[2]};
        beside[frame % 3] += most->length;
        far[frame % 3] += 1e-3;
        for (int n = 0; n < NORMALS; n++) {
            const float e = irradiance_at(s, w->points[i], n);
            const double change = (double)(fabsf(e - w->before[i][n]) / mean);
            const double step = (double)(fabsf(irradiance_at(s, beside, n) - e) / mean);
            const double longer = (double)(fabsf(irradiance_at(s, far, n) - e) / mean);
            most->frame = fmax(most->frame, frame > 0 ? change : 0.0);
            most->step = fmax(most->step, step);
            most->millimetre = fmax(most->millimetre, longer);
            w->before[i][n] = e;
        }
    }
    alp_ambience_end_read(a, s);
}

/// Points round the way of a camera, at least `low` metres high.
static void place_points(const alp_ambience_camera *camera, double low, uint64_t *seed, watch *w)
{
    for (int i = 0; i < POINTS; i++) {
        for (int k = 0; k < 3; k++) {
            w->points[i][k] = camera->position[k] + 12.0 * (world_random(seed) - 0.5) +
                              0.25 * camera->velocity[k];
        }
        w->points[i][1] = low + fabs(w->points[i][1] - low);
    }
}

static int count_paths(const char *name, int quick, int usual)
{
    const char *count = getenv(name);
    return count != NULL ? (int)strtol(count, NULL, 10) : test_is_quick() ? quick : usual;
}

static void check(const walk *most)
{
    print_message("largest change: %.3f %% a frame, %.4f %% along %g mm, %.4f %% along 1 mm\n",
                  100.0 * most->frame, 100.0 * most->step, 1e3 * most->length,
                  100.0 * most->millimetre);
    assert_true(most->frame <= 0.01);
    assert_true(most->step <= 0.001);
    assert_true(most->frame > 0.0); // something changed
}

// --- an analytic world ---------------------------------------------------------------------------

static void answer(alp_ambience *a, const alp_ambience_camera *camera, uint32_t count)
{
    if (a->options.visibility) {
        world_answer_seen(a, camera, count, -1.0);
    } else {
        world_answer(a, camera, count, -1.0, 0.0);
    }
}

/// Walks through the world for half a second, on a volume that is half filled.
static void walk_path(const alp_ambience_options *o, uint64_t seed, walk *most)
{
    alp_ambience *a = world_open(context, o);
    alp_ambience_camera camera = {.position = {0.0, 1.0, 0.0}};
    watch w;
    for (int k = 0; k < 3; k++) {
        camera.velocity[k] = k == 1 ? 0.0 : 20.0 * (world_random(&seed) - 0.5);
    }
    ASSERT_OK(context, alp_ambience_update(a, 0.0));
    answer(a, &camera, 100 + 20 * (uint32_t)(seed >> 61));
    ASSERT_OK(context, alp_ambience_update(a, 0.0));
    place_points(&camera, 0.0, &seed, &w);
    for (int i = 0; i < POINTS / 2 && o->visibility; i++) { // half of them by the wall
        w.points[i][0] = WORLD_WALL + world_random(&seed);
    }
    for (int frame = 0; frame < FRAMES; frame++) {
        ASSERT_OK(context, alp_ambience_update(a, (frame + 1) * FRAME));
        answer(a, &camera, 60);
        watch_frame(a, frame, 3.14159265f * 0.28209479f, &w, most);
        for (int k = 0; k < 3; k++) {
            camera.position[k] += camera.velocity[k] * FRAME;
        }
    }
    alp_ambience_destroy(a);
}

static alp_ambience_options walk_options(bool visibility)
{
    alp_ambience_options o = alp_ambience_options_default();
    o.size = 81.0;
    o.depth = 4;
    o.visibility = visibility;
    o.anchor_limit = 2000; // windows that are quick to plan
    return o;
}

TEST(light_does_not_jump)
{
    const alp_ambience_options o = walk_options(false);
    const int paths = count_paths("AMBIENCE_PATHS", 10, 200);
    walk most = {.length = 1e-3};
    for (int i = 0; i < paths; i++) {
        walk_path(&o, (uint64_t)i + 1, &most);
    }
    check(&most);
}

/// With distances to the ground and to a thin wall.
TEST(light_that_is_seen_does_not_jump)
{
    const alp_ambience_options o = walk_options(true);
    const int paths = count_paths("AMBIENCE_PATHS", 5, 50);
    walk most = {.length = 1e-5};
    for (int i = 0; i < paths; i++) {
        walk_path(&o, (uint64_t)i + 1, &most);
    }
    check(&most);
}

/// The rule of 2006 jumps, which shows that the tests above see jumps.
TEST(the_rule_of_2006_jumps)
{
    alp_ambience_options o = walk_options(false);
    walk most = {.length = 1e-3};
    o.lookup = ALP_AMBIENCE_CONFORMANCE;
    o.fade = 0.0;
    for (int i = 0; i < 5; i++) {
        walk_path(&o, (uint64_t)i + 1, &most);
    }
    assert_true(most.frame > 0.01);
}

// --- rays ----------------------------------------------------------------------------------------

/// Moves half of the points to 1 to 3 m over the ground, between the nearest two houses. The camera
/// flies by above them.
static void place_alley(alp_ambience_camera *camera, uint64_t *seed, watch *w)
{
    const alpi_house *a = &alpi_terrain_houses()[1], *b = &alpi_terrain_houses()[2];
    const double middle[3] = {0.5 * (double)(a->x + b->x), (double)alpi_terrain_pad(a),
                              0.5 * (double)(a->z + b->z)};
    for (int k = 0; k < 3; k += 2) {
        camera->velocity[k] = 60.0 * (world_random(seed) - 0.5);
        camera->position[k] = middle[k] - 0.25 * camera->velocity[k];
    }
    camera->position[1] = middle[1] + 4.0 + 10.0 * world_random(seed);
    place_points(camera, middle[1] + 12.0, seed, w);
    for (int i = 0; i < POINTS / 2; i++) {
        for (int k = 0; k < 3; k++) {
            const double away = world_random(seed);
            w->points[i][k] = middle[k] + (k == 1 ? 1.0 + 2.0 * away : 3.0 * (away - 0.5));
        }
    }
}

/// Flies over a hamlet for half a second, after a part of the anchors was sampled.
static void fly_path(const alp_scene *scene, uint64_t seed, walk *most)
{
    alp_ambience_options o = alp_ambience_options_default();
    alp_ambience_sampler_options s = alp_ambience_sampler_options_default();
    alp_ambience_sampler *sampler = NULL;
    alp_ambience_camera camera = {.position = {0.0, 0.0, 0.0}};
    watch w;
    o.anchor_limit = 4000;
    s.lighting.sky.kind = ALP_SKY_CLEAR;
    s.lighting.sun.elevation = 0.8f;
    s.lighting.sun.illuminance = 1e5f;
    alp_ambience *a = world_open(context, &o);
    ASSERT_OK(context, alp_ambience_sampler_create(a, scene, &s, &sampler));
    place_alley(&camera, &seed, &w);
    ASSERT_OK(context, alp_ambience_update(a, 0.0));
    ASSERT_OK(context, alp_ambience_sample(sampler, &camera, 50, 0.0, NULL));
    for (int frame = 0; frame < FRAMES; frame++) {
        ASSERT_OK(context, alp_ambience_update(a, (frame + 1) * FRAME));
        ASSERT_OK(context, alp_ambience_sample(sampler, &camera, 20, 0.0, NULL));
        watch_frame(a, frame, a->mean, &w, most);
        for (int k = 0; k < 3; k++) {
            camera.position[k] += camera.velocity[k] * FRAME;
        }
    }
    alp_ambience_sampler_destroy(sampler);
    alp_ambience_destroy(a);
}

TEST(light_from_rays_does_not_jump)
{
    const int paths = count_paths("AMBIENCE_RAY_PATHS", 1, 1);
    alp_scene *scene = test_load(context, "builtin:terrain");
    walk most = {.length = 1e-3};
    for (int i = 0; i < paths; i++) {
        fly_path(scene, (uint64_t)i + 1, &most);
    }
    check(&most);
    alp_scene_destroy(scene);
}
