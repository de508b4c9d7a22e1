// SPDX-License-Identifier: MIT
// The closed form of light from a polygon.
#include "scene/lights/polygon_light.h"

#include "scene/double3.h"

/// γ (n·Γ) of one edge. An edge that the point lies on, or points along, has no plane: 0.
static double edge_term(double3 normal, double3 a, double3 b)
{
    double3 cross = double3_cross(a, b);
    double length = double3_length(cross);
    if (!(length > 0.0)) {
        return 0.0;
    }
    return atan2(length, double3_dot(a, b)) * double3_dot(normal, cross) / length;
}

/// Where the edge from a to b meets the horizon; ha and hb are of opposite sign.
static double3 horizon_point(double3 a, double ha, double3 b, double hb)
{
    double t = ha / (ha - hb);
    return double3_unit(double3_add(double3_scale(a, 1.0 - t), double3_scale(b, t)));
}

/// Walks the edges, and joins where the polygon dives below the horizon with where it comes up.
double alpi_polygon_form_factor(vec3 point, vec3 normal, const vec3 *corners, uint32_t count)
{
    const double3 n = double3_from(normal);
    double3 left = {0}, risen = {0}; // where it dived last; where it rose before it ever dived
    bool has_left = false, has_risen = false;
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        // Unit lengths keep 1e15 m from overflowing, and leave angles and planes as they are.
        double3 a = double3_unit(double3_between(point, corners[i]));
        double3 b = double3_unit(double3_between(point, corners[i + 1 < count ? i + 1 : 0]));
        double ha = double3_dot(a, n), hb = double3_dot(b, n);
        if (ha >= 0.0 && hb >= 0.0) {
            sum += edge_term(n, a, b);
        } else if (ha >= 0.0) {
            left = horizon_point(a, ha, b, hb);
            has_left = true;
            sum += edge_term(n, a, left);
        } else if (hb >= 0.0) {
            double3 up = horizon_point(a, ha, b, hb);
            sum += edge_term(n, up, b);
            if (has_left) {
                sum += edge_term(n, left, up);
            } else {
                risen = up;
                has_risen = true;
            }
        }
    }
    if (has_left && has_risen) {
        sum += edge_term(n, left, risen);
    }
    // v_i × v_i+1 looks away from the point where the corners run counter-clockwise seen from
    // behind.
    return -sum / (2.0 * ALPI_PI);
}
