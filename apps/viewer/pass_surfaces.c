// SPDX-License-Identifier: MIT
#include "pass_surfaces.h"

#include "options/options.h"
#include "shader_list.h"

int pass_surfaces_create(const view_mode *mode, bool metals_black, pass_surfaces *pass)
{
    *pass = (pass_surfaces){.program = gl_program_create(&shader_surfaces_vert, mode->fragment),
                            .mode = mode,
                            .metals_black = metals_black};
    return pass->program != 0 ? EXIT_DONE : EXIT_FAILED;
}

void pass_surfaces_destroy(pass_surfaces *pass)
{
    glDeleteProgram(pass->program);
    *pass = (pass_surfaces){0};
}

static void clear(const gl_targets *t)
{
    static const GLfloat black[4];
    static const GLuint none[4] = {UINT32_MAX, 0, 0, 0};
    static const GLfloat far = 0.0f;
    glClearNamedFramebufferfv(t->light_frame, GL_COLOR, 0, black);
    glClearNamedFramebufferuiv(t->light_frame, GL_COLOR, 1, none);
    glClearNamedFramebufferfv(t->light_frame, GL_DEPTH, 0, &far);
}

static void draw_surface(const gl_scene *scene, const gl_surface *s)
{
    const gl_material *material = &scene->materials[s->material];
    for (GLuint i = 0; i < TEXTURE_USES; i++) {
        glBindTextureUnit(i, material->uses[i].texture);
        glBindSampler(i, material->uses[i].sampler);
    }
    glUniform1ui(UNIFORM_MATERIAL, s->material);
    glUniform3fv(UNIFORM_AXES, 3, &s->axes[0][0]);
    glDrawArrays(GL_TRIANGLES, s->first, s->corners);
}

void pass_surfaces_draw(const pass_surfaces *pass, const gl_scene *scene, const mode_light *light,
                        const camera_view *view, const gl_targets *t)
{
    clear(t);
    glBindFramebuffer(GL_FRAMEBUFFER, t->light_frame);
    glViewport(0, 0, (GLsizei)t->width, (GLsizei)t->height);
    // Row 0 is the upper one, as in images. Depth is 1 at the near plane and 0 far away.
    glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glUseProgram(pass->program);
    gl_scene_bind(scene);
    camera_view_bind(view);
    glUniform1ui(UNIFORM_VERTICES, scene->vertex_count);
    glUniform1i(UNIFORM_COLORED, scene->colored);
    glUniform1i(UNIFORM_METALS, pass->metals_black);
    if (pass->mode->bind != NULL) {
        pass->mode->bind(light);
    }
    for (uint32_t i = 0; i < scene->surface_count; i++) {
        draw_surface(scene, &scene->surfaces[i]);
    }
    for (GLuint i = 0; i < TEXTURE_USES; i++) {
        glBindSampler(i, 0);
    }
}
