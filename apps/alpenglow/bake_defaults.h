// SPDX-License-Identifier: MIT
// Options of alpenglow bake that follow from others: maps, the form of light, and the output.
#ifndef COMMAND_BAKE_DEFAULTS_H
#define COMMAND_BAKE_DEFAULTS_H

#include "options/options.h"

#include <alpenglow/alpenglow.h>

/// The first given option that only light has and that asks for light, or NULL.
const char *bake_light_option(const command_line *a);
/// The first given option that only occlusion has, or NULL.
const char *bake_occlusion_option(const command_line *a);
/// The bits of alp_map of --maps.
unsigned bake_maps(const option_value *values);
/// The form of --lightmap-as, or NONE.
alp_lightmap_as bake_form(const option_value *values);

/// Fills in options that were not given.
/// --maps: light for an option of light, with ao for an option of occlusion.
/// --lightmap-as: emissive for light in -o; three and babylon by the name of -o.
/// -o: the name of SCENE with .baked before its ending, unless --maps-dir is given.
/// @param note out: a note on a choice that was made, or NULL
/// @return the name of the output, which values[OPTION_OUTPUT] borrows, or NULL; the caller frees
/// it
char *bake_defaults_fill(command_line *a, const char **note);

#endif
