// SPDX-License-Identifier: MIT
// Anchors sampled by rays through a scene. Rays meet surfaces. Direct light of lamps and suns there
// is traced. All other light is looked up in the snapshot of the last update. So light bounces once
// more with each renewal.
#include "base/hash.h"
#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "fields/ambience/ambience.h"
#include "fields/ambience/ambience_ground.h"
#include "fields/truth.h"
#include "scene/lights/lighting.h"
#include "transport/sphere/sphere_hits.h"

#include <math.h>
#include <string.h>

enum { BATCH = 64, QUARTERS = 4 /* cost of a sample */, QUICK_FACE = 4 };
/// Rays are aimed at emissive surfaces that are less than this share of all surfaces.
static const double AIMED_AREA = 0.1;
/// An anchor nearer to a surface than this share of the finest cell lies on it.
static const float ON_SURFACE = 1e-3f;
/// Floors and walls often lie at whole numbers: the lattice is moved by this share of its cell.
static const double BESIDE_PLANES[3] = {0.37, 0.43, 0.41};
/// Hits are near each other within a quarter of this times their distance: about four rays apart.
static const float CELL_SCALE = 2.0f;
/// Radii of a sphere within which it changes light: beyond, it covers 1.6 % of the directions.
static const double OCCLUDER_REACH = 4.0;

struct alp_ambience_sampler {
    alp_ambience *ambience;
    const alp_scene *scene; // that rays meet
    alp_scene *simple;      // NULL, or the same: the sampler's own
    alp_ambience_sampler_options options;
    alpi_tracer *tracer;
    alpi_lighting *soft;  // all light, of the sky the part that rays meet
    alpi_lighting *spots; // sources that rays are aimed at; NULL of a single lamp or sun
    alpi_occluders occluders;
    alpi_sphere_hits_point points[BATCH];
    uint32_t anchors[BATCH];
    float (*moments)[ALPI_AMBIENCE_MOMENTS][2]; // [BATCH]
};

alp_ambience_sampler_options alp_ambience_sampler_options_default(void)
{
    return (alp_ambience_sampler_options){.struct_size = sizeof(alp_ambience_sampler_options),
                                          .lighting = alp_lighting_options_default(),
                                          .face = 16,
                                          .first_face = 8,
                                          .bounces = true,
                                          .light = ALPI_NONE,
                                          .keep_hits = true};
}

// --- life ----------------------------------------------------------------------------------------

static void drop_hits(alp_ambience *ambience, alpi_anchor *anchor)
{
    ambience->hit_bytes -= alpi_sphere_hits_count(anchor->hits_face) * sizeof(alpi_sphere_hit);
    alpi_release(ambience->context, anchor->hits);
    anchor->hits = NULL;
}

/// Hits are of one scene.
static void drop_all_hits(alp_ambience *a)
{
    for (uint32_t i = 0; i < a->anchor_end; i++) {
        alpi_anchor *at = &a->anchors[i];
        if (at->state != ALPI_ANCHOR_FREE && at->hits != NULL) {
            drop_hits(a, at);
        }
    }
}

static alp_result check_options(const alp_ambience_sampler_options *o, const alp_scene *scene)
{
    const uint32_t faces[2] = {o->face, o->first_face};
    if (o->struct_size != sizeof *o) {
        return alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                         "ambience sampler options are not from _default()");
    }
    for (int i = 0; i < 2; i++) {
        if (faces[i] < QUICK_FACE || faces[i] > ALPI_HITS_FACE_MOST || faces[i] % 4 != 0) {
            return alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                             "ambience: %u rays along a face, need a multiple of 4 from 4 to %d",
                             faces[i], ALPI_HITS_FACE_MOST);
        }
    }
    if (!(o->detail >= 0.0f) || !isfinite(o->detail)) {
        return alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                         "ambience: detail of %g m, need a finite one ≥ 0", (double)o->detail);
    }
    return alpi_lighting_refuse_darkness(scene, &o->lighting);
}

static void clear_lighting(alp_ambience_sampler *s)
{
    alpi_lighting_destroy(s->scene->context, s->spots); // reads the sky of the other
    alpi_lighting_destroy(s->scene->context, s->soft);
    s->soft = s->spots = NULL;
}

static alp_result make_lighting(alp_ambience_sampler *s)
{
    const alp_lighting_options *o = &s->options.lighting;
    ALP_TRY(alpi_lighting_create_quietly(s->scene, o, &s->soft));
    const uint32_t lights = alpi_lighting_light_count(s->soft), light = s->options.light;
    if (light != ALPI_NONE && light >= lights) {
        return alpi_fail(s->scene->context, ALP_ERROR_INVALID_ARGUMENT,
                         "ambience: light %u of %u lamps and suns; they are numbered from 0", light,
                         lights);
    }
    return light == ALPI_NONE ? alpi_lighting_take_spots(s->soft, o, &s->spots) : ALP_OK;
}

static double find_height(void *user, double x, double z)
{
    const alp_ambience_sampler *s = user;
    return alpi_ground_height(s->scene, s->tracer, x, z);
}

static alp_result start(alp_ambience_sampler *s)
{
    if (s->options.detail > 0.0f) {
        ALP_TRY(alp_scene_simplify(s->scene, s->options.detail, &s->simple));
        s->scene = s->simple;
    }
    ALP_TRY(alpi_tracer_for_scene(s->scene, NULL, NULL, &s->tracer, NULL));
    s->moments = alpi_allocate(s->scene->context, BATCH, sizeof *s->moments);
    return s->moments == NULL ? ALP_ERROR_OUT_OF_MEMORY : make_lighting(s);
}

/// Beyond the scene there is no light that differs.
static void fit_to_scene(alp_ambience *a, const alp_scene *scene)
{
    const vec3 low = scene->bounds_min, high = scene->bounds_max;
    const float mins[3] = {low.x, low.y, low.z}, maxs[3] = {high.x, high.y, high.z};
    for (int k = 0; k < 3; k++) {
        a->bounds_min[k] = (double)mins[k];
        a->bounds_max[k] = (double)maxs[k];
        a->options.centre[k] += isnan(a->time) ? BESIDE_PLANES[k] * a->unit : 0.0;
    }
}

alp_result alp_ambience_sampler_create(alp_ambience *ambience, const alp_scene *scene,
                                       const alp_ambience_sampler_options *options,
                                       alp_ambience_sampler **sampler)
{
    if (ambience == NULL || scene == NULL || sampler == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *sampler = NULL;
    const alp_ambience_sampler_options o =
        options ? *options : alp_ambience_sampler_options_default();
    ALP_TRY(check_options(&o, scene));
    if (ambience->sampler != NULL) {
        return alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                         "ambience: the volume has a sampler; destroy it before the next");
    }
    alp_ambience_sampler *s = ALPI_NEW(scene->context, alp_ambience_sampler, 1);
    if (s == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    s->ambience = ambience;
    s->scene = scene;
    s->options = o;
    const alp_result result = start(s);
    if (result != ALP_OK) {
        alp_ambience_sampler_destroy(s);
        return result;
    }
    ambience->sampler = s;
    ambience->drop_hits = drop_hits;
    fit_to_scene(ambience, scene);
    if (ambience->options.flat && ambience->options.height == NULL) {
        ambience->options.height = find_height;
        ambience->options.height_user = s;
    }
    *sampler = s;
    return ALP_OK;
}

void alp_ambience_sampler_destroy(alp_ambience_sampler *s)
{
    if (s == NULL) {
        return;
    }
    if (s->ambience->options.height_user == s) {
        s->ambience->options.height = NULL;
        s->ambience->options.height_user = NULL;
    }
    alp_context *context = s->scene->context;
    s->ambience->sampler = NULL;
    drop_all_hits(s->ambience);
    clear_lighting(s);
    alpi_release(context, s->moments);
    alp_scene_destroy(s->simple);
    alpi_release(context, s);
}

alp_result alp_ambience_sampler_set_lighting(alp_ambience_sampler *sampler,
                                             const alp_lighting_options *lighting)
{
    if (sampler == NULL || lighting == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    alp_ambience_sampler fresh = *sampler;
    fresh.options.lighting = *lighting;
    fresh.soft = fresh.spots = NULL;
    const alp_result result = make_lighting(&fresh);
    if (result != ALP_OK) { // the old light stays
        clear_lighting(&fresh);
        return result;
    }
    clear_lighting(sampler);
    *sampler = fresh;
    alp_ambience_invalidate(sampler->ambience, false, NULL, NULL);
    return ALP_OK;
}

// --- objects that move ---------------------------------------------------------------------------

/// Anchors near a sphere are relit. Their hits stay: spheres are not among them.
static void invalidate_near(const alp_ambience_sampler *s, uint32_t sphere)
{
    const vec3 centre = s->occluders.centres[sphere];
    const double reach = OCCLUDER_REACH * (double)s->occluders.radii[sphere];
    const double low[3] = {(double)centre.x - reach, (double)centre.y - reach,
                           (double)centre.z - reach};
    const double high[3] = {(double)centre.x + reach, (double)centre.y + reach,
                            (double)centre.z + reach};
    alp_ambience_invalidate(s->ambience, false, low, high);
}

static alp_result check_occluders(alp_context *context, const double (*spheres)[4], uint32_t count)
{
    if (count > ALPI_OCCLUDERS_MOST) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "ambience: %u occluders, at most %d are taken; give the largest", count,
                         ALPI_OCCLUDERS_MOST);
    }
    for (uint32_t i = 0; i < count; i++) {
        bool good = (float)spheres[i][3] > 0.0f;
        for (int k = 0; k < 4; k++) {
            good = good && fabs(spheres[i][k]) <= (double)ALPI_COORDINATE_LIMIT;
        }
        if (!good) {
            return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                             "ambience: occluder %u is not finite, or has a radius that is not > 0",
                             i);
        }
    }
    return ALP_OK;
}

static bool is_same_sphere(const alpi_occluders *a, const alpi_occluders *b, uint32_t i)
{
    const vec3 from = a->centres[i], to = b->centres[i];
    return from.x == to.x && from.y == to.y && from.z == to.z && a->radii[i] == b->radii[i];
}

alp_result alp_ambience_sampler_set_occluders(alp_ambience_sampler *sampler,
                                              const double (*spheres)[4], uint32_t count)
{
    if (sampler == NULL || (spheres == NULL && count > 0)) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    ALP_TRY(check_occluders(sampler->scene->context, spheres, count));
    const alpi_occluders old = sampler->occluders;
    alpi_occluders new = {.count = count};
    for (uint32_t i = 0; i < count; i++) {
        new.centres[i] = (vec3){(float)spheres[i][0], (float)spheres[i][1], (float)spheres[i][2]};
        new.radii[i] = (float)spheres[i][3];
    }
    for (uint32_t i = 0; i < ALPI_OCCLUDERS_MOST; i++) {
        const bool stays = i < old.count && i < count && is_same_sphere(&old, &new, i);
        sampler->occluders = old;
        if (!stays && i < old.count) {
            invalidate_near(sampler, i);
        }
        sampler->occluders = new;
        if (!stays && i < count) {
            invalidate_near(sampler, i);
        }
    }
    return ALP_OK;
}

// --- light of the volume on surfaces -------------------------------------------------------------

/// Nine coefficients may give an E below 0. In layers it stays, so that they add up to all light.
static void find_layer_bounce(const void *user, uint32_t count, const vec3 *points,
                              const vec3 *normals, vec3 *irradiance)
{
    const alp_ambience_snapshot *snapshot = user;
    for (uint32_t i = 0; i < count; i++) {
        const double place[3] = {(double)points[i].x, (double)points[i].y, (double)points[i].z};
        irradiance[i] = alpi_ambience_irradiance_at(snapshot, place, normals[i]);
    }
}

static void find_bounce(const void *user, uint32_t count, const vec3 *points, const vec3 *normals,
                        vec3 *irradiance)
{
    find_layer_bounce(user, count, points, normals, irradiance);
    for (uint32_t i = 0; i < count; i++) {
        irradiance[i] = vec3_max(irradiance[i], (vec3){0.0f, 0.0f, 0.0f});
    }
}

static alpi_bounce_fn *choose_bounce(const alp_ambience_sampler_options *o)
{
    return !o->bounces ? NULL : o->light == ALPI_NONE ? find_bounce : find_layer_bounce;
}

static const alpi_lighting *find_aimed(const alp_ambience_sampler *s)
{
    if (s->spots == NULL) {
        return NULL;
    }
    const double area = alpi_lighting_emitter_area(s->spots);
    const bool small = area > 0.0 && area < AIMED_AREA * s->scene->area;
    return small || alpi_lighting_sky(s->spots) != NULL ? s->spots : NULL;
}

// --- sampling ------------------------------------------------------------------------------------

/// The random numbers of an anchor depend on its place alone: renewals have the same noise.
static uint32_t key_of(const alpi_anchor *at)
{
    uint32_t key = 0;
    for (int k = 0; k < 3; k++) {
        const uint32_t units = (uint32_t)((int64_t)at->index[k] * alpi_graph_width(at->level));
        key = alpi_hash32(key ^ alpi_hash32(units + (uint32_t)k * 0x9e3779b9u));
    }
    return key;
}

/// Memory for the hits of a full sample; without it, they are not kept.
static alpi_sphere_hit *hold_hits(alp_ambience *a, alpi_anchor *at, uint32_t face)
{
    if (at->hits != NULL && at->hits_face != face) {
        drop_hits(a, at);
    }
    if (at->hits == NULL) {
        const uint32_t count = alpi_sphere_hits_count(face);
        at->hits = ALPI_NEW(a->context, alpi_sphere_hit, count);
        at->hits_face = face;
        a->hit_bytes += at->hits != NULL ? count * sizeof(alpi_sphere_hit) : 0;
    }
    return at->hits;
}

/// Adds an anchor to the batch. @return its cost in quarters of a sample
static uint32_t add_point(alp_ambience_sampler *s, uint32_t anchor, uint32_t index)
{
    alp_ambience *a = s->ambience;
    alpi_anchor *at = &a->anchors[anchor];
    const bool first = at->state == ALPI_ANCHOR_EMPTY && s->options.first_face < s->options.face;
    const uint32_t face = first ? s->options.first_face : s->options.face;
    const bool kept = at->hits != NULL && at->hits_face == face && at->stale_trace == 0;
    double place[3];
    alpi_sphere_hits_point *p = &s->points[index];
    alpi_anchor_place(a, at, place);
    *p = (alpi_sphere_hits_point){
        .point = {(float)place[0], (float)place[1], (float)place[2]},
        .key = key_of(at),
        .face = face,
        .traced = kept,
        .moments = a->lights.visibility ? s->moments[index] : NULL,
        .reach = 1.7320508f * (float)alpi_ambience_cell(a, at->level),
        .direct = s->options.direct,
    };
    p->hits = first || !s->options.keep_hits ? NULL : hold_hits(a, at, face);
    p->traced = kept && p->hits != NULL;
    s->anchors[index] = anchor;
    return p->traced ? QUARTERS / 2 : first ? 1 : QUARTERS;
}

static alp_result take_light(alp_ambience_sampler *s, uint32_t index, alp_ambience_work *work)
{
    alp_ambience *a = s->ambience;
    const alpi_sphere_hits_point *p = &s->points[index];
    const uint32_t anchor = s->anchors[index];
    work->samples += !p->traced;
    work->relit += p->traced;
    work->rays += p->traced ? 0 : alpi_sphere_hits_count(p->face);
    const float surface = fminf(p->value.front_distance, p->value.back_distance);
    // Rays of an anchor on a surface may start on either side.
    if (!p->traced &&
        (p->value.behind > ALPI_FREE_BACKS || surface < ON_SURFACE * (float)a->unit)) {
        alpi_anchor_solid(a, anchor, surface, a->stale_serial);
        if (a->anchors[anchor].hits != NULL) {
            drop_hits(a, &a->anchors[anchor]);
        }
        return ALP_OK;
    }
    const bool moments = a->lights.visibility && !p->traced;
    a->anchors[anchor].coarse = p->face < s->options.face;
    return alpi_anchor_light(a, anchor, &p->value.light,
                             moments ? (const float(*)[2])s->moments[index] : NULL,
                             a->stale_serial);
}

static alp_result gather(alp_ambience_sampler *s, uint32_t count, alp_ambience_work *work)
{
    alp_ambience *a = s->ambience;
    const alp_ambience_snapshot *now = alp_ambience_begin_read(a);
    const alpi_sphere_relight how = {
        .context = s->scene->context,
        .scene = s->scene,
        .tracer = s->tracer,
        .lighting = s->soft,
        .aimed = find_aimed(s),
        .only_light = s->options.light + 1u, // UINT32_MAX: 0, all
        .bounce = choose_bounce(&s->options),
        .bounce_user = now,
        .bounce_cell_scale = CELL_SCALE,
        .bounce_cell_least = (float)a->unit,
        .occluders = &s->occluders,
        .seed = s->options.seed,
    };
    alp_result result = alpi_sphere_hits_gather(&how, s->points, count, NULL);
    alp_ambience_end_read(a, now);
    for (uint32_t i = 0; i < count; i++) {
        a->anchors[s->anchors[i]].pending = false;
        if (result == ALP_OK) {
            result = take_light(s, i, work);
        } else if (s->points[i].hits != NULL && !s->points[i].traced) { // not all were traced
            drop_hits(a, &a->anchors[s->anchors[i]]);
        }
    }
    return result;
}

/// Fills a batch. @param quarters what may be spent; less the cost
static alp_result fill(alp_ambience_sampler *s, const alp_ambience_camera *camera, uint32_t most,
                       int64_t *quarters, uint32_t *count)
{
    *count = 0;
    for (int64_t left = *quarters; *count < most && left > 0; *quarters = left) {
        uint32_t anchor;
        ALP_TRY(alpi_ambience_choose(s->ambience, camera, &anchor));
        if (anchor == ALPI_NO_ANCHOR) {
            return ALP_OK;
        }
        left -= add_point(s, anchor, (*count)++);
    }
    return ALP_OK;
}

alp_result alp_ambience_sample(alp_ambience_sampler *sampler, const alp_ambience_camera *camera,
                               uint32_t samples, double milliseconds, alp_ambience_work *work)
{
    alp_ambience_work done = {0};
    if (sampler == NULL || camera == NULL || !(milliseconds >= 0.0)) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    const double started = alpi_seconds();
    const uint32_t workers = alp_context_worker_count(sampler->scene->context);
    const bool timed = milliseconds > 0.0;
    const uint32_t most = timed && workers < BATCH ? workers : BATCH;
    int64_t quarters = (int64_t)samples * QUARTERS;
    alp_result result = ALP_OK;
    uint32_t count = 1;
    while (result == ALP_OK && count > 0 &&
           !(timed && 1e3 * (alpi_seconds() - started) >= milliseconds)) {
        result = fill(sampler, camera, most, &quarters, &count);
        if (count > 0) {
            const alp_result gathered = gather(sampler, count, &done);
            result = result == ALP_OK ? gathered : result;
        }
    }
    done.seconds = alpi_seconds() - started;
    if (work != NULL) {
        *work = done;
    }
    return result;
}

alp_result alp_ambience_sampler_warm(alp_ambience_sampler *sampler,
                                     const alp_ambience_camera *camera, double time,
                                     uint32_t bounces)
{
    enum { EACH = 4096, ROUNDS = 64 };
    if (sampler == NULL || camera == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    alp_ambience *a = sampler->ambience;
    if (a->time > a->first_time || (!isnan(a->time) && time != a->time)) {
        return alpi_fail(a->context, ALP_ERROR_INVALID_ARGUMENT,
                         "ambience: warm-up at %g s of a volume that began at %g s and is at %g s; "
                         "warm up before time moves",
                         time, a->first_time, a->time);
    }
    for (uint32_t bounce = 0; bounce < bounces; bounce++) {
        alp_ambience_invalidate(a, false, NULL, NULL);
        alp_ambience_work work = {.samples = 1};
        for (int i = 0; i < ROUNDS && work.samples + work.relit > 0; i++) {
            ALP_TRY(alp_ambience_update(a, time));
            ALP_TRY(alp_ambience_sample(sampler, camera, EACH, 0.0, &work));
        }
    }
    return alp_ambience_update(a, time);
}
