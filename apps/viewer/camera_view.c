// SPDX-License-Identifier: MIT
#include "camera_view.h"

#include "shaders/bindings.h"

#include <epoxy/gl.h>

#include <math.h>

/// Rays have no near plane. This one is nearer than any surface that is seen; the depth of near /
/// distance loses nothing by it.
static const double NEAR_SHARE = 1e-5; // of the scene's diagonal

static void set_cross(const double a[3], const double b[3], double c[3])
{
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        c[k] = a[i] * b[j] - a[j] * b[i];
    }
}

static void normalize(double v[3])
{
    const double length = hypot(hypot(v[0], v[1]), v[2]);
    for (int k = 0; k < 3; k++) {
        v[k] /= length;
    }
}

double scene_diagonal(const alp_scene_info *info)
{
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        sum = hypot(sum, (double)info->bounds_max[k] - (double)info->bounds_min[k]);
    }
    return sum;
}

camera_view camera_view_of(const alp_camera *c, uint32_t width, uint32_t height,
                           const alp_scene_info *info)
{
    camera_view view = {.width = width, .height = height};
    double forward[3], right[3], up[3], given[3];
    for (int k = 0; k < 3; k++) {
        forward[k] = (double)c->target[k] - (double)c->position[k];
        given[k] = (double)c->up[k];
    }
    normalize(forward);
    set_cross(forward, given, right);
    normalize(right);
    set_cross(right, forward, up);
    const double half = tan(0.5 * (double)c->vertical_fov), aspect = (double)width / height;
    for (int k = 0; k < 3; k++) {
        view.origin[k] = c->position[k];
        view.forward[k] = (float)forward[k];
        view.right[k] = (float)(right[k] * half * aspect);
        view.up[k] = (float)(up[k] * half);
    }
    view.near_plane = (float)fmax(NEAR_SHARE * scene_diagonal(info), 1e-30);
    return view;
}

void camera_view_bind(const camera_view *view)
{
    glUniform3fv(UNIFORM_ORIGIN, 1, view->origin);
    glUniform3fv(UNIFORM_FORWARD, 1, view->forward);
    glUniform3fv(UNIFORM_RIGHT, 1, view->right);
    glUniform3fv(UNIFORM_UP, 1, view->up);
    glUniform1f(UNIFORM_NEAR, view->parallel ? 1.0f / view->far_plane : view->near_plane);
    glUniform1i(UNIFORM_PARALLEL, view->parallel);
    glUniform2f(UNIFORM_SIZE, (float)view->width, (float)view->height);
}
