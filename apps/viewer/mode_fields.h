// SPDX-License-Identifier: MIT
// Modes of fields: probes, ambience, light propagation, and models of ambient light.
#ifndef VIEWER_MODE_FIELDS_H
#define VIEWER_MODE_FIELDS_H

#include "view_modes.h"

/// The parts of a view_mode.
int mode_field_prepare(session *s, const command_line *arguments, alp_render_options *options,
                       mode_light *light);
void mode_field_bind(const mode_light *light, GLuint program);
int mode_ambience_move(session *s, double time, const alp_camera *camera, mode_light *light);
int mode_lpv_move(session *s, double time, const alp_camera *camera, mode_light *light);

#endif
