// SPDX-License-Identifier: MIT
// Rays through Embree 3: the only file of the library that knows it.
// Based on: Wald, Woop, Benthin, Johnson, Ernst. Embree: A Kernel Framework for Efficient CPU Ray
// Tracing. SIGGRAPH 2014.
#include "trace/few.h"
#include "trace/trace.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <embree3/rtcore.h>

#include <assert.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

/// Triangles are in three geometries: those that always stop a ray, and those whose material may
/// cut it or let it through in part, which alone pay for a filter call at every hit.
typedef enum geometry_kind {
    GEOMETRY_SOLID = 0,
    GEOMETRY_CUT = 1,
    GEOMETRY_PANE = 2,
    GEOMETRY_COUNT = 3
} geometry_kind;

/// A ray gains 4 to 7 ns and a triangle costs 300, on one thread: for four that share the rays they
/// are even at 170 to 300 rays. Of the rays that a map might take an adaptive one sends a fifth to
/// a quarter, so 700 to 1,500 would be asked for; for two workers half of them: measured, whole
/// bakes of a torus and of a room are even at 230 to 290, and take 3 to 4 % less time at 390 to
/// 450, 8 to 10 % less at 590 to 910. The number of workers may not decide: it changes no bit.
static const double QUICK_RAYS_PER_TRIANGLE = 500.0;

struct alpi_tracer {
    const alp_scene *scene;
    RTCDevice device;
    RTCScene embree_scene;
    alpi_few *few;                       // its triangles, where they are few and solid, or NULL
    RTCScene quick_scene;                // the same geometries without care for edges, or NULL
    uint32_t *triangles[GEOMETRY_COUNT]; // scene triangle of each primitive of a geometry
    uint32_t count[GEOMETRY_COUNT];
    uint32_t in_row[GEOMETRY_COUNT];   // of the first so many, triangle i is triangle 0 plus i: to
                                       // read it would mostly be a miss
    uint32_t first_vertex, end_vertex; // of the scene: all that the triangles use are between
};

/// Our data behind Embree's context, which the filters get.
typedef struct trace_context {
    struct RTCIntersectContext embree; // first: filters get its address
    const alpi_tracer *tracer;
    bool panes; // the caller sees to them
} trace_context;

// --- filters -------------------------------------------------------------------------------------

// RTCRayN and RTCHitN are structures of arrays of N floats, in the order of the fields of RTCRay
// and RTCHit; the accessors that Embree ships are C++ only.
enum { RAY_DIRECTION_X = 4 };
enum { HIT_NORMAL_X = 0, HIT_U = 3, HIT_V = 4, HIT_PRIMITIVE = 5, HIT_GEOMETRY = 6 };

static float lane_float(const void *fields, unsigned n, unsigned field, unsigned lane)
{
    float value;
    memcpy(&value, (const char *)fields + sizeof value * ((size_t)field * n + lane), sizeof value);
    return value;
}

static uint32_t lane_uint(const void *fields, unsigned n, unsigned field, unsigned lane)
{
    uint32_t value;
    memcpy(&value, (const char *)fields + sizeof value * ((size_t)field * n + lane), sizeof value);
    return value;
}

static uint32_t find_triangle(const alpi_tracer *tracer, uint32_t geometry, uint32_t primitive)
{
    return primitive < tracer->in_row[geometry] ? tracer->triangles[geometry][0] + primitive
                                                : tracer->triangles[geometry][primitive];
}

static uint32_t lane_triangle(const struct RTCFilterFunctionNArguments *a, unsigned lane)
{
    const trace_context *context = (const void *)a->context;
    uint32_t geometry = lane_uint(a->hit, a->N, HIT_GEOMETRY, lane);
    return find_triangle(context->tracer, geometry, lane_uint(a->hit, a->N, HIT_PRIMITIVE, lane));
}

/// Lets rays through where alpha cuts the surface.
static void cut_filter(const struct RTCFilterFunctionNArguments *a)
{
    const trace_context *context = (const void *)a->context;
    for (unsigned i = 0; i < a->N; i++) {
        if (a->valid[i] != 0 && alpi_surface_is_cut(context->tracer->scene, lane_triangle(a, i),
                                                    lane_float(a->hit, a->N, HIT_U, i),
                                                    lane_float(a->hit, a->N, HIT_V, i))) {
            a->valid[i] = 0;
        }
    }
}

/// Panes do not stop shadow rays whose caller sees to them.
static void pane_shadow_filter(const struct RTCFilterFunctionNArguments *a)
{
    const trace_context *context = (const void *)a->context;
    if (!context->panes) {
        cut_filter(a);
        return;
    }
    for (unsigned i = 0; i < a->N; i++) {
        a->valid[i] = 0;
    }
}

static void pane_filter(const struct RTCFilterFunctionNArguments *a)
{
    const trace_context *context = (const void *)a->context;
    if (!context->panes) {
        cut_filter(a);
    }
}

/// Lets rays through single-sided surfaces from behind. Embree's normal is (v1−v0)×(v2−v0), which
/// points outside for a counter-clockwise triangle.
static void one_sided_filter(const struct RTCFilterFunctionNArguments *a)
{
    const trace_context *context = (const void *)a->context;
    for (unsigned i = 0; i < a->N; i++) {
        if (a->valid[i] == 0) {
            continue;
        }
        float along = 0.0f;
        for (unsigned k = 0; k < 3; k++) {
            along += lane_float(a->ray, a->N, RAY_DIRECTION_X + k, i) *
                     lane_float(a->hit, a->N, HIT_NORMAL_X + k, i);
        }
        if (along > 0.0f &&
            !alpi_surface_is_double_sided(context->tracer->scene, lane_triangle(a, i))) {
            a->valid[i] = 0;
        }
    }
}

// --- building ------------------------------------------------------------------------------------

typedef struct build_progress {
    alp_progress_fn *callback;
    void *user;
    double reported;
    bool cancelled;
} build_progress;

static bool report_build(void *user, double done)
{
    build_progress *p = user;
    double now = alpi_seconds();
    if (p->callback != NULL && now - p->reported > 0.05) {
        p->reported = now;
        alp_progress progress = {"build", (uint64_t)(done * 100.0), 100, 0.0, -1.0};
        p->cancelled = !p->callback(p->user, &progress);
    }
    return !p->cancelled;
}

void alpi_tracer_destroy(alpi_tracer *tracer)
{
    if (tracer == NULL) {
        return;
    }
    if (tracer->quick_scene != NULL) {
        rtcReleaseScene(tracer->quick_scene);
    }
    if (tracer->embree_scene != NULL) {
        rtcReleaseScene(tracer->embree_scene);
    }
    if (tracer->device != NULL) {
        rtcReleaseDevice(tracer->device);
    }
    alpi_release(tracer->scene->context, tracer->few);
    for (int g = 0; g < GEOMETRY_COUNT; g++) {
        alpi_release(tracer->scene->context, tracer->triangles[g]);
    }
    alpi_release(tracer->scene->context, tracer);
}

static alp_result fail_embree(const alp_scene *scene, RTCDevice device, const char *what)
{
    enum RTCError error = rtcGetDeviceError(device);
    alp_result code = error == RTC_ERROR_OUT_OF_MEMORY ? ALP_ERROR_OUT_OF_MEMORY
                      : error == RTC_ERROR_CANCELLED   ? ALP_ERROR_CANCELLED
                                                       : ALP_ERROR_UNSUPPORTED;
    return alpi_fail(scene->context, code, "%s: %s failed in the ray tracer (Embree error %d)",
                     scene->name, what, (int)error);
}

static bool is_chosen(const bool *surfaces, uint32_t surface)
{
    return surfaces == NULL || surfaces[surface];
}

/// The geometry that a triangle goes to, GEOMETRY_COUNT for none.
static geometry_kind kind_of(const alp_scene *scene, const bool *surfaces, uint32_t triangle)
{
    const uint32_t surface = scene->triangle_surface[triangle];
    if (!scene->triangle_usable[triangle] || !is_chosen(surfaces, surface)) {
        return GEOMETRY_COUNT;
    }
    return alpi_surface_is_pane(scene, surface)    ? GEOMETRY_PANE
           : alpi_surface_has_cuts(scene, surface) ? GEOMETRY_CUT
                                                   : GEOMETRY_SOLID;
}

static void add_triangle(alpi_tracer *tracer, geometry_kind kind, uint32_t triangle)
{
    const uint32_t place = tracer->count[kind]++;
    tracer->triangles[kind][place] = triangle;
    if (tracer->in_row[kind] == place && triangle == tracer->triangles[kind][0] + place) {
        tracer->in_row[kind]++;
    }
    for (int k = 0; k < 3; k++) {
        const uint32_t vertex = tracer->scene->triangles[triangle][k];
        tracer->first_vertex = vertex < tracer->first_vertex ? vertex : tracer->first_vertex;
        tracer->end_vertex = vertex >= tracer->end_vertex ? vertex + 1 : tracer->end_vertex;
    }
}

/// Lists the usable triangles of the surfaces by geometry.
static alp_result sort_triangles(alpi_tracer *tracer, const bool *surfaces)
{
    const alp_scene *scene = tracer->scene;
    uint32_t first = scene->triangle_count, end = 0; // where they are, so that a few are found fast
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const alpi_surface *surface = &scene->surfaces[s];
        const uint32_t surface_end = surface->first_triangle + surface->triangle_count;
        if (is_chosen(surfaces, s)) {
            first = surface->first_triangle < first ? surface->first_triangle : first;
            end = surface_end > end ? surface_end : end;
        }
    }
    size_t room[GEOMETRY_COUNT + 1] = {0};
    for (uint32_t t = first; t < end; t++) {
        room[kind_of(scene, surfaces, t)]++;
    }
    for (int g = 0; g < GEOMETRY_COUNT; g++) {
        ALPI_TRY_NEW(scene->context, tracer->triangles[g], room[g]);
    }
    tracer->first_vertex = scene->vertex_count;
    for (uint32_t t = first; t < end; t++) {
        const geometry_kind kind = kind_of(scene, surfaces, t);
        if (kind != GEOMETRY_COUNT) {
            add_triangle(tracer, kind, t);
        }
    }
    return ALP_OK;
}

/// Vertices are copied: Embree reads 16 bytes at each of 12, past the end of an array of ours.
static alp_result attach_geometry(alpi_tracer *tracer, geometry_kind kind)
{
    const alp_scene *scene = tracer->scene;
    uint32_t count = tracer->count[kind];
    if (count == 0) {
        return ALP_OK;
    }
    RTCGeometry geometry = rtcNewGeometry(tracer->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *vertices =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), tracer->end_vertex - tracer->first_vertex);
    uint32_t(*indices)[3] = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                    RTC_FORMAT_UINT3, sizeof *indices, count);
    if (geometry == NULL || vertices == NULL || indices == NULL) {
        if (geometry != NULL) {
            rtcReleaseGeometry(geometry);
        }
        return fail_embree(scene, tracer->device, "making a geometry");
    }
    memcpy(vertices, scene->positions + tracer->first_vertex,
           sizeof *scene->positions * (tracer->end_vertex - tracer->first_vertex));
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t *corners = scene->triangles[tracer->triangles[kind][i]];
        for (int k = 0; k < 3; k++) {
            indices[i][k] = corners[k] - tracer->first_vertex;
        }
    }
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
    if (kind == GEOMETRY_CUT) {
        rtcSetGeometryIntersectFilterFunction(geometry, cut_filter);
        rtcSetGeometryOccludedFilterFunction(geometry, cut_filter);
    }
    if (kind == GEOMETRY_PANE) {
        rtcSetGeometryIntersectFilterFunction(geometry, pane_filter);
        rtcSetGeometryOccludedFilterFunction(geometry, pane_shadow_filter);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(tracer->embree_scene, geometry, kind);
    rtcReleaseGeometry(geometry);
    return ALP_OK;
}

/// A scene without geometries. @param flags besides those that all have
static alp_result start_scene(const alpi_tracer *tracer, enum RTCSceneFlags flags,
                              build_progress *progress, RTCScene *made)
{
    *made = rtcNewScene(tracer->device);
    if (*made == NULL) {
        return fail_embree(tracer->scene, tracer->device, "making a scene");
    }
    rtcSetSceneFlags(*made, flags | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    rtcSetSceneBuildQuality(*made, RTC_BUILD_QUALITY_MEDIUM);
    rtcSetSceneProgressMonitorFunction(*made, report_build, progress);
    return ALP_OK;
}

static alp_result commit_scene(const alpi_tracer *tracer, const build_progress *progress,
                               RTCScene made)
{
    rtcCommitScene(made);
    rtcSetSceneProgressMonitorFunction(made, NULL, NULL);
    if (progress->cancelled) {
        return alpi_fail(tracer->scene->context, ALP_ERROR_CANCELLED, "cancelled");
    }
    if (rtcGetDeviceError(tracer->device) != RTC_ERROR_NONE) {
        return fail_embree(tracer->scene, tracer->device, "building");
    }
    return ALP_OK;
}

static alp_result build(alpi_tracer *tracer, const bool *surfaces, build_progress *progress)
{
    const alp_scene *scene = tracer->scene;
    char config[96];
    const char *isa = alpi_context_options(scene->context)->max_isa;
    // One thread: our own pool drives the rays, and a build on one thread is the same every time.
    snprintf(config, sizeof config, "threads=1,set_affinity=0%s%s", isa ? ",max_isa=" : "",
             isa ? isa : "");
    tracer->device = rtcNewDevice(config);
    if (tracer->device == NULL) {
        return fail_embree(scene, NULL, "starting");
    }
    // Robust: no ray slips through the edge between two triangles.
    ALP_TRY(start_scene(tracer, RTC_SCENE_FLAG_ROBUST, progress, &tracer->embree_scene));
    ALP_TRY(sort_triangles(tracer, surfaces));
    if (tracer->count[GEOMETRY_SOLID] == alpi_tracer_triangle_count(tracer)) {
        ALP_TRY(alpi_few_create(scene, tracer->triangles[GEOMETRY_SOLID],
                                tracer->count[GEOMETRY_SOLID], &tracer->few));
    }
    for (int g = 0; g < GEOMETRY_COUNT; g++) {
        ALP_TRY(attach_geometry(tracer, (geometry_kind)g));
    }
    return commit_scene(tracer, progress, tracer->embree_scene);
}

alp_result alpi_tracer_create(const alp_scene *scene, const bool *surfaces,
                              alp_progress_fn *progress, void *progress_user, alpi_tracer **tracer)
{
    *tracer = NULL;
    alpi_tracer *made = ALPI_NEW(scene->context, alpi_tracer, 1);
    if (made == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    made->scene = scene;
    build_progress report = {progress, progress_user, alpi_seconds(), false};
    alp_result result = build(made, surfaces, &report);
    if (result != ALP_OK) {
        alpi_tracer_destroy(made);
        return result;
    }
    *tracer = made;
    return ALP_OK;
}

alp_result alpi_tracer_quicken(alpi_tracer *tracer, double rays, alp_progress_fn *progress,
                               void *progress_user, bool *quick)
{
    const double triangles = (double)alpi_tracer_triangle_count(tracer);
    *quick = rays >= QUICK_RAYS_PER_TRIANGLE * triangles;
    if (!*quick || tracer->quick_scene != NULL) {
        return ALP_OK;
    }
    build_progress report = {progress, progress_user, alpi_seconds(), false};
    RTCScene made = NULL;
    alp_result result = start_scene(tracer, RTC_SCENE_FLAG_NONE, &report, &made);
    for (unsigned g = 0; g < GEOMETRY_COUNT && result == ALP_OK; g++) {
        if (tracer->count[g] > 0) {
            rtcAttachGeometryByID(made, rtcGetGeometry(tracer->embree_scene, g), g);
        }
    }
    if (result == ALP_OK) {
        result = commit_scene(tracer, &report, made);
    }
    if (result != ALP_OK && made != NULL) {
        rtcReleaseScene(made);
        made = NULL;
    }
    tracer->quick_scene = made;
    *quick = result == ALP_OK;
    return result;
}

// --- tracing -------------------------------------------------------------------------------------

static trace_context start_context(const alpi_tracer *tracer, alpi_trace_filter filter)
{
    trace_context context = {.tracer = tracer, .panes = filter.panes};
    rtcInitIntersectContext(&context.embree);
    context.embree.filter = filter.one_sided ? one_sided_filter : NULL;
    return context;
}

_Static_assert(sizeof(alpi_rays) == sizeof(struct RTCRay8) &&
                   offsetof(alpi_rays, direction_x) == offsetof(struct RTCRay8, dir_x) &&
                   offsetof(alpi_rays, maximum) == offsetof(struct RTCRay8, tfar) &&
                   offsetof(alpi_rays, flags) == offsetof(struct RTCRay8, flags),
               "alpi_rays is what Embree takes");

static const _Alignas(32) int ALL_VALID[ALPI_PACKET] = {-1, -1, -1, -1, -1, -1, -1, -1};

/// Which lanes take part, as Embree wants it.
static const int *spread_bits(uint32_t active, int valid[ALPI_PACKET])
{
    if (active == (1u << ALPI_PACKET) - 1u) {
        return ALL_VALID;
    }
    for (int i = 0; i < ALPI_PACKET; i++) {
        valid[i] = (active >> i & 1u) != 0 ? -1 : 0;
    }
    return valid;
}

uint32_t alpi_tracer_triangle_count(const alpi_tracer *tracer)
{
    return tracer->count[GEOMETRY_SOLID] + tracer->count[GEOMETRY_CUT] +
           tracer->count[GEOMETRY_PANE];
}

bool alpi_tracer_has_panes(const alpi_tracer *tracer)
{
    return tracer->count[GEOMETRY_PANE] > 0;
}

bool alpi_tracer_meets_few(const alpi_tracer *tracer, float reach)
{
    return tracer->few != NULL && alpi_few_near(tracer->few, reach) <= (float)ALPI_FEW_NEAR;
}

void alpi_trace_occluded(const alpi_tracer *tracer, alpi_rays *packets, uint32_t count,
                         uint32_t active, alpi_trace_filter filter, alpi_rays_spread spread)
{
    _Alignas(32) int some[ALPI_PACKET];
    const int *valid = spread_bits(active, some);
    assert(!filter.few || tracer->few != NULL);
    if (filter.few) {
        tracer->few->loops->occluded(tracer->few, packets, count, (const uint32_t *)valid,
                                     filter.one_sided);
        return;
    }
    trace_context context = start_context(tracer, filter);
    assert(!filter.quick || tracer->quick_scene != NULL);
    RTCScene scene = filter.quick ? tracer->quick_scene : tracer->embree_scene;
    if (spread == ALPI_RAYS_SCATTERED && valid == ALL_VALID) {
        rtcOccludedNM(scene, &context.embree, (struct RTCRayN *)packets, ALPI_PACKET, count,
                      sizeof *packets);
        return;
    }
    for (uint32_t i = 0; i < count; i++) {
        rtcOccluded8(valid, scene, &context.embree, (struct RTCRay8 *)&packets[i]);
    }
}

static const _Alignas(32) uint32_t LANE_BITS[ALPI_PACKET] = {1, 2, 4, 8, 16, 32, 64, 128};

/// Lanes whose ray goes along Embree's normal, (v1−v0)×(v2−v0).
static uint32_t find_behind(const struct RTCRayHit8 *found)
{
    uint32_t behind = 0;
    for (int i = 0; i < ALPI_PACKET; i++) {
        const float along = found->ray.dir_x[i] * found->hit.Ng_x[i] +
                            found->ray.dir_y[i] * found->hit.Ng_y[i] +
                            found->ray.dir_z[i] * found->hit.Ng_z[i];
        behind |= along > 0.0f ? LANE_BITS[i] : 0u;
    }
    return behind;
}

/// Hits of the lanes that take part.
static void take_some(const alpi_tracer *tracer, const struct RTCRayHit8 *found, uint32_t active,
                      alpi_hits *hits)
{
    uint32_t hit_lanes = 0;
    for (int i = 0; i < ALPI_PACKET; i++) {
        const uint32_t geometry = found->hit.geomID[i];
        if ((active >> i & 1u) == 0) {
            continue;
        }
        const bool hit = geometry != RTC_INVALID_GEOMETRY_ID;
        hits->distance[i] = hit ? found->ray.tfar[i] : INFINITY;
        hits->b1[i] = hit ? found->hit.u[i] : 0.0f;
        hits->b2[i] = hit ? found->hit.v[i] : 0.0f;
        hits->triangle[i] = hit ? find_triangle(tracer, geometry, found->hit.primID[i]) : ALPI_NONE;
        hit_lanes |= hit ? 1u << i : 0u;
    }
    hits->behind = (hits->behind & ~active) | (find_behind(found) & hit_lanes);
}

/// The same of all lanes, where triangle i is that of primitive i, but for `first`: without a
/// branch.
static void take_all(uint32_t first, const struct RTCRayHit8 *found, alpi_hits *hits)
{
    _Alignas(32) uint32_t hit[ALPI_PACKET];
    uint32_t hit_lanes = 0;
    for (int i = 0; i < ALPI_PACKET; i++) {
        hit[i] = found->hit.geomID[i] != RTC_INVALID_GEOMETRY_ID ? UINT32_MAX : 0;
        hit_lanes |= hit[i] & LANE_BITS[i];
        hits->triangle[i] = (first + found->hit.primID[i]) | ~hit[i]; // ALPI_NONE is all ones
    }
    for (int i = 0; i < ALPI_PACKET; i++) {
        hits->distance[i] = hit[i] != 0 ? found->ray.tfar[i] : INFINITY;
        hits->b1[i] = hit[i] != 0 ? found->hit.u[i] : 0.0f;
        hits->b2[i] = hit[i] != 0 ? found->hit.v[i] : 0.0f;
    }
    hits->behind = find_behind(found) & hit_lanes;
}

/// Whether all its triangles are solid, and one after the other in the scene too.
static bool is_in_row(const alpi_tracer *tracer)
{
    const uint32_t count = tracer->in_row[GEOMETRY_SOLID];
    return count > 0 && count == alpi_tracer_triangle_count(tracer);
}

/// Field by field: see alpi_rays_clear.
static void copy_rays(const alpi_rays *rays, struct RTCRay8 *to)
{
    for (int i = 0; i < ALPI_PACKET; i++) {
        to->org_x[i] = rays->origin_x[i];
        to->org_y[i] = rays->origin_y[i];
        to->org_z[i] = rays->origin_z[i];
        to->tnear[i] = rays->minimum[i];
        to->dir_x[i] = rays->direction_x[i];
        to->dir_y[i] = rays->direction_y[i];
        to->dir_z[i] = rays->direction_z[i];
        to->time[i] = rays->time[i];
        to->tfar[i] = rays->maximum[i];
        to->mask[i] = UINT32_MAX; // this build of Embree has ray masks on
        to->id[i] = to->flags[i] = 0;
    }
}

static void trace_nearest(const alpi_tracer *tracer, const alpi_rays *rays, uint32_t active,
                          trace_context *context, alpi_hits *hits)
{
    struct RTCRayHit8 found;
    _Alignas(32) int some[ALPI_PACKET];
    const int *valid = spread_bits(active, some);
    copy_rays(rays, &found.ray);
    memset(found.hit.geomID, 0xff, sizeof found.hit.geomID); // RTC_INVALID_GEOMETRY_ID
    memset(found.hit.instID, 0xff, sizeof found.hit.instID);
    rtcIntersect8(valid, tracer->embree_scene, &context->embree, &found);
    if (valid == ALL_VALID && is_in_row(tracer)) {
        take_all(tracer->triangles[GEOMETRY_SOLID][0], &found, hits);
    } else {
        take_some(tracer, &found, active, hits);
    }
}

void alpi_trace_nearest_many(const alpi_tracer *tracer, const alpi_rays *const *packets,
                             const uint32_t *active, uint32_t count, alpi_trace_filter filter,
                             alpi_hits *hits)
{
    if (tracer->few != NULL && tracer->few->edge_count <= ALPI_FEW_NEAREST) {
        tracer->few->loops->nearest(tracer->few, packets, active, count, filter.one_sided, hits);
        return;
    }
    trace_context context = start_context(tracer, filter);
    for (uint32_t p = 0; p < count; p++) {
        trace_nearest(tracer, packets[p], active[p], &context, &hits[p]);
    }
}

void alpi_trace_nearest(const alpi_tracer *tracer, const alpi_rays *rays, uint32_t active,
                        alpi_trace_filter filter, alpi_hits *hits)
{
    alpi_trace_nearest_many(tracer, &rays, &active, 1, filter, hits);
}

void alpi_trace_nearest_coherent(const alpi_tracer *tracer, const alpi_rays *rays, uint32_t active,
                                 alpi_trace_filter filter, alpi_hits *hits)
{
    trace_context context = start_context(tracer, filter);
    context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    trace_nearest(tracer, rays, active, &context, hits);
}
