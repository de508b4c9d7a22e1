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

/// A frame about each lane's normal, as vec3_frame makes it.
typedef struct lane_frames {
    _Alignas(32) float tangent[3][ALPI_PACKET];
    float bitangent[3][ALPI_PACKET];
} lane_frames;

static inline void find_frames(const alpi_occlusion_lanes *lanes, lane_frames *frames)
{
    EACH_LANE
    {
        const float x = lanes->normal[0][i], y = lanes->normal[1][i], z = lanes->normal[2][i];
        const float sign = z < -0.5f ? -1.0f : 1.0f;
        const float a = -1.0f / (sign + z);
        const float c = x * y * a;
        frames->tangent[0][i] = 1.0f + sign * x * x * a;
        frames->tangent[1][i] = sign * c;
        frames->tangent[2][i] = -sign * x;
        frames->bitangent[0][i] = c;
        frames->bitangent[1][i] = sign + y * y * a;
        frames->bitangent[2][i] = -y;
    }
}

/// Whether the lanes look in different directions: then so do their rays. Measured on eight scenes:
/// below a cosine of .8 a stream is 1.02 to 1.4 times as fast as packets, above it .6 to 1.3 times.
static inline bool is_scattered(const alpi_occlusion_lanes *lanes)
{
    _Alignas(32) float cosine[ALPI_PACKET];
    const float x = lanes->normal[0][0], y = lanes->normal[1][0], z = lanes->normal[2][0];
    EACH_LANE
    {
        cosine[i] = x * lanes->normal[0][i] + y * lanes->normal[1][i] + z * lanes->normal[2][i];
    }
    float least = 1.0f;
    for (int i = 0; i < ALPI_PACKET; i++) {
        least = cosine[i] < least ? cosine[i] : least;
    }
    return least < 0.8f;
}

/// Concentric map of the shifted sample to a disk of radius `scale` (see alpi_warp_disk). The
/// coordinates are odd numbers of 25 bits with sign, in units of 2^-24: exact, and never 0. Sine
/// and cosine of ±π/4 · ratio by polynomials of least largest error, 6e-7 and 3e-8.
/// @param radius out: of the point, with sign
static inline void disk_points(const alpi_occlusion_lanes *lanes, const uint32_t sample[3],
                               float scale, float x[ALPI_PACKET], float y[ALPI_PACKET],
                               float radius[ALPI_PACKET])
{
    const uint32_t u = sample[0], v = sample[1];
    const float unit = scale * 0x1p-24f;
    EACH_LANE
    {
        const float a = (float)((int32_t)(u ^ lanes->shift[0][i]) >> 7 | 1);
        const float b = (float)((int32_t)(v ^ lanes->shift[1][i]) >> 7 | 1);
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
static inline void aim(const alpi_occlusion_setup *setup, const alpi_occlusion_lanes *lanes,
                       const lane_frames *frames, const uint32_t sample[3], alpi_rays *rays)
{
    _Alignas(32) float x[ALPI_PACKET], y[ALPI_PACKET], z[ALPI_PACKET];
    if (setup->options.distribution == ALP_DISTRIBUTION_UNIFORM) {
        const float h = 1.0f - setup->cone_cos; // z = 1 − h r², uniform in [cosθmax, 1]
        disk_points(lanes, sample, 1.0f, x, y, z);
        EACH_LANE
        {
            const float r2 = z[i] * z[i];
            const float scale = sqrtf(h * (2.0f - h * r2));
            x[i] *= scale;
            y[i] *= scale;
            z[i] = 1.0f - h * r2;
        }
    } else {
        disk_points(lanes, sample, setup->cone_sin, x, y, z);
        EACH_LANE
        {
            z[i] = sqrtf(1.0f - z[i] * z[i]); // |radius| < 1
        }
    }
    EACH_LANE
    {
        rays->direction_x[i] = x[i] * frames->tangent[0][i] + y[i] * frames->bitangent[0][i] +
                               z[i] * lanes->normal[0][i];
        rays->direction_y[i] = x[i] * frames->tangent[1][i] + y[i] * frames->bitangent[1][i] +
                               z[i] * lanes->normal[1][i];
        rays->direction_z[i] = x[i] * frames->tangent[2][i] + y[i] * frames->bitangent[2][i] +
                               z[i] * lanes->normal[2][i];
    }
}

/// t with 3t² − 2t³ = u, the inverse of smoothstep, to 5e-6: symmetric about ½, and analytic in √u
/// below (a polynomial of least largest error for ½ − sin(asin(1 − 2u) / 3) over √u).
static inline float inverse_smoothstep(float u)
{
    const float s = sqrtf(u < 0.5f ? u : 1.0f - u);
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

/// Adds up four packets at a time: the sums go through memory.
static inline void count_open(const alpi_rays *rays, uint32_t count, alpi_occlusion_tally *tally)
{
    uint32_t k = 0;
    for (; k + 4 <= count; k += 4) {
        const alpi_rays *r = rays + k;
        EACH_LANE
        {
            const uint32_t open =
                (r[0].maximum[i] >= 0.0f ? 1u : 0u) + (r[1].maximum[i] >= 0.0f ? 1u : 0u) +
                (r[2].maximum[i] >= 0.0f ? 1u : 0u) + (r[3].maximum[i] >= 0.0f ? 1u : 0u);
            tally->open[i] += open;
        }
    }
    for (; k < count; k++) {
        EACH_LANE
        {
            tally->open[i] += rays[k].maximum[i] >= 0.0f ? 1u : 0u;
        }
    }
}

static inline void bend(const alpi_rays *rays, alpi_occlusion_tally *tally)
{
    EACH_LANE
    {
        float open = rays->maximum[i] >= 0.0f ? 1.0f : 0.0f;
        tally->bent[0][i] += open * rays->direction_x[i];
        tally->bent[1][i] += open * rays->direction_y[i];
        tally->bent[2][i] += open * rays->direction_z[i];
    }
}

static inline void start_rays(const alpi_occlusion_lanes *lanes, alpi_rays *rays)
{
    EACH_LANE
    {
        rays->origin_x[i] = lanes->origin[0][i];
        rays->origin_y[i] = lanes->origin[1][i];
        rays->origin_z[i] = lanes->origin[2][i];
    }
}

/// A batch of packets is made before the first of it is traced: one packet after the other would
/// wait for its own divisions and roots.
void ALPI_KERNEL(const alpi_occlusion_setup *setup, alpi_occlusion_lanes *lanes,
                 const uint32_t (*samples)[3], uint32_t count, alpi_occlusion_tally *tally)
{
    alpi_rays *rays = lanes->rays;
    lane_frames frames;
    find_frames(lanes, &frames);
    const bool scattered = is_scattered(lanes);
    for (uint32_t k = 0; k < count && k < ALPI_TRACE_BATCH; k++) {
        start_rays(lanes, &rays[k]);
    }
    for (uint32_t s = 0; s < count; s += ALPI_TRACE_BATCH) {
        const uint32_t batch = count - s < ALPI_TRACE_BATCH ? count - s : ALPI_TRACE_BATCH;
        for (uint32_t k = 0; k < batch; k++) {
            aim(setup, lanes, &frames, samples[s + k], &rays[k]);
        }
        for (uint32_t k = 0; k < batch; k++) {
            limit(setup, lanes, samples[s + k], &rays[k]);
        }
        alpi_trace_occluded(setup->tracer, rays, batch, lanes->active, setup->filter, scattered);
        count_open(rays, batch, tally);
        for (uint32_t k = 0; k < batch && setup->bent; k++) {
            bend(&rays[k], tally);
        }
    }
}
