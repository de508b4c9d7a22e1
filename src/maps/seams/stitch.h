// SPDX-License-Identifier: MIT
// Stitching: moves texels at seams so that what look-ups read on both sides agrees.
//
//     minimise  Σ_s l_s d_s² + Σ_i λ_i (x_i − x⁰_i)²
//
// with the difference d_s of the look-ups of sample s, which stands for l_s texels of a seam, and
// the texels x_i that any of them reads; all others keep their bits. λ is 1e-4 for texels of gaps,
// which stand for no surface, and .15 for those that do: times their coverage, since what they do
// not cover nobody sees; times how much the faces inside them agree on a normal, since the mean
// over both sides of an edge is true of neither; and times mean(σ²) / σ_i² of their stated errors,
// within [1/2, 2], so that noisy ones go further.
//
// All were measured, with 2048 rays from points at and half a texel beside the seams of teapot-room
// (where books and parts of the teapot are a texel or two wide), sphere-plane and torus-plane at
// 512²: the stitched maps of occlusion and light are nowhere further from the truth than they were.
// With smaller λ thin charts are drawn away from it, with greater ones seams stay.
// docs/manual/bake.md has the figures. Based on: M. Iwanicki. Lighting Technology of The Last of
// Us. SIGGRAPH 2013 talks (least squares
//           over samples along the seams);
//           S. Sylvan. Fixing seams in lightmaps. 2010;
//           M. R. Hestenes, E. Stiefel. Methods of Conjugate Gradients for Solving Linear Systems.
//           J. Res. NBS 49(6), 1952.
#ifndef ALPI_MAPS_STITCH_H
#define ALPI_MAPS_STITCH_H

#include "maps/seams/seams.h"

/// What moves how easily. Light is linear, and so is this: maps that add up to one (its layers,
/// direct and bounced light) still do when they are stitched by the same weights.
typedef struct alpi_stitch {
    const alp_lightmap *lightmap;
    const alpi_seams *seams;
    double mean;   // of the map that it was made for, above 0
    float *errors; // [seams->pixel_count] stated standard error, 0 of gaps
    float *holds;  // [seams->pixel_count] λ
    float *spans;  // [seams->sample_count] l_s: as in `seams`, 0 at jumps (jumps.h)
} alpi_stitch;

/// @param seams        borrowed, as the lightmap is
/// @param pages        of the map that says how far sides are apart
/// @param texel_errors [texels] standard errors, or NULL
/// @param error_pages  NULL, or standard errors laid out like the map, in place of texel_errors
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_stitch_create(const alp_lightmap *lightmap, const alpi_seams *seams,
                              float *const *pages, const float *texel_errors,
                              float *const *error_pages, alpi_stitch *stitch);
void alpi_stitch_destroy(alpi_stitch *stitch);

typedef struct alpi_stitch_options {
    uint32_t channels; // 1: G and B become R; 3
    float low, high;   // values stay within, and not above all covered texels at seams
    bool part;         // of a sum: its own texels set no limit
    bool unit;         // they are unit vectors, and stay it
} alpi_stitch_options;

/// How far texels with a value of their own went, over their stated errors (of which less than
/// 0.2 % of the mean counts as that): of those that look-ups at seams read.
typedef struct alpi_stitch_change {
    double rms, largest;
} alpi_stitch_change;

/// Stitches a map by conjugate gradients with Jacobi's preconditioner, in double and in a fixed
/// order, until the residual is a millionth of what it was, or 300 steps are done; up to three
/// times again without the texels that left their range, which stop at its end.
/// @param change NULL, or out
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED by who watches the context: the map is as it was
alp_result alpi_stitch_apply(const alpi_stitch *stitch, const alpi_stitch_options *options,
                             float **pages, alpi_stitch_change *change);

#endif
