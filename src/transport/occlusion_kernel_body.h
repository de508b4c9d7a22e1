// SPDX-License-Identifier: MIT
// Body of alpi_occlusion_kernel, included once for each instruction set. Every inner loop runs over
// the eight lanes and becomes a few vector instructions (gcc -fopt-info-vec shows it).
//
// Fall-off without distances: the expectation of w(t) over hits is the chance that a ray of random
// length R reaches its hit, where R has the survival function w: P(R > t) = w(t). So every ray is
// only asked whether it is blocked, which for diverging rays costs half to a quarter of asking
// where, and short rays cost less still.
#include "transport/occlusion_kernel.h"

#include <math.h>

// Unrolled by 8 first, a loop of 8 would no longer be seen as one.
#ifdef __clang__
#define EACH_LANE                                                                                  \
    _Pragma("clang loop vectorize(assume_safety) unroll(disable)") for (int i = 0;                 \
                                                                        i < ALPI_PACKET; i++)
#else
#define EACH_LANE _Pragma("GCC ivdep") _Pragma("GCC unroll 1") for (int i = 0; i < ALPI_PACKET; i++)
#endif

static inline float to_unit(uint32_t bits)
{
    return (float)(int32_t)(bits >> 8) * 0x1p-24f; // 24 bits: exact, and below 1
}

/// Concentric map of the shifted sample to the unit disk (see alpi_warp_disk), with polynomials for
/// sine and cosine on [−π/4, π/4], right to 4e-7.
static inline void disk_points(const alpi_occlusion_lanes *lanes, const uint32_t sample[3],
                               float x[ALPI_PACKET], float y[ALPI_PACKET])
{
    const uint32_t u = sample[0], v = sample[1];
    EACH_LANE
    {
        float a = 2.0f * to_unit(u ^ lanes->shift[0][i]) - 1.0f;
        float b = 2.0f * to_unit(v ^ lanes->shift[1][i]) - 1.0f;
        int wide = fabsf(a) > fabsf(b);
        float radius = wide ? a : b;
        float across = wide ? b : a;
        float safe = radius != 0.0f ? radius : 1.0f;
        float p = (float)(ALPI_PI / 4.0) * (across / safe), q = p * p;
        float sine = p * (1.0f + q * (-1.0f / 6.0f + q * (1.0f / 120.0f + q * (-1.0f / 5040.0f))));
        float cosine =
            1.0f + q * (-0.5f + q * (1.0f / 24.0f + q * (-1.0f / 720.0f + q * (1.0f / 40320.0f))));
        x[i] = radius * (wide ? cosine : sine);
        y[i] = radius * (wide ? sine : cosine);
    }
}

/// Directions in the lanes' frames: cosine-distributed (Malley) or uniform in the cone.
static inline void aim(const alpi_occlusion_setup *setup, const alpi_occlusion_lanes *lanes,
                       const uint32_t sample[3], alpi_rays *rays)
{
    _Alignas(32) float x[ALPI_PACKET], y[ALPI_PACKET], z[ALPI_PACKET];
    disk_points(lanes, sample, x, y);
    if (setup->options.distribution == ALP_DISTRIBUTION_UNIFORM) {
        const float h = 1.0f - setup->cone_cos; // z = 1 − h r², uniform in [cosθmax, 1]
        EACH_LANE
        {
            float r2 = x[i] * x[i] + y[i] * y[i];
            float scale = sqrtf(fmaxf(h * (2.0f - h * r2), 0.0f));
            x[i] *= scale;
            y[i] *= scale;
            z[i] = 1.0f - h * r2;
        }
    } else {
        const float scale = setup->cone_sin;
        EACH_LANE
        {
            x[i] *= scale;
            y[i] *= scale;
            float z2 = 1.0f - x[i] * x[i] - y[i] * y[i];
            z[i] = sqrtf(z2 > 0.0f ? z2 : 0.0f);
        }
    }
    EACH_LANE
    {
        rays->direction_x[i] = x[i] * lanes->tangent[0][i] + y[i] * lanes->bitangent[0][i] +
                               z[i] * lanes->normal[0][i];
        rays->direction_y[i] = x[i] * lanes->tangent[1][i] + y[i] * lanes->bitangent[1][i] +
                               z[i] * lanes->normal[1][i];
        rays->direction_z[i] = x[i] * lanes->tangent[2][i] + y[i] * lanes->bitangent[2][i] +
                               z[i] * lanes->normal[2][i];
    }
}

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
        EACH_LANE
        {
            rays->maximum[i] = far * to_unit(u ^ lanes->shift[2][i]);
        }
        break;
    case ALP_FALLOFF_SMOOTH: // w = (1 − t)² (1 + 2t) = 1 − smoothstep(t)
        EACH_LANE
        {
            rays->maximum[i] = far * inverse_smoothstep(to_unit(u ^ lanes->shift[2][i]));
        }
        break;
    case ALP_FALLOFF_EXP: // w = (e^(−4t) − e^(−4)) / (1 − e^(−4))
        EACH_LANE
        {
            const float end = 0.018315638889f; // e^−4
            float open = 1.0f - to_unit(u ^ lanes->shift[2][i]);
            rays->maximum[i] = far * (-0.25f * logf(end + open * (1.0f - end)));
        }
        break;
    case ALP_FALLOFF_NONE:
    default:
        EACH_LANE
        {
            rays->maximum[i] = far;
        }
        break;
    }
}

static inline void count_open(const alpi_rays *rays, bool bent, alpi_occlusion_tally *tally)
{
    EACH_LANE
    {
        tally->open[i] += rays->maximum[i] >= 0.0f ? 1u : 0u;
    }
    if (bent) {
        EACH_LANE
        {
            float open = rays->maximum[i] >= 0.0f ? 1.0f : 0.0f;
            tally->bent[0][i] += open * rays->direction_x[i];
            tally->bent[1][i] += open * rays->direction_y[i];
            tally->bent[2][i] += open * rays->direction_z[i];
        }
    }
}

void ALPI_KERNEL(const alpi_occlusion_setup *setup, const alpi_occlusion_lanes *lanes,
                 const uint32_t (*samples)[3], uint32_t count, alpi_occlusion_tally *tally)
{
    alpi_rays rays;
    EACH_LANE
    {
        rays.origin_x[i] = lanes->origin[0][i];
        rays.origin_y[i] = lanes->origin[1][i];
        rays.origin_z[i] = lanes->origin[2][i];
        rays.minimum[i] = 0.0f;
        rays.time[i] = 0.0f;
        rays.id[i] = rays.flags[i] = 0;
    }
    for (uint32_t s = 0; s < count; s++) {
        aim(setup, lanes, samples[s], &rays);
        limit(setup, lanes, samples[s], &rays);
        alpi_trace_occluded(setup->tracer, &rays, lanes->active, setup->filter);
        count_open(&rays, setup->bent, tally);
    }
}
