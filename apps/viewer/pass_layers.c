// SPDX-License-Identifier: MIT
#include "pass_layers.h"

#include "options/options.h"
#include "shader_list.h"
#include "shaders/bindings.h"

int pass_layers_create(pass_layers *pass)
{
    *pass = (pass_layers){.program = gl_program_create(&shader_screen_vert, &shader_layer_frag)};
    glCreateVertexArrays(1, &pass->array);
    return pass->program != 0 ? EXIT_DONE : EXIT_FAILED;
}

void pass_layers_destroy(pass_layers *pass)
{
    if (pass->array != 0) {
        glDeleteProgram(pass->program);
        glDeleteVertexArrays(1, &pass->array);
    }
    *pass = (pass_layers){0};
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
    gl_targets_bind(t, t->sum_frames[1 - before]);
    glDisable(GL_DEPTH_TEST);
    glEnablei(GL_BLEND, 0);
    glBlendFunc(GL_ONE, GL_ONE);
    glUseProgram(pass->program);
    glBindVertexArray(pass->array);
    glBindTextureUnit(TEXTURE_PICTURE, light);
    glBindTextureUnit(TEXTURE_THROUGH, through);
    glBindTextureUnit(TEXTURE_LEFT, t->lefts[before]);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisablei(GL_BLEND, 0);
}
