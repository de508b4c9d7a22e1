// SPDX-License-Identifier: MIT
// How the maps of two baked assets differ: both are read at the same points of the surface, with
// the look-ups of pictures and bakes, and the figures are those of two images with a pixel a point.
#include <alpenglow/compare.h>

#include "base/memory.h"
#include "formats/formats.h"
#include "report/same_triangles.h"
#include "scene/area_points.h"
#include "scene/lights/lighting.h"

#include <math.h>
#include <string.h>

enum { POINT_LIMIT = 1 << 24, POINT_DEFAULT = 1 << 18, ROW = 4096 };

/// One of the two scenes.
typedef struct side {
    const alp_scene *scene;
    alpi_light_maps light;
    alp_image *values; // a pixel for each point: grey or RGB, and alpha 1 where there is a map
} side;

typedef struct comparison {
    alp_map_compare_options options;
    side sides[2];
    alpi_same_triangles same;
    alpi_area_point *points; // [options.points] in the first scene
} comparison;

alp_map_compare_options alp_map_compare_options_default(void)
{
    return (alp_map_compare_options){
        .struct_size = sizeof(alp_map_compare_options), .points = POINT_DEFAULT, .scale = 1.0};
}

static alp_result check_options(const alp_scene *a, const alp_scene *b,
                                const alp_map_compare_options *o)
{
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    if (o->struct_size != sizeof *o) {
        return alpi_fail(a->context, code, "compare options are not from _default()");
    }
    if (a->context != b->context) {
        return alpi_fail(a->context, code, "compare: the scenes are of two contexts");
    }
    if (o->points < 1 || o->points > POINT_LIMIT) {
        return alpi_fail(a->context, code, "compare: %u points, need 1 to %d", o->points,
                         POINT_LIMIT);
    }
    if (o->map != 0 && o->map != ALP_MAP_AO && o->map != ALP_MAP_LIGHT) {
        return alpi_fail(a->context, code, "compare: map %d is neither occlusion nor light",
                         (int)o->map);
    }
    return ALP_OK;
}

// --- which map -----------------------------------------------------------------------------------

static bool has_image(const alp_scene *scene, const alpi_texture *texture)
{
    return texture->image != ALPI_NONE && scene->images[texture->image] != NULL;
}

/// What a material's map is read with; NULL where it has none. *light: of light that is no
/// emission.
static const alpi_texture *map_texture(const side *s, uint32_t material, alp_map map,
                                       const alpi_light_map **light)
{
    *light = NULL;
    if (material == ALPI_NONE) {
        return NULL;
    }
    const alpi_material *m = &s->scene->materials[material];
    if (map == ALP_MAP_AO) {
        return has_image(s->scene, &m->occlusion_texture) ? &m->occlusion_texture : NULL;
    }
    if (s->light.maps[material].texture.image != ALPI_NONE) {
        *light = &s->light.maps[material];
        return &(*light)->texture;
    }
    return has_image(s->scene, &m->emission_texture) ? &m->emission_texture : NULL;
}

/// Whether any surface has the map, and is blended in it.
static bool has_map(const side *s, alp_map map, bool *blended)
{
    bool found = false;
    *blended = false;
    for (uint32_t i = 0; i < s->scene->surface_count; i++) {
        const alpi_surface *surface = &s->scene->surfaces[i];
        const alpi_light_map *light;
        const alpi_texture *texture = map_texture(s, surface->material, map, &light);
        if (texture != NULL && surface->triangle_count > 0) {
            found = true;
            *blended = *blended || alpi_surface_is_blended(s->scene, texture, i);
        }
    }
    return found;
}

static alp_result fail_map(const comparison *c, alp_map map, bool of_first)
{
    const alp_scene *scene = c->sides[of_first ? 0 : 1].scene;
    return alpi_fail(scene->context, ALP_ERROR_INVALID_DATA,
                     map == ALP_MAP_AO
                         ? "compare: %s has no occlusion map; bake it with --maps ao"
                         : "compare: %s has no map of light; bake it with --maps light and "
                           "--lightmap-as",
                     scene->name);
}

static alp_result choose_map(const comparison *c, alp_map_difference *d)
{
    const side *a = &c->sides[0], *b = &c->sides[1];
    static const alp_map maps[] = {ALP_MAP_AO, ALP_MAP_LIGHT};
    bool has[2][2];
    for (int i = 0; i < 2; i++) {
        has[i][0] = has_map(a, maps[i], &d->blended_first);
        has[i][1] = has_map(b, maps[i], &d->blended_second);
        const bool asked = c->options.map == maps[i];
        if (asked && !(has[i][0] && has[i][1])) {
            return fail_map(c, maps[i], !has[i][0]);
        }
        if (asked || (c->options.map == 0 && has[i][0] && has[i][1])) {
            d->map = maps[i];
            return ALP_OK;
        }
    }
    for (int k = 0; k < 2 && c->options.map == 0; k++) {
        if (!has[0][k] && !has[1][k]) {
            return alpi_fail(a->scene->context, ALP_ERROR_INVALID_DATA,
                             "compare: %s has neither an occlusion map nor one of light; bake it",
                             c->sides[k].scene->name);
        }
    }
    return alpi_fail(a->scene->context, ALP_ERROR_INVALID_DATA,
                     "compare: %s has a map of %s alone, and %s one of %s; bake the same of both",
                     a->scene->name, has[0][0] ? "occlusion" : "light", b->scene->name,
                     has[0][1] ? "occlusion" : "light");
}

// --- values --------------------------------------------------------------------------------------

static vec3 read_emission(const alp_scene *scene, alpi_area_point at)
{
    vec3 c[3];
    alpi_triangle_corners(scene, at.triangle, c);
    const vec3 front = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
    return alpi_surface_emission(scene, at.triangle, at.b1, at.b2, front);
}

/// A map at a point, in all three channels. @return false: there is none
static bool read_map(const side *s, alp_map map, alpi_area_point at, float rgb[3])
{
    const alp_scene *scene = s->scene;
    const uint32_t material = scene->surfaces[scene->triangle_surface[at.triangle]].material;
    const alpi_light_map *light;
    if (map_texture(s, material, map, &light) == NULL) {
        return false;
    }
    if (map == ALP_MAP_AO) {
        alpi_surface_occlusion(scene, at.triangle, at.b1, at.b2, &rgb[0]);
        rgb[1] = rgb[2] = rgb[0];
        return true;
    }
    if (light == NULL) {
        vec3_store(rgb, read_emission(scene, at));
        return true;
    }
    float rgba[4];
    alpi_surface_look_up(scene, &light->texture, s->light.images[light->texture.image], at, false,
                         rgba);
    for (int k = 0; k < 3; k++) {
        rgb[k] = light->scale * rgba[k];
    }
    return true;
}

/// The place of a point in the second scene.
static alpi_area_point place_in_second(const alpi_same_triangles *same, alpi_area_point at)
{
    const float weights[3] = {1.0f - at.b1 - at.b2, at.b1, at.b2};
    const uint32_t turn = same->turns[at.triangle], number = same->numbers[at.triangle];
    return (alpi_area_point){number, weights[(4 - turn) % 3], weights[(5 - turn) % 3]};
}

static alp_result read_point(comparison *c, alp_map map, uint32_t index, int which)
{
    const side *s = &c->sides[which];
    const alpi_area_point at =
        which == 0 ? c->points[index] : place_in_second(&c->same, c->points[index]);
    const uint32_t channels = s->values->info.channels;
    float *pixel = alp_image_floats(s->values) + (size_t)channels * index, rgb[3];
    if (!read_map(s, map, at, rgb)) {
        return ALP_OK;
    }
    if (!isfinite(rgb[0]) || !isfinite(rgb[1]) || !isfinite(rgb[2])) {
        const alp_scene *scene = s->scene;
        return alpi_fail(scene->context, ALP_ERROR_INVALID_DATA,
                         "compare: %s: the map of \"%s\" holds a value that is not finite",
                         scene->name, scene->surfaces[scene->triangle_surface[at.triangle]].name);
    }
    memcpy(pixel, rgb, (channels - 1) * sizeof *pixel);
    pixel[channels - 1] = 1.0f;
    return ALP_OK;
}

static alp_result read_points(comparison *c, alp_map map)
{
    const uint32_t count = c->options.points, width = count < ROW ? count : ROW;
    const alp_image_info info = {width, (count + width - 1) / width, map == ALP_MAP_AO ? 2 : 4,
                                 ALP_COMPONENT_FLOAT};
    for (int k = 0; k < 2; k++) {
        ALP_TRY(alp_image_create(c->sides[0].scene->context, info, &c->sides[k].values));
        for (uint32_t i = 0; i < count; i++) {
            ALP_TRY(read_point(c, map, i, k));
        }
    }
    return ALP_OK;
}

// --- figures -------------------------------------------------------------------------------------

static void find_place(const comparison *c, uint32_t index, alp_map_difference *d)
{
    const alp_scene *scene = c->sides[0].scene;
    const alpi_area_point *p = &c->points[index];
    vec3 corners[3];
    alpi_triangle_corners(scene, p->triangle, corners);
    vec3 at = vec3_scale(corners[0], 1.0f - p->b1 - p->b2);
    at = vec3_mad(vec3_mad(at, p->b1, corners[1]), p->b2, corners[2]);
    vec3_store(d->maximum_position, at);
    d->maximum_surface = scene->triangle_surface[p->triangle];
}

static alp_result find_figures(const comparison *c, alp_map_difference *d)
{
    alp_image_difference of;
    ALP_TRY(alp_image_compare(c->sides[0].values, c->sides[1].values, c->options.scale, &of, NULL));
    d->points = of.pixels;
    d->only_first = of.only_first;
    d->only_second = of.only_second;
    d->rmse = of.rmse;
    d->relative_rmse = of.relative_rmse;
    d->bias = of.bias;
    d->mean_first = of.mean_first;
    d->mean_second = of.mean_second;
    d->p99 = of.p99;
    d->maximum = of.maximum;
    if (of.pixels > 0) {
        find_place(c, of.maximum_y * c->sides[0].values->info.width + of.maximum_x, d);
    }
    return ALP_OK;
}

static alp_result run(comparison *c, alp_map_difference *d)
{
    const alp_scene *a = c->sides[0].scene, *b = c->sides[1].scene;
    ALP_TRY(alpi_same_triangles_find(a, b, &c->same));
    ALPI_TRY_NEW(a->context, c->points, c->options.points);
    if (!alpi_area_points(a, c->options.points, c->points)) {
        return alpi_fail(a->context, ALP_ERROR_INVALID_DATA,
                         "compare: %s has no triangle with area, and nothing to compare", a->name);
    }
    for (int k = 0; k < 2; k++) {
        ALP_TRY(alpi_gltf_read_light_maps(c->sides[k].scene, &c->sides[k].light));
    }
    ALP_TRY(choose_map(c, d));
    ALP_TRY(read_points(c, d->map));
    return find_figures(c, d);
}

alp_result alp_scene_compare_maps(const alp_scene *a, const alp_scene *b,
                                  const alp_map_compare_options *options,
                                  alp_map_difference *difference)
{
    if (a == NULL || b == NULL || difference == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *difference = (alp_map_difference){.maximum_surface = ALPI_NONE};
    comparison c = {.options = options != NULL ? *options : alp_map_compare_options_default(),
                    .sides = {{.scene = a}, {.scene = b}}};
    ALP_TRY(check_options(a, b, &c.options));
    const alp_result result = run(&c, difference);
    for (int k = 0; k < 2; k++) {
        alp_image_destroy(c.sides[k].values);
        alpi_light_maps_release(a->context, &c.sides[k].light);
    }
    alpi_release(a->context, c.points);
    alpi_same_triangles_release(a->context, &c.same);
    return result;
}
