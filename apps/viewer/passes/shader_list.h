// SPDX-License-Identifier: MIT
// The shaders that are compiled by themselves, shaders/NAME.vert and .frag, as the build embeds
// them.
#ifndef VIEWER_SHADER_LIST_H
#define VIEWER_SHADER_LIST_H

#include "gl/gl_program.h"

extern const gl_shader shader_surfaces_vert; // corners of triangles
extern const gl_shader shader_none_frag, shader_albedo_frag, shader_lightmap_frag; // of modes
extern const gl_shader shader_direct_frag, shader_ambient_frag;                    // of modes
extern const gl_shader shader_shadow_frag;                                         // of lights
extern const gl_shader shader_ao_frag, shader_sh_frag;                             // of maps
extern const gl_shader shader_points_frag, shader_field_frag;                      // of fields
extern const gl_shader shader_screen_vert; // the whole picture
extern const gl_shader shader_layer_frag, shader_background_frag, shader_film_frag;
extern const gl_shader shader_map_frag; // a reflective shadow map
extern const gl_shader shader_air_frag;
extern const gl_shader shader_lpv_light_comp, shader_lpv_blockers_comp, shader_lpv_merge_comp;
extern const gl_shader shader_lpv_gather_comp;
extern const gl_shader shader_lpv_faces_comp, shader_lpv_start_comp, shader_lpv_step_comp;
extern const gl_shader shader_project_comp, shader_reduce_comp; // of cubes
extern const gl_shader shader_ssao_places_frag, shader_ssao_frag, shader_ssao_blur_frag;

#endif
