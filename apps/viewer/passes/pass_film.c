// SPDX-License-Identifier: MIT
#include "passes/pass_film.h"

#include "passes/shader_list.h"
#include "shaders/bindings.h"

int pass_film_create(pass_film *pass)
{
    *pass = (pass_film){0};
    return screen_pass_create(&shader_film_frag, &pass->screen);
}

void pass_film_destroy(pass_film *pass)
{
    screen_pass_destroy(&pass->screen);
}

void pass_film_draw(const pass_film *pass, const alp_film_options *film,
                    const alp_film_numbers *numbers, const gl_targets *t)
{
    GLfloat balance[9]; // row by row
    for (int i = 0; i < 9; i++) {
        balance[i] = (GLfloat)numbers->balance[i / 3][i % 3];
    }
    screen_pass_bind(&pass->screen, t, t->developed_frame);
    glBindTextureUnit(TEXTURE_PICTURE, t->light);
    glUniform1f(UNIFORM_GAIN, (GLfloat)numbers->gain);
    glUniform1i(UNIFORM_TONE, (GLint)film->tone);
    glUniform1f(UNIFORM_WHITE, (GLfloat)numbers->white);
    glUniformMatrix3fv(UNIFORM_BALANCE, 1, GL_TRUE, balance);
    glUniform1i(UNIFORM_DITHER, film->dither == ALP_DITHER_HASHED);
    screen_pass_draw();
}
