// SPDX-License-Identifier: MIT
// Triangles that are unwrapped together, and what their unwrapping is worth.
#ifndef ALPI_ATLAS_PATCH_H
#define ALPI_ATLAS_PATCH_H

#include "atlas/fold.h"

#include "scene/scene.h"

/// Connected triangles laid out in the plane, in metres. Zero it; destroy it.
typedef struct alpi_patch {
    alp_context *context;
    uint32_t count, vertex_count;
    uint32_t (*vertices)[3]; // [count] corners → vertices of the patch: the same where triangles of
                             // the patch share an edge, so that there is no cut inside
    bool *open;        // [count] whether the patch ends at an edge of the triangle
    double (*flat)[3]; // [count] the triangle in a plane of its own: corners at (0, 0),
                       // (flat[0], 0) and (flat[1], flat[2]), metres
    double (*at)[2];   // [vertex_count] where the vertices are laid
} alpi_patch;

/// Which triangles: those of two charts, one after the other. What is shared by patches that are
/// made at the same time is only read.
typedef struct alpi_patch_source {
    const alp_scene *scene;
    const uint32_t (*neighbours)[3];
    const uint32_t *triangles; // [count]
    const uint32_t *charts;    // [triangle_count] chart of each, or ALPI_NONE
    const uint32_t *slots;     // [triangle_count] index in its chart
    uint32_t pair[2];          // the two charts
    uint32_t first_count;      // triangles of the first
    uint32_t count;
} alpi_patch_source;
alp_result alpi_patch_create(alp_context *context, const alpi_patch_source *source,
                             alpi_patch *patch);
void alpi_patch_destroy(alpi_patch *patch);

/// Lays the vertices so that lengths change as little as can be: as rigid as possible, `steps`
/// times, from where they are. Cost: steps · √vertices · vertices, about.
alp_result alpi_patch_unfold(alpi_patch *patch, int steps);

/// How much a patch is stretched, with its texture's area taken for its world's.
typedef struct alpi_stretch {
    double worst, mean; // L2 of a triangle; root of the area-weighted mean of squares
    bool flipped;       // a triangle is, or has no area: the others mean nothing then
} alpi_stretch;
/// Based on: P. V. Sander, J. Snyder, S. J. Gortler, H. Hoppe. Texture Mapping Progressive Meshes.
/// SIGGRAPH 2001, section 3.
alpi_stretch alpi_patch_stretch(const alpi_patch *patch);
/// Whether any of its triangles, none of which is flipped, lies over another. Only those at open
/// edges are looked at: where no inner vertex is wound round twice, the map is one-to-one near
/// every point, and what lies double ends somewhere, at an edge of the patch.
alp_result alpi_patch_overlaps(const alpi_patch *patch, bool *overlaps);

#endif
