// SPDX-License-Identifier: MIT
// The loop that one writes first: receiver by receiver, point by point, eight samples of one
// point, as they follow each other, in a packet. Written with the same care as ours otherwise: the
// same points, the same samples, directions made eight at a time.
#include "recorded_rays.h"

#include "base/random.h"

#define ALPI_VARIANT(name) bench_unused_kernel
alpi_occlusion_kernel bench_unused_kernel;
#include "transport/occlusion/occlusion_kernel_body.h"

enum { POINT_LIMIT = 128, STREAM_DIRECTION = 0, STREAM_PLACE = 1 };

static void start_lanes(const alpi_receiver_point *p, alpi_occlusion_lanes *lanes)
{
    const vec3 o = vec3_mad(p->position, p->offset, p->geometric_normal), n = p->shading_normal;
    ALPI_EACH_LANE
    {
        lanes->origin[0][i] = o.x;
        lanes->origin[1][i] = o.y;
        lanes->origin[2][i] = o.z;
        lanes->normal[0][i] = n.x;
        lanes->normal[1][i] = n.y;
        lanes->normal[2][i] = n.z;
    }
    alpi_lanes_frames(lanes);
}

/// Eight samples of one point.
static uint32_t trace_eight(const natural_loop *loop, const uint32_t shift[3], uint32_t first,
                            alpi_occlusion_stand *stand)
{
    const alpi_occlusion_lanes *lanes = &stand->groups[0];
    alpi_occlusion_tally tally = {{0}, {{0}}};
    alpi_sample_packet packet;
    const uint32_t(*samples)[3] = (const uint32_t(*)[3])loop->setup->sequence + first;
    ALPI_EACH_LANE
    {
        packet.u[i] = samples[i][0];
        packet.v[i] = samples[i][1];
        packet.w[i] = samples[i][2];
    }
    const alpi_ray_lanes to = ALPI_RAY_LANES(&stand->rays[0], 0);
    alpi_lanes_start(lanes, &to);
    alpi_lanes_aim(loop->setup, lanes, &packet, shift, &to);
    alpi_falloff_ranges(loop->setup->falloff, loop->setup->distance, packet.w, shift[2],
                        to.maximum);
    alpi_trace_occluded(loop->setup->tracer, &stand->rays[0], 1, (1u << ALPI_PACKET) - 1u,
                        loop->setup->filter, ALPI_RAYS_NEAR);
    count_open(stand, 0, 1, 0, &tally);
    uint32_t open = 0;
    for (int i = 0; i < ALPI_PACKET; i++) {
        open += tally.open[i];
    }
    return open;
}

static uint32_t trace_receiver(const natural_loop *loop, uint32_t receiver,
                               alpi_occlusion_stand *stand)
{
    const alpi_occlusion_setup *setup = loop->setup;
    const alpi_receivers *r = loop->receivers;
    alpi_receiver_point points[POINT_LIMIT];
    float square[POINT_LIMIT][2];
    const uint32_t place = alpi_random_key(setup->options.seed, receiver, STREAM_PLACE);
    const uint32_t key = alpi_random_key(setup->options.seed, receiver, STREAM_DIRECTION);
    const uint32_t turned = 1u << 31;
    const uint32_t shift[3] = {alpi_hash32(key ^ 0x68bc21ebu) ^ turned,
                               alpi_hash32(key ^ 0x02e5be93u) ^ turned,
                               alpi_hash32(key ^ 0x967a889bu)};
    const uint32_t corner[2] = {alpi_hash32(place ^ 0x68bc21ebu), alpi_hash32(place ^ 0x02e5be93u)};
    const uint32_t count = loop->count / ALPI_SAMPLES_PER_POINT;
    uint32_t open = 0;
    for (uint32_t k = 0; k < count && k < POINT_LIMIT; k++) {
        square[k][0] = alpi_unit_float(setup->places[k][0] ^ corner[0]);
        square[k][1] = alpi_unit_float(setup->places[k][1] ^ corner[1]);
    }
    r->place(r->user, receiver, count, (const float(*)[2])square, points);
    for (uint32_t k = 0; k < count && k < POINT_LIMIT; k++) {
        start_lanes(&points[k], &stand->groups[0]);
        for (uint32_t s = 0; s < ALPI_SAMPLES_PER_POINT; s += ALPI_PACKET) {
            open += trace_eight(loop, shift, k * ALPI_SAMPLES_PER_POINT + s, stand);
        }
    }
    return open;
}

alp_result natural_loop_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const natural_loop *loop = user;
    alpi_occlusion_stand stand;
    alpi_occlusion_stand_start(loop->setup, &stand);
    for (uint32_t i = begin; i < end; i++) {
        loop->open[loop->list[i]] += trace_receiver(loop, loop->list[i], &stand);
    }
    return ALP_OK;
}
