// SPDX-License-Identifier: MIT
// Light beside the file's: defaults, checks and fingerprint.
#include "scene/lights/lighting_options.h"

#include "base/hash.h"
#include "base/image.h"
#include "scene/double3.h"

enum { LAMP_LIMIT = 1000000 };

alp_lighting_options alp_lighting_options_default(void)
{
    return (alp_lighting_options){
        .struct_size = sizeof(alp_lighting_options),
        .sky = {.up = {1.0f, 1.0f, 1.0f}, .strength = 1.0f, .turbidity = 3.0f},
        .sun = {.color = {1.0f, 1.0f, 1.0f}, .size = 0.0093f}};
}

alp_lamp alp_lamp_default(void)
{
    return (alp_lamp){.kind = ALP_LIGHT_POINT,
                      .direction = {0.0f, 0.0f, -1.0f},
                      .color = {1.0f, 1.0f, 1.0f},
                      .outer_cone = (float)(ALPI_PI / 4.0)};
}

/// NaN fails.
static bool is_within(float value, double low, double high)
{
    return (double)value >= low && (double)value <= high;
}

static const double MOST_INTENSITY = (double)1e20f; // of which the float is larger

/// A quarter turn, of which a float may be larger.
static const double QUARTER = ALPI_PI / 2.0 * (1.0 + 1e-6);

static alp_result check_spot(alp_context *context, uint32_t index, const alp_lamp *lamp)
{
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    const vec3 d = vec3_load(lamp->direction);
    if (!vec3_is_finite(d) || !(double3_length(double3_from(d)) > 0.0)) {
        return alpi_fail(context, code, "lamp %u: direction %g %g %g, need a finite one, not 0",
                         index, (double)d.x, (double)d.y, (double)d.z);
    }
    if (!is_within(lamp->inner_cone, 0.0, QUARTER) || !is_within(lamp->outer_cone, 0.0, QUARTER) ||
        !(lamp->inner_cone < lamp->outer_cone)) {
        return alpi_fail(context, code,
                         "lamp %u: cones %g and %g rad, need 0 <= inner < outer <= pi/2", index,
                         (double)lamp->inner_cone, (double)lamp->outer_cone);
    }
    return ALP_OK;
}

static alp_result check_lamp(alp_context *context, uint32_t index, const alp_lamp *lamp)
{
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    const double limit = (double)ALPI_COORDINATE_LIMIT;
    if (!alp_light_traits_of(lamp->kind).has_position) {
        return alpi_fail(context, code,
                         "lamp %u: kind %d, need 0 (point) or 1 (spot); a directional light is "
                         "given as the sun",
                         index, (int)lamp->kind);
    }
    for (int k = 0; k < 3; k++) {
        if (!is_within(lamp->position[k], -limit, limit)) {
            return alpi_fail(context, code, "lamp %u: %c is %g m, need -1e15 to 1e15", index,
                             "xyz"[k], (double)lamp -> position[k]);
        }
        if (!is_within(lamp->color[k], 0.0, 1e10)) {
            return alpi_fail(context, code, "lamp %u: colour channel %d is %g, need 0 to 1e10",
                             index, k, (double)lamp->color[k]);
        }
    }
    if (!is_within(lamp->intensity, 0.0, MOST_INTENSITY)) {
        return alpi_fail(context, code, "lamp %u: intensity %g candela, need 0 to 1e20", index,
                         (double)lamp->intensity);
    }
    return alp_light_traits_of(lamp->kind).has_direction ? check_spot(context, index, lamp)
                                                         : ALP_OK;
}

static alp_result check_lamps(alp_context *context, const alp_lighting_options *o)
{
    if (o->lamp_count > LAMP_LIMIT) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT, "%u lamps, need 0 to %d",
                         o->lamp_count, (int)LAMP_LIMIT);
    }
    if (o->lamp_count > 0 && o->lamps == NULL) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT, "%u lamps, but lamps is NULL",
                         o->lamp_count);
    }
    for (uint32_t i = 0; i < o->lamp_count; i++) {
        ALP_TRY(check_lamp(context, i, &o->lamps[i]));
    }
    return ALP_OK;
}

static alp_result check_sun(alp_context *context, const alp_lighting_options *o)
{
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    if (!isfinite(o->sun.azimuth)) {
        return alpi_fail(context, code, "sun: azimuth %g rad, need a number",
                         (double)o->sun.azimuth);
    }
    if (!is_within(o->sun.elevation, -QUARTER, QUARTER)) {
        return alpi_fail(context, code, "sun: elevation %g rad, need -pi/2 to pi/2",
                         (double)o->sun.elevation);
    }
    if (!is_within(o->sun.illuminance, 0.0, MOST_INTENSITY)) {
        return alpi_fail(context, code, "sun: illuminance %g lux, need 0 to 1e20",
                         (double)o->sun.illuminance);
    }
    for (int k = 0; k < 3; k++) {
        if (!is_within(o->sun.color[k], 0.0, 1e10)) {
            return alpi_fail(context, code, "sun: colour channel %d is %g, need 0 to 1e10", k,
                             (double)o->sun.color[k]);
        }
    }
    if (!is_within(o->sun.size, 0.0, QUARTER)) {
        return alpi_fail(context, code, "sun: size %g rad, need 0 to pi/2", (double)o->sun.size);
    }
    if (!is_within(o->file_sun_size, 0.0, QUARTER)) {
        return alpi_fail(context, code, "size of the file's suns: %g rad, need 0 to pi/2",
                         (double)o->file_sun_size);
    }
    return ALP_OK;
}

alp_result alpi_lighting_options_check(alp_context *context, const alp_lighting_options *o)
{
    if (o->struct_size != sizeof *o) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "lighting options are not from _default()");
    }
    ALP_TRY(check_sun(context, o));
    return check_lamps(context, o);
}

alpi_light alpi_lamp_light(const alp_lamp *lamp, char *name)
{
    alpi_light light = {.name = name,
                        .kind = lamp->kind,
                        .color = vec3_load(lamp->color),
                        .intensity = lamp->intensity,
                        .position = vec3_load(lamp->position),
                        .range = INFINITY};
    if (alp_light_traits_of(lamp->kind).has_direction) {
        light.direction = double3_to_vec3(double3_unit(double3_from(vec3_load(lamp->direction))));
        light.inner_cone = lamp->inner_cone;
        light.outer_cone = lamp->outer_cone;
    }
    return light;
}

vec3 alpi_sun_direction(const alp_sun_options *sun)
{
    double azimuth = (double)sun->azimuth, elevation = (double)sun->elevation;
    return (vec3){(float)(sin(azimuth) * cos(elevation)), (float)sin(elevation),
                  (float)(cos(azimuth) * cos(elevation))};
}

// --- fingerprint ---------------------------------------------------------------------------------

/// By value: structures have padding, enumerations any size.
static uint64_t hash_number(uint64_t hash, uint32_t number)
{
    return alpi_hash_bytes(hash, &number, sizeof number);
}

static uint64_t hash_floats(uint64_t hash, const float *values, size_t count)
{
    return alpi_hash_bytes(hash, values, count * sizeof *values);
}

static uint64_t hash_sky(uint64_t hash, const alp_sky_options *sky)
{
    const float numbers[] = {sky->turn, sky->strength, sky->turbidity};
    hash = hash_number(hash, (uint32_t)sky->kind);
    hash = hash_floats(hash, sky->up, 3);
    hash = hash_floats(hash, sky->down, 3);
    hash = hash_floats(hash, numbers, sizeof numbers / sizeof *numbers);
    return sky->image != NULL ? alpi_image_hash(hash, sky->image) : hash;
}

static uint64_t hash_lamp(uint64_t hash, const alp_lamp *lamp)
{
    const float numbers[] = {lamp->intensity, lamp->inner_cone, lamp->outer_cone};
    hash = hash_number(hash, (uint32_t)lamp->kind);
    hash = hash_floats(hash, lamp->position, 3);
    hash = hash_floats(hash, lamp->direction, 3);
    hash = hash_floats(hash, lamp->color, 3);
    return hash_floats(hash, numbers, sizeof numbers / sizeof *numbers);
}

uint64_t alpi_lamps_hash(uint64_t hash, const alp_lighting_options *o)
{
    hash = hash_number(hash, o->lamp_count);
    for (uint32_t i = 0; i < o->lamp_count && o->lamps != NULL; i++) {
        hash = hash_lamp(hash, &o->lamps[i]);
    }
    return hash;
}

uint64_t alpi_lighting_options_hash(const alp_lighting_options *o)
{
    const float numbers[] = {o->sun.azimuth, o->sun.elevation, o->sun.illuminance, o->sun.size,
                             o->file_sun_size};
    uint64_t hash = hash_sky(ALPI_HASH_START, &o->sky);
    hash = hash_floats(hash, numbers, sizeof numbers / sizeof *numbers);
    hash = hash_floats(hash, o->sun.color, 3);
    return alpi_lamps_hash(hash, o);
}
