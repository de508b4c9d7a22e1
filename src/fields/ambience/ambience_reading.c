// SPDX-License-Identifier: MIT
// The public look-ups of a snapshot.
#include "fields/ambience/ambience_snapshot.h"

#include <math.h>
#include <string.h>

bool alpi_ambience_read(const alp_ambience_snapshot *snapshot, const double position[3],
                        float light[ALPI_AMBIENCE_FLOATS])
{
    return snapshot->read(snapshot, position, light);
}

void alp_ambience_coefficients(const alp_ambience_snapshot *snapshot, const double position[3],
                               alp_sh9 *radiance)
{
    if (snapshot == NULL || radiance == NULL) {
        return;
    }
    float light[ALPI_AMBIENCE_FLOATS];
    alpi_ambience_read(snapshot, position, light);
    memcpy(radiance->c, light, sizeof light);
}

void alp_ambience_irradiance(const alp_ambience_snapshot *snapshot, uint32_t count,
                             const double (*positions)[3], const float (*normals)[3],
                             float (*irradiance)[3])
{
    for (uint32_t i = 0; snapshot != NULL && i < count; i++) {
        alpi_sh9 radiance;
        const vec3 normal = vec3_load(normals[i]);
        alp_ambience_coefficients(snapshot, positions[i], &radiance);
        const vec3 e = vec3_is_finite(normal) ? alpi_sh9_irradiance(&radiance, normal)
                                              : (vec3){0.0f, 0.0f, 0.0f};
        irradiance[i][0] = fmaxf(e.x, 0.0f);
        irradiance[i][1] = fmaxf(e.y, 0.0f);
        irradiance[i][2] = fmaxf(e.z, 0.0f);
    }
}
