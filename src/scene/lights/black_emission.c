// SPDX-License-Identifier: MIT
// Emission textures are mostly black: a whole model wears one for its two head lights. Triangles
// over black are no lights, which a few looks cannot tell but counts of bright texels can.
// Based on: Franklin C. Crow. Summed-Area Tables for Texture Mapping. SIGGRAPH 1984.
#include "scene/lights/black_emission.h"

#include "base/memory.h"

typedef struct bright_map {
    uint32_t width, height;
    uint32_t *sums; // [height + 1][width + 1]: bright texels above and to the left
} bright_map;

static bool is_bright(const alp_image *image, uint32_t x, uint32_t y)
{
    float rgba[4];
    alpi_image_pixel(image, x, y, rgba);
    return !(rgba[0] <= 0.0f && rgba[1] <= 0.0f && rgba[2] <= 0.0f); // NaN is not black
}

static alp_result make_map(const alp_scene *scene, const alp_image *image, bright_map *map)
{
    map->width = image->info.width;
    map->height = image->info.height;
    size_t pitch = (size_t)map->width + 1;
    ALPI_TRY_NEW(scene->context, map->sums, pitch * ((size_t)map->height + 1));
    for (uint32_t y = 0; y < map->height; y++) {
        const uint32_t *above = map->sums + y * pitch;
        uint32_t *row = map->sums + (y + 1) * pitch, sum = 0;
        for (uint32_t x = 0; x < map->width; x++) {
            sum += is_bright(image, x, y);
            row[x + 1] = above[x + 1] + sum;
        }
    }
    return ALP_OK;
}

/// Texels of one axis, as first and one past last of two runs, of which the second may be empty.
typedef struct texel_runs {
    uint32_t from[2], to[2];
} texel_runs;

/// Texels that bilinear look-ups between two coordinates can read, one more at either side for
/// rounding; all of them where mirrors make that hard to say.
static texel_runs runs_of(float low, float high, uint32_t size, alpi_wrap wrap)
{
    const texel_runs all = {{0, 0}, {size, 0}};
    if (!(fmax(fabs((double)low), fabs((double)high)) * size < 4e6)) {
        return all; // a float of it is no longer right to half a texel
    }
    double first = floor((double)low * size - 0.5) - 1.0;
    double past = floor((double)high * size - 0.5) + 3.0, end = (double)size;
    if (wrap == ALPI_WRAP_CLAMP) {
        first = fmin(fmax(first, 0.0), end - 1.0);
        past = fmin(fmax(past, 1.0), end);
    } else if (wrap == ALPI_WRAP_REPEAT && past - first < end) {
        double turns = floor(first / end) * end;
        first -= turns;
        past -= turns;
    }
    if (!(first >= 0.0 && first < end && past > first && past - first <= end)) {
        return all;
    }
    if (past <= end) {
        return (texel_runs){{(uint32_t)first, 0}, {(uint32_t)past, 0}};
    }
    return wrap == ALPI_WRAP_REPEAT
               ? (texel_runs){{(uint32_t)first, 0}, {size, (uint32_t)(past - end)}}
               : all;
}

static bool has_bright(const bright_map *map, const texel_runs *x, const texel_runs *y)
{
    size_t pitch = (size_t)map->width + 1;
    bool bright = false;
    for (int i = 0; i < 4; i++) {
        const uint32_t *above = map->sums + y->from[i / 2] * pitch;
        const uint32_t *below = map->sums + y->to[i / 2] * pitch;
        uint32_t left = x->from[i % 2], right = x->to[i % 2];
        bright = bright || below[right] - below[left] - above[right] + above[left] != 0;
    }
    return bright;
}

static bool is_dark_in(const alp_scene *scene, const alpi_texture *texture, uint32_t set,
                       const bright_map *map, uint32_t triangle)
{
    float low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int k = 0; k < 3; k++) {
        vec2 uv = alpi_texture_transform(
            texture,
            alpi_triangle_uv(scene, triangle, set, k == 1 ? 1.0f : 0.0f, k == 2 ? 1.0f : 0.0f));
        if (!isfinite(uv.x) || !isfinite(uv.y)) {
            return false;
        }
        low[0] = fminf(low[0], uv.x);
        low[1] = fminf(low[1], uv.y);
        high[0] = fmaxf(high[0], uv.x);
        high[1] = fmaxf(high[1], uv.y);
    }
    texel_runs x = runs_of(low[0], high[0], map->width, texture->wrap_u);
    texel_runs y = runs_of(low[1], high[1], map->height, texture->wrap_v);
    return !has_bright(map, &x, &y);
}

/// Of a blended texture in all of its slots, whether or not the surface has them.
static bool is_dark(const alp_scene *scene, const alpi_texture *texture, const bright_map *map,
                    uint32_t triangle)
{
    bool dark = is_dark_in(scene, texture, texture->uv_set, map, triangle);
    for (int k = 1; k < 3 && texture->blended; k++) {
        dark = dark && is_dark_in(scene, texture, texture->slots[k], map, triangle);
    }
    return dark;
}

/// The emission texture of a surface if it reads this image.
static const alpi_texture *emission_of(const alp_scene *scene, uint32_t surface, uint32_t image)
{
    uint32_t index = scene->surfaces[surface].material;
    const alpi_material *m = index == ALPI_NONE ? NULL : &scene->materials[index];
    bool reads = m != NULL && m->emission_texture.image == image &&
                 (m->emission[0] > 0.0f || m->emission[1] > 0.0f || m->emission[2] > 0.0f);
    return reads ? &m->emission_texture : NULL;
}

static void mark_surfaces(const alp_scene *scene, uint32_t image, const bright_map *map, bool *dark)
{
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const alpi_texture *texture = emission_of(scene, s, image);
        const alpi_surface *surface = &scene->surfaces[s];
        for (uint32_t i = 0; texture != NULL && i < surface->triangle_count; i++) {
            uint32_t t = surface->first_triangle + i;
            dark[t] = dark[t] || is_dark(scene, texture, map, t);
        }
    }
}

alp_result alpi_lighting_mark_dark(const alp_scene *scene, bool *dark)
{
    for (uint32_t image = 0; image < scene->image_count; image++) {
        bool used = false;
        for (uint32_t s = 0; s < scene->surface_count && !used; s++) {
            used = emission_of(scene, s, image) != NULL;
        }
        if (used && scene->images[image] != NULL) {
            bright_map map;
            ALP_TRY(make_map(scene, scene->images[image], &map));
            mark_surfaces(scene, image, &map, dark);
            alpi_release(scene->context, map.sums);
        }
    }
    return ALP_OK;
}
