// SPDX-License-Identifier: MIT
#include "fields/probes/probe_ranks.h"

#include "base/bytes.h"
#include "base/hash.h"
#include "base/tiles/rank_calls.h"
#include "scene/lights/lighting_options.h"

#include <inttypes.h>

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
    alpi_bytes_print(&settings,
                     "SCENE-content %016" PRIx64 "\npose %016" PRIx64 "\nimages %016" PRIx64 "\n",
                     scene->input_hash, alpi_scene_pose_hash(scene), alpi_scene_images_hash(scene));
    alpi_bytes_print(&settings, "light %016" PRIx64 "\nmetals %d\none-sided %d\n",
                     alpi_lighting_options_hash(&o.lighting), scene->metals_black, o.one_sided);
    alpi_bytes_print(&settings, "probe-places %016" PRIx64 "\nspacing %a\n", places,
                     (double)o.spacing);
    alpi_bytes_print(&settings, "kind %d %d %d %d %d\nprobe-rays %u\nbounces %u\n", o.basis,
                     o.visibility, o.gradients, o.layers, o.direct, o.rays, o.bounces);
    alpi_bytes_print(&settings, "size %u\nseed %" PRIu64 "\n", o.atlas_size, o.seed);
    *began = false;
    const alp_result result =
        settings.failed ? ALP_ERROR_OUT_OF_MEMORY
                        : alpi_ranks_begin(scene->context, (const char *)settings.bytes, began);
    alpi_bytes_destroy(&settings);
    return result;
}
