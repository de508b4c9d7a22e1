// SPDX-License-Identifier: MIT
// Stated errors are true: over a map, against the root mean square of its real error, and texel by
// texel over seeds. The truth is two bakes of the same texels with many rays each, independent of
// the map and of each other: E[(x − y₁)(x − y₂)] is the squared error of x without their own.
#include "test_support.h"

#include "bake/occlusion/occlusion_rounds.h"

#include <math.h>
#include <stdlib.h>

enum { TRUTH_SAMPLES = 1024, SEEDS = 32 };

typedef struct map_case {
    alp_scene *scene;
    alpi_tracer *tracer;
    alp_atlas *atlas;
    alpi_texels texels;
    alpi_lattice lattice;
    float *truth[2], *errors;
} map_case;

static void gather_truth(alp_context *context, map_case *m, const alp_occlusion_options *options)
{
    const alpi_receivers receivers = alpi_texels_receivers(&m->texels);
    for (uint64_t k = 0; k < 2; k++) {
        alp_occlusion_options many = *options;
        alpi_occlusion_setup setup;
        many.samples = TRUTH_SAMPLES;
        many.seed = 1000 + k;
        m->truth[k] = calloc(m->texels.count, sizeof(float));
        ASSERT_OK(context, alpi_occlusion_prepare(m->scene, m->tracer, &many, &setup));
        ASSERT_OK(context, alpi_occlusion_gather(&setup, &receivers, m->lattice.order,
                                                 m->texels.count, m->truth[k]));
        alpi_occlusion_release(&setup);
    }
}

static void open_case(alp_context *context, const char *name, uint32_t size, map_case *m)
{
    const alp_occlusion_options options = alp_occlusion_options_default();
    alp_atlas_options atlas = alp_atlas_options_default();
    atlas.size = size;
    memset(m, 0, sizeof *m);
    ASSERT_OK(context, alp_scene_load(context, name, &m->scene));
    ASSERT_OK(context, alpi_tracer_for_scene(m->scene, NULL, NULL, &m->tracer, NULL));
    ASSERT_OK(context, alp_atlas_create(m->scene, &atlas, &m->atlas));
    ASSERT_OK(context, alpi_texels_create(m->atlas, &m->texels));
    ASSERT_OK(context, alpi_lattice_create(m->atlas, &m->texels, &m->lattice));
    m->errors = calloc(m->texels.count, sizeof(float));
    gather_truth(context, m, &options);
}

static void close_case(alp_context *context, map_case *m)
{
    alpi_lattice_destroy(&m->lattice);
    alpi_texels_destroy(context, &m->texels);
    alp_atlas_destroy(m->atlas);
    alp_scene_destroy(m->scene);
    free(m->truth[0]);
    free(m->truth[1]);
    free(m->errors);
}

static void bake(alp_context *context, map_case *m, uint32_t samples, uint64_t seed, float accuracy)
{
    const alpi_receivers receivers = alpi_texels_receivers(&m->texels);
    alp_occlusion_options options = alp_occlusion_options_default();
    alpi_occlusion_report report;
    alpi_occlusion_setup setup;
    alpi_scratch scratch;
    const alpi_occlusion_task task = {.setup = &setup,
                                      .receivers = &receivers,
                                      .order = m->lattice.order,
                                      .count = m->texels.count,
                                      .lattice = &m->lattice,
                                      .errors = m->errors,
                                      .scratch = &scratch,
                                      .accuracy = accuracy,
                                      .deadline = HUGE_VAL};
    options.samples = samples;
    options.seed = seed;
    memset(m->lattice.states, 0, m->texels.count);
    ASSERT_OK(context, alpi_occlusion_prepare(m->scene, m->tracer, &options, &setup));
    ASSERT_OK(context, alpi_scratch_create(context, m->texels.count, false, &scratch));
    ASSERT_OK(context, alpi_occlusion_rounds(&task, &report));
    alpi_scratch_destroy(&scratch);
    alpi_occlusion_release(&setup);
}

static double squared_error(const map_case *m, uint32_t texel)
{
    const double x = (double)m->lattice.values[texel];
    return (x - (double)m->truth[0][texel]) * (x - (double)m->truth[1][texel]);
}

/// √ Σ stated² / √ Σ error² over the texels of maps of some seeds. One map alone says little: half
/// of its squared error may come from a hundred texels.
static double stated_over_true(alp_context *context, map_case *m, uint32_t samples)
{
    double stated = 0.0, real = 0.0;
    for (uint64_t seed = 1; seed <= 6; seed++) {
        bake(context, m, samples, seed, ALP_ADAPTIVE_AUTO);
        for (uint32_t i = 0; i < m->texels.count; i++) {
            stated += (double)m->errors[i] * (double)m->errors[i];
            real += squared_error(m, i);
        }
    }
    return sqrt(stated / real);
}

TEST_WITH_CONTEXT(maps_state_their_error, 2)
{
    static const char *const names[] = {"builtin:cornell",     "builtin:sphere-plane",
                                        "builtin:torus-plane", "builtin:teapot-room",
                                        "builtin:bowl",        "builtin:furnace"};
    for (int i = 0; i < 6; i++) {
        map_case m;
        open_case(context, names[i], 80, &m);
        for (uint32_t samples = 64; samples <= 256; samples *= 4) {
            const double ratio = stated_over_true(context, &m, samples);
            print_message("accuracy: stated over true error, %s, %u rays: %.3f\n", names[i],
                          samples, ratio);
            assert_true(ratio > 0.85 && ratio < 1.15);
        }
        close_case(context, &m);
    }
}

/// Where nearly all is open, as on most of a plane with a sphere, rays that lie in strata err less
/// than the variance of their answers says: the map's error is true, and these texels' too careful.
static const double LEAST_SPREAD = 0.65;

/// Mean and spread of error / stated error over SEEDS seeds and all texels that state one.
static void find_z(alp_context *context, map_case *m, float accuracy, double *mean, double *spread)
{
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        bake(context, m, 64, seed, accuracy);
        for (uint32_t i = 0; i < m->texels.count; i++) {
            const double e = (double)m->errors[i];
            if (e > 0.0) {
                const double truth = 0.5 * ((double)m->truth[0][i] + (double)m->truth[1][i]);
                sum += ((double)m->lattice.values[i] - truth) / e;
                squares += squared_error(m, i) / (e * e);
                count += 1.0;
            }
        }
    }
    *mean = sum / count;
    *spread = sqrt(squares / count);
}

TEST_WITH_CONTEXT(texels_state_their_error, 2)
{
    static const char *const names[] = {"builtin:cornell", "builtin:sphere-plane",
                                        "builtin:torus-plane", "builtin:teapot-room"};
    for (int i = 0; i < 4; i++) {
        map_case m;
        double mean = 0.0, spread = 0.0;
        open_case(context, names[i], 48, &m);
        find_z(context, &m, ALP_ADAPTIVE_OFF, &mean, &spread);
        print_message("accuracy: error over stated error, %s, every texel traced, 32 seeds: mean "
                      "%+.3f, spread %.3f\n",
                      names[i], mean, spread);
        assert_true(fabs(mean) < 0.05);
        assert_true(spread > LEAST_SPREAD && spread < 1.25);
        find_z(context, &m, ALP_ADAPTIVE_AUTO, &mean, &spread);
        print_message("accuracy: error over stated error, %s, adaptive, 32 seeds: mean %+.3f, "
                      "spread %.3f\n",
                      names[i], mean, spread);
        assert_true(fabs(mean) < 0.2); // interpolation has a bias, below its stated error
        assert_true(spread > LEAST_SPREAD && spread < 1.25);
        close_case(context, &m);
    }
}
