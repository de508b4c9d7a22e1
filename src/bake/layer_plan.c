// SPDX-License-Identifier: MIT
// The plan of layers: which lights each has, its name, and its pages.
#include "bake/layer_plan.h"

#include "base/memory.h"
#include "transport/direct/direct.h"

#include <ctype.h>
#include <string.h>

/// Names are cut at this many bytes. A file name has at most 255 with its other parts.
enum { NAME_LIMIT = 64 };

// --- names ---------------------------------------------------------------------------------------

/// Makes a name fit for files on any system. Dots, separators and characters that other shells
/// refuse become "_", so that no name reads as a number or an ending.
static char *make_safe(alp_context *context, const char *name, const char *otherwise)
{
    char text[NAME_LIMIT + 1];
    size_t size = strlen(name);
    if (size > NAME_LIMIT) {
        size = NAME_LIMIT;
        while (size > 0 && ((unsigned char)name[size] & 0xC0u) == 0x80u) { // not inside a character
            size--;
        }
    }
    for (size_t i = 0; i < size; i++) {
        const unsigned char c = (unsigned char)name[i];
        text[i] = c < 0x20 || c == 0x7F || strchr("./\\:*?\"<>|", c) != NULL ? '_' : name[i];
    }
    while (size > 0 && text[size - 1] == ' ') {
        size--;
    }
    text[size] = '\0';
    return alpi_copy_string(context, size > 0 ? text : otherwise);
}

static bool is_alike(const char *a, const char *b)
{
    while (*a != '\0' && tolower((unsigned char)*a) == tolower((unsigned char)*b)) {
        a++;
        b++;
    }
    return *a == *b;
}

/// Whether another file has this name: a further page, a map, or a layer. Upper and lower case
/// count as equal, as on some systems.
static bool is_taken(const alpi_layer_plan *plan, const char *name)
{
    static const char *const maps[] = {"error", "direct", "bounced", "sh", "direction"};
    if (strspn(name, "0123456789") == strlen(name)) {
        return true;
    }
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++) {
        if (is_alike(name, maps[i])) {
            return true;
        }
    }
    for (uint32_t i = 0; i < plan->light.count; i++) {
        if (is_alike(name, plan->names[i])) {
            return true;
        }
    }
    return false;
}

/// Adds a layer. The second of a name is "NAME 2".
static alp_result add_layer(alp_context *context, alpi_layer_plan *plan, const char *name,
                            const char *otherwise)
{
    char *safe = make_safe(context, name, otherwise);
    char *unique = safe != NULL ? alpi_copy_string(context, safe) : NULL;
    for (uint32_t n = 2; unique != NULL && is_taken(plan, unique); n++) {
        alpi_release(context, unique);
        unique = alpi_format(context, "%s %u", safe, n);
    }
    alpi_release(context, safe);
    if (unique == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    plan->names[plan->light.count++] = unique;
    return ALP_OK;
}

static alp_result name_part(const alpi_bake_job *job, const alpi_lighting *lighting,
                            const alpi_direct_part *part, alpi_layer_plan *plan)
{
    alp_context *context = job->context;
    switch (part->kind) {
    case ALPI_DIRECT_LIGHT:
        return add_layer(context, plan, alpi_lighting_light(lighting, part->index)->name, "light");
    case ALPI_DIRECT_MATERIAL:
        return add_layer(context, plan, job->scene->materials[part->index].name, "material");
    case ALPI_DIRECT_LIGHTS:
        return add_layer(context, plan, "lamps", "");
    case ALPI_DIRECT_SUNS:
        return add_layer(context, plan, "suns", "");
    case ALPI_DIRECT_MATERIALS:
        return add_layer(context, plan, "materials", "");
    case ALPI_DIRECT_SKY:
        break;
    }
    return add_layer(context, plan, "sky", "");
}

/// Plans a layer for each part of direct light. If they are too many, the last layer takes the
/// rest.
static alp_result plan_parts(alpi_bake_job *job, const alpi_lighting *lighting,
                             const alpi_direct_part *parts, uint32_t count)
{
    alpi_layer_plan *plan = &job->layers;
    ALPI_TRY_NEW(job->context, plan->part_layers, count);
    const uint32_t own = count > ALPI_LAYER_LIMIT ? ALPI_LAYER_LIMIT - 1 : count;
    for (uint32_t i = 0; i < own; i++) {
        ALP_TRY(name_part(job, lighting, &parts[i], plan));
        plan->part_layers[i] = i;
    }
    for (uint32_t i = own; i < count; i++) {
        plan->part_layers[i] = own;
    }
    if (count > 0 && parts[count - 1].kind == ALPI_DIRECT_SKY) { // the sky is the last
        plan->sky = plan->part_layers[count - 1];
    }
    return own == count ? ALP_OK : add_layer(job->context, plan, "others", "");
}

alp_result alpi_bake_find_layers(alpi_bake_job *job, uint32_t *lights)
{
    *lights = 0;
    if (!job->options.light.layers) {
        return ALP_OK;
    }
    alpi_lighting *lighting = NULL;
    alpi_direct *direct = NULL;
    job->layers.light.context = job->context;
    job->layers.sky = ALPI_NONE;
    ALP_TRY(alpi_lighting_create_quietly(job->scene, &job->options.light.lighting, &lighting));
    const alpi_direct_options options = {
        .context = job->context, .scene = job->scene, .lighting = lighting, .samples = 1};
    alp_result result = alpi_direct_create(&options, &direct);
    if (result == ALP_OK) {
        const alpi_direct_part *parts = alpi_direct_parts(direct, lights);
        result = plan_parts(job, lighting, parts, *lights);
    }
    alpi_direct_destroy(direct);
    alpi_lighting_destroy(job->context, lighting);
    return result;
}

alp_result alpi_bake_plan_layers(alpi_bake_job *job)
{
    uint32_t lights;
    ALP_TRY(alpi_bake_find_layers(job, &lights));
    if (lights > ALPI_LAYER_LIMIT) {
        alpi_warn(job->context, "many-layers", job->scene->name,
                  "%u lights exceed %d layers: the last %u lights are summed in \"others\"", lights,
                  ALPI_LAYER_LIMIT, lights - ALPI_LAYER_LIMIT + 1);
    }
    return ALP_OK;
}

void alpi_bake_release_layers(alpi_bake_job *job)
{
    alpi_layer_plan *plan = &job->layers;
    alpi_layer_arrays_clear(&plan->light);
    alpi_release(job->context, plan->part_layers);
    for (uint32_t i = 0; i < plan->light.count; i++) {
        alpi_release(job->context, plan->names[i]);
    }
    *plan = (alpi_layer_plan){0};
}

// --- pages ---------------------------------------------------------------------------------------

alp_result alpi_bake_store_layers(alpi_bake_job *job)
{
    alp_lightmap *l = job->lightmap;
    alpi_layer_plan *plan = &job->layers;
    const uint32_t count = plan->light.count;
    if (count == 0) {
        return ALP_OK;
    }
    ALPI_TRY_NEW(job->context, l->layer_names, count);
    ALPI_TRY_NEW(job->context, l->layer_pages, count);
    l->layer_count = count;
    for (uint32_t i = 0; i < count; i++) {
        l->layer_names[i] = alpi_copy_string(job->context, plan->names[i]);
        if (l->layer_names[i] == NULL) {
            return ALP_ERROR_OUT_OF_MEMORY;
        }
        ALP_TRY(alpi_lightmap_store_vectors(l, (const float(*)[3])plan->light.bounced[i],
                                            &l->layer_pages[i]));
    }
    alpi_layer_arrays_clear(&plan->light);
    return ALP_OK;
}
