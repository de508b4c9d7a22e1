// SPDX-License-Identifier: MIT
#include "transport/direct_emitters.h"

#include "base/random.h"
#include "scene/polygon_light.h"
#include "scene/triangle_light.h"

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

// --- choices -------------------------------------------------------------------------------------

/// From how many of the points form factors are computed, each of which costs some rays' time; and
/// the least weight, as a cosine, of a triangle that these see from behind or below the horizon.
enum { LOOKS = 4 };
static const double LEAST_COSINE = 1.0 / 8.0;

/// The largest cosine at a corner of a triangle, at least 0.
static double largest_cosine(const alpi_triangle_view *seen, vec3 normal)
{
    double largest = 0.0;
    for (int k = 0; k < 3; k++) {
        largest = fmax(largest, double3_dot(double3_unit(seen->corner[k]), double3_from(normal)));
    }
    return largest;
}

/// Whether a triangle can give any light at one of the points: in front of it, and it above the
/// horizon.
static bool gives_any(const vec3 corner[3], bool two_sided, const alpi_receiver_point *points,
                      uint32_t count)
{
    const double3 front =
        double3_cross(double3_between(corner[0], corner[1]), double3_between(corner[0], corner[2]));
    for (uint32_t i = 0; i < count; i++) {
        const double3 normal = double3_from(points[i].shading_normal);
        bool above = false;
        for (int k = 0; k < 3; k++) {
            const double3 to = double3_between(points[i].position, corner[k]);
            above = above || double3_dot(to, normal) > 0.0;
        }
        const double height = double3_dot(front, double3_between(corner[0], points[i].position));
        if (above && (two_sided || height > 0.0)) {
            return true;
        }
    }
    return false;
}

/// The variance of what a draw brings is least where triangles are drawn in proportion to the root
/// of ∫ cos²θ dω × solid angle, which is at most √(largest cosine × π × form factor × solid angle).
/// The form factor alone would draw too seldom a triangle of which little is above the horizon.
static double look(const vec3 corner[3], bool two_sided, const alpi_receiver_point *p, double *f)
{
    *f = alpi_polygon_form_factor(p->position, p->shading_normal, corner, 3);
    *f = two_sided ? fabs(*f) : fmax(*f, 0.0);
    const alpi_triangle_view seen = alpi_triangle_view_from(p->position, corner);
    const double angle = fmax(seen.solid_angle, ALPI_PI * *f); // a speck's may round to 0
    const double root = sqrt(largest_cosine(&seen, p->shading_normal) * ALPI_PI * *f * angle);
    return fmax(root, LEAST_COSINE * angle);
}

alpi_emitter_choice alpi_emitter_choose(const alpi_direct_emitters *emitters,
                                        const alpi_receiver_point *points, uint32_t count)
{
    alpi_emitter_choice choice = {.emitters = emitters};
    const uint32_t looks = count < LOOKS ? count : LOOKS;
    for (uint32_t i = 0; are_few(emitters) && i < emitters->all.count; i++) {
        const uint32_t triangle = emitters->all.triangles[i];
        const bool two_sided = alpi_surface_is_double_sided(emitters->scene, triangle);
        vec3 corner[3];
        alpi_triangle_corners(emitters->scene, triangle, corner);
        if (!gives_any(corner, two_sided, points, count)) {
            continue;
        }
        for (uint32_t k = 0; k < looks; k++) {
            double f;
            choice.weight[i] += look(corner, two_sided, &points[k * count / looks], &f);
            choice.share += f / looks;
        }
        choice.weight[i] *= emitters->radiance[i];
        choice.sum += choice.weight[i];
    }
    return choice;
}

alpi_emitter_view alpi_emitter_view_from(const alpi_emitter_choice *choice, vec3 point, vec3 normal)
{
    const alpi_direct_emitters *e = choice->emitters;
    alpi_emitter_view view = {.choice = choice, .point = point, .normal = normal};
    if (e->all.count > 0 && are_few(e)) {
        view.share = choice->sum > 0.0 ? fmax(choice->share, 1e-30) : 0.0;
    } else if (e->all.count > 0) {
        view.share =
            alpi_light_tree_importance(e->all.tree, point, normal) / (ALPI_PI * e->all.largest);
    }
    return view;
}

// --- draws ---------------------------------------------------------------------------------------

/// One of few. What is left of u->x is as even as it was, and stays stratified within the triangle.
static double pick_of_few(const alpi_emitter_choice *c, vec2 *u, uint32_t *place)
{
    double rest = (double)u->x * c->sum;
    uint32_t last = ALPI_NONE; // that gives light: rounding may lead past it
    for (uint32_t i = 0; i < c->emitters->all.count; i++) {
        if (!(c->weight[i] > 0.0)) {
            continue;
        }
        last = i;
        if (rest < c->weight[i]) {
            break;
        }
        rest -= c->weight[i];
    }
    if (last == ALPI_NONE) {
        return 0.0;
    }
    *place = last;
    u->x = fminf((float)(rest / c->weight[last]), 1.0f - 0x1p-24f);
    return c->weight[last] / c->sum;
}

bool alpi_emitter_sample(const alpi_emitter_view *view, float pick, vec2 u,
                         alpi_light_sample *sample)
{
    const alpi_direct_emitters *e = view->choice->emitters;
    uint32_t place = 0;
    *sample = (alpi_light_sample){.kind = ALPI_LIGHT_CLASS_SURFACE};
    const double part = are_few(e) ? pick_of_few(view->choice, &u, &place)
                                   : alpi_light_tree_sample(e->all.tree, view->point, view->normal,
                                                            alpi_finer_pick(pick, u), &place);
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
    const alpi_direct_emitters *e = view->choice->emitters;
    const uint32_t place = alpi_emitters_find(&e->all, triangle);
    if (place == ALPI_NONE || !(view->share > 0.0)) {
        return 0.0;
    }
    const double part =
        are_few(e) ? view->choice->weight[place] / view->choice->sum
                   : alpi_light_tree_probability(e->all.tree, view->point, view->normal, place);
    vec3 corner[3];
    alpi_triangle_corners(e->scene, triangle, corner);
    const alpi_triangle_view seen = alpi_triangle_view_from(view->point, corner);
    return part * alpi_triangle_density(&seen, double3_from(direction));
}
