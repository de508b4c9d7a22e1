// SPDX-License-Identifier: MIT
// The radiosity of a whole scene on an atlas of its own, for pictures and probes.
#ifndef ALPI_MAPS_SOLUTION_H
#define ALPI_MAPS_SOLUTION_H

#include "maps/radiosity/radiosity.h"
#include "maps/texels/validity.h"
#include "transport/gather/cosine_rays.h"

#include <alpenglow/atlas.h>

typedef struct alpi_solution_options {
    const alp_scene *scene;
    const alpi_tracer *tracer;
    const alpi_lighting *lighting; // all borrowed until the solution is destroyed
    alp_atlas_options atlas;       // its progress is ignored
    bool one_sided;                // rays pass single-sided materials from behind
    uint32_t bounces;              // as of alpi_radiosity_options
    double tolerance;              // the same
    uint32_t patch_rays;           // cosine rays of a patch; 0: four times the least
    uint32_t direct_samples;       // of each light at each texel; 0: the default of radiosity.h
    double ray_limit;              // of the passes; 0: none
    alpi_layer_arrays *layers;     // NULL, or as of alpi_radiosity_options
    uint64_t kept_limit;           // bytes of kept rays; 0: the default of radiosity.h
    uint64_t seed;
} alpi_solution_options;

typedef struct alpi_solution {
    alp_context *context;
    alp_atlas *atlas;
    alpi_texels texels;
    alpi_lattice lattice;
    alpi_validity validity;
    uint32_t *order; // [count] texels that are not completely inside a solid
    uint32_t count;
    alpi_cosine_rays rays;
    alpi_gatherer gatherer;
    alpi_radiosity radiosity;
} alpi_solution;

/// Makes an atlas of all surfaces and solves on it, backs of double-sided materials too. Stages
/// "atlas", "validity" and "light".
/// @return ALP_OK; what alp_atlas_create returns; OUT_OF_MEMORY; CANCELLED
alp_result alpi_solution_create(const alpi_solution_options *options, alp_progress_fn *progress,
                                void *progress_user, alpi_solution **solution);
void alpi_solution_destroy(alpi_solution *solution); // NULL does nothing

/// Light that surfaces reflect after all bounces but the last, which the caller gathers.
alpi_surface_light alpi_solution_light(const alpi_solution *solution);

#endif
