// SPDX-License-Identifier: MIT
// Small scenes with closed forms, and reads of fields at one point.
#ifndef FIELD_SCENES_H
#define FIELD_SCENES_H

#include "test_support.h"

#include "base/vec.h"
#include "scene/builtin/mesh_builder.h"

#include <math.h>
#include <stdlib.h>

#define FIELD_PI 3.14159265358979323846

/// A box from inside, of one grey, that glows.
static inline alp_scene *field_room(alp_context *context, vec3 size, float albedo, float emission)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "room");
    alpi_builder_surface(&b, "walls",
                         alpi_builder_material(&b, "walls", (vec3){albedo, albedo, albedo},
                                               (vec3){emission, emission, emission}));
    alpi_builder_box(&b, size, (vec3){0.0f, 0.0f, 0.0f}, ALPI_FACE_ALL);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

/// Two black specks at opposite corners of a cube of 4 m about the origin: the sky alone lights it.
static inline alp_scene *field_specks(alp_context *context)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    const vec3 black = {0.0f, 0.0f, 0.0f};
    const float s = 1e-3f;
    alpi_builder_start(&b, context, "specks");
    alpi_builder_surface(&b, "specks", alpi_builder_material(&b, "black", black, black));
    for (float p = -2.0f; p <= 2.0f; p += 4.0f) {
        alpi_builder_quad(
            &b, (const vec3[4]){{p, p, p + s}, {p + s, p, p + s}, {p + s, p, p}, {p, p, p}});
    }
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

/// Probes in a box about the origin, at places of a lattice.
static inline alp_probe_options field_probes_at_origin(float spacing, float half)
{
    alp_probe_options o = alp_probe_options_default();
    o.spacing = spacing;
    for (int k = 0; k < 3; k++) {
        o.bounds_min[k] = -half;
        o.bounds_max[k] = half;
    }
    o.atlas_size = 64;
    return o;
}

/// Coefficient i of a probe with nine, all light.
static inline const float *field_coefficient(const alp_probes *probes, uint32_t probe, uint32_t i)
{
    return alp_probes_coefficients(probes, UINT32_MAX) + ((size_t)probe * 9 + i) * 3;
}

static inline vec3 field_read(const alp_field *field, vec3 position, vec3 normal)
{
    const float p[3] = {position.x, position.y, position.z};
    const float n[3] = {normal.x, normal.y, normal.z};
    float e[3];
    alp_field_irradiance(field, 1, &p, &n, &e);
    return vec3_load(e);
}

/// The reference at one point, with its standard error of channel 1.
static inline vec3 field_truth(const alp_scene *scene, const alp_reference_options *options,
                               vec3 position, vec3 normal, double *error)
{
    const float p[3] = {position.x, position.y, position.z};
    const float n[3] = {normal.x, normal.y, normal.z};
    float e[3], deviation[3];
    assert_int_equal(alp_reference_irradiance(scene, options, 1, &p, &n, &e, &deviation), ALP_OK);
    if (error != NULL) {
        *error = (double)deviation[1];
    }
    return vec3_load(e);
}

/// A unit vector at `tilt` from +y, turned about it.
static inline vec3 field_tilted(double tilt, double turn)
{
    return (vec3){(float)(sin(tilt) * cos(turn)), (float)cos(tilt), (float)(sin(tilt) * sin(turn))};
}

#endif
