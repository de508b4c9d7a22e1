// SPDX-License-Identifier: MIT
// Lamps and suns on the graphics card, and what their shadow maps hold.
#ifndef VIEWER_GL_LIGHTS_H
#define VIEWER_GL_LIGHTS_H

#include "light_views.h"

#include <alpenglow/light.h>

#include <epoxy/gl.h>

#include <stdbool.h>

/// A layer of a shadow map.
typedef struct gl_shadow_view {
    camera_view view;
    GLuint map; // a depth array
    GLint layer;
} gl_shadow_view;

typedef struct gl_lights {
    GLuint lights, views;             // BUFFER_LIGHTS, BUFFER_SHADOW_VIEWS
    GLuint sun_shadows, lamp_shadows; // arrays of 32-bit float depth, compared bilinearly
    alp_light_info *infos;            // [count] those that shine; names are not theirs
    uint32_t count;                   // lights
    gl_shadow_view *shadow_views;     // [view_count]
    uint32_t view_count;
    bool unseen; // they light a volume, and no surface straight
} gl_lights;

/// Lists the lights of the file and of the options, and makes empty shadow maps. A sun's map holds
/// the scene. A lamp has six maps around it, or one where what it lights lies in a cone of 120
/// degrees or less. The maps are smaller where lights are many.
/// @return EXIT_DONE, or EXIT_FAILED after a message; gl_lights_destroy in both cases
int gl_lights_create(const alp_scene *scene, const alp_lighting_options *lighting,
                     gl_lights *lights);
void gl_lights_destroy(gl_lights *lights);
/// Binds buffers and maps, and sets the uniform of the current program. Without lights: none.
void gl_lights_bind(const gl_lights *lights);

#endif
