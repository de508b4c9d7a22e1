// SPDX-License-Identifier: MIT
#include "transport/direct/direct_setup.h"

#include "base/memory.h"
#include "base/random.h"

/// Looks at the sky, to find how even it is.
enum { SKY_LOOKS = 1024, SKY_SEED = 1 };
/// Mean over what is drawn of radiance / mean radiance: 1 of an even sky, 2 of one that is black
/// below the horizon, for which cosine-distributed rays are best; more of a sky with a bright
/// place.
static const double UNEVEN = 2.5;

static uint32_t add_part(alpi_direct *d, alpi_direct_kind kind, uint32_t index)
{
    d->parts[d->part_count] = (alpi_direct_part){kind, index};
    return d->part_count++;
}

// --- lights --------------------------------------------------------------------------------------

static bool gives_light(const alpi_light *l)
{
    return l->intensity > 0.0f && (l->color.x > 0.0f || l->color.y > 0.0f || l->color.z > 0.0f);
}

/// Tells suns from lamps, and what is asked one by one from what is drawn.
static alp_result sort_lights(alpi_direct *d, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        d->lights[i] = *alpi_lighting_light(d->options.lighting, i);
        d->light_parts[i] = ALPI_NONE;
        if (!gives_light(&d->lights[i])) {
            continue;
        }
        if (d->lights[i].size > 0.0f) {
            d->suns[d->sun_count++] = alpi_sun_from(&d->lights[i], i);
        } else {
            d->lamps[d->lamp_count++] = i;
        }
    }
    d->lamps_drawn = d->lamp_count > ALPI_DIRECT_LIGHT_LIMIT;
    d->suns_drawn = d->sun_count > ALPI_DIRECT_LIGHT_LIMIT;
    return d->lamps_drawn ? alpi_punctual_collect(d->options.scene->context, d->lights, d->lamps,
                                                  d->lamp_count, &d->drawn)
                          : ALP_OK;
}

/// A part for each light, in the order of the list; lights that are drawn share one.
static void part_lights(alpi_direct *d, uint32_t count)
{
    uint32_t lamps = ALPI_NONE, suns = ALPI_NONE;
    for (uint32_t i = 0; i < count; i++) {
        const bool sun = d->lights[i].size > 0.0f;
        uint32_t *shared = sun ? &suns : &lamps;
        if (!gives_light(&d->lights[i])) {
            continue;
        }
        if (sun ? !d->suns_drawn : !d->lamps_drawn) {
            d->light_parts[i] = add_part(d, ALPI_DIRECT_LIGHT, i);
            continue;
        }
        if (*shared == ALPI_NONE) {
            *shared = add_part(d, sun ? ALPI_DIRECT_SUNS : ALPI_DIRECT_LIGHTS, ALPI_NONE);
        }
        d->light_parts[i] = *shared;
    }
}

static alp_result collect_lights(alpi_direct *d)
{
    alp_context *context = d->options.scene->context;
    const uint32_t count = alpi_lighting_light_count(d->options.lighting);
    ALPI_TRY_NEW(context, d->lights, count);
    ALPI_TRY_NEW(context, d->light_parts, count);
    ALPI_TRY_NEW(context, d->lamps, count);
    ALPI_TRY_NEW(context, d->suns, count);
    ALP_TRY(sort_lights(d, count));
    part_lights(d, count);
    return ALP_OK;
}

// --- surfaces and sky ----------------------------------------------------------------------------

/// Parts of the materials that emit, in their order.
static alp_result collect_surfaces(alpi_direct *d)
{
    const alp_scene *scene = d->options.scene;
    const uint32_t used = 0; // marks a material until its part is known
    ALP_TRY(alpi_direct_emitters_collect(scene, &d->emitters));
    ALPI_TRY_NEW(scene->context, d->material_parts, scene->material_count);
    for (uint32_t m = 0; m < scene->material_count; m++) {
        d->material_parts[m] = ALPI_NONE;
    }
    uint32_t count = 0;
    for (uint32_t i = 0; i < d->emitters.all.count; i++) {
        const uint32_t surface = scene->triangle_surface[d->emitters.all.triangles[i]];
        uint32_t *part = &d->material_parts[scene->surfaces[surface].material];
        count += *part == ALPI_NONE;
        *part = used;
    }
    uint32_t shared = ALPI_NONE;
    if (count > ALPI_DIRECT_LIGHT_LIMIT) {
        shared = add_part(d, ALPI_DIRECT_MATERIALS, ALPI_NONE);
    }
    for (uint32_t m = 0; m < scene->material_count; m++) {
        if (d->material_parts[m] == used) {
            d->material_parts[m] =
                shared != ALPI_NONE ? shared : add_part(d, ALPI_DIRECT_MATERIAL, m);
        }
    }
    d->polygon_count = alpi_polygons_collect(&d->emitters, d->material_parts, d->polygons);
    if (d->polygon_count > 0) {
        alpi_direct_emitters_clear(&d->emitters);
        d->emitters = (alpi_direct_emitters){.scene = scene};
    }
    return ALP_OK;
}

static double brightness(vec3 v)
{
    return ((double)v.x + (double)v.y + (double)v.z) / 3.0;
}

static bool is_uneven(const alpi_sky *sky)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < SKY_LOOKS; i++) {
        float density;
        const vec3 direction = alpi_sky_sample(sky, alpi_sample_2d(SKY_SEED, i), &density);
        sum += brightness(alpi_sky_radiance(sky, direction)) / SKY_LOOKS;
    }
    return sum > UNEVEN * brightness(alpi_sky_mean(sky));
}

static void find_sky(alpi_direct *d)
{
    d->sky = alpi_lighting_sky(d->options.lighting);
    if (d->sky != NULL) {
        d->sky_part = add_part(d, ALPI_DIRECT_SKY, ALPI_NONE);
        d->sky_spots = alpi_sky_spot_looks(d->sky) != NULL;
        d->sky_met = !d->sky_spots;
        d->sky_drawn = d->sky_met && is_uneven(d->sky);
    }
}

// --- making --------------------------------------------------------------------------------------

alp_result alpi_direct_create(const alpi_direct_options *options, alpi_direct **direct)
{
    *direct = NULL;
    alpi_direct *made = ALPI_NEW(options->scene->context, alpi_direct, 1);
    if (made == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const uint32_t replicates = ALPI_DIRECT_REPLICATES;
    made->options = *options;
    made->options.filter.panes = options->tracer != NULL && alpi_tracer_has_panes(options->tracer);
    made->samples = options->samples / replicates * replicates;
    made->samples += made->samples < options->samples || made->samples == 0 ? replicates : 0;
    alp_result result = collect_lights(made);
    if (result == ALP_OK) {
        result = collect_surfaces(made);
    }
    if (result != ALP_OK) {
        alpi_direct_destroy(made);
        return result;
    }
    find_sky(made);
    *direct = made;
    return ALP_OK;
}

void alpi_direct_destroy(alpi_direct *direct)
{
    if (direct == NULL) {
        return;
    }
    alp_context *context = direct->options.scene->context;
    alpi_direct_emitters_clear(&direct->emitters);
    alpi_punctual_clear(context, &direct->drawn);
    alpi_release(context, direct->material_parts);
    alpi_release(context, direct->suns);
    alpi_release(context, direct->lamps);
    alpi_release(context, direct->light_parts);
    alpi_release(context, direct->lights);
    alpi_release(context, direct);
}

double alpi_direct_most_rays(const alpi_direct *d, bool extended, uint32_t receivers)
{
    const bool meets = d->emitters.all.count > 0 || d->sky_met;
    double of_each_sample = d->suns_drawn ? 1.0 : d->sun_count;
    of_each_sample += d->emitters.all.count > 0 ? 1.0 : 0.0;
    of_each_sample += (meets ? 1.0 : 0.0) + (d->sky_drawn || d->sky_spots ? 1.0 : 0.0);
    const double lamps = d->lamps_drawn ? 1.0 : d->lamp_count;
    const bool once = !extended && !d->lamps_drawn;
    const double others = of_each_sample * d->samples + (once ? lamps : lamps * d->samples);
    const uint32_t block = receivers < ALPI_PACKET ? receivers : ALPI_PACKET;
    return block * others + d->polygon_count * alpi_polygon_rays(d->samples, block);
}

uint32_t alpi_direct_samples(const alpi_direct *direct)
{
    return direct->samples;
}

const alpi_direct_part *alpi_direct_parts(const alpi_direct *direct, uint32_t *count)
{
    *count = direct->part_count;
    return direct->parts;
}

void alpi_direct_put_part(const alpi_direct_output *output, uint32_t part_count, uint32_t part,
                          uint32_t receiver, const alpi_reference_value *value)
{
    if (output->parts != NULL) {
        output->parts[(size_t)receiver * part_count + part] = *value;
    }
    for (int k = 0; k < 3 && output->groups != NULL; k++) {
        output->groups[output->part_groups[part]][receiver][k] += value->mean[k];
    }
}
