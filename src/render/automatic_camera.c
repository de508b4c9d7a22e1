// SPDX-License-Identifier: MIT
// The camera of a scene that has none: of some eyes the one that sees most, as near as its picture
// allows.
#include "render/automatic_camera.h"

#include "base/memory.h"
#include "scene/area_points.h"
#include "scene/viewpoints.h"
#include "trace/trace.h"

#include <math.h>

enum { POINTS = 512 };
_Static_assert(POINTS % ALPI_PACKET == 0, "points come in whole packets");

/// Points spread over the scene's area, that an eye may see or not.
typedef struct landmarks {
    const alp_scene *scene;
    const alpi_tracer *tracer;
    alpi_area_point points[POINTS];
    vec3 positions[POINTS], normals[POINTS]; // of the triangle
    bool two_sided[POINTS];
} landmarks;

static bool find_landmarks(landmarks *marks)
{
    const alp_scene *scene = marks->scene;
    if (!alpi_area_points(scene, POINTS, marks->points)) {
        return false;
    }
    for (int i = 0; i < POINTS; i++) {
        const alpi_area_point *p = &marks->points[i];
        vec3 c[3];
        alpi_triangle_corners(scene, p->triangle, c);
        marks->positions[i] = vec3_add(vec3_scale(c[0], 1.0f - p->b1 - p->b2),
                                       vec3_add(vec3_scale(c[1], p->b1), vec3_scale(c[2], p->b2)));
        marks->normals[i] = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
        marks->two_sided[i] = alpi_surface_is_double_sided(scene, p->triangle);
    }
    return true;
}

/// Whether a point would lie in the picture, were nothing before it, and show its front. The
/// picture is taken as half as wide again as high.
static bool could_be_seen(const landmarks *marks, int i, const alp_camera *camera)
{
    const vec3 origin = vec3_load(camera->position), none = {0.0f, 0.0f, 0.0f};
    const vec3 forward = vec3_normalize_or(vec3_sub(vec3_load(camera->target), origin), none);
    const vec3 right = vec3_normalize_or(vec3_cross(forward, vec3_load(camera->up)), none);
    const vec3 up = vec3_cross(right, forward);
    const vec3 to = vec3_sub(marks->positions[i], origin);
    const float half = vec3_dot(to, forward) * tanf(0.5f * camera->vertical_fov);
    return half > 0.0f && fabsf(vec3_dot(to, right)) <= 1.5f * half &&
           fabsf(vec3_dot(to, up)) <= half &&
           (marks->two_sided[i] || vec3_dot(to, marks->normals[i]) < 0.0f);
}

/// Which points an eye sees.
static void look(const landmarks *marks, const alp_camera *camera, bool seen[POINTS])
{
    const vec3 origin = vec3_load(camera->position);
    alpi_rays rays;
    alpi_hits hits;
    alpi_rays_clear(&rays);
    for (int first = 0; first < POINTS; first += ALPI_PACKET) {
        uint32_t active = 0;
        for (int lane = 0; lane < ALPI_PACKET; lane++) {
            const vec3 to = vec3_sub(marks->positions[first + lane], origin);
            const vec3 direction = vec3_normalize_or(to, (vec3){0.0f, 0.0f, 1.0f});
            alpi_rays_set(&rays, lane, origin, direction, INFINITY);
            active |= (could_be_seen(marks, first + lane, camera) ? 1u : 0u) << lane;
            hits.triangle[lane] = ALPI_NONE;
        }
        alpi_trace_nearest_coherent(marks->tracer, &rays, active, (alpi_trace_filter){0}, &hits);
        for (int lane = 0; lane < ALPI_PACKET; lane++) {
            seen[first + lane] = (active >> lane & 1u) != 0 &&
                                 hits.triangle[lane] == marks->points[first + lane].triangle;
        }
    }
}

/// What a picture is worth: the share of the area that it shows, and a quarter of the share of the
/// surfaces: small things are what large walls are there for. A surface without a point is too
/// small to be missed. Points go by their triangles, so a surface's stand together.
static double score(const landmarks *marks, const alp_camera *camera)
{
    bool seen[POINTS];
    uint32_t points = 0, surfaces = 0, shown = 0, last = ALPI_NONE;
    bool counted = false; // the last surface, as shown
    look(marks, camera, seen);
    for (int i = 0; i < POINTS; i++) {
        const uint32_t surface = marks->scene->triangle_surface[marks->points[i].triangle];
        if (surface != last) {
            surfaces++;
            counted = false;
            last = surface;
        }
        points += seen[i];
        shown += seen[i] && !counted;
        counted = counted || seen[i];
    }
    return (double)points / POINTS + 0.25 * (double)shown / (double)surfaces;
}

/// The usual view, unless another is worth half as much again: nobody minds a good view that shows
/// a little less than another. Of the others the first that is about as good as the best.
static alp_camera choose(const landmarks *marks)
{
    static const double MUCH = 1.5, ALIKE = 1.1;
    alp_camera cameras[ALPI_VIEWPOINT_LIMIT];
    double scores[ALPI_VIEWPOINT_LIMIT] = {0.0}, most = 0.0;
    const uint32_t count = alpi_viewpoints(marks->scene, cameras);
    for (uint32_t i = 0; i < count; i++) {
        scores[i] = score(marks, &cameras[i]);
        most = fmax(most, scores[i]);
    }
    uint32_t best = 0;
    while (most > MUCH * scores[0] && scores[best] * ALIKE < most) {
        best++;
    }
    return cameras[best];
}

alp_result alpi_camera_choose(const alp_scene *scene, uint32_t index, alp_progress_fn *progress,
                              void *progress_user, alp_camera *camera)
{
    *camera = alp_scene_get_camera(scene, index);
    if (index < scene->camera_count) {
        return ALP_OK;
    }
    alpi_tracer *tracer = NULL;
    ALP_TRY(alpi_tracer_for_scene(scene, progress, progress_user, &tracer, NULL));
    landmarks *marks = NULL;
    ALPI_TRY_NEW(scene->context, marks, 1);
    marks->scene = scene;
    marks->tracer = tracer;
    if (find_landmarks(marks)) {
        *camera = choose(marks);
    }
    alpi_release(scene->context, marks);
    return ALP_OK;
}

// --- the frame -----------------------------------------------------------------------------------

/// How far the scene reaches towards two opposite sides of a picture, as planes through the eye:
/// the largest x + t z and −x + t z, for z towards the eye and the tangent t of half the view.
typedef struct reach {
    double tangent, least, most;
} reach;

static void extend(reach *r, double x, double z)
{
    r->most = fmax(r->most, x + r->tangent * z);
    r->least = fmax(r->least, r->tangent * z - x);
}

static bool is_in_box(const alp_scene *scene, vec3 p)
{
    const vec3 low = scene->bounds_min, high = scene->bounds_max;
    return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y &&
           p.z <= high.z;
}

void alpi_camera_frame(const alp_scene *scene, float aspect, alp_camera *camera)
{
    static const double MARGIN = 0.95; // of the picture is filled
    const vec3 eye = vec3_load(camera->position), none = {0.0f, 0.0f, 0.0f};
    const vec3 back = vec3_normalize_or(vec3_sub(eye, vec3_load(camera->target)), none);
    const vec3 right = vec3_normalize_or(vec3_cross(vec3_load(camera->up), back), none);
    const vec3 up = vec3_cross(back, right);
    const double tangent = MARGIN * tan(0.5 * (double)camera->vertical_fov);
    reach across = {tangent * (double)aspect, -HUGE_VAL, -HUGE_VAL};
    reach upwards = {tangent, -HUGE_VAL, -HUGE_VAL};
    if (scene->usable_count == 0 || is_in_box(scene, eye)) {
        return;
    }
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        vec3 c[3];
        alpi_triangle_corners(scene, t, c);
        for (int k = 0; k < 3 && scene->triangle_usable[t]; k++) {
            const double z = (double)vec3_dot(c[k], back);
            extend(&across, (double)vec3_dot(c[k], right), z);
            extend(&upwards, (double)vec3_dot(c[k], up), z);
        }
    }
    const double wide = 0.5 * (across.most + across.least) / across.tangent;
    const double high = 0.5 * (upwards.most + upwards.least) / upwards.tangent;
    const double distance = fmax(wide, high);
    const float x = (float)(0.5 * (across.most - across.least));
    const float y = (float)(0.5 * (upwards.most - upwards.least));
    const vec3 plane = vec3_mad(vec3_scale(right, x), y, up);
    const vec3 middle =
        vec3_mad(scene->bounds_min, 0.5f, vec3_sub(scene->bounds_max, scene->bounds_min));
    const float depth = vec3_dot(middle, back);
    vec3_store(camera->position, vec3_mad(plane, (float)distance, back));
    vec3_store(camera->target, vec3_mad(plane, depth, back));
}
