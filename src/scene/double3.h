// SPDX-License-Identifier: MIT
// Three-vectors in double, for solid angles: what is left of float coordinates after a difference
// is not enough for them.
#ifndef ALPI_SCENE_DOUBLE3_H
#define ALPI_SCENE_DOUBLE3_H

#include "base/vec.h"

typedef struct double3 {
    double x, y, z;
} double3;

static inline double3 double3_from(vec3 a)
{
    return (double3){(double)a.x, (double)a.y, (double)a.z};
}

static inline vec3 double3_to_vec3(double3 a)
{
    return (vec3){(float)a.x, (float)a.y, (float)a.z};
}

/// a − b of float vectors, exact to double.
static inline double3 double3_between(vec3 b, vec3 a)
{
    return (double3){(double)a.x - (double)b.x, (double)a.y - (double)b.y,
                     (double)a.z - (double)b.z};
}

static inline double3 double3_add(double3 a, double3 b)
{
    return (double3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline double3 double3_sub(double3 a, double3 b)
{
    return (double3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline double3 double3_scale(double3 a, double s)
{
    return (double3){a.x * s, a.y * s, a.z * s};
}

static inline double double3_dot(double3 a, double3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline double3 double3_cross(double3 a, double3 b)
{
    return (double3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline double double3_length(double3 a)
{
    return sqrt(double3_dot(a, a));
}

/// Unit vector along a; zero where a has no length.
static inline double3 double3_unit(double3 a)
{
    double length = double3_length(a);
    return double3_scale(a, length > 0.0 ? 1.0 / length : 0.0);
}

#endif
