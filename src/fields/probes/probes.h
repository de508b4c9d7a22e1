// SPDX-License-Identifier: MIT
// The handle of probes, and the parts that make and read them.
#ifndef ALPI_FIELDS_PROBES_H
#define ALPI_FIELDS_PROBES_H

#include "fields/field.h"
#include "scene/probe_volume.h"
#include "transport/sphere/sphere_rays.h"

#include <alpenglow/probes.h>

struct alp_probes {
    alp_context *context;
    alpi_probe_volume volume;
};

/// The nominal place of a probe, metres in the world of the file.
void alpi_probe_place(const alpi_probe_volume *volume, uint32_t index, double place[3]);

/// A lattice by bounds and spacing: sets size, origin, spacing, count.
/// @param bounds metres, positions in the scene
/// @return ALP_OK; INVALID_ARGUMENT; LIMIT: more probes than there can be
alp_result alpi_probe_lattice(const alp_scene *scene, const alp_probe_options *options,
                              alpi_probe_volume *volume);

/// Where probes are sampled.
typedef struct alpi_probe_sampling {
    alp_context *context;
    const alp_scene *scene;
    alpi_sphere_rays rays; // all light but that of layers
    const alp_probe_options *options;
    float (*points)[3];        // [count] metres, positions in the scene
    alpi_sphere_light *values; // [count]
} alpi_probe_sampling;

/// Few rays of a sampling, for geometry alone.
alpi_sphere_rays alpi_probe_survey_rays(const alpi_probe_sampling *sampling);

/// Samples all probes of a volume whose arrays are there: moves those in solids, and writes
/// coefficients, states, moves and moments. `points` must hold the nominal places.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_probes_sample(alpi_probe_sampling *sampling, alpi_probe_volume *volume);

/// Fills probes in solids from valid neighbours that see them: those a cell away, else two.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_probes_fill(const alpi_probe_sampling *sampling, alpi_probe_volume *volume);

/// Coefficients of a basis from radiance. @param coefficients [alpi_probe_basis_count] out
void alpi_probe_project(const alpi_sh9 *radiance, alpi_probe_basis basis, float (*coefficients)[3]);
/// E = Σ weight · coefficient for a normal. @param weights [9] out
void alpi_probe_weights(alpi_probe_basis basis, vec3 normal, float *weights);

/// The field behind alp_field_create_probes, for volumes that belong to no handle.
alp_result alpi_probe_field_create(const alpi_probe_volume *volume, alp_probe_lookup lookup,
                                   const double origin[3], const float *strengths,
                                   alp_field **field);

#endif
