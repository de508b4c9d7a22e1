// SPDX-License-Identifier: MIT
// What looking around texels and gathering them need for each: made once for an atlas, so that
// work on a part of its texels costs what that part costs.
#ifndef ALPI_MAPS_SCRATCH_H
#define ALPI_MAPS_SCRATCH_H

#include "transport/occlusion/occlusion.h"

typedef struct alpi_scratch {
    alp_context *context;
    alpi_occlusion_sums sums; // [texels]
    uint8_t *marks;           // [texels]
    uint16_t *inside;         // [texels]
} alpi_scratch;

/// All zero. @param vectors as of alpi_occlusion_sums
alp_result alpi_scratch_create(alp_context *context, uint32_t texels, bool vectors,
                               alpi_scratch *scratch);
void alpi_scratch_destroy(alpi_scratch *scratch);
/// Zero again for the texels in `order`.
/// @return ALP_OK; CANCELLED
alp_result alpi_scratch_clear(alpi_scratch *scratch, const uint32_t *order, uint32_t order_count,
                              const alpi_task_progress *progress);

#endif
