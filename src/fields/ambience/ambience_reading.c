// SPDX-License-Identifier: MIT
// The public look-ups of a snapshot. Nine coefficients may give an E below 0: it reads as 0.
#include "fields/ambience/ambience_snapshot.h"

#include <string.h>

bool alpi_ambience_read(const alp_ambience_snapshot *snapshot, const double position[3],
                        const float *normal, float light[ALPI_AMBIENCE_FLOATS])
{
    return snapshot->read(snapshot, position, normal, light);
}

vec3 alpi_ambience_irradiance_at(const alp_ambience_snapshot *snapshot, const double position[3],
                                 vec3 normal)
{
    const float n[3] = {normal.x, normal.y, normal.z};
    float light[ALPI_AMBIENCE_FLOATS];
    alpi_sh9 radiance;
    if (!vec3_is_finite(normal) || !alpi_ambience_read(snapshot, position, n, light)) {
        return (vec3){0.0f, 0.0f, 0.0f};
    }
    memcpy(radiance.c, light, sizeof light);
    return alpi_sh9_irradiance(&radiance, normal);
}

void alp_ambience_coefficients(const alp_ambience_snapshot *snapshot, const double position[3],
                               alp_sh9 *radiance)
{
    float light[ALPI_AMBIENCE_FLOATS];
    if (snapshot == NULL || radiance == NULL) {
        return;
    }
    alpi_ambience_read(snapshot, position, NULL, light);
    memcpy(radiance->c, light, sizeof light);
}

void alp_ambience_irradiance(const alp_ambience_snapshot *snapshot, uint32_t count,
                             const double (*positions)[3], const float (*normals)[3],
                             float (*irradiance)[3])
{
    for (uint32_t i = 0; snapshot != NULL && i < count; i++) {
        const vec3 e = alpi_ambience_irradiance_at(snapshot, positions[i], vec3_load(normals[i]));
        vec3_store(irradiance[i], vec3_max(e, (vec3){0.0f, 0.0f, 0.0f}));
    }
}
