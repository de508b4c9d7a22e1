// SPDX-License-Identifier: MIT
// All receivers share one sequence, each with digital shifts of its own: the errors of neighbours
// must have nothing to do with each other. Equal receivers make that sharp: where n errors of one
// variance are uncorrelated, the variance of their mean is 1/n of it; a correlation r makes it
// 1 + (n − 1) r times as much.
#include "test_scenes.h"

#include "transport/occlusion/occlusion.h"

#include <math.h>

enum { SEEDS = 256, RECEIVERS = 64 };

/// Two places of which one sees nothing and the other all but a lid.
typedef struct stage {
    bool divided; // by where in the receiver the point lies, else it is the place under the lid
} stage;

/// The part of the unit square that is inside the sealed box, on no dyadic lines.
static bool is_sealed(const float square[2])
{
    return square[0] > 0.13f && square[0] < 0.61f && square[1] > 0.23f && square[1] < 0.94f;
}

static void place(const void *user, uint32_t receiver, uint32_t count, const float (*square)[2],
                  alpi_receiver_point *points)
{
    (void)receiver;
    const stage *s = user;
    const vec3 up = {0.0f, 1.0f, 0.0f}, under_lid = {0.0f, 0.0f, 0.0f},
               in_box = {20.0f, 0.0f, 0.0f};
    for (uint32_t i = 0; i < count; i++) {
        const bool sealed = s->divided && is_sealed(square[i]);
        points[i] = (alpi_receiver_point){sealed ? in_box : under_lid, up, up, 0.0f};
    }
}

/// A lid 1 m above the origin, and a closed ball about (20, 0, 0).
static alp_scene *lid_and_box(alp_context *context)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){-0.5, 1, -0.4}, (double[]){1.7, 0, 0}, (double[]){0, 0, 1.3});
    test_mesh_sphere(mesh, (double[]){20, 0, 0}, 1.0, 8, 4, 1.0, 0);
    return test_mesh_scene(context, mesh, 1);
}

/// What is sent: the first `samples` of a sequence of `length`.
typedef struct trial {
    stage stage;
    alp_falloff falloff;
    uint32_t length, samples;
} trial;

static void gather(const alp_scene *scene, const trial *t, uint64_t seed, double *values)
{
    alpi_tracer *tracer = NULL;
    alp_occlusion_options options = alp_occlusion_options_default();
    options.samples = t->length;
    options.falloff = t->falloff;
    options.distance = t->falloff == ALP_FALLOFF_NONE ? INFINITY : 2.0f;
    options.seed = seed;
    alpi_occlusion_setup setup;
    alpi_occlusion_sums sums;
    ASSERT_OK(scene->context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    ASSERT_OK(scene->context, alpi_occlusion_prepare(scene, tracer, &options, &setup));
    ASSERT_OK(scene->context, alpi_occlusion_sums_create(scene->context, RECEIVERS, false, &sums));
    const alpi_receivers receivers = {RECEIVERS, t->stage.divided, place, &t->stage};
    ASSERT_OK(scene->context, alpi_occlusion_add(&setup, &receivers, NULL, RECEIVERS, 0, t->samples,
                                                 setup.samples, NULL, &sums));
    for (uint32_t i = 0; i < RECEIVERS; i++) {
        values[i] = (double)alpi_occlusion_value(&sums, i);
    }
    alpi_occlusion_sums_destroy(scene->context, &sums);
    alpi_occlusion_release(&setup);
}

/// Variance over the seeds of the mean of the receivers, over a RECEIVERSth of the variance of one.
static double variance_ratio(const alp_scene *scene, const trial *t)
{
    double sum = 0.0, squares = 0.0, mean_squares = 0.0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        double values[RECEIVERS], mean = 0.0;
        gather(scene, t, seed, values);
        for (int i = 0; i < RECEIVERS; i++) {
            mean += values[i] / RECEIVERS;
            squares += values[i] * values[i];
        }
        sum += mean;
        mean_squares += mean * mean;
    }
    const double truth = sum / SEEDS;
    const double of_mean = (mean_squares - SEEDS * truth * truth) / (SEEDS - 1);
    const double of_one = squares / (SEEDS * RECEIVERS) - truth * truth;
    assert_true(of_one > 1e-6); // there is an error to speak of
    return of_mean * RECEIVERS / of_one;
}

static void check(const trial *trials, size_t count)
{
    // Means of 64 errors are nearly normal: the variance of 256 of them has a relative standard
    // error of √(2 / 255). Four of these make |r| < .006.
    const double limit = 4.0 * sqrt(2.0 / (SEEDS - 1));
    alp_context *context = test_context(1);
    alp_scene *scene = lid_and_box(context);
    int wrong = 0;
    for (size_t i = 0; i < count; i++) {
        const double ratio = variance_ratio(scene, &trials[i]);
        print_message("%u of %u samples: ratio %.2f, r %+.4f\n", trials[i].samples,
                      trials[i].length, ratio, (ratio - 1.0) / (RECEIVERS - 1));
        wrong += !(fabs(ratio - 1.0) < limit);
    }
    assert_int_equal(wrong, 0);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

TEST(directions_of_neighbours_are_not_correlated)
{
    const trial trials[] = {
        {{false}, ALP_FALLOFF_NONE, 4, 4},     {{false}, ALP_FALLOFF_NONE, 16, 16},
        {{false}, ALP_FALLOFF_NONE, 64, 64},   {{false}, ALP_FALLOFF_NONE, 100, 100},
        {{false}, ALP_FALLOFF_NONE, 300, 300}, {{false}, ALP_FALLOFF_NONE, 512, 512},
    };
    check(trials, sizeof trials / sizeof *trials);
}

TEST(the_beginning_of_a_long_sequence_is_as_good)
{
    const trial trials[] = {
        {{false}, ALP_FALLOFF_NONE, 4096, 64},
        {{false}, ALP_FALLOFF_NONE, 4096, 256},
        {{false}, ALP_FALLOFF_NONE, 4096, 768},
    };
    check(trials, sizeof trials / sizeof *trials);
}

TEST(lengths_of_neighbours_are_not_correlated)
{
    const trial trials[] = {
        {{false}, ALP_FALLOFF_SMOOTH, 16, 16},
        {{false}, ALP_FALLOFF_SMOOTH, 64, 64},
        {{false}, ALP_FALLOFF_SMOOTH, 300, 300},
    };
    check(trials, sizeof trials / sizeof *trials);
}

TEST(places_of_neighbours_are_not_correlated)
{
    const trial trials[] = {
        {{true}, ALP_FALLOFF_NONE, 16, 16},
        {{true}, ALP_FALLOFF_NONE, 64, 64},
        {{true}, ALP_FALLOFF_NONE, 300, 300},
    };
    check(trials, sizeof trials / sizeof *trials);
}
