// SPDX-License-Identifier: MIT
// The doctor's look at both sides of surfaces, by rays: what lies inside other objects, and sheets
// whose two sides share texels but not the sky.
#include "doctor/doctor_rays.h"

#include "base/memory.h"

#include <math.h>

/// 16 rays a side, on points that stand for equal areas.
enum { POINTS = 8192, RAYS = ALPI_DOCTOR_RAYS, POINTS_PER_RANGE = 64, STREAM_SIDES = 202 };
/// Points from which a surface's shares say something: with half of them a standard error of 1/8.
/// A surface has as many from 0.2 % of the scene's area on.
enum { LEAST_POINTS = 16 };
/// Solids that are built together reach into each other, with some of their surface. From half of
/// it on more of an object's texels are wasted than seen.
static const double BURIED_SHARE = 0.5;
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

/// What is known of a point.
typedef struct found {
    uint32_t inside; // surface that the point is in, ALPI_NONE = in none
    bool thin;
} found;

/// @param sign 1 = the front, −1 = the back
/// @param all  false: a side that sees the sky need not be looked at further
static side look_to(const alpi_doctor_points *points, uint32_t point, float sign, bool all)
{
    const alp_scene *scene = points->scene;
    const uint32_t *surfaces = scene->triangle_surface;
    const uint32_t own = surfaces[points->points[point].triangle];
    const float reach =
        (float)FAR_SHARE * vec3_length(vec3_sub(scene->bounds_max, scene->bounds_min));
    side seen = {.around = ALPI_NONE};
    for (uint32_t first = 0; first < RAYS && (all || seen.open == 0); first += ALPI_PACKET) {
        alpi_doctor_hit hits[ALPI_PACKET];
        alpi_doctor_look_from(points, point, sign, STREAM_SIDES, first, hits);
        for (int i = 0; i < ALPI_PACKET; i++) {
            const bool open = hits[i].triangle == ALPI_NONE;
            seen.open += open;
            seen.far += open || hits[i].distance > reach;
            if (hits[i].back && surfaces[hits[i].triangle] != own) {
                seen.around = seen.backs++ == 0 ? surfaces[hits[i].triangle] : seen.around;
            }
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

static void look_from(const alpi_doctor_points *points, uint32_t point, void *kept)
{
    found *f = kept;
    const bool sheet = is_sheet(points->scene, points->points[point].triangle);
    const side front = look_to(points, point, 1.0f, sheet);
    f->inside = front.open == 0 && front.backs >= BACKS_INSIDE ? front.around : ALPI_NONE;
    if (sheet) {
        const side back = look_to(points, point, -1.0f, true);
        f->thin = are_apart(&front, &back);
    }
}

// --- by surface ----------------------------------------------------------------------------------

/// Of each surface. Shares are 0 where they are not worth a word.
typedef struct tallies {
    double *buried, *thin;         // [surface_count] points, then shares
    uint32_t *points;              // [surface_count]
    uint32_t *buried_at, *thin_at; // [surface_count] the first such point
} tallies;

/// Whether more than half of a surface is surely inside: by two standard errors of a share.
static bool is_buried(double share, double points)
{
    return share - 2.0 * sqrt(share * (1.0 - share) / points) >= BURIED_SHARE;
}

static void add_up(const alpi_doctor_points *p, const found *all, const tallies *t)
{
    for (uint32_t i = 0; i < p->count; i++) {
        const uint32_t surface = p->scene->triangle_surface[p->points[i].triangle];
        t->points[surface]++;
        if (all[i].inside != ALPI_NONE && t->buried[surface]++ == 0.0) {
            t->buried_at[surface] = i;
        }
        if (all[i].thin && t->thin[surface]++ == 0.0) {
            t->thin_at[surface] = i;
        }
    }
    for (uint32_t i = 0; i < p->scene->surface_count; i++) {
        const double points = t->points[i] >= LEAST_POINTS ? t->points[i] : HUGE_VAL;
        const double buried = t->buried[i] / points, thin = t->thin[i] / points;
        t->buried[i] = is_buried(buried, points) ? buried : 0.0;
        t->thin[i] = thin >= THIN_SHARE ? thin : 0.0;
    }
}

static alp_result tell_buried(alp_diagnosis *d, const alpi_doctor_points *p, const found *all,
                              const tallies *t)
{
    uint32_t worst[ALPI_DOCTOR_SURFACES], surfaces;
    const uint32_t count = alpi_doctor_choose_worst(d->scene, t->buried, worst, &surfaces);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t point = t->buried_at[worst[i]];
        const double share = t->buried[worst[i]];
        const alpi_finding_facts facts = {ALP_FINDING_BURIED, ALP_PLACE_SURFACE, worst[i], surfaces,
                                          share};
        ALP_TRY(alpi_diagnosis_add(
            d, facts, "%.3g %% of it, %.2g %% of all area, lies inside other objects, such as %s",
            100.0 * share, 100.0 * share * t->points[worst[i]] / p->count,
            alpi_doctor_label(d->scene, all[point].inside).text));
        alpi_doctor_mark_point(d, &p->points[point]);
    }
    return ALP_OK;
}

static alp_result tell_thin(alp_diagnosis *d, const alpi_doctor_points *p, const tallies *t)
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
        alpi_doctor_mark_point(d, &p->points[t->thin_at[worst[i]]]);
    }
    return ALP_OK;
}

static alp_result tell(alp_diagnosis *d, const alpi_doctor_points *points, const void *kept)
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
        add_up(points, kept, &t);
        result = tell_buried(d, points, kept, &t);
        result = result == ALP_OK ? tell_thin(d, points, &t) : result;
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
    const alpi_doctor_survey survey = {POINTS, POINTS_PER_RANGE, sizeof(found), look_from, tell};
    return alpi_doctor_take_survey(diagnosis, &survey);
}
