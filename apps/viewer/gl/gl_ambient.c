// SPDX-License-Identifier: MIT
#include "gl/gl_ambient.h"

#include "printing/messages.h"
#include "shaders/bindings.h"

#include <stdlib.h>
#include <string.h>

enum { TEXELS = ALP_GROUND_MAP_SIDE * ALP_GROUND_MAP_SIDE };

/// shaders/ambient.glsl, std430.
typedef struct shader_ambient {
    float colors[ALP_AMBIENT_COLORS][4];
    float place[4];
    float texels[TEXELS][4];
} shader_ambient;

void gl_ambient_create(const alp_field *field, gl_ambient *d)
{
    const alp_ambient_info info = alp_field_get_ambient(field);
    shader_ambient *s = allocate_or_exit(NULL, sizeof *s);
    memset(s, 0, sizeof *s);
    for (uint32_t i = 0; i < info.color_count; i++) {
        memcpy(s->colors[i], info.colors[i], sizeof info.colors[i]);
    }
    for (size_t i = 0; i < TEXELS && info.ground != NULL; i++) {
        memcpy(s->texels[i], info.ground[i], sizeof info.ground[i]);
    }
    for (int k = 0; k < 2; k++) {
        s->place[k] = info.ground_low[k];
        s->place[2 + k] = info.ground_scale[k];
    }
    d->kind = (GLint)info.model;
    glCreateBuffers(1, &d->model);
    glNamedBufferStorage(d->model, sizeof *s, s, 0);
    free(s);
}

void gl_ambient_destroy(gl_ambient *d)
{
    if (d->model != 0) { // else there may be no context either
        glDeleteBuffers(1, &d->model);
    }
    *d = (gl_ambient){0};
}

void gl_ambient_bind(const gl_ambient *d)
{
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BUFFER_AMBIENT, d->model);
    glUniform1i(UNIFORM_AMBIENT, d->kind);
}
