// SPDX-License-Identifier: MIT
// Solids wound inwards, by their signed volumes. Winding numbers tell which part holds which: sums
// of the solid angles of a solid's triangles, seen from a point, over 4π.
//
// Based on: A. Van Oosterom, J. Strackee. The Solid Angle of a Plane Triangle. IEEE Transactions on
//           Biomedical Engineering 30(2), 1983.
#include "scene/sides.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "scene/adjacency.h"
#include "scene/double3.h"

#include <math.h>
#include <string.h>

enum { SAMPLES = 8, TICK_INTERVAL = 1 << 14 };
// Triangles in winding numbers, of about 50 ns; so many pairs of boxes take as long as one of them.
static const double WORK_LIMIT = 0x1p25, PAIRS = 32.0;
static const double LEAST_VOLUME = 1e-5; // over area^1.5; a closed sheet of no thickness has 0
static const double INSIDE = 0.75;       // winding number, from which on a point is inside
static const vec3 UP = {0.0f, 1.0f, 0.0f};

/// Triangles that are connected.
typedef struct part {
    uint32_t first, count; // in finder.order
    bool closed, turnable; // turnable: opaque and double-sided all over
    bool shines;
    double volume, area; // m³, positive if wound outwards; m²
    vec3 low, high;
} part;

typedef struct finder {
    const alp_scene *scene;
    uint32_t (*neighbours)[3];
    uint32_t *order; // [usable triangles] part after part
    bool *visited;   // [triangles]
    part *parts;
    size_t count, capacity;
    double work;
} finder;

// --- parts ---------------------------------------------------------------------------------------

static bool is_turnable(const alp_scene *scene, uint32_t surface)
{
    const uint32_t material = scene->surfaces[surface].material;
    return material != ALPI_NONE && scene->materials[material].double_sided &&
           scene->materials[material].alpha_mode == ALPI_ALPHA_OPAQUE &&
           !alpi_surface_is_pane(scene, surface);
}

static bool is_any_turnable(const alp_scene *scene)
{
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        if (scene->surfaces[s].triangle_count > 0 && is_turnable(scene, s)) {
            return true;
        }
    }
    return false;
}

static bool is_shining(const alp_scene *scene, uint32_t surface)
{
    const uint32_t material = scene->surfaces[surface].material;
    const float *e = material != ALPI_NONE ? scene->materials[material].emission : NULL;
    return e != NULL && (e[0] > 0.0f || e[1] > 0.0f || e[2] > 0.0f);
}

/// Adds a triangle's share of a part. Volumes are measured from a corner of the part.
static void add_triangle(const finder *f, part *p, uint32_t triangle)
{
    const alp_scene *scene = f->scene;
    const uint32_t surface = scene->triangle_surface[triangle];
    const vec3 origin = vec3_load(scene->positions[scene->triangles[f->order[p->first]][0]]);
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    p->volume +=
        double3_dot(double3_between(origin, c[0]),
                    double3_cross(double3_between(origin, c[1]), double3_between(origin, c[2]))) /
        6.0;
    p->area += vec3_triangle_area(c[0], c[1], c[2]);
    for (int k = 0; k < 3; k++) {
        p->low = vec3_min(p->low, c[k]);
        p->high = vec3_max(p->high, c[k]);
        p->closed = p->closed && f->neighbours[triangle][k] != ALPI_NONE;
    }
    p->turnable = p->turnable && is_turnable(scene, surface);
    p->shines = p->shines || is_shining(scene, surface);
}

/// Visits all triangles that are connected with one, breadth first.
static void fill_part(finder *f, part *p, uint32_t triangle)
{
    uint32_t end = p->first;
    f->visited[triangle] = true;
    f->order[end++] = triangle;
    for (uint32_t at = p->first; at < end; at++) {
        const uint32_t t = f->order[at];
        for (int k = 0; k < 3; k++) {
            const uint32_t next = f->neighbours[t][k];
            if (next != ALPI_NONE && !f->visited[next]) {
                f->visited[next] = true;
                f->order[end++] = next;
            }
        }
        add_triangle(f, p, t);
    }
    p->count = end - p->first;
}

static alp_result find_parts(finder *f)
{
    const alp_scene *scene = f->scene;
    uint32_t placed = 0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        if (t % TICK_INTERVAL == 0) {
            ALP_TRY(alpi_tick(scene->context, "sides", t, scene->triangle_count));
        }
        if (!scene->triangle_usable[t] || f->visited[t]) {
            continue;
        }
        ALP_TRY(alpi_grow(scene->context, (void **)&f->parts, &f->capacity, f->count + 1,
                          sizeof *f->parts));
        part *p = &f->parts[f->count++];
        *p = (part){.first = placed,
                    .closed = true,
                    .turnable = true,
                    .low = {INFINITY, INFINITY, INFINITY},
                    .high = {-INFINITY, -INFINITY, -INFINITY}};
        fill_part(f, p, t);
        placed += p->count;
    }
    return ALP_OK;
}

static double limit_volume(const part *p)
{
    return LEAST_VOLUME * p->area * sqrt(p->area);
}

static bool is_inwards(const part *p)
{
    return p->closed && p->turnable && p->volume < -limit_volume(p);
}

// --- what holds what -----------------------------------------------------------------------------

/// Solid angle of a triangle over 4π: positive where its front faces away from the point.
static double wind_triangle(const alp_scene *scene, uint32_t triangle, double3 point)
{
    double3 r[3];
    double length[3];
    for (int k = 0; k < 3; k++) {
        const float *p = scene->positions[scene->triangles[triangle][k]];
        r[k] = double3_sub(double3_from(vec3_load(p)), point);
        length[k] = double3_length(r[k]);
    }
    const double up = double3_dot(r[0], double3_cross(r[1], r[2]));
    const double along = length[0] * length[1] * length[2] + double3_dot(r[0], r[1]) * length[2] +
                         double3_dot(r[1], r[2]) * length[0] + double3_dot(r[2], r[0]) * length[1];
    return atan2(up, along) / (2.0 * ALPI_PI);
}

static double wind(const alp_scene *scene, const uint32_t *triangles, uint32_t count, double3 point)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        sum += wind_triangle(scene, triangles[i], point);
    }
    return sum;
}

static double wind_part(finder *f, const part *p, double3 point)
{
    f->work += p->count;
    return wind(f->scene, f->order + p->first, p->count, point);
}

static bool holds_box(const part *outer, const part *inner)
{
    return inner->low.x >= outer->low.x && inner->low.y >= outer->low.y &&
           inner->low.z >= outer->low.z && inner->high.x <= outer->high.x &&
           inner->high.y <= outer->high.y && inner->high.z <= outer->high.z;
}

/// Points spread over a part. @return how many
static uint32_t place_samples(const finder *f, const part *p, double3 samples[SAMPLES])
{
    const alp_scene *scene = f->scene;
    const uint32_t count = p->count < SAMPLES ? p->count : SAMPLES;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t triangle = f->order[p->first + (uint64_t)p->count * i / count];
        samples[i] = (double3){0.0, 0.0, 0.0};
        for (int k = 0; k < 3; k++) {
            const vec3 corner = vec3_load(scene->positions[scene->triangles[triangle][k]]);
            samples[i] = double3_add(samples[i], double3_scale(double3_from(corner), 1.0 / 3.0));
        }
    }
    return count;
}

/// Whether a part lies inside one that is wound inwards. Some of its points may touch that.
static bool holds_part(finder *f, const part *outer, const part *inner)
{
    double3 samples[SAMPLES];
    const uint32_t count = place_samples(f, inner, samples);
    uint32_t inside = 0;
    for (uint32_t i = 0; i < count; i++) {
        inside += wind_part(f, outer, samples[i]) < -INSIDE;
    }
    return 2 * inside > count;
}

static bool is_in_box(vec3 at, vec3 low, vec3 high)
{
    return at.x > low.x && at.y > low.y && at.z > low.z && at.x < high.x && at.y < high.y &&
           at.z < high.z;
}

static bool holds_point(finder *f, const part *p, vec3 at)
{
    return is_in_box(at, p->low, p->high) && wind_part(f, p, double3_from(at)) < -INSIDE;
}

static bool holds_lamp_or_camera(finder *f, const part *p)
{
    const alp_scene *scene = f->scene;
    for (uint32_t i = 0; i < scene->light_count; i++) {
        if (alp_light_traits_of(scene->lights[i].kind).has_position &&
            holds_point(f, p, scene->lights[i].position)) {
            return true;
        }
    }
    for (uint32_t i = 0; i < scene->camera_count; i++) {
        if (holds_point(f, p, vec3_load(scene->cameras[i].position))) {
            return true;
        }
    }
    return false;
}

/// Whether most points of a part lie in the material of other solids.
static bool is_in_material(finder *f, const part *p)
{
    double3 samples[SAMPLES];
    double around[SAMPLES] = {0.0};
    const uint32_t count = place_samples(f, p, samples);
    uint32_t inside = 0;
    for (size_t i = 0; i < f->count && f->work < WORK_LIMIT; i++) {
        const part *other = &f->parts[i];
        const bool holds = other != p && other->closed && holds_box(other, p);
        for (uint32_t k = 0; k < count && holds; k++) {
            around[k] += wind_part(f, other, samples[k]);
        }
    }
    for (uint32_t k = 0; k < count; k++) {
        inside += around[k] > INSIDE;
    }
    f->work += (double)f->count / PAIRS;
    return 2 * inside > count;
}

static bool is_room(finder *f, const part *p)
{
    for (size_t i = 0; i < f->count && f->work < WORK_LIMIT; i++) {
        const part *other = &f->parts[i];
        if (other != p && holds_box(p, other) && holds_part(f, p, other)) {
            return true;
        }
    }
    f->work += (double)f->count / PAIRS;
    const bool alone = f->count == 1 && f->scene->light_count == 0;
    return (alone && p->shines) || holds_lamp_or_camera(f, p);
}

// -------------------------------------------------------------------------------------------------

/// Keeps the parts that are turned as solids of the scene.
static alp_result keep(const finder *f, const bool *turned, alp_scene *scene)
{
    alpi_sides *sides = scene->sides = ALPI_NEW(scene->context, alpi_sides, 1);
    if (sides == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    uint32_t triangles = 0;
    for (size_t i = 0; i < f->count; i++) {
        triangles += turned[i] ? f->parts[i].count : 0;
        sides->count += turned[i];
    }
    ALPI_TRY_NEW(scene->context, sides->first, (size_t)sides->count + 1);
    ALPI_TRY_NEW(scene->context, sides->triangles, triangles);
    ALPI_TRY_NEW(scene->context, sides->turned, scene->triangle_count);
    uint32_t solid = 0;
    for (size_t i = 0; i < f->count; i++) {
        const part *p = &f->parts[i];
        if (turned[i]) {
            const uint32_t first = sides->first[solid++];
            memcpy(sides->triangles + first, f->order + p->first, p->count * sizeof *f->order);
            sides->first[solid] = first + p->count;
        }
    }
    alpi_sides_choose(scene, NULL, 0);
    return ALP_OK;
}

static alp_result find_solids(finder *f, alp_scene *scene)
{
    bool *turned = ALPI_NEW(scene->context, bool, f->count), any = false;
    alp_result result = turned != NULL ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
    for (size_t i = 0; i < f->count && result == ALP_OK; i++) {
        if (is_inwards(&f->parts[i]) && f->work < WORK_LIMIT) {
            const bool room = is_room(f, &f->parts[i]) || is_in_material(f, &f->parts[i]);
            turned[i] = !room && f->work < WORK_LIMIT;
            any = any || turned[i];
            result = alpi_tick(scene->context, "sides", i, f->count);
        }
    }
    if (result == ALP_OK && any) {
        result = keep(f, turned, scene);
    }
    alpi_release(scene->context, turned);
    return result;
}

alp_result alpi_sides_create(alp_scene *scene)
{
    if (!is_any_turnable(scene) || scene->triangle_count > UINT32_MAX / 3 - 1) {
        return ALP_OK;
    }
    finder f = {.scene = scene};
    ALP_TRY(alpi_adjacency_create(scene, &f.neighbours));
    f.order = ALPI_NEW(scene->context, uint32_t, scene->triangle_count);
    f.visited = ALPI_NEW(scene->context, bool, scene->triangle_count);
    alp_result result = f.order != NULL && f.visited != NULL ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
    result = result == ALP_OK ? find_parts(&f) : result;
    result = result == ALP_OK ? find_solids(&f, scene) : result;
    alpi_release(scene->context, f.neighbours);
    alpi_release(scene->context, f.order);
    alpi_release(scene->context, f.visited);
    alpi_release(scene->context, f.parts);
    return result;
}

void alpi_sides_destroy(alp_context *context, alpi_sides *sides)
{
    if (sides != NULL) {
        alpi_release(context, sides->first);
        alpi_release(context, sides->triangles);
        alpi_release(context, sides->turned);
        alpi_release(context, sides);
    }
}

/// Whether a solid holds one of some lamps.
static bool holds_lamp(const alp_scene *scene, uint32_t solid, const vec3 *lamps, uint32_t count)
{
    const alpi_sides *sides = scene->sides;
    const uint32_t *triangles = sides->triangles + sides->first[solid];
    const uint32_t triangle_count = sides->first[solid + 1] - sides->first[solid];
    vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY}, c[3];
    for (uint32_t i = 0; i < triangle_count; i++) {
        alpi_triangle_corners(scene, triangles[i], c);
        for (int k = 0; k < 3; k++) {
            low = vec3_min(low, c[k]);
            high = vec3_max(high, c[k]);
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        if (is_in_box(lamps[i], low, high) &&
            wind(scene, triangles, triangle_count, double3_from(lamps[i])) < -INSIDE) {
            return true;
        }
    }
    return false;
}

void alpi_sides_choose(const alp_scene *scene, const vec3 *lamps, uint32_t count)
{
    alpi_sides *sides = scene->sides;
    for (uint32_t i = 0; sides != NULL && i < sides->count; i++) {
        const bool room = count > 0 && holds_lamp(scene, i, lamps, count);
        for (uint32_t k = sides->first[i]; k < sides->first[i + 1]; k++) {
            sides->turned[sides->triangles[k]] = !room;
        }
    }
}

// --- normals -------------------------------------------------------------------------------------

static vec3 front_normal(const alp_scene *scene, uint32_t triangle)
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    return vec3_triangle_normal(c[0], c[1], c[2], UP);
}

vec3 alpi_sides_normal(const alp_scene *scene, uint32_t triangle)
{
    const float sign = alpi_sides_is_turned(scene, triangle) ? -1.0f : 1.0f;
    return vec3_scale(front_normal(scene, triangle), sign);
}

void alpi_sides_corner_normals(const alp_scene *scene, uint32_t triangle, vec3 normals[3])
{
    vec3 sum = {0.0f, 0.0f, 0.0f};
    for (int k = 0; k < 3; k++) {
        normals[k] = vec3_load(scene->normals[scene->triangles[triangle][k]]);
        sum = vec3_add(sum, normals[k]);
    }
    if (alpi_sides_is_turned(scene, triangle) &&
        vec3_dot(sum, front_normal(scene, triangle)) > 0.0f) {
        for (int k = 0; k < 3; k++) {
            normals[k] = vec3_scale(normals[k], -1.0f);
        }
    }
}
