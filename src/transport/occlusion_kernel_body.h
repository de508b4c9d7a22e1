// SPDX-License-Identifier: MIT
// Body of alpi_occlusion_kernel, included once for each instruction set. Every inner loop runs over
// the eight lanes and becomes a few vector instructions (gcc -fopt-info-vec shows it).
//
// Fall-off without distances: the expectation of w(t) over hits is the chance that a ray of random
// length R reaches its hit, where R has the survival function w: P(R > t) = w(t). So every ray is
// only asked whether it is blocked, which for diverging rays costs half to a quarter of asking
// where, and short rays cost less still.
#include "transport/occlusion_aim.h"

/// t with 3t² − 2t³ = u, the inverse of smoothstep, to 9e-7: symmetric about ½, and analytic in √u
/// below. (Coefficients: Chebyshev fit of ½ − sin(asin(1 − 2u) / 3) over √u.)
static inline float inverse_smoothstep(float u)
{
    float s = sqrtf(u < 0.5f ? u : 1.0f - u);
    float t =
        s * (0.5773496f +
             s * (0.11123088f +
                  s * (0.05011027f +
                       s * (0.0678495f +
                            s * (-0.15111879f +
                                 s * (0.46672475f + s * (-0.57647908f + s * 0.33255363f)))))));
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

static inline void count_open(const alpi_rays *rays, bool bent, alpi_occlusion_tally *tally)
{
    ALPI_EACH_LANE
    {
        tally->open[i] += rays->maximum[i] >= 0.0f ? 1u : 0u;
    }
    if (bent) {
        ALPI_EACH_LANE
        {
            float open = rays->maximum[i] >= 0.0f ? 1.0f : 0.0f;
            tally->sum[0][i] += open * rays->direction_x[i];
            tally->sum[1][i] += open * rays->direction_y[i];
            tally->sum[2][i] += open * rays->direction_z[i];
        }
    }
}

void ALPI_KERNEL(const alpi_occlusion_setup *setup, const alpi_occlusion_lanes *lanes,
                 const uint32_t (*samples)[3], uint32_t count, alpi_occlusion_tally *tally)
{
    alpi_rays rays;
    alpi_lanes_start(lanes, &rays);
    for (uint32_t s = 0; s < count; s++) {
        alpi_lanes_aim(setup, lanes, samples[s], &rays);
        limit(setup, lanes, samples[s], &rays);
        alpi_trace_occluded(setup->tracer, &rays, lanes->active, setup->filter);
        count_open(&rays, setup->bent, tally);
    }
}
