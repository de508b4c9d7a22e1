// SPDX-License-Identifier: MIT
#include "raw_embree.h"

#include "bench.h"

#include "base/tasks.h"

#include <embree3/rtcore.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct raw_embree {
    RTCDevice device;
    RTCScene scene;
    double build_seconds;
};

static bool attach(raw_embree *raw, const alp_scene *scene)
{
    RTCGeometry geometry = rtcNewGeometry(raw->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *vertices =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), scene->vertex_count);
    uint32_t(*indices)[3] = rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof *indices, scene->usable_count);
    if (vertices == NULL || indices == NULL) {
        rtcReleaseGeometry(geometry);
        return false;
    }
    memcpy(vertices, scene->positions, sizeof *scene->positions * scene->vertex_count);
    for (uint32_t t = 0, i = 0; t < scene->triangle_count; t++) {
        if (scene->triangle_usable[t]) {
            memcpy(indices[i++], scene->triangles[t], sizeof *indices);
        }
    }
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(raw->scene, geometry, 0);
    rtcReleaseGeometry(geometry);
    return true;
}

raw_embree *raw_embree_create(const alp_scene *scene, bool robust)
{
    raw_embree *raw = calloc(1, sizeof *raw);
    const double started = alpi_seconds();
    if (raw == NULL || (raw->device = rtcNewDevice("threads=1,set_affinity=0")) == NULL ||
        (raw->scene = rtcNewScene(raw->device)) == NULL) {
        fprintf(stderr, "alpenglow bench: Embree does not start\n");
        raw_embree_destroy(raw);
        return NULL;
    }
    rtcSetSceneFlags(raw->scene, (robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE) |
                                     RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    rtcSetSceneBuildQuality(raw->scene, RTC_BUILD_QUALITY_MEDIUM);
    if (!attach(raw, scene)) {
        fprintf(stderr, "alpenglow bench: Embree takes no geometry\n");
        raw_embree_destroy(raw);
        return NULL;
    }
    rtcCommitScene(raw->scene);
    raw->build_seconds = alpi_seconds() - started;
    return raw;
}

void raw_embree_destroy(raw_embree *raw)
{
    if (raw != NULL && raw->scene != NULL) {
        rtcReleaseScene(raw->scene);
    }
    if (raw != NULL && raw->device != NULL) {
        rtcReleaseDevice(raw->device);
    }
    free(raw);
}

double raw_embree_build_seconds(const raw_embree *raw)
{
    return raw->build_seconds;
}

void raw_embree_occluded(const raw_embree *raw, alpi_rays *packets, uint32_t count)
{
    static const _Alignas(32) int valid[ALPI_PACKET] = {-1, -1, -1, -1, -1, -1, -1, -1};
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (uint32_t i = 0; i < count; i++) {
        rtcOccluded8(valid, raw->scene, &context, (struct RTCRay8 *)&packets[i]);
    }
}

void raw_embree_occluded_stream(const raw_embree *raw, alpi_rays *packets, uint32_t count)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccludedNM(raw->scene, &context, (struct RTCRayN *)packets, ALPI_PACKET, count,
                  sizeof *packets);
}

void raw_embree_lay_pairs(const alpi_rays *packets, uint32_t count, alpi_ray_pair *pairs)
{
    for (uint32_t i = 0; i < count / 2 * 2; i++) {
        alpi_ray_pair_set(&pairs[i / 2], i % 2, &packets[i]);
    }
}

static const _Alignas(64) int VALID_PAIR[2 * ALPI_PACKET] = {-1, -1, -1, -1, -1, -1, -1, -1,
                                                             -1, -1, -1, -1, -1, -1, -1, -1};

void raw_embree_occluded_pairs(const raw_embree *raw, alpi_ray_pair *pairs, uint32_t count)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (uint32_t i = 0; i < count; i++) {
        rtcOccluded16(VALID_PAIR, raw->scene, &context, (struct RTCRay16 *)&pairs[i]);
    }
}

double raw_embree_time_nearest(const raw_embree *raw, const alpi_rays *packets, uint32_t count,
                               bool coherent, double (*clock)(void))
{
    enum { BLOCK = 256 };
    static const _Alignas(32) int valid[ALPI_PACKET] = {-1, -1, -1, -1, -1, -1, -1, -1};
    static _Thread_local struct RTCRayHit8 block[BLOCK];
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (coherent) {
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    }
    double seconds = 0.0;
    for (uint32_t first = 0; first < count; first += BLOCK) {
        const uint32_t some = count - first < BLOCK ? count - first : BLOCK;
        for (uint32_t i = 0; i < some; i++) {
            memcpy(&block[i].ray, &packets[first + i], sizeof block[i].ray);
            memset(&block[i].hit, 0xff, sizeof block[i].hit);
        }
        const double started = clock();
        for (uint32_t i = 0; i < some; i++) {
            rtcIntersect8(valid, raw->scene, &context, &block[i]);
        }
        seconds += clock() - started;
    }
    return seconds;
}

double raw_embree_time_pairs(const raw_embree *raw, const alpi_rays *packets, uint32_t count,
                             double (*clock)(void))
{
    enum { BLOCK = 128 };
    static _Thread_local struct RTCRayHit16 block[BLOCK];
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    double seconds = 0.0;
    for (uint32_t first = 0; first + 2 <= count; first += 2 * BLOCK) {
        const uint32_t left = (count - first) / 2, some = left < BLOCK ? left : BLOCK;
        for (uint32_t i = 0; i < some; i++) {
            raw_embree_lay_pairs(packets + first + 2 * (size_t)i, 2,
                                 (alpi_ray_pair *)&block[i].ray);
            memset(&block[i].hit, 0xff, sizeof block[i].hit);
        }
        const double started = clock();
        for (uint32_t i = 0; i < some; i++) {
            rtcIntersect16(VALID_PAIR, raw->scene, &context, &block[i]);
        }
        seconds += clock() - started;
    }
    return seconds;
}

static void call_again(const raw_embree *raw, const embree_packet *p, struct RTCRayHit8 *packet,
                       alpi_rays *stream)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (p->coherent) {
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    }
    if (p->kind == EMBREE_NEAREST) {
        rtcIntersect8(p->valid, raw->scene, &context, packet);
    } else if (p->kind == EMBREE_OCCLUDED) {
        rtcOccluded8(p->valid, raw->scene, &context, (struct RTCRay8 *)stream);
    } else if (p->count > 0) {
        rtcOccludedNM(raw->scene, &context, (struct RTCRayN *)stream, ALPI_PACKET, p->count,
                      sizeof *stream);
    }
}

/// Where the first call at a packet or behind it begins.
static uint32_t next_call(const embree_record *record, uint32_t packet)
{
    while (packet < record->count && record->packets[packet].count == 0) {
        packet++;
    }
    return packet;
}

double raw_embree_time_calls(const raw_embree *raw, const embree_record *record, uint32_t begin,
                             uint32_t end, double (*clock)(void))
{
    enum { BLOCK = 256, MOST = BLOCK + ALPI_TRACE_BATCH };
    static _Thread_local struct RTCRayHit8 block[MOST];
    static _Thread_local alpi_rays streams[MOST];
    double seconds = 0.0;
    end = next_call(record, end);
    for (uint32_t first = next_call(record, begin), next; first < end; first = next) {
        next = next_call(record, end - first < BLOCK ? end : first + BLOCK);
        const embree_packet *packets = &record->packets[first];
        for (uint32_t i = 0; i < next - first; i++) {
            memcpy(&block[i].ray, &packets[i].rays, sizeof block[i].ray);
            memset(&block[i].hit, 0xff, sizeof block[i].hit);
            streams[i] = packets[i].rays;
        }
        const double started = clock();
        for (uint32_t i = 0; i < next - first; i++) {
            call_again(raw, &packets[i], &block[i], &streams[i]);
        }
        seconds += clock() - started;
    }
    return seconds;
}
