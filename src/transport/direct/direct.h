// SPDX-License-Identifier: MIT
// Direct light at receivers: what lights, emissive surfaces and sky give without a bounce, each
// with samples of its own.
//
// Lamps and suns are asked by shadow rays, suns at stratified points of their disk. Of a few even
// emissive polygons the light is known in closed form, and rays say how much of it is hidden
// (direct_polygons.h). Of others a triangle is drawn in proportion to what it can give, and a
// stratified direction within its solid angle. Sky, and such surfaces that fill much of the
// hemisphere, are also met by cosine-distributed rays; the balance heuristic weighs asking against
// meeting.
// Based on: E. Veach, L. J. Guibas. Optimally Combining Sampling Techniques. SIGGRAPH 1995;
//           J. Arvo. Stratified Sampling of Spherical Triangles. SIGGRAPH 1995.
#ifndef ALPI_TRANSPORT_DIRECT_H
#define ALPI_TRANSPORT_DIRECT_H

#include "transport/directional.h"
#include "transport/paths/reference.h"

/// Parts of a receiver's samples: see ALPI_REFERENCE_REPLICATES. Half as
/// many here, for they cost stratification, of which direct light lives: 16 have an error 15 to
/// 20 % larger at the same number of rays (penumbrae and polygons of test_direct.c).
enum { ALPI_DIRECT_REPLICATES = 8 };
/// Replicates of one half of the samples are not even that: each half is one sequence, dealt out to
/// its replicates. One of 4 n points errs less than four of n: on zdm2 under its sky 2000 samples
/// by as much as 3600 of eight sequences. The difference of the halves tells how much less, see
/// direct_sums.h.
enum { ALPI_DIRECT_HALF = ALPI_DIRECT_REPLICATES / 2 };
/// Up to here each light, and each emissive material, has a part of its own. More lights are drawn
/// in proportion to what they give, with as many samples as one of them would have.
enum { ALPI_DIRECT_LIGHT_LIMIT = 64 };

typedef struct alpi_direct_options {
    alp_context *context; // its workers, its memory
    const alp_scene *scene;
    const alpi_tracer *tracer;     // NULL: nothing is asked but which parts there are
    const alpi_lighting *lighting; // all three borrowed
    alpi_trace_filter filter;
    uint32_t samples; // of each light at each receiver, rounded up to a multiple of REPLICATES
    uint64_t seed;
} alpi_direct_options;

typedef enum alpi_direct_kind {
    ALPI_DIRECT_LIGHT,     // one light, `index` of alpi_lighting_light
    ALPI_DIRECT_LIGHTS,    // lights without size, where they are too many
    ALPI_DIRECT_SUNS,      // suns, where they are too many
    ALPI_DIRECT_MATERIAL,  // emissive triangles of one material, `index` of scene.materials
    ALPI_DIRECT_MATERIALS, // of all of them, where they are too many
    ALPI_DIRECT_SKY
} alpi_direct_kind;

/// Light that can be told apart. Lights that give nothing have none.
typedef struct alpi_direct_part {
    alpi_direct_kind kind;
    uint32_t index; // ALPI_NONE where it is not one
} alpi_direct_part;

typedef struct alpi_direct alpi_direct; // immutable

/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_direct_create(const alpi_direct_options *options, alpi_direct **direct);
void alpi_direct_destroy(alpi_direct *direct); // NULL does nothing

/// Samples of each light: options.samples rounded up.
uint32_t alpi_direct_samples(const alpi_direct *direct);
/// The parts, in the order in which they are summed: lights as listed, materials, sky.
const alpi_direct_part *alpi_direct_parts(const alpi_direct *direct, uint32_t *count);

/// What is written of each receiver.
typedef struct alpi_direct_output {
    alpi_reference_value *values;  // [receivers] of all light together
    alpi_reference_value *parts;   // [receivers][parts], or NULL. Their means, added as floats in
                                   // order, are the mean of all; variances do not add up: parts
                                   // share the points of a receiver
    float (*const *groups)[3];     // [groups][receivers] or NULL: the mean of part p is added to
    const uint32_t *part_groups;   // groups[part_groups[p]]. [parts]
    alpi_directional *directional; // [receivers] of all light together, or NULL
    uint64_t rays;                 // that were sent from receivers; what goes on behind a pane
                                   // is still the ray that met it and is not counted again
    double draw; // set: the time of a sample, in that of a plain shadow ray: what is drawn takes
                 // more
} alpi_direct_output;

/// Irradiance E [W·m⁻²] of the receivers in `list` (NULL = all), means over their points. Unbiased,
/// but for partly hidden polygons and spots of a sky, whose bias is far below their noise; a lamp
/// at a receiver without extent takes one ray and is exact. Packets of eight receivers that follow
/// each other in the list ask for polygons together: they should be neighbours in space. What a
/// receiver gets does not depend on the list, but for who is beside it among those eight, who say
/// how many samples it takes, and for a factor that the list's variances have in common.
/// @param output values and parts of the listed receivers are written, rays is added to
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
/// Variances are true on average over receivers and seeds. Where all rays to a polygon agree, only
/// its form factor's is left, mostly nothing: a hundredth of it that is hidden is seen by few, who
/// then state more than they err. (By the rule of three, of a polygon that n rays find free at most
/// 3/n is hidden, 19 times in 20.)
/// Progress counts the most rays there may be. Cost: samples × (lights up to 64, else 1; suns; each
/// of up to 8 polygons, and half as much where it is wholly visible or hidden; 1 for other emissive
/// triangles, and 1 more near them; 1 for a sky, 2 for an uneven one).
alp_result alpi_direct_irradiance(const alpi_direct *direct, const alpi_receivers *receivers,
                                  const uint32_t *list, uint32_t list_count,
                                  const alpi_task_progress *progress, alpi_direct_output *output);

#endif
