// SPDX-License-Identifier: MIT
#include "light_views.h"

#include <math.h>
#include <string.h>

enum { BORDER = 3 }; // texels

/// The near plane of a lamp. Depth of near / distance loses less by rounding where it is farther.
static const double NEAR_SHARE = 1e-4; // of the scene's diagonal

static void cross(const double a[3], const double b[3], double c[3])
{
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        c[k] = a[i] * b[j] - a[j] * b[i];
    }
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Axes to the right and up, of length 1.
static void find_frame(const double forward[3], double right[3], double up[3])
{
    double reference[3] = {0.0, 0.0, 0.0};
    int least = 0;
    for (int k = 1; k < 3; k++) {
        least = fabs(forward[k]) < fabs(forward[least]) ? k : least;
    }
    reference[least] = 1.0;
    cross(forward, reference, right);
    const double length = sqrt(dot(right, right));
    for (int k = 0; k < 3; k++) {
        right[k] /= length;
    }
    cross(right, forward, up);
}

static double diagonal_of(const alp_scene_info *info)
{
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        sum = hypot(sum, (double)info->bounds_max[k] - (double)info->bounds_min[k]);
    }
    return sum;
}

/// A length with the border of the map.
static double add_border(double length, uint32_t side)
{
    return length / (1.0 - 2.0 * BORDER / side);
}

/// Ends of the scene's bounds along an axis.
static void find_ends(const alp_scene_info *info, const double axis[3], double ends[2])
{
    ends[0] = ends[1] = 0.0;
    for (int k = 0; k < 3; k++) {
        const double a = axis[k] * (double)info->bounds_min[k];
        const double b = axis[k] * (double)info->bounds_max[k];
        ends[0] += fmin(a, b);
        ends[1] += fmax(a, b);
    }
}

camera_view light_view_of_sun(const alp_scene_info *info, const float direction[3], uint32_t side)
{
    camera_view view = {.width = side, .height = side, .parallel = true};
    const double forward[3] = {(double)direction[0], (double)direction[1], (double)direction[2]};
    double right[3], up[3], x[2], y[2], z[2];
    find_frame(forward, right, up);
    find_ends(info, right, x);
    find_ends(info, up, y);
    find_ends(info, forward, z);
    const double diagonal = diagonal_of(info), least = fmax(1e-6 * diagonal, 1e-30);
    const double half_x = add_border(fmax(0.5 * (x[1] - x[0]), least), side);
    const double half_y = add_border(fmax(0.5 * (y[1] - y[0]), least), side);
    const double space = fmax(1e-3 * diagonal, 1e-30); // before and behind, for what is moved
    view.far_plane = (float)(z[1] - z[0] + 2.0 * space);
    for (int k = 0; k < 3; k++) {
        view.origin[k] = (float)(0.5 * (x[0] + x[1]) * right[k] + 0.5 * (y[0] + y[1]) * up[k] +
                                 (z[0] - space) * forward[k]);
        view.forward[k] = direction[k];
        view.right[k] = (float)(half_x * right[k]);
        view.up[k] = (float)(half_y * up[k]);
    }
    return view;
}

/// @param tangent of half the angle that is seen
static camera_view make_lamp_view(const alp_scene_info *info, const float position[3],
                                  const double forward[3], double tangent, uint32_t side)
{
    camera_view view = {.near_plane = (float)fmax(NEAR_SHARE * diagonal_of(info), 1e-30),
                        .width = side,
                        .height = side};
    const double half = add_border(tangent, side);
    double right[3], up[3];
    find_frame(forward, right, up);
    memcpy(view.origin, position, sizeof view.origin);
    for (int k = 0; k < 3; k++) {
        view.forward[k] = (float)forward[k];
        view.right[k] = (float)(half * right[k]);
        view.up[k] = (float)(half * up[k]);
    }
    return view;
}

light_cone light_cone_of(const alp_scene_info *info, const alp_light_info *lamp)
{
    light_cone cone = {.outer = M_PI};
    double way[3];
    for (int k = 0; k < 3; k++) {
        const double middle = 0.5 * ((double)info->bounds_min[k] + (double)info->bounds_max[k]);
        way[k] = middle - (double)lamp->position[k];
    }
    const double distance = sqrt(dot(way, way)), radius = 0.5 * diagonal_of(info);
    if (distance > radius) {
        cone.outer = asin(fmax(radius / distance, 1e-6));
    }
    const bool own = lamp->kind == ALP_LIGHT_SPOT && (double)lamp->outer_cone < cone.outer;
    cone.outer = own ? (double)lamp->outer_cone : cone.outer;
    for (int k = 0; k < 3; k++) {
        cone.axis[k] = own ? (double)lamp->direction[k] : way[k] / fmax(distance, 1e-30);
    }
    return cone;
}

camera_view light_view_of_cone(const alp_scene_info *info, const float position[3],
                               const light_cone *cone, uint32_t side)
{
    return make_lamp_view(info, position, cone->axis, tan(cone->outer), side);
}

camera_view light_view_of_face(const alp_scene_info *info, const float position[3], int face,
                               uint32_t side)
{
    double forward[3] = {0.0, 0.0, 0.0};
    forward[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
    return make_lamp_view(info, position, forward, 1.0, side);
}
