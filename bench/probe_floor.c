// SPDX-License-Identifier: MIT
#include "probe_floor.h"

#include "base/random.h"

enum { SIDE = ALPI_PROBE_MOMENT_SIDE, FLOATS = 28 };

float bench_probes_read(const alpi_probe_volume *v, const float (*positions)[3], uint32_t count)
{
    const uint32_t side = v->size[0], floats = 3 * v->coefficient_count;
    float sums[FLOATS] = {0.0f}, sum = 0.0f;
    for (uint32_t i = 0; i < count; i++) {
        const float *p = positions[i];
        const uint32_t low =
            (uint32_t)(int)p[0] + side * ((uint32_t)(int)p[1] + side * (uint32_t)(int)p[2]);
        const uint32_t texel = SIDE * (i % (SIDE - 1)) + alpi_hash32(i) % (SIDE - 1);
        for (uint32_t corner = 0; corner < 8; corner++) {
            const uint32_t probe =
                low + (corner & 1) + side * ((corner >> 1 & 1) + side * (corner >> 2));
            const float *light = v->coefficients + (size_t)probe * floats;
            for (uint32_t k = 0; k < floats; k++) {
                sums[k] += light[k];
            }
            if (v->moments != NULL) {
                const float *m = v->moments[(size_t)probe * SIDE * SIDE + texel];
                for (uint32_t k = 0; k < 4; k++) {
                    sums[k] += m[k] + m[2 * SIDE + k];
                }
            }
        }
    }
    for (uint32_t k = 0; k < floats; k++) {
        sum += sums[k];
    }
    return sum;
}
