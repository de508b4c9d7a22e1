// SPDX-License-Identifier: MIT
// The functions of direction that probes hold.
#include "fields/probes/probes.h"

#include <string.h>

void alpi_probe_project(const alpi_sh9 *radiance, alpi_probe_basis basis, float (*coefficients)[3])
{
    static const vec3 axes[6] = {{1.0f, 0.0f, 0.0f},  {-1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f},
                                 {0.0f, -1.0f, 0.0f}, {0.0f, 0.0f, 1.0f},  {0.0f, 0.0f, -1.0f}};
    if (basis != ALPI_PROBE_AMBIENT_CUBE) {
        memcpy(coefficients, radiance->c, alpi_probe_basis_count(basis) * sizeof *coefficients);
        return;
    }
    for (int i = 0; i < 6; i++) {
        vec3_store(coefficients[i], alpi_sh9_irradiance(radiance, axes[i]));
    }
}

void alpi_probe_weights(alpi_probe_basis basis, vec3 n, float *weights)
{
    if (basis != ALPI_PROBE_AMBIENT_CUBE) {
        alpi_sh9_irradiance_weights(n, weights);
        return;
    }
    alpi_ambient_cube_weights(n, weights);
}
