// SPDX-License-Identifier: MIT
// What Embree asks at hits: whether they are any.
#include "trace/embree.h"

#include "scene/sides.h"

#include <string.h>

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

static uint32_t lane_triangle(const struct RTCFilterFunctionNArguments *a, unsigned lane)
{
    const alpi_trace_context *context = (const void *)a->context;
    uint32_t geometry = lane_uint(a->hit, a->N, HIT_GEOMETRY, lane);
    return alpi_embree_triangle(context->tracer, geometry,
                                lane_uint(a->hit, a->N, HIT_PRIMITIVE, lane));
}

/// Lets rays through where alpha cuts the surface.
void alpi_embree_cut_filter(const struct RTCFilterFunctionNArguments *a)
{
    const alpi_trace_context *context = (const void *)a->context;
    for (unsigned i = 0; i < a->N; i++) {
        if (a->valid[i] != 0 && alpi_surface_is_cut(context->tracer->scene, lane_triangle(a, i),
                                                    lane_float(a->hit, a->N, HIT_U, i),
                                                    lane_float(a->hit, a->N, HIT_V, i))) {
            a->valid[i] = 0;
        }
    }
}

/// Panes do not stop shadow rays whose caller sees to them.
void alpi_embree_pane_shadow_filter(const struct RTCFilterFunctionNArguments *a)
{
    const alpi_trace_context *context = (const void *)a->context;
    if (!context->panes) {
        alpi_embree_cut_filter(a);
        return;
    }
    for (unsigned i = 0; i < a->N; i++) {
        a->valid[i] = 0;
    }
}

void alpi_embree_pane_filter(const struct RTCFilterFunctionNArguments *a)
{
    const alpi_trace_context *context = (const void *)a->context;
    if (!context->panes) {
        alpi_embree_cut_filter(a);
    }
}

/// Whether a ray meets the back of its triangle: Embree's normal is (v1−v0)×(v2−v0), which points
/// outside for a counter-clockwise triangle.
static bool is_from_behind(const struct RTCFilterFunctionNArguments *a, unsigned lane)
{
    float along = 0.0f;
    for (unsigned k = 0; k < 3; k++) {
        along += lane_float(a->ray, a->N, RAY_DIRECTION_X + k, lane) *
                 lane_float(a->hit, a->N, HIT_NORMAL_X + k, lane);
    }
    return along > 0.0f;
}

void alpi_embree_one_sided_filter(const struct RTCFilterFunctionNArguments *a)
{
    const alpi_trace_context *context = (const void *)a->context;
    for (unsigned i = 0; i < a->N; i++) {
        if (a->valid[i] != 0 && is_from_behind(a, i) &&
            !alpi_surface_is_double_sided(context->tracer->scene, lane_triangle(a, i))) {
            a->valid[i] = 0;
        }
    }
}

void alpi_embree_front_filter(const struct RTCFilterFunctionNArguments *a)
{
    const alp_scene *scene = ((const alpi_trace_context *)(const void *)a->context)->tracer->scene;
    for (unsigned i = 0; i < a->N; i++) {
        if (a->valid[i] != 0 &&
            is_from_behind(a, i) != alpi_sides_is_turned(scene, lane_triangle(a, i))) {
            a->valid[i] = 0;
        }
    }
}
