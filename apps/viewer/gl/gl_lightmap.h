// SPDX-License-Identifier: MIT
// A light map on the graphics card: its pages as one array of textures, and its coordinates.
#ifndef VIEWER_GL_LIGHTMAP_H
#define VIEWER_GL_LIGHTMAP_H

#include <alpenglow/bake.h>

#include <epoxy/gl.h>

#include <stdbool.h>

typedef struct gl_lightmap {
    GLuint pages; // RGBA32F; of ALP_MAP_SH four times page_count, by coefficient
    GLuint page_count;
    GLuint uvs;       // BUFFER_MAP_UVS
    GLuint triangles; // BUFFER_MAP_TRIANGLES
    GLuint sets;      // 1, or 3 that are blended
    bool equal;       // ALP_BLEND_AVERAGE
} gl_lightmap;

/// @param lightmap of `scene`; not needed afterwards
/// @param map      that it holds: ALP_MAP_LIGHT, ALP_MAP_AO or ALP_MAP_SH
/// @param blend    weights of overlapping charts
/// @return EXIT_DONE, or EXIT_FAILED after a message; gl_lightmap_destroy in both cases
int gl_lightmap_create(const alp_scene *scene, const alp_lightmap *lightmap, alp_map map,
                       alp_blend blend, gl_lightmap *drawn);
void gl_lightmap_destroy(gl_lightmap *drawn);
/// Binds textures and buffers, and sets the uniforms of the current program.
void gl_lightmap_bind(const gl_lightmap *drawn);

#endif
