// SPDX-License-Identifier: MIT
#include "passes/pass_air.h"

#include "passes/shader_list.h"
#include "shaders/bindings.h"

int pass_air_create(screen_pass *pass)
{
    return screen_pass_create(&shader_air_frag, pass);
}

void pass_air_draw(const screen_pass *pass, const mist *m, const camera_view *view,
                   const gl_targets *t, GLuint before, GLuint end, uint32_t step)
{
    screen_pass_bind(pass, t, t->sum_frames[1 - step % 2]);
    glEnablei(GL_BLEND, 0);
    glBlendFunc(GL_ONE, GL_ONE);
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
    screen_pass_draw();
    glDisablei(GL_BLEND, 0);
}
