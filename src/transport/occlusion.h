// SPDX-License-Identifier: MIT
// Receivers → ambient occlusion. Knows neither texel nor probe.
#ifndef ALPI_TRANSPORT_OCCLUSION_H
#define ALPI_TRANSPORT_OCCLUSION_H

#include "base/tasks.h"
#include "scene/receivers.h"
#include "trace/trace.h"

#include <alpenglow/occlusion.h>

/// Independent repetitions that the samples of a receiver are split into: their spread is the
/// standard error of their mean.
enum { ALPI_REPLICATES = 4 };

/// Uses of random numbers, apart from each other.
enum {
    ALPI_STREAM_SEQUENCE = 0x5eed, // of the sequence that all receivers share
    ALPI_STREAM_DIRECTION = 0,     // + replicate: of one receiver's shifts
    ALPI_STREAM_PLACE = 0x100,     // + replicate: of its points
};

/// Options with everything resolved that is the same for all receivers.
typedef struct alpi_occlusion_setup {
    alp_context *context;
    const alpi_tracer *tracer;
    alp_occlusion_options options;
    float distance;      // metres, INFINITY = no limit
    alp_falloff falloff; // NONE where there is no limit
    float cone_sin, cone_cos;
    alpi_trace_filter filter;
    bool bent;               // sum the open directions too
    uint32_t replicates;     // 1 or ALPI_REPLICATES
    uint32_t samples;        // of each replicate
    uint32_t shift_mask;     // bits of a direction's coordinates that a receiver shifts by itself
    uint32_t (*sequence)[3]; // [replicates][samples] 32-bit fractions, shared by all receivers
} alpi_occlusion_setup;

/// @return ALP_OK; INVALID_ARGUMENT: a value out of its range, named
alp_result alpi_occlusion_check(const alp_scene *scene, const alp_occlusion_options *options);

/// `options` must have passed the check. Release the setup in the end.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_occlusion_prepare(const alp_scene *scene, const alpi_tracer *tracer,
                                  const alp_occlusion_options *options,
                                  alpi_occlusion_setup *setup);
void alpi_occlusion_release(alpi_occlusion_setup *setup);

/// Eight points, a value of each from its first `count` samples (of each replicate): the way in for
/// callers that have points at hand one packet at a time, such as a renderer.
/// @param keys   of the points' random numbers   @param active bit i: point i is asked about
void alpi_occlusion_of_packet(const alpi_occlusion_setup *setup,
                              const alpi_receiver_point points[ALPI_PACKET],
                              const uint64_t keys[ALPI_PACKET], uint32_t active, uint32_t count,
                              float accessibility[ALPI_PACKET]);

/// What rays have met so far, per receiver. Counts, so that any order gives the same bits.
typedef struct alpi_occlusion_sums {
    uint32_t (*open)[ALPI_REPLICATES]; // [receivers] free rays of each replicate
    float (*bent)[3];                  // [receivers] Σ of the free directions, or NULL
} alpi_occlusion_sums;

/// Sends samples [first, first + count) of each replicate from the receivers in `list` (NULL = all,
/// then list_count is receivers->count) on all workers and adds to `sums`. Eight receivers that
/// follow each other in the list are traced together: they should be neighbours in space. What a
/// receiver gets does not depend on the list.
/// @param progress NULL, or what to tell; its units are filled in here, in rays
alp_result alpi_occlusion_add(const alpi_occlusion_setup *setup, const alpi_receivers *receivers,
                              const uint32_t *list, uint32_t list_count, uint32_t first,
                              uint32_t count, const alpi_task_progress *progress,
                              alpi_occlusion_sums *sums);

/// Accessibility of the receivers in `list` from all samples; stage "occlusion".
/// @param accessibility [receivers->count] out; only those of the list are written
alp_result alpi_occlusion_gather(const alpi_occlusion_setup *setup, const alpi_receivers *receivers,
                                 const uint32_t *list, uint32_t list_count, float *accessibility);

#endif
