// SPDX-License-Identifier: MIT
// Borders of regions: straight where the surface is, whole, on creases, within the angle.
#include "atlas_scenes.h"

#include "base/memory.h"

#include "atlas/regions.h"
#include "scene/adjacency.h"

enum { N = 32, TRIANGLES = 2 * N * N };

/// N x N squares of side 1 in the plane z = 0, those beyond x = fold turned up by an angle.
static alp_scene *bent_grid(alp_context *context, uint32_t fold, double angle)
{
    static float positions[(N + 1) * (N + 1)][3];
    static uint32_t indices[TRIANGLES][3];
    for (uint32_t y = 0; y <= N; y++) {
        for (uint32_t x = 0; x <= N; x++) {
            const double beyond = x > fold ? x - fold : 0.0;
            float *p = positions[y * (N + 1) + x];
            p[0] = (float)(x - beyond + cos(angle) * beyond);
            p[1] = (float)y;
            p[2] = (float)(sin(angle) * beyond);
        }
    }
    for (uint32_t i = 0; i < N * N; i++) {
        const uint32_t a = i / N * (N + 1) + i % N, b = a + 1, c = a + N + 2, d = a + N + 1;
        memcpy(indices[2 * i], (uint32_t[]){a, b, c}, sizeof *indices);
        memcpy(indices[2 * i + 1], (uint32_t[]){a, c, d}, sizeof *indices);
    }
    return scene_of(context, (const float(*)[3])positions, NULL, (N + 1) * (N + 1),
                    (const uint32_t(*)[3])indices, TRIANGLES);
}

typedef struct setting {
    alp_context *context;
    alp_scene *scene;
    uint32_t (*neighbours)[3];
    alpi_regions regions; // two: of triangle 0, and of the last
} setting;

/// Squares for which is_second(x, y) are one region, all others another; planes lean by `lean` from
/// z towards x.
static setting set_up(uint32_t fold, double angle, bool (*is_second)(uint32_t x, uint32_t y),
                      const double lean[2])
{
    setting s = {.context = test_context(1)};
    s.scene = bent_grid(s.context, fold, angle);
    ASSERT_OK(s.context, alpi_adjacency_create(s.scene, &s.neighbours));
    s.regions.of_triangle = ALPI_NEW(s.context, uint32_t, TRIANGLES);
    s.regions.planes = alpi_allocate(s.context, TRIANGLES, sizeof *s.regions.planes);
    assert_true(s.regions.of_triangle != NULL && s.regions.planes != NULL);
    for (uint32_t t = 0; t < TRIANGLES; t++) {
        const bool second = is_second(t / 2 % N, t / 2 / N);
        s.regions.of_triangle[t] = second ? TRIANGLES - 1 : 0;
        s.regions.planes[t][0] = (float)-sin(lean[t == TRIANGLES - 1]);
        s.regions.planes[t][2] = (float)cos(lean[t == TRIANGLES - 1]);
    }
    return s;
}

static void straighten(setting *s)
{
    ASSERT_OK(s->context, alpi_regions_straighten(s->scene, (const uint32_t(*)[3])s->neighbours,
                                                  0.78f, &s->regions));
}

static void tear_down(setting *s)
{
    alpi_release(s->context, s->neighbours);
    alpi_regions_destroy(s->context, &s->regions);
    alp_scene_destroy(s->scene);
    alp_context_destroy(s->context);
}

static double border_length(const setting *s)
{
    double sum = 0.0;
    for (uint32_t t = 0; t < TRIANGLES; t++) {
        vec3 c[3];
        alpi_triangle_corners(s->scene, t, c);
        for (int k = 0; k < 3; k++) {
            const uint32_t across = s->neighbours[t][k];
            if (across != ALPI_NONE && s->regions.of_triangle[across] > s->regions.of_triangle[t]) {
                sum += (double)vec3_length(vec3_sub(c[(k + 1) % 3], c[k]));
            }
        }
    }
    return sum;
}

static uint32_t count_of(const setting *s, uint32_t region)
{
    uint32_t count = 0;
    for (uint32_t t = 0; t < TRIANGLES; t++) {
        count += s->regions.of_triangle[t] == region;
    }
    return count;
}

/// How many triangles can be reached inside the region from its first.
static uint32_t connected_of(const setting *s, uint32_t region)
{
    static uint32_t stack[TRIANGLES];
    static bool seen[TRIANGLES];
    memset(seen, 0, sizeof seen);
    uint32_t count = 0, reached = 0;
    for (uint32_t t = 0; t < TRIANGLES && count == 0; t++) {
        if (s->regions.of_triangle[t] == region) {
            stack[count++] = t;
            seen[t] = true;
        }
    }
    while (count > 0) {
        const uint32_t t = stack[--count];
        reached++;
        for (int k = 0; k < 3; k++) {
            const uint32_t across = s->neighbours[t][k];
            if (across != ALPI_NONE && !seen[across] && s->regions.of_triangle[across] == region) {
                seen[across] = true;
                stack[count++] = across;
            }
        }
    }
    return reached;
}

/// Teeth of 2 x 2 squares.
static bool behind_teeth(uint32_t x, uint32_t y)
{
    return x >= (y / 2 % 2 == 0 ? N / 2 - 1 : N / 2 + 1);
}

TEST(teeth_are_taken_away)
{
    const double lean[2] = {0.0, 0.0};
    setting s = set_up(N, 0.0, behind_teeth, lean);
    assert_true(border_length(&s) > 1.9 * N);
    straighten(&s);
    // Straight but for a step or two at the rims of the grid.
    assert_true(border_length(&s) < 1.05 * N);
    for (int i = 0; i < 2; i++) {
        const uint32_t region = i == 0 ? 0 : TRIANGLES - 1;
        assert_true(count_of(&s, region) > TRIANGLES * 2 / 5);
        assert_int_equal(connected_of(&s, region), count_of(&s, region));
    }
    tear_down(&s);
}

TEST(what_leans_too_far_stays)
{
    // The second plane leans by more than the angle from this surface, so nothing may go over to
    // it; its own teeth go.
    const double lean[2] = {0.0, 0.8};
    setting s = set_up(N, 0.0, behind_teeth, lean);
    bool second[TRIANGLES];
    for (uint32_t t = 0; t < TRIANGLES; t++) {
        second[t] = s.regions.of_triangle[t] != 0;
    }
    straighten(&s);
    uint32_t gone = 0;
    for (uint32_t t = 0; t < TRIANGLES; t++) {
        assert_true(second[t] || s.regions.of_triangle[t] == 0);
        gone += second[t] && s.regions.of_triangle[t] == 0;
    }
    assert_true(gone > 0);
    tear_down(&s);
}

static bool in_strip(uint32_t x, uint32_t y)
{
    (void)y;
    return x >= N - 1;
}

/// What is left of a strip one square wide along the rim of the grid, folded up where it begins.
static uint32_t strip_left(double angle)
{
    const double lean[2] = {0.5 * angle, 0.5 * angle}; // both planes suit both sides
    setting s = set_up(N - 1, angle, in_strip, lean);
    straighten(&s);
    const uint32_t left = count_of(&s, TRIANGLES - 1);
    assert_int_equal(connected_of(&s, TRIANGLES - 1), left);
    tear_down(&s);
    return left;
}

TEST(creases_stay_borders)
{
    assert_int_equal(strip_left(0.0), 0);     // most of what is around it is not it
    assert_int_equal(strip_left(1.4), 2 * N); // nothing goes over a crease of 80 degrees
}

/// Two halves, joined by a neck one square wide.
static bool in_dumbbell(uint32_t x, uint32_t y)
{
    return y == N / 2 || x < N / 2 - 4 || x >= N / 2 + 4;
}

TEST(nothing_falls_apart)
{
    const double lean[2] = {0.0, 0.0};
    setting s = set_up(N, 0.0, in_dumbbell, lean);
    straighten(&s);
    const uint32_t left = count_of(&s, TRIANGLES - 1);
    assert_true(left > 0);
    assert_int_equal(connected_of(&s, TRIANGLES - 1), left);
    tear_down(&s);
}
