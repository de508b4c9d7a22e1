// SPDX-License-Identifier: MIT
// Scratch memory per texel for validity and occlusion, made once for an atlas, so that work on some
// texels costs no time for the others.
#ifndef ALPI_MAPS_SCRATCH_H
#define ALPI_MAPS_SCRATCH_H

#include "transport/occlusion/occlusion.h"

typedef struct alpi_scratch {
    alp_context *context;
    alpi_occlusion_sums sums; // [texels]
    uint8_t *marks;           // [texels]
    uint16_t *inside;         // [texels]
} alpi_scratch;

/// All zeros. @param vectors as of alpi_occlusion_sums   @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_scratch_create(alp_context *context, uint32_t texels, bool vectors,
                               alpi_scratch *scratch);
void alpi_scratch_destroy(alpi_scratch *scratch);
/// Sets the texels in `order` to zero. @return ALP_OK; CANCELLED
alp_result alpi_scratch_clear(alpi_scratch *scratch, const uint32_t *order, uint32_t order_count,
                              const alpi_task_progress *progress);

#endif
