// SPDX-License-Identifier: MIT
// Origins and directions of the rays of eight points, for both kernels: occlusion and obscurance
// trace the same rays.
#ifndef ALPI_TRANSPORT_OCCLUSION_AIM_H
#define ALPI_TRANSPORT_OCCLUSION_AIM_H

#include "transport/lane_loop.h"
#include "transport/occlusion/occlusion_kernel.h"

#include <math.h>

/// Where eight rays lie: in a packet, or in a half of a pair.
typedef struct alpi_ray_lanes {
    float *origin[3], *direction[3], *maximum;
} alpi_ray_lanes;

/// @param rays pointer to either   @param at the first lane
#define ALPI_RAY_LANES(rays, at)                                                                   \
    ((alpi_ray_lanes){                                                                             \
        {(rays)->origin_x + (at), (rays)->origin_y + (at), (rays)->origin_z + (at)},               \
        {(rays)->direction_x + (at), (rays)->direction_y + (at), (rays)->direction_z + (at)},      \
        (rays)->maximum + (at)})

/// A frame about each lane's normal, as vec3_frame makes it.
static inline void alpi_lanes_frames(alpi_occlusion_lanes *lanes)
{
    ALPI_EACH_LANE
    {
        const float x = lanes->normal[0][i], y = lanes->normal[1][i], z = lanes->normal[2][i];
        const float sign = z < -0.5f ? -1.0f : 1.0f;
        const float a = -1.0f / (sign + z);
        const float c = x * y * a;
        lanes->tangent[0][i] = 1.0f + sign * x * x * a;
        lanes->tangent[1][i] = sign * c;
        lanes->tangent[2][i] = -sign * x;
        lanes->bitangent[0][i] = c;
        lanes->bitangent[1][i] = sign + y * y * a;
        lanes->bitangent[2][i] = -y;
    }
}

/// Concentric map of the shifted samples to a disk of radius `scale` (see alpi_warp_disk). The
/// coordinates are odd numbers of 25 bits with sign, in units of 2^-24: exact, and never 0. Sine
/// and cosine of ±π/4 · ratio by polynomials of least largest error, 6e-7 and 3e-8.
/// @param radius out: of the point, with sign
static inline void alpi_lanes_disk_points(const alpi_sample_packet *samples,
                                          const uint32_t shift[3], float scale,
                                          float x[ALPI_PACKET], float y[ALPI_PACKET],
                                          float radius[ALPI_PACKET])
{
    const uint32_t turn_u = shift[0], turn_v = shift[1];
    const float unit = scale * 0x1p-24f;
    ALPI_EACH_LANE
    {
        const float a = (float)((int32_t)(samples->u[i] ^ turn_u) >> 7 | 1);
        const float b = (float)((int32_t)(samples->v[i] ^ turn_v) >> 7 | 1);
        const int wide = fabsf(a) > fabsf(b);
        const float longer = wide ? a : b, shorter = wide ? b : a;
        const float p = shorter / longer, q = p * p;
        const float r = unit * longer;
        const float sine = r * p * (0.78539423f + q * (-0.080714f + q * 0.0024271060f));
        const float cosine =
            r * (0.99999997f + q * (-0.30842425f + q * (0.015849915f + q * -0.00031888049f)));
        x[i] = wide ? cosine : sine;
        y[i] = wide ? sine : cosine;
        radius[i] = r;
    }
}

/// Directions in the lanes' frames: cosine-distributed (Malley) or uniform in the cone.
static inline void alpi_lanes_aim(const alpi_occlusion_setup *setup,
                                  const alpi_occlusion_lanes *lanes,
                                  const alpi_sample_packet *samples, const uint32_t shift[3],
                                  const alpi_ray_lanes *to)
{
    float *along_x = to->direction[0], *along_y = to->direction[1], *along_z = to->direction[2];
    _Alignas(32) float x[ALPI_PACKET], y[ALPI_PACKET], z[ALPI_PACKET];
    if (setup->options.distribution == ALP_DISTRIBUTION_UNIFORM) {
        const float h = 1.0f - setup->cone_cos; // z = 1 − h r², uniform in [cosθmax, 1]
        alpi_lanes_disk_points(samples, shift, 1.0f, x, y, z);
        ALPI_EACH_LANE
        {
            const float r2 = z[i] * z[i];
            const float scale = sqrtf(h * (2.0f - h * r2));
            x[i] *= scale;
            y[i] *= scale;
            z[i] = 1.0f - h * r2;
        }
    } else {
        alpi_lanes_disk_points(samples, shift, setup->cone_sin, x, y, z);
        ALPI_EACH_LANE
        {
            z[i] = sqrtf(1.0f - z[i] * z[i]); // |radius| < 1
        }
    }
    ALPI_EACH_LANE
    {
        along_x[i] = x[i] * lanes->tangent[0][i] + y[i] * lanes->bitangent[0][i] +
                     z[i] * lanes->normal[0][i];
        along_y[i] = x[i] * lanes->tangent[1][i] + y[i] * lanes->bitangent[1][i] +
                     z[i] * lanes->normal[1][i];
        along_z[i] = x[i] * lanes->tangent[2][i] + y[i] * lanes->bitangent[2][i] +
                     z[i] * lanes->normal[2][i];
    }
}

/// Where the rays of a packet start.
static inline void alpi_lanes_start(const alpi_occlusion_lanes *lanes, const alpi_ray_lanes *to)
{
    float *x = to->origin[0], *y = to->origin[1], *z = to->origin[2];
    ALPI_EACH_LANE
    {
        x[i] = lanes->origin[0][i];
        y[i] = lanes->origin[1][i];
        z[i] = lanes->origin[2][i];
    }
}

#endif
