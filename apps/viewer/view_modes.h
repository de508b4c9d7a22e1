// SPDX-License-Identifier: MIT
// Modes of --with: where the light of surfaces comes from.
#ifndef VIEWER_VIEW_MODES_H
#define VIEWER_VIEW_MODES_H

#include "gl_ambient.h"
#include "gl_lightmap.h"
#include "gl_lights.h"
#include "gl_program.h"
#include "path_picture.h"
#include "session.h"

/// The light of a mode on the graphics card. Parts of other modes are empty.
typedef struct mode_light {
    gl_lightmap lightmap;
    gl_ambient ambient;
    gl_lights lights;
    path_picture paths;
    GLuint ssao; // share of ambient light that is open, of pass_ssao; 0 = all of it
} mode_light;

/// Options that a mode reads.
typedef enum mode_use {
    USES_METALS = 1,
    USES_BACKGROUND = 2, // sky and suns, which are seen behind the surfaces
    USES_LIGHTS = 4,     // lamps
    USES_BOUNCES = 8,
    USES_ATLAS = 16,
    USES_SEED = 32,
    USES_SWITCH = 64, // --direct
    // Not options.
    USES_PANES = 128,  // light goes through panes
    USES_DIRECT = 256, // light comes straight from lamps and suns
    USES_PATHS = 512,  // --samples; paths make the picture, and nothing is drawn
    USES_SSAO = 1024   // --ssao
} mode_use;

typedef struct view_mode {
    const gl_shader *fragment;
    unsigned uses;            // of mode_use
    alp_ambient_model model;  // of an ambient model
    alp_render_method method; // of render, whose film the picture has
    /// Makes the light. NULL: there is none.
    /// @return EXIT_DONE, or an exit code after a message
    int (*prepare)(session *s, const command_line *arguments, const alp_render_options *options,
                   mode_light *light);
    /// Binds it, and sets the uniforms of the current program. NULL: there is none.
    void (*bind)(const mode_light *light);
} view_mode;

/// The mode of --with.
const view_mode *view_mode_of(const command_line *arguments);
/// Refuses options that no mode of the picture uses. @return EXIT_DONE, or EXIT_USAGE after a
/// message
int view_mode_check(const command_line *arguments);
void mode_light_destroy(mode_light *light);

#endif
