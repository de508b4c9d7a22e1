// SPDX-License-Identifier: MIT
// Few triangles, laid out for the loops that meet them.
#include "trace/few.h"

#include "base/context.h"
#include "base/memory.h"

#include <math.h>

static const alpi_few_loops *choose_loops(alp_context *context)
{
#ifdef ALPI_HAS_V3_KERNEL
    if (alpi_context_has_v3(context)) {
        return &alpi_few_loops_v3;
    }
#endif
    (void)context;
    return &alpi_few_loops_baseline;
}

static void set_triangle(const alp_scene *scene, uint32_t triangle, alpi_few *few, uint32_t t)
{
    const uint32_t *v = scene->triangles[triangle];
    float(*corner)[3] = few->corner[t];
    for (int k = 0; k < 3; k++) {
        few->low[k][t] = INFINITY;
        few->high[k][t] = -INFINITY;
        for (int c = 0; c < 3; c++) {
            const float at = scene->positions[v[c]][k];
            corner[c][k] = at;
            few->low[k][t] = fminf(few->low[k][t], at);
            few->high[k][t] = fmaxf(few->high[k][t], at);
        }
    }
    const vec3 a = vec3_load(corner[0]), b = vec3_load(corner[1]), c = vec3_load(corner[2]);
    vec3_store(few->normal[t], vec3_cross(vec3_sub(b, a), vec3_sub(c, a)));
    few->triangle[t] = triangle;
    few->single_sided[t] = !alpi_surface_is_double_sided(scene, triangle);
}

/// Whether each triangle is wide enough for rays from anywhere in the scene to tell its edges
/// apart: from 10^7 times its width they are one in floats, and every ray would pass between them.
static bool are_plain(const alpi_few *few, float far)
{
    // Of `far`; and metres, within which cubes of lengths are floats.
    static const float NARROWEST = 1e-4f, LEAST = 1e-6f, MOST = 1e6f;
    bool plain = far > LEAST && far < MOST;
    for (uint32_t t = 0; t < few->count; t++) {
        float longest = 0.0f;
        for (int c = 0; c < 3; c++) {
            const vec3 edge =
                vec3_sub(vec3_load(few->corner[t][(c + 1) % 3]), vec3_load(few->corner[t][c]));
            longest = fmaxf(longest, vec3_length(edge));
        }
        const float area = vec3_length(vec3_load(few->normal[t])); // twice
        plain = plain && area >= NARROWEST * far * longest;
    }
    return plain;
}

/// What all triangles have in common; boxes of none after the last.
/// @return whether they are for these loops
static bool finish(alpi_few *few)
{
    float far = 0.0f; // of any coordinate
    for (int k = 0; k < 3; k++) {
        float low = INFINITY, high = -INFINITY;
        for (uint32_t t = 0; t < few->count; t++) {
            low = fminf(low, few->low[k][t]);
            high = fmaxf(high, few->high[k][t]);
        }
        for (uint32_t t = few->count; t < ALPI_FEW_LIMIT; t++) {
            few->low[k][t] = INFINITY;
            few->high[k][t] = -INFINITY;
        }
        far = fmaxf(far, fmaxf(-low, high));
        few->extent = fmaxf(few->extent, high - low);
    }
    few->slack = 1e-4f * far;
    return are_plain(few, far);
}

alp_result alpi_few_create(const alp_scene *scene, const uint32_t *triangles, uint32_t count,
                           alpi_few **few)
{
    *few = NULL;
    if (count == 0 || count > ALPI_FEW_LIMIT) {
        return ALP_OK;
    }
    alpi_few *made = ALPI_NEW(scene->context, alpi_few, 1);
    if (made == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    made->loops = choose_loops(scene->context);
    made->count = count;
    for (uint32_t t = 0; t < count; t++) {
        set_triangle(scene, triangles[t], made, t);
    }
    if (!finish(made)) {
        alpi_release(scene->context, made);
        made = NULL;
    }
    *few = made;
    return ALP_OK;
}

static uint32_t count_near(const alpi_few *few, vec3 p, float reach)
{
    const float at[3] = {p.x, p.y, p.z};
    uint32_t count = 0;
    for (uint32_t t = 0; t < few->count; t++) {
        bool near = true;
        for (int k = 0; k < 3; k++) {
            near = near && few->low[k][t] <= at[k] + reach && few->high[k][t] >= at[k] - reach;
        }
        count += near;
    }
    return count;
}

float alpi_few_near(const alpi_few *few, float reach)
{
    enum { STEPS = 4 }; // middles of 10 of the 16 equal parts of a triangle
    double sum = 0.0, area = 0.0;
    for (uint32_t t = 0; t < few->count; t++) {
        const vec3 a = vec3_load(few->corner[t][0]);
        const vec3 e1 = vec3_sub(vec3_load(few->corner[t][1]), a);
        const vec3 e2 = vec3_sub(vec3_load(few->corner[t][2]), a);
        const double weight = (double)vec3_length(vec3_load(few->normal[t]));
        for (int i = 0; i < STEPS; i++) {
            for (int j = 0; j + i < STEPS; j++) {
                const float u = ((float)i + 1.0f / 3.0f) / STEPS;
                const float v = ((float)j + 1.0f / 3.0f) / STEPS;
                sum += weight * count_near(few, vec3_mad(vec3_mad(a, u, e1), v, e2), reach);
                area += weight;
            }
        }
    }
    return area > 0.0 ? (float)(sum / area) : 0.0f;
}
