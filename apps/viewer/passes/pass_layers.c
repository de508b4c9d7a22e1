// SPDX-License-Identifier: MIT
#include "passes/pass_layers.h"

#include "passes/shader_list.h"
#include "shaders/bindings.h"

int pass_layers_create(pass_layers *pass)
{
    *pass = (pass_layers){0};
    return screen_pass_create(&shader_layer_frag, &pass->screen);
}

void pass_layers_destroy(pass_layers *pass)
{
    screen_pass_destroy(&pass->screen);
}

void pass_layers_clear(const gl_targets *t)
{
    static const GLfloat black[4], open[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    glClearNamedFramebufferfv(t->sum_frames[0], GL_COLOR, 0, black);
    glClearNamedFramebufferfv(t->sum_frames[0], GL_COLOR, 1, open);
}

void pass_layers_add(const pass_layers *pass, const gl_targets *t, GLuint light, GLuint through,
                     uint32_t step)
{
    const int before = (int)(step % 2);
    screen_pass_bind(&pass->screen, t, t->sum_frames[1 - before]);
    glEnablei(GL_BLEND, 0);
    glBlendFunc(GL_ONE, GL_ONE);
    glBindTextureUnit(TEXTURE_PICTURE, light);
    glBindTextureUnit(TEXTURE_THROUGH, through);
    glBindTextureUnit(TEXTURE_LEFT, t->lefts[before]);
    screen_pass_draw();
    glDisablei(GL_BLEND, 0);
}
