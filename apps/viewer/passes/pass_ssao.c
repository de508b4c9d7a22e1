// SPDX-License-Identifier: MIT
#include "passes/pass_ssao.h"

#include "options/options.h"
#include "passes/shader_list.h"
#include "shaders/bindings.h"

static GLuint make_texture(GLenum format, const gl_targets *t)
{
    GLuint texture = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &texture);
    glTextureStorage2D(texture, 1, format, (GLsizei)t->width, (GLsizei)t->height);
    return texture;
}

static GLuint make_frame(GLuint color)
{
    GLuint frame = 0;
    glCreateFramebuffers(1, &frame);
    glNamedFramebufferTexture(frame, GL_COLOR_ATTACHMENT0, color, 0);
    return frame;
}

int pass_ssao_create(const gl_targets *t, bool panes, float radius, pass_ssao *pass)
{
    static const view_mode modes[2] = {{.fragment = &shader_ssao_places_frag},
                                       {.fragment = &shader_ssao_places_frag, .uses = USES_PANES}};
    *pass = (pass_ssao){.radius = radius};
    pass->seen = make_texture(GL_RGBA32F, t);
    pass->noisy = make_texture(GL_R32F, t);
    pass->share = make_texture(GL_R32F, t);
    pass->noisy_frame = make_frame(pass->noisy);
    pass->frame = make_frame(pass->share);
    int code = pass_surfaces_create(&modes[panes ? 1 : 0], false, &pass->places);
    code = code == EXIT_DONE ? screen_pass_create(&shader_ssao_frag, &pass->occlude) : code;
    return code == EXIT_DONE ? screen_pass_create(&shader_ssao_blur_frag, &pass->blur) : code;
}

void pass_ssao_destroy(pass_ssao *pass)
{
    if (pass->seen != 0) {
        glDeleteTextures(3, (const GLuint[]){pass->seen, pass->noisy, pass->share});
        glDeleteFramebuffers(2, (const GLuint[]){pass->noisy_frame, pass->frame});
    }
    screen_pass_destroy(&pass->occlude);
    screen_pass_destroy(&pass->blur);
    pass_surfaces_destroy(&pass->places);
    *pass = (pass_ssao){0};
}

static void fill(const pass_ssao *pass, const screen_pass *step, GLuint frame,
                 const camera_view *view, const gl_targets *t)
{
    screen_pass_bind(step, t, frame);
    camera_view_bind(view);
    glUniform1f(UNIFORM_SSAO_RADIUS, pass->radius);
    glBindTextureUnit(TEXTURE_PICTURE, pass->seen);
    glBindTextureUnit(TEXTURE_SSAO, pass->noisy);
    screen_pass_draw();
}

void pass_ssao_draw(const pass_ssao *pass, const gl_scene *scene, const camera_view *view,
                    const gl_targets *t)
{
    pass_surfaces_draw_opaque(&pass->places, scene, NULL, view, t);
    glCopyImageSubData(t->opaque_light, GL_TEXTURE_2D, 0, 0, 0, 0, pass->seen, GL_TEXTURE_2D, 0, 0,
                       0, 0, (GLsizei)t->width, (GLsizei)t->height, 1);
    fill(pass, &pass->occlude, pass->noisy_frame, view, t);
    fill(pass, &pass->blur, pass->frame, view, t);
}
