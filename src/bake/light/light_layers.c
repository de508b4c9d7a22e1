// SPDX-License-Identifier: MIT
#include "bake/light/light_layers.h"

#include "base/memory.h"
#include "maps/radiosity/regather.h"

alpi_layer_arrays *alpi_light_start_layers(alpi_bake_job *job, bool sky)
{
    alpi_layer_plan *plan = &job->layers;
    plan->light.part_layers = plan->part_layers;
    plan->light.sky = sky ? plan->sky : ALPI_NONE;
    return job->options.light.layers ? &plan->light : NULL;
}

static alp_result gather_each(alpi_light_rounds *r, alpi_regather *again, uint32_t rays)
{
    const alpi_light_bake *light = r->light;
    const alpi_final_gather_options *o = &again->options;
    const alpi_layer_arrays *layers = &light->job->layers.light;
    for (uint32_t layer = 0; layer < layers->count; layer++) {
        float(*bounced)[3] = layers->bounced[layer];
        ALP_TRY(alpi_radiosity_relight(r->solution, layer, NULL, &light->progress));
        ALP_TRY(alpi_regather_run(again, &light->progress));
        for (uint32_t i = 0; i < o->count; i++) {
            const uint32_t t = o->order[i];
            const double had = r->rays.of_texels != NULL ? r->rays.of_texels[t] : 0.0;
            const float b = (float)(rays / (had + rays));
            for (int k = 0; k < 3; k++) {
                bounced[t][k] += b * (o->gather->values[t].mean[k] - bounced[t][k]);
            }
        }
    }
    light->job->report.rays += again->rays;
    return alpi_radiosity_relight(r->solution, ALPI_NONE, NULL, &light->progress);
}

alp_result alpi_light_gather_layers(alpi_light_rounds *r, const alpi_final_gather_options *options,
                                    uint8_t *states, uint32_t rays)
{
    const alpi_light_bake *light = r->light;
    alp_context *context = light->job->context;
    if (light->job->layers.light.count == 0) {
        return ALP_OK;
    }
    alpi_gather_scene from = *options->gather->from;
    from.sky = false; // its light is known, by the same rays
    alpi_gather_job gather = *options->gather;
    gather.from = &from;
    gather.skies = NULL;
    gather.directional = NULL; // that of all layers is known
    gather.values = ALPI_NEW(context, alpi_reference_value, light->lattice->texels->count);
    if (gather.values == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alpi_final_gather_options own = *options;
    own.gather = &gather;
    alpi_regather again = {0};
    alp_result result = alpi_regather_create(
        &own, light->lattice, states, r->solution->options.kept_limit, &light->progress, &again);
    if (result == ALP_OK) {
        result = gather_each(r, &again, rays);
    }
    alpi_regather_destroy(&again);
    alpi_release(context, gather.values);
    return result;
}

void alpi_light_scale_layers(const alpi_light_rounds *rounds, const uint32_t *list, uint32_t count,
                             uint32_t more, bool merged)
{
    const alpi_layer_arrays *l = &rounds->light->job->layers.light;
    for (uint32_t layer = 0; layer < l->count; layer++) {
        for (uint32_t i = 0; i < count; i++) {
            const uint32_t t = list[i];
            const double had = rounds->direct.counts[t];
            const float factor = (float)(merged ? more / (had + more) : had / more);
            for (int k = 0; k < 3; k++) {
                l->direct[layer][t][k] *= factor;
            }
        }
    }
}

void alpi_light_sum_layers(const alpi_light_bake *light, const float (*skies)[3], bool direct)
{
    const alpi_layer_arrays *l = &light->job->layers.light;
    for (uint32_t i = 0; light->job->options.light.layers && i < light->count; i++) {
        const uint32_t t = light->order[i];
        for (int k = 0; k < 3; k++) {
            float sum = 0.0f;
            for (uint32_t layer = 0; layer < l->count; layer++) {
                float *value = &l->bounced[layer][t][k];
                const float sky = skies != NULL && layer == l->sky ? skies[t][k] : 0.0f;
                *value += direct ? l->direct[layer][t][k] + sky : 0.0f;
                sum += *value;
            }
            light->values[t].mean[k] = sum;
        }
    }
}
