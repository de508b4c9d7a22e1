// SPDX-License-Identifier: MIT
// The loops over camera rays, included once for each instruction set. Every loop becomes a few
// vector instructions (gcc -fopt-info-vec shows it). No fused operations in either: the same bits.
#include "render/camera_rays.h"

#include "base/random.h"

#ifdef __clang__ // finds them by itself
#define EACH_RAY(count) for (uint32_t i = 0; i < (count); i++)
#else
#define EACH_RAY(count)                                                                            \
    _Pragma("GCC ivdep") _Pragma("GCC unroll 1") for (uint32_t i = 0; i < (count); i++)
#endif

/// The plane at distance 1 as a function of x and y in pixels: corner + x · across − y · down.
typedef struct picture_plane {
    vec3 corner, across, down;
} picture_plane;

static inline picture_plane plane_of(const alpi_view *view)
{
    return (picture_plane){vec3_add(vec3_sub(view->forward, view->right), view->up),
                           vec3_scale(view->right, 2.0f / (float)view->width),
                           vec3_scale(view->up, 2.0f / (float)view->height)};
}

static inline vec3 through(const picture_plane *p, float x, float y)
{
    const vec3 d = {p->corner.x + x * p->across.x - y * p->down.x,
                    p->corner.y + x * p->across.y - y * p->down.y,
                    p->corner.z + x * p->across.z - y * p->down.z};
    const float scale = 1.0f / sqrtf(d.x * d.x + d.y * d.y + d.z * d.z);
    return (vec3){d.x * scale, d.y * scale, d.z * scale};
}

static void packet(const alpi_view *view, uint32_t pixel, uint32_t key, uint32_t first,
                   alpi_rays *rays)
{
    const picture_plane plane = plane_of(view);
    const uint32_t row = pixel / view->width, column = pixel - row * view->width;
    EACH_RAY(ALPI_PACKET)
    {
        const vec2 u = alpi_sample_2d(key, first + i);
        const float x = view->centred ? 0.5f : u.x, y = view->centred ? 0.5f : u.y;
        const vec3 d = through(&plane, (float)column + x, (float)row + y);
        rays->origin_x[i] = view->origin.x;
        rays->origin_y[i] = view->origin.y;
        rays->origin_z[i] = view->origin.z;
        rays->direction_x[i] = d.x;
        rays->direction_y[i] = d.y;
        rays->direction_z[i] = d.z;
        rays->maximum[i] = INFINITY;
    }
}

static void aim(const alpi_view *view, uint32_t count, const float *x, const float *y,
                float *const direction[3])
{
    const picture_plane plane = plane_of(view);
    float *dx = direction[0], *dy = direction[1], *dz = direction[2];
    EACH_RAY(count)
    {
        const vec3 d = through(&plane, x[i], y[i]);
        dx[i] = d.x;
        dy[i] = d.y;
        dz[i] = d.z;
    }
}

const alpi_camera_loops ALPI_VARIANT(alpi_camera_loops) = {packet, aim};
