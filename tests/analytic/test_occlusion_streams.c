// SPDX-License-Identifier: MIT
// Rays leave in packets, batches of packets or streams, of one receiver or of several: whatever the
// number of samples and of receivers, every ray counts once, for its receiver and its quarter.
#include "test_scenes.h"

#include "transport/occlusion/occlusion.h"

#include <math.h>

enum { RECEIVERS = 21 }; // two times as many as go together, and a part

// 4: one a quarter. 8, 24: an odd number of packets of each of several receivers, which go in no
// pairs. 12, 100: quarters of less than a batch of 64 packets. 260: of one more.
static const uint32_t SAMPLES[] = {4, 8, 12, 24, 64, 100, 256, 260, 1000};
enum { SAMPLE_COUNTS = sizeof SAMPLES / sizeof *SAMPLES };

/// Where receivers are: every third in the sealed ball about (20, 0, 0), every third under the lid,
/// every third so far away that it sees nothing; each looks elsewhere.
typedef struct places {
    bool extended;
} places;

static void place(const void *user, uint32_t receiver, uint32_t count, const float (*square)[2],
                  alpi_receiver_point *points)
{
    const places *how = user;
    const float turn = (float)receiver;
    const vec3 n = {0.6f * cosf(turn), 0.8f, 0.6f * sinf(turn)};
    static const vec3 at[3] = {{20.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, {-1e5f, 0.0f, 0.0f}};
    for (uint32_t i = 0; i < count; i++) {
        vec3 p = at[receiver % 3];
        p.x += how->extended ? 0.3f * square[i][0] : 0.0f;
        p.z += how->extended ? 0.3f * square[i][1] : 0.0f;
        points[i] = (alpi_receiver_point){p, n, n, 0.0f};
    }
}

typedef struct rays {
    alp_context *context;
    alp_scene *scene;
    alpi_occlusion_setup setup;
    places places;
} rays;

static void set_up(rays *r, uint32_t samples, bool extended)
{
    *r = (rays){.context = test_context(1), .places = {.extended = extended}};
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){-0.5, 1, -0.4}, (double[]){1.7, 0, 0}, (double[]){0, 0, 1.3});
    test_mesh_sphere(mesh, (double[]){20, 0, 0}, 1.0, 16, 8, 1.0, 0);
    r->scene = test_mesh_scene(r->context, mesh, 1);
    alpi_tracer *tracer = NULL;
    ASSERT_OK(r->context, alpi_tracer_for_scene(r->scene, NULL, NULL, &tracer, NULL));
    alp_occlusion_options options = alp_occlusion_options_default();
    options.samples = samples;
    options.distance = 100.0f;
    options.falloff = ALP_FALLOFF_NONE;
    ASSERT_OK(r->context, alpi_occlusion_prepare(r->scene, tracer, &options, &r->setup));
}

static void tear_down(rays *r)
{
    alpi_occlusion_release(&r->setup);
    alp_scene_destroy(r->scene);
    alp_context_destroy(r->context);
}

/// Sends all samples from the first `count` receivers, at most `step` at a time.
static alpi_occlusion_sums send_rays(const rays *r, uint32_t count, uint32_t step, bool streams)
{
    alpi_occlusion_sums sums;
    alpi_occlusion_setup setup = r->setup;
    setup.spread = streams ? ALPI_RAYS_SCATTERED : ALPI_RAYS_NEAR; // packets go in pairs, or alone
    setup.bent = true;
    const alpi_receivers receivers = {RECEIVERS, r->places.extended, place, &r->places};
    ASSERT_OK(r->context, alpi_occlusion_sums_create(r->context, RECEIVERS, true, &sums));
    for (uint32_t at = 0; at < setup.samples; at += step) {
        const uint32_t left = setup.samples - at;
        ASSERT_OK(r->context,
                  alpi_occlusion_add(&setup, &receivers, NULL, count, at, left < step ? left : step,
                                     setup.samples, NULL, &sums));
    }
    return sums;
}

TEST(every_ray_counts_once)
{
    static const uint32_t steps[] = {UINT32_MAX / 2, 65, 7};
    for (int k = 0; k < 12 * SAMPLE_COUNTS; k++) {
        const bool extended = k % 2 != 0, streams = k / 2 % 2 != 0;
        rays r;
        set_up(&r, SAMPLES[k / 12], extended);
        alpi_occlusion_sums sums = send_rays(&r, RECEIVERS, steps[k / 4 % 3], streams);
        for (uint32_t i = 0; i < RECEIVERS; i++) {
            assert_int_equal(sums.done[i], r.setup.samples);
            uint32_t open = 0;
            for (int q = 0; q < ALPI_QUARTERS; q++) {
                const uint32_t all = r.setup.samples / ALPI_QUARTERS;
                const uint32_t found = sums.open[i][q];
                assert_true(i % 3 == 0 ? found == 0 : i % 3 == 2 ? found == all : found <= all);
                open += found;
            }
            assert_true(i % 3 != 1 || SAMPLES[k / 12] < 64 || (open > 0 && open < r.setup.samples));
            // Σ of unit vectors: no longer than their number, and 0 where there are none
            assert_true(vec3_length(vec3_load(sums.vectors[i])) <= 1.00001f * (float)open);
        }
        alpi_occlusion_sums_destroy(r.context, &sums);
        tear_down(&r);
    }
}

static void assert_same(const alpi_occlusion_sums *a, const alpi_occlusion_sums *b, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(a->done[i], b->done[i]);
        assert_memory_equal(a->open[i], b->open[i], sizeof a->open[i]);
        for (int k = 0; k < 3; k++) { // sums of floats in another order
            ASSERT_NEAR(a->vectors[i][k], b->vectors[i][k], 1e-5 * a->done[i] + 1e-6);
        }
    }
}

TEST(streams_packets_parts_and_steps_agree)
{
    // A ray that grazes an edge may be decided either way: with these seeds none does.
    static const uint32_t counts[] = {1, 7, 8, 9, 15, RECEIVERS};
    // Of which of its receiver's points a sample leaves hangs on the others that are sent with it,
    // but where all parts are whole blocks.
    static const uint32_t steps[2][4] = {{1, 3, 65, 128}, {64, 128, 192, 256}};
    for (int k = 0; k < 2 * SAMPLE_COUNTS; k++) {
        rays r;
        set_up(&r, SAMPLES[k / 2], k % 2 != 0);
        alpi_occlusion_sums whole = send_rays(&r, RECEIVERS, UINT32_MAX / 2, false);
        for (int i = 0; i < 6; i++) {
            for (int streams = 0; streams < 2; streams++) {
                alpi_occlusion_sums sums = send_rays(&r, counts[i], UINT32_MAX / 2, streams != 0);
                assert_same(&whole, &sums, counts[i]);
                for (uint32_t j = counts[i]; j < RECEIVERS; j++) { // not asked: nothing sent
                    assert_int_equal(sums.done[j] + sums.open[j][0], 0);
                }
                alpi_occlusion_sums_destroy(r.context, &sums);
            }
        }
        for (int i = 0; i < 4 && (k % 2 == 0 || SAMPLES[k / 2] % 64 == 0); i++) {
            alpi_occlusion_sums sums = send_rays(&r, RECEIVERS, steps[k % 2][i], i % 2 != 0);
            assert_same(&whole, &sums, RECEIVERS);
            alpi_occlusion_sums_destroy(r.context, &sums);
        }
        alpi_occlusion_sums_destroy(r.context, &whole);
        tear_down(&r);
    }
}
