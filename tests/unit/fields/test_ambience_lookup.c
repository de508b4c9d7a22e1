// SPDX-License-Identifier: MIT
// Look-ups of the ambience volume against a slow twin that searches the list of all anchors, and
// their continuity.
#include "ambience_world.h"

TEST_CONTEXT(1);

// --- the twin ------------------------------------------------------------------------------------

/// Index at level 0 of a place of the lattice of a level.
static int64_t units_of(int32_t index, uint32_t level)
{
    return (int64_t)index * alpi_graph_width(level);
}

/// The anchor at a place of the lattice of a level, among those in use; −1: none.
static int find_anchor(const alp_ambience *a, uint32_t level, const int32_t index[3])
{
    for (uint32_t i = 0; i < a->anchor_end; i++) {
        const alpi_anchor *at = &a->anchors[i];
        bool same = at->state != ALPI_ANCHOR_FREE && at->level >= level;
        for (int k = 0; k < 3; k++) {
            same = same && units_of(at->index[k], at->level) == units_of(index[k], level);
        }
        if (same) {
            return (int)i;
        }
    }
    return -1;
}

/// Index of the parent: the nearest third.
static void go_up(int32_t index[3])
{
    for (int k = 0; k < 3; k++) {
        index[k] = (int32_t)floor((double)index[k] / 3.0 + 0.5);
    }
}

/// The most confidence among the children of the parent of a place, the middle one left out; −1:
/// its parent has no children, for no anchor lies below it.
static float siblings(const alp_ambience *a, uint32_t level, const int32_t index[3])
{
    int32_t parent[3] = {index[0], index[1], index[2]};
    float most = -1.0f;
    go_up(parent);
    for (uint32_t i = 0; i < a->anchor_end; i++) {
        const alpi_anchor *at = &a->anchors[i];
        if (at->state == ALPI_ANCHOR_FREE || at->level > level) {
            continue;
        }
        int32_t up[3] = {at->index[0], at->index[1], at->index[2]};
        for (uint32_t l = at->level; l <= level; l++) {
            go_up(up);
        }
        if (memcmp(up, parent, sizeof up) == 0) {
            most = fmaxf(most, at->level == level ? at->confidence : 0.0f);
        }
    }
    return most;
}

static void twin_read(const alp_ambience *a, const double p[3], float light[ALPI_AMBIENCE_FLOATS])
{
    float rest = a->dawn;
    memset(light, 0, ALPI_AMBIENCE_FLOATS * sizeof *light);
    for (uint32_t level = 0; level <= a->graph.depth; level++) {
        const double cell = a->unit * pow(3.0, level);
        double sum = 0.0, trusted = 0.0, added[ALPI_AMBIENCE_FLOATS] = {0.0};
        for (int corner = 0; corner < 8; corner++) {
            int32_t index[3];
            double t = 1.0;
            for (int k = 0; k < 3; k++) {
                const double x =
                    a->options.flat && k == 1 ? 0.0 : (p[k] - a->options.centre[k]) / cell;
                index[k] = (int32_t)floor(x) + (corner >> k & 1);
                t *= 1.0 - fabs(x - index[k]);
            }
            const int found = find_anchor(a, level, index);
            float openness = 1.0f, confidence = 0.0f;
            if (found >= 0) {
                const alpi_anchor *at = &a->anchors[found];
                const float share = level < a->graph.depth ? siblings(a, level, index) : 1.0f;
                const bool has_node = share >= 0.0f;
                confidence = at->level > level ? fminf(at->confidence, share) : at->confidence;
                openness = has_node ? at->open : 1.0f;
                confidence = has_node ? confidence : 0.0f;
                for (int i = 0; i < ALPI_AMBIENCE_FLOATS && confidence > 0.0f; i++) {
                    added[i] += t * (double)(openness * confidence * a->lights.light[at->slot][i]);
                }
            }
            sum += t * (double)openness;
            trusted += t * (double)(openness * confidence);
        }
        if (trusted > 0.0) {
            const double scale = (double)rest * fmin(1.0, sum / 0.004) / sum;
            for (int i = 0; i < ALPI_AMBIENCE_FLOATS; i++) {
                light[i] += (float)(scale * added[i]);
            }
            rest -= (float)(scale * trusted);
        }
    }
    for (int i = 0; i < ALPI_AMBIENCE_FLOATS; i++) {
        light[i] += rest * a->base[i];
    }
}

// --- look-ups ------------------------------------------------------------------------------------

static alp_ambience_options small_options(void)
{
    alp_ambience_options o = alp_ambience_options_default();
    o.size = 27.0;
    o.depth = 3;
    o.visibility = false;
    o.lifetime = 2.0;
    o.fade = 0.5;
    return o;
}

static void compare(alp_ambience *a, const double centre[3], uint64_t *state)
{
    const alp_ambience_snapshot *s = alp_ambience_begin_read(a);
    for (int i = 0; i < 12; i++) {
        double p[3];
        float twin[ALPI_AMBIENCE_FLOATS];
        alp_sh9 light;
        for (int k = 0; k < 3; k++) { // a few outside of the root
            p[k] = centre[k] + (i % 4 == 0 ? 40.0 : 6.0) * (world_random(state) - 0.5);
        }
        alp_ambience_coefficients(s, p, &light);
        twin_read(a, p, twin);
        for (int k = 0; k < ALPI_AMBIENCE_FLOATS; k++) {
            ASSERT_NEAR(light.c[k / 3][k % 3], twin[k], 2e-5);
        }
    }
    alp_ambience_end_read(a, s);
}

/// Moves, expiries, lapses of the provider, and jumps outside.
static void fuzz(bool flat, uint64_t seed)
{
    alp_ambience_options o = small_options();
    o.flat = flat;
    o.anchor_limit = 600;
    alp_ambience *a = world_open(context, &o);
    alp_ambience_camera camera = {.position = {1.0, 2.0, -3.0}};
    const int frames = test_is_quick() ? 40 : 120;
    double time = 0.0;
    for (int frame = 0; frame < frames; frame++) {
        const double kind = world_random(&seed);
        for (int k = 0; k < 3; k++) {
            camera.velocity[k] = kind < 0.1 ? 100.0 * (world_random(&seed) - 0.5) : 2.0;
            camera.position[k] += 0.1 * camera.velocity[k];
            camera.position[k] += kind > 0.98 ? 300.0 * (world_random(&seed) - 0.5) : 0.0;
        }
        time += kind > 0.95 ? 1.7 : 0.05;
        ASSERT_OK(context, alp_ambience_update(a, time));
        if (kind < 0.8) {
            world_answer(a, &camera, 30, flat ? -1e9 : -2.0, time);
        }
        if (frame % 4 == 0) {
            compare(a, camera.position, &seed);
        }
    }
    for (int i = 0; i < 400; i++) { // all expires
        time += 0.2;
        ASSERT_OK(context, alp_ambience_update(a, time));
    }
    const alp_ambience_info info = alp_ambience_get_info(a);
    assert_int_equal(info.anchors, 0);
    assert_int_equal(info.solids, 0);
    assert_int_equal(info.nodes, 1);
    assert_int_equal(info.levels, 4);
    assert_int_equal(info.open, 0);
    alp_ambience_destroy(a);
}

TEST(look_ups_are_the_twins)
{
    for (uint64_t seed = 1; seed <= 6; seed++) {
        fuzz(false, seed);
    }
}

TEST(flat_look_ups_are_the_twins)
{
    for (uint64_t seed = 1; seed <= 6; seed++) {
        fuzz(true, seed);
    }
}

TEST(even_light_is_read_exactly)
{
    alp_ambience_options o = small_options();
    alp_ambience *a = world_open(context, &o);
    const alp_ambience_camera camera = {.position = {0.3, 0.2, 0.1}};
    alp_sh9 even = {.c = {{1.0f, 2.0f, 3.0f}}};
    uint64_t state = 5;
    for (int frame = 0; frame < 40; frame++) {
        ASSERT_OK(context, alp_ambience_update(a, 0.1 * frame));
        for (int i = 0; i < 20; i++) {
            alp_ambience_request request;
            ASSERT_OK(context, alp_ambience_next(a, &camera, &request));
            if (request.id != 0) {
                ASSERT_OK(context, alp_ambience_submit(a, request.id, &even));
            }
        }
    }
    const alp_ambience_snapshot *s = alp_ambience_begin_read(a);
    for (int i = 0; i < 100; i++) {
        const double p[1][3] = {{60.0 * (world_random(&state) - 0.5),
                                 60.0 * (world_random(&state) - 0.5),
                                 60.0 * (world_random(&state) - 0.5)}};
        const float n[1][3] = {{0.0f, 1.0f, 0.0f}};
        float e[1][3];
        alp_ambience_irradiance(s, 1, p, n, e);
        ASSERT_NEAR(e[0][0], 3.14159265 * 0.28209479, 1e-5); // A0 Y0
        ASSERT_NEAR(e[0][2], 3.0 * 3.14159265 * 0.28209479, 3e-5);
    }
    alp_ambience_end_read(a, s);
    alp_ambience_destroy(a);
}

// --- continuity ----------------------------------------------------------------------------------

typedef struct walk {
    double frame, step; // largest changes of E over the mean: from frame to frame, and of 1 mm
} walk;

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

/// Walks through the world, 30 frames of 1/60 s on a volume that is half filled, and finds the
/// largest changes at fixed points and along steps of 1 mm.
static void walk_path(const alp_ambience_options *o, uint64_t seed, walk *most)
{
    enum { FRAMES = 30, POINTS = 4 };
    alp_ambience *a = world_open(context, o);
    alp_ambience_camera camera = {.position = {0.0, 1.0, 0.0}};
    double points[POINTS][3];
    float before[POINTS][6];
    const float mean = 3.14159265f * 0.28209479f;
    for (int k = 0; k < 3; k++) {
        camera.velocity[k] = k == 1 ? 0.0 : 20.0 * (world_random(&seed) - 0.5);
    }
    ASSERT_OK(context, alp_ambience_update(a, 0.0));
    world_answer(a, &camera, 100 + 20 * (uint32_t)(seed >> 61), -1.0, 0.0);
    ASSERT_OK(context, alp_ambience_update(a, 0.0));
    for (int i = 0; i < POINTS; i++) {
        for (int k = 0; k < 3; k++) {
            points[i][k] =
                camera.position[k] + 12.0 * (world_random(&seed) - 0.5) + 0.25 * camera.velocity[k];
        }
        points[i][1] = fabs(points[i][1]);
    }
    for (int frame = 0; frame < FRAMES; frame++) {
        ASSERT_OK(context, alp_ambience_update(a, (frame + 1) / 60.0));
        world_answer(a, &camera, 60, -1.0, 0.0);
        const alp_ambience_snapshot *s = alp_ambience_begin_read(a);
        for (int i = 0; i < POINTS; i++) {
            double beside[3] = {points[i][0], points[i][1], points[i][2]};
            beside[frame % 3] += 0.001;
            for (int n = 0; n < 6; n++) {
                const float e = irradiance_at(s, points[i], n);
                if (frame > 0) {
                    most->frame = fmax(most->frame, (double)(fabsf(e - before[i][n]) / mean));
                }
                before[i][n] = e;
                most->step =
                    fmax(most->step, (double)(fabsf(irradiance_at(s, beside, n) - e) / mean));
            }
        }
        alp_ambience_end_read(a, s);
        for (int k = 0; k < 3; k++) {
            camera.position[k] += camera.velocity[k] / 60.0;
        }
    }
    alp_ambience_destroy(a);
}

TEST(light_does_not_jump)
{
    alp_ambience_options o = alp_ambience_options_default();
    walk most = {0.0, 0.0};
    const char *count = getenv("AMBIENCE_PATHS");
    const int paths = count != NULL ? (int)strtol(count, NULL, 10) : test_is_quick() ? 10 : 200;
    o.size = 81.0;
    o.depth = 4;
    o.visibility = false;
    o.anchor_limit = 2000; // windows that are quick to plan
    for (int i = 0; i < paths; i++) {
        walk_path(&o, (uint64_t)i + 1, &most);
    }
    print_message("largest change: %.3f %% a frame, %.4f %% a millimetre\n", 100.0 * most.frame,
                  100.0 * most.step);
    assert_true(most.frame <= 0.01);
    assert_true(most.step <= 0.001);
    assert_true(most.frame > 0.0); // something changed
}

/// The rule of 2006 jumps, which shows that the test above sees jumps.
TEST(the_rule_of_2006_jumps)
{
    alp_ambience_options o = alp_ambience_options_default();
    walk most = {0.0, 0.0};
    o.size = 81.0;
    o.depth = 4;
    o.visibility = false;
    o.anchor_limit = 2000;
    o.lookup = ALP_AMBIENCE_CONFORMANCE;
    o.fade = 0.0;
    for (int i = 0; i < 5; i++) {
        walk_path(&o, (uint64_t)i + 1, &most);
    }
    assert_true(most.frame > 0.01);
}

// --- life of an anchor ---------------------------------------------------------------------------

static float lone_light(alp_ambience *a, double time)
{
    const double centre[3] = {0.0, 0.0, 0.0};
    alp_sh9 light;
    ASSERT_OK(context, alp_ambience_update(a, time));
    const alp_ambience_snapshot *s = alp_ambience_begin_read(a);
    alp_ambience_coefficients(s, centre, &light);
    alp_ambience_end_read(a, s);
    return light.c[0][0];
}

static uint64_t ask_root(alp_ambience *a)
{
    const alp_ambience_camera camera = {.position = {0.0, 0.0, 0.0}};
    for (int i = 0; i < 1000; i++) {
        alp_ambience_request request;
        ASSERT_OK(context, alp_ambience_next(a, &camera, &request));
        if (request.id == 0) {
            return 0;
        }
        if (request.position[0] == 0.0 && request.position[1] == 0.0 &&
            request.position[2] == 0.0) {
            return request.id;
        }
    }
    return 0;
}

/// Oracle 18: at t of a fade of T seconds, light is lerp(old, new, t/T).
TEST(new_light_fades_in_evenly)
{
    alp_ambience_options o = small_options();
    o.depth = 1;
    o.lifetime = 10.0;
    o.fade = 2.0;
    alp_ambience *a = world_open(context, &o);
    const alp_sh9 old = {.c = {{1.0f, 1.0f, 1.0f}}}, new = {.c = {{1.1f, 1.1f, 1.1f}}};
    ASSERT_OK(context, alp_ambience_update(a, 0.0));
    ASSERT_OK(context, alp_ambience_submit(a, ask_root(a), &old));
    ASSERT_NEAR(lone_light(a, 0.0), 1.0, 1e-6);
    ASSERT_NEAR(lone_light(a, 7.0), 1.0, 1e-6);
    const uint64_t renewal = ask_root(a);
    assert_true(renewal != 0);
    ASSERT_OK(context, alp_ambience_submit(a, renewal, &new));
    ASSERT_NEAR(lone_light(a, 7.0), 1.0, 1e-6);
    ASSERT_NEAR(lone_light(a, 7.5), 1.025, 1e-6);
    ASSERT_NEAR(lone_light(a, 8.7), 1.085, 1e-6);
    ASSERT_NEAR(lone_light(a, 9.0), 1.1, 1e-6);
    ASSERT_NEAR(lone_light(a, 16.9), 1.1, 1e-6);
    (void)lone_light(a, 17.1);
    assert_int_equal(alp_ambience_get_info(a).anchors, 1); // it fades out
    (void)lone_light(a, 40.0);
    (void)lone_light(a, 40.1);
    assert_int_equal(alp_ambience_get_info(a).anchors, 0);
    alp_ambience_destroy(a);
}

TEST(a_large_change_fades_for_longer)
{
    alp_ambience_options o = small_options();
    o.depth = 1;
    o.lifetime = 20.0;
    o.fade = 1.0;
    alp_ambience *a = world_open(context, &o);
    const alp_sh9 old = {.c = {{1.0f, 1.0f, 1.0f}}}, new = {.c = {{2.5f, 2.5f, 2.5f}}};
    ASSERT_OK(context, alp_ambience_update(a, 0.0));
    ASSERT_OK(context, alp_ambience_submit(a, ask_root(a), &old));
    (void)lone_light(a, 0.0);
    (void)lone_light(a, 13.0);
    ASSERT_OK(context, alp_ambience_submit(a, ask_root(a), &new));
    (void)lone_light(a, 13.0);
    ASSERT_NEAR(lone_light(a, 14.0), 1.3, 1e-5); // .3 of the mean a second
    ASSERT_NEAR(lone_light(a, 18.0), 2.5, 1e-5);
    alp_ambience_destroy(a);
}

/// Light that arrives just after the old light expired takes its place.
TEST(late_light_stays)
{
    alp_ambience_options o = small_options();
    o.depth = 1;
    o.lifetime = 10.0;
    alp_ambience *a = world_open(context, &o);
    const alp_sh9 light = {.c = {{1.0f, 1.0f, 1.0f}}};
    ASSERT_OK(context, alp_ambience_update(a, 0.0));
    ASSERT_OK(context, alp_ambience_submit(a, ask_root(a), &light));
    (void)lone_light(a, 0.0);
    (void)lone_light(a, 9.0);
    const uint64_t renewal = ask_root(a);
    (void)lone_light(a, 10.01); // it expires in this update
    ASSERT_OK(context, alp_ambience_submit(a, renewal, &light));
    for (int i = 1; i < 60; i++) {
        ASSERT_NEAR(lone_light(a, 10.01 + 0.1 * i), 1.0, 1e-6);
    }
    const uint32_t anchor = a->graph.nodes[ALPI_GRAPH_ROOT].anchor;
    assert_int_not_equal(anchor, ALPI_NO_ANCHOR);
    ASSERT_NEAR(a->anchors[anchor].confidence, 1.0, 0.0);
    alp_ambience_destroy(a);
}
