// SPDX-License-Identifier: MIT
// The floor of look-ups of probes: the reading of memory alone.
#ifndef BENCH_PROBE_FLOOR_H
#define BENCH_PROBE_FLOOR_H

#include "scene/probe_volume.h"

/// Adds up all that a look-up reads of the eight probes round each point: their coefficients, and
/// with visibility four texels. @param volume a cube of probes, 1 m apart from the zero point
float bench_probes_read(const alpi_probe_volume *volume, const float (*positions)[3],
                        uint32_t count);

#endif
