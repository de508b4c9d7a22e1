// SPDX-License-Identifier: MIT
#include "test_lit.h"

#include "base/memory.h"
#include "base/random.h"

#include <math.h>

test_lit test_lit_open(alp_scene *scene, const alp_lighting_options *options)
{
    test_lit lit = {.scene = scene};
    ASSERT_OK(scene->context, alpi_tracer_for_scene(scene, NULL, NULL, &lit.tracer, NULL));
    ASSERT_OK(scene->context, alpi_lighting_create(scene, options, &lit.lighting));
    return lit;
}

void test_lit_close(test_lit *lit)
{
    alpi_lighting_destroy(lit->scene->context, lit->lighting);
    alp_scene_destroy(lit->scene);
}

void test_lit_set_lamps(alp_scene *scene, const alpi_light *lights, uint32_t count)
{
    assert_int_equal(scene->light_count, 0);
    scene->lights = ALPI_NEW(scene->context, alpi_light, count);
    assert_non_null(scene->lights);
    memcpy(scene->lights, lights, count * sizeof *lights);
    scene->light_count = count;
}

alpi_reference test_lit_reference(const test_lit *lit, uint32_t bounces, uint32_t samples)
{
    return (alpi_reference){.context = lit->scene->context,
                            .scene = lit->scene,
                            .tracer = lit->tracer,
                            .lighting = lit->lighting,
                            .bounces = bounces,
                            .samples = samples,
                            .next_event = true,
                            .seed = 1};
}

void test_lit_irradiance(const alpi_reference *reference, const vec3 *positions,
                         const vec3 *normals, float offset, uint32_t count,
                         alpi_reference_value *values)
{
    static float places[TEST_LIT_POINT_LIMIT][3], axes[TEST_LIT_POINT_LIMIT][3];
    static float offsets[TEST_LIT_POINT_LIMIT];
    assert_true(count <= TEST_LIT_POINT_LIMIT);
    for (uint32_t i = 0; i < count; i++) {
        vec3_store(places[i], positions[i]);
        vec3_store(axes[i], normals[i]);
        offsets[i] = offset;
    }
    const alpi_point_array array = {.count = count,
                                    .positions = places,
                                    .geometric_normals = axes,
                                    .shading_normals = axes,
                                    .offsets = offsets};
    const alpi_receivers receivers = alpi_point_array_receivers(&array);
    ASSERT_OK(reference->context,
              alpi_reference_irradiance(reference, &receivers, NULL, count, NULL, values));
}

alpi_reference_value test_lit_point(const alpi_reference *reference, vec3 position, vec3 normal)
{
    alpi_reference_value value;
    test_lit_irradiance(reference, &position, &normal, 1e-6f, 1, &value);
    return value;
}

// --- means ---------------------------------------------------------------------------------------

/// Triangles one after another, `ends` their area up to each.
typedef struct sheet {
    const alp_scene *scene;
    uint32_t first, count;
    double *ends;
} sheet;

/// The triangle at `area` along the sheet; *rest: how far into it, [0, 1).
static uint32_t sheet_find(const sheet *s, double area, double *rest)
{
    uint32_t low = 0, high = s->count - 1;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (area < s->ends[middle]) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    const double begin = low > 0 ? s->ends[low - 1] : 0.0, size = s->ends[low] - begin;
    *rest = size > 0.0 ? fmin(fmax((area - begin) / size, 0.0), 1.0) : 0.0;
    return s->first + low;
}

static void place_on_sheet(const void *user, uint32_t receiver, uint32_t count,
                           const float (*square)[2], alpi_receiver_point *points)
{
    (void)receiver;
    const sheet *s = user;
    for (uint32_t i = 0; i < count; i++) {
        double x, y = (double)square[i][1];
        const uint32_t triangle = sheet_find(s, (double)square[i][0] * s->ends[s->count - 1], &x);
        vec3 c[3];
        alpi_triangle_corners(s->scene, triangle, c);
        const double root = sqrt(x); // the square onto the triangle, area for area
        const vec3 position =
            vec3_mad(vec3_mad(c[0], (float)(root * (1.0 - y)), vec3_sub(c[1], c[0])),
                     (float)(root * y), vec3_sub(c[2], c[0]));
        const vec3 normal = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
        points[i] = (alpi_receiver_point){.position = position,
                                          .geometric_normal = normal,
                                          .shading_normal = normal,
                                          .offset = alpi_receiver_offset(position, c)};
    }
}

/// All triangles of a surface (ALPI_NONE: of the scene). `ends` must be released.
static sheet make_sheet(const alp_scene *scene, uint32_t surface)
{
    sheet s = {.scene = scene, .first = 0, .count = scene->triangle_count};
    double area = 0.0;
    if (surface != ALPI_NONE) {
        s.first = scene->surfaces[surface].first_triangle;
        s.count = scene->surfaces[surface].triangle_count;
    }
    s.ends = ALPI_NEW(scene->context, double, s.count);
    assert_non_null(s.ends);
    for (uint32_t i = 0; i < s.count; i++) {
        vec3 c[3];
        alpi_triangle_corners(scene, s.first + i, c);
        area += vec3_triangle_area(c[0], c[1], c[2]);
        s.ends[i] = area;
    }
    return s;
}

alpi_reference_value test_lit_mean(const alpi_reference *reference, uint32_t surface)
{
    sheet s = make_sheet(reference->scene, surface);
    const alpi_receivers receivers = {
        .count = 1, .extended = true, .place = place_on_sheet, .user = &s};
    alpi_reference_value value;
    ASSERT_OK(reference->context,
              alpi_reference_irradiance(reference, &receivers, NULL, 1, NULL, &value));
    alpi_release(reference->scene->context, s.ends);
    return value;
}

static bool is_inside(vec3 p, vec3 low, vec3 high)
{
    return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y && p.z >= low.z &&
           p.z <= high.z;
}

void test_lit_scatter(const alp_scene *scene, vec3 low, vec3 high, uint32_t count, vec3 *positions,
                      vec3 *normals)
{
    sheet s = make_sheet(scene, ALPI_NONE);
    uint32_t found = 0;
    for (uint32_t i = 0; i < 1000 * count && found < count; i++) {
        const vec2 u = alpi_sample_2d(17, i);
        alpi_receiver_point point;
        place_on_sheet(&s, 0, 1, (const float[1][2]){{u.x, u.y}}, &point);
        if (is_inside(point.position, low, high)) {
            positions[found] = point.position;
            normals[found++] = point.geometric_normal;
        }
    }
    assert_int_equal(found, count);
    alpi_release(scene->context, s.ends);
}
