// SPDX-License-Identifier: MIT
// Three-vectors and 4×4 matrices. Plain structs, inline functions, column-major like glTF.
#ifndef ALPI_BASE_VEC_H
#define ALPI_BASE_VEC_H

#include <math.h>
#include <stdbool.h>

#define ALPI_PI 3.14159265358979323846

typedef struct vec2 {
    float x, y;
} vec2;

typedef struct vec3 {
    float x, y, z;
} vec3;

static inline vec3 vec3_load(const float *p)
{
    return (vec3){p[0], p[1], p[2]};
}

static inline void vec3_store(float *p, vec3 v)
{
    p[0] = v.x;
    p[1] = v.y;
    p[2] = v.z;
}

static inline vec3 vec3_add(vec3 a, vec3 b)
{
    return (vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline vec3 vec3_sub(vec3 a, vec3 b)
{
    return (vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline vec3 vec3_scale(vec3 a, float s)
{
    return (vec3){a.x * s, a.y * s, a.z * s};
}

/// a + s·b
static inline vec3 vec3_mad(vec3 a, float s, vec3 b)
{
    return (vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline float vec3_dot(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline vec3 vec3_cross(vec3 a, vec3 b)
{
    return (vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline float vec3_length(vec3 a)
{
    return sqrtf(vec3_dot(a, a));
}

static inline bool vec3_is_finite(vec3 a)
{
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

/// Unit vector along a, computed in double so that neither 1e-30 nor 1e30 overflows; `fallback`
/// where a has no direction (zero or not finite).
static inline vec3 vec3_normalize_or(vec3 a, vec3 fallback)
{
    double x = (double)a.x, y = (double)a.y, z = (double)a.z;
    double length = sqrt(x * x + y * y + z * z);
    if (!(length > 0.0) || !isfinite(length)) {
        return fallback;
    }
    return (vec3){(float)(x / length), (float)(y / length), (float)(z / length)};
}

static inline vec3 vec3_min(vec3 a, vec3 b)
{
    return (vec3){fminf(a.x, b.x), fminf(a.y, b.y), fminf(a.z, b.z)};
}

static inline vec3 vec3_max(vec3 a, vec3 b)
{
    return (vec3){fmaxf(a.x, b.x), fmaxf(a.y, b.y), fmaxf(a.z, b.z)};
}

/// Area of a triangle, all in double: neither 1e-12 nor 1e15 m under- or overflows.
static inline double vec3_triangle_area(vec3 a, vec3 b, vec3 c)
{
    double ux = (double)b.x - (double)a.x, uy = (double)b.y - (double)a.y,
           uz = (double)b.z - (double)a.z;
    double vx = (double)c.x - (double)a.x, vy = (double)c.y - (double)a.y,
           vz = (double)c.z - (double)a.z;
    double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    return 0.5 * sqrt(x * x + y * y + z * z);
}

/// Unit normal of a triangle (counter-clockwise outside), `fallback` where it has no area.
static inline vec3 vec3_triangle_normal(vec3 a, vec3 b, vec3 c, vec3 fallback)
{
    double ux = (double)b.x - (double)a.x, uy = (double)b.y - (double)a.y,
           uz = (double)b.z - (double)a.z;
    double vx = (double)c.x - (double)a.x, vy = (double)c.y - (double)a.y,
           vz = (double)c.z - (double)a.z;
    double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    double length = sqrt(x * x + y * y + z * z);
    if (!(length > 0.0) || !isfinite(length)) {
        return fallback;
    }
    return (vec3){(float)(x / length), (float)(y / length), (float)(z / length)};
}

/// Two unit vectors that make a right-handed orthonormal frame with the unit vector n: t × b = n.
/// Duff, Burgess, Christensen, Hery, Kensler, Liani, Villemin: Building an Orthonormal Basis,
/// Revisited. JCGT 6(1), 2017. No branch on a near-singular pole, error below 1e-6.
static inline void vec3_frame(vec3 n, vec3 *t, vec3 *b)
{
    float sign = n.z < -0.5f ? -1.0f : 1.0f; // not at 0: walls stand there, and rounding noise
    float a = -1.0f / (sign + n.z);
    float c = n.x * n.y * a;
    *t = (vec3){1.0f + sign * n.x * n.x * a, sign * c, -sign * n.x};
    *b = (vec3){c, sign + n.y * n.y * a, -n.y};
}

/// Column-major 4×4 matrix, as in glTF: element (row r, column c) is m[4c + r].
typedef struct mat4 {
    double m[16];
} mat4;

static inline mat4 mat4_identity(void)
{
    return (mat4){{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
}

static inline mat4 mat4_multiply(const mat4 *a, const mat4 *b)
{
    mat4 r;
    for (int column = 0; column < 4; column++) {
        for (int row = 0; row < 4; row++) {
            double sum = 0.0;
            for (int k = 0; k < 4; k++) {
                sum += a->m[4 * k + row] * b->m[4 * column + k];
            }
            r.m[4 * column + row] = sum;
        }
    }
    return r;
}

static inline vec3 mat4_transform_point(const mat4 *a, vec3 p)
{
    double x = (double)p.x, y = (double)p.y, z = (double)p.z;
    return (vec3){(float)(a->m[0] * x + a->m[4] * y + a->m[8] * z + a->m[12]),
                  (float)(a->m[1] * x + a->m[5] * y + a->m[9] * z + a->m[13]),
                  (float)(a->m[2] * x + a->m[6] * y + a->m[10] * z + a->m[14])};
}

static inline vec3 mat4_transform_direction(const mat4 *a, vec3 p)
{
    double x = (double)p.x, y = (double)p.y, z = (double)p.z;
    return (vec3){(float)(a->m[0] * x + a->m[4] * y + a->m[8] * z),
                  (float)(a->m[1] * x + a->m[5] * y + a->m[9] * z),
                  (float)(a->m[2] * x + a->m[6] * y + a->m[10] * z)};
}

/// The images of the axes x, y, z: what normals of the target are multiplied by to come back.
static inline void mat4_axes(const mat4 *a, float axes[3][3])
{
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 3; i++) {
            axes[k][i] = (float)a->m[4 * k + i];
        }
    }
}

/// Determinant of the upper 3×3 block: negative where the transform mirrors.
static inline double mat4_determinant3(const mat4 *a)
{
    const double *m = a->m;
    return m[0] * (m[5] * m[10] - m[9] * m[6]) - m[4] * (m[1] * m[10] - m[9] * m[2]) +
           m[8] * (m[1] * m[6] - m[5] * m[2]);
}

/// Transforms a normal by the cofactor matrix of the upper 3×3 block: right for non-uniform scale
/// and finite for a singular one; the sign of the determinant is kept out, so a mirrored normal
/// still points outside. Unit length, or zero where the matrix leaves the normal no direction.
static inline vec3 mat4_transform_normal(const mat4 *a, vec3 n)
{
    const double *m = a->m;
    double x = (double)n.x, y = (double)n.y, z = (double)n.z;
    double cx = (m[5] * m[10] - m[9] * m[6]) * x + (m[9] * m[2] - m[1] * m[10]) * y +
                (m[1] * m[6] - m[5] * m[2]) * z;
    double cy = (m[8] * m[6] - m[4] * m[10]) * x + (m[0] * m[10] - m[8] * m[2]) * y +
                (m[4] * m[2] - m[0] * m[6]) * z;
    double cz = (m[4] * m[9] - m[8] * m[5]) * x + (m[8] * m[1] - m[0] * m[9]) * y +
                (m[0] * m[5] - m[4] * m[1]) * z;
    double length = sqrt(cx * cx + cy * cy + cz * cz);
    if (!(length > 0.0) || !isfinite(length)) {
        return (vec3){0.0f, 0.0f, 0.0f};
    }
    double scale = (mat4_determinant3(a) < 0.0 ? -1.0 : 1.0) / length;
    return (vec3){(float)(cx * scale), (float)(cy * scale), (float)(cz * scale)};
}

#endif
