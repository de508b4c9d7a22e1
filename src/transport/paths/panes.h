// SPDX-License-Identifier: MIT
// Rays through panes: surfaces that are blended or transmit, and filter light by their colour.
#ifndef ALPI_TRANSPORT_PANES_H
#define ALPI_TRANSPORT_PANES_H

#include "transport/paths/path_wave.h"

/// More panes in a row than any scene has; a ray that rounding holds up ends there.
enum { ALPI_PANE_LIMIT = 4096 };

/// Rays of a packet that hit panes go on behind them.
/// @param active bit i: lane i has been traced, with what it hit in `hits`
/// @param left   in, out: what is left of light along each ray, per channel
/// @return the lanes that go on: their rays start behind what they hit, with what is left of their
///         length
uint32_t alpi_panes_go_on(const alp_scene *scene, const alpi_hits *hits, uint32_t active,
                          alpi_rays *rays, vec3 left[ALPI_PACKET]);

/// What is left, per channel, of light along each ray of a packet that nothing opaque stops, after
/// all panes on its way. The filter must have `panes` set.
/// @param rays   origins, directions and lengths; destroyed
/// @param active bit i: lane i
void alpi_panes_dim(const alp_scene *scene, const alpi_tracer *tracer, alpi_trace_filter filter,
                    uint32_t active, alpi_rays *rays, vec3 left[ALPI_PACKET]);

/// Hears of a pane that a path is about to pass: where it was hit, and how many metres from the
/// vertex that the path left last.
typedef void alpi_pane_met_fn(const alpi_reference *reference, alpi_path_wave *wave, uint32_t path,
                              uint32_t triangle, float b1, float b2, float distance);

/// Path `path`, whose hit is in the wave, goes on straight through each pane it meets, or is kept
/// by one: by chance, in proportion to what each way brings. Its hit is then that of what kept it
/// or of what is behind, and its throughput has been multiplied.
/// @param met called for each pane that was passed
/// @param distance out: metres from the vertex to the last hit
/// @return share that the last surface may reflect of what it meets, 1 / probability included:
///         multiplies its albedo; 0: the path ends
float alpi_panes_pass(const alpi_reference *reference, alpi_path_wave *wave, uint32_t path,
                      alpi_pane_met_fn *met, float *distance);

#endif
