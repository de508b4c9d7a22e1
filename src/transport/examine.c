// SPDX-License-Identifier: MIT
// What will surprise who lights a scene, found by rays: lamps that lie inside something, and rooms
// that no sky can look into.
#include "transport/examine.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "base/warp.h"
#include "scene/area_points.h"
#include "scene/origin.h"
#include "transport/paths/hit.h"

#include <alpenglow/light.h>

#include <stdio.h>

/// Rays of a lamp: half of them into all directions that it shines in, half to points of the
/// surface, so that a lamp far away meets something too.
enum { RAYS_AROUND = 64, RAYS_AIMED = 64, LIGHTS_PER_RANGE = 16 };
/// So many rays must meet something before it is said what a lamp lies in, and of those at most one
/// in FRONT_SHARE a side that can be lit.
enum { LEAST_HITS = 8, FRONT_SHARE = 20 };
/// A lamp in a surface: so many rays must light each side, and those along it are of neither.
enum { LEAST_SIDE = 6 };
static const float LEAST_RISE = 0.05f;
/// Named one by one; of more only the number is told.
enum { NAMED_LIMIT = 8 };
/// Points of the surface, walks from each, and surfaces that a walk comes to: an opening of a
/// thousandth of a room's walls is found from two of three points.
enum { ROOM_POINTS = 512, ROOM_WALKS = 16, WALK_BOUNCES = 64 };
/// One in so many points in a closed room is worth a word.
enum { ROOM_SHARE = 4 };
enum { STREAM_AROUND = 101, STREAM_ROOM = 102, STREAM_CLOSER = 103 };

/// What the rays of a lamp met.
typedef struct verdict {
    uint32_t fronts, backs; // rays that met a side that can be lit, and one that cannot
    uint32_t sides[2];      // of the fronts: above and below the surface that the lamp lies in
    uint32_t around;        // the nearest triangle met from behind, ALPI_NONE = none
    uint32_t in;            // triangle that the lamp lies in, ALPI_NONE = none
    float around_distance;
} verdict;

typedef struct examination {
    const alp_scene *scene;
    const alpi_lighting *lighting;
    const alpi_tracer *tracer;
    alpi_trace_filter filter;
    vec3 aims[RAYS_AIMED];
    verdict *verdicts; // [lights]
} examination;

// --- lamps ---------------------------------------------------------------------------------------

static bool is_lamp(const alpi_light *light)
{
    return alp_light_traits_of(light->kind).has_position && light->intensity > 0.0f &&
           (light->color.x > 0.0f || light->color.y > 0.0f || light->color.z > 0.0f);
}

/// Light passes it in part.
static bool is_clear(const alp_scene *scene, uint32_t triangle, float b1, float b2)
{
    const vec3 through = alpi_surface_pane(scene, triangle, b1, b2).through;
    return through.x > 0.0f || through.y > 0.0f || through.z > 0.0f;
}

static vec3 normal_of(const alp_scene *scene, uint32_t triangle)
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    return vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
}

/// Direction of ray `index`. @return false: the lamp does not shine there
static bool aim(const examination *e, uint32_t light_index, uint32_t index, vec3 *direction)
{
    const alpi_light *light = alpi_lighting_light(e->lighting, light_index);
    const bool spot = alp_light_traits_of(light->kind).has_cone;
    const float edge = spot ? cosf(light->outer_cone) : -1.0f;
    const vec3 none = {0.0f, 0.0f, 0.0f};
    if (index >= RAYS_AROUND) {
        *direction =
            vec3_normalize_or(vec3_sub(e->aims[index - RAYS_AROUND], light->position), none);
        return vec3_length(*direction) > 0.5f &&
               (!spot || vec3_dot(*direction, light->direction) >= edge);
    }
    vec3 t, b;
    const vec3 axis = spot ? light->direction : (vec3){0.0f, 1.0f, 0.0f};
    const vec3 local = alpi_warp_uniform_cone(
        alpi_sample_2d(alpi_random_key(0, light_index, STREAM_AROUND), index), edge);
    vec3_frame(axis, &t, &b);
    *direction = vec3_normalize_or(
        vec3_mad(vec3_mad(vec3_scale(t, local.x), local.y, b), local.z, axis), axis);
    return true;
}

/// How near a surface a lamp lies in it.
static float touching_distance(const alp_scene *scene, vec3 position)
{
    const float largest = fmaxf(fmaxf(fabsf(position.x), fabsf(position.y)), fabsf(position.z));
    const float diagonal = vec3_length(vec3_sub(scene->bounds_max, scene->bounds_min));
    return fmaxf(1e-5f * diagonal, 8.0f * 0x1p-23f * largest);
}

static void note_hit(const examination *e, const alpi_hits *hits, int lane, vec3 direction,
                     verdict *v)
{
    const uint32_t triangle = hits->triangle[lane];
    if (triangle == ALPI_NONE ||
        is_clear(e->scene, triangle, hits->b1[lane], hits->b2[lane])) { // what is behind, is lit
        return;
    }
    const bool behind = vec3_dot(normal_of(e->scene, triangle), direction) > 0.0f;
    if (!behind || alpi_surface_is_double_sided(e->scene, triangle)) {
        const float rise =
            v->in == ALPI_NONE ? 0.0f : vec3_dot(normal_of(e->scene, v->in), direction);
        v->fronts++;
        v->sides[0] += rise > LEAST_RISE;
        v->sides[1] += rise < -LEAST_RISE;
        return;
    }
    v->backs++;
    if (v->around == ALPI_NONE || hits->distance[lane] < v->around_distance) {
        v->around = triangle;
        v->around_distance = hits->distance[lane];
    }
}

/// The lanes of a packet of rays from a lamp, from ray `first` on.
static uint32_t set_rays(const examination *e, uint32_t light, uint32_t first, alpi_rays *rays,
                         vec3 directions[ALPI_PACKET])
{
    uint32_t active = 0;
    alpi_rays_clear(rays);
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        if (aim(e, light, first + i, &directions[i])) {
            alpi_rays_set(rays, (int)i, alpi_lighting_light(e->lighting, light)->position,
                          directions[i], INFINITY);
            active |= 1u << i;
        }
    }
    return active;
}

/// The surface that a lamp lies in, if any.
static uint32_t find_touched(const examination *e, uint32_t light, float touching)
{
    for (uint32_t first = 0; first < RAYS_AROUND; first += ALPI_PACKET) {
        alpi_rays rays;
        alpi_hits hits;
        vec3 directions[ALPI_PACKET];
        const uint32_t active = set_rays(e, light, first, &rays, directions);
        for (int i = 0; i < ALPI_PACKET; i++) {
            rays.maximum[i] = touching;
        }
        alpi_trace_nearest(e->tracer, &rays, active, e->filter, &hits);
        for (int i = 0; i < ALPI_PACKET; i++) {
            if ((active >> i & 1u) != 0 && hits.triangle[i] != ALPI_NONE) {
                return hits.triangle[i];
            }
        }
    }
    return ALPI_NONE;
}

static void examine_lamp(const examination *e, uint32_t light, verdict *v)
{
    const float touching =
        touching_distance(e->scene, alpi_lighting_light(e->lighting, light)->position);
    v->in = find_touched(e, light, touching);
    for (uint32_t first = 0; first < RAYS_AROUND + RAYS_AIMED; first += ALPI_PACKET) {
        alpi_rays rays;
        alpi_hits hits;
        vec3 directions[ALPI_PACKET];
        const uint32_t active = set_rays(e, light, first, &rays, directions);
        for (int i = 0; i < ALPI_PACKET; i++) {
            rays.minimum[i] = touching; // past the surface it lies in
        }
        alpi_trace_nearest(e->tracer, &rays, active, e->filter, &hits);
        for (int i = 0; i < ALPI_PACKET; i++) {
            if ((active >> i & 1u) != 0) {
                note_hit(e, &hits, i, directions[i], v);
            }
        }
    }
}

static alp_result examine_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const examination *e = user;
    for (uint32_t i = begin; i < end; i++) {
        e->verdicts[i] = (verdict){.around = ALPI_NONE, .in = ALPI_NONE};
        if (is_lamp(alpi_lighting_light(e->lighting, i))) {
            examine_lamp(e, i, &e->verdicts[i]);
        }
    }
    return ALP_OK;
}

static bool is_inside(const verdict *v)
{
    return v->fronts + v->backs >= LEAST_HITS && v->fronts * FRONT_SHARE <= v->backs + v->fronts;
}

static bool is_between(const verdict *v)
{
    return v->in != ALPI_NONE && v->sides[0] >= LEAST_SIDE && v->sides[1] >= LEAST_SIDE;
}

static const char *surface_name(const alp_scene *scene, uint32_t triangle)
{
    return scene->surfaces[scene->triangle_surface[triangle]].name;
}

static void name_lamp(const examination *e, uint32_t index, const verdict *v)
{
    const alp_scene *scene = e->scene;
    const alpi_light *light = alpi_lighting_light(e->lighting, index);
    double p[3];
    alpi_origin_restore(scene, light->position, p);
    char name[40];
    snprintf(name, sizeof name, "light %u", index);
    const char *called = light->name != NULL && light->name[0] != '\0' ? light->name : name;
    if (is_inside(v)) {
        alpi_warn(scene->context, "light-inside", called,
                  "lies inside something or behind a wall, at %g %g %g m: its rays meet the "
                  "backs of single-sided surfaces, \"%s\" first, which are black and opaque; "
                  "move it, or remove the surface around it",
                  p[0], p[1], p[2], surface_name(scene, v->around));
    } else {
        alpi_warn(scene->context, "light-on-surface", called,
                  "lies in the surface \"%s\", at %g %g %g m, and lights both its sides; move it"
                  " to the side that it should light",
                  surface_name(scene, v->in), p[0], p[1], p[2]);
    }
}

static void tell_lamps(const examination *e, uint32_t count)
{
    uint32_t found = 0;
    for (uint32_t i = 0; i < count; i++) {
        const verdict *v = &e->verdicts[i];
        if ((is_inside(v) || is_between(v)) && found++ < NAMED_LIMIT) {
            name_lamp(e, i, v);
        }
    }
    if (found > NAMED_LIMIT) {
        alpi_warn(e->scene->context, "light-inside", e->scene->name,
                  "%u more lights lie inside something, behind a wall or in a surface",
                  found - NAMED_LIMIT);
    }
}

static alp_result examine_lamps(examination *e, alp_progress_fn *progress, void *user)
{
    alp_context *context = e->scene->context;
    const uint32_t count = alpi_lighting_light_count(e->lighting);
    alpi_area_point points[RAYS_AIMED];
    alpi_area_points(e->scene, RAYS_AIMED, points);
    for (uint32_t i = 0; i < RAYS_AIMED; i++) {
        vec3 c[3];
        alpi_triangle_corners(e->scene, points[i].triangle, c);
        e->aims[i] =
            vec3_mad(vec3_scale(c[0], 1.0f - points[i].b1 - points[i].b2), points[i].b1, c[1]);
        e->aims[i] = vec3_mad(e->aims[i], points[i].b2, c[2]);
    }
    ALPI_TRY_NEW(context, e->verdicts, count);
    const alpi_task_progress told = {.callback = progress,
                                     .user = user,
                                     .stage = "examine",
                                     .units_per_item = RAYS_AROUND + RAYS_AIMED};
    alp_result result =
        alpi_parallel_for(context, count, LIGHTS_PER_RANGE, examine_range, e, &told);
    if (result == ALP_OK) {
        tell_lamps(e, count);
    }
    alpi_release(context, e->verdicts);
    return result;
}

// --- cameras -------------------------------------------------------------------------------------

bool alpi_examine_is_inside(const alpi_tracer *tracer, alpi_trace_filter filter,
                            const alp_scene *scene, vec3 place, const vec3 *directions,
                            uint32_t count)
{
    const examination e = {.scene = scene, .tracer = tracer, .filter = filter};
    verdict v = {.around = ALPI_NONE, .in = ALPI_NONE};
    for (uint32_t first = 0; first < count; first += ALPI_PACKET) {
        alpi_rays rays;
        alpi_hits hits;
        alpi_rays_clear(&rays);
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            alpi_rays_set(&rays, (int)i, place, directions[first + i], INFINITY);
        }
        alpi_trace_nearest(tracer, &rays, (1u << ALPI_PACKET) - 1u, filter, &hits);
        for (int i = 0; i < ALPI_PACKET; i++) {
            note_hit(&e, &hits, i, directions[first + (uint32_t)i], &v);
        }
    }
    return is_inside(&v);
}

// --- rooms ---------------------------------------------------------------------------------------

typedef struct rooms {
    const examination *e;
    alpi_area_point points[ROOM_POINTS];
    bool closed[ROOM_POINTS];
} rooms;

/// What became of eight walks, by bits.
typedef struct fates {
    uint32_t escaped; // left the scene, or came to what lets light through
    uint32_t kept;    // still among front sides at the end; the others came to the back of one
} fates;

static void set_step(alpi_rays *rays, int lane, const alpi_receiver_point *p, vec2 u,
                     vec3 *direction)
{
    vec3 t, b;
    const vec3 n = p->geometric_normal, local = alpi_warp_cosine_cone(u, 1.0f);
    vec3_frame(n, &t, &b);
    *direction =
        vec3_normalize_or(vec3_mad(vec3_mad(vec3_scale(t, local.x), local.y, b), local.z, n), n);
    alpi_rays_set(rays, lane, vec3_mad(p->position, p->offset, n), *direction, INFINITY);
}

/// One step of the walks that go on; those that end leave `active`.
static void take_step(const examination *e, const vec2 u[ALPI_PACKET],
                      alpi_receiver_point at[ALPI_PACKET], uint32_t *active, fates *f)
{
    alpi_rays rays;
    alpi_hits hits;
    vec3 directions[ALPI_PACKET];
    alpi_rays_clear(&rays);
    for (int i = 0; i < ALPI_PACKET; i++) {
        if ((*active >> i & 1u) != 0) {
            set_step(&rays, i, &at[i], u[i], &directions[i]);
        }
    }
    const uint32_t before = *active;
    alpi_trace_nearest(e->tracer, &rays, before, e->filter, &hits);
    for (int i = 0; i < ALPI_PACKET; i++) {
        if ((before >> i & 1u) == 0) {
            continue;
        }
        if (hits.triangle[i] == ALPI_NONE ||
            is_clear(e->scene, hits.triangle[i], hits.b1[i], hits.b2[i])) {
            f->escaped |= 1u << i;
            *active &= ~(1u << i);
            continue;
        }
        bool behind = false;
        at[i] = alpi_hit_point(e->scene, &hits, i, directions[i], &behind);
        if (behind && !alpi_surface_is_double_sided(e->scene, hits.triangle[i])) {
            *active &= ~(1u << i);
        }
    }
}

/// A walk from each of eight points, from front side to front side.
static fates walk(const rooms *r, uint32_t first, uint32_t round, uint32_t active)
{
    fates f = {0, 0};
    alpi_hits start = {.behind = 0};
    alpi_receiver_point at[ALPI_PACKET];
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        const alpi_area_point *p = &r->points[first + i];
        start.triangle[i] = p->triangle;
        start.b1[i] = p->b1;
        start.b2[i] = p->b2;
        at[i] = alpi_hit_point(r->e->scene, &start, (int)i, (vec3){0.0f, 0.0f, 0.0f}, NULL);
    }
    for (uint32_t bounce = 0; bounce < WALK_BOUNCES && active != 0; bounce++) {
        vec2 u[ALPI_PACKET];
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            u[i] = alpi_sample_2d(alpi_random_key(round, first + i, STREAM_ROOM), bounce);
        }
        take_step(r->e, u, at, &active, &f);
    }
    f.kept = active;
    return f;
}

/// Points that lie inside other solids, whose walks come to backs, are in no room.
static alp_result examine_points(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    rooms *r = user;
    for (uint32_t packet = begin; packet < end; packet++) {
        uint32_t inside = (1u << ALPI_PACKET) - 1u, kept[ALPI_PACKET] = {0};
        for (uint32_t round = 0; round < ROOM_WALKS && inside != 0; round++) {
            const fates f = walk(r, packet * ALPI_PACKET, round, inside);
            inside &= ~f.escaped;
            for (int i = 0; i < ALPI_PACKET; i++) {
                kept[i] += f.kept >> i & 1u;
            }
        }
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            r->closed[packet * ALPI_PACKET + i] =
                (inside >> i & 1u) != 0 && 2 * kept[i] >= ROOM_WALKS;
        }
    }
    return ALP_OK;
}

/// Rays from closed points that met a surface, and of those the ones with nothing behind it.
typedef struct closers {
    uint32_t *met, *last; // [surfaces]
} closers;

/// One ray from each of eight points, and what lies behind its first hit.
static void count_closers(const rooms *r, uint32_t first, uint32_t round, uint32_t active,
                          closers *c)
{
    const examination *e = r->e;
    alpi_hits hits = {.behind = 0}, behind;
    alpi_rays rays;
    vec3 directions[ALPI_PACKET];
    alpi_rays_clear(&rays);
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        const alpi_area_point *p = &r->points[first + i];
        hits.triangle[i] = p->triangle;
        hits.b1[i] = p->b1;
        hits.b2[i] = p->b2;
        const alpi_receiver_point at =
            alpi_hit_point(e->scene, &hits, (int)i, (vec3){0.0f, 0.0f, 0.0f}, NULL);
        set_step(&rays, (int)i, &at,
                 alpi_sample_2d(alpi_random_key(round, first + i, STREAM_CLOSER), 0),
                 &directions[i]);
    }
    alpi_trace_nearest(e->tracer, &rays, active, e->filter, &hits);
    uint32_t met = 0;
    alpi_rays_clear(&rays);
    for (int i = 0; i < ALPI_PACKET; i++) {
        if ((active >> i & 1u) != 0 && hits.triangle[i] != ALPI_NONE) {
            const alpi_receiver_point at = alpi_hit_point(e->scene, &hits, i, directions[i], NULL);
            alpi_rays_set(&rays, i, vec3_mad(at.position, -at.offset, at.geometric_normal),
                          directions[i], INFINITY);
            met |= 1u << i;
        }
    }
    alpi_trace_nearest(e->tracer, &rays, met, (alpi_trace_filter){0}, &behind);
    for (int i = 0; i < ALPI_PACKET; i++) {
        if ((met >> i & 1u) != 0) {
            const uint32_t surface = e->scene->triangle_surface[hits.triangle[i]];
            c->met[surface]++;
            c->last[surface] += behind.triangle[i] == ALPI_NONE;
        }
    }
}

/// The surface with the largest count, whose count becomes 0; ALPI_NONE if all are.
static uint32_t take_largest(const alp_scene *scene, uint32_t *counts)
{
    uint32_t largest = ALPI_NONE;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        if (counts[s] > (largest == ALPI_NONE ? 0 : counts[largest])) {
            largest = s;
        }
    }
    if (largest != ALPI_NONE) {
        counts[largest] = 0;
    }
    return largest;
}

/// Names up to three surfaces: outer ones, or what is met where nothing is an outer one.
static void name_closers(const alp_scene *scene, const closers *c, char *text, size_t size)
{
    enum { NAMES = 3 };
    uint32_t surface = take_largest(scene, c->last);
    uint32_t *counts = surface != ALPI_NONE ? c->last : c->met;
    surface = surface != ALPI_NONE ? surface : take_largest(scene, counts);
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; i < NAMES && surface != ALPI_NONE; i++) {
        const int length = snprintf(text + used, size - used, "%s\"%.60s\"", i > 0 ? ", " : "",
                                    scene->surfaces[surface].name);
        used += length > 0 && (size_t)length < size - used ? (size_t)length : 0;
        surface = take_largest(scene, counts);
    }
}

/// Finds the surfaces between closed points and the outside.
static alp_result find_closers(const rooms *r, char *text, size_t size)
{
    enum { ROUNDS = 8 };
    const alp_scene *scene = r->e->scene;
    closers c = {NULL, NULL};
    c.met = ALPI_NEW(scene->context, uint32_t, scene->surface_count);
    c.last = ALPI_NEW(scene->context, uint32_t, scene->surface_count);
    const bool good = c.met != NULL && c.last != NULL;
    for (uint32_t first = 0; good && first < ROOM_POINTS; first += ALPI_PACKET) {
        uint32_t active = 0;
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            active |= (r->closed[first + i] ? 1u : 0u) << i;
        }
        for (uint32_t round = 0; round < ROUNDS && active != 0; round++) {
            count_closers(r, first, round, active, &c);
        }
    }
    if (good) {
        name_closers(scene, &c, text, size);
    }
    alpi_release(scene->context, c.met);
    alpi_release(scene->context, c.last);
    return good ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
}

/// Whether a light stands in the scene and need not get in.
static bool has_light_inside(const alpi_lighting *lighting)
{
    bool any = alpi_lighting_emitter_count(lighting) > 0;
    for (uint32_t i = 0; i < alpi_lighting_light_count(lighting) && !any; i++) {
        any = is_lamp(alpi_lighting_light(lighting, i));
    }
    return any;
}

static alp_result examine_rooms(const examination *e, alp_progress_fn *progress, void *user)
{
    alp_context *context = e->scene->context;
    if (has_light_inside(e->lighting)) {
        return ALP_OK;
    }
    rooms *r = ALPI_NEW(context, rooms, 1);
    if (r == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    r->e = e;
    alpi_area_points(e->scene, ROOM_POINTS, r->points);
    const alpi_task_progress told = {.callback = progress, .user = user, .stage = "examine"};
    alp_result result =
        alpi_parallel_for(context, ROOM_POINTS / ALPI_PACKET, 2, examine_points, r, &told);
    uint32_t closed = 0;
    for (uint32_t i = 0; i < ROOM_POINTS; i++) {
        closed += r->closed[i];
    }
    const bool told_of = result == ALP_OK && closed * ROOM_SHARE >= ROOM_POINTS;
    char names[256] = "";
    if (told_of) {
        result = find_closers(r, names, sizeof names);
    }
    alpi_release(context, r);
    if (told_of && result == ALP_OK) {
        alpi_warn(context, "closed-room", e->scene->name,
                  "%.0f %% of the surface is in rooms closed by %s: no sky or sun reaches "
                  "it, and there is no lamp or emissive surface; add one, or an opening",
                  100.0 * closed / ROOM_POINTS, names);
    }
    return result;
}

// --- all of it -----------------------------------------------------------------------------------

alp_result alpi_examine_light(const alpi_tracer *tracer, alpi_trace_filter filter,
                              const alp_scene *scene, const alpi_lighting *lighting,
                              alp_progress_fn *progress, void *progress_user)
{
    examination e = {.scene = scene, .lighting = lighting, .tracer = tracer, .filter = filter};
    alpi_lighting_warn(scene, lighting);
    if (!(scene->area > 0.0)) {
        return ALP_OK;
    }
    ALP_TRY(examine_lamps(&e, progress, progress_user));
    return examine_rooms(&e, progress, progress_user);
}

alp_result alp_scene_examine(const alp_scene *scene, const alp_lighting_options *options,
                             alp_progress_fn *progress, void *progress_user)
{
    if (scene == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    alpi_lighting *lighting = NULL;
    alpi_tracer *tracer = NULL;
    ALP_TRY(alpi_lighting_create(scene, options, &lighting));
    alp_result result = alpi_tracer_for_scene(scene, progress, progress_user, &tracer, NULL);
    if (result == ALP_OK) {
        alpi_scene_warn_of_metal(scene);
        result = alpi_examine_light(tracer, (alpi_trace_filter){.one_sided = false}, scene,
                                    lighting, progress, progress_user);
    }
    alpi_lighting_destroy(scene->context, lighting);
    return result;
}
