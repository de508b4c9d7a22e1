// SPDX-License-Identifier: MIT
#include "embree_clock.h"

#include "base/tasks.h"

#include <embree3/rtcore.h>

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

// Names that the linker makes: references to NAME become __wrap_NAME, the original is __real_NAME.
void __real_rtcIntersect8(const int *valid, RTCScene scene, struct RTCIntersectContext *context,
                          struct RTCRayHit8 *rays);
void __real_rtcOccluded8(const int *valid, RTCScene scene, struct RTCIntersectContext *context,
                         struct RTCRay8 *rays);
void __real_rtcOccludedNM(RTCScene scene, struct RTCIntersectContext *context, struct RTCRayN *rays,
                          unsigned n, unsigned m, size_t stride);
void __wrap_rtcIntersect8(const int *valid, RTCScene scene, struct RTCIntersectContext *context,
                          struct RTCRayHit8 *rays);
void __wrap_rtcOccluded8(const int *valid, RTCScene scene, struct RTCIntersectContext *context,
                         struct RTCRay8 *rays);
void __wrap_rtcOccludedNM(RTCScene scene, struct RTCIntersectContext *context, struct RTCRayN *rays,
                          unsigned n, unsigned m, size_t stride);

void __wrap_rtcIntersect8(const int *valid, RTCScene scene, struct RTCIntersectContext *context,
                          struct RTCRayHit8 *rays)
{
    const double started = running ? alpi_seconds() : 0.0;
    __real_rtcIntersect8(valid, scene, context, rays);
    take(started);
}

void __wrap_rtcOccluded8(const int *valid, RTCScene scene, struct RTCIntersectContext *context,
                         struct RTCRay8 *rays)
{
    const double started = running ? alpi_seconds() : 0.0;
    __real_rtcOccluded8(valid, scene, context, rays);
    take(started);
}

void __wrap_rtcOccludedNM(RTCScene scene, struct RTCIntersectContext *context, struct RTCRayN *rays,
                          unsigned n, unsigned m, size_t stride)
{
    const double started = running ? alpi_seconds() : 0.0;
    __real_rtcOccludedNM(scene, context, rays, n, m, stride);
    take(started);
}
