// SPDX-License-Identifier: MIT
// Noise falls by the number of neighbours, gradients and steps at walls stay, and nothing is done
// where there is nothing to do.
#include "base/context.h"
#include "base/random.h"
#include "maps/denoise.h"
#include "test_scenes.h"

#include <math.h>
#include <stdlib.h>

enum { WIDTH = 48, COUNT = WIDTH * WIDTH };
static const float SIDE = 0.1f;

/// A floor of WIDTH × WIDTH texels about the origin, and what comes out.
typedef struct field {
    uint32_t count;
    float means[COUNT][3], variances[COUNT][3], positions[COUNT][3], normals[COUNT][3];
    float sides[COUNT];
    float out[COUNT][3], left[COUNT][3];
} field;

static field *new_field(void)
{
    field *f = calloc(1, sizeof *f);
    assert_non_null(f);
    f->count = COUNT;
    for (uint32_t i = 0; i < COUNT; i++) {
        f->positions[i][0] = SIDE * ((float)(i % WIDTH) + 0.5f - 0.5f * WIDTH);
        f->positions[i][2] = SIDE * ((float)(i / WIDTH) + 0.5f - 0.5f * WIDTH);
        f->normals[i][1] = 1.0f;
        f->sides[i] = SIDE;
    }
    return f;
}

static void set(field *f, uint32_t i, float mean, float variance)
{
    for (int c = 0; c < 3; c++) {
        f->means[i][c] = mean;
        f->variances[i][c] = variance;
    }
}

/// A normal deviate by Box and Muller.
static float deviate(uint32_t seed, uint32_t i)
{
    const double u = ((double)alpi_hash32(alpi_hash32(2 * i) ^ seed) + 0.5) / 4294967296.0;
    const double v = (double)alpi_hash32(alpi_hash32(2 * i + 1) ^ seed) / 4294967296.0;
    return (float)(sqrt(-2.0 * log(u)) * cos(2.0 * ALPI_PI * v));
}

static alpi_denoise_texels texels_of(const field *f)
{
    return (alpi_denoise_texels){.count = f->count,
                                 .means = (const float(*)[3])f->means,
                                 .variances = (const float(*)[3])f->variances,
                                 .positions = (const float(*)[3])f->positions,
                                 .normals = (const float(*)[3])f->normals,
                                 .sides = f->sides};
}

static void run_with(field *f, alp_context *context, const alpi_tracer *tracer)
{
    const alpi_denoise_texels texels = texels_of(f);
    ASSERT_OK(context, alpi_denoise(context, tracer, &texels, NULL, f->out, f->left));
}

static void run(field *f)
{
    alp_context *context = test_context(2);
    run_with(f, context, NULL);
    alp_context_destroy(context);
}

/// Whether the largest radius reaches over the border.
static bool is_rim(uint32_t i)
{
    const uint32_t x = i % WIDTH, y = i / WIDTH, rim = 8;
    return x < rim || y < rim || x >= WIDTH - rim || y >= WIDTH - rim;
}

TEST(noise_falls_by_the_number_of_neighbours)
{
    const double sigma = 0.2;
    enum { SEEDS = 8 };
    double before = 0.0, after = 0.0, stated = 0.0, sum = 0.0, largest = 0.0;
    for (uint32_t seed = 0; seed < SEEDS; seed++) {
        field *f = new_field();
        for (uint32_t i = 0; i < COUNT; i++) {
            set(f, i, 1.0f + (float)sigma * deviate(seed, i), (float)(sigma * sigma));
        }
        run(f);
        for (uint32_t i = 0; i < COUNT; i++) {
            const double a = (double)f->means[i][0] - 1.0, b = (double)f->out[i][0] - 1.0;
            sum += b / (SEEDS * COUNT);
            largest = fmax(largest, fabs(b));
            if (!is_rim(i)) {
                before += a * a;
                after += b * b;
                stated += (double)f->left[i][0];
            }
        }
        free(f);
    }
    // The largest radius has π 8² · 3/4 = 151 effective neighbours. Where chance makes it look
    // biased smaller ones take part, which leaves a third of them in the mean.
    assert_true(before / after > 151.0 / 3.5 && before / after < 151.0);
    // What chance shows as bias is stated, and a blend's variance is an upper bound.
    assert_true(stated / after > 0.9 && stated / after < 4.0);
    // At the rim a fit has fewer neighbours, but more than one.
    assert_true(largest < 4.0 * sigma);
    // Four standard errors of the mean; 1.3: texels at the rim weigh more than others.
    ASSERT_NEAR(sum, 0.0, 4.0 * 1.3 * sigma / sqrt((double)SEEDS * COUNT));
}

TEST(a_gradient_stays)
{
    field *f = new_field();
    for (uint32_t i = 0; i < COUNT; i++) {
        set(f, i, 10.0f + 2.0f * f->positions[i][0] - f->positions[i][2], 0.01f);
    }
    run(f);
    for (uint32_t i = 0; i < COUNT; i++) {
        // The ridge takes .0001/.07 of the gradient over .4 radii of .8 m where it is one-sided:
        // .0005 of √5 per metre · .32 m, each way; more in a corner.
        ASSERT_NEAR(f->out[i][0], f->means[i][0], 0.003);
        // 151 effective neighbours, some less in a blend; at a corner the fit leans out by .37
        // radii in both directions, with a quarter of them.
        assert_true(f->left[i][0] < 0.01f / (is_rim(i) ? 5.0f : 120.0f));
    }
    free(f);
}

TEST(an_edge_stays_sharp)
{
    // A step of ten standard errors with nothing to tell it by but the light.
    field *f = new_field();
    for (uint32_t i = 0; i < COUNT; i++) {
        set(f, i, (f->positions[i][0] > 0.0f ? 2.0f : 1.0f) + 0.1f * deviate(1, i), 0.01f);
    }
    run(f);
    double squares = 0.0;
    for (uint32_t i = 0; i < COUNT; i++) {
        const double truth = f->positions[i][0] > 0.0f ? 2.0 : 1.0;
        const double error = (double)f->out[i][0] - truth;
        squares += error * error / COUNT;
        ASSERT_NEAR(f->out[i][0], truth, 0.5); // the noise alone reaches .35
    }
    assert_true(squares < 0.01 / 4.0);
    free(f);
}

/// A floor, black on one side of x = 0 and white on the other, both said to be noisy, with a wall
/// between that begins `gap` above the floor.
static void check_wall(float gap, bool traced)
{
    alp_context *context = test_context(2);
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){-3, 0, -3}, (double[]){0, 0, 6}, (double[]){6, 0, 0});
    test_mesh_quad(mesh, (double[]){0, (double)gap, -3}, (double[]){0, 2, 0}, (double[]){0, 0, 6});
    alp_scene *scene = test_mesh_scene(context, mesh, 1);
    alpi_tracer *tracer = NULL;
    ASSERT_OK(context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    field *f = new_field();
    for (uint32_t i = 0; i < COUNT; i++) {
        set(f, i, f->positions[i][0] > 0.0f ? 1.0f : 0.0f, 10.0f);
    }
    run_with(f, context, traced ? tracer : NULL);
    uint32_t leaks = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        const float truth = f->positions[i][0] > 0.0f ? 1.0f : 0.0f;
        leaks += traced && truth == 0.0f ? f->out[i][0] != 0.0f
                                         : fabsf(f->out[i][0] - truth) > 1e-6f; // rounding
        assert_true(f->left[i][0] < 10.0f / 5.0f);                              // it did something
    }
    assert_true(traced ? leaks == 0 : leaks > WIDTH); // or the test shows nothing
    free(f);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

TEST(no_light_passes_a_wall)
{
    check_wall(0.0f, true);
    check_wall(0.2f * SIDE, true); // a slit below it that a texel cannot show
    check_wall(0.0f, false);
}

TEST(other_sides_and_floors_are_strangers)
{
    for (int kind = 0; kind < 2; kind++) {
        // Every second row is the underside of a thin floor, or a floor a little higher.
        field *f = new_field();
        for (uint32_t i = 0; i < COUNT; i++) {
            const bool other = i / WIDTH % 2 == 1;
            f->positions[i][1] = other ? (kind == 0 ? -0.01f : 1.05f * SIDE) : 0.0f;
            f->normals[i][1] = other && kind == 0 ? -1.0f : 1.0f;
            set(f, i, other ? 0.0f : 1.0f, 10.0f);
        }
        run(f);
        for (uint32_t i = 0; i < COUNT; i++) {
            ASSERT_NEAR(f->out[i][0], f->means[i][0], 1e-6); // rounding
        }
        free(f);
    }
}

TEST(a_seam_is_not_seen)
{
    // The same texels as two charts, whose texels alternate in space and not in memory.
    field *one = new_field(), *two = new_field();
    for (uint32_t i = 0; i < COUNT; i++) {
        const uint32_t k = i % 2 * (COUNT / 2) + i / 2;
        set(one, i, 1.0f + 0.1f * deviate(3, i), 0.01f);
        memcpy(two->positions[k], one->positions[i], sizeof *one->positions);
        set(two, k, one->means[i][0], 0.01f);
    }
    run(one);
    run(two);
    for (uint32_t i = 0; i < COUNT; i++) {
        const uint32_t k = i % 2 * (COUNT / 2) + i / 2;
        ASSERT_NEAR(one->out[i][0], two->out[k][0], 1e-5); // sums in another order
        ASSERT_NEAR(one->left[i][0], two->left[k][0], 1e-6);
    }
    free(one);
    free(two);
}

TEST(without_variance_nothing_changes)
{
    field *f = new_field();
    for (uint32_t i = 0; i < COUNT; i++) {
        set(f, i, deviate(4, i), 0.0f);
    }
    run(f);
    assert_memory_equal(f->out, f->means, sizeof f->means);
    assert_memory_equal(f->left, f->variances, sizeof f->variances);
    free(f);
}

TEST(what_is_not_known_comes_from_neighbours)
{
    field *f = new_field();
    for (uint32_t i = 0; i < COUNT; i++) {
        set(f, i, 1.0f, 0.01f);
    }
    const uint32_t middle = COUNT / 2 + WIDTH / 2, lost = 7;
    set(f, middle, NAN, 0.01f);
    set(f, middle + 1, 5.0f, INFINITY);
    set(f, middle + 2, 5.0f, -1.0f);
    set(f, lost, 3.0f, INFINITY);
    f->positions[lost][0] = 100.0f; // nobody is there
    f->positions[lost + 1][0] = NAN;
    f->sides[lost + 2] = 0.0f;
    run(f);
    for (uint32_t i = 0; i < COUNT; i++) {
        ASSERT_NEAR(f->out[i][0], i == lost ? 3.0 : 1.0, 1e-6); // rounding
        assert_true(i == lost || (isfinite(f->left[i][0]) && f->left[i][0] <= 0.01f));
    }
    assert_true(isinf(f->left[lost][0]));
    // Neighbours that are sure of themselves are believed.
    for (uint32_t i = 0; i < COUNT; i++) {
        set(f, i, i == middle ? NAN : 1.0f, 0.0f);
    }
    run(f);
    ASSERT_NEAR(f->out[middle][0], 1.0, 1e-6);
    free(f);
}

TEST(any_number_of_workers_gives_the_same_bits)
{
    field *first = NULL;
    for (uint32_t workers = 1; workers <= 7; workers = workers == 2 ? 7 : workers + 1) {
        field *f = new_field();
        for (uint32_t i = 0; i < COUNT; i++) {
            set(f, i, 1.0f + 0.1f * deviate(5, i), 0.01f);
        }
        alp_context *context = test_context(workers);
        run_with(f, context, NULL);
        // Outputs may be inputs.
        const alpi_denoise_texels texels = texels_of(f);
        ASSERT_OK(context, alpi_denoise(context, NULL, &texels, NULL, f->means, f->variances));
        assert_memory_equal(f->out, f->means, sizeof f->out);
        assert_memory_equal(f->left, f->variances, sizeof f->left);
        alp_context_destroy(context);
        if (first == NULL) {
            first = f;
            continue;
        }
        assert_memory_equal(f->out, first->out, sizeof f->out);
        assert_memory_equal(f->left, first->left, sizeof f->left);
        free(f);
    }
    free(first);
}

TEST(none_and_one)
{
    field *f = new_field();
    set(f, 0, 0.3f, 0.7f);
    f->count = 0;
    run(f);
    assert_true(f->out[0][0] == 0.0f);
    f->count = 1;
    run(f);
    ASSERT_NEAR(f->out[0][0], 0.3, 1e-7);
    ASSERT_NEAR(f->left[0][0], 0.7, 1e-6);
    assert_true(f->out[1][0] == 0.0f);
    free(f);
}

static bool say_no(void *user, const alp_progress *progress)
{
    (void)user;
    (void)progress;
    return false;
}

TEST(it_can_be_stopped_and_run_out_of_memory)
{
    field *f = new_field();
    const alpi_denoise_texels texels = texels_of(f);
    const alpi_task_progress progress = {.callback = say_no};
    alp_context *context = test_context(2);
    assert_int_equal(alpi_denoise(context, NULL, &texels, &progress, f->out, f->left),
                     ALP_ERROR_CANCELLED);
    alp_context_destroy(context);
    int left = 0;
    context = test_context_failing(&left);
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    int failures = 0;
    for (; result != ALP_OK && failures < 100; failures++) {
        left = failures;
        result = alpi_denoise(context, NULL, &texels, NULL, f->out, f->left);
        assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
    }
    assert_true(failures > 6 && failures < 100); // there are six arrays
    alp_context_destroy(context);
    free(f);
}
