// SPDX-License-Identifier: MIT
// Directions from a point to a triangle, uniform in its solid angle, or in its area where it is
// small.
// Based on: James Arvo. Stratified Sampling of Spherical Triangles. SIGGRAPH 1995;
//           A. van Oosterom, J. Strackee. The Solid Angle of a Plane Triangle. IEEE Trans. Biomed.
//           Eng. 30(2), 1983.
#include "scene/lights/triangle_light.h"

/// Below, what is drawn hangs on cosines that differ from 1 by 1e-7 and less, and would no longer
/// be right to float. Above, the point is in the plane to within rounding and the angles of the
/// spherical triangle are all straight.
static const double LEAST_SOLID_ANGLE = 1e-7, LARGEST_SOLID_ANGLE = 2.0 * ALPI_PI * (1.0 - 1e-7);

/// Edges at a corner over its distance. Of a triangle that is smaller, parts of the same area fill
/// the same solid angle to a tenth, (1 ± SMALL)³: drawing from the one is as good as from the
/// other, and takes a fifth of the time.
static const double SMALL = 1.0 / 32.0;

/// @param view corners, cross and determinant are known; the rest is filled in if so
static bool is_small(alpi_triangle_view *view)
{
    const double3 *c = view->corner;
    const double3 a = double3_sub(c[1], c[0]), b = double3_sub(c[2], c[0]);
    const double near = double3_dot(c[0], c[0]);
    if (!(fmax(double3_dot(a, a), double3_dot(b, b)) < SMALL * SMALL * near)) {
        return false;
    }
    const double three = double3_length(double3_add(c[0], double3_add(c[1], c[2])));
    view->solid_angle = 13.5 * fabs(view->determinant) / (three * three * three);
    view->by_area = true;
    return isfinite(view->solid_angle);
}

alpi_triangle_view alpi_triangle_view_from(vec3 point, const vec3 corner[3])
{
    alpi_triangle_view view;
    double3 unit[3];
    for (int k = 0; k < 3; k++) {
        view.corner[k] = double3_between(point, corner[k]);
    }
    view.cross =
        double3_cross(double3_between(corner[0], corner[1]), double3_between(corner[0], corner[2]));
    view.determinant = double3_dot(view.corner[0], view.cross);
    if (is_small(&view)) {
        return view;
    }
    for (int k = 0; k < 3; k++) {
        unit[k] = double3_unit(view.corner[k]);
    }
    // Of unit vectors, so that nothing overflows.
    double volume = double3_dot(
        unit[0], double3_cross(double3_sub(unit[1], unit[0]), double3_sub(unit[2], unit[0])));
    double sum = 1.0 + double3_dot(unit[0], unit[1]) + double3_dot(unit[1], unit[2]) +
                 double3_dot(unit[2], unit[0]);
    view.solid_angle = 2.0 * atan2(fabs(volume), sum);
    view.by_area =
        !(view.solid_angle >= LEAST_SOLID_ANGLE && view.solid_angle <= LARGEST_SOLID_ANGLE);
    return view;
}

alpi_triangle_hit alpi_triangle_hit_at(const alpi_triangle_view *view, double3 direction)
{
    const double3 *c = view->corner;
    // direction = x c0 + y c1 + z c2, by Cramer's rule without the common determinant.
    double x = double3_dot(direction, double3_cross(c[1], c[2]));
    double y = double3_dot(direction, double3_cross(c[2], c[0]));
    double z = double3_dot(direction, double3_cross(c[0], c[1]));
    double sum = x + y + z; // = direction · cross
    double b1 = sum != 0.0 ? y / sum : 1.0 / 3.0, b2 = sum != 0.0 ? z / sum : 1.0 / 3.0;
    b1 = fmin(fmax(b1, 0.0), 1.0);
    b2 = fmin(fmax(b2, 0.0), 1.0 - b1);
    double slope = double3_dot(direction, view->cross);
    return (alpi_triangle_hit){(float)b1, (float)b2,
                               slope != 0.0 ? fabs(view->determinant / slope) : HUGE_VAL};
}

/// Unit part of `a` at right angles to the unit vector `axis`.
static double3 across(double3 a, double3 axis)
{
    return double3_unit(double3_sub(a, double3_scale(axis, double3_dot(a, axis))));
}

static double clamp_cosine(double value)
{
    return fmin(fmax(value, -1.0), 1.0);
}

/// Cuts the spherical triangle at a fraction u.x of its solid angle by an arc through corner 1,
/// and goes along that arc so that strips of equal area are as likely.
static double3 sample_solid_angle(const alpi_triangle_view *view, vec2 u)
{
    double3 a = double3_unit(view->corner[0]), b = double3_unit(view->corner[1]),
            c = double3_unit(view->corner[2]);
    double3 ab = double3_cross(a, b), ac = double3_cross(a, c);
    double sine = fabs(double3_dot(a, double3_cross(b, c))), cosine = double3_dot(ab, ac);
    double scale = hypot(sine, cosine); // the angle at a, as sine and cosine
    double sin_alpha = sine / scale, cos_alpha = cosine / scale;
    double part = (double)u.x * view->solid_angle;
    double alpha = atan2(sin_alpha, cos_alpha);
    double s = sin(part - alpha), t = cos(part - alpha);
    double p = t - cos_alpha, q = s + sin_alpha * double3_dot(a, b);
    double below = (q * s + p * t) * sin_alpha;
    double cut = below != 0.0 ? clamp_cosine(((q * t - p * s) * cos_alpha - q) / below) : 1.0;
    double3 far = double3_add(double3_scale(a, cut),
                              double3_scale(across(c, a), sqrt(fmax(1.0 - cut * cut, 0.0))));
    double z = clamp_cosine(1.0 - (double)u.y * (1.0 - double3_dot(far, b)));
    return double3_unit(double3_add(double3_scale(b, z),
                                    double3_scale(across(far, b), sqrt(fmax(1.0 - z * z, 0.0)))));
}

/// The map that keeps area, of the square to the triangle: √ of one coordinate.
static double3 sample_area(const alpi_triangle_view *view, vec2 u)
{
    const double3 *c = view->corner;
    double root = sqrt((double)u.x);
    double b0 = 1.0 - root, b1 = root * (1.0 - (double)u.y), b2 = root * (double)u.y;
    return double3_unit(double3_add(double3_add(double3_scale(c[0], b0), double3_scale(c[1], b1)),
                                    double3_scale(c[2], b2)));
}

double3 alpi_triangle_sample(const alpi_triangle_view *view, vec2 u)
{
    return view->by_area ? sample_area(view, u) : sample_solid_angle(view, u);
}

double alpi_triangle_density(const alpi_triangle_view *view, double3 direction)
{
    if (!view->by_area) {
        return 1.0 / view->solid_angle;
    }
    // distance² / (area cosθ), with distance = determinant / slope and area cosθ = slope / 2.
    double slope = fabs(double3_dot(direction, view->cross));
    double distance = fabs(view->determinant) / slope;
    double density = 2.0 * distance * distance / slope;
    return density > 0.0 && isfinite(density) ? density : 0.0;
}
