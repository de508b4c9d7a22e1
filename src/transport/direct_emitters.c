// SPDX-License-Identifier: MIT
#include "transport/direct_emitters.h"

#include "base/random.h"
#include "scene/polygon_light.h"
#include "scene/triangle_light.h"

#include <string.h>

static bool are_few(const alpi_direct_emitters *emitters)
{
    return emitters->all.count <= ALPI_DIRECT_FEW;
}

alp_result alpi_direct_emitters_collect(const alp_scene *scene, alpi_direct_emitters *emitters)
{
    *emitters = (alpi_direct_emitters){.scene = scene};
    ALP_TRY(alpi_emitters_collect(scene, &emitters->all));
    for (uint32_t i = 0; are_few(emitters) && i < emitters->all.count; i++) {
        emitters->radiance[i] = alpi_emitters_radiance(scene, emitters->all.triangles[i]);
    }
    return ALP_OK;
}

void alpi_direct_emitters_clear(alpi_direct_emitters *emitters)
{
    if (emitters->scene != NULL) {
        alpi_emitters_clear(emitters->scene->context, &emitters->all);
    }
}

// --- views ---------------------------------------------------------------------------------------

/// The largest cosine at a corner of a triangle, at least 0.
static double largest_cosine(const alpi_triangle_view *seen, vec3 normal)
{
    double largest = 0.0;
    for (int k = 0; k < 3; k++) {
        largest = fmax(largest, double3_dot(double3_unit(seen->corner[k]), double3_from(normal)));
    }
    return largest;
}

/// The variance of what a draw brings is least where triangles are drawn in proportion to the root
/// of ∫ cos²θ dω × solid angle, which is at most √(largest cosine × π × form factor × solid angle).
/// The form factor alone would draw too seldom a triangle of which little is above the horizon.
static void look_at_few(alpi_emitter_view *view)
{
    const alpi_direct_emitters *e = view->emitters;
    double filled = 0.0;
    for (uint32_t i = 0; i < e->all.count; i++) {
        const uint32_t triangle = e->all.triangles[i];
        vec3 corner[3];
        alpi_triangle_corners(e->scene, triangle, corner);
        double f = alpi_polygon_form_factor(view->point, view->normal, corner, 3);
        f = alpi_surface_is_double_sided(e->scene, triangle) ? fabs(f) : fmax(f, 0.0);
        const alpi_triangle_view seen = alpi_triangle_view_from(view->point, corner);
        const double cosine = largest_cosine(&seen, view->normal);
        const double angle = fmax(seen.solid_angle, ALPI_PI * f); // a speck's may round to 0
        view->weight[i] = e->radiance[i] * sqrt(cosine * ALPI_PI * f * angle);
        view->sum += view->weight[i];
        filled += f;
    }
    view->share = view->sum > 0.0 ? filled : 0.0;
}

alpi_emitter_view alpi_emitter_view_from(const alpi_direct_emitters *emitters, vec3 point,
                                         vec3 normal)
{
    alpi_emitter_view view = {.emitters = emitters, .point = point, .normal = normal};
    if (emitters->all.count == 0) {
        return view;
    }
    if (are_few(emitters)) {
        look_at_few(&view);
    } else {
        view.share = alpi_light_tree_importance(emitters->all.tree, point, normal) /
                     (ALPI_PI * emitters->all.largest);
    }
    return view;
}

// --- draws ---------------------------------------------------------------------------------------

/// One of few. What is left of u->x is as even as it was, and stays stratified within the triangle.
static double pick_of_few(const alpi_emitter_view *view, vec2 *u, uint32_t *place)
{
    double rest = (double)u->x * view->sum;
    uint32_t last = ALPI_NONE; // that gives light: rounding may lead past it
    for (uint32_t i = 0; i < view->emitters->all.count; i++) {
        if (!(view->weight[i] > 0.0)) {
            continue;
        }
        last = i;
        if (rest < view->weight[i]) {
            break;
        }
        rest -= view->weight[i];
    }
    if (last == ALPI_NONE) {
        return 0.0;
    }
    *place = last;
    u->x = fminf((float)(rest / view->weight[last]), 1.0f - 0x1p-24f);
    return view->weight[last] / view->sum;
}

/// 24 digits cannot tell 2^24 triangles apart, nor find one of less than a 2^-24th: the new ones
/// are a hash of u, which they leave as even as it was.
static double with_more_digits(float pick, vec2 u)
{
    uint32_t x, y;
    memcpy(&x, &u.x, sizeof x);
    memcpy(&y, &u.y, sizeof y);
    return (double)pick + (double)alpi_hash32(alpi_hash32(x) ^ y) * 0x1p-56;
}

bool alpi_emitter_sample(const alpi_emitter_view *view, float pick, vec2 u,
                         alpi_light_sample *sample)
{
    const alpi_direct_emitters *e = view->emitters;
    uint32_t place = 0;
    *sample = (alpi_light_sample){.kind = ALPI_LIGHT_CLASS_SURFACE};
    const double part = are_few(e) ? pick_of_few(view, &u, &place)
                                   : alpi_light_tree_sample(e->all.tree, view->point, view->normal,
                                                            with_more_digits(pick, u), &place);
    if (!(part > 0.0)) {
        return false;
    }
    vec3 corner[3];
    sample->triangle = e->all.triangles[place];
    alpi_triangle_corners(e->scene, sample->triangle, corner);
    const alpi_triangle_view seen = alpi_triangle_view_from(view->point, corner);
    // All that follows is of the direction as a float, which is what a ray has.
    sample->direction = double3_to_vec3(alpi_triangle_sample(&seen, u));
    const double3 direction = double3_from(sample->direction);
    const alpi_triangle_hit hit = alpi_triangle_hit_at(&seen, direction);
    sample->distance = (float)hit.distance;
    sample->light = alpi_surface_emission(e->scene, sample->triangle, hit.b1, hit.b2,
                                          vec3_scale(sample->direction, -1.0f));
    sample->density = (float)(part * alpi_triangle_density(&seen, direction));
    const vec3 l = sample->light;
    return sample->density > 0.0f && isfinite(sample->density) &&
           (l.x > 0.0f || l.y > 0.0f || l.z > 0.0f);
}

double alpi_emitter_density(const alpi_emitter_view *view, vec3 direction, uint32_t triangle)
{
    const alpi_direct_emitters *e = view->emitters;
    const uint32_t place = alpi_emitters_find(&e->all, triangle);
    if (place == ALPI_NONE || !(view->share > 0.0)) {
        return 0.0;
    }
    const double part =
        are_few(e) ? view->weight[place] / view->sum
                   : alpi_light_tree_probability(e->all.tree, view->point, view->normal, place);
    vec3 corner[3];
    alpi_triangle_corners(e->scene, triangle, corner);
    const alpi_triangle_view seen = alpi_triangle_view_from(view->point, corner);
    return part * alpi_triangle_density(&seen, double3_from(direction));
}
