// SPDX-License-Identifier: MIT
// Objects: groups of texels that other surfaces occlude, and the ray tracers of these surfaces.
#ifndef ALPI_BAKE_OBJECTS_H
#define ALPI_BAKE_OBJECTS_H

#include "bake/job.h"

/// Groups the texels of the job's atlas, in the order of their nodes.
/// @param order [texels] all texels, neighbours together; borrowed
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_objects_create(const alpi_bake_job *job, const uint32_t *order,
                               alpi_objects *objects);
void alpi_objects_destroy(alpi_objects *objects);

/// Finds or builds the tracer of the surfaces that occlude the whole scene.
/// @param owned out: the tracer if the caller has to destroy it, NULL if it is the scene's
alp_result alpi_bake_tracer(const alpi_bake_job *job, alp_progress_fn *progress,
                            void *progress_user, alpi_tracer **tracer, alpi_tracer **owned);

/// Finds or builds the tracer of the surfaces that occlude an object. `owned` as above.
alp_result alpi_object_tracer(const alpi_bake_job *job, alpi_objects *objects,
                              const alpi_object *object, alp_progress_fn *progress,
                              void *progress_user, alpi_tracer **tracer, alpi_tracer **owned);

#endif
