// SPDX-License-Identifier: MIT
// Occlusion in the red channel of the images that materials read already.
#ifndef ALPI_BAKE_PACK_ORM_H
#define ALPI_BAKE_PACK_ORM_H

#include "bake/job.h"

/// Decides which images occlusion is packed into, and says why not where it is not.
alp_result alpi_bake_plan_packing(alpi_bake_job *job);
/// Makes those images from the finished maps.
alp_result alpi_bake_pack_images(alpi_bake_job *job);
void alpi_bake_release_packing(alpi_bake_job *job);
/// Whether the occlusion of a triangle is packed into an image.
bool alpi_bake_is_packed(const alpi_bake_job *job, uint32_t triangle);

#endif
