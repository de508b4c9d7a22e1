// SPDX-License-Identifier: MIT
// Interpolation of keys: constant, linear, spherical and cubic (glTF 2.0, appendix C).
#include "formats/gltf/gltf_keys.h"

#include <math.h>

static double time_of(const alpi_gltf_keys *keys, uint32_t key)
{
    return (double)alpi_gltf_values_float(&keys->times, key, 0);
}

/// The three numbers of a key of a cubic, in their order.
enum { IN_TANGENT, VALUE, OUT_TANGENT, CUBIC_PARTS };

/// Number k of a part of a key. Weights are scalars in a row, other values vectors.
static double number_of(const alpi_gltf_keys *keys, uint32_t key, int part, uint32_t k)
{
    const bool cubic = keys->interpolation == ALPI_GLTF_CUBIC;
    const size_t row = cubic ? (size_t)CUBIC_PARTS * key + (size_t)part : key;
    const size_t at = row * keys->width + k;
    const uint32_t components = keys->values.components;
    return (double)alpi_gltf_values_float(&keys->values, (uint32_t)(at / components),
                                          (uint32_t)(at % components));
}

static void read_value(const alpi_gltf_keys *keys, uint32_t key, double *value)
{
    for (uint32_t k = 0; k < keys->width; k++) {
        value[k] = number_of(keys, key, VALUE, k);
    }
}

/// @return false, and the value as it was, where it has no direction
static bool normalize(double q[4])
{
    const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(length > 1e-12) || !isfinite(length)) {
        return false;
    }
    for (int k = 0; k < 4; k++) {
        q[k] /= length;
    }
    return true;
}

// --- checks --------------------------------------------------------------------------------------

static bool is_finite(const alpi_gltf_keys *keys, uint32_t key)
{
    const int parts = keys->interpolation == ALPI_GLTF_CUBIC ? CUBIC_PARTS : 1;
    bool finite = true;
    for (int part = 0; part < parts; part++) {
        for (uint32_t k = 0; k < keys->width; k++) {
            finite = finite && isfinite(number_of(keys, key, part, k));
        }
    }
    return finite;
}

const char *alpi_gltf_keys_fault(const alpi_gltf_keys *keys, uint32_t *key)
{
    for (uint32_t i = 0; i < keys->count; i++) {
        *key = i;
        if (!isfinite(time_of(keys, i))) {
            return "its time is not finite";
        }
        if (i > 0 && !(time_of(keys, i) > time_of(keys, i - 1))) {
            return "its time is not after the one before";
        }
        if (!is_finite(keys, i)) {
            return "its value is not finite";
        }
        double q[4];
        if (keys->rotations) {
            read_value(keys, i, q);
            if (!normalize(q)) {
                return "its rotation is not a quaternion";
            }
        }
    }
    return NULL;
}

double alpi_gltf_keys_end(const alpi_gltf_keys *keys)
{
    return time_of(keys, keys->count - 1);
}

// --- the curve -----------------------------------------------------------------------------------

/// The last key at or before a time that is not before the first key.
static uint32_t find_key(const alpi_gltf_keys *keys, double seconds)
{
    uint32_t low = 0, high = keys->count;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (time_of(keys, middle) <= seconds) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

/// Spherical, the short way round.
static void slerp(double a[4], double b[4], double s)
{
    (void)normalize(a);
    (void)normalize(b);
    double cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
    const double sign = cosine < 0.0 ? -1.0 : 1.0;
    cosine = fmin(fabs(cosine), 1.0);
    const double angle = acos(cosine), sine = sin(angle);
    const bool near = sine < 1e-6; // the chord is as good
    const double from = near ? 1.0 - s : sin((1.0 - s) * angle) / sine;
    const double to = near ? s : sin(s * angle) / sine;
    for (int k = 0; k < 4; k++) {
        a[k] = from * a[k] + sign * to * b[k];
    }
}

/// Number k between two keys. @param s [0, 1]   @param span seconds between them
static double cubic(const alpi_gltf_keys *keys, uint32_t key, uint32_t k, double s, double span)
{
    const double s2 = s * s, s3 = s2 * s;
    return (2.0 * s3 - 3.0 * s2 + 1.0) * number_of(keys, key, VALUE, k) +
           (s3 - 2.0 * s2 + s) * span * number_of(keys, key, OUT_TANGENT, k) +
           (3.0 * s2 - 2.0 * s3) * number_of(keys, key + 1, VALUE, k) +
           (s3 - s2) * span * number_of(keys, key + 1, IN_TANGENT, k);
}

/// Between a key and the next.
static void interpolate(const alpi_gltf_keys *keys, uint32_t key, double seconds, double *value)
{
    const double span = time_of(keys, key + 1) - time_of(keys, key);
    const double s = (seconds - time_of(keys, key)) / span;
    if (keys->rotations && keys->interpolation == ALPI_GLTF_LINEAR) {
        double next[4];
        read_value(keys, key, value);
        read_value(keys, key + 1, next);
        slerp(value, next, s);
        return;
    }
    for (uint32_t k = 0; k < keys->width; k++) {
        value[k] = keys->interpolation == ALPI_GLTF_CUBIC
                       ? cubic(keys, key, k, s, span)
                       : (1.0 - s) * number_of(keys, key, VALUE, k) +
                             s * number_of(keys, key + 1, VALUE, k);
    }
}

void alpi_gltf_keys_at(const alpi_gltf_keys *keys, double seconds, double *value)
{
    const uint32_t key = find_key(keys, seconds);
    const bool between = seconds > time_of(keys, key) && key + 1 < keys->count &&
                         keys->interpolation != ALPI_GLTF_STEP;
    if (between) {
        interpolate(keys, key, seconds, value);
    } else {
        read_value(keys, key, value);
    }
    if (keys->rotations && !normalize(value)) { // a spline may go through 0
        read_value(keys, key, value);
        (void)normalize(value);
    }
}
