// SPDX-License-Identifier: MIT
// The lines of examples/terrain_flight.csv, which CMake writes into a source file.
#ifndef COMMAND_FLIGHT_TERRAIN_H
#define COMMAND_FLIGHT_TERRAIN_H

#include <stdint.h>

extern const double flight_terrain_lines[][7]; // t, position, target
extern const uint32_t flight_terrain_count;

#endif
