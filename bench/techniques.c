// SPDX-License-Identifier: MIT
#include "techniques.h"

#include "bake/light/light.h"
#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- the reference -------------------------------------------------------------------------------

bool bench_reference(const bench_question *question, bench_paths paths,
                     alpi_reference_value *values)
{
    const alpi_receivers receivers = alpi_texels_receivers(&question->map->texels);
    const alpi_reference reference = {.context = question->scene->context,
                                      .scene = question->scene->scene,
                                      .tracer = question->scene->tracer,
                                      .lighting = question->lighting,
                                      .bounces = paths.bounces,
                                      .samples = paths.count,
                                      .next_event = paths.next_event,
                                      .seed = paths.seed};
    alpi_reference_value *all = bench_allocate(receivers.count, sizeof *all);
    const bool good = bench_good(question->scene,
                                 alpi_reference_irradiance(&reference, &receivers, question->list,
                                                           question->count, NULL, all));
    for (uint32_t i = 0; i < question->count; i++) {
        values[i] = all[question->list[i]];
    }
    free(all);
    return good;
}

static bool run_reference(const bench_question *question, uint32_t paths,
                          alpi_reference_value *values)
{
    const bench_paths how = {paths, ALPI_REFERENCE_BOUNCE_LIMIT, true, question->seed};
    return bench_reference(question, how, values);
}

/// Texels in the order of packets, as a bake takes them, of the blocks of eight that hold an asked
/// one. @return how many
static uint32_t list_blocks(const bench_question *question, uint32_t *list)
{
    const bench_map *map = question->map;
    const uint32_t texels = map->texels.count;
    bool *asked = bench_allocate(texels, sizeof *asked);
    uint32_t *order = bench_allocate(texels, sizeof *order);
    uint32_t count = 0, listed = 0;
    memset(asked, 0, texels * sizeof *asked);
    for (uint32_t i = 0; i < question->count; i++) {
        asked[question->list[i]] = true;
    }
    for (uint32_t i = 0; i < texels; i++) {
        if (!map->validity.dropped[map->lattice.order[i]]) {
            order[count++] = map->lattice.order[i];
        }
    }
    for (uint32_t block = 0; block < count; block += ALPI_PACKET) {
        const uint32_t end = count - block < ALPI_PACKET ? count : block + ALPI_PACKET;
        bool any = false;
        for (uint32_t i = block; i < end; i++) {
            any = any || asked[order[i]];
        }
        for (uint32_t i = block; i < end && any; i++) {
            list[listed++] = order[i];
        }
    }
    free(asked);
    free(order);
    return listed;
}

/// What `bake --maps light --gather paths` does: the paths of neighbours are shared.
static bool run_bake(const bench_question *question, uint32_t paths, alpi_reference_value *values)
{
    const alpi_receivers receivers = alpi_texels_receivers(&question->map->texels);
    const alpi_reference reference = {.context = question->scene->context,
                                      .scene = question->scene->scene,
                                      .tracer = question->scene->tracer,
                                      .lighting = question->lighting,
                                      .bounces = ALPI_REFERENCE_BOUNCE_LIMIT,
                                      .samples = paths,
                                      .next_event = true,
                                      .share = true,
                                      .seed = question->seed};
    uint32_t *list = bench_allocate(receivers.count, sizeof *list);
    alpi_reference_value *all = bench_allocate(receivers.count, sizeof *all);
    const uint32_t count = list_blocks(question, list);
    const bool good = bench_good(
        question->scene, alpi_reference_irradiance(&reference, &receivers, list, count, NULL, all));
    for (uint32_t i = 0; i < question->count && good; i++) {
        values[i] = all[question->list[i]];
    }
    free(list);
    free(all);
    return good;
}

/// Radiosity as `bake --maps light` solves it, on all texels of the map.
static bool run_radiosity_with(const bench_question *question, const alp_light_options *light,
                               alpi_reference_value *values)
{
    const bench_scene *scene = question->scene;
    const alpi_receivers receivers = alpi_texels_receivers(&question->map->texels);
    alp_lightmap lightmap = {.context = scene->context,
                             .scene = scene->scene,
                             .atlas = question->map->atlas,
                             .texels = question->map->texels};
    alpi_bake_job job = {.scene = scene->scene,
                         .context = scene->context,
                         .options = alp_bake_options_default(),
                         .lightmap = &lightmap,
                         .gathering.validity = question->map->validity};
    job.options.light = *light;
    job.options.light.lighting = *question->light;
    job.options.occlusion.seed = question->seed;
    uint32_t *order = bench_allocate(receivers.count, sizeof *order);
    const alpi_task_progress silent = {.stage = "light"};
    alpi_light_clock clock = alpi_light_clock_start(&job, &silent);
    alpi_light_bake bake = {
        .job = &job,
        .clock = &clock,
        .progress = {.callback = alpi_light_clock_goes_on, .user = &clock, .stage = silent.stage},
        .lighting = question->lighting,
        .tracer = scene->tracer,
        .receivers = &receivers,
        .order = order,
        .lattice = &question->map->lattice};
    for (uint32_t i = 0; i < receivers.count; i++) {
        const uint32_t texel = question->map->lattice.order[i];
        if (!question->map->validity.dropped[texel]) {
            order[bake.count++] = texel;
        }
    }
    const bool good = bench_good(scene, alpi_light_radiosity(&bake));
    for (uint32_t i = 0; i < question->count && good; i++) {
        values[i] = bake.values[question->list[i]];
    }
    free(order);
    alpi_release(scene->context, bake.values);
    return good;
}

/// What `bake --maps light --samples` does.
static bool run_radiosity(const bench_question *question, uint32_t rays,
                          alpi_reference_value *values)
{
    alp_light_options light = alp_bake_options_default().light;
    light.samples = rays;
    return run_radiosity_with(question, &light, values);
}

/// What `bake --maps light --error` does, which by default is for 1 %. @param paths 1 / error
static bool run_radiosity_for(const bench_question *question, uint32_t paths,
                              alpi_reference_value *values)
{
    alp_light_options light = alp_bake_options_default().light;
    light.error = 1.0f / (float)paths;
    return run_radiosity_with(question, &light, values);
}

static bool run_by_chance(const bench_question *question, uint32_t paths,
                          alpi_reference_value *values)
{
    const bench_paths how = {paths, ALPI_REFERENCE_BOUNCE_LIMIT, false, question->seed};
    return bench_reference(question, how, values);
}

static bool run_direct(const bench_question *question, uint32_t paths, alpi_reference_value *values)
{
    const bench_paths how = {paths, 0, true, question->seed};
    return bench_reference(question, how, values);
}

// --- ambient models ------------------------------------------------------------------------------

/// E = c₀ a + c₁ b with the colours of least squares, for two weights a and b of each texel.
static void fit(const bench_question *question, const float (*weights)[2],
                alpi_reference_value *values)
{
    for (int k = 0; k < 3; k++) {
        double aa = 0.0, ab = 0.0, bb = 0.0, ay = 0.0, by = 0.0;
        for (uint32_t i = 0; i < question->count; i++) {
            const double a = (double)weights[i][0], b = (double)weights[i][1];
            const double y = (double)question->truth[i].mean[k];
            aa += a * a;
            ab += a * b;
            bb += b * b;
            ay += a * y;
            by += b * y;
        }
        const double determinant = aa * bb - ab * ab;
        const bool both = determinant > 1e-12 * aa * bb; // else one weight says all there is
        const double one = both ? (ay * bb - by * ab) / determinant : aa > 0.0 ? ay / aa : 0.0;
        const double two = both                    ? (by * aa - ay * ab) / determinant
                           : aa <= 0.0 && bb > 0.0 ? by / bb
                                                   : 0.0;
        for (uint32_t i = 0; i < question->count; i++) {
            values[i].mean[k] = (float)(one * (double)weights[i][0] + two * (double)weights[i][1]);
            values[i].variance[k] = 0.0f;
        }
    }
}

/// The same light everywhere: OpenGL's GL_AMBIENT, and the mean that a picture is exposed for.
static bool run_constant(const bench_question *question, uint32_t paths,
                         alpi_reference_value *values)
{
    (void)paths;
    float(*weights)[2] = bench_allocate(question->count, sizeof *weights);
    for (uint32_t i = 0; i < question->count; i++) {
        weights[i][0] = 1.0f;
    }
    fit(question, (const float(*)[2])weights, values);
    free(weights);
    return true;
}

/// One colour from above, one from below, nothing in their way.
static bool run_hemisphere(const bench_question *question, uint32_t paths,
                           alpi_reference_value *values)
{
    (void)paths;
    float(*weights)[2] = bench_allocate(question->count, sizeof *weights);
    for (uint32_t i = 0; i < question->count; i++) {
        const float up = question->map->texels.normals[question->list[i]][1];
        weights[i][0] = 0.5f * (1.0f + up);
        weights[i][1] = 0.5f * (1.0f - up);
    }
    fit(question, (const float(*)[2])weights, values);
    free(weights);
    return true;
}

/// The same light everywhere, as much of it as the occlusion of a bake with default options lets
/// through.
static bool run_occlusion(const bench_question *question, uint32_t paths,
                          alpi_reference_value *values)
{
    (void)paths;
    const bench_scene *scene = question->scene;
    const alpi_receivers receivers = alpi_texels_receivers(&question->map->texels);
    alp_occlusion_options options = alp_occlusion_options_default();
    options.seed = question->seed;
    alpi_occlusion_setup setup;
    if (!bench_good(scene, alpi_occlusion_prepare(scene->scene, scene->tracer, &options, &setup))) {
        return false;
    }
    float *all = bench_allocate(receivers.count, sizeof *all);
    float(*weights)[2] = bench_allocate(question->count, sizeof *weights);
    const bool good = bench_good(
        scene, alpi_occlusion_gather(&setup, &receivers, question->list, question->count, all));
    for (uint32_t i = 0; i < question->count; i++) {
        weights[i][0] = all[question->list[i]];
    }
    fit(question, (const float(*)[2])weights, values);
    alpi_occlusion_release(&setup);
    free(weights);
    free(all);
    return good;
}

// --- the table -----------------------------------------------------------------------------------

const bench_technique *bench_technique_at(int index)
{
    static const bench_technique techniques[] = {
        {"reference, 64 paths", run_reference, 64, true, false, 1},
        {"reference, 256 paths", run_reference, 256, true, false, 1},
        // Neighbours' errors are alike: the mean's standard error, which takes them for
        // independent, says too little.
        {"shared paths, 64", run_bake, 64, false, false, 1},
        {"radiosity, 64 rays", run_radiosity, 64, false, false, 1},
        {"radiosity, 256 rays", run_radiosity, 256, false, false, 1},
        {"radiosity, for 4 %", run_radiosity_for, 25, false, false, 1},
        // Held to its stated error, which is as true as the chance of a seed lets it be.
        {"radiosity, for 1 %", run_radiosity_for, 100, false, false, 8},
        // Has no bias either, but where a sun is small so few paths meet it that 256 of them say
        // too little of their own spread.
        {"without next event, 256 paths", run_by_chance, 256, false, false, 1},
        {"direct light alone", run_direct, 1024, false, true, 1},
        {"constant ambient", run_constant, 0, false, false, 1},
        {"hemisphere ambient", run_hemisphere, 0, false, false, 1},
        {"constant x occlusion", run_occlusion, 0, false, false, 1},
    };
    const int count = sizeof techniques / sizeof *techniques;
    return index >= 0 && index < count ? &techniques[index] : NULL;
}
