// SPDX-License-Identifier: MIT
// Parts of the table of options, one file each.
#ifndef COMMAND_OPTION_PARTS_H
#define COMMAND_OPTION_PARTS_H

#include "options/options.h"

#define RAY_COMMANDS (IN_BAKE | IN_RENDER)
#define LIGHT_COMMANDS (RAY_COMMANDS | IN_SAMPLE | IN_PROBES | IN_AMBIENCE | IN_LPV | IN_VIEW)
#define SKY_COMMANDS (LIGHT_COMMANDS & ~IN_LPV)
#define SCENE_COMMANDS (LIGHT_COMMANDS | IN_INFO)

/// Modes of view: choices of --with and --beside.
#define VIEW_MODES                                                                                 \
    "none|albedo|lightmap|direct|constant|hemisphere|ground-map|ambient-cube|"                     \
    "environment|probes|ambience|lpv|ao|sh|blend|reference"

typedef struct option_part {
    const option *rows; // [count]
    size_t count;
} option_part;

extern const option_part option_part_output;
extern const option_part option_part_what;
extern const option_part option_part_stop;
extern const option_part option_part_picture;
extern const option_part option_part_light;
extern const option_part option_part_space;
extern const option_part option_part_ambience;
extern const option_part option_part_lpv;
extern const option_part option_part_ao;
extern const option_part option_part_run;
extern const option_part option_part_view;
extern const option_part option_part_view_more;
extern const option_part option_part_later;
extern const option_part option_part_scale;

#endif
