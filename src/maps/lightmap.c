// SPDX-License-Identifier: MIT
#include "maps/lightmap.h"

#include "atlas/blend.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

static void release_pages(const alp_lightmap *lightmap, float **pages)
{
    for (uint32_t p = 0; pages != NULL && p < lightmap->page_count; p++) {
        alpi_release(lightmap->context, pages[p]);
    }
    alpi_release(lightmap->context, pages);
}

void alp_lightmap_destroy(alp_lightmap *lightmap)
{
    if (lightmap == NULL) {
        return;
    }
    alp_context *context = lightmap->context;
    release_pages(lightmap, lightmap->pages);
    release_pages(lightmap, lightmap->bent_pages);
    release_pages(lightmap, lightmap->obscurance_pages);
    release_pages(lightmap, lightmap->irradiance_pages);
    release_pages(lightmap, lightmap->irradiance_error_pages);
    release_pages(lightmap, lightmap->direct_pages);
    release_pages(lightmap, lightmap->bounced_pages);
    for (int i = 0; i < 4; i++) {
        release_pages(lightmap, lightmap->sh_pages[i]);
    }
    release_pages(lightmap, lightmap->direction_pages);
    for (uint32_t i = 0; i < lightmap->layer_count; i++) {
        release_pages(lightmap, lightmap->layer_pages[i]);
        alpi_release(context, lightmap->layer_names[i]);
    }
    alpi_release(context, lightmap->layer_pages);
    alpi_release(context, lightmap->layer_names);
    alpi_release(context, lightmap->vertex_values);
    alpi_release(context, lightmap->errors);
    alpi_release(context, lightmap->states);
    alpi_texels_destroy(context, &lightmap->texels);
    alp_atlas_destroy(lightmap->atlas);
    alpi_release(context, lightmap);
}

/// What there is already after a failure goes with the lightmap.
static alp_result allocate_pages(const alp_lightmap *l, float ***pages)
{
    ALPI_TRY_NEW(l->context, *pages, l->page_count);
    for (uint32_t p = 0; p < l->page_count; p++) {
        ALPI_TRY_NEW(l->context, (*pages)[p], 4 * (size_t)l->width * l->height);
    }
    return ALP_OK;
}

static alp_result allocate(alp_lightmap *l)
{
    ALPI_TRY_NEW(l->context, l->states, l->texels.count);
    memset(l->states, ALPI_TEXEL_TRACED, l->texels.count); // until somebody knows better
    return ALP_OK;
}

alp_result alpi_lightmap_create(alp_atlas *atlas, alp_lightmap **lightmap)
{
    *lightmap = NULL;
    alp_lightmap *l = ALPI_NEW(atlas->context, alp_lightmap, 1);
    if (l == NULL) {
        alp_atlas_destroy(atlas);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    l->context = atlas->context;
    l->scene = atlas->scene;
    l->atlas = atlas;
    l->page_count = atlas->info.pages;
    l->width = atlas->info.width;
    l->height = atlas->info.height;
    alp_result result = alpi_texels_create(atlas, &l->texels);
    if (result == ALP_OK) {
        result = allocate(l);
    }
    if (result != ALP_OK) {
        alp_lightmap_destroy(l);
        return result;
    }
    *lightmap = l;
    return ALP_OK;
}

alp_result alpi_lightmap_create_vertices(const alp_scene *scene, float *values,
                                         alp_lightmap **lightmap)
{
    alp_lightmap *l = ALPI_NEW(scene->context, alp_lightmap, 1);
    *lightmap = l;
    if (l == NULL) {
        alpi_release(scene->context, values);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    l->context = scene->context;
    l->scene = scene;
    l->vertex_values = values;
    return ALP_OK;
}

/// Writes texels of `channels` values each, one or three, and dilates.
static alp_result fill_pages(alp_lightmap *lightmap, const float *values, size_t channels,
                             float **pages)
{
    const alpi_texels *texels = &lightmap->texels;
    for (uint32_t i = 0; i < texels->count; i++) {
        size_t at = (size_t)texels->pixels[i][1] * lightmap->width + texels->pixels[i][0];
        float *pixel = pages[texels->pages[i]] + 4 * at;
        for (size_t k = 0; k < 3; k++) {
            pixel[k] = values[channels * i + (channels == 3 ? k : 0)];
        }
        pixel[3] = lightmap->states[i] != ALPI_TEXEL_OPEN ? 1.0f : 0.0f;
    }
    for (uint32_t p = 0; p < lightmap->page_count; p++) {
        ALP_TRY(alpi_dilate(lightmap->context, pages[p], lightmap->width, lightmap->height));
    }
    return ALP_OK;
}

alp_result alpi_lightmap_store(alp_lightmap *lightmap, const float *values)
{
    if (lightmap->pages == NULL) {
        ALP_TRY(allocate_pages(lightmap, &lightmap->pages));
    }
    return fill_pages(lightmap, values, 1, lightmap->pages);
}

alp_result alpi_lightmap_store_vectors(alp_lightmap *lightmap, const float (*values)[3],
                                       float ***pages)
{
    ALP_TRY(allocate_pages(lightmap, pages));
    return fill_pages(lightmap, (const float *)values, 3, *pages);
}

void alp_lightmap_set_blend(alp_lightmap *lightmap, alp_blend blend)
{
    if (lightmap != NULL) {
        lightmap->blend = blend;
    }
}

bool alpi_lightmap_holds(const alp_lightmap *lightmap, uint32_t triangle)
{
    return lightmap->vertex_values != NULL ||
           lightmap->atlas->triangle_pages[triangle] != ALPI_NONE;
}

/// Bilinear look-up in a page, at coordinates between those of a triangle's corners.
static void sample_page(const alp_lightmap *lightmap, float *page, const float (*uv)[2], float b1,
                        float b2, float rgb[3])
{
    float u = uv[0][0] + b1 * (uv[1][0] - uv[0][0]) + b2 * (uv[2][0] - uv[0][0]);
    float v = uv[0][1] + b1 * (uv[1][1] - uv[0][1]) + b2 * (uv[2][1] - uv[0][1]);
    alp_image view = {.context = lightmap->context,
                      .info = {lightmap->width, lightmap->height, 4, ALP_COMPONENT_FLOAT},
                      .pixels = page};
    float rgba[4];
    alpi_image_sample(&view, u, v,
                      (alpi_sampler){.wrap_u = ALPI_WRAP_CLAMP, .wrap_v = ALPI_WRAP_CLAMP}, rgba);
    memcpy(rgb, rgba, 3 * sizeof *rgb);
}

void alpi_lightmap_shares(const alp_lightmap *lightmap, uint32_t triangle, float b1, float b2,
                          float weights[3])
{
    if (lightmap->atlas->set_uvs == NULL) {
        weights[0] = 1.0f;
        weights[1] = weights[2] = 0.0f;
        return;
    }
    if (lightmap->blend == ALP_BLEND_NORMAL) {
        alpi_blend_weights(lightmap->atlas, triangle, b1, b2, weights);
        return;
    }
    const uint8_t members = lightmap->atlas->set_members[triangle];
    const int count = __builtin_popcount(members);
    for (int k = 0; k < 3; k++) { // a triangle without area is in none: all sets are alike
        weights[k] = count == 0                 ? 1.0f / 3.0f
                     : (members >> k & 1u) != 0 ? 1.0f / (float)count
                                                : 0.0f;
    }
}

/// Look-up in some pages.
static void sample_pages(const alp_lightmap *lightmap, float *const *pages, uint32_t triangle,
                         float b1, float b2, float rgb[3])
{
    const alp_atlas *atlas = lightmap->atlas;
    float *page = pages[atlas->triangle_pages[triangle]];
    if (atlas->set_uvs == NULL) {
        sample_page(lightmap, page, (const float(*)[2])atlas->corner_uvs[triangle], b1, b2, rgb);
        return;
    }
    float weights[3];
    alpi_lightmap_shares(lightmap, triangle, b1, b2, weights);
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    for (int k = 0; k < 3; k++) {
        float value[3];
        sample_page(lightmap, page, (const float(*)[2])atlas->set_uvs[triangle][k], b1, b2, value);
        for (int i = 0; i < 3; i++) {
            rgb[i] += weights[k] * value[i];
        }
    }
}

void alpi_lightmap_sample(const alp_lightmap *lightmap, uint32_t triangle, float b1, float b2,
                          float rgb[3])
{
    if (lightmap->vertex_values != NULL) {
        const uint32_t *corner = lightmap->scene->triangles[triangle];
        const float *values = lightmap->vertex_values;
        rgb[0] = rgb[1] = rgb[2] =
            (1.0f - b1 - b2) * values[corner[0]] + b1 * values[corner[1]] + b2 * values[corner[2]];
        return;
    }
    if (lightmap->pages == NULL) { // nobody asked what is open
        rgb[0] = rgb[1] = rgb[2] = 1.0f;
        return;
    }
    sample_pages(lightmap, lightmap->pages, triangle, b1, b2, rgb);
}

static void reflect(const void *user, const alpi_surface_point *points, uint32_t count,
                    vec3 *radiance)
{
    const alp_lightmap *lightmap = user;
    const alp_scene *scene = lightmap->scene;
    for (uint32_t i = 0; i < count; i++) {
        const alpi_surface_point *p = &points[i];
        float e[3] = {0.0f, 0.0f, 0.0f};
        if (alpi_lightmap_holds(lightmap, p->triangle)) {
            sample_pages(lightmap, lightmap->irradiance_pages, p->triangle, p->b1, p->b2, e);
        }
        const vec3 albedo = alpi_surface_albedo(scene, p->triangle, p->b1, p->b2);
        const float kept = alpi_surface_pane(scene, p->triangle, p->b1, p->b2).kept;
        const float share = kept * (float)(1.0 / ALPI_PI);
        radiance[i] =
            (vec3){share * albedo.x * e[0], share * albedo.y * e[1], share * albedo.z * e[2]};
    }
}

alpi_surface_light alpi_lightmap_light(const alp_lightmap *lightmap)
{
    return (alpi_surface_light){.reflected = reflect, .user = lightmap};
}

alp_result alpi_lightmap_page_image(const alp_lightmap *lightmap, uint32_t page,
                                    alp_component component, alp_image **image)
{
    bool bytes = component == ALP_COMPONENT_U8;
    alp_image_info info = {lightmap->width, lightmap->height, bytes ? 1 : 4, component};
    ALP_TRY(alp_image_create(lightmap->context, info, image));
    size_t count = (size_t)info.width * info.height;
    const float *source = lightmap->pages[page];
    if (!bytes) {
        memcpy((*image)->pixels, source, 4 * count * sizeof *source);
        return ALP_OK;
    }
    uint8_t *target = (*image)->pixels;
    for (size_t i = 0; i < count; i++) {
        float value = fminf(fmaxf(source[4 * i], 0.0f), 1.0f);
        target[i] = (uint8_t)(value * 255.0f + 0.5f);
    }
    return ALP_OK;
}

alp_result alpi_lightmap_rgb_image(const alp_lightmap *lightmap, const float *page, float scale,
                                   float offset, alp_image **image)
{
    alp_image_info info = {lightmap->width, lightmap->height, 3, ALP_COMPONENT_U8};
    ALP_TRY(alp_image_create(lightmap->context, info, image));
    uint8_t *target = (*image)->pixels;
    const size_t count = (size_t)info.width * info.height;
    for (size_t i = 0; i < 3 * count; i++) {
        float value = scale * page[i / 3 * 4 + i % 3] + offset;
        target[i] = (uint8_t)(fminf(fmaxf(value, 0.0f), 1.0f) * 255.0f + 0.5f);
    }
    return ALP_OK;
}

alp_result alpi_lightmap_error_image(const alp_lightmap *lightmap, uint32_t page, alp_image **image)
{
    const alpi_texels *texels = &lightmap->texels;
    alp_image_info info = {lightmap->width, lightmap->height, 4, ALP_COMPONENT_FLOAT};
    ALP_TRY(alp_image_create(lightmap->context, info, image));
    float *pixels = (*image)->pixels;
    for (uint32_t i = texels->page_first[page]; i < texels->page_first[page + 1]; i++) {
        float *pixel =
            pixels + 4 * ((size_t)texels->pixels[i][1] * info.width + texels->pixels[i][0]);
        pixel[0] = pixel[1] = pixel[2] = lightmap->errors[i];
        pixel[3] = lightmap->states[i] != ALPI_TEXEL_OPEN ? 1.0f : 0.0f;
    }
    return ALP_OK;
}

alp_result alpi_lightmap_sampling_image(const alp_lightmap *lightmap, uint32_t page,
                                        alp_image **image)
{
    static const uint8_t colors[][3] = {[ALPI_TEXEL_OPEN] = {40, 60, 220},
                                        [ALPI_TEXEL_TRACED] = {220, 40, 40},
                                        [ALPI_TEXEL_INTERPOLATED] = {40, 180, 60}};
    const alpi_texels *texels = &lightmap->texels;
    alp_image_info info = {lightmap->width, lightmap->height, 3, ALP_COMPONENT_U8};
    ALP_TRY(alp_image_create(lightmap->context, info, image));
    uint8_t *pixels = (*image)->pixels;
    for (uint32_t i = texels->page_first[page]; i < texels->page_first[page + 1]; i++) {
        const size_t at = (size_t)texels->pixels[i][1] * info.width + texels->pixels[i][0];
        memcpy(pixels + 3 * at, colors[lightmap->states[i]], 3);
    }
    return ALP_OK;
}

uint32_t alp_lightmap_page_count(const alp_lightmap *lightmap)
{
    return lightmap ? lightmap->page_count : 0;
}

/// One of some pages and its size, or NULL.
static const float *find_page(const alp_lightmap *lightmap, float *const *pages, uint32_t page,
                              uint32_t *width, uint32_t *height)
{
    if (page >= lightmap->page_count || pages == NULL) {
        return NULL;
    }
    if (width != NULL) {
        *width = lightmap->width;
    }
    if (height != NULL) {
        *height = lightmap->height;
    }
    return pages[page];
}

const float *alp_lightmap_page(const alp_lightmap *lightmap, uint32_t page, uint32_t *width,
                               uint32_t *height)
{
    return lightmap != NULL ? find_page(lightmap, lightmap->pages, page, width, height) : NULL;
}

const float *alp_lightmap_map_page(const alp_lightmap *lightmap, alp_map map, uint32_t page,
                                   uint32_t *width, uint32_t *height)
{
    if (lightmap == NULL) {
        return NULL;
    }
    float *const *pages = map == ALP_MAP_AO           ? lightmap->pages
                          : map == ALP_MAP_BENT       ? lightmap->bent_pages
                          : map == ALP_MAP_OBSCURANCE ? lightmap->obscurance_pages
                          : map == ALP_MAP_LIGHT      ? lightmap->irradiance_pages
                          : map == ALP_MAP_DIRECT     ? lightmap->direct_pages
                          : map == ALP_MAP_BOUNCED    ? lightmap->bounced_pages
                          : map == ALP_MAP_SH         ? lightmap->sh_pages[0]
                          : map == ALP_MAP_DIRECTION  ? lightmap->direction_pages
                                                      : NULL;
    return find_page(lightmap, pages, page, width, height);
}

const float *alp_lightmap_sh_page(const alp_lightmap *lightmap, uint32_t index, uint32_t page,
                                  uint32_t *width, uint32_t *height)
{
    return lightmap != NULL && index < 4
               ? find_page(lightmap, lightmap->sh_pages[index], page, width, height)
               : NULL;
}

uint32_t alp_lightmap_layer_count(const alp_lightmap *lightmap)
{
    return lightmap ? lightmap->layer_count : 0;
}

const char *alp_lightmap_layer_name(const alp_lightmap *lightmap, uint32_t layer)
{
    return layer < alp_lightmap_layer_count(lightmap) ? lightmap->layer_names[layer] : NULL;
}

const float *alp_lightmap_layer_page(const alp_lightmap *lightmap, uint32_t layer, uint32_t page,
                                     uint32_t *width, uint32_t *height)
{
    return layer < alp_lightmap_layer_count(lightmap)
               ? find_page(lightmap, lightmap->layer_pages[layer], page, width, height)
               : NULL;
}

const alp_atlas *alp_lightmap_atlas(const alp_lightmap *lightmap)
{
    return lightmap ? lightmap->atlas : NULL;
}

const float *alp_lightmap_vertex_values(const alp_lightmap *lightmap, uint32_t surface,
                                        uint32_t *count)
{
    bool there = lightmap != NULL && lightmap->vertex_values != NULL &&
                 surface < lightmap->scene->surface_count;
    const alpi_surface *s = there ? &lightmap->scene->surfaces[surface] : NULL;
    if (count != NULL) {
        *count = there ? s->vertex_count : 0;
    }
    return there ? lightmap->vertex_values + s->first_vertex : NULL;
}
