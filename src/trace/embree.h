// SPDX-License-Identifier: MIT
// What the files behind trace.h that know Embree 3 share: embree.c builds, embree_filters.c is
// asked at hits, embree_rays.c traces. Based on: Wald, Woop, Benthin, Johnson, Ernst. Embree: A
// Kernel Framework for Efficient CPU Ray Tracing. SIGGRAPH 2014.
#ifndef ALPI_TRACE_EMBREE_H
#define ALPI_TRACE_EMBREE_H

#include "trace/trace.h"

#include <embree3/rtcore.h>

/// Triangles are in three geometries: those that always stop a ray, and those whose material may
/// cut it or let it through in part, which alone pay for a filter call at every hit.
typedef enum alpi_geometry_kind {
    ALPI_GEOMETRY_SOLID = 0,
    ALPI_GEOMETRY_CUT = 1,
    ALPI_GEOMETRY_PANE = 2,
    ALPI_GEOMETRY_COUNT = 3
} alpi_geometry_kind;

struct alpi_tracer {
    const alp_scene *scene;
    RTCDevice device;
    RTCScene embree_scene;
    RTCScene quick_scene; // the same geometries without care for edges, or NULL
    bool wide; // packets of 16 are met as fast as two of 8, or up to a fifth faster where coherent
    uint32_t *triangles[ALPI_GEOMETRY_COUNT]; // scene triangle of each primitive of a geometry
    uint32_t count[ALPI_GEOMETRY_COUNT];
    uint32_t in_row[ALPI_GEOMETRY_COUNT]; // of the first so many, triangle i is triangle 0 plus i:
                                          // to read it would mostly be a miss
    uint32_t first_vertex, end_vertex;    // of the scene: all that the triangles use are between
};

/// Our data behind Embree's context, which the filters get.
typedef struct alpi_trace_context {
    struct RTCIntersectContext embree; // first: filters get its address
    const alpi_tracer *tracer;
    bool panes; // the caller sees to them
    bool backs; // fronts are not met before backs in their place
} alpi_trace_context;

/// The scene's triangle of a hit.
static inline uint32_t alpi_embree_triangle(const alpi_tracer *tracer, uint32_t geometry,
                                            uint32_t primitive)
{
    return primitive < tracer->in_row[geometry] ? tracer->triangles[geometry][0] + primitive
                                                : tracer->triangles[geometry][primitive];
}

/// Filters of geometries and of calls: they let rays through where alpha cuts the surface, where
/// the caller sees to panes, and through single-sided surfaces from behind.
void alpi_embree_cut_filter(const struct RTCFilterFunctionNArguments *a);
void alpi_embree_pane_filter(const struct RTCFilterFunctionNArguments *a);
void alpi_embree_pane_shadow_filter(const struct RTCFilterFunctionNArguments *a);
void alpi_embree_one_sided_filter(const struct RTCFilterFunctionNArguments *a);
/// Lets rays through all surfaces from behind.
void alpi_embree_front_filter(const struct RTCFilterFunctionNArguments *a);

#endif
