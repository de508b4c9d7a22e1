// SPDX-License-Identifier: MIT
#include "fields/probes/probe_ranks.h"

#include "base/bytes.h"
#include "base/hash.h"
#include "base/image.h"
#include "base/tiles/rank_calls.h"
#include "scene/scene.h"

#include <inttypes.h>

static uint64_t hash_lighting(const alp_lighting_options *l)
{
    uint64_t hash = alpi_hash_bytes(ALPI_HASH_START, &l->sun, sizeof l->sun);
    hash = alpi_hash_bytes(hash, l->sky.up, sizeof l->sky.up);
    hash = alpi_hash_bytes(hash, l->sky.down, sizeof l->sky.down);
    if (l->sky.image != NULL) {
        const alp_image_info i = l->sky.image->info;
        const size_t size = i.component == ALP_COMPONENT_FLOAT ? sizeof(float) : 1;
        hash = alpi_hash_bytes(hash, l->sky.image->pixels,
                               (size_t)i.width * i.height * i.channels * size);
    }
    for (uint32_t i = 0; i < l->lamp_count; i++) {
        hash = alpi_hash_bytes(hash, l->lamps[i].position, sizeof l->lamps[i].position);
        hash = alpi_hash_bytes(hash, l->lamps[i].direction, sizeof l->lamps[i].direction);
        hash = alpi_hash_bytes(hash, l->lamps[i].color, sizeof l->lamps[i].color);
        hash = alpi_hash_bytes(hash, &l->lamps[i].intensity, sizeof l->lamps[i].intensity);
    }
    return hash;
}

alp_result alpi_probes_begin_ranks(const alp_scene *scene, const alp_probe_options *options,
                                   bool *began)
{
    const alp_probe_options o = options ? *options : alp_probe_options_default();
    uint64_t places = alpi_hash_bytes(ALPI_HASH_START, o.bounds_min, sizeof o.bounds_min);
    places = alpi_hash_bytes(places, o.bounds_max, sizeof o.bounds_max);
    if (o.positions != NULL) {
        places = alpi_hash_bytes(places, o.positions, o.position_count * sizeof *o.positions);
    }
    alpi_bytes settings = alpi_bytes_create(scene->context);
    alpi_bytes_print(&settings, "alpenglow %s\ninstructions %s\n", alp_version(),
                     alpi_context_isa(scene->context));
    alpi_bytes_print(&settings, "SCENE-content %016" PRIx64 "\nlight %016" PRIx64 "\n",
                     scene->input_hash, hash_lighting(&o.lighting));
    alpi_bytes_print(&settings, "probe-places %016" PRIx64 "\nspacing %a\n", places,
                     (double)o.spacing);
    alpi_bytes_print(&settings, "kind %d %d %d %d %d\nprobe-rays %u\nbounces %u\n", o.basis,
                     o.visibility, o.gradients, o.layers, o.direct, o.rays, o.bounces);
    alpi_bytes_print(&settings, "seed %" PRIu64 "\n", o.seed);
    *began = false;
    const alp_result result =
        settings.failed ? ALP_ERROR_OUT_OF_MEMORY
                        : alpi_ranks_begin(scene->context, (const char *)settings.bytes, began);
    alpi_bytes_destroy(&settings);
    return result;
}
