// SPDX-License-Identifier: MIT
// The rays of a map of bounced light (bounced_map.h) once more, for other light on the same
// surfaces: the same texels are traced, by the same rays, and the others interpolated by the same
// stencils. Nothing is decided by the light itself, so that what comes out is linear in it, but for
// interpolated values below 0, which become 0.
#ifndef ALPI_MAPS_BOUNCED_AGAIN_H
#define ALPI_MAPS_BOUNCED_AGAIN_H

#include "maps/radiosity/bounced_map.h"
#include "transport/gather/kept_rays.h"

typedef struct alpi_bounced_again {
    alpi_bounced_options options; // whose gather finds no sky
    alpi_lattice lattice;         // its values are none
    uint32_t *list;               // [traced]
    uint32_t traced;
    alpi_kept_rays kept; // room for none: rays are traced every time
    uint64_t rays;       // that were sent
} alpi_bounced_again;

/// @param states     [texels] as alpi_bounced_map left them; borrowed, as all else
/// @param kept_limit bytes, within the budget, of rays that are traced here and then looked up
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_bounced_again_create(const alpi_bounced_options *options,
                                     const alpi_lattice *lattice, uint8_t *states,
                                     uint64_t kept_limit, const alpi_task_progress *progress,
                                     alpi_bounced_again *again);
void alpi_bounced_again_destroy(alpi_bounced_again *again);

/// Writes the means of the gather job's values for the light that is there now.
/// @return ALP_OK; CANCELLED
alp_result alpi_bounced_again_gather(alpi_bounced_again *again, const alpi_task_progress *progress);

#endif
