// SPDX-License-Identifier: MIT
// A frame of a scene: maps of its lights, blockers, and the propagation.
#include "base/memory.h"
#include "base/tasks.h"
#include "fields/propagation/lpv.h"
#include "fields/propagation/lpv_maps.h"

#include <math.h>
#include <string.h>

enum { MAP_LEAST = 4, MAP_MOST = 4096 };
enum { CAMERA_MAP = 256, CUBE_FACES = 6 };

alp_lpv_scene_options alp_lpv_scene_options_default(void)
{
    return (alp_lpv_scene_options){.struct_size = sizeof(alp_lpv_scene_options),
                                   .lighting = alp_lighting_options_default(),
                                   .map_size = 256,
                                   .camera_aspect = 1.0f,
                                   .points = 65536};
}

typedef struct frame {
    alp_lpv *lpv;
    const alp_lpv_scene_options *options;
    alpi_map_scene in;
    alpi_lighting *lighting;
    alpi_map_view camera; // of options->camera, where it is not NULL
    alp_lpv_report report;
} frame;

/// Adds a map to the volume, as light and, where views block, as a view.
static alp_result add_map(frame *f, uint32_t cascade, const alpi_surfels *surfels, bool view)
{
    const alp_lpv_surfels s = alpi_surfels_view(surfels);
    const double start = alpi_seconds();
    ALP_TRY(alp_lpv_add_light(f->lpv, cascade, &s));
    const double injected = alpi_seconds();
    if (view && f->lpv->options.blockers && f->options->points == 0) {
        ALP_TRY(alp_lpv_add_blockers(f->lpv, cascade, &s));
    }
    f->report.inject += injected - start;
    f->report.block += alpi_seconds() - injected;
    return ALP_OK;
}

static alp_result trace_view(frame *f, const alpi_map_view *view, uint32_t light, uint32_t first,
                             alpi_surfels *surfels)
{
    const double start = alpi_seconds();
    ALP_TRY(alpi_trace_view(&f->in, view, f->lighting, light, first, surfels));
    f->report.trace += alpi_seconds() - start;
    f->report.rays += (uint64_t)view->size * view->size;
    return ALP_OK;
}

// --- lights --------------------------------------------------------------------------------------

/// A map for each grid, over its box.
static alp_result add_sun(frame *f, uint32_t light, const alpi_light *sun)
{
    const uint32_t size = f->options->map_size;
    for (uint32_t c = 0; c < f->lpv->options.cascades; c++) {
        const alpi_lpv_grid *g = &f->lpv->grids[c];
        double low[3], high[3];
        alpi_surfels surfels;
        for (int k = 0; k < 3; k++) {
            low[k] = g->cell * (double)g->corner[k];
            high[k] = low[k] + g->cell * (double)g->size[k];
        }
        const alpi_map_view view = alpi_sun_view(f->in.scene, sun->direction, low, high, size);
        ALP_TRY(alpi_surfels_create(f->lpv->context, size * size, &surfels));
        alp_result result = trace_view(f, &view, light, 0, &surfels);
        result = result == ALP_OK ? add_map(f, c, &surfels, true) : result;
        alpi_surfels_destroy(f->lpv->context, &surfels);
        ALP_TRY(result);
    }
    return ALP_OK;
}

/// A spot light sees through its cone, a point light through six faces of half the size.
static alp_result add_lamp(frame *f, uint32_t light, const alpi_light *lamp)
{
    const bool spot = lamp->kind == ALP_LIGHT_SPOT && lamp->outer_cone < 1.2f;
    const uint32_t size = spot ? f->options->map_size : f->options->map_size / 2;
    const uint32_t faces = spot ? 1 : CUBE_FACES;
    alpi_surfels surfels;
    ALP_TRY(alpi_surfels_create(f->lpv->context, faces * size * size, &surfels));
    alp_result result = ALP_OK;
    for (uint32_t i = 0; i < faces && result == ALP_OK; i++) {
        const alpi_map_view view =
            spot ? alpi_cone_view(lamp->position, lamp->direction, lamp->outer_cone, size)
                 : alpi_cube_view(lamp->position, i, size);
        result = trace_view(f, &view, light, i * size * size, &surfels);
    }
    result = result == ALP_OK ? add_map(f, ALP_LPV_ALL_CASCADES, &surfels, true) : result;
    alpi_surfels_destroy(f->lpv->context, &surfels);
    return result;
}

static alp_result add_lights(frame *f)
{
    const uint32_t count = alpi_lighting_light_count(f->lighting);
    for (uint32_t i = 0; i < count; i++) {
        const alpi_light *light = alpi_lighting_light(f->lighting, i);
        if (light->intensity > 0.0f) {
            ALP_TRY(light->kind == ALP_LIGHT_DIRECTIONAL ? add_sun(f, i, light)
                                                         : add_lamp(f, i, light));
        }
    }
    return ALP_OK;
}

static alp_result add_emitters(frame *f)
{
    const uint32_t size = f->options->map_size;
    const double start = alpi_seconds();
    alpi_surfels surfels;
    bool found = false;
    if (alpi_lighting_emitter_count(f->lighting) == 0) {
        return ALP_OK;
    }
    ALP_TRY(alpi_surfels_create(f->lpv->context, 2 * size * size, &surfels));
    alp_result result = alpi_trace_emitters(&f->in, &surfels, &found);
    f->report.trace += alpi_seconds() - start;
    f->report.rays += found ? (uint64_t)size * size : 0;
    if (result == ALP_OK && found) {
        result = add_map(f, ALP_LPV_ALL_CASCADES, &surfels, false);
    }
    alpi_surfels_destroy(f->lpv->context, &surfels);
    return result;
}

// --- blockers ------------------------------------------------------------------------------------

static alp_result find_blockers(frame *f, alpi_surfels *surfels)
{
    const double start = alpi_seconds();
    if (f->options->points > 0) {
        ALP_TRY(alpi_spread_points(&f->in, surfels));
        f->report.trace += alpi_seconds() - start;
        return ALP_OK;
    }
    return trace_view(f, &f->camera, ALPI_NONE, 0, surfels);
}

static alp_result add_blockers(frame *f)
{
    const uint32_t points = f->options->points;
    alpi_surfels surfels;
    if (!f->lpv->options.blockers || (points == 0 && f->options->camera == NULL)) {
        return ALP_OK;
    }
    ALP_TRY(alpi_surfels_create(f->lpv->context, points > 0 ? points : CAMERA_MAP * CAMERA_MAP,
                                &surfels));
    alp_result result = find_blockers(f, &surfels);
    const alp_lpv_surfels s = alpi_surfels_view(&surfels);
    const double start = alpi_seconds();
    result = result == ALP_OK ? alp_lpv_add_blockers(f->lpv, ALP_LPV_ALL_CASCADES, &s) : result;
    f->report.block += alpi_seconds() - start;
    alpi_surfels_destroy(f->lpv->context, &surfels);
    return result;
}

// --- the frame -----------------------------------------------------------------------------------

/// Flux that was injected into the coarsest grid: 4π Σ p0.
static void add_up_flux(const alp_lpv *lpv, double flux[3])
{
    const alpi_lpv_grid *g = &lpv->grids[lpv->options.cascades - 1];
    const size_t n = g->size[0], rows = (size_t)g->size[1] * g->size[2];
    for (uint32_t k = 0; k < 3; k++) {
        double sum = 0.0;
        for (size_t r = 0; r < rows; r++) {
            const float *p0 = g->injected + (r * ALPI_LPV_ROWS + k * ALPI_LPV_TERMS) * n;
            for (size_t x = 0; x < n; x++) {
                sum += (double)p0[x];
            }
        }
        flux[k] = 4.0 * ALPI_PI * sum;
    }
}

static alp_result run_frame(frame *f, float **radii)
{
    ALP_TRY(alpi_find_object_radii(f->in.scene, radii));
    f->in.radii = *radii;
    alp_lpv_begin(f->lpv);
    ALP_TRY(add_lights(f));
    ALP_TRY(add_emitters(f));
    ALP_TRY(add_blockers(f));
    const double start = alpi_seconds();
    ALP_TRY(alp_lpv_propagate(f->lpv));
    f->report.propagate = alpi_seconds() - start;
    f->report.lit = f->lpv->lit;
    f->report.lights = f->lpv->lights;
    add_up_flux(f->lpv, f->report.flux);
    return ALP_OK;
}

static alp_result check_options(alp_context *context, const alp_lpv_scene_options *o)
{
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    if (o->struct_size != sizeof *o) {
        return alpi_fail(context, code, "lpv scene options are not from _default()");
    }
    if (o->map_size < MAP_LEAST || o->map_size > MAP_MOST) {
        return alpi_fail(context, code, "lpv: maps of %u texels along a side, need %d to %d",
                         o->map_size, MAP_LEAST, MAP_MOST);
    }
    if (o->points > ALPI_LPV_POINTS_MOST) {
        return alpi_fail(context, code, "lpv: %u points that block, need at most %d", o->points,
                         ALPI_LPV_POINTS_MOST);
    }
    return ALP_OK;
}

alp_result alp_lpv_light_scene(alp_lpv *lpv, const alp_scene *scene,
                               const alp_lpv_scene_options *options, alp_lpv_report *report)
{
    if (lpv == NULL || scene == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    alp_lpv_scene_options o = options ? *options : alp_lpv_scene_options_default();
    ALP_TRY(check_options(lpv->context, &o));
    o.lighting.sky.kind = ALP_SKY_NONE;
    ALP_TRY(alpi_lighting_refuse_darkness(scene, &o.lighting));
    frame f = {.lpv = lpv, .options = &o, .in = {.scene = scene, .seed = o.seed}};
    if (o.camera != NULL) {
        ALP_TRY(
            alpi_camera_map_view(lpv->context, o.camera, o.camera_aspect, CAMERA_MAP, &f.camera));
    }
    alpi_tracer *tracer = NULL;
    ALP_TRY(alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    f.in.tracer = tracer;
    ALP_TRY(alpi_lighting_create_quietly(scene, &o.lighting, &f.lighting));
    float *radii = NULL;
    const alp_result result = run_frame(&f, &radii);
    alpi_release(scene->context, radii);
    alpi_lighting_destroy(scene->context, f.lighting);
    f.report.struct_size = sizeof f.report;
    if (result == ALP_OK && report != NULL) {
        *report = f.report;
    }
    return result;
}
