// SPDX-License-Identifier: MIT
#include "lit_scene.h"

#include "transport/gather/cosine_rays.h"

#include <stdlib.h>

enum { SEED_SOLUTION = 1, PATCH_RAYS = 256, DIRECT_SAMPLES = 64 };

static alp_result make_lighting(const alp_lighting_options *options, lit_scene *lit)
{
    ALP_TRY(alpi_lighting_create(lit->scene.scene, options, &lit->lighting));
    return alpi_lighting_sky(lit->lighting) == NULL || alpi_tracer_has_panes(lit->scene.tracer)
               ? ALP_OK
               : alpi_lighting_split_sky(lit->lighting, options, &lit->soft, &lit->direct);
}

alp_result lit_scene_solve(const lit_scene *lit, uint32_t bounces, alpi_radiosity *solution)
{
    const alpi_cosine_rays rays = {.context = lit->scene.context,
                                   .samples = PATCH_RAYS,
                                   .replicates = 1,
                                   .seed = SEED_SOLUTION};
    const alpi_gatherer gatherer = alpi_cosine_rays_gatherer(&rays);
    alpi_radiosity_options o = alpi_radiosity_options_default();
    o.context = lit->scene.context;
    o.scene = lit->scene.scene;
    o.tracer = lit->scene.tracer;
    o.lighting = lit->soft != NULL ? lit->soft : lit->lighting;
    o.direct = lit->direct != NULL ? lit->direct : lit->lighting;
    o.proximity = lit->map.validity.proximity;
    o.gatherer = &gatherer;
    o.direct_samples = DIRECT_SAMPLES;
    o.seed = SEED_SOLUTION;
    o.bounces = bounces;
    return alpi_radiosity_solve(&o, &lit->map.lattice, lit->map.atlas, lit->order, lit->count, NULL,
                                solution);
}

/// Lists the texels that have light of their own.
static void list_texels(lit_scene *lit)
{
    lit->receivers = alpi_texels_receivers(&lit->map.texels);
    lit->order = bench_allocate(lit->map.texels.count, sizeof *lit->order);
    for (uint32_t i = 0; i < lit->map.texels.count; i++) {
        const uint32_t texel = lit->map.lattice.order[i];
        if (!lit->map.validity.dropped[texel]) {
            lit->order[lit->count++] = texel;
        }
    }
}

bool lit_scene_make(const alp_lighting_options *lighting, const alp_atlas_options *atlas,
                    lit_scene *lit)
{
    if (!bench_good(&lit->scene, make_lighting(lighting, lit)) ||
        !bench_map_open_with(&lit->scene, atlas, &lit->map)) {
        return false;
    }
    list_texels(lit);
    return bench_good(&lit->scene, lit_scene_solve(lit, UINT32_MAX, &lit->solution));
}

void lit_scene_close(lit_scene *lit)
{
    free(lit->order);
    alpi_radiosity_destroy(&lit->solution);
    alpi_lighting_destroy(lit->scene.context, lit->lighting);
    alpi_lighting_destroy(lit->scene.context, lit->soft);
    alpi_lighting_destroy(lit->scene.context, lit->direct);
    if (lit->map.atlas != NULL) {
        bench_map_close(&lit->scene, &lit->map);
    }
    bench_scene_close(&lit->scene);
}
