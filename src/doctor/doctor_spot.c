// SPDX-License-Identifier: MIT
// Spots of findings in pictures: where to look from, and a ring around them.
#include "doctor/doctor_spot.h"

#include "scene/receivers.h"

#include <math.h>

/// Eyes that are tried, around both sides of the spot, one for each lane of two packets.
enum { EYES = 2 * ALPI_PACKET, EYES_PER_SIDE = ALPI_PACKET };
/// From the surface's normal: a slanting look shows edges, straight on none is seen.
static const double TILT = 0.7; // radians
/// How far the eye goes back: triangles' lengths, within shares of the scene's diagonal.
static const double LENGTHS = 2.5, NEAREST = 0.01, FARTHEST = 0.5;
/// Of the free way, and of what was asked: nearer shows nothing but the spot itself.
static const float FREE_WAY = 0.9f, LEAST_WAY = 0.15f;
static const float FIELD_OF_VIEW = 0.8f;            // radians
static const double RADIUS = 42.0, THICKNESS = 4.0; // of rings, pixels
static const uint8_t MAGENTA[3] = {255, 40, 220}, DARK[3] = {40, 0, 34};

static float longest_edge(const vec3 c[3])
{
    float longest = 0.0f;
    for (int k = 0; k < 3; k++) {
        longest = fmaxf(longest, vec3_length(vec3_sub(c[(k + 1) % 3], c[k])));
    }
    return longest;
}

/// Traces from the spot to all eyes; ways[i]: how far the way to eye i is free.
static void find_ways(const alpi_tracer *tracer, vec3 at, const vec3 c[3], vec3 directions[EYES],
                      float ways[EYES])
{
    vec3 t, b;
    const vec3 face = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
    vec3_frame(face, &t, &b);
    for (int first = 0; first < EYES; first += ALPI_PACKET) {
        const float sign = first < EYES_PER_SIDE ? 1.0f : -1.0f;
        alpi_rays rays;
        alpi_hits hits;
        alpi_rays_clear(&rays);
        for (int k = 0; k < ALPI_PACKET; k++) {
            const double turn = 2.0 * ALPI_PI * (k + 0.3) / ALPI_PACKET; // along no usual axis
            const vec3 side =
                vec3_add(vec3_scale(t, (float)cos(turn)), vec3_scale(b, (float)sin(turn)));
            directions[first + k] = vec3_add(vec3_scale(face, sign * (float)cos(TILT)),
                                             vec3_scale(side, (float)sin(TILT)));
            // Ten offsets: a spot on an edge lies in the plane of its other triangles too.
            alpi_rays_set(&rays, k,
                          vec3_mad(at, 10.0f * alpi_receiver_offset(at, c), directions[first + k]),
                          directions[first + k], (float)INFINITY);
        }
        alpi_trace_nearest(tracer, &rays, (1u << ALPI_PACKET) - 1u,
                           (alpi_trace_filter){.one_sided = false}, &hits);
        for (int k = 0; k < ALPI_PACKET; k++) {
            ways[first + k] = hits.distance[k];
        }
    }
}

void alpi_doctor_aim(const alp_scene *scene, const alpi_tracer *tracer,
                     const alp_finding_spot *spot, alp_camera *camera)
{
    const vec3 at = vec3_load(spot->at);
    vec3 c[3], directions[EYES];
    float ways[EYES];
    alpi_triangle_corners(scene, scene->surfaces[spot->surface].first_triangle + spot->triangle, c);
    const double diagonal = (double)vec3_length(vec3_sub(scene->bounds_max, scene->bounds_min));
    const float wanted = (float)fmin(fmax(LENGTHS * (double)longest_edge(c), NEAREST * diagonal),
                                     FARTHEST * diagonal);
    find_ways(tracer, at, c, directions, ways);
    int best = 0;
    float most = -1.0f;
    for (int i = 0; i < EYES; i++) { // fronts first, from above rather than below
        const float way = fminf(FREE_WAY * ways[i], wanted);
        const float worth =
            way * (i < EYES_PER_SIDE ? 1.0f : 0.5f) * (1.0f + 0.2f * directions[i].y);
        if (worth > most) {
            most = worth;
            best = i;
        }
    }
    const float way = fminf(FREE_WAY * ways[best], wanted);
    if (!(way > LEAST_WAY * wanted)) {
        return;
    }
    const bool is_upright = fabsf(directions[best].y) < 0.98f;
    vec3_store(camera->position, vec3_mad(at, way, directions[best]));
    vec3_store(camera->target, at);
    vec3_store(camera->up, is_upright ? (vec3){0.0f, 1.0f, 0.0f} : (vec3){0.0f, 0.0f, 1.0f});
    camera->vertical_fov = FIELD_OF_VIEW;
}

// --- rings ---------------------------------------------------------------------------------------

void alpi_doctor_ring(uint8_t *bytes, uint32_t width, uint32_t height, double x, double y)
{
    const double reach = RADIUS + THICKNESS;
    if (!(x >= -reach) || !(x <= width + reach) || !(y >= -reach) || !(y <= height + reach)) {
        return;
    }
    const int64_t left = (int64_t)fmax(x - reach, 0.0), top = (int64_t)fmax(y - reach, 0.0);
    for (int64_t row = top; row < height && (double)row <= y + reach; row++) {
        for (int64_t column = left; column < width && (double)column <= x + reach; column++) {
            const double from =
                fabs(hypot((double)column + 0.5 - x, (double)row + 0.5 - y) - RADIUS);
            uint8_t *pixel = &bytes[3 * (row * (int64_t)width + column)];
            for (int k = 0; k < 3 && from <= THICKNESS; k++) { // a dark rim, for light pictures
                pixel[k] = from <= 0.5 * THICKNESS ? MAGENTA[k] : DARK[k];
            }
        }
    }
}

void alpi_doctor_ring_in_view(const alpi_view *view, vec3 at, uint8_t *bytes)
{
    const vec3 to = vec3_sub(at, view->origin);
    const float depth = vec3_dot(to, view->forward);
    if (!(depth > 0.0f)) {
        return;
    }
    const double across =
        (double)(vec3_dot(to, view->right) / (depth * vec3_dot(view->right, view->right)));
    const double above = (double)(vec3_dot(to, view->up) / (depth * vec3_dot(view->up, view->up)));
    alpi_doctor_ring(bytes, view->width, view->height, 0.5 * (1.0 + across) * view->width,
                     0.5 * (1.0 - above) * view->height);
}
