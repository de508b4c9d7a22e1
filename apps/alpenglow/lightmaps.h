// SPDX-License-Identifier: MIT
// The light map of --with lightmap.
#ifndef COMMAND_LIGHTMAPS_H
#define COMMAND_LIGHTMAPS_H

#include "session.h"

/// Bakes irradiance alone, as bake --maps light with --samples of --texel-samples.
/// @param options  atlas, occlusion, lighting and bounces of the picture
/// @param lightmap out, which the caller destroys; NULL on failure
/// @return as alp_bake
alp_result lightmap_bake(session *s, const command_line *arguments,
                         const alp_render_options *options, alp_lightmap **lightmap);
/// Weights of overlapping charts, of --atlas.
alp_blend lightmap_blend(const command_line *arguments);

#endif
