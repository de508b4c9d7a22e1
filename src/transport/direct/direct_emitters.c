// SPDX-License-Identifier: MIT
#include "transport/direct/direct_emitters.h"

#include "base/memory.h"
#include "base/random.h"
#include "scene/lights/polygon_light.h"
#include "scene/lights/triangle_light.h"

static bool are_few(const alpi_direct_emitters *emitters)
{
    return emitters->all.count <= ALPI_DIRECT_FEW;
}

static bool are_listed(const alpi_direct_emitters *emitters)
{
    return emitters->all.count <= ALPI_DIRECT_LISTED;
}

/// The arrays of a list, one after the other.
enum { LIST_ARRAYS = 9 };

static void lay_out(alpi_emitter_list *l, float *arrays, uint32_t count)
{
    float **const all[LIST_ARRAYS] = {&l->centre[0], &l->centre[1], &l->centre[2],
                                      &l->normal[0], &l->normal[1], &l->normal[2],
                                      &l->radius,    &l->power,     &l->two_sided};
    for (size_t k = 0; k < LIST_ARRAYS; k++) {
        *all[k] = arrays + k * count;
    }
}

static void list_triangle(const alp_scene *scene, uint32_t triangle, alpi_emitter_list *l,
                          uint32_t i)
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    const vec3 sum = vec3_add(vec3_add(c[0], c[1]), c[2]);
    const vec3 centre = vec3_scale(sum, 1.0f / 3.0f);
    const vec3 normal = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
    l->centre[0][i] = centre.x;
    l->centre[1][i] = centre.y;
    l->centre[2][i] = centre.z;
    l->normal[0][i] = normal.x;
    l->normal[1][i] = normal.y;
    l->normal[2][i] = normal.z;
    for (int k = 0; k < 3; k++) {
        l->radius[i] = fmaxf(l->radius[i], vec3_length(vec3_sub(c[k], centre)));
    }
    l->power[i] =
        (float)(alpi_emitters_radiance(scene, triangle) * vec3_triangle_area(c[0], c[1], c[2]));
    l->two_sided[i] = alpi_surface_is_double_sided(scene, triangle) ? 1.0f : 0.0f;
}

static alp_result make_list(alpi_direct_emitters *emitters)
{
    const uint32_t count = emitters->all.count;
    float *arrays = NULL;
    ALPI_TRY_NEW(emitters->scene->context, arrays, (size_t)LIST_ARRAYS * count);
    lay_out(&emitters->list, arrays, count);
    for (uint32_t i = 0; i < count; i++) {
        list_triangle(emitters->scene, emitters->all.triangles[i], &emitters->list, i);
    }
    return ALP_OK;
}

alp_result alpi_direct_emitters_collect(const alp_scene *scene, alpi_direct_emitters *emitters)
{
    *emitters = (alpi_direct_emitters){.scene = scene};
    ALP_TRY(alpi_emitters_collect(scene, &emitters->all));
    if (!are_few(emitters)) {
        return are_listed(emitters) ? make_list(emitters) : ALP_OK;
    }
    for (uint32_t i = 0; i < emitters->all.count; i++) {
        emitters->radiance[i] = alpi_emitters_radiance(scene, emitters->all.triangles[i]);
    }
    return ALP_OK;
}

void alpi_direct_emitters_clear(alpi_direct_emitters *emitters)
{
    if (emitters->scene != NULL) {
        alpi_release(emitters->scene->context, emitters->list.centre[0]); // and all after it
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

static void weigh_few(const alpi_receiver_point *points, uint32_t count,
                      alpi_emitter_choice *choice)
{
    const alpi_direct_emitters *emitters = choice->emitters;
    const uint32_t looks = count < LOOKS ? count : LOOKS;
    for (uint32_t i = 0; i < emitters->all.count; i++) {
        const uint32_t triangle = emitters->all.triangles[i];
        const bool two_sided = alpi_surface_is_double_sided(emitters->scene, triangle);
        double weight = 0.0;
        vec3 corner[3];
        alpi_triangle_corners(emitters->scene, triangle, corner);
        const bool any = gives_any(corner, two_sided, points, count);
        for (uint32_t k = 0; any && k < looks; k++) {
            double f;
            weight += look(corner, two_sided, &points[k * count / looks], &f);
            choice->share += f / looks;
        }
        choice->sum += weight * emitters->radiance[i];
        choice->upto[i] = choice->sum;
    }
}

/// Points of a receiver, about one of them: how far others lie from it, in metres, and how much
/// their normals turn, as the length of a difference.
typedef struct lump {
    alpi_receiver_point at;
    float apart, turned;
} lump;

static lump gather_points(const alpi_receiver_point *points, uint32_t count)
{
    lump l = {.at = points[count / 2]};
    for (uint32_t i = 0; i < count; i++) {
        const vec3 n = vec3_sub(points[i].shading_normal, l.at.shading_normal);
        const vec3 p = vec3_sub(points[i].position, l.at.position);
        l.apart = fmaxf(l.apart, vec3_length(p) + points[i].offset);
        l.turned = fmaxf(l.turned, vec3_length(n));
    }
    return l;
}

/// Mean of the positive part of a cosine that is even within ± slack: 0 only where none of it is.
static inline float mean_cosine(float cosine, float slack)
{
    const float above = cosine + slack, part = above * above / (4.0f * slack);
    const float mean = cosine > slack ? cosine : part;
    return above > 0.0f ? mean < 1.0f ? mean : 1.0f : 0.0f;
}

/// Of a small triangle, radiance × area × cosine × cosine / distance². Where a triangle gives any
/// light to any of the points its weight is not 0: a point sees all of its front or nothing, but
/// may see some of it above the horizon. Plain floats, for the compiler to make vectors of.
static void weigh(const alpi_emitter_list *l, uint32_t count, const lump *from, float *weights)
{
    const float x = from->at.position.x, y = from->at.position.y, z = from->at.position.z;
    const vec3 n = from->at.shading_normal;
    const float apart = from->apart, rounding = 1e-4f; // of cosines, at least
    for (uint32_t i = 0; i < count; i++) {
        const float dx = l->centre[0][i] - x, dy = l->centre[1][i] - y, dz = l->centre[2][i] - z;
        const float size = l->radius[i] + apart, squared = dx * dx + dy * dy + dz * dz;
        const float inverse = 1.0f / sqrtf(squared + 1e-30f);
        const float front =
            -inverse * (dx * l->normal[0][i] + dy * l->normal[1][i] + dz * l->normal[2][i]);
        const float back = -front * l->two_sided[i];
        const float height = inverse * (dx * n.x + dy * n.y + dz * n.z);
        const float leaving = mean_cosine(front > back ? front : back, apart * inverse + rounding);
        const float falling = mean_cosine(height, size * inverse + from->turned + rounding);
        weights[i] = l->power[i] * leaving * falling / (squared + size * size);
    }
}

static void weigh_listed(const alpi_receiver_point *points, uint32_t count,
                         alpi_emitter_choice *choice)
{
    const alpi_emitters *all = &choice->emitters->all;
    const lump from = gather_points(points, count);
    float weights[ALPI_DIRECT_LISTED];
    weigh(&choice->emitters->list, all->count, &from, weights);
    for (uint32_t i = 0; i < all->count; i++) {
        choice->sum += (double)weights[i];
        choice->upto[i] = choice->sum;
    }
    choice->share = choice->sum / (ALPI_PI * all->largest);
}

void alpi_emitter_choose(const alpi_direct_emitters *emitters, const alpi_receiver_point *points,
                         uint32_t count, alpi_emitter_choice *choice)
{
    choice->emitters = emitters;
    choice->sum = choice->share = 0.0;
    if (are_few(emitters)) {
        weigh_few(points, count, choice);
    } else if (are_listed(emitters)) {
        weigh_listed(points, count, choice);
    }
}

alpi_emitter_view alpi_emitter_view_from(const alpi_emitter_choice *choice, vec3 point, vec3 normal)
{
    const alpi_direct_emitters *e = choice->emitters;
    alpi_emitter_view view = {.choice = choice, .point = point, .normal = normal};
    if (e->all.count > 0 && are_listed(e)) {
        view.share = choice->sum > 0.0 ? fmax(choice->share, 1e-30) : 0.0;
    } else if (e->all.count > 0) {
        view.share =
            alpi_light_tree_importance(e->all.tree, point, normal) / (ALPI_PI * e->all.largest);
    }
    return view;
}

// --- draws ---------------------------------------------------------------------------------------

/// Probability that a triangle is drawn.
static double chance_of(const alpi_emitter_choice *c, uint32_t place)
{
    return (c->upto[place] - (place > 0 ? c->upto[place - 1] : 0.0)) / c->sum;
}

/// One of those listed. What is left of u->x is as even as it was, and stays stratified within the
/// triangle.
static double pick_listed(const alpi_emitter_choice *c, vec2 *u, uint32_t *place)
{
    uint32_t low = 0, high = c->emitters->all.count - 1; // the first whose sum is above the pick
    const double pick = (double)u->x * c->sum;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (c->upto[middle] > pick) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    const double before = low > 0 ? c->upto[low - 1] : 0.0, weight = c->upto[low] - before;
    if (!(weight > 0.0)) {
        return 0.0; // rounding led past the last that gives any
    }
    *place = low;
    u->x = fminf((float)((pick - before) / weight), 1.0f - 0x1p-24f);
    return weight / c->sum;
}

bool alpi_emitter_sample(const alpi_emitter_view *view, float pick, vec2 u,
                         alpi_light_sample *sample)
{
    const alpi_direct_emitters *e = view->choice->emitters;
    uint32_t place = 0;
    *sample = (alpi_light_sample){.kind = ALPI_LIGHT_CLASS_SURFACE};
    const double part = are_listed(e)
                            ? pick_listed(view->choice, &u, &place)
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
        are_listed(e) ? chance_of(view->choice, place)
                      : alpi_light_tree_probability(e->all.tree, view->point, view->normal, place);
    vec3 corner[3];
    alpi_triangle_corners(e->scene, triangle, corner);
    const alpi_triangle_view seen = alpi_triangle_view_from(view->point, corner);
    return part * alpi_triangle_density(&seen, double3_from(direction));
}
