// SPDX-License-Identifier: MIT
// The light map of --with lightmap.
#ifndef COMMAND_LIGHTMAPS_H
#define COMMAND_LIGHTMAPS_H

#include "session.h"

/// An atlas, and the weights of its overlapping charts.
typedef struct lightmap_layout {
    alp_atlas_mode mode;
    alp_blend blend;
} lightmap_layout;
/// That of --atlas.
lightmap_layout lightmap_layout_of(const command_line *arguments);

/// Whether the file holds a light map that render shows: one that its materials name, unless an
/// option asks for a new one, or one that black surfaces emit. A note tells of it. Such maps are
/// read, for alp_render without a lightmap.
/// @param found out   @return as alp_scene_read_light_maps
alp_result lightmap_find(session *s, const command_line *arguments, bool *found);

/// Refuses --quality and --error where nothing has rounds. @return EXIT_DONE or EXIT_USAGE
int lightmap_check(const command_line *arguments);

/// Bakes maps alone, as bake --maps with --samples of --texel-samples. A note of view says of a
/// scene with baked light whether the picture shows it.
/// @param options  atlas, occlusion, lighting and bounces of the picture
/// @param maps     bits of alp_map
/// @param lightmap out, which the caller destroys; NULL on failure
/// @return as alp_bake
alp_result lightmap_bake(session *s, const command_line *arguments,
                         const alp_render_options *options, unsigned maps, lightmap_layout layout,
                         alp_lightmap **lightmap);

#endif
