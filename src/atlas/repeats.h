// SPDX-License-Identifier: MIT
// Meshes that several nodes show have one set of charts, each node a copy of its own.
#ifndef ALPI_ATLAS_REPEATS_H
#define ALPI_ATLAS_REPEATS_H

#include "atlas/stages.h"

/// Which surfaces repeat another, but for a movement, a rotation and one factor of size.
typedef struct alpi_repeats {
    uint32_t *sources; // [surface_count] what each repeats; itself: it has charts of its own
    double *scales;    // [surface_count] its size over its source's
    uint32_t count;    // surfaces that repeat another
} alpi_repeats;

/// Instances (alpi_scene_instances) whose triangles have the shapes of the original's. Mirrored
/// ones and those scaled unevenly have not.
alp_result alpi_repeats_create(const alp_scene *scene, alpi_repeats *repeats);
void alpi_repeats_destroy(alp_context *context, alpi_repeats *repeats);

/// The scene without the triangles of repeats, but with their area: a copy that owns nothing but
/// `triangle_usable`, which the caller releases.
alp_result alpi_repeats_view(const alp_scene *scene, const alpi_repeats *repeats, alp_scene *view);
/// Gives every repeat copies of its source's charts at its own size. atlas->scene is the whole
/// scene again.
alp_result alpi_repeats_copy(alp_atlas *atlas, const alpi_repeats *repeats, alpi_charts *charts);

#endif
