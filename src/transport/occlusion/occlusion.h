// SPDX-License-Identifier: MIT
// Receivers → ambient occlusion. Knows neither texel nor probe.
#ifndef ALPI_TRANSPORT_OCCLUSION_H
#define ALPI_TRANSPORT_OCCLUSION_H

#include "base/tasks.h"
#include "scene/receivers.h"
#include "trace/trace.h"

#include <alpenglow/occlusion.h>

/// Equal parts of a receiver's samples that are counted apart: their spread shows how its error
/// compares with its neighbours' (it is not the error: parts of one sequence are not independent).
enum { ALPI_QUARTERS = 4 };

/// The innermost loop, see occlusion_kernel.h.
struct alpi_occlusion_setup;
struct alpi_sample_run;
struct alpi_sample_chunk;
struct alpi_occlusion_stand;
struct alpi_occlusion_tally;
typedef void alpi_occlusion_kernel(const struct alpi_occlusion_setup *setup,
                                   const struct alpi_sample_run *run,
                                   const struct alpi_sample_chunk *chunk,
                                   struct alpi_occlusion_stand *stand,
                                   struct alpi_occlusion_tally *tallies);

/// Directions that leave from one point of a receiver with extent. With more, texels that many
/// small triangles share err by the choice of their points: 16 doubled the error of torus-plane at
/// 64². With fewer, placing them takes longer than it gains.
enum { ALPI_SAMPLES_PER_POINT = 8 };

/// The automatic distance limit over the diagonal of a bounding box.
#define ALPI_OCCLUSION_AUTO_SHARE 0.2f

/// Options with everything resolved that is the same for all receivers.
typedef struct alpi_occlusion_setup {
    alp_context *context;
    const alp_scene *scene;
    const alpi_tracer *tracer;
    alpi_occlusion_kernel *kernel; // the one for this machine
    alp_occlusion_options options;
    float distance;      // metres, INFINITY = no limit
    alp_falloff falloff; // NONE where there is no limit
    float cone_sin, cone_cos;
    alpi_trace_filter filter;
    alpi_rays_spread spread; // of packets that neighbouring receivers send
    bool bent;               // sum the open directions too
    uint32_t samples;        // of each receiver, a multiple of ALPI_QUARTERS
    uint32_t (*sequence)[3]; // [samples] 32-bit fractions, shared by all receivers
    uint32_t (*places)[2];   // [samples / SAMPLES_PER_POINT + 2 + PACKET] the same for their points
} alpi_occlusion_setup;

/// @return ALP_OK; INVALID_ARGUMENT: a value out of its range, named
alp_result alpi_occlusion_check(const alp_scene *scene, const alp_occlusion_options *options);

/// `options` must have passed the check. Rays are careful until alpi_occlusion_be_quick says else.
/// Release the setup in the end.
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_occlusion_prepare(const alp_scene *scene, const alpi_tracer *tracer,
                                  const alp_occlusion_options *options,
                                  alpi_occlusion_setup *setup);
/// @param quick what alpi_tracer_quicken told of the setup's rays
void alpi_occlusion_be_quick(alpi_occlusion_setup *setup, bool quick);
/// The same setup with other random numbers, a sequence of its own.
alp_result alpi_occlusion_prepare_again(const alpi_occlusion_setup *setup, uint64_t seed,
                                        alpi_occlusion_setup *other);
void alpi_occlusion_release(alpi_occlusion_setup *setup);

/// Accessibility of points from all samples, by a run of them (occlusion_run.h) that is not
/// `extended`: the way in for callers that have a few points at hand at a time, such as a renderer.
/// @param keys [count] of the points' random numbers
void alpi_occlusion_of_points(const alpi_occlusion_setup *setup, const struct alpi_sample_run *run,
                              const alpi_receiver_point *points, const uint64_t *keys,
                              uint32_t count, float *accessibility);

/// What rays have met so far, per receiver. Counts, so that any order gives the same bits.
typedef struct alpi_occlusion_sums {
    uint32_t (*open)[ALPI_QUARTERS]; // [receivers] free rays of each quarter
    uint32_t *done;                  // [receivers] rays sent
    float (*vectors)[3];             // [receivers] Σ of the free directions or of colours, or NULL
    uint32_t parted;                 // samples before this one make four quarters, those from it on
                                     // four more, added to the first; 0 (as made): all make four
} alpi_occlusion_sums;
alp_result alpi_occlusion_sums_create(alp_context *context, uint32_t receivers, bool vectors,
                                      alpi_occlusion_sums *sums);
void alpi_occlusion_sums_destroy(alp_context *context, alpi_occlusion_sums *sums);
/// Free rays over rays sent; 1 where none was sent.
float alpi_occlusion_value(const alpi_occlusion_sums *sums, uint32_t receiver);
/// Σ of the vectors over rays sent; 0 where none was sent.
vec3 alpi_occlusion_mean_vector(const alpi_occlusion_sums *sums, uint32_t receiver);

/// Makes the quarters of `before` samples those of `after`, a multiple: the old ones become a part
/// of the first. (To go on to what is no multiple, set sums->parted to `before` instead.)
void alpi_occlusion_requarter(alpi_occlusion_sums *sums, uint32_t receiver, uint32_t before,
                              uint32_t after);

/// Sends samples [first, first + count) from the receivers in `list` (NULL = all, then list_count
/// is receivers->count) on all workers and adds to `sums`: sample s counts in quarter s / (total /
/// ALPI_QUARTERS), unless sums->parted says otherwise. Receivers that follow each other in the list
/// should be neighbours in space: they meet the same parts of the scene. What a receiver gets does
/// not depend on the list; which of its points a sample leaves from does on which samples are sent
/// together, and where quarters end. After CANCELLED `sums` holds what was sent.
/// @param total    of the samples that the receivers will have, a multiple of ALPI_QUARTERS
/// @param progress NULL, or what to tell; units are filled in here, in rays
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_occlusion_add(const alpi_occlusion_setup *setup, const alpi_receivers *receivers,
                              const uint32_t *list, uint32_t list_count, uint32_t first,
                              uint32_t count, uint32_t total, const alpi_task_progress *progress,
                              alpi_occlusion_sums *sums);

/// Accessibility of the receivers in `list` from all samples; stage "occlusion".
/// @param accessibility [receivers->count] out; only those of the list are written
alp_result alpi_occlusion_gather(const alpi_occlusion_setup *setup, const alpi_receivers *receivers,
                                 const uint32_t *list, uint32_t list_count, float *accessibility);

#endif
