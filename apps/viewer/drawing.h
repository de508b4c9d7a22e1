// SPDX-License-Identifier: MIT
// All that draws a frame: targets, scene, light and passes.
#ifndef VIEWER_DRAWING_H
#define VIEWER_DRAWING_H

#include "gl/gl_object.h"
#include "passes/pass_air.h"
#include "passes/pass_background.h"
#include "passes/pass_field.h"
#include "passes/pass_film.h"
#include "passes/pass_layers.h"
#include "passes/pass_shadows.h"
#include "passes/pass_ssao.h"
#include "passes/pass_surfaces.h"

typedef struct drawing {
    const alp_scene *scene;
    gl_targets targets;
    gl_scene drawn;
    gl_object object; // that moves; empty without one
    pass_surfaces surfaces;
    pass_field field; // of modes that read a field at pixels
    pass_layers layers;
    pass_background background;
    pass_film film;
    pass_shadows shadows;
    screen_pass air; // of a volume's mist
    pass_ssao ssao;
    mode_light light; // of the mode; owned
} drawing;

typedef struct drawing_options {
    alp_context *context; // of the scene
    const view_mode *mode;
    mode_light light; // of the mode; drawing_create takes it over, also where it fails
    const alp_lighting_options *lighting;
    uint32_t width, height;
    alp_render_object object; // beside the scene; the mode has USES_OBJECT
    bool direct;              // lamps and suns shine, in modes that have their light
    bool metals_black;
    bool normal_maps;  // those that are loaded are drawn, where light comes by direction
    float ssao_radius; // metres; 0 = no ambient occlusion, as of modes that do not use it
    bool level_zero;   // textures are read bilinearly without mip levels, as by render
} drawing_options;

/// Makes it in the current context of OpenGL.
/// @return EXIT_DONE, or EXIT_FAILED after a message; drawing_destroy in both cases
int drawing_create(const alp_scene *scene, const drawing_options *options, drawing *d);
void drawing_destroy(drawing *d);

/// Changes sky, suns and lamps. @return EXIT_DONE, or EXIT_FAILED
int drawing_set_lighting(drawing *d, alp_context *context, const alp_lighting_options *lighting);
/// Draws another pose of the scene from now on: surfaces, lights and what propagates from them.
/// Maps and fields keep their light, and are read where the surfaces are. `posed` must live as long
/// as it is drawn.
/// @return EXIT_DONE, or EXIT_FAILED after a message
int drawing_set_pose(drawing *d, alp_context *context, const alp_scene *posed,
                     const alp_lighting_options *lighting);
/// Moves the object to a place, metres. @return EXIT_DONE, or EXIT_FAILED after a message
int drawing_move_object(drawing *d, alp_context *context, const float position[3]);
/// Lights the volume of a mode that has one. Several grids follow the eye as far as the scene
/// reaches.
/// @param forward unit, the way of the grids ahead of the eye, or 0
/// @param view    a view of blockers, or NULL
void drawing_light(drawing *d, const float eye[3], const float forward[3], const camera_view *view);
/// Lights the volume for a camera, and draws a frame of light.
void drawing_draw(drawing *d, const alp_camera *camera);
/// Draws a frame of any view with the size of the targets, by the light that the volume has.
void drawing_draw_view(drawing *d, const camera_view *view);
/// Develops it by alp_film_develop's numbers.
/// @param film  out: exposure becomes the one that was used
/// @param light NULL, or out: the light; the caller destroys both
alp_result drawing_develop(const drawing *d, alp_context *context, alp_film_options *film,
                           alp_image **developed, alp_image **light);

#endif
