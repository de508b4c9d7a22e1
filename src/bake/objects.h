// SPDX-License-Identifier: MIT
// Groups of texels that are gathered apart, because other surfaces occlude them: the whole scene is
// one group; with ao_self every object (a node with all its primitives) is one.
#ifndef ALPI_BAKE_OBJECTS_H
#define ALPI_BAKE_OBJECTS_H

#include "bake/job.h"
#include "transport/occlusion/occlusion.h"

/// What one group is gathered with.
typedef struct alpi_object {
    const uint32_t *texels; // [texel_count] in the order that was given
    uint32_t texel_count;
    uint32_t first_surface, surface_count; // in alpi_objects.surfaces; 0: the scene's occluders
    float distance;                        // limit in metres, INFINITY = none
} alpi_object;

typedef struct alpi_objects {
    alp_context *context;
    uint32_t count;
    alpi_object *items;
    uint32_t *surfaces; // of the groups, one after the other
    uint32_t *texels;   // of the groups, one after the other; NULL: those of the order
    bool *marks;        // [scene surfaces] all false between calls
} alpi_objects;

/// The groups that hold texels of the job's atlas, in the order of their nodes.
/// @param order [texels] all texels, neighbours together; borrowed
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_objects_create(const alpi_bake_job *job, const uint32_t *order,
                               alpi_objects *objects);
void alpi_objects_destroy(alpi_objects *objects);

/// The tracer of what occludes the whole scene: the scene's own, or one of the chosen occluders.
/// @param owned out: what the caller destroys after it, NULL where it is the scene's, which stays
alp_result alpi_bake_tracer(const alpi_bake_job *job, alp_progress_fn *progress,
                            void *progress_user, alpi_tracer **tracer, alpi_tracer **owned);

/// The tracer of what occludes a group. `owned` as above.
alp_result alpi_object_tracer(const alpi_bake_job *job, alpi_objects *objects,
                              const alpi_object *object, alp_progress_fn *progress,
                              void *progress_user, alpi_tracer **tracer, alpi_tracer **owned);

/// Progress of the parts of one stage told as that of the whole.
typedef struct alpi_part_progress {
    alp_progress_fn *callback; // NULL: nobody listens
    void *user;
    const char *stage;
    double begin, end;    // of this part, as shares of the whole
    double done;          // told so far, as a share of the whole: never less
    double started, last; // alpi_seconds() when the stage began, and of the last report
    uint64_t rays;        // of the whole stage
} alpi_part_progress;
/// An alp_progress_fn whose user is an alpi_part_progress. Progress of other stages (building)
/// counts as the begin of the part.
bool alpi_tell_part(void *user, const alp_progress *progress);

#endif
