// SPDX-License-Identifier: MIT
#include "passes/screen_pass.h"

#include "options/options.h"
#include "passes/shader_list.h"

int screen_pass_create(const gl_shader *fragment, screen_pass *pass)
{
    *pass = (screen_pass){.program = gl_program_create(&shader_screen_vert, fragment)};
    glCreateVertexArrays(1, &pass->array);
    return pass->program != 0 ? EXIT_DONE : EXIT_FAILED;
}

void screen_pass_destroy(screen_pass *pass)
{
    if (pass->array != 0) { // else there may be no context either
        glDeleteProgram(pass->program);
        glDeleteVertexArrays(1, &pass->array);
    }
    *pass = (screen_pass){0};
}

void screen_pass_bind(const screen_pass *pass, const gl_targets *t, GLuint frame)
{
    gl_targets_bind(t, frame);
    glDisable(GL_DEPTH_TEST);
    glUseProgram(pass->program);
    glBindVertexArray(pass->array);
}

void screen_pass_draw(void)
{
    glDrawArrays(GL_TRIANGLES, 0, 3);
}
