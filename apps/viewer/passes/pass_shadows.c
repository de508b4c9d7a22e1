// SPDX-License-Identifier: MIT
#include "passes/pass_shadows.h"

#include "options/options.h"
#include "passes/shader_list.h"

int pass_shadows_create(pass_shadows *pass)
{
    *pass =
        (pass_shadows){.program = gl_program_create(&shader_surfaces_vert, &shader_shadow_frag)};
    glCreateFramebuffers(1, &pass->frame);
    glNamedFramebufferDrawBuffer(pass->frame, GL_NONE);
    return pass->program != 0 ? EXIT_DONE : EXIT_FAILED;
}

void pass_shadows_destroy(pass_shadows *pass)
{
    if (pass->frame != 0) {
        glDeleteProgram(pass->program);
        glDeleteFramebuffers(1, &pass->frame);
    }
    *pass = (pass_shadows){0};
}

static void draw(const gl_scene *scene)
{
    gl_scene_bind(scene);
    gl_scene_draw(scene, GL_SCENE_ALL);
}

/// A sun's map begins at the bounds of the scene: an object before them has the depth of these.
static void draw_object(const gl_scene *object, bool parallel)
{
    if (parallel) {
        glEnable(GL_DEPTH_CLAMP);
    }
    draw(object);
    glDisable(GL_DEPTH_CLAMP);
}

void pass_shadows_draw(const pass_shadows *pass, const gl_scene *scene, const gl_scene *object,
                       const gl_lights *lights)
{
    static const GLfloat far = 0.0f;
    glUseProgram(pass->program);
    glBindFramebuffer(GL_FRAMEBUFFER, pass->frame);
    glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    for (uint32_t i = 0; i < lights->view_count; i++) {
        const gl_shadow_view *v = &lights->shadow_views[i];
        glNamedFramebufferTextureLayer(pass->frame, GL_DEPTH_ATTACHMENT, v->map, 0, v->layer);
        glClearNamedFramebufferfv(pass->frame, GL_DEPTH, 0, &far);
        glViewport(0, 0, (GLsizei)v->view.width, (GLsizei)v->view.height);
        camera_view_bind(&v->view);
        draw(scene);
        if (object != NULL) {
            draw_object(object, v->view.parallel);
        }
    }
}
