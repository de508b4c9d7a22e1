// SPDX-License-Identifier: MIT
// The ambience volume and what hosts do wrong.
#include "ambience_world.h"

#include <pthread.h>
#include <sched.h>

TEST_CONTEXT(1);

static alp_ambience *open_default(void)
{
    alp_ambience_options o = alp_ambience_options_default();
    o.anchor_limit = 3000; // windows that are quick to plan
    alp_ambience *a = world_open(context, &o);
    ASSERT_OK(context, alp_ambience_update(a, 0.0));
    return a;
}

TEST(options_out_of_range_are_refused)
{
    const alp_ambience_options good = alp_ambience_options_default();
    alp_ambience_options bad[9];
    for (int i = 0; i < 9; i++) {
        bad[i] = good;
    }
    bad[0].struct_size = 0;
    bad[1].size = 0.0;
    bad[2].size = (double)NAN;
    bad[3].depth = 0;
    bad[4].depth = 11;
    bad[5].lifetime = 0.0;
    bad[6].fade = -1.0;
    bad[7].anchor_limit = 63;
    bad[8].centre[1] = HUGE_VAL;
    for (int i = 0; i < 9; i++) {
        alp_ambience *a = NULL;
        assert_int_equal(alp_ambience_create(context, &bad[i], &a), ALP_ERROR_INVALID_ARGUMENT);
        assert_null(a);
    }
    alp_ambience_destroy(NULL);
}

TEST(time_does_not_run_backwards)
{
    alp_ambience *a = world_open(context, NULL);
    ASSERT_OK(context, alp_ambience_update(a, 5.0));
    ASSERT_OK(context, alp_ambience_update(a, 5.0));
    assert_int_equal(alp_ambience_update(a, 4.9), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_ambience_update(a, (double)NAN), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_ambience_update(a, HUGE_VAL), ALP_ERROR_INVALID_ARGUMENT);
    ASSERT_NEAR(alp_ambience_get_info(a).time, 5.0, 0.0);
    ASSERT_OK(context, alp_ambience_update(a, 6.0));
    alp_ambience_destroy(a);
}

TEST(nothing_is_sampled_before_the_first_update)
{
    alp_ambience *a = world_open(context, NULL);
    const alp_ambience_camera camera = {.position = {0.0, 0.0, 0.0}};
    alp_ambience_request request;
    assert_int_equal(alp_ambience_next(a, &camera, &request), ALP_ERROR_INVALID_ARGUMENT);
    alp_ambience_destroy(a);
}

TEST(a_camera_that_is_nowhere_is_refused)
{
    alp_ambience *a = open_default();
    alp_ambience_request request;
    for (int i = 0; i < 9; i++) {
        alp_ambience_camera camera = {.vfov = 1.0};
        double *const numbers[9] = {&camera.position[0], &camera.position[1], &camera.position[2],
                                    &camera.velocity[0], &camera.velocity[1], &camera.velocity[2],
                                    &camera.forward[0],  &camera.forward[2],  &camera.vfov};
        *numbers[i] = i % 2 == 0 ? (double)NAN : HUGE_VAL;
        assert_int_equal(alp_ambience_next(a, &camera, &request), ALP_ERROR_INVALID_ARGUMENT);
        assert_true(request.id == 0);
    }
    alp_ambience_destroy(a);
}

TEST(objects_and_paths_nowhere_are_refused)
{
    alp_ambience *a = open_default();
    alp_ambience_request request;
    const double objects[2][4] = {{1.0, 0.0, 0.0, 1.0}, {0.0, 0.0, 0.0, (double)NAN}};
    const double path[2][4] = {{0.0, 0.0, 0.0, 0.0}, {1.0, HUGE_VAL, 0.0, 0.0}};
    const alp_ambience_camera near = {.objects = objects, .object_count = 2};
    const alp_ambience_camera on = {.path = path, .path_count = 2};
    assert_int_equal(alp_ambience_next(a, &near, &request), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_ambience_next(a, &on, &request), ALP_ERROR_INVALID_ARGUMENT);
    alp_ambience_destroy(a);
}

TEST(look_ups_nowhere_are_black)
{
    alp_ambience *a = open_default();
    const alp_ambience_camera camera = {.position = {0.0, 0.0, 0.0}};
    world_warm(a, &camera, -1e9);
    const double p[4][3] = {
        {(double)NAN, 0.0, 0.0}, {0.0, HUGE_VAL, 0.0}, {0.0, 0.0, 1e300}, {0.0, 0.0, 0.0}};
    const float n[4][3] = {
        {0.0f, 1.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, NAN, 0.0f}};
    float e[4][3];
    const alp_ambience_snapshot *s = alp_ambience_begin_read(a);
    alp_ambience_irradiance(s, 4, p, n, e);
    for (int i = 0; i < 12; i++) {
        ASSERT_NEAR(e[i / 3][i % 3], 0.0, 0.0);
    }
    alp_ambience_end_read(a, s);
    alp_ambience_destroy(a);
}

TEST(speed_lowers_the_depth)
{
    uint32_t finest[3];
    const double speeds[3] = {0.0, 100.0, 1e9};
    for (int i = 0; i < 3; i++) {
        alp_ambience *a = open_default();
        const alp_ambience_camera camera = {.velocity = {speeds[i], 0.0, 0.0}};
        world_warm(a, &camera, -1e9);
        const alp_ambience_info info = alp_ambience_get_info(a);
        assert_in_range(info.anchors, 1, 8192);
        finest[i] = (uint32_t)info.cell;
        alp_ambience_destroy(a);
    }
    assert_int_equal(finest[0], 1);
    assert_true(finest[1] > finest[0]);
    assert_true(finest[2] > finest[1]);
}

/// Anchors a million metres away lie where they are said to.
TEST(a_wide_world_keeps_its_precision)
{
    alp_ambience *a = open_default();
    const alp_ambience_camera camera = {.position = {1e6, 0.0, -1e6}};
    alp_ambience_request request;
    int fine = 0;
    for (int i = 0; i < 8000; i++) {
        ASSERT_OK(context, alp_ambience_next(a, &camera, &request));
        if (request.id == 0) {
            ASSERT_OK(context, alp_ambience_update(a, a->time + 0.01));
            continue;
        }
        for (int k = 0; k < 3; k++) {
            const double cells = request.position[k] / request.cell;
            ASSERT_NEAR(cells, floor(cells + 0.5), 0.0);
        }
        fine += request.cell == 1.0;
        const alp_sh9 light = world_light(request.position, 0.0);
        ASSERT_OK(context, alp_ambience_submit(a, request.id, &light));
    }
    assert_true(fine > 50);
    for (int i = 0; i < 300; i++) {
        ASSERT_OK(context, alp_ambience_update(a, a->time + 0.01));
    }
    const alp_ambience_snapshot *s = alp_ambience_begin_read(a);
    alp_sh9 light;
    const double beside[3] = {1e6 + 1.0, 0.0, -1e6};
    alp_ambience_coefficients(s, beside, &light);
    ASSERT_NEAR(light.c[0][0], world_light(beside, 0.0).c[0][0], 1e-3);
    alp_ambience_end_read(a, s);
    alp_ambience_destroy(a);
}

TEST(a_place_beyond_all_levels_is_not_sampled)
{
    alp_ambience *a = open_default();
    const alp_ambience_camera camera = {.position = {1e15, 0.0, 0.0}};
    alp_ambience_request request;
    ASSERT_OK(context, alp_ambience_next(a, &camera, &request));
    assert_true(request.id == 0);
    alp_ambience_destroy(a);
}

// --- providers -----------------------------------------------------------------------------------

TEST(a_provider_that_never_answers_is_asked_again)
{
    alp_ambience *a = open_default();
    const alp_ambience_camera camera = {.position = {0.0, 0.0, 0.0}};
    alp_ambience_request first, request;
    ASSERT_OK(context, alp_ambience_next(a, &camera, &first));
    assert_true(first.id != 0);
    uint32_t most = 1;
    for (int i = 0; i < 2000; i++) {
        ASSERT_OK(context, alp_ambience_next(a, &camera, &request));
        most += request.id != 0;
    }
    assert_int_equal(alp_ambience_get_info(a).open, most);
    assert_in_range(most, 100, 1024);
    ASSERT_OK(context, alp_ambience_update(a, 7.0)); // longer than a lifetime
    ASSERT_OK(context, alp_ambience_update(a, 7.1));
    assert_int_equal(alp_ambience_get_info(a).open, 0);
    assert_int_equal(alp_ambience_get_info(a).nodes, 1);
    const alp_sh9 light = {.c = {{1.0f, 1.0f, 1.0f}}};
    assert_int_equal(alp_ambience_submit(a, first.id, &light), ALP_ERROR_INVALID_ARGUMENT);
    ASSERT_OK(context, alp_ambience_next(a, &camera, &request));
    assert_true(request.id != 0 && request.id != first.id);
    alp_ambience_destroy(a);
}

TEST(an_answer_counts_once)
{
    alp_ambience *a = open_default();
    const alp_ambience_camera camera = {.position = {0.0, 0.0, 0.0}};
    alp_ambience_request request;
    const alp_sh9 light = {.c = {{1.0f, 1.0f, 1.0f}}};
    alp_sh9 bad = light;
    bad.c[8][2] = NAN;
    ASSERT_OK(context, alp_ambience_next(a, &camera, &request));
    assert_int_equal(alp_ambience_submit(a, request.id, &bad), ALP_ERROR_INVALID_ARGUMENT);
    ASSERT_OK(context, alp_ambience_submit(a, request.id, &light)); // it stayed open
    assert_int_equal(alp_ambience_submit(a, request.id, &light), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_ambience_submit_solid(a, request.id), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_ambience_submit(a, 0, &light), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_ambience_submit(a, 12345678, &light), ALP_ERROR_INVALID_ARGUMENT);
    ASSERT_OK(context, alp_ambience_update(a, 0.1));
    assert_int_equal(alp_ambience_submit(a, request.id, &light), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_ambience_get_info(a).anchors, 1);
    alp_ambience_destroy(a);
}

TEST(faces_are_projected)
{
    enum { SIDE = 8 };
    alp_ambience *a = open_default();
    const alp_ambience_camera camera = {.position = {0.0, 0.0, 0.0}};
    alp_ambience_request request;
    static float pixels[SIDE * SIDE * 3];
    for (int i = 0; i < SIDE * SIDE * 3; i++) {
        pixels[i] = 2.0f;
    }
    const float *faces[6] = {pixels, pixels, pixels, pixels, pixels, NULL};
    ASSERT_OK(context, alp_ambience_next(a, &camera, &request));
    assert_int_equal(alp_ambience_submit_faces(a, request.id, SIDE, faces),
                     ALP_ERROR_INVALID_ARGUMENT);
    faces[5] = pixels;
    assert_int_equal(alp_ambience_submit_faces(a, request.id, 0, faces),
                     ALP_ERROR_INVALID_ARGUMENT);
    ASSERT_OK(context, alp_ambience_submit_faces(a, request.id, SIDE, faces));
    ASSERT_OK(context, alp_ambience_update(a, 0.0));
    const alp_ambience_snapshot *s = alp_ambience_begin_read(a);
    alp_sh9 light;
    alp_ambience_coefficients(s, request.position, &light);
    ASSERT_NEAR(light.c[0][1], 2.0 * 3.5449077, 1e-3); // 2 sqrt(pi) L
    ASSERT_NEAR(light.c[3][1], 0.0, 1e-4);
    alp_ambience_end_read(a, s);
    alp_ambience_destroy(a);
}

/// The table of a size is made at its first use.
TEST(faces_of_one_size_share_a_table)
{
    int left = 1 << 30;
    alp_context *counting = test_context_failing(&left);
    alp_ambience *a = world_open(counting, NULL);
    const alp_ambience_camera camera = {.position = {0.0, 0.0, 0.0}};
    static float pixels[16 * 16 * 3];
    const float *faces[6] = {pixels, pixels, pixels, pixels, pixels, pixels};
    ASSERT_OK(counting, alp_ambience_update(a, 0.0));
    for (int i = 0; i < 6; i++) {
        alp_ambience_request request;
        ASSERT_OK(counting, alp_ambience_next(a, &camera, &request));
        const int before = left;
        left = i < 2 ? 0 : left; // no memory for a table: the request stays open
        const alp_result result = alp_ambience_submit_faces(a, request.id, i % 2 ? 8 : 16, faces);
        assert_int_equal(result, i < 2 ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK);
        left = i < 2 ? before : left;
        assert_true((left == before) == (i < 2 || i > 3));
    }
    alp_ambience_destroy(a);
    alp_context_destroy(counting);
}

// --- threads -------------------------------------------------------------------------------------

typedef struct reader {
    alp_ambience *ambience;
    atomic_bool *stop;
    uint64_t read;
    float worst;
} reader;

static void *read_on(void *user)
{
    reader *r = user;
    uint64_t state = 77;
    while (!atomic_load(r->stop)) {
        const alp_ambience_snapshot *s = alp_ambience_begin_read(r->ambience);
        for (int i = 0; i < 20; i++) {
            const double p[1][3] = {
                {200.0 * (world_random(&state) - 0.5), 3.0, 20.0 * (world_random(&state) - 0.5)}};
            const float n[1][3] = {{0.0f, 1.0f, 0.0f}};
            float e[1][3];
            alp_ambience_irradiance(s, 1, p, n, e);
            r->worst = fmaxf(r->worst, e[0][0]);
            r->read++;
        }
        alp_ambience_end_read(r->ambience, s);
    }
    return NULL;
}

typedef struct answerer {
    alp_ambience *ambience;
    alp_ambience_request requests[64];
    uint32_t count;
} answerer;

static void *answer_all(void *user)
{
    answerer *w = user;
    for (uint32_t i = 0; i < w->count; i++) {
        const alp_sh9 light = world_light(w->requests[i].position, 0.0);
        ASSERT_OK(w->ambience->context,
                  alp_ambience_submit(w->ambience, w->requests[i].id, &light));
    }
    return NULL;
}

typedef struct racer {
    alp_ambience *ambience;
    const alp_ambience_request *requests;
    uint32_t count;
    float level; // 0: says that all lie in solids
    atomic_uint *arrived;
    alp_result results[64];
} racer;

static void *race(void *user)
{
    racer *r = user;
    const alp_sh9 light = {.c = {{r->level, r->level, r->level}}};
    for (uint32_t i = 0; i < r->count; i++) {
        const uint64_t id = r->requests[i].id;
        atomic_fetch_add(r->arrived, 1);
        while (atomic_load(r->arrived) < 2 * (i + 1)) { // both answer together
            sched_yield();
        }
        r->results[i] = r->level > 0.0f ? alp_ambience_submit(r->ambience, id, &light)
                                        : alp_ambience_submit_solid(r->ambience, id);
    }
    return NULL;
}

static void race_for(alp_ambience *a, float second_level)
{
    const alp_ambience_camera camera = {.position = {0.0, 0.0, 0.0}};
    alp_ambience_request requests[64];
    uint32_t count = 0;
    while (count < 64) {
        ASSERT_OK(context, alp_ambience_next(a, &camera, &requests[count]));
        if (requests[count].id == 0) {
            break;
        }
        count++;
    }
    atomic_uint arrived;
    atomic_init(&arrived, 0);
    racer racers[2] = {{.level = 1.0f}, {.level = second_level}};
    pthread_t threads[2];
    for (int i = 0; i < 2; i++) {
        racers[i].ambience = a;
        racers[i].requests = requests;
        racers[i].count = count;
        racers[i].arrived = &arrived;
        assert_int_equal(pthread_create(&threads[i], NULL, race, &racers[i]), 0);
    }
    for (int i = 0; i < 2; i++) {
        assert_int_equal(pthread_join(threads[i], NULL), 0);
    }
    ASSERT_OK(context, alp_ambience_update(a, 0.0));
    for (uint32_t i = 0; i < count; i++) {
        const bool first = racers[0].results[i] == ALP_OK;
        assert_int_equal(racers[first ? 1 : 0].results[i], ALP_ERROR_INVALID_ARGUMENT);
        assert_int_equal(racers[first ? 0 : 1].results[i], ALP_OK);
        int32_t index[3];
        const uint32_t level = (uint32_t)lround(log(requests[i].cell) / log(3.0));
        assert_true(alpi_ambience_index(a, level, requests[i].position, index));
        const uint32_t node = alpi_graph_find(&a->graph, level, index);
        const alpi_anchor *at = &a->anchors[a->graph.nodes[node].anchor];
        if (!first && !(second_level > 0.0f)) {
            assert_int_equal(at->state, ALPI_ANCHOR_SOLID);
        } else {
            ASSERT_NEAR(a->lights.light[at->slot][0], first ? 1.0f : second_level, 0.0);
        }
    }
}

/// Two threads answer each request: one answer is taken whole, the other is refused.
TEST(racing_answers_count_once)
{
    alp_ambience *a = open_default();
    for (int round = 0; round < 20; round++) {
        race_for(a, 2.0f);
        race_for(a, 0.0f);
    }
    assert_true(alp_ambience_get_info(a).anchors > 100);
    alp_ambience_destroy(a);
}

/// Eight readers through a flight that grows and prunes, and answers from another thread.
TEST(readers_need_no_locks)
{
    enum { READERS = 8 };
    alp_ambience_options o = alp_ambience_options_default();
    o.lifetime = 1.0;
    o.fade = 0.2;
    o.size = 27.0;
    o.depth = 3;
    alp_ambience *a = world_open(context, &o);
    atomic_bool stop;
    reader readers[READERS];
    pthread_t threads[READERS];
    alp_ambience_camera camera = {.position = {-100.0, 3.0, 0.0}, .velocity = {40.0, 0.0, 0.0}};
    atomic_init(&stop, false);
    ASSERT_OK(context, alp_ambience_update(a, 0.0));
    for (int i = 0; i < READERS; i++) {
        readers[i] = (reader){a, &stop, 0, 0.0f};
        assert_int_equal(pthread_create(&threads[i], NULL, read_on, &readers[i]), 0);
    }
    const int frames = test_is_quick() ? 60 : 120;
    for (int frame = 1; frame <= frames; frame++) {
        answerer work = {a, {{0}}, 0};
        pthread_t thread;
        const alp_result updated = alp_ambience_update(a, frame / 60.0);
        assert_true(updated == ALP_OK || updated == ALP_ERROR_LIMIT);
        camera.position[0] = -100.0 + 200.0 * frame / frames;
        while (work.count < 40) {
            ASSERT_OK(context, alp_ambience_next(a, &camera, &work.requests[work.count]));
            if (work.requests[work.count].id == 0) {
                break;
            }
            work.count++;
        }
        assert_int_equal(pthread_create(&thread, NULL, answer_all, &work), 0);
        pthread_join(thread, NULL);
    }
    assert_true(alp_ambience_get_info(a).levels > 4); // it grew
    for (int i = 0; i < 200; i++) {
        const alp_result updated = alp_ambience_update(a, a->time + 0.1);
        assert_true(updated == ALP_OK || updated == ALP_ERROR_LIMIT);
    }
    atomic_store(&stop, true);
    for (int i = 0; i < READERS; i++) {
        pthread_join(threads[i], NULL);
        assert_true(readers[i].read > 0);
        assert_true(readers[i].worst < 5.0f);
    }
    const alp_ambience_info info = alp_ambience_get_info(a);
    assert_int_equal(info.anchors, 0);
    assert_int_equal(info.nodes, 1);
    assert_int_equal(info.levels, 4);
    alp_ambience_destroy(a);
}
