// SPDX-License-Identifier: MIT
// Which surfaces of a scene get charts.
#ifndef ALPI_ATLAS_CHOICE_H
#define ALPI_ATLAS_CHOICE_H

#include "atlas/atlas.h"

/// Surfaces that are not chosen are left out of everything: no charts, no texels, no part in
/// utilisation, density or the checks of a kept set; their page is ALPI_NONE. Instances
/// (originals[s] != s) have no charts and no texels either, but the coordinates and pages of their
/// originals.
typedef struct alpi_atlas_choice {
    const bool *surfaces;      // [surface_count] chosen; NULL = all
    const uint32_t *originals; // [surface_count] of alpi_scene_instances; NULL = no instances
    bool world_axes;           // BLEND: what is written has no objects
} alpi_atlas_choice;

/// Refuses options that are out of range or make no sense together.
/// @return ALP_OK; INVALID_ARGUMENT
alp_result alpi_atlas_check(const alp_scene *scene, const alp_atlas_options *options);

/// alp_atlas_create for some of the surfaces. What `choice` points to is read by this call only.
/// @param choice NULL = all surfaces, no instances
alp_result alpi_atlas_create(const alp_scene *scene, const alp_atlas_options *options,
                             const alpi_atlas_choice *choice, alp_atlas **atlas);

/// The scene as the stages see it: a copy that owns nothing but `triangle_usable`, in which only
/// triangles that get charts are usable. `usable_count` and `area` are of those.
alp_result alpi_choice_view(const alp_scene *scene, const alpi_atlas_choice *choice,
                            alp_scene *view);
/// Releases what the view owns.
void alpi_choice_end(alp_scene *view);
/// After the stages: coordinates and pages of instances, and ALPI_NONE for what was not chosen.
void alpi_choice_share(alp_atlas *atlas, const alpi_atlas_choice *choice);

#endif
