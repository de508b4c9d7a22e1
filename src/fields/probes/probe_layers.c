// SPDX-License-Identifier: MIT
#include "fields/probes/probe_layers.h"

#include "base/memory.h"
#include "transport/direct/direct.h"

static alp_result assign(const alp_scene *scene, const alpi_direct_part *parts, uint32_t count,
                         alpi_probe_layers *layers)
{
    uint32_t left = 0;
    ALPI_TRY_NEW(scene->context, layers->part_layers, count);
    for (uint32_t i = 0; i < count; i++) {
        const bool lamp = parts[i].kind == ALPI_DIRECT_LIGHT;
        layers->part_layers[i] = ALPI_NONE;
        left += parts[i].kind == ALPI_DIRECT_LIGHTS || parts[i].kind == ALPI_DIRECT_SUNS;
        if (lamp && layers->count < ALPI_LAMP_LAYER_LIMIT) {
            layers->lamps[layers->count] = parts[i].index;
            layers->part_layers[i] = layers->count++;
        } else if (lamp) {
            left++;
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        if (layers->part_layers[i] == ALPI_NONE) {
            layers->part_layers[i] = layers->count;
        }
    }
    if (left > 0) {
        alpi_warn(scene->context, "many-layers", scene->name,
                  "there are more lamps than the %d that get a layer; the others are in the light "
                  "of all probes alone",
                  ALPI_LAMP_LAYER_LIMIT);
    }
    layers->light = (alpi_layer_arrays){.context = scene->context,
                                        .count = layers->count + 1,
                                        .part_layers = layers->part_layers,
                                        .sky = ALPI_NONE};
    return ALP_OK;
}

alp_result alpi_probe_layers_plan(const alp_scene *scene, const alpi_lighting *lighting,
                                  alpi_probe_layers *layers)
{
    uint32_t count = 0;
    alpi_direct *direct = NULL;
    const alpi_direct_options options = {
        .context = scene->context, .scene = scene, .lighting = lighting, .samples = 1};
    ALP_TRY(alpi_direct_create(&options, &direct));
    const alpi_direct_part *parts = alpi_direct_parts(direct, &count);
    const alp_result result = assign(scene, parts, count, layers);
    alpi_direct_destroy(direct);
    return result;
}

void alpi_probe_layers_clear(alp_context *context, alpi_probe_layers *layers)
{
    alpi_layer_arrays_clear(&layers->light);
    alpi_release(context, layers->part_layers);
}

alp_result alpi_probe_layers_name(const alpi_lighting *lighting, const alpi_probe_layers *layers,
                                  alpi_probe_volume *v)
{
    for (uint32_t i = 0; i < v->layer_count; i++) {
        const char *name = alpi_lighting_light(lighting, layers->lamps[i])->name;
        v->layers[i].name = alpi_copy_string(v->context, name != NULL ? name : "light");
        if (v->layers[i].name == NULL) {
            return ALP_ERROR_OUT_OF_MEMORY;
        }
    }
    return ALP_OK;
}
