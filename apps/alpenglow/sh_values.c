// SPDX-License-Identifier: MIT
#include "sh_values.h"

#include <math.h>
#include <stdio.h>

alp_result sh_values_print(const alp_sh9 *radiance, alp_sh_convention convention)
{
    float values[9][3];
    const alp_result result = alp_sh_convert(radiance, convention, values);
    const uint32_t count = result == ALP_OK ? 3 * alp_sh_row_count(convention) : 0;
    float largest = 0.0f;
    for (uint32_t i = 0; i < count; i++) {
        largest = fmaxf(largest, fabsf(values[i / 3][i % 3]));
    }
    for (uint32_t i = 0; i < count; i++) {
        const float value = values[i / 3][i % 3];
        printf("%.7g%c", fabsf(value) > 1e-7f * largest ? (double)value : 0.0,
               i % 3 == 2 ? '\n' : ' ');
    }
    return result;
}
