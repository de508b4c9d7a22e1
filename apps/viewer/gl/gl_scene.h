// SPDX-License-Identifier: MIT
// A scene on the graphics card: geometry, materials and textures.
#ifndef VIEWER_GL_SCENE_H
#define VIEWER_GL_SCENE_H

#include "shaders/bindings.h"

#include <alpenglow/geometry.h>

#include <epoxy/gl.h>

#include <stdbool.h>

/// One surface, as it is drawn.
typedef struct gl_surface {
    GLint first;      // corner
    GLsizei corners;  // 3 a triangle
    GLuint material;  // in BUFFER_MATERIALS
    bool pane;        // light goes through its material
    float axes[3][3]; // of its object
} gl_surface;

/// The textures of a material.
typedef struct gl_material {
    struct {
        GLuint texture, sampler;
    } uses[TEXTURE_USES];
} gl_material;

enum { GL_SCENE_BUFFERS = BUFFER_MATERIALS + 1, GL_WRAPS = 9, GL_ENCODINGS = 2 };

typedef struct gl_scene {
    GLuint array;                     // an empty vertex array: shaders fetch vertices by number
    GLuint buffers[GL_SCENE_BUFFERS]; // at BUFFER_…
    GLuint tangents;                  // BUFFER_TANGENTS
    bool normal_maps;                 // are drawn
    uint32_t vertex_count;
    uint32_t first_triangle; // its number in pictures of triangles
    bool colored;            // vertices have colours
    bool has_panes;          // light goes through some material
    gl_surface *surfaces;    // [surface_count]
    uint32_t surface_count;
    gl_material *materials; // [material_count + 1]; the last is that of no material
    uint32_t material_count;
    GLuint white;                     // texture of one texel
    GLuint (*textures)[GL_ENCODINGS]; // [image_count] linear, sRGB; 0 = not read
    uint32_t image_count;
    GLuint samplers[GL_WRAPS]; // 3 × wrap_u + wrap_v
} gl_scene;

/// Makes it. Surfaces read textures trilinearly with mip levels.
/// @param level_zero  true: bilinearly and without mip levels, as render
/// @param normal_maps whether those that alp_scene_load_normal_maps has loaded are drawn
/// @return EXIT_DONE, or EXIT_FAILED after a message; gl_scene_destroy in both cases
int gl_scene_create(const alp_scene *scene, bool level_zero, bool normal_maps, gl_scene *drawn);
void gl_scene_destroy(gl_scene *drawn);
/// Takes the places of a pose of the same scene: positions, normals, tangents, and axes of objects.
/// @return EXIT_DONE, or EXIT_FAILED after a message
int gl_scene_move(const alp_scene *posed, gl_scene *drawn);
/// Binds the vertex array and the buffers.
void gl_scene_bind(const gl_scene *drawn);
/// Surfaces of a scene.
typedef enum gl_scene_part { GL_SCENE_ALL, GL_SCENE_OPAQUE, GL_SCENE_PANES } gl_scene_part;
/// Draws surfaces by the current program, whose vertex shader is surfaces.vert. It is bound.
void gl_scene_draw(const gl_scene *drawn, gl_scene_part part);

#endif
