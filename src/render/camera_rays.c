// SPDX-License-Identifier: MIT
#include "render/camera_rays.h"

#include <math.h>

alp_result alpi_view_place(alp_context *context, const alp_camera *c, uint32_t width,
                           uint32_t height, alpi_view *view)
{
    const vec3 none = {0.0f, 0.0f, 0.0f}, origin = vec3_load(c->position);
    const vec3 forward = vec3_normalize_or(vec3_sub(vec3_load(c->target), origin), none);
    const vec3 right = vec3_normalize_or(vec3_cross(forward, vec3_load(c->up)), none);
    const bool fov_is_valid = c->vertical_fov > 0.0f && c->vertical_fov < (float)ALPI_PI;
    if (!vec3_is_finite(origin) || vec3_length(right) == 0.0f || !fov_is_valid) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "camera: its position must be finite and differ from the target, the view "
                         "not along up, the field of view inside (0, pi)");
    }
    const float half = tanf(0.5f * c->vertical_fov), aspect = (float)width / (float)height;
    *view = (alpi_view){.origin = origin,
                        .forward = forward,
                        .right = vec3_scale(right, half * aspect),
                        .up = vec3_scale(vec3_cross(right, forward), half),
                        .width = width,
                        .height = height,
                        .loops = &ALPI_COMPILED_FOR(context, alpi_camera_loops)};
    return ALP_OK;
}

void alpi_view_rays(const void *user, uint32_t count, const uint64_t *pixels, const float *u,
                    const float *v, const alpi_camera_rays *rays)
{
    enum { CHUNK = 64 };
    const alpi_view *view = user;
    for (uint32_t first = 0; first < count; first += CHUNK) {
        const uint32_t some = count - first < CHUNK ? count - first : CHUNK;
        float x[CHUNK], y[CHUNK];
        for (uint32_t i = 0; i < some; i++) {
            const uint32_t pixel = (uint32_t)pixels[first + i], row = pixel / view->width;
            x[i] = (float)(pixel - row * view->width) + u[first + i];
            y[i] = (float)row + v[first + i];
            rays->start[0][first + i] = view->origin.x;
            rays->start[1][first + i] = view->origin.y;
            rays->start[2][first + i] = view->origin.z;
        }
        view->loops->aim(view, some, x, y,
                         (float *const[3]){rays->direction[0] + first, rays->direction[1] + first,
                                           rays->direction[2] + first});
    }
}
