// SPDX-License-Identifier: MIT
// Rays of a hemicube's packets: through their pixels as the cube stands, and the same bits by any
// instructions.
#include "test_support.h"

#include "base/random.h"
#include "transport/gather/hemicube.h"

#include <math.h>

/// 34: packets that are not full.
static const uint32_t RESOLUTIONS[] = {2, 6, 32, 34};
enum { RESOLUTION_COUNT = sizeof RESOLUTIONS / sizeof *RESOLUTIONS, FRAMES = 60 };

static float draw(uint32_t number, uint32_t what)
{
    return 2.0f * alpi_unit_float(alpi_random_key(number, what, 0)) - 1.0f;
}

/// A place and how the cube stands there: about any normal or along axes, turned or upright, near
/// and far.
static void draw_frame(uint32_t number, vec3 *start, alpi_hemicube_frame *frame)
{
    static const float SIZES[] = {0.0f, -0.0f, 1.0f, 1e-30f, 1e30f, 1e-42f};
    const float size = SIZES[number / 3 % 6];
    const uint32_t axis = number % 7;
    const vec3 any = {draw(number, 1), draw(number, 2), draw(number, 3)};
    const vec3 up = {0.0f, 1.0f, 0.0f};
    vec3 normal = vec3_normalize_or(any, up);
    if (axis < 3) {
        const float way = number % 2 == 0 ? 1.0f : -1.0f;
        normal = (vec3){axis == 0 ? way : 0.0f, axis == 1 ? way : -0.0f, axis == 2 ? way : 0.0f};
    }
    *start = (vec3){size * draw(number, 4), size * draw(number, 5), size * draw(number, 6)};
    *frame = number % 4 == 0 ? alpi_hemicube_frame_upright(normal)
                             : alpi_hemicube_frame_about(normal, 1.6f * draw(number, 7));
}

/// Shrinks and stretches the axes, which the loops must not mind: to denormals and large numbers.
static void spoil_frame(uint32_t number, alpi_hemicube_frame *frame)
{
    static const float SIZES[] = {1e-38f, 1e-42f, 1e18f, 3.0f};
    frame->right = vec3_scale(frame->right, SIZES[number % 4]);
    frame->up = vec3_scale(frame->up, SIZES[number / 4 % 4]);
    frame->forward = vec3_scale(frame->forward, SIZES[number / 16 % 4]);
}

static void aim(alpi_hemicube_aim_fn *aim_packet, const alpi_hemicube_packet *packet, vec3 start,
                const alpi_hemicube_frame *frame, int garbage, alpi_rays *rays)
{
    memset(rays, garbage, sizeof *rays);
    aim_packet(packet, start, frame, rays);
}

TEST_WITH_CONTEXT(rays_go_through_their_pixels, 1)
{
    for (int k = 0; k < RESOLUTION_COUNT; k++) {
        const uint32_t n = RESOLUTIONS[k];
        alpi_hemicube *cube = NULL;
        ASSERT_OK(context, alpi_hemicube_create(context, n, &cube));
        for (uint32_t number = 0; number < FRAMES * cube->packet_count; number++) {
            const alpi_hemicube_packet *packet = &cube->packets[number % cube->packet_count];
            alpi_hemicube_frame f;
            vec3 start;
            alpi_rays rays;
            draw_frame(number, &start, &f);
            aim(alpi_hemicube_aim_baseline, packet, start, &f, 0x55, &rays);
            for (int i = 0; i < ALPI_PACKET; i++) {
                double d[3] = {0.0}, length = 0.0;
                if ((packet->active >> i & 1u) != 0) {
                    assert_true(alpi_hemicube_pixel(n, packet->column[i], packet->row[i], d));
                    length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
                }
                const vec3 to = {rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]};
                const vec3 at = {rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]};
                // Roundings of the pixel, the products and the sums, of numbers up to 1.
                ASSERT_NEAR(length * (double)vec3_dot(to, f.right), d[0], 5e-7 * length);
                ASSERT_NEAR(length * (double)vec3_dot(to, f.up), d[1], 5e-7 * length);
                ASSERT_NEAR(length * (double)vec3_dot(to, f.forward), d[2], 5e-7 * length);
                assert_memory_equal(&at, &start, sizeof at);
                assert_true(rays.minimum[i] == 0.0f && isinf(rays.maximum[i]));
                assert_true(rays.mask[i] == UINT32_MAX && rays.time[i] == 0.0f);
                assert_true(rays.id[i] == 0 && rays.flags[i] == 0);
            }
        }
        alpi_hemicube_destroy(cube);
    }
}

TEST(any_instructions_aim_the_same)
{
    bool other = false;
    alp_context *context = test_context(1);
    for (int k = 0; k < RESOLUTION_COUNT; k++) {
        alpi_hemicube *cube = NULL;
        ASSERT_OK(context, alpi_hemicube_create(context, RESOLUTIONS[k], &cube));
        other = cube->aim != alpi_hemicube_aim_baseline;
        for (uint32_t number = 0; number < FRAMES * cube->packet_count && other; number++) {
            alpi_hemicube_packet packet = cube->packets[number % cube->packet_count];
            alpi_hemicube_frame f;
            vec3 start;
            alpi_rays any, best;
            draw_frame(number, &start, &f);
            if (number % 3 == 0) {
                spoil_frame(number / 3, &f);
                packet.x[number % ALPI_PACKET] = -0.0f;
            }
            aim(alpi_hemicube_aim_baseline, &packet, start, &f, 0x55, &any);
            aim(cube->aim, &packet, start, &f, 0xaa, &best);
            assert_memory_equal(&best, &any, sizeof any);
        }
        alpi_hemicube_destroy(cube);
    }
    alp_context_destroy(context);
    if (!other) {
        print_message("this machine has no x86-64-v3, of which there are other loops\n");
        skip();
    }
}
