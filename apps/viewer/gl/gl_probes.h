// SPDX-License-Identifier: MIT
// Probes on the graphics card, for shaders/probes.glsl of the repository.
#ifndef VIEWER_GL_PROBES_H
#define VIEWER_GL_PROBES_H

#include <alpenglow/probes.h>

#include <epoxy/gl.h>

#include <stdbool.h>

typedef struct gl_probes {
    GLuint light, moments; // 3D textures of floats; 0: there are none
    GLint size[3];
    float origin[3]; // metres, in the scene
    float spacing[3];
    bool visible; // probes hold distances
} gl_probes;

/// Whether the shader reads these probes as a field of ALP_LOOKUP_OURS does: a lattice of spherical
/// harmonics without gradients, whose textures the graphics card takes.
bool gl_probes_can_read(const alp_probes *probes);
/// Makes the textures. @param origin of the scene in the world of its file
void gl_probes_create(const alp_probes *probes, const double origin[3], gl_probes *drawn);
void gl_probes_destroy(gl_probes *drawn);
/// Binds the textures, and sets the uniforms of a program, which is the current one. Without probes
/// it sets the units of the samplers alone.
void gl_probes_bind(const gl_probes *drawn, GLuint program);

#endif
