// SPDX-License-Identifier: MIT
// Faces cut into triangles: the area is that of the face, every triangle turns the same way, and
// large faces take about as many steps a corner as small ones.
#include "test_support.h"

#include "base/random.h"
#include "base/vec.h"
#include "formats/polygon/polygon.h"

#include <math.h>
#include <stdlib.h>

enum { LIMIT = 1 << 18 };
static float corners[LIMIT][3];
static uint32_t triangles[LIMIT][3];

typedef struct outcome {
    double area, turned; // sums of those that turn as the face, and of the others
    uint32_t without_area;
    uint64_t steps;
    bool clean;
} outcome;

/// Cuts the first `count` corners; `normal` is the side they turn left about.
static outcome cut(uint32_t count, const double normal[3])
{
    alp_context *context = test_context(1);
    alpi_polygon_scratch scratch = {.context = context};
    outcome o = {0};
    ASSERT_OK(context, alpi_polygon_triangulate(&scratch, count, (const float(*)[3])corners,
                                                triangles, &o.clean));
    for (uint32_t t = 0; t + 2 < count; t++) {
        double e[2][3], n[3];
        for (int k = 0; k < 3; k++) {
            assert_in_range(triangles[t][k], 0, count - 1);
            e[0][k] = (double)corners[triangles[t][1]][k] - (double)corners[triangles[t][0]][k];
            e[1][k] = (double)corners[triangles[t][2]][k] - (double)corners[triangles[t][0]][k];
        }
        double along = 0.0;
        for (int k = 0; k < 3; k++) {
            int l = (k + 1) % 3, m = (k + 2) % 3;
            n[k] = e[0][l] * e[1][m] - e[0][m] * e[1][l];
            along += 0.5 * n[k] * normal[k];
        }
        *(along < 0.0 ? &o.turned : &o.area) += along;
        o.without_area += along == 0.0;
    }
    o.steps = scratch.work;
    alpi_polygon_scratch_destroy(&scratch);
    alp_context_destroy(context);
    return o;
}

static void put(uint32_t i, double x, double y)
{
    corners[i][0] = (float)x;
    corners[i][1] = (float)y;
    corners[i][2] = 0.0f;
}

static const double up[3] = {0.0, 0.0, 1.0};

static void check(const char *name, uint32_t count, double area, double tolerance)
{
    outcome o = cut(count, up);
    if (!o.clean || o.turned != 0.0 || o.without_area != 0 || fabs(o.area - area) > tolerance) {
        fail_msg("%s of %u corners: area %.17g of %.17g, %g turned, %u without, %s", name, count,
                 o.area, area, o.turned, o.without_area, o.clean ? "clean" : "crossed");
    }
}

typedef struct small_shape {
    const char *name;
    uint32_t count;
    double xy[16][2], area; // 0: its edges touch
} small_shape;

/// Cuts it, beginning at a corner.
static void check_shape(const small_shape *s, uint32_t first)
{
    double shoelace = 0.0;
    for (uint32_t i = 0; i < s->count; i++) {
        const double *p = s->xy[(first + i) % s->count];
        const double *q = s->xy[(first + i + 1) % s->count];
        put(i, p[0], p[1]);
        shoelace += 0.5 * (p[0] * q[1] - p[1] * q[0]);
    }
    if (s->area != 0.0) {
        ASSERT_NEAR(shoelace, s->area, 0.0);
        check(s->name, s->count, s->area, 0.0);
    } else { // its edges touch: nothing but the sum is promised
        outcome o = cut(s->count, up);
        ASSERT_NEAR(o.area + o.turned, shoelace, 0.0);
    }
}

/// Exact in floats: sums of halves of whole numbers.
TEST(small_shapes)
{
    static const small_shape shapes[] = {
        {"triangle", 3, {{0, 0}, {2, 0}, {0, 2}}, 2},
        {"square", 4, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 1},
        {"arrow", 4, {{0, 0}, {4, -4}, {1, 0}, {4, 4}}, 4},
        {"arrow, dent first", 4, {{1, 0}, {4, 4}, {0, 0}, {4, -4}}, 4},
        {"L", 6, {{2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}, {0, 0}}, 3},
        {"square with a corner on an edge", 5, {{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}, 4},
        {"triangle with two on one edge", 5, {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {0, 3}}, 4.5},
        {"cross",
         12,
         {{1, 0},
          {2, 0},
          {2, 1},
          {3, 1},
          {3, 2},
          {2, 2},
          {2, 3},
          {1, 3},
          {1, 2},
          {0, 2},
          {0, 1},
          {1, 1}},
         5},
        {"a hole with a bridge",
         10,
         {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}},
         12},
        {"spiral",
         12,
         {{0, 0},
          {7, 0},
          {7, 7},
          {0, 7},
          {0, 2},
          {5, 2},
          {5, 5},
          {2, 5},
          {2, 4},
          {4, 4},
          {4, 3},
          {1, 3}},
         0},
    };
    for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++) {
        for (uint32_t first = 0; first < shapes[s].count; first++) { // from any corner
            check_shape(&shapes[s], first);
        }
    }
}

/// Either winding, in any plane: the triangles turn as the face does.
TEST(any_plane)
{
    static const double ell[6][2] = {{2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}, {0, 0}};
    for (int turned = 0; turned < 2; turned++) {
        for (int axis = 0; axis < 3; axis++) {
            for (uint32_t i = 0; i < 6; i++) {
                const double *p = ell[turned ? 5 - i : i];
                corners[i][(axis + 1) % 3] = (float)p[0];
                corners[i][(axis + 2) % 3] = (float)p[1];
                corners[i][axis] = (float)(2.0 * p[0] - p[1] + 5.0); // slanted
            }
            double normal[3];
            normal[axis] = turned ? -1.0 : 1.0;
            normal[(axis + 1) % 3] = -2.0 * normal[axis];
            normal[(axis + 2) % 3] = normal[axis];
            outcome o = cut(6, normal);
            assert_true(o.clean);
            ASSERT_NEAR(o.turned, 0.0, 0.0);
            // 3 in the plane of the two axes, times the normal's length squared: it is not unit
            ASSERT_NEAR(o.area, 3.0 * 6.0, 0.0);
        }
    }
}

/// Shoelace sum of the corners as they are stored.
static double stored_area(uint32_t count)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const float *p = corners[i], *q = corners[(i + 1) % count];
        sum += 0.5 * ((double)p[0] * (double)q[1] - (double)p[1] * (double)q[0]);
    }
    return sum;
}

/// A star with random radii is simple from its centre; doubles sum to 1e-12 of the area.
TEST(random_stars)
{
    uint64_t seed = 7;
    for (uint32_t count = 4; count < 3000; count += count / 3) {
        for (int round = 0; round < 20; round++) {
            for (uint32_t i = 0; i < count; i++) {
                seed = alpi_hash64(seed);
                double radius = 0.2 + (double)(seed >> 40) * 0x1p-24;
                double angle = 2.0 * ALPI_PI * i / count;
                put(i, radius * cos(angle), radius * sin(angle));
            }
            double area = stored_area(count);
            check("star", count, area, 1e-12 * area);
        }
    }
}

/// Long teeth, a crescent, a zigzag: what makes plain ear clipping take the square of the corners.
TEST_SLOW(large_faces)
{
    for (uint32_t n = 1 << 8; n <= 1 << 16; n *= 16) {
        for (uint32_t i = 0; i < n; i++) { // comb: teeth of height 1000, valleys near the bottom
            put(i, (double)(n - i), i % 2 ? 1000.0 : 1.0);
        }
        put(n, 0.0, 0.0);
        put(n + 1, (double)(n + 1), 0.0);
        double area = stored_area(n + 2);
        check("comb", n + 2, area, 1e-11 * area);
        outcome o = cut(n + 2, up);
        assert_in_range(o.steps / (n + 2), 0, 700);
        for (uint32_t i = 0; i < n; i++) { // crescent: half of the corners are dents
            double angle = ALPI_PI * (i + 0.5) / (n / 2);
            bool inner = i >= n / 2;
            double turn = inner ? ALPI_PI * (n - i - 0.5) / (n / 2) : angle;
            double radius = inner ? 0.9 : 1.0;
            put(i, 1e4 * radius * cos(turn), 1e4 * (radius * sin(turn)));
        }
        area = stored_area(n);
        o = cut(n, up);
        ASSERT_NEAR(o.area + o.turned, area, 1e-11 * area);
        // measured 10, 29 and 76 a corner: far below n, which looking at all would take
        assert_in_range(o.steps / n, 0, 200);
        assert_true(o.clean);
    }
}

/// 20,000 corners that were chosen to be slow end within the steps that are promised: 2048 a corner
/// and, because the last look and the last corner are taken whole, n and all cells.
TEST(hostile_faces)
{
    enum { N = 20000 };
    static const char *const names[] = {"needles", "one line there and back", "all crossing",
                                        "comb in a comb"};
    for (int shape = 0; shape < 4; shape++) {
        for (uint32_t i = 0; i < N; i++) {
            const double a = (double)(alpi_hash64(i) >> 40) * 0x1p-24;
            const double b = (double)(alpi_hash64(i + N) >> 40) * 0x1p-24;
            const double radius = i % 2 ? 1.0 : 0.1 * (1.0 + a), angle = 2.0 * ALPI_PI * i / N;
            switch (shape) {
            case 0:
                put(i, radius * cos(angle), radius * sin(angle));
                break;
            case 1:
                put(i, a, i == 0 ? 1.0 : 0.0);
                break;
            case 2:
                put(i, a, b);
                break;
            default: // long teeth from above reach between those from below
                put(i, i < N / 2 ? i : N - i + 0.25, i % 2 ? 1.0 : i < N / 2 ? 1000.0 : 1001.0);
            }
        }
        const outcome o = cut(N, up);
        if (o.steps > (uint64_t)2048 * N + (1 << 14) + N + (1 << 20)) {
            fail_msg("%s: %llu steps", names[shape], (unsigned long long)o.steps);
        }
        ASSERT_NEAR(o.area + o.turned, stored_area(N), 1e-9 * N);
        assert_true(shape != 0 || (o.clean && o.turned == 0.0));
    }
}

/// Crossing edges, all in one place, on one line: triangles come out all the same, and it is said.
TEST(broken_faces)
{
    static const double bow[4][2] = {{0, 0}, {2, 2}, {2, 0}, {0, 3}};
    for (uint32_t i = 0; i < 4; i++) {
        put(i, bow[i][0], bow[i][1]);
    }
    (void)cut(4, up);
    for (uint32_t i = 0; i < 5; i++) { // a pentagram
        put(i, cos(0.8 * ALPI_PI * i), sin(0.8 * ALPI_PI * i));
    }
    outcome o = cut(5, up);
    ASSERT_NEAR(o.area + o.turned, stored_area(5), 1e-12); // its middle counts twice
    for (uint32_t i = 0; i < 7; i++) {
        put(i, 1.0, 2.0);
    }
    o = cut(7, up);
    assert_int_equal(o.without_area, 5);
    for (uint32_t i = 0; i < 7; i++) {
        put(i, (double)(i * i), (double)(i * i));
    }
    o = cut(7, up);
    assert_int_equal(o.without_area, 5);
    for (uint32_t i = 0; i < 64; i++) { // random: crosses itself many times
        put(i, (double)(alpi_hash64(i) >> 40), (double)(alpi_hash64(i + 1000) >> 40));
        corners[i][2] = (float)(alpi_hash64(i + 2000) >> 40);
    }
    o = cut(64, up);
    assert_false(o.clean);
    for (uint32_t i = 0; i < 64; i++) { // the largest floats
        put(i, i % 3 ? 3e38 : -3e38, i % 5 ? -3e38 : 3e38);
    }
    (void)cut(64, up);
}

TEST(failing_memory)
{
    int left = 0;
    alp_context *context = test_context_failing(&left);
    alpi_polygon_scratch scratch = {.context = context};
    bool clean;
    for (uint32_t i = 0; i < 8; i++) {
        put(i, (i % 2 ? 1.0 : 3.0) * cos(ALPI_PI * i / 4),
            (i % 2 ? 1.0 : 3.0) * sin(ALPI_PI * i / 4));
    }
    left = 0;
    assert_int_equal(
        alpi_polygon_triangulate(&scratch, 8, (const float(*)[3])corners, triangles, &clean),
        ALP_ERROR_OUT_OF_MEMORY);
    left = 1;
    assert_int_equal(
        alpi_polygon_triangulate(&scratch, 8, (const float(*)[3])corners, triangles, &clean),
        ALP_OK);
    assert_true(clean);
    alpi_polygon_scratch_destroy(&scratch);
    alp_context_destroy(context);
}
