// SPDX-License-Identifier: MIT
#include "gl_lpv.h"

#include "gl_program.h"
#include "options/options.h"
#include "shader_list.h"
#include "shaders/lpv_bindings.h"

#include <alpenglow/shared_constants.h>

#include <stdlib.h>
#include <string.h>

enum { TERMS = 12, CASCADE_STEPS = 8 };

static GLuint create_texture(const uint32_t size[3], uint32_t times)
{
    GLuint texture = 0;
    glCreateTextures(GL_TEXTURE_3D, 1, &texture);
    glTextureStorage3D(texture, 1, GL_RGBA32F, (GLsizei)size[0], (GLsizei)size[1],
                       (GLsizei)(size[2] * times));
    glClearTexImage(texture, 0, GL_RGBA, GL_FLOAT, NULL);
    return texture;
}

int gl_lpv_create(const alp_lpv_options *o, gl_lpv *v)
{
    const uint32_t cells[3] = {o->size[0], o->size[1], o->size[2] * o->cascades};
    const uint32_t nodes[3] = {o->size[0] + 1, o->size[1] + 1, (o->size[2] + 1) * o->cascades};
    *v = (gl_lpv){.options = *o};
    glCreateBuffers(1, &v->injected);
    glNamedBufferStorage(v->injected,
                         (GLsizeiptr)(sizeof(GLint) * TERMS * cells[0] * cells[1] * cells[2]), NULL,
                         GL_DYNAMIC_STORAGE_BIT);
    v->opacities = create_texture(nodes, 1);
    v->albedos = create_texture(nodes, 1);
    v->faces = create_texture(nodes, 3);
    v->colors = create_texture(nodes, 3);
    v->light[0] = create_texture(cells, 3);
    v->light[1] = create_texture(cells, 3);
    v->sum = create_texture(cells, 3);
    v->start = gl_program_create_compute(&shader_lpv_start_comp);
    v->face = gl_program_create_compute(&shader_lpv_faces_comp);
    v->step = gl_program_create_compute(&shader_lpv_step_comp);
    return v->start != 0 && v->face != 0 && v->step != 0 ? EXIT_DONE : EXIT_FAILED;
}

void gl_lpv_destroy(gl_lpv *v)
{
    if (v->injected == 0) {
        return;
    }
    const GLuint textures[] = {v->opacities, v->albedos,  v->faces, v->colors,
                               v->light[0],  v->light[1], v->sum};
    glDeleteBuffers(1, &v->injected);
    glDeleteTextures(sizeof textures / sizeof *textures, textures);
    glDeleteProgram(v->start);
    glDeleteProgram(v->face);
    glDeleteProgram(v->step);
    *v = (gl_lpv){0};
}

/// Makes a program current, with what all passes know.
static void use(const gl_lpv *v, GLuint program)
{
    const uint32_t *size = v->options.size;
    const bool accurate = v->options.mode == ALP_LPV_ACCURATE;
    const float along = (float)ALP_LPV_ALONG, aside = (float)ALP_LPV_ASIDE;
    glUseProgram(program);
    glUniform3i(UNIFORM_LPV_SIZE, (GLint)size[0], (GLint)size[1], (GLint)size[2]);
    glUniform1i(UNIFORM_LPV_CASCADES, (GLint)v->options.cascades);
    glUniform3f(UNIFORM_LPV_READ, 1.0f, along, aside);
    glUniform2f(UNIFORM_LPV_GIVE, accurate ? along : 0.0f, accurate ? aside : 1.0f);
    glUniform1f(UNIFORM_LPV_OPACITY, accurate ? (float)ALP_LPV_OPACITY : 1.0f);
    glUniform1i(UNIFORM_LPV_BY_ANGLE, accurate);
}

/// Runs the current program for each of size[0] × size[1] × size[2] × cascades elements.
static void run(const gl_lpv *v, uint32_t more)
{
    const uint32_t *size = v->options.size, deep = (size[2] + more) * v->options.cascades;
    glDispatchCompute((size[0] + more + LPV_GROUP_X - 1) / LPV_GROUP_X,
                      (size[1] + more + LPV_GROUP_Y - 1) / LPV_GROUP_Y,
                      (deep + LPV_GROUP_Z - 1) / LPV_GROUP_Z);
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

static void bind_image(GLuint unit, GLuint texture, GLenum access)
{
    glBindImageTexture(unit, texture, 0, GL_TRUE, 0, access, GL_RGBA32F);
}

static uint32_t count_steps(const alp_lpv_options *o)
{
    const uint32_t xy = o->size[0] > o->size[1] ? o->size[0] : o->size[1];
    const uint32_t longest = xy > o->size[2] ? xy : o->size[2];
    return o->iterations > 0 ? o->iterations : o->cascades > 1 ? CASCADE_STEPS : longest;
}

void gl_lpv_propagate(gl_lpv *v)
{
    const uint32_t steps = count_steps(&v->options);
    if (v->options.blockers) {
        use(v, v->face);
        glBindTextureUnit(0, v->opacities);
        glBindTextureUnit(1, v->albedos);
        bind_image(0, v->faces, GL_WRITE_ONLY);
        bind_image(1, v->colors, GL_WRITE_ONLY);
        run(v, 1);
    }
    use(v, v->start);
    glUniform3fv(UNIFORM_LPV_UNITS, 1, v->units);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BUFFER_LPV_INJECTED, v->injected);
    bind_image(0, v->light[0], GL_WRITE_ONLY);
    bind_image(1, v->sum, GL_WRITE_ONLY);
    run(v, 0);
    use(v, v->step);
    glBindTextureUnit(1, v->faces);
    glBindTextureUnit(2, v->colors);
    bind_image(1, v->sum, GL_READ_WRITE);
    for (uint32_t i = 0; i < steps; i++) {
        // Blockers of the surface that light leaves would stop it in the first step.
        const bool blocked = v->options.blockers && i > 0;
        const GLuint now = v->light[0];
        glUniform1i(UNIFORM_LPV_BLOCKED, blocked);
        glUniform1i(UNIFORM_LPV_REFLECTS, blocked && v->options.bounces != 1);
        glBindTextureUnit(0, now);
        bind_image(0, v->light[1], GL_WRITE_ONLY);
        run(v, 0);
        v->light[0] = v->light[1];
        v->light[1] = now;
    }
}
