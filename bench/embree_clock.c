// SPDX-License-Identifier: MIT
#include "embree_clock.h"

#include "base/tasks.h"

#include <embree3/rtcore.h>

#include <string.h>

static _Thread_local bool running;
static _Thread_local double inside;
static _Thread_local uint64_t call_count;

void embree_clock_start(void)
{
    inside = 0.0;
    call_count = 0;
    running = true;
}

double embree_clock_stop(uint64_t *calls)
{
    running = false;
    *calls = call_count;
    return inside;
}

double embree_clock_reading(void)
{
    enum { READINGS = 100000 };
    const double started = alpi_seconds();
    double last = started;
    for (int i = 0; i < READINGS; i++) {
        last = alpi_seconds();
    }
    return (last - started) / READINGS;
}

/// After a call that began then.
static void take(double started)
{
    if (running) {
        inside += alpi_seconds() - started;
        call_count++;
    }
}

// --- recording -----------------------------------------------------------------------------------

static embree_record *record_in_use;

void embree_record_to(embree_record *record)
{
    record_in_use = record;
}

/// @param valid NULL: all lanes   @param stride bytes from packet to packet
static void write_down(embree_call_kind kind, const int *valid,
                       const struct RTCIntersectContext *context, const void *rays, uint32_t count,
                       size_t stride)
{
    embree_record *r = record_in_use;
    if (r == NULL) {
        return;
    }
    const bool wanted = r->calls++ / EMBREE_RECORD_BLOCK % r->every == 0;
    r->seen += count;
    if (!wanted || r->capacity - r->count < count) {
        return;
    }
    for (uint32_t i = 0; i < count; i++) {
        embree_packet *p = &r->packets[r->count++];
        memcpy(&p->rays, (const char *)rays + i * stride, sizeof p->rays);
        memset(p->valid, 0xff, sizeof p->valid);
        if (valid != NULL) {
            memcpy(p->valid, valid, sizeof p->valid);
        }
        p->kind = kind;
        p->count = i == 0 ? count : 0;
        p->coherent = (context->flags & RTC_INTERSECT_CONTEXT_FLAG_COHERENT) != 0;
    }
}

/// Sixteen rays, as the two packets of eight that they are for the limit.
static void write_halves(embree_call_kind kind, const int *valid,
                         const struct RTCIntersectContext *context, const struct RTCRay16 *rays)
{
    const char *fields = (const char *)rays;
    for (int half = 0; half < 2 && record_in_use != NULL; half++) {
        struct RTCRay8 packet;
        for (size_t k = 0; k < sizeof packet / sizeof packet.org_x; k++) {
            memcpy((char *)&packet + k * sizeof packet.org_x,
                   fields + (2 * k + (size_t)half) * sizeof packet.org_x, sizeof packet.org_x);
        }
        write_down(kind, valid + half * ALPI_PACKET, context, &packet, 1, 0);
    }
}

// --- calls ---------------------------------------------------------------------------------------

// Names that the linker makes: references to NAME become __wrap_NAME, the original is __real_NAME.
// NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl37-c)
void __real_rtcIntersect8(const int *valid, RTCScene scene, struct RTCIntersectContext *context,
                          struct RTCRayHit8 *rays);
void __real_rtcIntersect16(const int *valid, RTCScene scene, struct RTCIntersectContext *context,
                           struct RTCRayHit16 *rays);
void __real_rtcOccluded8(const int *valid, RTCScene scene, struct RTCIntersectContext *context,
                         struct RTCRay8 *rays);
void __real_rtcOccluded16(const int *valid, RTCScene scene, struct RTCIntersectContext *context,
                          struct RTCRay16 *rays);
void __real_rtcOccludedNM(RTCScene scene, struct RTCIntersectContext *context, struct RTCRayN *rays,
                          unsigned n, unsigned m, size_t stride);
void __wrap_rtcIntersect8(const int *valid, RTCScene scene, struct RTCIntersectContext *context,
                          struct RTCRayHit8 *rays);
void __wrap_rtcIntersect16(const int *valid, RTCScene scene, struct RTCIntersectContext *context,
                           struct RTCRayHit16 *rays);
void __wrap_rtcOccluded8(const int *valid, RTCScene scene, struct RTCIntersectContext *context,
                         struct RTCRay8 *rays);
void __wrap_rtcOccluded16(const int *valid, RTCScene scene, struct RTCIntersectContext *context,
                          struct RTCRay16 *rays);
void __wrap_rtcOccludedNM(RTCScene scene, struct RTCIntersectContext *context, struct RTCRayN *rays,
                          unsigned n, unsigned m, size_t stride);
// NOLINTEND(bugprone-reserved-identifier,cert-dcl37-c)

void __wrap_rtcIntersect8(const int *valid, RTCScene scene, struct RTCIntersectContext *context,
                          struct RTCRayHit8 *rays)
{
    write_down(EMBREE_NEAREST, valid, context, &rays->ray, 1, 0);
    const double started = running ? alpi_seconds() : 0.0;
    __real_rtcIntersect8(valid, scene, context, rays);
    take(started);
}

void __wrap_rtcIntersect16(const int *valid, RTCScene scene, struct RTCIntersectContext *context,
                           struct RTCRayHit16 *rays)
{
    write_halves(EMBREE_NEAREST, valid, context, &rays->ray);
    const double started = running ? alpi_seconds() : 0.0;
    __real_rtcIntersect16(valid, scene, context, rays);
    take(started);
}

void __wrap_rtcOccluded8(const int *valid, RTCScene scene, struct RTCIntersectContext *context,
                         struct RTCRay8 *rays)
{
    write_down(EMBREE_OCCLUDED, valid, context, rays, 1, 0);
    const double started = running ? alpi_seconds() : 0.0;
    __real_rtcOccluded8(valid, scene, context, rays);
    take(started);
}

void __wrap_rtcOccluded16(const int *valid, RTCScene scene, struct RTCIntersectContext *context,
                          struct RTCRay16 *rays)
{
    write_halves(EMBREE_OCCLUDED, valid, context, rays);
    const double started = running ? alpi_seconds() : 0.0;
    __real_rtcOccluded16(valid, scene, context, rays);
    take(started);
}

void __wrap_rtcOccludedNM(RTCScene scene, struct RTCIntersectContext *context, struct RTCRayN *rays,
                          unsigned n, unsigned m, size_t stride)
{
    write_down(EMBREE_STREAM, NULL, context, rays, m, stride); // ours are of eight
    const double started = running ? alpi_seconds() : 0.0;
    __real_rtcOccludedNM(scene, context, rays, n, m, stride);
    take(started);
}
