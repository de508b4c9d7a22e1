// SPDX-License-Identifier: MIT
#include "passes/pass_surfaces.h"

#include "options/options.h"
#include "passes/shader_list.h"

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

bool pass_surfaces_has_panes(const pass_surfaces *pass, const gl_scene *scene)
{
    return scene->has_panes && (pass->mode->uses & USES_PANES) != 0;
}

static void clear(GLuint frame)
{
    static const GLfloat black[4], open[4] = {1.0f, 1.0f, 1.0f, 1.0f}, far = 0.0f;
    glClearNamedFramebufferfv(frame, GL_COLOR, 0, black);
    glClearNamedFramebufferfv(frame, GL_COLOR, 2, open);
    glClearNamedFramebufferfv(frame, GL_DEPTH, 0, &far);
}

/// Binds the part that all surfaces share.
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

static void set_target(const gl_targets *t, GLuint frame)
{
    gl_targets_bind(t, frame);
    // Row 0 is the upper one, as in images. Depth is 1 at the near plane and 0 far away.
    glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
}

/// Draws a scene into opaque_frame.
static void draw_opaque(const pass_surfaces *pass, const gl_scene *scene, const mode_light *light,
                        const camera_view *view, const gl_targets *t)
{
    const bool panes = pass_surfaces_has_panes(pass, scene);
    set_target(t, t->opaque_frame);
    bind(pass, scene, light, view);
    glBindTextureUnit(TEXTURE_DEPTH, scene->white);
    glBindTextureUnit(TEXTURE_OPAQUE_DEPTH, scene->white);
    glUniform1i(UNIFORM_PEELED, 0);
    gl_scene_draw(scene, panes ? GL_SCENE_OPAQUE : GL_SCENE_ALL);
}

void pass_surfaces_draw_opaque(const pass_surfaces *pass, const gl_scene *scene,
                               const mode_light *light, const camera_view *view,
                               const gl_targets *t)
{
    static const GLuint none[4] = {UINT32_MAX, 0, 0, 0};
    clear(t->opaque_frame);
    glClearNamedFramebufferuiv(t->opaque_frame, GL_COLOR, 1, none);
    draw_opaque(pass, scene, light, view, t);
}

void pass_surfaces_add_object(const pass_surfaces *pass, const gl_scene *object,
                              const mode_light *light, const camera_view *view, const gl_targets *t)
{
    glEnable(GL_CULL_FACE);
    draw_opaque(pass, object, light, view, t);
    glDisable(GL_CULL_FACE);
}

bool pass_surfaces_draw_panes(const pass_surfaces *pass, const gl_scene *scene,
                              const mode_light *light, const camera_view *view, const gl_targets *t,
                              uint32_t layer)
{
    const bool first = layer == 0;
    GLuint seen = 0;
    clear(t->layer_frames[layer % 2]);
    set_target(t, t->layer_frames[layer % 2]);
    glColorMaski(1, first, first, first, first); // triangles are those of the first layer
    bind(pass, scene, light, view);
    glBindTextureUnit(TEXTURE_DEPTH, first ? scene->white : t->depths[1 - layer % 2]);
    glBindTextureUnit(TEXTURE_OPAQUE_DEPTH, t->opaque_depth);
    glUniform1i(UNIFORM_PEELED, PEEL_BEFORE | (first ? 0 : PEEL_BEHIND));
    glBeginQuery(GL_ANY_SAMPLES_PASSED, pass->query);
    gl_scene_draw(scene, GL_SCENE_PANES);
    glEndQuery(GL_ANY_SAMPLES_PASSED);
    glColorMaski(1, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glGetQueryObjectuiv(pass->query, GL_QUERY_RESULT, &seen);
    return seen != 0;
}
