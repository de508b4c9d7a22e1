// SPDX-License-Identifier: MIT
// Body of alpi_occlusion_kernel, included once for each instruction set. Every inner loop runs over
// the eight lanes and becomes a few vector instructions (gcc -fopt-info-vec shows it).
//
// Fall-off without distances: the expectation of w(t) over hits is the chance that a ray of random
// length R reaches its hit, where R has the survival function w: P(R > t) = w(t). So every ray is
// only asked whether it is blocked, which for diverging rays costs half to a quarter of asking
// where, and short rays cost less still.
#include "transport/occlusion_aim.h"

/// How far the lanes' axes part: so do their rays.
static inline float least_cosine(const alpi_occlusion_lanes *lanes)
{
    _Alignas(32) float cosine[ALPI_PACKET];
    const float x = lanes->normal[0][0], y = lanes->normal[1][0], z = lanes->normal[2][0];
    ALPI_EACH_LANE
    {
        cosine[i] = x * lanes->normal[0][i] + y * lanes->normal[1][i] + z * lanes->normal[2][i];
    }
    float least = 1.0f;
    for (int i = 0; i < ALPI_PACKET; i++) {
        least = cosine[i] < least ? cosine[i] : least;
    }
    return least;
}

/// Measured on eight scenes: below a cosine of .8 a stream is 1.02 to 1.4 times as fast as packets,
/// above it .6 to 1.3 times. On five, above .99 a beam is 1.01 to 1.2 times as fast; used for all
/// packets, .85 to 1.1 times.
static inline alpi_rays_spread spread_of(const alpi_occlusion_setup *setup, float cosine)
{
    return setup->streams || cosine < 0.8f  ? ALPI_RAYS_SCATTERED
           : setup->beams && cosine > 0.99f ? ALPI_RAYS_PARALLEL
                                            : ALPI_RAYS_NEAR;
}

/// t with 3t² − 2t³ = u, the inverse of smoothstep, to 5e-6: symmetric about ½, and analytic in √u
/// below (a polynomial of least largest error for ½ − sin(asin(1 − 2u) / 3) over √u).
static inline float inverse_smoothstep(float u)
{
    const float rest = 1.0f - u;                // exact
    const float s = sqrtf(u < rest ? u : rest); // a minimum: else gcc does both ends of the curve
    const float t =
        s * (0.57698999f +
             s * (0.11991628f +
                  s * (-0.016986352f + s * (0.28287674f + s * (-0.39250040f + s * 0.29372040f)))));
    return u < 0.5f ? t : 1.0f - t;
}

/// How far the rays reach: the limit, or a random length below it.
static inline void limit(const alpi_occlusion_setup *setup, const alpi_occlusion_lanes *lanes,
                         const uint32_t sample[3], alpi_rays *rays)
{
    const float far = setup->distance;
    const uint32_t u = sample[2];
    switch (setup->falloff) {
    case ALP_FALLOFF_LINEAR: // w = 1 − t
        ALPI_EACH_LANE
        {
            rays->maximum[i] = far * alpi_lane_unit(u ^ lanes->shift[2][i]);
        }
        break;
    case ALP_FALLOFF_SMOOTH: // w = (1 − t)² (1 + 2t) = 1 − smoothstep(t)
        ALPI_EACH_LANE
        {
            rays->maximum[i] = far * inverse_smoothstep(alpi_lane_unit(u ^ lanes->shift[2][i]));
        }
        break;
    case ALP_FALLOFF_EXP: // w = (e^(−4t) − e^(−4)) / (1 − e^(−4))
        ALPI_EACH_LANE
        {
            const float end = 0.018315638889f; // e^−4
            float open = 1.0f - alpi_lane_unit(u ^ lanes->shift[2][i]);
            rays->maximum[i] = far * (-0.25f * logf(end + open * (1.0f - end)));
        }
        break;
    case ALP_FALLOFF_NONE:
    default:
        ALPI_EACH_LANE
        {
            rays->maximum[i] = far;
        }
        break;
    }
}

/// Adds up four packets at a time: the sums go through memory.
static inline void count_open(const alpi_rays *rays, uint32_t count, alpi_occlusion_tally *tally)
{
    uint32_t k = 0;
    for (; k + 4 <= count; k += 4) {
        const alpi_rays *r = rays + k;
        ALPI_EACH_LANE
        {
            const uint32_t open =
                (r[0].maximum[i] >= 0.0f ? 1u : 0u) + (r[1].maximum[i] >= 0.0f ? 1u : 0u) +
                (r[2].maximum[i] >= 0.0f ? 1u : 0u) + (r[3].maximum[i] >= 0.0f ? 1u : 0u);
            tally->open[i] += open;
        }
    }
    for (; k < count; k++) {
        ALPI_EACH_LANE
        {
            tally->open[i] += rays[k].maximum[i] >= 0.0f ? 1u : 0u;
        }
    }
}

static inline void bend(const alpi_rays *rays, alpi_occlusion_tally *tally)
{
    ALPI_EACH_LANE
    {
        float open = rays->maximum[i] >= 0.0f ? 1.0f : 0.0f;
        tally->sum[0][i] += open * rays->direction_x[i];
        tally->sum[1][i] += open * rays->direction_y[i];
        tally->sum[2][i] += open * rays->direction_z[i];
    }
}

/// Traces what is pending and counts it.
static inline void flush(const alpi_occlusion_setup *setup, alpi_occlusion_lanes *lanes,
                         alpi_occlusion_tally *tally)
{
    if (lanes->pending == 0) {
        return;
    }
    alpi_trace_occluded(setup->tracer, lanes->rays, lanes->pending, lanes->active, setup->filter,
                        spread_of(setup, lanes->cosine));
    count_open(lanes->rays, lanes->pending, tally);
    for (uint32_t k = 0; k < lanes->pending && setup->bent; k++) {
        bend(&lanes->rays[k], tally);
    }
    lanes->pending = 0;
    lanes->cosine = 1.0f;
}

/// A batch of packets is made before the first of it is traced: one packet after the other would
/// wait for its own divisions and roots.
void ALPI_KERNEL(const alpi_occlusion_setup *setup, alpi_occlusion_lanes *lanes,
                 const uint32_t (*samples)[3], uint32_t count, alpi_occlusion_tally *tally)
{
    alpi_lane_frames frames;
    alpi_lanes_frames(lanes, &frames);
    const float cosine = least_cosine(lanes);
    for (uint32_t s = 0; s < count;) {
        alpi_rays *rays = lanes->rays + lanes->pending;
        const uint32_t room = ALPI_TRACE_BATCH - lanes->pending;
        const uint32_t made = count - s < room ? count - s : room;
        for (uint32_t k = 0; k < made; k++) {
            alpi_lanes_start(lanes, &rays[k]);
            alpi_lanes_aim(setup, lanes, &frames, samples[s + k], &rays[k]);
        }
        for (uint32_t k = 0; k < made; k++) {
            limit(setup, lanes, samples[s + k], &rays[k]);
        }
        lanes->pending += made;
        lanes->cosine = cosine < lanes->cosine ? cosine : lanes->cosine;
        s += made;
        if (lanes->pending == ALPI_TRACE_BATCH) {
            flush(setup, lanes, tally);
        }
    }
    if (count == 0) {
        flush(setup, lanes, tally);
    }
}
