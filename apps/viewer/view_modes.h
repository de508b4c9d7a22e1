// SPDX-License-Identifier: MIT
// Modes of --with: where the light of surfaces comes from.
#ifndef VIEWER_VIEW_MODES_H
#define VIEWER_VIEW_MODES_H

#include "gl/gl_ambient.h"
#include "gl/gl_field.h"
#include "gl/gl_lightmap.h"
#include "gl/gl_lights.h"
#include "gl/gl_program.h"
#include "lpv_frame.h"
#include "path_picture.h"
#include "picture_fields.h"

/// The light of a mode on the graphics card. Parts of other modes are empty.
typedef struct mode_light {
    gl_lightmap lightmap;
    gl_ambient ambient;
    gl_field field;
    field_source source; // of `field`
    lpv_frame *lpv;      // the volume on the card that `field` reads, or NULL
    float scattering;    // of mist that shows its light, 1/metre
    gl_lights lights;
    path_picture paths;
    GLuint ssao; // share of ambient light that is open, of pass_ssao; 0 = all of it
} mode_light;

/// Options that a mode reads.
typedef enum mode_use {
    USES_METALS = 1u << 0,
    USES_BACKGROUND = 1u << 1, // sky and suns, which are seen behind the surfaces
    USES_LIGHTS = 1u << 2,     // lamps
    USES_BOUNCES = 1u << 3,
    USES_ATLAS = 1u << 4,
    USES_SEED = 1u << 5,
    USES_SWITCH = 1u << 6, // --direct
    USES_FIELD = 1u << 7,
    USES_PROBES = 1u << 8,
    USES_NORMALS = 1u << 9, // normal maps
    USES_LAYOUT = 1u << 10, // --atlas
    USES_TEXELS = 1u << 11, // rays of texels
    USES_OCCLUSION = 1u << 12,
    USES_SSAO = 1u << 13,
    USES_OBJECT = 1u << 14, // --object
    USES_PATHS = 1u << 15,  // --samples; paths make the picture, and nothing is drawn
    // Not options.
    USES_PANES = 1u << 16, // light goes through panes
    USES_DIRECT = 1u << 17 // light comes straight from lamps and suns
} mode_use;

typedef struct view_mode {
    const char *name; // of --with
    const gl_shader *fragment;
    unsigned uses;            // of mode_use
    alp_render_method method; // of render, whose film the picture has
    picture_field field;      // of fields and models of ambient light
    /// Makes the light. NULL: there is none.
    /// @param options of the picture; camera and lighting may become those of the light
    /// @return EXIT_DONE, or an exit code after a message
    int (*prepare)(session *s, const command_line *arguments, alp_render_options *options,
                   mode_light *light);
    /// Binds it, and sets the uniforms of the current program, which is given. NULL: there is none.
    void (*bind)(const mode_light *light, GLuint program);
    /// Updates the light for a time of a flight. NULL: it stands still.
    /// @return EXIT_DONE, or an exit code after a message
    int (*move)(session *s, double time, const alp_camera *camera, mode_light *light);
} view_mode;

/// The mode of --with.
const view_mode *view_mode_of(const command_line *arguments);
/// Refuses options that no mode of the picture uses. @return EXIT_DONE, or EXIT_USAGE after a
/// message
int view_mode_check(const command_line *arguments);
/// Whether the light of a mode of the picture moves along the flight of --path, also before -o.
bool view_mode_flies(const command_line *arguments);
void mode_light_destroy(mode_light *light);
/// Binds ambient occlusion of the screen, and sets its uniform in the current program.
void mode_light_bind_ssao(const mode_light *light);

#endif
