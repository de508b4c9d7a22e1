// SPDX-License-Identifier: MIT
#include "embree_clock.h"

#include "base/tasks.h"

#include <embree3/rtcore.h>

static _Thread_local bool running;
static _Thread_local double inside;

void embree_clock_start(void)
{
    inside = 0.0;
    running = true;
}

double embree_clock_stop(void)
{
    running = false;
    return inside;
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
    inside += running ? alpi_seconds() - started : 0.0;
}

void __wrap_rtcOccluded8(const int *valid, RTCScene scene, struct RTCIntersectContext *context,
                         struct RTCRay8 *rays)
{
    const double started = running ? alpi_seconds() : 0.0;
    __real_rtcOccluded8(valid, scene, context, rays);
    inside += running ? alpi_seconds() - started : 0.0;
}

void __wrap_rtcOccludedNM(RTCScene scene, struct RTCIntersectContext *context, struct RTCRayN *rays,
                          unsigned n, unsigned m, size_t stride)
{
    const double started = running ? alpi_seconds() : 0.0;
    __real_rtcOccludedNM(scene, context, rays, n, m, stride);
    inside += running ? alpi_seconds() - started : 0.0;
}
