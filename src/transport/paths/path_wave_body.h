// SPDX-License-Identifier: MIT
// The loops over a wave of paths that become vector instructions, included once for each
// instruction set. No fused operations in either: the same bits.
#include "transport/paths/path_wave.h"

#include "base/random.h"

#include <math.h>

#ifdef __clang__ // finds them by itself
#define EACH_PATH(count) for (uint32_t i = 0; i < (count); i++)
#else
#define EACH_PATH(count) _Pragma("GCC ivdep") for (uint32_t i = 0; i < (count); i++)
#endif

static void draw(alpi_path_wave *w, alpi_path_use use, uint32_t ahead)
{
    EACH_PATH(w->count)
    {
        const uint32_t number = (w->event[i] + ahead) * ALPI_USE_COUNT + (uint32_t)use;
        const vec2 u =
            alpi_sample_2d(alpi_hash32(w->key[i] ^ alpi_hash32(number + 1u)), w->sample[i]);
        w->u[i] = u.x;
        w->v[i] = u.y;
    }
}

/// Concentric map to the disk, lifted to the hemisphere, in the frame of vec3_frame. Sine and
/// cosine of ±π/4 · ratio by polynomials of least largest error, 6e-7 and 3e-8.
static void aim(alpi_path_wave *w)
{
    EACH_PATH(w->count)
    {
        // Odd numbers of 25 bits: never 0, never the rim.
        const float a = 2.0f * w->u[i] - (1.0f - 0x1p-24f);
        const float b = 2.0f * w->v[i] - (1.0f - 0x1p-24f);
        const int wide = fabsf(a) > fabsf(b);
        const float longer = wide ? a : b, shorter = wide ? b : a;
        const float p = shorter / longer, q = p * p;
        const float sine = longer * p * (0.78539423f + q * (-0.080714f + q * 0.0024271060f));
        const float cosine =
            longer * (0.99999997f + q * (-0.30842425f + q * (0.015849915f + q * -0.00031888049f)));
        const float x = wide ? cosine : sine, y = wide ? sine : cosine;
        const float z = sqrtf(1.0f - longer * longer);
        const float nx = w->normal.x[i], ny = w->normal.y[i], nz = w->normal.z[i];
        const float sign = nz < -0.5f ? -1.0f : 1.0f;
        const float f = -1.0f / (sign + nz), g = nx * ny * f;
        w->direction.x[i] = x * (1.0f + sign * nx * nx * f) + y * g + z * nx;
        w->direction.y[i] = x * (sign * g) + y * (sign + ny * ny * f) + z * ny;
        w->direction.z[i] = x * (-sign * nx) - y * ny + z * nz;
        w->density[i] = z * (float)(1.0 / ALPI_PI);
        w->start.x[i] = w->origin.x[i];
        w->start.y[i] = w->origin.y[i];
        w->start.z[i] = w->origin.z[i];
    }
}

const alpi_wave_loops ALPI_VARIANT(alpi_wave_loops) = {draw, aim};
