// SPDX-License-Identifier: MIT
// Where the rays of eight points leave and in which directions: what the kernels that ask different
// things of the same rays have in common. Every loop runs over the eight lanes and becomes a few
// vector instructions (gcc -fopt-info-vec shows it).
#ifndef ALPI_TRANSPORT_OCCLUSION_AIM_H
#define ALPI_TRANSPORT_OCCLUSION_AIM_H

#include "transport/occlusion_kernel.h"

#include <math.h>

// Unrolled by 8 first, a loop of 8 would no longer be seen as one.
#ifdef __clang__
#define ALPI_EACH_LANE                                                                             \
    _Pragma("clang loop vectorize(assume_safety) unroll(disable)") for (int i = 0;                 \
                                                                        i < ALPI_PACKET; i++)
#else
#define ALPI_EACH_LANE                                                                             \
    _Pragma("GCC ivdep") _Pragma("GCC unroll 1") for (int i = 0; i < ALPI_PACKET; i++)
#endif

static inline float alpi_lane_unit(uint32_t bits)
{
    return (float)(int32_t)(bits >> 8) * 0x1p-24f; // 24 bits: exact, and below 1
}

/// Concentric map of the shifted sample to the unit disk (see alpi_warp_disk), with polynomials for
/// sine and cosine on [−π/4, π/4], right to 4e-7.
static inline void alpi_lanes_disk_points(const alpi_occlusion_lanes *lanes,
                                          const uint32_t sample[3], float x[ALPI_PACKET],
                                          float y[ALPI_PACKET])
{
    const uint32_t u = sample[0], v = sample[1];
    ALPI_EACH_LANE
    {
        float a = 2.0f * alpi_lane_unit(u ^ lanes->shift[0][i]) - 1.0f;
        float b = 2.0f * alpi_lane_unit(v ^ lanes->shift[1][i]) - 1.0f;
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
static inline void alpi_lanes_aim(const alpi_occlusion_setup *setup,
                                  const alpi_occlusion_lanes *lanes, const uint32_t sample[3],
                                  alpi_rays *rays)
{
    _Alignas(32) float x[ALPI_PACKET], y[ALPI_PACKET], z[ALPI_PACKET];
    alpi_lanes_disk_points(lanes, sample, x, y);
    if (setup->options.distribution == ALP_DISTRIBUTION_UNIFORM) {
        const float h = 1.0f - setup->cone_cos; // z = 1 − h r², uniform in [cosθmax, 1]
        ALPI_EACH_LANE
        {
            float r2 = x[i] * x[i] + y[i] * y[i];
            float scale = sqrtf(fmaxf(h * (2.0f - h * r2), 0.0f));
            x[i] *= scale;
            y[i] *= scale;
            z[i] = 1.0f - h * r2;
        }
    } else {
        const float scale = setup->cone_sin;
        ALPI_EACH_LANE
        {
            x[i] *= scale;
            y[i] *= scale;
            float z2 = 1.0f - x[i] * x[i] - y[i] * y[i];
            z[i] = sqrtf(z2 > 0.0f ? z2 : 0.0f);
        }
    }
    ALPI_EACH_LANE
    {
        rays->direction_x[i] = x[i] * lanes->tangent[0][i] + y[i] * lanes->bitangent[0][i] +
                               z[i] * lanes->normal[0][i];
        rays->direction_y[i] = x[i] * lanes->tangent[1][i] + y[i] * lanes->bitangent[1][i] +
                               z[i] * lanes->normal[1][i];
        rays->direction_z[i] = x[i] * lanes->tangent[2][i] + y[i] * lanes->bitangent[2][i] +
                               z[i] * lanes->normal[2][i];
    }
}

/// The rays of a packet, but for direction and length.
static inline void alpi_lanes_start(const alpi_occlusion_lanes *lanes, alpi_rays *rays)
{
    ALPI_EACH_LANE
    {
        rays->origin_x[i] = lanes->origin[0][i];
        rays->origin_y[i] = lanes->origin[1][i];
        rays->origin_z[i] = lanes->origin[2][i];
        rays->minimum[i] = 0.0f;
        rays->time[i] = 0.0f;
        rays->id[i] = rays->flags[i] = 0;
    }
}

#endif
