// SPDX-License-Identifier: MIT
#include "gl/gl_probes.h"

#include "printing/messages.h"
#include "shaders/bindings.h"

#include <stdlib.h>
#include <string.h>

// Coefficients, and 7 texels of RGBA that hold them and nothing else; then one with move and state.
enum { COEFFICIENTS = 9, CHANNELS = 3, SLABS = 8, SIDE = 8 };

bool gl_probes_can_read(const alp_probes *probes)
{
    const alp_probes_info info = alp_probes_get_info(probes);
    GLint most = 0;
    glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &most);
    const uint32_t limit = (uint32_t)most;
    return !info.is_list && !info.gradients && info.basis != ALP_PROBE_AMBIENT_CUBE &&
           info.size[0] <= limit / SIDE && info.size[1] <= limit / SIDE &&
           info.size[2] <= limit / SLABS;
}

/// Coefficients in seven texels, and the move from the lattice with the state in the eighth. Slabs
/// of a texel lie one behind the other. The second band of nine is 0 where probes have four.
static void fill_light(const alp_probes *probes, const alp_probes_info *info, float (*texels)[4])
{
    const float *from = alp_probes_coefficients(probes, UINT32_MAX);
    const uint8_t *states = alp_probes_states(probes);
    const size_t values = (size_t)CHANNELS * info->coefficients;
    for (uint32_t p = 0; p < info->count; p++) {
        float own[SLABS * 4] = {0.0f};
        double place[3];
        memcpy(own, from + p * values, values * sizeof *own);
        const uint32_t at[3] = {p % info->size[0], p / info->size[0] % info->size[1],
                                p / info->size[0] / info->size[1]};
        alp_probes_position(probes, p, place);
        for (int k = 0; k < 3; k++) {
            const double regular = info->origin[k] + (double)info->spacing[k] * at[k];
            own[(SLABS - 1) * 4 + k] = (float)(place[k] - regular);
        }
        own[SLABS * 4 - 1] = (float)states[p];
        for (size_t s = 0; s < SLABS; s++) {
            memcpy(texels[s * info->count + p], own + 4 * s, sizeof *texels);
        }
    }
}

/// Tiles of 8 × 8 texels, one a probe.
static void fill_moments(const float *moments, const alp_probes_info *info, float (*texels)[2])
{
    const size_t width = (size_t)SIDE * info->size[0], height = (size_t)SIDE * info->size[1];
    for (size_t p = 0; p < info->count; p++) {
        const size_t x = SIDE * (p % info->size[0]), y = SIDE * (p / info->size[0] % info->size[1]);
        const size_t z = p / info->size[0] / info->size[1];
        for (size_t row = 0; row < SIDE; row++) {
            memcpy(texels[(z * height + y + row) * width + x],
                   moments + 2 * (p * SIDE * SIDE + row * SIDE), SIDE * sizeof *texels);
        }
    }
}

static GLuint make_texture(GLenum format, const GLint size[3])
{
    GLuint texture = 0;
    glCreateTextures(GL_TEXTURE_3D, 1, &texture);
    glTextureStorage3D(texture, 1, format, size[0], size[1], size[2]);
    glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    return texture;
}

void gl_probes_create(const alp_probes *probes, const double origin[3], gl_probes *d)
{
    const alp_probes_info info = alp_probes_get_info(probes);
    const float *moments = alp_probes_moments(probes);
    const size_t count = info.count;
    *d = (gl_probes){.visible = moments != NULL};
    for (int k = 0; k < 3; k++) {
        d->size[k] = (GLint)info.size[k];
        d->origin[k] = (float)(info.origin[k] - origin[k]);
        d->spacing[k] = info.spacing[k];
    }
    const GLint light[3] = {d->size[0], d->size[1], SLABS * d->size[2]};
    float(*texels)[4] = allocate_or_exit(NULL, count * SLABS * sizeof *texels);
    fill_light(probes, &info, texels);
    d->light = make_texture(GL_RGBA32F, light);
    glTextureSubImage3D(d->light, 0, 0, 0, 0, light[0], light[1], light[2], GL_RGBA, GL_FLOAT,
                        texels);
    free(texels);
    if (moments != NULL) {
        const GLint tiles[3] = {SIDE * d->size[0], SIDE * d->size[1], d->size[2]};
        float(*distances)[2] = allocate_or_exit(NULL, count * SIDE * SIDE * sizeof *distances);
        fill_moments(moments, &info, distances);
        d->moments = make_texture(GL_RG32F, tiles);
        glTextureSubImage3D(d->moments, 0, 0, 0, 0, tiles[0], tiles[1], tiles[2], GL_RG, GL_FLOAT,
                            distances);
        free(distances);
    }
}

void gl_probes_destroy(gl_probes *d)
{
    if (d->light != 0) {
        glDeleteTextures(1, &d->light);
        glDeleteTextures(1, &d->moments);
    }
    *d = (gl_probes){0};
}

void gl_probes_bind(const gl_probes *d, GLuint program)
{
    glUniform1i(glGetUniformLocation(program, "alpenglowProbeLight"), TEXTURE_PROBE_LIGHT);
    glUniform1i(glGetUniformLocation(program, "alpenglowProbeMoments"), TEXTURE_PROBE_MOMENTS);
    if (d->light == 0) {
        return;
    }
    glBindTextureUnit(TEXTURE_PROBE_LIGHT, d->light);
    glBindTextureUnit(TEXTURE_PROBE_MOMENTS, d->moments);
    glUniform3iv(glGetUniformLocation(program, "alpenglowProbeSize"), 1, d->size);
    glUniform3fv(glGetUniformLocation(program, "alpenglowProbeOrigin"), 1, d->origin);
    glUniform3fv(glGetUniformLocation(program, "alpenglowProbeSpacing"), 1, d->spacing);
    glUniform1f(glGetUniformLocation(program, "alpenglowProbeScale"), 1.0f);
    // The texture holds metres, not shares of the reach.
    glUniform1f(glGetUniformLocation(program, "alpenglowProbeReach"), d->visible ? 1.0f : 0.0f);
}
