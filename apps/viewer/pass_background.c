// SPDX-License-Identifier: MIT
#include "pass_background.h"

#include "gl_program.h"
#include "messages.h"
#include "options/options.h"
#include "shader_list.h"
#include "shaders/bindings.h"

int pass_background_create(const alp_lighting_options *lighting, pass_background *pass)
{
    const alp_sky_options *sky = &lighting->sky;
    *pass = (pass_background){0};
    if (sky->kind == ALP_SKY_NONE) {
        return EXIT_DONE;
    }
    if (sky->kind != ALP_SKY_CONSTANT && sky->kind != ALP_SKY_HEMISPHERE) {
        return failure("view draws no image of a sky and no clear sky yet; give --sky R,G,B or "
                       "R,G,B/R,G,B");
    }
    pass->kind = SKY_COLORS;
    for (int k = 0; k < 3; k++) {
        pass->up[k] = sky->strength * sky->up[k];
        pass->down[k] = sky->kind == ALP_SKY_CONSTANT ? pass->up[k] : sky->strength * sky->down[k];
    }
    pass->program = gl_program_create(&shader_screen_vert, &shader_background_frag);
    return pass->program != 0 ? EXIT_DONE : EXIT_FAILED;
}

void pass_background_destroy(pass_background *pass)
{
    glDeleteProgram(pass->program);
    *pass = (pass_background){0};
}

void pass_background_draw(const pass_background *pass, const camera_view *view)
{
    if (pass->program == 0) {
        return;
    }
    glUseProgram(pass->program);
    camera_view_bind(view);
    glUniform1i(UNIFORM_SKY_KIND, pass->kind);
    glUniform3fv(UNIFORM_SKY_UP, 1, pass->up);
    glUniform3fv(UNIFORM_SKY_DOWN, 1, pass->down);
    glDepthFunc(GL_EQUAL); // the depth of nothing
    glDrawArrays(GL_TRIANGLES, 0, 3);
}
