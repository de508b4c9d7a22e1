// SPDX-License-Identifier: MIT
// Bounced light at the texels of an atlas, over the adaptive lattice: it changes slowly but where
// surfaces meet, so that most texels can be interpolated.
//
// Passes and flood are those of occlusion (lattice.h), and stencils, which also go along borders;
// what is smooth is judged by the noise of the rays, in proportion to the light that is there.
// Bounced light is judged by the mean
// of its channels; its channels, and a sky's part of them, are interpolated by the same stencils.
// Based on: H. Elias. Radiosity (the adaptive light map).
#ifndef ALPI_MAPS_BOUNCED_MAP_H
#define ALPI_MAPS_BOUNCED_MAP_H

#include "maps/texels/lattice.h"
#include "transport/gather/gather.h"

/// Texels that several maps of the same light hold out: the first map chooses them, evenly and at
/// random, among those it interpolates. They have rays of their own in each map.
enum { ALPI_HELD_OUT = 1024, ALPI_BOUNCED_PROBES = 512 };
typedef struct alpi_held_out {
    uint32_t count; // 0: none yet
    uint32_t texels[ALPI_HELD_OUT];
    alpi_reference_value values[ALPI_HELD_OUT]; // by the rays of their own of the last map
} alpi_held_out;

typedef struct alpi_bounced_options {
    const alpi_gather_job *gather; // its list and count are not read; its gatherer knows its error
    const uint32_t *order;         // [count] texels, neighbours together
    uint32_t count;
    const uint8_t *near;         // [texels] alpi_nearness, or NULL
    bool adaptive;               // false: all texels are traced
    bool straight;               // alpi_lattice
    alpi_held_out *held_out;     // NULL: one map alone; else in and out
    const alpi_gatherer *beside; // like that of `gather`, of other random numbers: of texels that
                                 // are held out, as some may be traced now, and, where replicates
                                 // are joined, of probes, which tell what their spread is worth
    bool joined;                 // they are
    float *levels;               // [texels] that may be written over, or NULL
} alpi_bounced_options;

typedef struct alpi_bounced_report {
    uint64_t traced, interpolated; // texels
    uint64_t rays;
    float factor; // joined: true variances over those that replicates state
} alpi_bounced_report;

/// Writes the values (with variances), skies and light by direction of the gather job for the
/// texels of the order. Variances are pooled over a texel and its neighbours; where replicates are
/// joined, times the one factor that makes them true over some traced texels, chosen at random,
/// which have rays of their own once more: E[(x − y)²] = 2 Var x. Those of interpolated
/// texels are the mean square difference to independent rays from some of them, chosen at random,
/// less the variance of those rays: it holds what interpolation misses, as a mean over all of them.
/// Where a map before held some out, it is 0: means of maps are held to means of what those found.
/// @param states [texels] out: alpi_texel_state of those in the order
/// @param report in: traced, those of a map like it, to tell progress by, or 0; factor, that of a
/// map
///               like it, for one of too few traced texels to find it, or 0; out: all of it
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_bounced_map(const alpi_bounced_options *options, const alpi_lattice *lattice,
                            const alpi_task_progress *progress, uint8_t *states,
                            alpi_bounced_report *report);

/// The lattice that a map of these options is made on: what interpolates its like again takes it.
/// @param states, values [texels] of it
alpi_lattice alpi_bounced_lattice(const alpi_bounced_options *options, const alpi_lattice *lattice,
                                  uint8_t *states, float *values);

/// Mean square error of texels by channel, held to what was found there apart, whose own error is
/// taken off: E[(x − y)²] − Var y = E[(x − truth)²]. Not below 0.
void alpi_held_out_error(const uint32_t *texels, const alpi_reference_value *found, uint32_t count,
                         const alpi_reference_value *values, float variance[3]);

/// The means of an interpolated texel, not below 0, and the sky's part of them.
void alpi_bounced_interpolate(const alpi_gather_job *gather, uint32_t texel,
                              const alpi_stencil *stencil);

#endif
