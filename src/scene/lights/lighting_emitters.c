// SPDX-License-Identifier: MIT
// Emissive triangles: which there are, and how strong each is.
#include "scene/lights/lighting_emitters.h"

#include "base/memory.h"
#include "scene/lights/black_emission.h"
#include "scene/lights/lighting.h"

#include <math.h>

/// Samples of a texture along each of two sides of a triangle: as many as it has texels there.
enum { FEWEST_ACROSS = 4, MOST_ACROSS = 64 };
/// Samples that a triangle has at least in draws as if they were fully bright, whatever they found:
/// they may have missed the only bright place.
static const double LEAST_SAMPLES = 0.25;

static double channel_mean(vec3 v)
{
    return ((double)v.x + (double)v.y + (double)v.z) / 3.0;
}

static const alpi_material *emissive_material(const alp_scene *scene, uint32_t surface)
{
    uint32_t index = scene->surfaces[surface].material;
    const alpi_material *m = index == ALPI_NONE ? NULL : &scene->materials[index];
    bool emits =
        m != NULL && (m->emission[0] > 0.0f || m->emission[1] > 0.0f || m->emission[2] > 0.0f);
    return emits ? m : NULL;
}

/// How many samples across a triangle find each texel of its emission texture.
static int count_across(const alp_scene *scene, uint32_t triangle, const alpi_texture *texture)
{
    if (texture->image == ALPI_NONE || scene->images[texture->image] == NULL) {
        return FEWEST_ACROSS;
    }
    const alp_image_info *size = &scene->images[texture->image]->info;
    vec2 uv[3];
    for (int k = 0; k < 3; k++) {
        uv[k] = alpi_texture_transform(texture, alpi_triangle_uv(scene, triangle, texture->uv_set,
                                                                 k == 1 ? 1.0f : 0.0f,
                                                                 k == 2 ? 1.0f : 0.0f));
    }
    double longest = 0.0; // texels
    for (int k = 0; k < 3; k++) {
        const vec2 from = uv[k], to = uv[(k + 1) % 3];
        longest = fmax(longest, hypot((double)(to.x - from.x) * size->width,
                                      (double)(to.y - from.y) * size->height));
    }
    return longest < MOST_ACROSS ? (int)fmax(ceil(longest), FEWEST_ACROSS) : MOST_ACROSS;
}

/// Mean of the emission over a triangle, at the centroids of across² triangles that it is cut into.
static double mean_radiance(const alp_scene *scene, uint32_t triangle, const alpi_material *m,
                            vec3 normal)
{
    double sum = 0.0, full = 0.0;
    for (int k = 0; k < 3; k++) { // as alpi_surface_emission bounds it
        full += m->emission[k] > 0.0f ? fmin((double)m->emission[k], 1e20) / 3.0 : 0.0;
    }
    bool plain = (m->emission_texture.image == ALPI_NONE ||
                  scene->images[m->emission_texture.image] == NULL) &&
                 m->alpha_mode == ALPI_ALPHA_OPAQUE;
    if (plain) {
        return full;
    }
    const int across = count_across(scene, triangle, &m->emission_texture);
    const double count = (double)across * across;
    for (int i = 0; i < 2 * across * across; i++) { // squares of a grid, each cut by its diagonal
        const int column = i / 2 % across, row = i / 2 / across, upper = i % 2;
        if (column + row + upper < across) {
            const float within = (float)(1 + upper) / 3.0f;
            sum += channel_mean(
                alpi_surface_emission(scene, triangle, ((float)column + within) / (float)across,
                                      ((float)row + within) / (float)across, normal));
        }
    }
    return fmax(sum, LEAST_SAMPLES * full) / count;
}

double alpi_emitters_radiance(const alp_scene *scene, uint32_t triangle)
{
    const alpi_material *m = emissive_material(scene, scene->triangle_surface[triangle]);
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    return m == NULL ? 0.0
                     : mean_radiance(scene, triangle, m,
                                     vec3_triangle_normal(c[0], c[1], c[2], (vec3){0, 1, 0}));
}

static alpi_light_bound bound_triangle(const alp_scene *scene, uint32_t triangle,
                                       const alpi_material *m, double *radiance)
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    vec3 normal = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
    *radiance = mean_radiance(scene, triangle, m, normal);
    return (alpi_light_bound){.low = vec3_min(vec3_min(c[0], c[1]), c[2]),
                              .high = vec3_max(vec3_max(c[0], c[1]), c[2]),
                              .axis = normal,
                              .reach = (float)(ALPI_PI / 2.0),
                              .two_sided = m->double_sided,
                              .power = *radiance * vec3_triangle_area(c[0], c[1], c[2])};
}

/// The material a triangle emits with; NULL where it does not.
static const alpi_material *emitter_material(const alp_scene *scene, const bool *dark,
                                             uint32_t triangle)
{
    return scene->triangle_usable[triangle] && !dark[triangle]
               ? emissive_material(scene, scene->triangle_surface[triangle])
               : NULL;
}

static alp_result fill(const alp_scene *scene, const bool *dark, alpi_emitters *emitters)
{
    uint32_t candidates = 0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        candidates += emitter_material(scene, dark, t) != NULL;
    }
    if (candidates == 0) {
        return ALP_OK;
    }
    ALPI_TRY_NEW(scene->context, emitters->triangles, candidates);
    alpi_light_bound *bounds = ALPI_NEW(scene->context, alpi_light_bound, candidates);
    if (bounds == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        const alpi_material *m = emitter_material(scene, dark, t);
        if (m == NULL) {
            continue;
        }
        double radiance;
        alpi_light_bound bound = bound_triangle(scene, t, m, &radiance);
        if (bound.power > 0.0) { // also not where area × radiance is below any number
            emitters->largest = fmax(emitters->largest, radiance);
            bounds[emitters->count] = bound;
            emitters->triangles[emitters->count++] = t;
        }
    }
    alp_result result = ALP_OK;
    if (emitters->count > 0) {
        result = alpi_light_tree_create(scene->context, bounds, emitters->count, &emitters->tree);
    }
    alpi_release(scene->context, bounds);
    return result;
}

alp_result alpi_emitters_collect(const alp_scene *scene, alpi_emitters *emitters)
{
    *emitters = (alpi_emitters){0};
    bool any = false;
    for (uint32_t s = 0; s < scene->surface_count && !any; s++) {
        any = emissive_material(scene, s) != NULL;
    }
    if (!any) {
        return ALP_OK;
    }
    bool *dark = ALPI_NEW(scene->context, bool, scene->triangle_count);
    if (dark == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = alpi_lighting_mark_dark(scene, dark);
    if (result == ALP_OK) {
        result = fill(scene, dark, emitters);
    }
    alpi_release(scene->context, dark);
    return result;
}

void alpi_emitters_clear(alp_context *context, alpi_emitters *emitters)
{
    alpi_light_tree_destroy(context, emitters->tree);
    alpi_release(context, emitters->triangles);
    *emitters = (alpi_emitters){0};
}

uint32_t alpi_emitters_find(const alpi_emitters *emitters, uint32_t triangle)
{
    uint32_t low = 0, high = emitters->count;
    while (low < high) {
        uint32_t mid = low + (high - low) / 2;
        if (emitters->triangles[mid] < triangle) {
            low = mid + 1;
        } else {
            high = mid;
        }
    }
    return low < emitters->count && emitters->triangles[low] == triangle ? low : ALPI_NONE;
}
