// SPDX-License-Identifier: MIT
// The handle of probes, and the parts that make and read them.
#ifndef ALPI_FIELDS_PROBES_H
#define ALPI_FIELDS_PROBES_H

#include "fields/field.h"
#include "scene/probe_volume.h"
#include "transport/sphere/sphere_lamps.h"

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

/// The places and rays of a sampling.
typedef struct alpi_probe_sampling {
    alp_context *context;
    const alp_probe_options *options;  // progress is read
    alpi_sphere_rays rays;             // their geometry is read
    float (*points)[3];                // [count] metres, positions in the scene
    alpi_sphere_light *values;         // [count]
    uint32_t *free_probes, free_count; // those outside of solids, moved ones too
} alpi_probe_sampling;

/// Few rays of a sampling, for geometry alone.
alpi_sphere_rays alpi_probe_survey_rays(const alpi_probe_sampling *sampling);

/// Finds the probes in solids, and moves those that can be: writes states, moves, points and the
/// list of free probes. `points` hold the nominal places before.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_probes_survey(alpi_probe_sampling *sampling, alpi_probe_volume *volume);

/// Light that is sampled, and where.
typedef struct alpi_probe_light {
    alpi_sphere_rays rays;
    const alpi_lighting *lamps; // NULL, or whose lamps and suns are added
    uint32_t lamp;              // one of them, or ALPI_NONE: all
    const float (*points)[3];   // [count]
    alpi_sphere_light *values;  // [count] out
    float (*moments)[2];        // NULL, or out
    const char *stage;
} alpi_probe_light;
/// Samples light at free probes. @param coefficients [count][coefficient_count][3] out
/// @return ALP_OK; CANCELLED
alp_result alpi_probes_light(const alpi_probe_sampling *sampling, const alpi_probe_light *light,
                             alpi_probe_volume *volume, float *coefficients);
/// Gradients of free probes, by central differences over half a cell; 0 along all axes beside a
/// surface that is nearer.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_probes_find_gradients(const alpi_probe_sampling *sampling,
                                      const alpi_probe_light *light, alpi_probe_volume *volume);

/// Fills probes in solids, layers too, from valid neighbours that see them: those a cell away, else
/// two.
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_probes_fill(const alpi_probe_sampling *sampling, alpi_probe_volume *volume);

/// Coefficients of a basis from radiance. @param coefficients [alpi_probe_basis_count] out
void alpi_probe_project(const alpi_sh9 *radiance, alpi_probe_basis basis, float (*coefficients)[3]);
/// E = Σ weight · coefficient for a normal. @param weights [9] out
void alpi_probe_weights(alpi_probe_basis basis, vec3 normal, float *weights);

/// The bake behind alp_probes_bake, of light that is known.
/// @param known NULL, or light that surfaces reflect after all bounces, in cells; without layers
/// @return as alp_probes_bake
alp_result alpi_probes_bake(const alp_scene *scene, const alp_probe_options *options,
                            const alpi_surface_light *known, alp_probes **probes);

/// The field behind alp_field_create_probes, for volumes that belong to no handle.
alp_result alpi_probe_field_create(const alpi_probe_volume *volume, alp_probe_lookup lookup,
                                   const double origin[3], const float *strengths,
                                   alp_field **field);

/// Mean square change of E about a point of a lattice's field: see alp_field_errors.
double alpi_probe_field_change(const alp_field *field, const float position[3],
                               const float normal[3]);

#endif
