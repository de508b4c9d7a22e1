// SPDX-License-Identifier: MIT
#include "gl/gl_scene.h"

#include "gl/gl_buffer.h"
#include "gl/gl_textures.h"
#include "options/options.h"
#include "printing/messages.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/// shaders/materials.glsl, std430.
typedef struct shader_material {
    float base_color[4];
    float emission[4]; // rgb, alpha cutoff
    float metallic, transmission;
    uint32_t alpha_mode, flags;
    float normal_scale;
    uint32_t slots[TEXTURE_USES], unused[2];
    float rows[2 * TEXTURE_USES][4];
} shader_material;
_Static_assert(sizeof(shader_material) == (4 + 4 + 2 + 2 + 1 + 5 + 2 + 40) * 4,
               "std430 has no holes here");

_Static_assert(ALP_ALPHA_OPAQUE == ALPHA_OPAQUE && ALP_ALPHA_MASK == ALPHA_MASK &&
                   ALP_ALPHA_BLEND == ALPHA_BLEND,
               "shaders know the library's numbers");

// --- geometry ------------------------------------------------------------------------------------

static int load_buffer(const void *data, size_t size, GLuint *buffer)
{
    return gl_buffer_load("the scene", data, size, buffer);
}

/// Slots in use, in a row. @param places out: place of each slot, or NO_SLOT
static int load_uvs(gl_scene *d, const alp_geometry *g, uint32_t places[ALP_UV_SETS])
{
    const size_t slot_size = (size_t)g->vertex_count * sizeof *g->uvs[0];
    uint32_t used = 0;
    for (int i = 0; i < ALP_UV_SETS; i++) {
        places[i] = g->uvs[i] != NULL ? used++ : NO_SLOT;
    }
    unsigned char *packed = allocate_or_exit(NULL, used * slot_size + 1);
    for (int i = 0; i < ALP_UV_SETS; i++) {
        if (g->uvs[i] != NULL) {
            memcpy(packed + places[i] * slot_size, g->uvs[i], slot_size);
        }
    }
    const int code = load_buffer(packed, used * slot_size, &d->buffers[BUFFER_UVS]);
    free(packed);
    return code;
}

/// Triangles that are not usable become points, which cover no pixel.
static int load_triangles(gl_scene *d, const alp_geometry *g)
{
    const size_t size = (size_t)g->triangle_count * sizeof *g->triangles;
    uint32_t(*triangles)[3] = allocate_or_exit(NULL, size + 1);
    for (uint32_t t = 0; t < g->triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            triangles[t][k] = g->triangles[t][g->triangle_usable[t] ? k : 0];
        }
    }
    const int code = load_buffer(triangles, size, &d->buffers[BUFFER_TRIANGLES]);
    free(triangles);
    return code;
}

/// All that a pose moves, but tangents. The order of corners may change too.
static int load_places(gl_scene *d, const alp_geometry *g)
{
    const size_t count = g->vertex_count;
    int code =
        load_buffer(g->positions, count * sizeof *g->positions, &d->buffers[BUFFER_POSITIONS]);
    if (code == EXIT_DONE) {
        code = load_buffer(g->normals, count * sizeof *g->normals, &d->buffers[BUFFER_NORMALS]);
    }
    return code == EXIT_DONE ? load_triangles(d, g) : code;
}

static int load_geometry(gl_scene *d, const alp_geometry *g, uint32_t places[ALP_UV_SETS])
{
    if (g->triangle_count > INT_MAX / 3) {
        return failure("the scene has too many triangles to draw, need 715827882 or fewer");
    }
    const size_t count = g->vertex_count;
    d->vertex_count = g->vertex_count;
    d->colored = g->colors != NULL;
    int code = load_places(d, g);
    if (code == EXIT_DONE) {
        code = load_buffer(g->colors, d->colored ? count * sizeof *g->colors : 0,
                           &d->buffers[BUFFER_COLORS]);
    }
    return code == EXIT_DONE ? load_uvs(d, g, places) : code;
}

static int load_tangents(gl_scene *d, const alp_scene *scene, const alp_geometry *g)
{
    const size_t count = d->normal_maps ? g->vertex_count : 0;
    float(*tangents)[4] = allocate_or_exit(NULL, count * sizeof *tangents + 1);
    if (count > 0 && alp_scene_make_tangents(scene, tangents) != ALP_OK) {
        free(tangents);
        return failure("the scene has no tangents");
    }
    const int code = load_buffer(tangents, count * sizeof *tangents, &d->tangents);
    free(tangents);
    return code;
}

static void list_surfaces(const alp_scene *scene, const alp_scene_info *info, gl_scene *d)
{
    d->surface_count = info->surfaces;
    d->surfaces = allocate_or_exit(d->surfaces, info->surfaces * sizeof *d->surfaces + 1);
    for (uint32_t i = 0; i < info->surfaces; i++) {
        const alp_surface_info s = alp_scene_get_surface(scene, i);
        const alp_material_info m = alp_scene_get_material(scene, s.material_index);
        d->surfaces[i] = (gl_surface){
            .first = (GLint)(3 * s.first_triangle),
            .corners = (GLsizei)(3 * s.triangle_count),
            .material = s.material_index == ALP_NONE ? info->materials : s.material_index,
            .pane = m.alpha_mode == ALP_ALPHA_BLEND || m.transmission > 0.0f};
        memcpy(d->surfaces[i].axes, s.axes, sizeof s.axes);
        d->has_panes = d->has_panes || d->surfaces[i].pane;
    }
}

// --- materials -----------------------------------------------------------------------------------

static GLuint texture_of(gl_scene *d, const alp_scene *scene, uint32_t index, bool srgb, int *code)
{
    const alp_image *image = alp_scene_get_image(scene, index);
    if (image == NULL) {
        return d->white;
    }
    GLuint *texture = &d->textures[index][srgb];
    if (*texture == 0 && *code == EXIT_DONE) {
        *code = gl_texture_create(image, srgb, texture);
    }
    return *texture;
}

static int load_material(gl_scene *d, const alp_scene *scene, uint32_t index,
                         const uint32_t places[ALP_UV_SETS], shader_material *out)
{
    const alp_material_info m = alp_scene_get_material(scene, index);
    const alp_texture_info *const uses[TEXTURE_USES] = {
        [TEXTURE_BASE_COLOR] = &m.base_color_texture,
        [TEXTURE_METALLIC] = &m.metallic_texture,
        [TEXTURE_EMISSION] = &m.emission_texture,
        [TEXTURE_TRANSMISSION] = &m.transmission_texture,
        [TEXTURE_NORMAL] = &m.normal_texture};
    const bool mapped = d->normal_maps && m.normal_texture.image != ALP_NONE &&
                        alp_scene_get_image(scene, m.normal_texture.image) != NULL;
    int code = EXIT_DONE;
    *out =
        (shader_material){.emission = {m.emission[0], m.emission[1], m.emission[2], m.alpha_cutoff},
                          .metallic = m.metallic,
                          .transmission = m.transmission,
                          .alpha_mode = (uint32_t)m.alpha_mode,
                          .flags = (m.double_sided ? MATERIAL_DOUBLE_SIDED : 0u) |
                                   (index < d->material_count ? MATERIAL_EXISTS : 0u) |
                                   (mapped ? MATERIAL_NORMAL_MAP : 0u),
                          .normal_scale = m.normal_scale};
    memcpy(out->base_color, m.base_color, sizeof out->base_color);
    for (int i = 0; i < TEXTURE_USES; i++) {
        const alp_texture_info *t = uses[i];
        const bool srgb = i == TEXTURE_BASE_COLOR || i == TEXTURE_EMISSION;
        out->slots[i] = t->uv_slot < ALP_UV_SETS ? places[t->uv_slot] : NO_SLOT;
        memcpy(out->rows[2 * i], t->transform[0], sizeof t->transform[0]);
        memcpy(out->rows[2 * i + 1], t->transform[1], sizeof t->transform[1]);
        d->materials[index].uses[i].texture =
            i == TEXTURE_NORMAL && !mapped ? d->white : texture_of(d, scene, t->image, srgb, &code);
        d->materials[index].uses[i].sampler = d->samplers[3 * (int)t->wrap_u + (int)t->wrap_v];
    }
    return code;
}

static int load_materials(gl_scene *d, const alp_scene *scene, const alp_scene_info *info,
                          const uint32_t places[ALP_UV_SETS])
{
    const size_t count = (size_t)info->materials + 1;
    shader_material *list = allocate_or_exit(NULL, count * sizeof *list);
    d->material_count = info->materials;
    d->image_count = info->images;
    d->materials = allocate_or_exit(NULL, count * sizeof *d->materials);
    d->textures = allocate_or_exit(NULL, info->images * sizeof *d->textures + 1);
    memset(d->textures, 0, info->images * sizeof *d->textures);
    int code = EXIT_DONE;
    for (uint32_t i = 0; i < count && code == EXIT_DONE; i++) {
        code = load_material(d, scene, i, places, &list[i]);
    }
    if (code == EXIT_DONE) {
        code = load_buffer(list, count * sizeof *list, &d->buffers[BUFFER_MATERIALS]);
    }
    free(list);
    return code;
}

// --- the whole -----------------------------------------------------------------------------------

int gl_scene_create(const alp_scene *scene, bool level_zero, bool normal_maps, gl_scene *d)
{
    *d = (gl_scene){.normal_maps = normal_maps};
    const alp_geometry geometry = alp_scene_get_geometry(scene);
    const alp_scene_info info = alp_scene_get_info(scene);
    uint32_t places[ALP_UV_SETS];
    glCreateVertexArrays(1, &d->array);
    gl_samplers_create(level_zero, d->samplers);
    d->white = gl_texture_white();
    int code = load_geometry(d, &geometry, places);
    code = code == EXIT_DONE ? load_tangents(d, scene, &geometry) : code;
    if (code != EXIT_DONE) {
        return code;
    }
    list_surfaces(scene, &info, d);
    return load_materials(d, scene, &info, places);
}

int gl_scene_move(const alp_scene *posed, gl_scene *d)
{
    static const int moved[] = {BUFFER_POSITIONS, BUFFER_NORMALS, BUFFER_TRIANGLES};
    const alp_geometry geometry = alp_scene_get_geometry(posed);
    const alp_scene_info info = alp_scene_get_info(posed);
    for (size_t i = 0; i < sizeof moved / sizeof *moved; i++) {
        glDeleteBuffers(1, &d->buffers[moved[i]]);
        d->buffers[moved[i]] = 0;
    }
    glDeleteBuffers(1, &d->tangents);
    d->tangents = 0;
    list_surfaces(posed, &info, d);
    const int code = load_places(d, &geometry);
    return code == EXIT_DONE ? load_tangents(d, posed, &geometry) : code;
}

void gl_scene_destroy(gl_scene *d)
{
    if (d->array == 0) { // there may be no context either
        return;
    }
    for (uint32_t i = 0; i < d->image_count && d->textures != NULL; i++) {
        glDeleteTextures(GL_ENCODINGS, d->textures[i]); // leaves out 0
    }
    glDeleteTextures(1, &d->white);
    glDeleteSamplers(GL_WRAPS, d->samplers);
    glDeleteBuffers(GL_SCENE_BUFFERS, d->buffers);
    glDeleteBuffers(1, &d->tangents);
    glDeleteVertexArrays(1, &d->array);
    free(d->textures);
    free(d->materials);
    free(d->surfaces);
    *d = (gl_scene){0};
}

void gl_scene_bind(const gl_scene *d)
{
    glBindVertexArray(d->array);
    glBindBuffersBase(GL_SHADER_STORAGE_BUFFER, 0, GL_SCENE_BUFFERS, d->buffers);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, BUFFER_TANGENTS, d->tangents);
}

static void draw_surface(const gl_scene *scene, const gl_surface *s)
{
    const gl_material *material = &scene->materials[s->material];
    for (GLuint i = 0; i < TEXTURE_USES; i++) {
        glBindTextureUnit(i, material->uses[i].texture);
        glBindSampler(i, material->uses[i].sampler);
    }
    glUniform1ui(UNIFORM_MATERIAL, s->material);
    glUniform1ui(UNIFORM_SURFACE, (GLuint)(s - scene->surfaces));
    glUniform3fv(UNIFORM_AXES, 3, &s->axes[0][0]);
    glDrawArrays(GL_TRIANGLES, s->first, s->corners);
}

void gl_scene_draw(const gl_scene *d, gl_scene_part part)
{
    glUniform1ui(UNIFORM_VERTICES, d->vertex_count);
    glUniform1i(UNIFORM_COLORED, d->colored);
    glUniform1ui(UNIFORM_FIRST_TRIANGLE, d->first_triangle);
    for (uint32_t i = 0; i < d->surface_count; i++) {
        const gl_surface *s = &d->surfaces[i];
        if (part == GL_SCENE_ALL || s->pane == (part == GL_SCENE_PANES)) {
            draw_surface(d, s);
        }
    }
    for (GLuint i = 0; i < TEXTURE_USES; i++) {
        glBindSampler(i, 0);
    }
}
