// SPDX-License-Identifier: MIT
// Light of the ambience volume in time: solids that come and go, first light, and light that gets
// out of date before it arrives.
#include "ambience_world.h"

TEST_CONTEXT(1);

static const double FRAME = 1.0 / 60.0;

static alp_ambience_options small_options(void)
{
    alp_ambience_options o = alp_ambience_options_default();
    o.size = 27.0;
    o.depth = 3;
    o.visibility = false;
    o.anchor_limit = 2000;
    return o;
}

static float read_up(alp_ambience *a, const double p[3])
{
    const double place[1][3] = {{p[0], p[1], p[2]}};
    const float up[1][3] = {{0.0f, 1.0f, 0.0f}};
    float e[1][3];
    const alp_ambience_snapshot *s = alp_ambience_begin_read(a);
    alp_ambience_irradiance(s, 1, place, up, e);
    alp_ambience_end_read(a, s);
    return e[0][1];
}

// --- solids --------------------------------------------------------------------------------------

enum { PROBES = 40 };

/// Even light, but that of a lamp round a place, and a block there that is solid from time to time.
static void answer_block(alp_ambience *a, const alp_ambience_camera *camera, bool solid)
{
    alp_ambience_request request;
    for (int i = 0; i < 400; i++) {
        ASSERT_OK(context, alp_ambience_next(a, camera, &request));
        if (request.id == 0) {
            return;
        }
        const double *p = request.position;
        const bool inside = fabs(p[0]) < 1.5 && fabs(p[1]) < 1.5 && fabs(p[2]) < 1.5;
        const float level = (float)(1.0 + 2.0 * exp(-0.2 * (p[0] - 1.0) * (p[0] - 1.0)));
        const alp_sh9 light = {.c = {{level, level, level}}};
        ASSERT_OK(context, inside && solid ? alp_ambience_submit_solid(a, request.id)
                                           : alp_ambience_submit(a, request.id, &light));
    }
}

typedef struct watch {
    double places[PROBES][3];
    float before[PROBES];
    float most, total; // changes of E from frame to frame: the largest, and all of the first place
} watch;

static void watch_frame(alp_ambience *a, watch *w, bool first)
{
    for (int i = 0; i < PROBES; i++) {
        const float e = read_up(a, w->places[i]);
        const float change = first ? 0.0f : fabsf(e - w->before[i]);
        w->most = fmaxf(w->most, change);
        w->total += change;
        w->before[i] = e;
    }
}

/// Flips a block between light and solid. Slow flips let each fade end, quick ones turn it back.
static void flip_block(double seconds, int flips)
{
    static const double low[3] = {-1.5, -1.5, -1.5}, high[3] = {1.5, 1.5, 1.5};
    const alp_ambience_camera camera = {.position = {0.2, 0.1, 0.3}};
    const alp_ambience_options o = small_options();
    alp_ambience *a = world_open(context, &o);
    watch w = {.most = 0.0f};
    uint64_t state = 3;
    for (int i = 0; i < PROBES; i++) { // in and round the block; two next to places of anchors
        for (int k = 0; k < 3; k++) {
            w.places[i][k] = i < 2 ? 0.01 + 0.005 * k + i : 5.0 * (world_random(&state) - 0.5);
        }
    }
    for (int i = 0; i < 20; i++) {
        ASSERT_OK(context, alp_ambience_update(a, 0.0));
        answer_block(a, &camera, false);
    }
    ASSERT_OK(context, alp_ambience_update(a, 0.0));
    const float mean = alpi_ambience_mean(a->base);
    const int frames = (int)(seconds / FRAME);
    for (int frame = 0; frame < flips * frames; frame++) {
        if (frame % frames == 0) {
            alp_ambience_invalidate(a, true, low, high);
        }
        ASSERT_OK(context, alp_ambience_update(a, (frame + 1) * FRAME));
        answer_block(a, &camera, frame / frames % 2 == 0);
        watch_frame(a, &w, frame == 0);
    }
    print_message("%.1f s: %.3f %% a frame\n", seconds, 100.0 * (double)(w.most / mean));
    assert_true(w.most <= 0.01f * mean);
    assert_true(w.total > 2.0f * mean); // something changed
    alp_ambience_destroy(a);
}

TEST(solids_come_and_go_without_a_jump)
{
    flip_block(20.0, 3);
    flip_block(2.3, 6);
    flip_block(0.7, 9);
}

// --- light out of date ---------------------------------------------------------------------------

/// The request of the anchor in the middle; id 0: it is not wanted. All others are answered.
static alp_ambience_request find_middle(alp_ambience *a)
{
    const alp_ambience_camera camera = {.position = {0.0, 0.0, 0.0}};
    const alp_sh9 light = {.c = {{1.0f, 1.0f, 1.0f}}};
    alp_ambience_request middle = {0}, request;
    for (int i = 0; i < 1000; i++) {
        ASSERT_OK(context, alp_ambience_next(a, &camera, &request));
        if (request.id == 0) {
            break;
        }
        if (request.position[0] == 0.0 && request.position[1] == 0.0 &&
            request.position[2] == 0.0) {
            middle = request;
        } else {
            ASSERT_OK(context, alp_ambience_submit(a, request.id, &light));
        }
    }
    return middle;
}

/// Changes while a request is open: its answer does not have them.
static void change_on_the_way(bool traced, bool solid)
{
    alp_ambience_options o = small_options();
    o.depth = 1;
    alp_ambience *a = world_open(context, &o);
    const alp_sh9 light = {.c = {{1.0f, 1.0f, 1.0f}}};
    ASSERT_OK(context, alp_ambience_update(a, 0.0));
    ASSERT_OK(context, alp_ambience_submit(a, find_middle(a).id, &light));
    ASSERT_OK(context, alp_ambience_update(a, 0.1));
    alp_ambience_invalidate(a, true, NULL, NULL); // before the request: the answer has it
    alp_ambience_request request = find_middle(a);
    assert_true(request.id != 0 && !request.relight);
    alp_ambience_invalidate(a, traced, NULL, NULL);
    ASSERT_OK(context, solid ? alp_ambience_submit_solid(a, request.id)
                             : alp_ambience_submit(a, request.id, &light));
    ASSERT_OK(context, alp_ambience_update(a, 0.2));
    const uint32_t anchor = a->graph.nodes[ALPI_GRAPH_ROOT].anchor;
    assert_true(a->anchors[anchor].stale_light != 0);
    assert_true((a->anchors[anchor].stale_trace != 0) == traced);
    if (!solid) {
        request = find_middle(a);
        assert_true(request.id != 0 && request.relight == !traced);
        ASSERT_OK(context, alp_ambience_submit(a, request.id, &light));
        ASSERT_OK(context, alp_ambience_update(a, 0.3));
        assert_true(a->anchors[anchor].stale_light == 0 && a->anchors[anchor].stale_trace == 0);
        assert_true(find_middle(a).id == 0);
    }
    alp_ambience_destroy(a);
}

TEST(changes_after_a_request_outlive_its_answer)
{
    change_on_the_way(false, false);
    change_on_the_way(true, false);
    change_on_the_way(true, true);
}

// --- first light ---------------------------------------------------------------------------------

/// Light that comes when time has moved does not jump, wherever it comes first.
TEST(first_light_dawns)
{
    const alp_ambience_camera camera = {.position = {0.2, 0.1, 0.3}};
    const double places[2][3] = {{0.3, 0.2, -0.4}, {100.0, 0.0, 0.0}}; // the second has the base
    alp_ambience_options o = small_options();
    o.anchor_limit = 300;
    for (uint32_t seed = 0; seed < 4; seed++) {
        alp_ambience *a = world_open(context, &o);
        float before[2] = {0.0f, 0.0f}, most = 0.0f;
        uint64_t state = seed;
        for (int frame = 0; frame < 600; frame++) {
            ASSERT_OK(context, alp_ambience_update(a, frame * FRAME));
            for (int i = 0; i < 2 && frame > 0; i++) {
                const float e = read_up(a, places[i]);
                most = fmaxf(most, fabsf(e - before[i]));
                before[i] = e;
            }
            alp_ambience_request request = {0};
            for (int i = 0; i < 10 && frame > 30; i++) { // light that differs from place to place
                const float level = (float)(0.5 + world_random(&state));
                const alp_sh9 light = {.c = {{level, level, level}}};
                ASSERT_OK(context, alp_ambience_next(a, &camera, &request));
                if (request.id != 0) {
                    ASSERT_OK(context, alp_ambience_submit(a, request.id, &light));
                }
            }
        }
        print_message("%.3f %% a frame\n", 100.0 * (double)(most / a->mean));
        assert_true(before[1] > 0.5f * a->mean);
        assert_true(most <= 0.01f * a->mean);
        alp_ambience_destroy(a);
    }
}

/// Both look-ups dawn alike. Under even light, each gives the dawn's share of it.
TEST(all_look_ups_dawn)
{
    const alp_ambience_camera camera = {.position = {0.2, 0.1, 0.3}};
    const double place[3] = {0.3, 0.2, -0.4};
    const alp_sh9 light = {.c = {{1.0f, 1.0f, 1.0f}}};
    for (int lookup = 0; lookup < 2; lookup++) {
        alp_ambience_options o = small_options();
        o.lookup = (alp_ambience_lookup)lookup;
        alp_ambience *a = world_open(context, &o);
        ASSERT_OK(context, alp_ambience_update(a, 0.0));
        ASSERT_OK(context, alp_ambience_update(a, 0.5));
        for (int step = 0; step < 40; step++) {
            alp_ambience_request request;
            ASSERT_OK(context, alp_ambience_next(a, &camera, &request));
            if (request.id != 0) {
                ASSERT_OK(context, alp_ambience_submit(a, request.id, &light));
            }
            ASSERT_OK(context, alp_ambience_update(a, 0.6 + 0.1 * step));
            ASSERT_NEAR(read_up(a, place), ALPI_PI * 0.28209479 * fmin(0.03 * (step + 1), 1.0),
                        1e-4);
        }
        alp_ambience_destroy(a);
    }
}

/// The loop of a host: answers to the requests of one frame are taken in the next. Those of the
/// first frame count at once if nothing was visible, and fade in if light was.
TEST(answers_to_the_first_requests_count_at_once)
{
    const alp_ambience_camera camera = {.position = {0.2, 0.1, 0.3}};
    const double place[3] = {0.3, 0.2, -0.4};
    const alp_ambience_options o = small_options();
    alp_ambience *looped = world_open(context, &o), *warmed = world_open(context, &o);
    ASSERT_OK(context, alp_ambience_update(looped, 0.0));
    ASSERT_OK(context, alp_ambience_update(warmed, 0.0));
    (void)world_answer(looped, &camera, 20, -1e9, 0.0);
    (void)world_answer(warmed, &camera, 20, -1e9, 0.0);
    ASSERT_OK(context, alp_ambience_update(looped, FRAME));
    ASSERT_OK(context, alp_ambience_update(warmed, 0.0));
    const float warm = read_up(warmed, place);
    assert_true(warm > 0.5f);
    ASSERT_NEAR(read_up(looped, place), warm, 1e-6);
    assert_true(world_answer(warmed, &camera, 200, -1e9, 0.0) > 100);
    ASSERT_OK(context, alp_ambience_update(warmed, FRAME));
    ASSERT_NEAR(read_up(warmed, place), warm, 0.01 * (double)warm);
    alp_ambience_destroy(looped);
    alp_ambience_destroy(warmed);
}

/// A camera that jumps to bright places: where no anchor is, light follows slowly.
TEST(light_without_anchors_does_not_jump)
{
    const double place[3] = {0.0, 0.0, 500.0};
    alp_ambience_camera camera = {.position = {0.2, 0.1, 0.3}};
    alp_ambience_options o = small_options();
    o.anchor_limit = 300;
    alp_ambience *a = world_open(context, &o);
    float before = 0.0f, most = 0.0f;
    world_warm(a, &camera, -1e9);
    camera.position[0] = 300.0;
    for (int frame = 0; frame < 1800; frame++) {
        ASSERT_OK(context, alp_ambience_update(a, frame * FRAME));
        const float e = read_up(a, place);
        most = fmaxf(most, frame > 0 ? fabsf(e - before) : 0.0f);
        before = e;
        for (int i = 0; i < 10; i++) {
            alp_ambience_request request;
            const alp_sh9 light = {.c = {{3.0f, 3.0f, 3.0f}}};
            ASSERT_OK(context, alp_ambience_next(a, &camera, &request));
            if (request.id != 0) {
                ASSERT_OK(context, alp_ambience_submit(a, request.id, &light));
            }
        }
    }
    print_message("%.3f %% a frame\n", 100.0 * (double)(most / a->mean));
    ASSERT_NEAR(before, 3.0 * ALPI_PI * 0.28209479, 0.02);
    assert_true(most <= 0.01f * a->mean);
    alp_ambience_destroy(a);
}
