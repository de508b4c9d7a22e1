// SPDX-License-Identifier: MIT
// Look-ups of the ambience volume against a slow twin that searches the list of all anchors.
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

/// The most confidence among the children of the parent of a place, without the middle one. −1:
/// its parent has no children, because no anchor lies below it.
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

/// A moment in a texel, which may lie beyond the square. There the map continues, turned by half a
/// turn about the middle of the edge.
static double texel_moment(const float (*moments)[2], int x, int y, int which)
{
    if (x < 0 || x > 7) {
        x = x < 0 ? -1 - x : 15 - x;
        y = 7 - y;
    }
    if (y < 0 || y > 7) {
        y = y < 0 ? -1 - y : 15 - y;
        x = 7 - x;
    }
    return (double)moments[8 * y + x][which];
}

/// How well an anchor sees a point `way` metres from it.
static double twin_sees(const alp_ambience *a, const alpi_anchor *at, const double way[3])
{
    const float(*moments)[2] = (const float(*)[2])a->lights.moments[at->slot];
    const double distance = sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
    const vec2 uv = alpi_octahedral_encode((vec3){(float)way[0], (float)way[1], (float)way[2]});
    const double u = 8.0 * (double)uv.x - 0.5, v = 8.0 * (double)uv.y - 0.5;
    double m[2] = {0.0, 0.0};
    if (!(distance > 0.0)) {
        return 1.0;
    }
    for (int i = 0; i < 8; i++) { // two moments of four texels
        const int x = (int)floor(u) + (i & 1), y = (int)floor(v) + (i >> 1 & 1), which = i >> 2;
        m[which] += (1.0 - fabs(u - x)) * (1.0 - fabs(v - y)) * texel_moment(moments, x, y, which);
    }
    const double beyond = fmax(distance - m[0], 0.0), variance = fabs(m[1] - m[0] * m[0]) + 1e-12;
    const double w = fmax(pow(variance / (variance + beyond * beyond), 3.0), 0.05);
    return w < 0.2 ? 25.0 * w * w * w : w;
}

/// @param normal NULL, or the side of a surface that the point lies on
static void twin_read(const alp_ambience *a, const double p[3], const float *normal,
                      float light[ALPI_AMBIENCE_FLOATS])
{
    float rest = a->dawn;
    memset(light, 0, ALPI_AMBIENCE_FLOATS * sizeof *light);
    for (uint32_t level = 0; level <= a->graph.depth; level++) {
        const double cell = a->unit * pow(3.0, level);
        double sum = 0.0, trusted = 0.0, added[ALPI_AMBIENCE_FLOATS] = {0.0};
        for (int corner = 0; corner < 8; corner++) {
            int32_t index[3];
            double t = 1.0, way[3];
            for (int k = 0; k < 3; k++) {
                const double x =
                    a->options.flat && k == 1 ? 0.0 : (p[k] - a->options.centre[k]) / cell;
                index[k] = (int32_t)floor(x) + (corner >> k & 1);
                t *= 1.0 - fabs(x - index[k]);
                way[k] = cell * (x - index[k] + (normal != NULL ? 0.25 * (double)normal[k] : 0.0));
            }
            const int found = find_anchor(a, level, index);
            float openness = 1.0f, confidence = 0.0f;
            double seen = 1.0;
            if (found >= 0) {
                const alpi_anchor *at = &a->anchors[found];
                const float share = level < a->graph.depth ? siblings(a, level, index) : 1.0f;
                const bool has_node = share >= 0.0f;
                confidence = at->level > level ? fminf(at->confidence, share) : at->confidence;
                openness = has_node ? at->open : 1.0f;
                confidence = has_node ? confidence : 0.0f;
                if (a->options.flat) {
                    way[1] += p[1] - (double)at->height;
                }
                if (a->options.visibility && at->slot != ALPI_NO_SLOT && at->confidence > 0.0f) {
                    seen = twin_sees(a, at, way);
                }
            }
            const double f = (double)confidence;
            const double w = t * (double)openness * (1.0 - f + f * seen);
            for (int i = 0; i < ALPI_AMBIENCE_FLOATS && f > 0.0; i++) {
                added[i] += w * f * (double)a->lights.light[a->anchors[found].slot][i];
            }
            sum += w;
            trusted += w * f;
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
        alp_sh9 light, lifted;
        for (int k = 0; k < 3; k++) { // a few outside of the root
            p[k] = centre[k] + (i % 4 == 0 ? 40.0 : 6.0) * (world_random(state) - 0.5);
        }
        alp_ambience_coefficients(s, p, &light);
        twin_read(a, p, NULL, twin);
        for (int k = 0; k < ALPI_AMBIENCE_FLOATS; k++) {
            ASSERT_NEAR(light.c[k / 3][k % 3], twin[k], 2e-5);
        }
        const float normal[1][3] = {{0.48f, 0.6f, -0.64f}};
        const double place[1][3] = {{p[0], p[1], p[2]}};
        float e[1][3];
        alp_ambience_irradiance(s, 1, place, normal, e);
        twin_read(a, p, normal[0], twin);
        memcpy(lifted.c, twin, sizeof twin);
        ASSERT_NEAR(e[0][1], alpi_sh9_irradiance(&lifted, vec3_load(normal[0])).y, 5e-5);
    }
    alp_ambience_end_read(a, s);
}

/// Moves, expiries, lapses of the provider, and jumps outside.
static void fuzz(bool flat, bool visibility, uint64_t seed)
{
    alp_ambience_options o = small_options();
    o.flat = flat;
    o.visibility = visibility;
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
        if (kind < 0.8 && visibility) {
            world_answer_seen(a, &camera, 30, flat ? -1e9 : -2.0);
        } else if (kind < 0.8) {
            world_answer(a, &camera, 30, flat ? -1e9 : -2.0, time);
        }
        if (frame % 4 == 0) {
            ASSERT_OK(context, alp_ambience_update(a, time)); // readers see all answers
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
    assert_in_range(a->graph.node_end, 1, 64); // and its memory is given back
    alp_ambience_destroy(a);
}

TEST(look_ups_are_the_twins)
{
    for (uint64_t seed = 1; seed <= 6; seed++) {
        fuzz(false, false, seed);
        fuzz(false, true, seed);
    }
}

TEST(flat_look_ups_are_the_twins)
{
    for (uint64_t seed = 1; seed <= 6; seed++) {
        fuzz(true, false, seed);
        fuzz(true, true, seed);
    }
}

/// Light that a host submits comes without distances: it is read as without visibility.
static void compare_without_distances(bool flat)
{
    alp_ambience_options o = small_options();
    const alp_ambience_camera camera = {.position = {0.3, 0.2, 0.1}};
    alp_ambience *volumes[2];
    float e[2][1][3];
    uint64_t state = 11;
    o.flat = flat;
    for (int i = 0; i < 2; i++) {
        o.visibility = i == 1;
        volumes[i] = world_open(context, &o);
        world_warm(volumes[i], &camera, flat ? -1e9 : -2.0);
    }
    for (int k = 0; k < 300; k++) {
        double p[1][3];
        const float n[1][3] = {{0.577350269f, 0.577350269f, -0.577350269f}};
        for (int axis = 0; axis < 3; axis++) {
            p[0][axis] = 30.0 * (world_random(&state) - 0.5);
        }
        for (int i = 0; i < 2; i++) {
            const alp_ambience_snapshot *s = alp_ambience_begin_read(volumes[i]);
            alp_ambience_irradiance(s, 1, (const double(*)[3])p, n, e[i]);
            alp_ambience_end_read(volumes[i], s);
        }
        ASSERT_NEAR(e[1][0][0], e[0][0][0], 1e-6);
    }
    alp_ambience_destroy(volumes[0]);
    alp_ambience_destroy(volumes[1]);
}

TEST(anchors_without_distances_see_all_points_that_read_them)
{
    compare_without_distances(false);
    compare_without_distances(true);
}

/// The context counts all that the library allocates.
TEST(look_ups_allocate_nothing)
{
    int left = 1 << 30;
    alp_context *counting = test_context_failing(&left);
    alp_ambience_options o = small_options();
    o.visibility = true;
    alp_ambience *a = world_open(counting, &o);
    const alp_ambience_camera camera = {.position = {0.3, 0.2, 0.1}};
    world_warm(a, &camera, -2.0);
    ASSERT_OK(counting, alp_ambience_update(a, 0.1));
    const int before = left;
    uint64_t state = 9;
    for (int i = 0; i < 200; i++) {
        double p[4][3];
        const float n[4][3] = {{0.0f, 1.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f}, {0.6f, 0.8f, 0.0f}};
        float e[4][3], cube[6][3];
        alp_sh9 light;
        for (int k = 0; k < 12; k++) { // some outside of the root
            p[k / 3][k % 3] = 60.0 * (world_random(&state) - 0.5);
        }
        const alp_ambience_snapshot *s = alp_ambience_begin_read(a);
        alp_ambience_irradiance(s, 4, (const double(*)[3])p, n, e);
        alp_ambience_coefficients(s, p[0], &light);
        alp_ambience_object_cube(s, p[1], p[2], cube);
        alp_ambience_patch(s, (const double(*)[3])p, n, e);
        alp_ambience_end_read(a, s);
    }
    assert_int_equal(left, before);
    alp_ambience_destroy(a);
    alp_context_destroy(counting);
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

/// Nine coefficients may give an E below 0, which no surface receives.
TEST(irradiance_is_never_negative)
{
    const alp_ambience_options o = small_options();
    alp_ambience *a = world_open(context, &o);
    const alp_ambience_camera camera = {.position = {0.0, 0.0, 0.0}};
    const alp_sh9 light = {.c = {{1.0f, 1.0f, 1.0f}, {1.5f, 1.5f, 1.5f}}}; // E(−y) = −.649
    const double low[3] = {-0.1, -0.1, -0.1}, high[3] = {0.1, 0.1, 0.1};
    const double corners[4][3] = {{0.0}};
    float cube[6][3], down[4][3], e[4][3];
    alp_ambience_request request;
    ASSERT_OK(context, alp_ambience_update(a, 0.0));
    ASSERT_OK(context, alp_ambience_next(a, &camera, &request));
    ASSERT_OK(context, alp_ambience_submit(a, request.id, &light));
    ASSERT_OK(context, alp_ambience_update(a, 0.0));
    const alp_ambience_snapshot *s = alp_ambience_begin_read(a);
    for (int way = 0; way < 6; way++) {
        for (int i = 0; i < 4; i++) {
            memset(down[i], 0, sizeof down[i]);
            down[i][way / 2] = way % 2 == 0 ? 1.0f : -1.0f;
        }
        alp_ambience_patch(s, corners, (const float(*)[3])down, e);
        alp_ambience_object_cube(s, low, high, cube);
        assert_true(e[3][1] >= 0.0f && cube[way][1] >= 0.0f);
        alp_ambience_irradiance(s, 4, corners, (const float(*)[3])down, e);
        assert_true(e[3][1] >= 0.0f);
    }
    alp_ambience_end_read(a, s);
    alp_ambience_destroy(a);
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
