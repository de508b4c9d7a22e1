// SPDX-License-Identifier: MIT
// Surfels of a scene that hosts keep: they run the volume on a graphics card.
#include "base/memory.h"
#include "fields/propagation/lpv.h"
#include "fields/propagation/lpv_maps.h"

struct alp_lpv_collection {
    alp_context *context;
    alpi_surfels surfels;
};

static alp_result fill(const alpi_map_scene *in, alp_lpv_source source, alpi_surfels *surfels)
{
    bool found = true;
    ALP_TRY(source == ALP_LPV_POINTS ? alpi_spread_points(in, surfels)
                                     : alpi_trace_emitters(in, surfels, &found));
    surfels->count = found ? surfels->count : 0;
    return ALP_OK;
}

alp_result alp_lpv_collect(const alp_scene *scene, alp_lpv_source source, uint32_t count,
                           uint64_t seed, alp_lpv_collection **out)
{
    if (scene == NULL || out == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *out = NULL;
    if (count < 2 || count > ALPI_LPV_POINTS_MOST) {
        return alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                         "lpv: %u surfels, need 2 to %d", count, ALPI_LPV_POINTS_MOST);
    }
    alpi_map_scene in = {.scene = scene, .seed = seed};
    alpi_tracer *tracer = NULL;
    float *radii = NULL;
    ALP_TRY(alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    in.tracer = tracer;
    alp_lpv_collection *c = ALPI_NEW(scene->context, alp_lpv_collection, 1);
    if (c == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    c->context = scene->context;
    alp_result result = alpi_find_object_radii(scene, &radii);
    in.radii = radii;
    result = result == ALP_OK ? alpi_surfels_create(scene->context, count, &c->surfels) : result;
    result = result == ALP_OK ? fill(&in, source, &c->surfels) : result;
    alpi_release(scene->context, radii);
    if (result != ALP_OK) {
        alp_lpv_collection_destroy(c);
        return result;
    }
    *out = c;
    return ALP_OK;
}

void alp_lpv_collection_destroy(alp_lpv_collection *c)
{
    if (c != NULL) {
        alpi_surfels_destroy(c->context, &c->surfels);
        alpi_release(c->context, c);
    }
}

alp_lpv_surfels alp_lpv_collection_surfels(const alp_lpv_collection *c)
{
    return alpi_surfels_view(&c->surfels);
}
