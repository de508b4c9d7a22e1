// SPDX-License-Identifier: MIT
// The clear sky in many directions, included once for each instruction set: every inner loop runs
// over LANES of them, eight but for single ones, and becomes a few vector instructions (gcc
// -fopt-info-vec shows it). No fused operations in either: the same bits.
#include "scene/sky/sky_clear.h"

#include <math.h>
#include <string.h>

#ifndef ALPI_CLEAR_SKY_LANES
#define ALPI_CLEAR_SKY_LANES 8
#endif

enum { LANES = ALPI_CLEAR_SKY_LANES };

#define EACH_LANE for (int i = 0; i < LANES; i++)

/// e^x − less, to 3e-7 of e^x, for x up to 80; where x is small and less near 1, to 3e-7 of x. What
/// floats have no room for counts as e^−87. x = n ln 2 + r, with ln 2 in two parts (Cody, Waite.
/// Software Manual for the Elementary Functions. 1980), and the series of e^r − 1.
static inline float exponential(float x, float less)
{
    static const float ROUND = 12582912.0f; // 1.5 · 2²³: what is added to it becomes whole
    const float bounded = x > -87.0f ? x : -87.0f;
    const float n = (bounded * 1.44269504f + ROUND) - ROUND;
    const float r = (bounded - n * 0.693359375f) - n * -2.12194440e-4f;
    const float series =
        r * (1.0f + r * (0.5f + r * (1.0f / 6.0f +
                                     r * (1.0f / 24.0f + r * (1.0f / 120.0f + r / 720.0f)))));
    const int32_t bits = ((int32_t)n + 127) << 23;
    float power;
    memcpy(&power, &bits, sizeof power);
    return series * power + (power - less);
}

/// To 1e-7. Abramowitz, Stegun. Handbook of Mathematical Functions. 1964, 4.4.46.
static inline float arc_cosine(float cosine)
{
    const float x = fabsf(cosine);
    const float series =
        1.5707963050f +
        x * (-0.2145988016f +
             x * (0.0889789874f +
                  x * (-0.0501743046f +
                       x * (0.0308918810f +
                            x * (-0.0170881256f + x * (0.0066700901f + x * -0.0012624911f))))));
    const float angle = sqrtf(1.0f - x) * series;
    return cosine < 0.0f ? 3.14159265f - angle : angle;
}

/// Of eight directions.
typedef struct clear_lanes {
    _Alignas(32) float inverse[LANES]; // of the cosine to the zenith
    float cos_gamma[LANES], gamma[LANES];
    float value[3][LANES]; // Y, x, y
    float color[3][LANES];
} clear_lanes;

static inline void look(const alpi_clear_sky *sky, const vec3 *directions, uint32_t count,
                        clear_lanes *l)
{
    float height[LANES], dot[LANES];
    EACH_LANE
    {
        const vec3 d = directions[i < (int)count ? i : 0];
        height[i] = d.y;
        dot[i] = vec3_dot(d, sky->sun);
    }
    EACH_LANE
    {
        const float low = dot[i] > -1.0f ? dot[i] : -1.0f, cosine = low < 1.0f ? low : 1.0f;
        // At the horizon itself the term of 1/cosθ has vanished.
        l->inverse[i] = 1.0f / (height[i] > 1e-6f ? height[i] : 1e-6f);
        l->cos_gamma[i] = cosine;
        l->gamma[i] = arc_cosine(cosine);
    }
}

static inline void distribute(const alpi_clear_sky *sky, clear_lanes *l)
{
    for (int k = 0; k < 3; k++) {
        const float a = (float)sky->perez[k][0], b = (float)sky->perez[k][1];
        const float c = (float)sky->perez[k][2], d = (float)sky->perez[k][3];
        const float e = (float)sky->perez[k][4], scale = (float)sky->scale[k];
        // Of the clearest air A e^(B/cosθ) is −.97 at the zenith. What is left of 1 comes from two
        // small numbers: 1 + A near, and how far e^(B/cosθ) is from near, a guess of e^B.
        const float near = (float)(1.0 + sky->perez[k][1]);
        const float rest = (float)(1.0 + sky->perez[k][0] * (double)near);
        EACH_LANE
        {
            const float squared = l->cos_gamma[i] * l->cos_gamma[i];
            l->value[k][i] = scale * (rest + a * exponential(b * l->inverse[i], near)) *
                             (1.0f + c * exponential(d * l->gamma[i], 0.0f) + e * squared);
        }
    }
}

/// CIE XYZ to linear Rec.709 (IEC 61966-2-1).
static inline void color(clear_lanes *l)
{
    EACH_LANE
    {
        const float x = l->value[1][i], y = l->value[2][i], z = 1.0f - x - y;
        const float per_y = l->value[0][i] / y;
        const float red = (3.2406f * x - 1.5372f * y - 0.4986f * z) * per_y;
        const float green = (-0.9689f * x + 1.8758f * y + 0.0415f * z) * per_y;
        const float blue = (0.0557f * x - 0.2040f * y + 1.0570f * z) * per_y;
        l->color[0][i] = red > 0.0f ? red : 0.0f;
        l->color[1][i] = green > 0.0f ? green : 0.0f;
        l->color[2][i] = blue > 0.0f ? blue : 0.0f;
    }
}

void ALPI_VARIANT(alpi_clear_sky_radiances)(const alpi_clear_sky *sky, const vec3 *directions,
                                            uint32_t count, vec3 *radiances)
{
    for (uint32_t first = 0; first < count; first += LANES) {
        const uint32_t left = count - first, some = left < LANES ? left : LANES;
        clear_lanes l;
        look(sky, directions + first, some, &l);
        distribute(sky, &l);
        color(&l);
        for (uint32_t i = 0; i < some; i++) {
            radiances[first + i] = (vec3){l.color[0][i], l.color[1][i], l.color[2][i]};
        }
    }
}
