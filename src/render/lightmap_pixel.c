// SPDX-License-Identifier: MIT
#include "render/lightmap_pixel.h"

/// What lies behind the surfaces: sky and sun disks, as far as panes and air let it through.
/// @return share of the ray's view that something fills
static float add_background(const alpi_gather_scene *from, vec3 direction, vec3 open,
                            vec3 *radiance)
{
    const vec3 behind = alpi_lighting_escaped(from->lighting, direction);
    radiance->x += open.x * behind.x;
    radiance->y += open.y * behind.y;
    radiance->z += open.z * behind.z;
    const bool lit = behind.x + behind.y + behind.z > 0.0f;
    return lit ? 1.0f : 1.0f - (open.x + open.y + open.z) / 3.0f;
}

void alpi_lightmap_pixel(const alpi_shown *shown, const alpi_view *view, uint32_t samples,
                         uint32_t key, uint32_t index, float pixel[4])
{
    const alpi_gather_scene *from = &shown->surfaces;
    const bool misty = shown->air.scattering > 0.0f;
    double sum[3] = {0.0, 0.0, 0.0}, covered = 0.0;
    alpi_rays rays;
    alpi_rays_clear(&rays);
    for (uint32_t first = 0; first < samples; first += ALPI_PACKET) {
        const uint32_t rest = samples - first, lanes = rest < ALPI_PACKET ? rest : ALPI_PACKET;
        vec3 radiance[ALPI_PACKET], open[ALPI_PACKET], scattered[ALPI_PACKET];
        view->loops->packet(view, index, key, first, &rays);
        if (misty) {
            alpi_air_along(&shown->air, &rays, (1u << lanes) - 1u, key, first, scattered);
        }
        alpi_gather_trace(from, &rays, (1u << lanes) - 1u, true, radiance, open);
        for (uint32_t i = 0; i < lanes; i++) { // panes move origins and no directions
            const vec3 direction = {rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]};
            covered += (double)add_background(from, direction, open[i], &radiance[i]);
            if (misty) {
                radiance[i] = vec3_add(radiance[i], scattered[i]);
            }
            sum[0] += (double)radiance[i].x;
            sum[1] += (double)radiance[i].y;
            sum[2] += (double)radiance[i].z;
        }
    }
    const double share = alpi_lighting_sky(from->lighting) != NULL ? (double)samples : covered;
    for (int k = 0; k < 3; k++) {
        pixel[k] = share > 0.0 ? (float)(sum[k] / share) : 0.0f;
    }
    pixel[3] = (float)(share / (double)samples);
}
