// SPDX-License-Identifier: MIT
// What a surface is made of at a point: texture coordinates, alpha, transmission, albedo, emission.
#include "scene/blend_weights.h"
#include "scene/lights/lighting.h"
#include "scene/scene.h"

#include <alpenglow/shared_constants.h>

#include <math.h>

// Physics: diffuse albedo is clamped here, so that closed rooms converge.
static const float ALBEDO_LIMIT = (float)ALP_ALBEDO_LIMIT;
static const float ALBEDO_WITHOUT_MATERIAL = (float)ALP_ALBEDO_WITHOUT_MATERIAL;

alpi_texture alpi_texture_none(void)
{
    return (alpi_texture){.image = ALPI_NONE, .scale = {1.0f, 1.0f}};
}

alpi_material alpi_material_default(void)
{
    return (alpi_material){.base_color = {1.0f, 1.0f, 1.0f, 1.0f},
                           .base_color_texture = alpi_texture_none(),
                           .metallic_texture = alpi_texture_none(),
                           .emission_texture = alpi_texture_none(),
                           .alpha_cutoff = 0.5f,
                           .occlusion_texture = alpi_texture_none(),
                           .occlusion_strength = 1.0f,
                           .transmission_texture = alpi_texture_none(),
                           .normal_texture = alpi_texture_none(),
                           .normal_scale = 1.0f,
                           .shine = {.roughness = 1.0f,
                                     .roughness_texture = alpi_texture_none(),
                                     .specular = {1.0f, 1.0f, 1.0f},
                                     .specular_texture = alpi_texture_none(),
                                     .bump_texture = alpi_texture_none(),
                                     .bump_scale = 1.0f}};
}

vec2 alpi_texture_transform(const alpi_texture *texture, vec2 uv)
{
    // KHR_texture_transform: offset · rotation · scale, the rotation counter-clockwise in uv with
    // v pointing down: u' = cos·u·sx + sin·v·sy, v' = −sin·u·sx + cos·v·sy.
    float u = uv.x * texture->scale[0], v = uv.y * texture->scale[1];
    float c = cosf(texture->rotation), s = sinf(texture->rotation);
    return (vec2){c * u + s * v + texture->offset[0], c * v - s * u + texture->offset[1]};
}

vec2 alpi_triangle_uv(const alp_scene *scene, uint32_t triangle, uint32_t set, float b1, float b2)
{
    if (set >= ALPI_UV_SLOT_COUNT || scene->uvs[set] == NULL) {
        return (vec2){0.0f, 0.0f};
    }
    const uint32_t *v = scene->triangles[triangle];
    const float *a = scene->uvs[set][v[0]], *b = scene->uvs[set][v[1]], *c = scene->uvs[set][v[2]];
    return (vec2){a[0] + b1 * (b[0] - a[0]) + b2 * (c[0] - a[0]),
                  a[1] + b1 * (b[1] - a[1]) + b2 * (c[1] - a[1])};
}

bool alpi_surface_is_blended(const alp_scene *scene, const alpi_texture *texture, uint32_t surface)
{
    const unsigned there = scene->surfaces[surface].uv_slots;
    bool all = texture->blended;
    for (int k = 0; k < 3 && all; k++) {
        all = (there >> texture->slots[k] & 1u) != 0;
    }
    return all;
}

void alpi_surface_look_up(const alp_scene *scene, const alpi_texture *texture,
                          const alp_image *image, alpi_surface_place at, bool srgb, float rgba[4])
{
    const alpi_sampler sampler = {texture->wrap_u, texture->wrap_v, srgb};
    float weights[3], values[3][4];
    if (!alpi_surface_is_blended(scene, texture, scene->triangle_surface[at.triangle])) {
        const vec2 uv = alpi_triangle_uv(scene, at.triangle, texture->uv_set, at.b1, at.b2);
        const vec2 turned = alpi_texture_transform(texture, uv);
        alpi_image_sample(image, turned.x, turned.y, sampler, rgba);
        return;
    }
    alpi_surface_weights(scene, false, at.triangle, at.b1, at.b2, weights);
    for (int k = 0; k < 3; k++) {
        const vec2 uv = alpi_triangle_uv(scene, at.triangle, texture->slots[k], at.b1, at.b2);
        const vec2 turned = alpi_texture_transform(texture, uv);
        alpi_image_sample(image, turned.x, turned.y, sampler, values[k]);
    }
    for (int i = 0; i < 4; i++) {
        rgba[i] = weights[0] * values[0][i] + weights[1] * values[1][i] + weights[2] * values[2][i];
    }
}

static bool read_texture(const alp_scene *scene, const alpi_texture *texture, alpi_surface_place at,
                         bool srgb, float rgba[4])
{
    if (texture->image == ALPI_NONE || scene->images[texture->image] == NULL) {
        return false;
    }
    alpi_surface_look_up(scene, texture, scene->images[texture->image], at, srgb, rgba);
    return true;
}

static void read_vertex_color(const alp_scene *scene, uint32_t triangle, float b1, float b2,
                              float rgba[4])
{
    const uint32_t *v = scene->triangles[triangle];
    for (int k = 0; k < 4; k++) {
        rgba[k] = scene->colors == NULL
                      ? 1.0f
                      : (1.0f - b1 - b2) * scene->colors[v[0]][k] + b1 * scene->colors[v[1]][k] +
                            b2 * scene->colors[v[2]][k];
    }
}

static const alpi_material *material_of(const alp_scene *scene, uint32_t triangle)
{
    uint32_t material = scene->surfaces[scene->triangle_surface[triangle]].material;
    return material == ALPI_NONE ? NULL : &scene->materials[material];
}

float alpi_surface_alpha(const alp_scene *scene, uint32_t triangle, float b1, float b2)
{
    const alpi_material *material = material_of(scene, triangle);
    if (material == NULL || material->alpha_mode == ALPI_ALPHA_OPAQUE) {
        return 1.0f;
    }
    const alpi_surface_place at = {triangle, b1, b2};
    float texel[4] = {1.0f, 1.0f, 1.0f, 1.0f}, vertex[4];
    read_texture(scene, &material->base_color_texture, at, false, texel); // alpha is linear
    read_vertex_color(scene, triangle, b1, b2, vertex);
    return material->base_color[3] * texel[3] * vertex[3];
}

/// Channel `channel` of a texture that multiplies a factor.
static float scale_by_texture(const alp_scene *scene, float factor, const alpi_texture *texture,
                              int channel, alpi_surface_place at)
{
    float texel[4];
    return factor > 0.0f && read_texture(scene, texture, at, false, texel) ? factor * texel[channel]
                                                                           : factor;
}

float alpi_surface_transmission(const alp_scene *scene, uint32_t triangle, float b1, float b2)
{
    const alpi_material *material = material_of(scene, triangle);
    return material == NULL
               ? 0.0f
               : scale_by_texture(scene, material->transmission, &material->transmission_texture, 0,
                                  (alpi_surface_place){triangle, b1, b2});
}

float alpi_surface_metallic(const alp_scene *scene, uint32_t triangle, float b1, float b2)
{
    const alpi_material *material = material_of(scene, triangle);
    return material == NULL
               ? 0.0f
               : scale_by_texture(scene, material->metallic, &material->metallic_texture, 2,
                                  (alpi_surface_place){triangle, b1, b2});
}

bool alpi_surface_is_cut(const alp_scene *scene, uint32_t triangle, float b1, float b2)
{
    const alpi_material *material = material_of(scene, triangle);
    if (material == NULL || material->alpha_mode == ALPI_ALPHA_OPAQUE) {
        return false;
    }
    float cutoff = material->alpha_mode == ALPI_ALPHA_MASK ? material->alpha_cutoff : 0.5f;
    return alpi_surface_alpha(scene, triangle, b1, b2) < cutoff;
}

bool alpi_surface_has_cuts(const alp_scene *scene, uint32_t surface)
{
    uint32_t material = scene->surfaces[surface].material;
    return material != ALPI_NONE && scene->materials[material].alpha_mode != ALPI_ALPHA_OPAQUE;
}

static vec3 base_color_at(const alp_scene *scene, const alpi_material *material,
                          alpi_surface_place at)
{
    float texel[4] = {1.0f, 1.0f, 1.0f, 1.0f}, vertex[4], color[3];
    read_texture(scene, &material->base_color_texture, at, true, texel);
    read_vertex_color(scene, at.triangle, at.b1, at.b2, vertex);
    for (int k = 0; k < 3; k++) {
        color[k] = material->base_color[k] * vertex[k] * texel[k];
    }
    return vec3_load(color);
}

static float clamp_between(float value, float low, float high)
{
    return fminf(fmaxf(value, low), high);
}

/// The colour of a surface without a material: grey, or that of its vertices where they are not all
/// white, as those of surfaces without colours are.
static vec3 bare_color_at(const alp_scene *scene, uint32_t triangle, float b1, float b2)
{
    bool white = true;
    for (int k = 0; scene->colors != NULL && k < 3; k++) {
        const float *color = scene->colors[scene->triangles[triangle][k]];
        white = white && color[0] == 1.0f && color[1] == 1.0f && color[2] == 1.0f;
    }
    if (white) {
        return (vec3){ALBEDO_WITHOUT_MATERIAL, ALBEDO_WITHOUT_MATERIAL, ALBEDO_WITHOUT_MATERIAL};
    }
    float rgba[4];
    read_vertex_color(scene, triangle, b1, b2, rgba);
    return (vec3){fminf(rgba[0], ALBEDO_LIMIT), fminf(rgba[1], ALBEDO_LIMIT),
                  fminf(rgba[2], ALBEDO_LIMIT)};
}

/// The base colour, or that of a surface without a material, × a share.
static vec3 find_albedo(const alp_scene *scene, uint32_t triangle, float b1, float b2, float share)
{
    const alpi_material *material = material_of(scene, triangle);
    if (material == NULL) {
        return bare_color_at(scene, triangle, b1, b2);
    }
    const vec3 color = base_color_at(scene, material, (alpi_surface_place){triangle, b1, b2});
    return (vec3){clamp_between(color.x * share, 0.0f, ALBEDO_LIMIT),
                  clamp_between(color.y * share, 0.0f, ALBEDO_LIMIT),
                  clamp_between(color.z * share, 0.0f, ALBEDO_LIMIT)};
}

vec3 alpi_surface_albedo(const alp_scene *scene, uint32_t triangle, float b1, float b2)
{
    const float diffuse =
        scene->metals_black ? 1.0f - alpi_surface_metallic(scene, triangle, b1, b2) : 1.0f;
    return find_albedo(scene, triangle, b1, b2, diffuse);
}

vec3 alpi_surface_color(const alp_scene *scene, uint32_t triangle, float b1, float b2)
{
    return find_albedo(scene, triangle, b1, b2, 1.0f);
}

bool alpi_surface_is_pane(const alp_scene *scene, uint32_t surface)
{
    const uint32_t index = scene->surfaces[surface].material;
    const alpi_material *m = index == ALPI_NONE ? NULL : &scene->materials[index];
    return m != NULL && (m->alpha_mode == ALPI_ALPHA_BLEND || m->transmission > 0.0f);
}

alpi_pane alpi_surface_pane(const alp_scene *scene, uint32_t triangle, float b1, float b2)
{
    const alpi_material *m = material_of(scene, triangle);
    alpi_pane pane = {.kept = 1.0f};
    if (m == NULL) {
        return pane;
    }
    if (m->alpha_mode == ALPI_ALPHA_MASK && alpi_surface_is_cut(scene, triangle, b1, b2)) {
        return (alpi_pane){.through = {1.0f, 1.0f, 1.0f}};
    }
    const bool blended = m->alpha_mode == ALPI_ALPHA_BLEND;
    const float a =
        blended ? clamp_between(alpi_surface_alpha(scene, triangle, b1, b2), 0.0f, 1.0f) : 1.0f;
    const float t =
        clamp_between(alpi_surface_transmission(scene, triangle, b1, b2), 0.0f, 1.0f) *
        (1.0f - clamp_between(alpi_surface_metallic(scene, triangle, b1, b2), 0.0f, 1.0f));
    const vec3 color = base_color_at(scene, m, (alpi_surface_place){triangle, b1, b2});
    const float c[3] = {clamp_between(color.x, 0.0f, 1.0f), clamp_between(color.y, 0.0f, 1.0f),
                        clamp_between(color.z, 0.0f, 1.0f)};
    float through[3];
    for (int k = 0; k < 3; k++) {
        through[k] = (1.0f - a) * (1.0f - a + a * c[k]) + a * t * c[k];
    }
    pane.through = vec3_load(through);
    pane.kept = a * (1.0f - t);
    return pane;
}

bool alpi_surface_occlusion(const alp_scene *scene, uint32_t triangle, float b1, float b2,
                            float *accessibility)
{
    const alpi_material *material = material_of(scene, triangle);
    float texel[4];
    if (material == NULL || !read_texture(scene, &material->occlusion_texture,
                                          (alpi_surface_place){triangle, b1, b2}, false, texel)) {
        return false;
    }
    *accessibility = 1.0f + material->occlusion_strength * (texel[0] - 1.0f);
    return true;
}

bool alpi_scene_set_is_blended(const alp_scene *scene, uint32_t set)
{
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const alpi_surface *surface = &scene->surfaces[s];
        if (surface->material != ALPI_NONE && surface->uv_sets > set &&
            (scene->materials[surface->material].blend_sets >> set & 1u) != 0) {
            return true;
        }
    }
    return false;
}

bool alpi_surface_is_double_sided(const alp_scene *scene, uint32_t triangle)
{
    uint32_t material = scene->surfaces[scene->triangle_surface[triangle]].material;
    return material != ALPI_NONE && scene->materials[material].double_sided;
}

/// Radiance that sums of many can hold: what a scene's emission is clamped to as well. NaN is none.
static float bounded_radiance(float value)
{
    const float limit = 1e20f;
    return value > 0.0f ? fminf(value, limit) : 0.0f;
}

vec3 alpi_surface_emission(const alp_scene *scene, uint32_t triangle, float b1, float b2,
                           vec3 direction)
{
    const vec3 dark = {0.0f, 0.0f, 0.0f};
    const alpi_material *m = material_of(scene, triangle);
    if (m == NULL || !(m->emission[0] > 0.0f || m->emission[1] > 0.0f || m->emission[2] > 0.0f)) {
        return dark;
    }
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    bool behind = !(vec3_dot(vec3_triangle_normal(c[0], c[1], c[2], dark), direction) > 0.0f);
    const bool masked = m->alpha_mode == ALPI_ALPHA_MASK;
    if ((behind && !m->double_sided) || (masked && alpi_surface_is_cut(scene, triangle, b1, b2))) {
        return dark;
    }
    const float covered = m->alpha_mode == ALPI_ALPHA_BLEND
                              ? clamp_between(alpi_surface_alpha(scene, triangle, b1, b2), 0, 1)
                              : 1.0f;
    float texel[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    read_texture(scene, &m->emission_texture, (alpi_surface_place){triangle, b1, b2}, true, texel);
    return (vec3){bounded_radiance(m->emission[0] * texel[0] * covered),
                  bounded_radiance(m->emission[1] * texel[1] * covered),
                  bounded_radiance(m->emission[2] * texel[2] * covered)};
}
