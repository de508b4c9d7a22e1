// SPDX-License-Identifier: MIT
#include "maps/radiosity/outgoing.h"

#include "base/memory.h"
#include "scene/lights/lighting.h"

#include <math.h>

enum { PARTS = 4, REFLECTED = 0, EMITTED = 3, COVERED = 6, SUMS = 7 };
// Integer sums do not depend on the order in which workers add to them.
static const double ONE = 0x1p40; // 16 of them stay below 2^45
static const float PI = 3.14159265f;

typedef struct outgoing {
    const alp_scene *scene;
    uint32_t parts, width;
    float brightest;        // emission that 1 stands for in the sums
    uint64_t (*sums)[SUMS]; // [texels] coverage × albedo, × emission / brightest, coverage
} outgoing;

/// The largest factor of emission that any material has, or 1.
static float find_brightest(const alp_scene *scene)
{
    float brightest = 0.0f;
    for (uint32_t m = 0; m < scene->material_count; m++) {
        for (int k = 0; k < 3; k++) {
            brightest = fmaxf(brightest, scene->materials[m].emission[k]);
        }
    }
    return brightest > 0.0f ? brightest : 1.0f;
}

/// Alpha of a blended surface, by which its light is divided since the viewer multiplies by it; 0
/// or 1 for a mask.
static float alpha_of(const alp_scene *scene, const alpi_uv_cell *cell)
{
    const uint32_t m = scene->surfaces[scene->triangle_surface[cell->triangle]].material;
    const float *b = cell->barycentrics;
    switch (m == ALPI_NONE ? ALPI_ALPHA_OPAQUE : scene->materials[m].alpha_mode) {
    case ALPI_ALPHA_BLEND:
        return fminf(alpi_surface_alpha(scene, cell->triangle, b[0], b[1]), 1.0f);
    case ALPI_ALPHA_MASK:
        return alpi_surface_is_cut(scene, cell->triangle, b[0], b[1]) ? 0.0f : 1.0f;
    default:
        return 1.0f;
    }
}

static void add(uint64_t *sum, double coverage, float value)
{
    const float bounded = fminf(fmaxf(value, 0.0f), 1.0f);
    __atomic_fetch_add(sum, (uint64_t)(coverage * (double)bounded), __ATOMIC_RELAXED);
}

static void add_cell(void *user, const alpi_uv_cell *cell)
{
    const outgoing *o = user;
    const float *b = cell->barycentrics;
    const uint32_t t = cell->triangle;
    const alpi_pane pane = alpi_surface_pane(o->scene, t, b[0], b[1]);
    const float alpha = alpha_of(o->scene, cell);
    if (!(alpha > 0.0f)) {
        return; // not there
    }
    vec3 c[3];
    alpi_triangle_corners(o->scene, t, c);
    const vec3 normal = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0.0f, 1.0f, 0.0f});
    const vec3 albedo = alpi_surface_albedo(o->scene, t, b[0], b[1]);
    const vec3 emission = alpi_surface_emission(o->scene, t, b[0], b[1], normal);
    const double coverage = (double)cell->coverage * ONE;
    const float kept = pane.kept / alpha, share = 1.0f / (alpha * o->brightest);
    uint64_t *sums = o->sums[(size_t)(cell->y / o->parts) * o->width + cell->x / o->parts];
    add(&sums[REFLECTED], coverage, albedo.x * kept);
    add(&sums[REFLECTED + 1], coverage, albedo.y * kept);
    add(&sums[REFLECTED + 2], coverage, albedo.z * kept);
    add(&sums[EMITTED], coverage, emission.x * share);
    add(&sums[EMITTED + 1], coverage, emission.y * share);
    add(&sums[EMITTED + 2], coverage, emission.z * share);
    add(&sums[COVERED], coverage, 1.0f);
}

static void finish_page(const outgoing *o, const float *irradiance, size_t count, float *out)
{
    for (size_t i = 0; i < count; i++) {
        const double covered = (double)o->sums[i][COVERED];
        const bool there = irradiance[4 * i + 3] > 0.0f;
        for (size_t k = 0; k < 3; k++) {
            double value = 0.0;
            if (there && covered > 0.0) {
                value = (double)o->sums[i][REFLECTED + k] / covered *
                            (double)irradiance[4 * i + k] / (double)PI +
                        (double)o->sums[i][EMITTED + k] / covered * (double)o->brightest;
            }
            out[4 * i + k] = (float)value;
        }
        out[4 * i + 3] = there ? 1.0f : 0.0f;
    }
}

alp_result alpi_lightmap_outgoing(const alp_lightmap *lightmap, uint32_t page, float *out)
{
    const size_t count = (size_t)lightmap->width * lightmap->height;
    const uint32_t side = lightmap->width > lightmap->height ? lightmap->width : lightmap->height;
    const uint32_t most = ALPI_IMAGE_SIDE_LIMIT / side;
    outgoing o = {.scene = lightmap->scene,
                  .parts = most < 1       ? 1
                           : most < PARTS ? most
                                          : PARTS,
                  .width = lightmap->width,
                  .brightest = find_brightest(lightmap->scene)};
    ALPI_TRY_NEW(lightmap->context, o.sums, count);
    const alp_result result = alpi_atlas_visit(lightmap->atlas, page, o.parts, add_cell, &o);
    if (result == ALP_OK) {
        finish_page(&o, lightmap->irradiance_pages[page], count, out);
    }
    alpi_release(lightmap->context, o.sums);
    return result;
}
