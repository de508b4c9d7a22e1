// SPDX-License-Identifier: MIT
#include "pass_air.h"

#include "options/options.h"
#include "shader_list.h"
#include "shaders/bindings.h"

int pass_air_create(pass_air *pass)
{
    *pass = (pass_air){.program = gl_program_create(&shader_screen_vert, &shader_air_frag)};
    glCreateVertexArrays(1, &pass->array);
    return pass->program != 0 ? EXIT_DONE : EXIT_FAILED;
}

void pass_air_destroy(pass_air *pass)
{
    if (pass->array != 0) {
        glDeleteProgram(pass->program);
        glDeleteVertexArrays(1, &pass->array);
    }
    *pass = (pass_air){0};
}

void pass_air_draw(const pass_air *pass, const mist *m, const camera_view *view,
                   const gl_targets *t, GLuint before, GLuint end, uint32_t step)
{
    gl_targets_bind(t, t->sum_frames[1 - step % 2]);
    glDisable(GL_DEPTH_TEST);
    glEnablei(GL_BLEND, 0);
    glBlendFunc(GL_ONE, GL_ONE);
    glUseProgram(pass->program);
    glBindVertexArray(pass->array);
    camera_view_bind(view);
    gl_lights_bind(m->lights);
    gl_lpv_bind(m->volume);
    glUniform1f(UNIFORM_AIR_SCATTERING, m->scattering);
    glUniform3fv(UNIFORM_AIR_LOW, 1, m->info->bounds_min);
    glUniform3fv(UNIFORM_AIR_HIGH, 1, m->info->bounds_max);
    glUniform1i(UNIFORM_PEELED, before != 0 ? PEEL_BEHIND : 0);
    glBindTextureUnit(TEXTURE_DEPTH, before);
    glBindTextureUnit(TEXTURE_LAYER_DEPTH, end);
    glBindTextureUnit(TEXTURE_OPAQUE_DEPTH, t->opaque_depth);
    glBindTextureUnit(TEXTURE_LEFT, t->lefts[step % 2]);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisablei(GL_BLEND, 0);
}
