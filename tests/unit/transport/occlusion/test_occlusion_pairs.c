// SPDX-License-Identifier: MIT
// Which packets the occlusion kernel lays side by side, whatever the machine takes: never those of
// two receivers, for what a ray through an edge is told may hang on what it is with, and a receiver
// must not hang on its neighbours; and all of a receiver's where their number is even. The kernel
// is compiled with a pen in the place of the tracer.
#include "test_scenes.h"

#include "base/memory.h"
#include "transport/occlusion/occlusion_kernel.h"

enum { RECEIVERS = 21, ALL_LANES = (1 << ALPI_PACKET) - 1 };

/// Packets that were sent.
static uint32_t seen_paired, seen_alone;

static bool takes_pairs(const alpi_tracer *tracer)
{
    (void)tracer;
    return true;
}

/// All rays of a receiver start at one place.
static void see(const float *origins, uint32_t count)
{
    for (uint32_t i = 1; i < count; i++) {
        assert_true(origins[i] == origins[0]);
    }
}

static void see_pairs(const alpi_tracer *tracer, alpi_ray_pair *pairs, uint32_t count,
                      alpi_trace_filter filter)
{
    (void)tracer;
    (void)filter;
    for (uint32_t k = 0; k < count; k++) {
        see(pairs[k].origin_x, 2 * ALPI_PACKET);
        seen_paired += 2;
    }
}

static void see_packets(const alpi_tracer *tracer, alpi_rays *rays, uint32_t count, uint32_t active,
                        alpi_trace_filter filter, alpi_rays_spread spread)
{
    (void)tracer;
    (void)filter;
    assert_int_equal(spread, ALPI_RAYS_NEAR); // which no tracer may pair
    for (uint32_t k = 0; k < count; k++) {
        see(rays[k].origin_x, ALPI_PACKET);
        seen_alone += active != 0 ? 1 : 0;
    }
}

#define alpi_tracer_takes_pairs takes_pairs
#define alpi_trace_occluded_pairs see_pairs
#define alpi_trace_occluded see_packets
#define ALPI_VARIANT(name) seeing_kernel
static alpi_occlusion_kernel seeing_kernel;
#include "transport/occlusion/occlusion_kernel_body.h"

static void place(const void *user, uint32_t receiver, uint32_t count, const float (*square)[2],
                  alpi_receiver_point *points)
{
    (void)user;
    (void)square;
    const vec3 at = {(float)receiver, 0.0f, 0.0f}, up = {0.0f, 1.0f, 0.0f};
    for (uint32_t i = 0; i < count; i++) {
        points[i] = (alpi_receiver_point){at, up, up, 0.0f};
    }
}

static void send_rays(uint32_t samples, bool extended)
{
    alp_context *context = test_context(1);
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0, 0, 0}, (double[]){1, 0, 0}, (double[]){0, 0, 1});
    alp_scene *scene = test_mesh_scene(context, mesh, 1);
    alpi_tracer *tracer = NULL;
    alpi_occlusion_setup setup;
    alpi_occlusion_sums sums;
    alp_occlusion_options options = alp_occlusion_options_default();
    options.samples = samples;
    ASSERT_OK(context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    ASSERT_OK(context, alpi_occlusion_prepare(scene, tracer, &options, &setup));
    ASSERT_OK(context, alpi_occlusion_sums_create(context, RECEIVERS, false, &sums));
    setup.kernel = seeing_kernel;
    const alpi_receivers receivers = {RECEIVERS, extended, place, NULL};
    seen_paired = seen_alone = 0;
    ASSERT_OK(context, alpi_occlusion_add(&setup, &receivers, NULL, RECEIVERS, 0, samples, samples,
                                          NULL, &sums));
    alpi_occlusion_sums_destroy(context, &sums);
    alpi_occlusion_release(&setup);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

TEST(pairs_are_of_one_receiver)
{
    static const struct {
        uint32_t samples;
        uint32_t alone; // packets of a receiver
    } runs[] = {{8, 1},   {16, 0},   {24, 3},  {40, 5},   {64, 0},  {100, 1},
                {256, 0}, {264, 33}, {512, 0}, {1024, 0}, {4096, 0}};
    for (size_t k = 0; k < 2 * (sizeof runs / sizeof *runs); k++) {
        const uint32_t samples = runs[k / 2].samples, each = (samples + 7) / 8;
        send_rays(samples, k % 2 != 0);
        print_message("%u samples: %u packets in pairs, %u alone\n", samples, seen_paired,
                      seen_alone);
        assert_int_equal(seen_paired + seen_alone, RECEIVERS * each);
        assert_int_equal(seen_alone, RECEIVERS * runs[k / 2].alone);
    }
}
