// SPDX-License-Identifier: MIT
// All light that falls on a scene: which there is, and draws of one of it.
//
// A draw asks one of four classes, in proportion to what each may give at the point, and within it
// one light. Sky and suns are seen in the same directions, so that a direction to either counts all
// that comes from there, over the density of drawing it in any way (the balance heuristic of Eric
// Veach, Leonidas Guibas. Optimally Combining Sampling Techniques. SIGGRAPH 1995). Not so the spots
// of a sky that was parted (sky_spots.h), which are drawn alone, nor its soft part, met alone.
#include "scene/lights/lighting.h"

#include "base/memory.h"
#include "base/random.h"
#include "scene/lights/lighting_emitters.h"
#include "scene/lights/lighting_list.h"
#include "scene/lights/lighting_options.h"
#include "scene/lights/lighting_punctual.h"
#include "scene/lights/lighting_suns.h"
#include "scene/lights/triangle_light.h"
#include "scene/sky/sky_spots.h"

#include <stdio.h>

struct alpi_lighting {
    const alp_scene *scene;
    alpi_light_list list;
    alpi_punctual punctual;
    alpi_sun *suns;
    uint32_t sun_count;
    alpi_emitters emitters;
    alpi_sky *sky;        // may be NULL
    const alpi_sky *soft; // borrowed, where the sky is spots: what rays meet instead; else NULL
    double sky_average;   // π × mean radiance, mean of the channels
    bool lamps;           // punctual lights and suns are in it
    int only;             // the one class of which there is light; −1: several, or none
};

/// Of draws, that a class of light has wherever it may give any.
static const double LEAST_SHARE = 1.0 / 16.0;

static double channel_mean(vec3 v)
{
    return ((double)v.x + (double)v.y + (double)v.z) / 3.0;
}

static bool is_lit(vec3 v)
{
    return v.x > 0.0f || v.y > 0.0f || v.z > 0.0f;
}

// --- making --------------------------------------------------------------------------------------

/// Tells disks from points.
static alp_result sort_lights(alpi_lighting *lighting)
{
    alp_context *context = lighting->scene->context;
    ALPI_TRY_NEW(context, lighting->suns, lighting->list.count);
    uint32_t *points = ALPI_NEW(context, uint32_t, lighting->list.count);
    uint32_t count = 0;
    if (points == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < lighting->list.count; i++) {
        alpi_light *light = &lighting->list.lights[i];
        bool disk = alp_light_traits_of(light->kind).has_size && light->size >= ALPI_SUN_LEAST_SIZE;
        light->size = disk ? light->size : 0.0f;
        if (!(light->intensity > 0.0f && is_lit(light->color))) {
            continue;
        }
        if (disk) {
            lighting->suns[lighting->sun_count++] = alpi_sun_from(light, i);
        } else {
            points[count++] = i;
        }
    }
    alp_result result =
        alpi_punctual_collect(context, lighting->list.lights, points, count, &lighting->punctual);
    alpi_release(context, points);
    return result;
}

/// The class that draws need not be shared out to.
static int only_class(const alpi_lighting *lighting)
{
    const alpi_punctual *p = &lighting->punctual;
    const bool there[ALPI_LIGHT_CLASS_COUNT] = {
        [ALPI_LIGHT_CLASS_PUNCTUAL] = p->listed + p->placed_count > 0,
        [ALPI_LIGHT_CLASS_SUN] = lighting->sun_count > 0,
        [ALPI_LIGHT_CLASS_SURFACE] = lighting->emitters.count > 0,
        [ALPI_LIGHT_CLASS_SKY] = lighting->sky_average > 0.0};
    int only = -1;
    for (int i = 0; i < ALPI_LIGHT_CLASS_COUNT; i++) {
        if (there[i]) {
            if (only >= 0) {
                return -1;
            }
            only = i;
        }
    }
    return only;
}

static void set_sky(alpi_lighting *lighting, alpi_sky *sky)
{
    lighting->sky = sky;
    lighting->sky_average = sky != NULL ? ALPI_PI * channel_mean(alpi_sky_mean(sky)) : 0.0;
    lighting->only = only_class(lighting);
}

static alp_result fill(alpi_lighting *lighting, const alp_lighting_options *options)
{
    alp_context *context = lighting->scene->context;
    ALP_TRY(alpi_light_list_gather(lighting->scene, options, &lighting->list));
    lighting->list.count = lighting->lamps ? lighting->list.count : 0;
    ALP_TRY(sort_lights(lighting));
    ALP_TRY(alpi_emitters_collect(lighting->scene, &lighting->emitters));
    alpi_sky *sky = NULL;
    ALP_TRY(alpi_sky_create(context, &options->sky, alpi_sun_direction(&options->sun), &sky));
    set_sky(lighting, sky);
    return ALP_OK;
}

/// @param lamps false: punctual lights and suns are left out
static alp_result create(const alp_scene *scene, const alp_lighting_options *options, bool lamps,
                         alpi_lighting **lighting)
{
    *lighting = NULL;
    const alp_lighting_options chosen = options ? *options : alp_lighting_options_default();
    ALP_TRY(alpi_lighting_options_check(scene->context, &chosen));
    alpi_lighting *made = ALPI_NEW(scene->context, alpi_lighting, 1);
    if (made == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    made->scene = scene;
    made->lamps = lamps;
    alp_result result = fill(made, &chosen);
    if (result != ALP_OK) {
        alpi_lighting_destroy(scene->context, made);
        return result;
    }
    *lighting = made;
    return ALP_OK;
}

alp_result alpi_lighting_create(const alp_scene *scene, const alp_lighting_options *options,
                                alpi_lighting **lighting)
{
    return create(scene, options, true, lighting);
}

static alp_result create_quietly(const alp_scene *scene, const alp_lighting_options *options,
                                 bool lamps, alpi_lighting **lighting)
{
    alpi_hush(scene->context, true);
    const alp_result result = create(scene, options, lamps, lighting);
    alpi_hush(scene->context, false);
    return result;
}

alp_result alpi_lighting_create_without_lamps(const alp_scene *scene,
                                              const alp_lighting_options *options,
                                              alpi_lighting **lighting)
{
    return create_quietly(scene, options, false, lighting);
}

alp_result alpi_lighting_create_quietly(const alp_scene *scene, const alp_lighting_options *options,
                                        alpi_lighting **lighting)
{
    return create_quietly(scene, options, true, lighting);
}

alp_result alpi_lighting_split_sky(const alpi_lighting *lighting,
                                   const alp_lighting_options *options, alpi_lighting **soft,
                                   alpi_lighting **spots)
{
    alp_context *context = lighting->scene->context;
    alp_lighting_options without = *options;
    alpi_sky *skies[2] = {NULL, NULL};
    *soft = *spots = NULL;
    without.sky.kind = ALP_SKY_NONE;
    if (lighting->sky != NULL) {
        ALP_TRY(alpi_sky_split(context, lighting->sky, &skies[0], &skies[1]));
    }
    alp_result result = create_quietly(lighting->scene, &without, lighting->lamps, soft);
    if (result == ALP_OK) {
        result = create_quietly(lighting->scene, &without, lighting->lamps, spots);
    }
    if (result != ALP_OK) {
        alpi_sky_destroy(context, skies[0]);
        alpi_sky_destroy(context, skies[1]);
        alpi_lighting_destroy(context, *soft);
        *soft = NULL;
        return result;
    }
    set_sky(*soft, skies[0]);
    set_sky(*spots, skies[1]);
    (*spots)->soft = skies[1] != NULL ? skies[0] : NULL;
    return ALP_OK;
}

alp_result alpi_lighting_take_spots(alpi_lighting *lighting, const alp_lighting_options *options,
                                    alpi_lighting **spots)
{
    alp_context *context = lighting->scene->context;
    alp_lighting_options without = *options;
    alpi_sky *soft = NULL, *bright = NULL;
    without.sky.kind = ALP_SKY_NONE;
    ALP_TRY(create_quietly(lighting->scene, &without, false, spots));
    if (lighting->sky == NULL || !alpi_sky_is_image(lighting->sky)) {
        return ALP_OK;
    }
    const alp_result result = alpi_sky_split(context, lighting->sky, &soft, &bright);
    if (result != ALP_OK) {
        alpi_lighting_destroy(context, *spots);
        *spots = NULL;
        return result;
    }
    alpi_sky_destroy(context, lighting->sky);
    set_sky(lighting, soft);
    set_sky(*spots, bright);
    (*spots)->soft = bright != NULL ? soft : NULL;
    return ALP_OK;
}

void alpi_lighting_destroy(alp_context *context, alpi_lighting *lighting)
{
    if (lighting == NULL) {
        return;
    }
    alpi_sky_destroy(context, lighting->sky);
    alpi_emitters_clear(context, &lighting->emitters);
    alpi_punctual_clear(context, &lighting->punctual);
    alpi_release(context, lighting->suns);
    alpi_light_list_clear(context, &lighting->list);
    alpi_release(context, lighting);
}

// --- questions -----------------------------------------------------------------------------------

bool alpi_lighting_is_dark(const alpi_lighting *lighting)
{
    const alpi_punctual *p = &lighting->punctual;
    return p->listed + p->placed_count + lighting->sun_count + lighting->emitters.count == 0 &&
           lighting->sky == NULL;
}

uint32_t alpi_lighting_light_count(const alpi_lighting *lighting)
{
    return lighting->list.count;
}

const alpi_light *alpi_lighting_light(const alpi_lighting *lighting, uint32_t index)
{
    return &lighting->list.lights[index];
}

const alpi_sky *alpi_lighting_sky(const alpi_lighting *lighting)
{
    return lighting->sky;
}

uint32_t alpi_lighting_emitter_count(const alpi_lighting *lighting)
{
    return lighting->emitters.count;
}

double alpi_lighting_emitter_area(const alpi_lighting *lighting)
{
    double area = 0.0;
    for (uint32_t i = 0; i < lighting->emitters.count; i++) {
        vec3 c[3];
        alpi_triangle_corners(lighting->scene, lighting->emitters.triangles[i], c);
        area += vec3_triangle_area(c[0], c[1], c[2]);
    }
    return area;
}

/// By rays that leave: spots are where to look, drawn alone.
static bool is_met(const alpi_sky *sky)
{
    return sky != NULL && alpi_sky_spot_looks(sky) == NULL;
}

vec3 alpi_lighting_escaped(const alpi_lighting *lighting, vec3 direction)
{
    vec3 sum = {0.0f, 0.0f, 0.0f};
    if (is_met(lighting->sky)) {
        sum = alpi_sky_radiance(lighting->sky, direction);
    }
    if (lighting->soft != NULL) {
        sum = vec3_add(sum, alpi_sky_radiance(lighting->soft, direction));
    }
    for (uint32_t i = 0; i < lighting->sun_count; i++) {
        if (alpi_sun_holds(&lighting->suns[i], direction)) {
            sum = vec3_add(sum, lighting->suns[i].radiance);
        }
    }
    return sum;
}

bool alpi_lighting_sample_light(const alpi_lighting *lighting, uint32_t index, vec3 point, vec2 u,
                                alpi_light_sample *sample)
{
    const alpi_light *light = &lighting->list.lights[index];
    *sample = (alpi_light_sample){.kind = ALPI_LIGHT_CLASS_PUNCTUAL,
                                  .distance = INFINITY,
                                  .density = 1.0f,
                                  .triangle = ALPI_NONE};
    if (light->size > 0.0f) {
        alpi_sun sun = alpi_sun_from(light, index);
        sample->kind = ALPI_LIGHT_CLASS_SUN;
        sample->direction = alpi_sun_sample(&sun, u);
        sample->light = sun.radiance;
        sample->density = (float)alpi_sun_density(&sun);
        return is_lit(sun.radiance);
    }
    alpi_punctual_light at;
    bool lit = alpi_punctual_at(light, point, &at);
    sample->direction = at.direction;
    sample->distance = at.distance;
    sample->light = at.light;
    return lit;
}

// --- draws ---------------------------------------------------------------------------------------

/// Where light is asked for, and the probability of each class there.
typedef struct place {
    const alpi_lighting *lighting;
    vec3 point, normal;
    double weight[ALPI_LIGHT_CLASS_COUNT]; // sum 1, or all 0
    double sun_sum;                        // importance of all suns
    bool by_area;                          // triangles are drawn from by area, not solid angle
} place;

/// Of the emissive triangles together, not more than a sky of the brightest one would give: their
/// hierarchy knows no bound for a point among them.
static double emitters_importance(const alpi_emitters *emitters, vec3 point, vec3 normal)
{
    return emitters->tree == NULL ? 0.0
                                  : fmin(alpi_light_tree_importance(emitters->tree, point, normal),
                                         ALPI_PI * emitters->largest);
}

/// Probabilities from importances. None that may give light falls below LEAST_SHARE: an importance
/// is a bound, which for a point among emitters is far above what they give.
static void share_out(double weight[ALPI_LIGHT_CLASS_COUNT])
{
    double sum = 0.0;
    int there = 0;
    for (int i = 0; i < ALPI_LIGHT_CLASS_COUNT; i++) {
        sum += weight[i];
        there += weight[i] > 0.0;
    }
    const double even = LEAST_SHARE, rest = 1.0 - there * even;
    for (int i = 0; i < ALPI_LIGHT_CLASS_COUNT; i++) {
        const bool some = weight[i] > 0.0 && sum > 0.0 && isfinite(sum);
        weight[i] = some ? even + rest * (weight[i] / sum) : 0.0;
    }
}

static place place_at(const alpi_lighting *lighting, vec3 point, vec3 normal, bool by_area)
{
    place p = {.lighting = lighting, .point = point, .normal = normal, .by_area = by_area};
    for (uint32_t i = 0; i < lighting->sun_count; i++) {
        p.sun_sum += alpi_sun_importance(&lighting->suns[i], normal);
    }
    if (lighting->only >= 0) {
        p.weight[lighting->only] = 1.0;
        return p;
    }
    p.weight[ALPI_LIGHT_CLASS_PUNCTUAL] =
        alpi_punctual_importance(&lighting->punctual, point, normal);
    p.weight[ALPI_LIGHT_CLASS_SUN] = p.sun_sum;
    p.weight[ALPI_LIGHT_CLASS_SURFACE] = emitters_importance(&lighting->emitters, point, normal);
    p.weight[ALPI_LIGHT_CLASS_SKY] = lighting->sky_average;
    share_out(p.weight);
    return p;
}

static double escape_density(const place *p, vec3 direction)
{
    const alpi_lighting *lighting = p->lighting;
    double density = 0.0;
    for (uint32_t i = 0; p->sun_sum > 0.0 && i < lighting->sun_count; i++) {
        const alpi_sun *sun = &lighting->suns[i];
        if (alpi_sun_holds(sun, direction)) {
            density += p->weight[ALPI_LIGHT_CLASS_SUN] * alpi_sun_density(sun) *
                       (alpi_sun_importance(sun, p->normal) / p->sun_sum);
        }
    }
    if (is_met(lighting->sky)) {
        density +=
            p->weight[ALPI_LIGHT_CLASS_SKY] * (double)alpi_sky_density(lighting->sky, direction);
    }
    return density;
}

/// Density, per steradian, of directions to a triangle whose points are as likely everywhere:
/// distance² / (area cosθ), where 2 area cosθ = |direction · (c1 − c0) × (c2 − c0)|.
static double area_density(const vec3 corner[3], vec3 direction, double distance)
{
    const vec3 cross = vec3_cross(vec3_sub(corner[1], corner[0]), vec3_sub(corner[2], corner[0]));
    const double density = 2.0 * distance * distance / fabs((double)vec3_dot(direction, cross));
    return isfinite(density) ? density : 0.0;
}

/// Probability of a class and of one emitter in it; 0: no emitter.
static double emitter_probability(const place *p, uint32_t triangle)
{
    const alpi_emitters *emitters = &p->lighting->emitters;
    const uint32_t emitter = alpi_emitters_find(emitters, triangle);
    if (emitter == ALPI_NONE || !(p->weight[ALPI_LIGHT_CLASS_SURFACE] > 0.0)) {
        return 0.0;
    }
    return p->weight[ALPI_LIGHT_CLASS_SURFACE] *
           alpi_light_tree_probability(emitters->tree, p->point, p->normal, emitter);
}

static double surface_density(const place *p, uint32_t triangle, vec3 direction)
{
    const double probability = emitter_probability(p, triangle);
    if (!(probability > 0.0)) {
        return 0.0;
    }
    vec3 corner[3];
    alpi_triangle_corners(p->lighting->scene, triangle, corner);
    alpi_triangle_view view = alpi_triangle_view_from(p->point, corner);
    return probability * alpi_triangle_density(&view, double3_from(direction));
}

float alpi_lighting_density(const alpi_lighting *lighting, vec3 point, vec3 normal, vec3 direction,
                            uint32_t triangle)
{
    place p = place_at(lighting, point, normal, false);
    return (float)(triangle == ALPI_NONE ? escape_density(&p, direction)
                                         : surface_density(&p, triangle, direction));
}

float alpi_lighting_density_by_area(const alpi_lighting *lighting, vec3 point, vec3 normal,
                                    vec3 direction, uint32_t triangle, float distance)
{
    const place p = place_at(lighting, point, normal, true);
    vec3 corner[3];
    alpi_triangle_corners(lighting->scene, triangle, corner);
    return (float)(emitter_probability(&p, triangle) *
                   area_density(corner, direction, (double)distance));
}

static bool sample_punctual(const place *p, double pick, alpi_light_sample *sample)
{
    uint32_t light = 0;
    double part = alpi_punctual_sample(&p->lighting->punctual, p->point, p->normal, pick, &light);
    alpi_punctual_light at;
    if (!(part > 0.0) || !alpi_punctual_at(&p->lighting->list.lights[light], p->point, &at)) {
        return false;
    }
    sample->direction = at.direction;
    sample->distance = at.distance;
    sample->light = at.light;
    sample->density = (float)(p->weight[ALPI_LIGHT_CLASS_PUNCTUAL] * part);
    return true;
}

/// A direction that is even over the triangle's solid angle, and where it meets it.
static double aim_by_solid_angle(const place *p, const vec3 corner[3], vec2 u,
                                 alpi_light_sample *sample, float b[2])
{
    alpi_triangle_view view = alpi_triangle_view_from(p->point, corner);
    // All that follows is of the direction as a float, so that alpi_lighting_density finds it
    // again.
    sample->direction = double3_to_vec3(alpi_triangle_sample(&view, u));
    double3 direction = double3_from(sample->direction);
    alpi_triangle_hit hit = alpi_triangle_hit_at(&view, direction);
    sample->distance = (float)hit.distance;
    b[0] = hit.b1;
    b[1] = hit.b2;
    return alpi_triangle_density(&view, direction);
}

/// A direction to a point that is even over the triangle's area: √ of one coordinate.
static double aim_by_area(const place *p, const vec3 corner[3], vec2 u, alpi_light_sample *sample,
                          float b[2])
{
    const float root = sqrtf(u.x);
    b[0] = root * (1.0f - u.y);
    b[1] = root * u.y;
    const vec3 at = vec3_mad(vec3_mad(corner[0], b[0], vec3_sub(corner[1], corner[0])), b[1],
                             vec3_sub(corner[2], corner[0]));
    const double3 to = double3_between(p->point, at);
    const double distance = double3_length(to);
    if (!(distance > 0.0)) {
        return 0.0;
    }
    sample->direction = double3_to_vec3(double3_scale(to, 1.0 / distance));
    sample->distance = (float)distance;
    return area_density(corner, sample->direction, distance);
}

static bool sample_surface(const place *p, double pick, vec2 u, alpi_light_sample *sample)
{
    const alpi_emitters *emitters = &p->lighting->emitters;
    uint32_t emitter = 0;
    double part = alpi_light_tree_sample(emitters->tree, p->point, p->normal, pick, &emitter);
    if (!(part > 0.0)) {
        return false;
    }
    vec3 corner[3];
    float b[2] = {0.0f, 0.0f};
    sample->triangle = emitters->triangles[emitter];
    alpi_triangle_corners(p->lighting->scene, sample->triangle, corner);
    const double density = p->by_area ? aim_by_area(p, corner, u, sample, b)
                                      : aim_by_solid_angle(p, corner, u, sample, b);
    sample->light = alpi_surface_emission(p->lighting->scene, sample->triangle, b[0], b[1],
                                          vec3_scale(sample->direction, -1.0f));
    sample->density = (float)(p->weight[ALPI_LIGHT_CLASS_SURFACE] * part * density);
    return true;
}

/// One of the looks, as a light without extent.
static bool sample_spots(const place *p, vec2 u, alpi_light_sample *sample)
{
    const alpi_sky_looks *l = alpi_sky_spot_looks(p->lighting->sky);
    const uint32_t k = (uint32_t)(u.x * (float)ALPI_SKY_LOOKS);
    sample->kind = ALPI_LIGHT_CLASS_PUNCTUAL;
    sample->direction = (vec3){l->direction[0][k], l->direction[1][k], l->direction[2][k]};
    sample->light = (vec3){l->light[0][k], l->light[1][k], l->light[2][k]};
    sample->density = (float)(p->weight[ALPI_LIGHT_CLASS_SKY] / ALPI_SKY_LOOKS);
    return true;
}

static bool sample_escape(const place *p, double pick, vec2 u, alpi_light_sample *sample)
{
    const alpi_lighting *lighting = p->lighting;
    if (sample->kind == ALPI_LIGHT_CLASS_SKY && !is_met(lighting->sky)) {
        return sample_spots(p, u, sample);
    }
    if (sample->kind == ALPI_LIGHT_CLASS_SKY) {
        sample->direction = alpi_sky_sample(lighting->sky, u, NULL);
    } else {
        double rest = pick * p->sun_sum;
        const alpi_sun *sun = NULL; // the last one that gives light, if rounding leads past it
        for (uint32_t i = 0; i < lighting->sun_count && rest >= 0.0; i++) {
            double one = alpi_sun_importance(&lighting->suns[i], p->normal);
            sun = one > 0.0 ? &lighting->suns[i] : sun;
            rest -= one;
        }
        if (sun == NULL) {
            return false;
        }
        sample->direction = alpi_sun_sample(sun, u);
    }
    sample->light = alpi_lighting_escaped(lighting, sample->direction);
    sample->density = (float)escape_density(p, sample->direction);
    return true;
}

static bool draw_light(const place *p, float pick, vec2 u, alpi_light_sample *sample)
{
    double rest = alpi_finer_pick(pick, u);
    int kind = -1;
    for (int i = 0; i < ALPI_LIGHT_CLASS_COUNT; i++) {
        if (p->weight[i] > 0.0) {
            kind = i;
            if (rest < p->weight[i]) {
                break;
            }
            rest -= p->weight[i];
        }
    }
    *sample = (alpi_light_sample){.distance = INFINITY, .triangle = ALPI_NONE};
    if (kind < 0) {
        return false;
    }
    sample->kind = (alpi_light_class)kind;
    rest = fmin(rest / p->weight[kind], 1.0 - 0x1p-53);
    bool drawn = sample->kind == ALPI_LIGHT_CLASS_PUNCTUAL  ? sample_punctual(p, rest, sample)
                 : sample->kind == ALPI_LIGHT_CLASS_SURFACE ? sample_surface(p, rest, u, sample)
                                                            : sample_escape(p, rest, u, sample);
    return drawn && sample->density > 0.0f && isfinite(sample->density) && is_lit(sample->light) &&
           vec3_dot(sample->direction, p->normal) > 0.0f;
}

bool alpi_lighting_sample(const alpi_lighting *lighting, vec3 point, vec3 normal, float pick,
                          vec2 u, alpi_light_sample *sample)
{
    const place p = place_at(lighting, point, normal, false);
    return draw_light(&p, pick, u, sample);
}

bool alpi_lighting_sample_by_area(const alpi_lighting *lighting, vec3 point, vec3 normal,
                                  float pick, vec2 u, alpi_light_sample *sample)
{
    const place p = place_at(lighting, point, normal, true);
    return draw_light(&p, pick, u, sample);
}
