// SPDX-License-Identifier: MIT
// Probes that ranks sample together, without a bake of maps.
#ifndef ALPI_FIELDS_PROBE_RANKS_H
#define ALPI_FIELDS_PROBE_RANKS_H

#include <alpenglow/probes.h>

/// Begins with all ranks, whose scene and options must be the same.
/// @param began out: alpi_ranks_end must follow
/// @return as alpi_ranks_begin
alp_result alpi_probes_begin_ranks(const alp_scene *scene, const alp_probe_options *options,
                                   bool *began);

#endif
