// SPDX-License-Identifier: MIT
// What the parts of the atrium have in common.
#ifndef ALPI_SCENE_BUILTIN_ATRIUM_H
#define ALPI_SCENE_BUILTIN_ATRIUM_H

#include "scene/builtin/shapes.h"

enum { ALPI_ATRIUM_X_BAYS = 5, ALPI_ATRIUM_Z_BAYS = 3 };

/// Metres. The court's half sides are those between the axes of the columns.
#define ALPI_ATRIUM_BAY 3.2f
#define ALPI_ATRIUM_HALF_X (0.5f * ALPI_ATRIUM_BAY * (float)ALPI_ATRIUM_X_BAYS)
#define ALPI_ATRIUM_HALF_Z (0.5f * ALPI_ATRIUM_BAY * (float)ALPI_ATRIUM_Z_BAYS)
#define ALPI_ATRIUM_GALLERY 3.2f    // from the columns' axes to the outer walls
#define ALPI_ATRIUM_OUTER_WALL 0.5f // thickness
#define ALPI_ATRIUM_CEILING 6.1f    // heights: of the ground floor's slab,
#define ALPI_ATRIUM_UPPER 6.5f      // of the upper floor,
#define ALPI_ATRIUM_EAVES 11.8f     // of the roof's underside
#define ALPI_ATRIUM_ROOF 12.15f     // and of its top
#define ALPI_ATRIUM_COURT 0.45f     // the court ends that far before the columns' axes

typedef struct alpi_atrium_materials {
    uint32_t stone, marble, plaster, paving, clay, leaf, wood, water;
} alpi_atrium_materials;

// builtin_atrium_shell.c

/// Outer walls between two heights: niches and two doors, or, above, windows.
void alpi_atrium_build_walls(alpi_shaper *shaper, float low, float high, bool windows);
/// Court, steps, floors, roof.
void alpi_atrium_build_floors(alpi_shaper *shaper, const alpi_atrium_materials *materials);
/// Cornices, dentils, balustrade, parapet.
void alpi_atrium_build_ornaments(alpi_shaper *shaper, const alpi_atrium_materials *materials);

// builtin_atrium_garden.c

/// The fountain and four trees in pots.
void alpi_atrium_build_garden(alpi_shaper *shaper, const alpi_atrium_materials *materials);

#endif
