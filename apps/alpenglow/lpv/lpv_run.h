// SPDX-License-Identifier: MIT
// A light propagation volume of the command line: its options, its grids, and frames of light.
#ifndef COMMAND_LPV_RUN_H
#define COMMAND_LPV_RUN_H

#include "session.h"

#include <alpenglow/lpv.h>

typedef struct lpv_run {
    session *session;
    alp_lpv *lpv;
    alp_lpv_options options;
    alp_lpv_scene_options frame; // of a frame of light
    alp_camera camera;           // borrowed by `frame`
    bool judged;                 // warnings of the first frame were given
} lpv_run;

/// Refuses values and lights that light propagation has not.
/// @return EXIT_DONE, or EXIT_USAGE after a message
int lpv_run_check(const command_line *arguments);
/// Refuses the options of light propagation, for a --with that has none.
/// @return EXIT_DONE, or EXIT_USAGE after a message
int lpv_run_refuse(const command_line *arguments);

/// Makes the volume, which holds no light yet. `run` must not move in memory.
/// @param lighting copied, not its parts
/// @param camera   NULL, or the view that the grids follow, and that shows --blockers views
/// @return EXIT_DONE, or an exit code after a message; lpv_run_close in both cases
int lpv_run_open(session *s, const command_line *arguments, const alp_lighting_options *lighting,
                 const alp_camera *camera, lpv_run *run);
void lpv_run_close(lpv_run *run);

/// Moves the camera. Several grids follow it.   @return as the library
alp_result lpv_run_follow(lpv_run *run, const alp_camera *camera);
/// Lights a frame: alp_lpv_light_scene. @param report out, or NULL   @return as the library
alp_result lpv_run_light(lpv_run *run, alp_lpv_report *report);

#endif
