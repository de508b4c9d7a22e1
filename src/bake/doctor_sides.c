// SPDX-License-Identifier: MIT
// The doctor's look at both sides of surfaces, by rays: what lies inside other objects, and sheets
// whose two sides share texels but not the sky.
#include "bake/doctor.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "base/warp.h"
#include "scene/area_points.h"
#include "scene/receivers.h"
#include "trace/trace.h"

#include <math.h>

/// 16 rays a side, on points that stand for equal areas.
enum { POINTS = 8192, RAYS = 2 * ALPI_PACKET, POINTS_PER_RANGE = 64, STREAM_SIDES = 202 };
/// Points from which a surface's shares say something: with half of them a standard error of 1/8.
/// A surface has as many from 0.2 % of the scene's area on.
enum { LEAST_POINTS = 16 };
/// Solids that are built together reach into each other: steps into the ground, gables into roofs,
/// with four fifths of their surface. What is inside to nine tenths is nothing that anybody sees.
static const double BURIED_SHARE = 0.9;
/// The same of sheets: less is where one ends at a wall.
static const double THIN_SHARE = 0.25;
/// Inside: half of the rays at least meet backs of other surfaces, and none the sky. Others meet
/// what else is inside.
enum { BACKS_INSIDE = RAYS / 2 };
/// A side is seen where a quarter of its rays come farther than this share of the scene's diagonal:
/// the underside of a carpet is not.
enum { RAYS_SEEN = RAYS / 4 };
static const double FAR_SHARE = 0.02;
/// Sky seen by one side and not by the other: half of it, eight grey levels of ten. The other side
/// must see some too: the inside of a closed shell, which sees none, is looked at by nobody.
enum { RAYS_APART = RAYS / 2 };

/// What a side of a point sees.
typedef struct side {
    uint32_t open, far; // rays that meet nothing; that come far
    uint32_t backs;     // that meet backs of single-sided surfaces, not the point's own
    uint32_t around;    // surface of the first of them
} side;

typedef struct sides {
    const alp_scene *scene;
    const alpi_tracer *tracer;
    float reach; // metres: far
    alpi_area_point points[POINTS];
    uint32_t inside[POINTS]; // surface that the point is in, ALPI_NONE = in none
    bool thin[POINTS];
} sides;

static bool is_back(const alp_scene *scene, uint32_t triangle, vec3 direction)
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    const vec3 face = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
    return vec3_dot(face, direction) > 0.0f && !alpi_surface_is_double_sided(scene, triangle) &&
           !alpi_surface_is_pane(scene, scene->triangle_surface[triangle]);
}

static void add_hit(const sides *s, uint32_t own, const alpi_hits *hits, int lane, vec3 direction,
                    side *seen)
{
    const uint32_t triangle = hits->triangle[lane];
    seen->open += triangle == ALPI_NONE;
    seen->far += triangle == ALPI_NONE || hits->distance[lane] > s->reach;
    if (triangle != ALPI_NONE && s->scene->triangle_surface[triangle] != own &&
        is_back(s->scene, triangle, direction)) {
        seen->around = seen->backs++ == 0 ? s->scene->triangle_surface[triangle] : seen->around;
    }
}

/// @param sign 1 = the front, −1 = the back
/// @param all  false: a side that sees the sky need not be looked at further
static side look_to(const sides *s, uint32_t point, float sign, bool all)
{
    const alpi_area_point *at = &s->points[point];
    vec3 c[3], t, b, directions[ALPI_PACKET];
    alpi_triangle_corners(s->scene, at->triangle, c);
    const vec3 face = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
    const vec3 normal = vec3_scale(face, sign);
    vec3 p = vec3_scale(c[0], 1.0f - at->b1 - at->b2);
    p = vec3_mad(vec3_mad(p, at->b1, c[1]), at->b2, c[2]);
    p = vec3_mad(p, alpi_receiver_offset(p, c), normal);
    side seen = {.around = ALPI_NONE};
    vec3_frame(normal, &t, &b);
    for (uint32_t first = 0; first < RAYS && (all || seen.open == 0); first += ALPI_PACKET) {
        alpi_rays rays;
        alpi_hits hits;
        alpi_rays_clear(&rays);
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            const vec3 local = alpi_warp_cosine_cone(
                alpi_sample_2d(alpi_random_key(0, point, STREAM_SIDES), first + i), 1.0f);
            directions[i] = vec3_normalize_or(
                vec3_mad(vec3_mad(vec3_scale(t, local.x), local.y, b), local.z, normal), normal);
            alpi_rays_set(&rays, (int)i, p, directions[i], (float)INFINITY);
        }
        alpi_trace_nearest(s->tracer, &rays, (1u << ALPI_PACKET) - 1u,
                           (alpi_trace_filter){.one_sided = false}, &hits);
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            add_hit(s, s->scene->triangle_surface[at->triangle], &hits, (int)i, directions[i],
                    &seen);
        }
    }
    return seen;
}

/// Leaves and nets are cut from sheets; nobody minds their backs. Glass has none.
static bool is_sheet(const alp_scene *scene, uint32_t triangle)
{
    const uint32_t surface = scene->triangle_surface[triangle];
    const uint32_t material = scene->surfaces[surface].material;
    return alpi_surface_is_double_sided(scene, triangle) && !alpi_surface_is_pane(scene, surface) &&
           (material == ALPI_NONE || scene->materials[material].alpha_mode == ALPI_ALPHA_OPAQUE);
}

static bool are_apart(const side *a, const side *b)
{
    const uint32_t least = a->open < b->open ? a->open : b->open;
    const uint32_t most = a->open < b->open ? b->open : a->open;
    return least > 0 && most - least >= RAYS_APART && a->far >= RAYS_SEEN && b->far >= RAYS_SEEN;
}

static alp_result look_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    sides *s = user;
    (void)worker;
    for (uint32_t i = begin; i < end; i++) {
        const bool sheet = is_sheet(s->scene, s->points[i].triangle);
        const side front = look_to(s, i, 1.0f, sheet);
        s->inside[i] = front.open == 0 && front.backs >= BACKS_INSIDE ? front.around : ALPI_NONE;
        if (sheet) {
            const side back = look_to(s, i, -1.0f, true);
            s->thin[i] = are_apart(&front, &back);
        }
    }
    return ALP_OK;
}

// --- by surface ----------------------------------------------------------------------------------

typedef struct tallies {
    double *buried, *thin; // [surface_count] points, then shares where they are worth a word
    uint32_t *points;      // [surface_count]
    uint32_t *buried_at, *thin_at; // [surface_count] the first such point
} tallies;

static void add_up(const sides *s, const tallies *t)
{
    for (uint32_t i = 0; i < POINTS; i++) {
        const uint32_t surface = s->scene->triangle_surface[s->points[i].triangle];
        t->points[surface]++;
        if (s->inside[i] != ALPI_NONE && t->buried[surface]++ == 0.0) {
            t->buried_at[surface] = i;
        }
        if (s->thin[i] && t->thin[surface]++ == 0.0) {
            t->thin_at[surface] = i;
        }
    }
    for (uint32_t i = 0; i < s->scene->surface_count; i++) {
        const double points = t->points[i] >= LEAST_POINTS ? t->points[i] : HUGE_VAL;
        t->buried[i] = t->buried[i] / points >= BURIED_SHARE ? t->buried[i] / points : 0.0;
        t->thin[i] = t->thin[i] / points >= THIN_SHARE ? t->thin[i] / points : 0.0;
    }
}

static void mark_point(alp_diagnosis *d, const alpi_area_point *at)
{
    vec3 c[3];
    alpi_triangle_corners(d->scene, at->triangle, c);
    vec3 p = vec3_scale(c[0], 1.0f - at->b1 - at->b2);
    p = vec3_mad(vec3_mad(p, at->b1, c[1]), at->b2, c[2]);
    alpi_diagnosis_mark(d, at->triangle, p, NULL);
}

static alp_result tell_buried(alp_diagnosis *d, const sides *s, const tallies *t)
{
    uint32_t worst[ALPI_DOCTOR_SURFACES], all;
    const uint32_t count = alpi_doctor_choose_worst(d->scene, t->buried, worst, &all);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t point = t->buried_at[worst[i]];
        const alpi_finding_facts facts = {ALP_FINDING_BURIED, ALP_PLACE_SURFACE, worst[i], all,
                                          t->buried[worst[i]]};
        ALP_TRY(alpi_diagnosis_add(
            d, facts, "%.3g %% of it lies inside other objects, such as %.60s",
            100.0 * t->buried[worst[i]], d->scene->surfaces[s->inside[point]].name));
        mark_point(d, &s->points[point]);
    }
    return ALP_OK;
}

static alp_result tell_thin(alp_diagnosis *d, const sides *s, const tallies *t)
{
    uint32_t worst[ALPI_DOCTOR_SURFACES], all;
    const uint32_t count = alpi_doctor_choose_worst(d->scene, t->thin, worst, &all);
    for (uint32_t i = 0; i < count; i++) {
        const alpi_finding_facts facts = {ALP_FINDING_THIN_WALL, ALP_PLACE_SURFACE, worst[i], all,
                                          t->thin[worst[i]]};
        ALP_TRY(alpi_diagnosis_add(d, facts,
                                   "on %.3g %% of it one side sees much more of the sky than the "
                                   "other, and both share their texels",
                                   100.0 * t->thin[worst[i]]));
        mark_point(d, &s->points[t->thin_at[worst[i]]]);
    }
    return ALP_OK;
}

static alp_result tell(alp_diagnosis *d, const sides *s)
{
    alp_context *context = d->context;
    const uint32_t count = d->scene->surface_count;
    const tallies t = {.buried = ALPI_NEW(context, double, count),
                       .thin = ALPI_NEW(context, double, count),
                       .points = ALPI_NEW(context, uint32_t, count),
                       .buried_at = ALPI_NEW(context, uint32_t, count),
                       .thin_at = ALPI_NEW(context, uint32_t, count)};
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    if (t.buried != NULL && t.thin != NULL && t.points != NULL && t.buried_at != NULL &&
        t.thin_at != NULL) {
        add_up(s, &t);
        result = tell_buried(d, s, &t);
        result = result == ALP_OK ? tell_thin(d, s, &t) : result;
    }
    alpi_release(context, t.buried);
    alpi_release(context, t.thin);
    alpi_release(context, t.points);
    alpi_release(context, t.buried_at);
    alpi_release(context, t.thin_at);
    return result;
}

alp_result alpi_doctor_look_at_sides(alp_diagnosis *diagnosis)
{
    const alp_scene *scene = diagnosis->scene;
    if (scene->usable_count == 0) {
        return ALP_OK;
    }
    alpi_tracer *tracer = NULL;
    ALP_TRY(alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    sides *s = ALPI_NEW(diagnosis->context, sides, 1);
    if (s == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    s->scene = scene;
    s->tracer = tracer;
    s->reach = (float)FAR_SHARE * vec3_length(vec3_sub(scene->bounds_max, scene->bounds_min));
    alp_result result = ALP_OK;
    if (alpi_area_points(scene, POINTS, s->points)) {
        result =
            alpi_parallel_for(diagnosis->context, POINTS, POINTS_PER_RANGE, look_range, s, NULL);
        result = result == ALP_OK ? tell(diagnosis, s) : result;
    }
    alpi_release(diagnosis->context, s);
    return result;
}
