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

void sun_toward(const alp_sun_options *sun, double toward[3])
{
    const double azimuth = (double)sun->azimuth, elevation = (double)sun->elevation;
    toward[0] = sin(azimuth) * cos(elevation);
    toward[1] = sin(elevation);
    toward[2] = cos(azimuth) * cos(elevation);
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

/// A parallel view that reaches through the scene.
/// @param centre, half along the two axes, metres
static camera_view make_parallel_view(const alp_scene_info *info, const float direction[3],
                                      const double centre[2], const double half[2], uint32_t side)
{
    camera_view view = {.width = side, .height = side, .parallel = true};
    const double forward[3] = {(double)direction[0], (double)direction[1], (double)direction[2]};
    double right[3], up[3], z[2];
    find_frame(forward, right, up);
    find_ends(info, forward, z);
    const double space = fmax(1e-3 * scene_diagonal(info), 1e-30); // for what is moved
    view.far_plane = (float)(z[1] - z[0] + 2.0 * space);
    for (int k = 0; k < 3; k++) {
        view.origin[k] =
            (float)(centre[0] * right[k] + centre[1] * up[k] + (z[0] - space) * forward[k]);
        view.forward[k] = direction[k];
        view.right[k] = (float)(half[0] * right[k]);
        view.up[k] = (float)(half[1] * up[k]);
    }
    return view;
}

camera_view light_view_of_sun(const alp_scene_info *info, const float direction[3], uint32_t side)
{
    const double forward[3] = {(double)direction[0], (double)direction[1], (double)direction[2]};
    const double least = fmax(1e-6 * scene_diagonal(info), 1e-30);
    double axes[2][3], centre[2], half[2];
    find_frame(forward, axes[0], axes[1]);
    for (int a = 0; a < 2; a++) {
        double ends[2];
        find_ends(info, axes[a], ends);
        centre[a] = 0.5 * (ends[0] + ends[1]);
        half[a] = add_border(fmax(0.5 * (ends[1] - ends[0]), least), side);
    }
    return make_parallel_view(info, direction, centre, half, side);
}

camera_view light_view_of_box(const alp_scene_info *info, const float direction[3],
                              const double low[3], const double high[3], uint32_t side)
{
    const double forward[3] = {(double)direction[0], (double)direction[1], (double)direction[2]};
    double axes[2][3], centre[2], half[2];
    find_frame(forward, axes[0], axes[1]);
    for (int a = 0; a < 2; a++) {
        centre[a] = half[a] = 0.0;
        for (int k = 0; k < 3; k++) {
            centre[a] += 0.5 * (low[k] + high[k]) * axes[a][k];
            half[a] += 0.5 * (high[k] - low[k]) * fabs(axes[a][k]);
        }
        const double texel = 2.0 * half[a] / (side - 1);
        centre[a] = texel * floor(centre[a] / texel + 0.5);
        half[a] += 0.5 * texel;
    }
    return make_parallel_view(info, direction, centre, half, side);
}

camera_view light_view_of_lamp(const alp_scene_info *info, const float position[3],
                               const double forward[3], double tangent, uint32_t side)
{
    camera_view view = {.near_plane = (float)fmax(NEAR_SHARE * scene_diagonal(info), 1e-30),
                        .width = side,
                        .height = side};
    double right[3], up[3];
    find_frame(forward, right, up);
    memcpy(view.origin, position, sizeof view.origin);
    for (int k = 0; k < 3; k++) {
        view.forward[k] = (float)forward[k];
        view.right[k] = (float)(tangent * right[k]);
        view.up[k] = (float)(tangent * up[k]);
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
    const double distance = sqrt(dot(way, way)), radius = 0.5 * scene_diagonal(info);
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
    return light_view_of_lamp(info, position, cone->axis, add_border(tan(cone->outer), side), side);
}

camera_view light_view_of_face(const alp_scene_info *info, const float position[3], int face,
                               uint32_t side)
{
    double forward[3] = {0.0, 0.0, 0.0};
    forward[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
    return light_view_of_lamp(info, position, forward, add_border(1.0, side), side);
}
