// SPDX-License-Identifier: MIT
#include "gl/gl_lightmap.h"

#include "gl/gl_buffer.h"
#include "options/options.h"
#include "printing/messages.h"
#include "shaders/bindings.h"

#include <stdlib.h>

enum { CORNERS = 3, SETS = 3, COEFFICIENTS = 4 };

static int load_pages(const alp_lightmap *lightmap, alp_map map, gl_lightmap *d)
{
    uint32_t width = 0, height = 0;
    const uint32_t count =
        alp_lightmap_page_count(lightmap) * (map == ALP_MAP_SH ? COEFFICIENTS : 1);
    d->page_count = alp_lightmap_page_count(lightmap);
    GLint layers = 0, side = 0;
    alp_lightmap_map_page(lightmap, map, 0, &width, &height);
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &layers);
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &side);
    if (count > (uint32_t)layers || width > (uint32_t)side || height > (uint32_t)side) {
        char text[192];
        snprintf(text, sizeof text,
                 "the light map has %u pages of %u x %u texels, and the graphics card takes %d of "
                 "%d x %d",
                 count, width, height, layers, side, side);
        return failure(text);
    }
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &d->pages);
    glTextureStorage3D(d->pages, 1, GL_RGBA32F, (GLsizei)width, (GLsizei)height, (GLsizei)count);
    for (uint32_t p = 0; p < count; p++) {
        const uint32_t page = p % d->page_count, coefficient = p / d->page_count;
        const float *texels = map == ALP_MAP_SH
                                  ? alp_lightmap_sh_page(lightmap, coefficient, page, NULL, NULL)
                                  : alp_lightmap_map_page(lightmap, map, page, NULL, NULL);
        glTextureSubImage3D(d->pages, 0, 0, 0, (GLint)p, (GLsizei)width, (GLsizei)height, 1,
                            GL_RGBA, GL_FLOAT, texels);
    }
    return EXIT_DONE;
}

/// The sets that a triangle has a chart in, bit by bit. In others it has the coordinates of its
/// strongest axis. A triangle without area is in none, and all sets are alike.
/// @param strongest [corner][2]   @param sets [set][corner][2]
static GLuint sets_of(const float *strongest, const float *sets)
{
    const size_t corners = (size_t)2 * CORNERS;
    GLuint members = 0;
    bool found = false; // the strongest itself, or one that is like it
    for (GLuint k = 0; k < SETS; k++) {
        bool same = true;
        for (size_t i = 0; i < corners; i++) {
            same = same && sets[k * corners + i] == strongest[i];
        }
        members |= same && found ? 0u : 1u << k;
        found = found || same;
    }
    return members;
}

static int load_triangles(const alp_scene *scene, const alp_atlas *atlas, gl_lightmap *d)
{
    const size_t count = alp_scene_get_info(scene).triangles;
    const uint32_t *pages = alp_atlas_triangle_pages(atlas);
    const float *strongest = alp_atlas_corner_uvs(atlas), *blended = alp_atlas_blend_uvs(atlas);
    const size_t corners = (size_t)2 * CORNERS;
    GLuint *entries = allocate_or_exit(NULL, count * sizeof *entries + 1);
    for (size_t t = 0; t < count; t++) {
        const GLuint sets =
            blended == NULL ? 1u : sets_of(strongest + t * corners, blended + t * SETS * corners);
        entries[t] = pages[t] == UINT32_MAX ? MAP_NONE : pages[t] | sets << MAP_SETS_SHIFT;
    }
    d->sets = blended != NULL ? SETS : 1;
    int code = gl_buffer_load("the light map", blended != NULL ? blended : strongest,
                              count * d->sets * corners * sizeof *strongest, &d->uvs);
    if (code == EXIT_DONE) {
        code = gl_buffer_load("the light map", entries, count * sizeof *entries, &d->triangles);
    }
    free(entries);
    return code;
}

int gl_lightmap_create(const alp_scene *scene, const alp_lightmap *lightmap, alp_map map,
                       alp_blend blend, gl_lightmap *d)
{
    *d = (gl_lightmap){.equal = blend == ALP_BLEND_AVERAGE};
    const int code = load_pages(lightmap, map, d);
    return code == EXIT_DONE ? load_triangles(scene, alp_lightmap_atlas(lightmap), d) : code;
}

void gl_lightmap_destroy(gl_lightmap *d)
{
    if (d->pages != 0) { // else there may be no context either
        glDeleteTextures(1, &d->pages);
        glDeleteBuffers(1, &d->uvs);
        glDeleteBuffers(1, &d->triangles);
    }
    *d = (gl_lightmap){0};
}

void gl_lightmap_bind(const gl_lightmap *d)
{
    glBindTextureUnit(TEXTURE_LIGHTMAP, d->pages);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BUFFER_MAP_UVS, d->uvs);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BUFFER_MAP_TRIANGLES, d->triangles);
    glUniform1ui(UNIFORM_MAP_SETS, d->sets);
    glUniform1ui(UNIFORM_MAP_PAGES, d->page_count);
    glUniform1i(UNIFORM_MAP_EQUAL, d->equal);
}
