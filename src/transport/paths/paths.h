// SPDX-License-Identifier: MIT
// Steps of the path tracer over a wave of paths.
#ifndef ALPI_TRANSPORT_PATHS_H
#define ALPI_TRANSPORT_PATHS_H

#include "transport/paths/path_wave.h"

/// Puts path `slot` of a wave at a vertex. The wave is filled from 0; `count` is the caller's.
void alpi_paths_place(alpi_path_wave *wave, uint32_t slot, const alpi_receiver_point *point);

/// u and v: where on its receiver or pixel each fresh path begins.
void alpi_paths_draw_places(const alpi_reference *reference, alpi_path_wave *wave);

/// From vertices, or rays from the eye (depth −1, all or none), to the ends of all paths.
void alpi_paths_run(const alpi_reference *reference, alpi_path_wave *wave);

/// What the paths brought for the receiver of a slot: its own, and its shares of its neighbours'.
vec3 alpi_paths_light(const alpi_path_wave *wave, uint32_t slot);

#endif
