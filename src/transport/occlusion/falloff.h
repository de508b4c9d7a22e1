// SPDX-License-Identifier: MIT
// Fall-offs of occlusion: the weight w(t) of a hit at t = distance / limit. A new fall-off needs a
// constant of alp_falloff (alpenglow/occlusion.h), a case in each of the three functions here, and
// a word in the option --ao-falloff.
#ifndef ALPI_TRANSPORT_FALLOFF_H
#define ALPI_TRANSPORT_FALLOFF_H

#include "transport/lane_loop.h"

#include <alpenglow/occlusion.h>
#include <math.h>

/// The name in options and files; NULL for a number that is no fall-off.
static inline const char *alpi_falloff_name(alp_falloff falloff)
{
    switch (falloff) {
    case ALP_FALLOFF_NONE:
        return "none";
    case ALP_FALLOFF_LINEAR:
        return "linear";
    case ALP_FALLOFF_SMOOTH:
        return "smooth";
    case ALP_FALLOFF_EXP:
        return "exp";
    default:
        return NULL;
    }
}

#define ALPI_FALLOFF_EXP_END 0.018315638889f // e^−4

/// w(t), t in [0, 1]: w(0) = 1.
static inline float alpi_falloff_weight(alp_falloff falloff, float t)
{
    switch (falloff) {
    case ALP_FALLOFF_LINEAR: // w = 1 − t
        return 1.0f - t;
    case ALP_FALLOFF_SMOOTH: // w = (1 − t)² (1 + 2t) = 1 − smoothstep(t)
        return (1.0f - t) * (1.0f - t) * (1.0f + 2.0f * t);
    case ALP_FALLOFF_EXP: // w = (e^(−4t) − e^(−4)) / (1 − e^(−4))
        return (expf(-4.0f * t) - ALPI_FALLOFF_EXP_END) / (1.0f - ALPI_FALLOFF_EXP_END);
    case ALP_FALLOFF_NONE:
    default:
        return 1.0f;
    }
}

/// t with 3t² − 2t³ = u, the inverse of smoothstep, to 5e-6: symmetric about ½, and analytic in √u
/// below (a polynomial of least largest error for ½ − sin(asin(1 − 2u) / 3) over √u).
static inline float alpi_inverse_smoothstep(float u)
{
    const float rest = 1.0f - u;                // exact
    const float s = sqrtf(u < rest ? u : rest); // a minimum: else gcc does both ends of the curve
    const float t =
        s * (0.57698999f +
             s * (0.11991628f +
                  s * (-0.016986352f + s * (0.28287674f + s * (-0.39250040f + s * 0.29372040f)))));
    return u < 0.5f ? t : 1.0f - t;
}

/// Random lengths of eight rays that replace the weights. A ray whose length R has the survival
/// function P(R > t) = w(t) reaches a hit at t with probability w(t). So the share of blocked rays
/// has the mean of w, and no ray needs the distance of its hit. That takes a half to a quarter of
/// the time for diverging rays, and short rays take less still.
/// @param limit  metres, where w ends
/// @param random [ALPI_PACKET] 32-bit fractions u of the lanes, before the shift; 1 − w(R) = u
/// @param range  [ALPI_PACKET] out, metres, [0, limit]
static inline void alpi_falloff_ranges(alp_falloff falloff, float limit,
                                       const uint32_t random[ALPI_PACKET], uint32_t shift,
                                       float range[ALPI_PACKET])
{
    switch (falloff) {
    case ALP_FALLOFF_LINEAR:
        ALPI_EACH_LANE
        {
            range[i] = limit * alpi_lane_unit(random[i] ^ shift);
        }
        break;
    case ALP_FALLOFF_SMOOTH:
        ALPI_EACH_LANE
        {
            range[i] = limit * alpi_inverse_smoothstep(alpi_lane_unit(random[i] ^ shift));
        }
        break;
    case ALP_FALLOFF_EXP:
        ALPI_EACH_LANE
        {
            const float end = ALPI_FALLOFF_EXP_END;
            const float open = 1.0f - alpi_lane_unit(random[i] ^ shift);
            range[i] = limit * (-0.25f * logf(end + open * (1.0f - end)));
        }
        break;
    case ALP_FALLOFF_NONE:
    default:
        ALPI_EACH_LANE
        {
            range[i] = limit;
        }
        break;
    }
}

#endif
