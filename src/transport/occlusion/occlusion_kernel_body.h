// SPDX-License-Identifier: MIT
// Body of alpi_occlusion_kernel, included once for each instruction set. Rays of random length
// replace the weights of the fall-off (falloff.h), so each ray is only tested for being blocked.
#include "transport/occlusion/falloff.h"
#include "transport/occlusion/occlusion_aim.h"

/// Packet k of a batch of which the first `paired` are traced in pairs.
static inline alpi_ray_lanes lanes_of(alpi_occlusion_stand *stand, uint32_t k, uint32_t paired)
{
    return k < paired ? ALPI_RAY_LANES(&stand->pairs[k / 2], k % 2 * ALPI_PACKET)
                      : ALPI_RAY_LANES(&stand->rays[k], 0);
}

/// Packets [first, end) of a batch, four at a time: the sums go through memory.
static inline void count_open(alpi_occlusion_stand *stand, uint32_t first, uint32_t end,
                              uint32_t paired, alpi_occlusion_tally *tally)
{
    uint32_t k = first;
    for (; k + 4 <= end; k += 4) {
        const float *a = lanes_of(stand, k, paired).maximum;
        const float *b = lanes_of(stand, k + 1, paired).maximum;
        const float *c = lanes_of(stand, k + 2, paired).maximum;
        const float *d = lanes_of(stand, k + 3, paired).maximum;
        ALPI_EACH_LANE
        {
            const uint32_t open = (a[i] >= 0.0f ? 1u : 0u) + (b[i] >= 0.0f ? 1u : 0u) +
                                  (c[i] >= 0.0f ? 1u : 0u) + (d[i] >= 0.0f ? 1u : 0u);
            tally->open[i] += open;
        }
    }
    for (; k < end; k++) {
        const float *a = lanes_of(stand, k, paired).maximum;
        ALPI_EACH_LANE
        {
            tally->open[i] += a[i] >= 0.0f ? 1u : 0u;
        }
    }
}

static inline void bend(const alpi_ray_lanes *rays, alpi_occlusion_tally *tally)
{
    const float *x = rays->direction[0], *y = rays->direction[1], *z = rays->direction[2];
    ALPI_EACH_LANE
    {
        float open = rays->maximum[i] >= 0.0f ? 1.0f : 0.0f;
        tally->sum[0][i] += open * x[i];
        tally->sum[1][i] += open * y[i];
        tally->sum[2][i] += open * z[i];
    }
}

/// Lanes that the last packet of a chunk leaves out are neither traced nor counted.
static inline void leave_out(uint32_t active, alpi_rays *rays)
{
    for (int i = 0; i < ALPI_PACKET; i++) {
        rays->maximum[i] = (active >> i & 1u) != 0 ? rays->maximum[i] : -1.0f;
    }
}

/// How a batch is traced, of whose last packet only some lanes may take part.
typedef struct batch_plan {
    uint32_t count, last; // packets; the lanes of the last one
    uint32_t whole;       // those of which all lanes take part
    uint32_t paired;      // of those, the ones in pairs
} batch_plan;

/// @param each packets of a receiver: an odd number leaves one that a pair would join to the next
///             receiver's, and what a receiver gets must not depend on its neighbours
static inline batch_plan plan_batch(const alpi_occlusion_setup *setup, uint32_t count,
                                    uint32_t last, uint32_t each, uint32_t receivers)
{
    const uint32_t whole = last == (1u << ALPI_PACKET) - 1u ? count : count - 1;
    batch_plan plan = {.count = count, .last = last, .whole = whole};
    if (setup->spread == ALPI_RAYS_NEAR && (each % 2 == 0 || receivers == 1) &&
        alpi_tracer_takes_pairs(setup->tracer)) {
        plan.paired = whole / 2 * 2;
    }
    return plan;
}

static inline void trace_batch(const alpi_occlusion_setup *setup, const batch_plan *plan,
                               alpi_occlusion_stand *stand)
{
    const uint32_t all = (1u << ALPI_PACKET) - 1u, whole = plan->whole, paired = plan->paired;
    if (paired > 0) {
        alpi_trace_occluded_pairs(setup->tracer, stand->pairs, paired / 2, setup->filter);
    }
    if (paired < whole) {
        alpi_trace_occluded(setup->tracer, stand->rays + paired, whole - paired, all, setup->filter,
                            setup->spread);
    }
    if (whole < plan->count) {
        leave_out(plan->last, &stand->rays[whole]);
        alpi_trace_occluded(setup->tracer, &stand->rays[whole], 1, plan->last, setup->filter,
                            ALPI_RAYS_NEAR);
    }
}

/// Counts what a batch met, receiver by receiver. @param first packet of the batch, of all
static inline void count_batch(const alpi_occlusion_setup *setup, alpi_occlusion_stand *stand,
                               const batch_plan *plan, uint32_t first, uint32_t packets,
                               alpi_occlusion_tally *tallies)
{
    const uint32_t made = plan->count;
    for (uint32_t k = 0; k < made;) {
        alpi_occlusion_tally *tally = &tallies[(first + k) / packets];
        const uint32_t left = packets - (first + k) % packets; // of the receiver's
        const uint32_t end = k + left < made ? k + left : made;
        count_open(stand, k, end, plan->paired, tally);
        for (; k < end && setup->bent; k++) {
            const alpi_ray_lanes lanes = lanes_of(stand, k, plan->paired);
            bend(&lanes, tally);
        }
        k = end;
    }
}

/// Makes packets that leave from one group of points. @param first of them, in the batch
static inline void make_packets(const alpi_occlusion_setup *setup,
                                const alpi_sample_packet *packets, uint32_t packet_count,
                                const alpi_occlusion_lanes *lanes, const uint32_t shift[3],
                                uint32_t first, uint32_t paired, alpi_occlusion_stand *stand)
{
    for (uint32_t k = 0; k < packet_count; k++) {
        const alpi_ray_lanes to = lanes_of(stand, first + k, paired);
        alpi_lanes_start(lanes, &to);
        alpi_lanes_aim(setup, lanes, &packets[k], shift, &to);
    }
    for (uint32_t k = 0; k < packet_count; k++) {
        alpi_falloff_ranges(setup->falloff, setup->distance, packets[k].w, shift[2],
                            lanes_of(stand, first + k, paired).maximum);
    }
}

/// A batch of packets is made before the first of it is traced: one packet after the other would
/// wait for its own divisions and roots.
void ALPI_VARIANT(alpi_occlusion_kernel)(const alpi_occlusion_setup *setup,
                                         const alpi_sample_run *run, const alpi_sample_chunk *chunk,
                                         alpi_occlusion_stand *stand, alpi_occlusion_tally *tallies)
{
    const alpi_sample_packet *packets = run->packets + chunk->first_packet;
    const uint32_t each = chunk->packet_count, all = stand->receivers * each;
    uint32_t receiver = 0, group = 0, at = 0; // of the next packet
    for (uint32_t g = 0; g < stand->receivers * chunk->groups; g++) {
        alpi_lanes_frames(&stand->groups[g]);
    }
    for (uint32_t first = 0; first < all; first += ALPI_TRACE_BATCH) {
        const uint32_t made = all - first < ALPI_TRACE_BATCH ? all - first : ALPI_TRACE_BATCH;
        const uint32_t last = first + made == all ? chunk->last : (1u << ALPI_PACKET) - 1u;
        const batch_plan plan = plan_batch(setup, made, last, each, stand->receivers);
        for (uint32_t k = 0; k < made;) {
            const uint32_t next = (group + 1) * chunk->block, end = next < each ? next : each;
            const uint32_t some = end - at < made - k ? end - at : made - k;
            make_packets(setup, packets + at, some,
                         &stand->groups[receiver * chunk->groups + group], stand->shifts[receiver],
                         k, plan.paired, stand);
            k += some;
            at += some;
            group += at == end ? 1 : 0;
            if (at == each) {
                receiver++;
                at = group = 0;
            }
        }
        trace_batch(setup, &plan, stand);
        count_batch(setup, stand, &plan, first, each, tallies);
    }
}
