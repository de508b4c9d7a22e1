// SPDX-License-Identifier: MIT
// Builds what Embree 3 traces.
#include "trace/embree.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <stdio.h>
#include <string.h>

/// A ray gains 4 to 7 ns and a triangle costs 300, on one thread: for four that share the rays they
/// are even at 170 to 300 rays. Of the rays that a map might take an adaptive one sends a fifth to
/// a quarter, so 700 to 1,500 would be asked for; for two workers half of them: measured, whole
/// bakes of a torus and of a room are even at 230 to 290, and take 3 to 4 % less time at 390 to
/// 450, 8 to 10 % less at 590 to 910. The number of workers may not decide: it changes no bit.
static const double QUICK_RAYS_PER_TRIANGLE = 500.0;

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
    for (int g = 0; g < ALPI_GEOMETRY_COUNT; g++) {
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

/// The geometry that a triangle goes to, ALPI_GEOMETRY_COUNT for none.
static alpi_geometry_kind kind_of(const alp_scene *scene, const bool *surfaces, uint32_t triangle)
{
    const uint32_t surface = scene->triangle_surface[triangle];
    if (!scene->triangle_usable[triangle] || !is_chosen(surfaces, surface)) {
        return ALPI_GEOMETRY_COUNT;
    }
    return alpi_surface_is_pane(scene, surface)    ? ALPI_GEOMETRY_PANE
           : alpi_surface_has_cuts(scene, surface) ? ALPI_GEOMETRY_CUT
                                                   : ALPI_GEOMETRY_SOLID;
}

static void add_triangle(alpi_tracer *tracer, alpi_geometry_kind kind, uint32_t triangle)
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
    size_t room[ALPI_GEOMETRY_COUNT + 1] = {0};
    for (uint32_t t = first; t < end; t++) {
        room[kind_of(scene, surfaces, t)]++;
    }
    for (int g = 0; g < ALPI_GEOMETRY_COUNT; g++) {
        ALPI_TRY_NEW(scene->context, tracer->triangles[g], room[g]);
    }
    tracer->first_vertex = scene->vertex_count;
    for (uint32_t t = first; t < end; t++) {
        const alpi_geometry_kind kind = kind_of(scene, surfaces, t);
        if (kind != ALPI_GEOMETRY_COUNT) {
            add_triangle(tracer, kind, t);
        }
    }
    return ALP_OK;
}

/// Vertices are copied: Embree reads 16 bytes at each of 12, past the end of an array of ours.
static alp_result attach_geometry(alpi_tracer *tracer, alpi_geometry_kind kind)
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
    if (kind == ALPI_GEOMETRY_CUT) {
        rtcSetGeometryIntersectFilterFunction(geometry, alpi_embree_cut_filter);
        rtcSetGeometryOccludedFilterFunction(geometry, alpi_embree_cut_filter);
    }
    if (kind == ALPI_GEOMETRY_PANE) {
        rtcSetGeometryIntersectFilterFunction(geometry, alpi_embree_pane_filter);
        rtcSetGeometryOccludedFilterFunction(geometry, alpi_embree_pane_shadow_filter);
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
    tracer->wide =
        rtcGetDeviceProperty(tracer->device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
    // Robust: no ray slips through the edge between two triangles.
    ALP_TRY(start_scene(tracer, RTC_SCENE_FLAG_ROBUST, progress, &tracer->embree_scene));
    ALP_TRY(sort_triangles(tracer, surfaces));
    for (int g = 0; g < ALPI_GEOMETRY_COUNT; g++) {
        ALP_TRY(attach_geometry(tracer, (alpi_geometry_kind)g));
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
    for (unsigned g = 0; g < ALPI_GEOMETRY_COUNT && result == ALP_OK; g++) {
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

uint32_t alpi_tracer_triangle_count(const alpi_tracer *tracer)
{
    return tracer->count[ALPI_GEOMETRY_SOLID] + tracer->count[ALPI_GEOMETRY_CUT] +
           tracer->count[ALPI_GEOMETRY_PANE];
}

bool alpi_tracer_has_panes(const alpi_tracer *tracer)
{
    return tracer->count[ALPI_GEOMETRY_PANE] > 0;
}
