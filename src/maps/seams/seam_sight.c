// SPDX-License-Identifier: MIT
#include "maps/seams/seam_sight.h"

#include "base/tasks.h"
#include "scene/double3.h"
#include "scene/sides.h"

#include <math.h>

enum { SAMPLES_PER_PACKET = ALPI_PACKET / ALPI_SIGHT_RAYS, PACKETS_PER_RANGE = 16 };
/// Rays reach so far from the edge, in texels; and so far into a triangle that is smaller.
static const double REACH = 1.0, DEPTH = 0.5;
static const double HEIGHTS[ALPI_SIGHT_RAYS] = {0.1, 0.5}; // texels above the edge
static const double LEAST_COSINE = 0.1; // between a normal and the mean of both: of 84°

/// One side of a seam: a place on the edge of its triangle.
typedef struct side {
    double3 place, inward, normal; // metres; unit, of the side that the map holds
    double reach;                  // metres inward
    double rounding;               // metres: how far above the surface a ray must start
} side;

static double3 load(const float position[3])
{
    return double3_from(vec3_load(position));
}

/// The scale of a triangle inward from a place on its edge: h e / (e + |across|), h the height of
/// the third corner, `across` its way along the edge from the place, and e from the place to the
/// end of the edge on that side. A ray of this length may leave the triangle.
/// @param opposite the third corner, seen from the place
static double find_room(double3 inward, double3 along, double before, double after,
                        double3 opposite)
{
    const double height = double3_dot(opposite, inward), across = double3_dot(opposite, along);
    const double end = across < 0.0 ? before : after;
    return height * end / (end + fabs(across));
}

static side make_side(const alp_scene *scene, uint32_t half_edge, double share, double texel)
{
    const uint32_t *corners = scene->triangles[half_edge / 3], k = half_edge % 3;
    const double3 from = load(scene->positions[corners[k]]);
    const double3 to = load(scene->positions[corners[(k + 1) % 3]]);
    const double3 third = load(scene->positions[corners[(k + 2) % 3]]);
    const double3 way = double3_sub(to, from);
    const double3 normal = double3_unit(double3_cross(way, double3_sub(third, from)));
    const double3 along = double3_unit(way), inward = double3_cross(normal, along);
    const double3 place = double3_add(from, double3_scale(way, share));
    const double length = double3_length(way);
    const double room =
        find_room(inward, along, share * length, (1.0 - share) * length, double3_sub(third, place));
    vec3 c[3];
    alpi_triangle_corners(scene, half_edge / 3, c);
    const double3 seen = double3_from(alpi_sides_normal(scene, half_edge / 3));
    return (side){place, inward, seen, fmin(REACH * texel, DEPTH * room),
                  (double)alpi_receiver_offset(double3_to_vec3(place), c)};
}

alpi_sight alpi_sight_aim(const alp_scene *scene, const uint32_t half_edges[2],
                          const double shares[2], const float texels[2])
{
    alpi_sight sight = {.aimed = false};
    side sides[2];
    for (int i = 0; i < 2; i++) {
        sides[i] = make_side(scene, half_edges[i], shares[i], (double)texels[i]);
    }
    const double3 mean = double3_unit(double3_add(sides[0].normal, sides[1].normal));
    const double reach = fmin(sides[0].reach, sides[1].reach);
    const double texel = fmin(fmin((double)texels[0], (double)texels[1]), 2.0 * reach);
    const double rounding = fmax(sides[0].rounding, sides[1].rounding);
    if (!(double3_dot(mean, sides[0].normal) >= LEAST_COSINE) || !(reach > 4.0 * rounding)) {
        return sight;
    }
    double drop = 0.0; // of the ends below the edge
    for (int i = 0; i < 2; i++) {
        drop = fmax(drop, -sides[i].reach * double3_dot(sides[i].inward, mean));
    }
    for (int ray = 0; ray < ALPI_SIGHT_RAYS; ray++) {
        const double lift = drop + fmax(HEIGHTS[ray] * texel, 2.0 * rounding);
        vec3 ends[2];
        for (int i = 0; i < 2; i++) {
            const double3 low =
                double3_add(sides[i].place, double3_scale(sides[i].inward, sides[i].reach));
            ends[i] = double3_to_vec3(double3_add(low, double3_scale(mean, lift)));
        }
        sight.from[ray] = ends[0];
        sight.to[ray] = ends[1];
    }
    sight.aimed = true;
    return sight;
}

typedef struct trace_job {
    const alpi_tracer *tracer;
    alpi_sight *sights; // [count]
    uint32_t count;
} trace_job;

/// Aims the rays of a sample, one lane each; those of no length stay of no length.
static void set_lanes(const alpi_sight *sight, int lane, alpi_rays *rays)
{
    for (int ray = 0; ray < ALPI_SIGHT_RAYS && sight->aimed; ray++) {
        const vec3 way = vec3_sub(sight->to[ray], sight->from[ray]);
        const float length = vec3_length(way);
        if (length > 0.0f) {
            alpi_rays_set(rays, lane + ray, sight->from[ray], vec3_scale(way, 1.0f / length),
                          length);
        }
    }
}

static alp_result trace_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const trace_job *job = user;
    alpi_rays packets[PACKETS_PER_RANGE];
    const uint32_t first = begin * SAMPLES_PER_PACKET, last = end * SAMPLES_PER_PACKET;
    const uint32_t stop = last < job->count ? last : job->count;
    for (uint32_t p = 0; p < end - begin; p++) {
        alpi_rays_clear(&packets[p]);
    }
    for (uint32_t i = first; i < stop; i++) {
        const int lane = (int)(i % SAMPLES_PER_PACKET) * ALPI_SIGHT_RAYS;
        set_lanes(&job->sights[i], lane, &packets[(i - first) / SAMPLES_PER_PACKET]);
    }
    alpi_trace_occluded(job->tracer, packets, end - begin, 0xffu,
                        (alpi_trace_filter){.panes = true}, ALPI_RAYS_PAIRED);
    for (uint32_t i = first; i < stop; i++) {
        const alpi_rays *rays = &packets[(i - first) / SAMPLES_PER_PACKET];
        const uint32_t lane = i % SAMPLES_PER_PACKET * ALPI_SIGHT_RAYS;
        bool blocked = false;
        for (uint32_t ray = 0; ray < ALPI_SIGHT_RAYS; ray++) {
            blocked = blocked || rays->maximum[lane + ray] < 0.0f;
        }
        job->sights[i].blocked = blocked;
    }
    return ALP_OK;
}

alp_result alpi_sight_trace(const alpi_tracer *tracer, alp_context *context, alpi_sight *sights,
                            uint32_t count)
{
    trace_job job = {tracer, sights, count};
    const alpi_watch *watch = alpi_context_watch(context);
    const alpi_task_progress progress = {
        .callback = watch->callback, .user = watch->user, .stage = "seams"};
    const uint32_t packets = (count + SAMPLES_PER_PACKET - 1) / SAMPLES_PER_PACKET;
    return alpi_parallel_for(context, packets, PACKETS_PER_RANGE, trace_range, &job, &progress);
}
