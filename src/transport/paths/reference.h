// SPDX-License-Identifier: MIT
// The truth that every technique is measured against: a path tracer for diffuse surfaces, for
// receivers and for pictures. Right before it is fast.
//
// At a point x with normal n it estimates E(x) = ∫ L(ω) cosθ dω. Light is asked for directly and by
// cosine-distributed rays, the two weighted by the balance heuristic; a ray that hits a surface of
// albedo ρ brings Le + ρ/π · E there. Russian roulette ends long paths without bias.
// Based on: J. T. Kajiya. The Rendering Equation. SIGGRAPH 1986;
//           E. Veach, L. J. Guibas. Optimally Combining Sampling Techniques. SIGGRAPH 1995.
#ifndef ALPI_TRANSPORT_REFERENCE_H
#define ALPI_TRANSPORT_REFERENCE_H

#include "base/tasks.h"
#include "scene/lights/lighting.h"
#include "scene/receivers.h"
#include "trace/trace.h"
#include "transport/surface_light.h"

/// Independently scrambled parts of a receiver's samples: the spread of their means gives the
/// standard error. Samples are rounded up to a multiple of it.
enum { ALPI_REFERENCE_REPLICATES = 16 };
/// Paths never grow longer than this: the chance that one would, at ρ = .95, is below 1e-20.
enum { ALPI_REFERENCE_BOUNCE_LIMIT = 1024 };

typedef struct alpi_reference {
    alp_context *context;
    const alp_scene *scene;
    const alpi_tracer *tracer;
    const alpi_lighting *lighting;
    const alpi_lighting *direct; // NULL, or the light that arrives directly, in place of `lighting`
    alpi_trace_filter filter;
    uint32_t bounces; // 0 = direct light only; up to BOUNCE_LIMIT
    uint32_t samples; // paths of each receiver or pixel
    bool next_event;  // false: light is only found by rays that hit it, a cross-check; lights
                      // without extent then give nothing
    bool share;       // eight receivers that follow each other, best if neighbours, share what
                      // their paths find after the first bounce: less noise for as many paths,
                      // alike in all eight. Pixels do not
    // NULL, or light that surfaces reflect, as somebody knows already: from the first vertex on a
    // surface a path goes to what it meets next and ends there with this, if it may bounce there.
    // Where it meets a cell nearer than known_reach of its sides it goes on, while it may.
    const alpi_surface_light *known; // with cells
    float known_reach;
    uint64_t seed;
} alpi_reference;

/// Paths that are sent for `samples`: rounded up to a multiple of the replicates.
uint32_t alpi_reference_samples(const alpi_reference *reference);

/// A mean over paths with its variance (of the mean: its root is the standard error).
typedef struct alpi_reference_value {
    float mean[3], variance[3];
} alpi_reference_value;

/// Mean of the channels.
static inline float alpi_reference_level(const alpi_reference_value *v)
{
    return (v->mean[0] + v->mean[1] + v->mean[2]) * (1.0f / 3.0f);
}

/// Mean of replicates' means, and its variance by their spread.
/// @param sums [replicates][3], each over `each` samples
void alpi_reference_mean(const double (*sums)[3], uint32_t replicates, uint32_t each,
                         alpi_reference_value *value);

/// Irradiance E [W·m⁻²] of the receivers in `list` (NULL = all), means over their points.
/// @param values [receivers->count] out; only those of the list are written
/// @return ALP_OK; CANCELLED; OUT_OF_MEMORY
alp_result alpi_reference_irradiance(const alpi_reference *reference,
                                     const alpi_receivers *receivers, const uint32_t *list,
                                     uint32_t list_count, const alpi_task_progress *progress,
                                     alpi_reference_value *values);

/// Rays of a camera: metres, unit.
typedef struct alpi_camera_rays {
    float *start[3], *direction[3]; // [count] each
} alpi_camera_rays;
/// Camera rays of `count` pixels, pixel by pixel with a point (u, v) of the unit square in each.
/// Called by many threads.
typedef void alpi_camera_fn(const void *user, uint32_t count, const uint64_t *pixels,
                            const float *u, const float *v, const alpi_camera_rays *rays);

/// Radiance L [W·sr⁻¹·m⁻²] that reaches `count` pixels from number `first` on. By any thread; as
/// the body of a parallel loop it stops when the loop does.
/// @param values  [count] out
/// @param covered [count] out: share of the paths that met a surface, or light behind all of them
/// @return ALP_OK; CANCELLED
alp_result alpi_reference_pixels(const alpi_reference *reference, alpi_camera_fn *camera,
                                 const void *camera_user, uint64_t first, uint32_t count,
                                 alpi_reference_value *values, float *covered);

#endif
