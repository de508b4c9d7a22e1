// SPDX-License-Identifier: MIT
#include "pass_surfaces.h"

#include "options/options.h"
#include "shader_list.h"

int pass_surfaces_create(const view_mode *mode, bool metals_black, pass_surfaces *pass)
{
    *pass = (pass_surfaces){.program = gl_program_create(&shader_surfaces_vert, mode->fragment),
                            .mode = mode,
                            .metals_black = metals_black};
    glCreateQueries(GL_ANY_SAMPLES_PASSED, 1, &pass->query);
    return pass->program != 0 ? EXIT_DONE : EXIT_FAILED;
}

void pass_surfaces_destroy(pass_surfaces *pass)
{
    if (pass->query != 0) {
        glDeleteProgram(pass->program);
        glDeleteQueries(1, &pass->query);
    }
    *pass = (pass_surfaces){0};
}

static void clear(GLuint frame, bool first)
{
    static const GLfloat black[4], open[4] = {1.0f, 1.0f, 1.0f, 1.0f}, far = 0.0f;
    static const GLuint none[4] = {UINT32_MAX, 0, 0, 0};
    glClearNamedFramebufferfv(frame, GL_COLOR, 0, black);
    if (first) {
        glClearNamedFramebufferuiv(frame, GL_COLOR, 1, none);
    }
    glClearNamedFramebufferfv(frame, GL_COLOR, 2, open);
    glClearNamedFramebufferfv(frame, GL_DEPTH, 0, &far);
}

/// What is the same for all surfaces.
static void bind(const pass_surfaces *pass, const gl_scene *scene, const mode_light *light,
                 const camera_view *view)
{
    glUseProgram(pass->program);
    gl_scene_bind(scene);
    camera_view_bind(view);
    glUniform1i(UNIFORM_METALS, pass->metals_black);
    glUniform1i(UNIFORM_FIELD_READ, READ_PIXEL); // vertices hold no light
    if (pass->mode->bind != NULL) {
        pass->mode->bind(light, pass->program);
    }
}

bool pass_surfaces_draw(const pass_surfaces *pass, const gl_scene *scene, const mode_light *light,
                        const camera_view *view, const gl_targets *t, uint32_t layer)
{
    const bool first = layer == 0;
    GLuint seen = 0;
    clear(t->layer_frames[layer % 2], first);
    gl_targets_bind(t, t->layer_frames[layer % 2]);
    // Row 0 is the upper one, as in images. Depth is 1 at the near plane and 0 far away.
    glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glColorMaski(1, first, first, first, first); // triangles are those of the first layer
    bind(pass, scene, light, view);
    glBindTextureUnit(TEXTURE_DEPTH, first ? scene->white : t->depths[1 - layer % 2]);
    glUniform1i(UNIFORM_PEELED, !first);
    glBeginQuery(GL_ANY_SAMPLES_PASSED, pass->query);
    gl_scene_draw(scene);
    glEndQuery(GL_ANY_SAMPLES_PASSED);
    glColorMaski(1, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glGetQueryObjectuiv(pass->query, GL_QUERY_RESULT, &seen);
    return seen != 0;
}
