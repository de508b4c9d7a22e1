// SPDX-License-Identifier: MIT
#include "pass_film.h"

#include "gl_program.h"
#include "options/options.h"
#include "shader_list.h"
#include "shaders/bindings.h"

int pass_film_create(pass_film *pass)
{
    *pass = (pass_film){.program = gl_program_create(&shader_screen_vert, &shader_film_frag)};
    glCreateVertexArrays(1, &pass->array);
    return pass->program != 0 ? EXIT_DONE : EXIT_FAILED;
}

void pass_film_destroy(pass_film *pass)
{
    if (pass->array != 0) {
        glDeleteProgram(pass->program);
        glDeleteVertexArrays(1, &pass->array);
    }
    *pass = (pass_film){0};
}

void pass_film_draw(const pass_film *pass, const alp_film_options *film,
                    const alp_film_numbers *numbers, const gl_targets *t)
{
    GLfloat balance[9]; // row by row
    for (int i = 0; i < 9; i++) {
        balance[i] = (GLfloat)numbers->balance[i / 3][i % 3];
    }
    gl_targets_bind(t, t->developed_frame);
    glDisable(GL_DEPTH_TEST);
    glUseProgram(pass->program);
    glBindVertexArray(pass->array);
    glBindTextureUnit(TEXTURE_PICTURE, t->light);
    glUniform1f(UNIFORM_GAIN, (GLfloat)numbers->gain);
    glUniform1i(UNIFORM_TONE, (GLint)film->tone);
    glUniform1f(UNIFORM_WHITE, (GLfloat)numbers->white);
    glUniformMatrix3fv(UNIFORM_BALANCE, 1, GL_TRUE, balance);
    glUniform1i(UNIFORM_DITHER, film->dither == ALP_DITHER_HASHED);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}
