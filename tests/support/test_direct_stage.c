// SPDX-License-Identifier: MIT
#include "test_direct_stage.h"

#include "base/memory.h"

test_stage test_stage_open(alp_context *context, alp_scene *scene, const alpi_light *lights,
                           uint32_t count, const alp_lighting_options *options)
{
    test_stage s = {.context = context, .scene = scene};
    if (count > 0) {
        alpi_light *all =
            alpi_reallocate(context, scene->lights, scene->light_count + count, sizeof *all);
        assert_non_null(all);
        memcpy(all + scene->light_count, lights, count * sizeof *lights);
        scene->lights = all;
        scene->light_count += count;
    }
    ASSERT_OK(context, alpi_tracer_for_scene(scene, NULL, NULL, &s.tracer, NULL));
    ASSERT_OK(context, alpi_lighting_create(scene, options, &s.lighting));
    return s;
}

void test_stage_close(test_stage *stage)
{
    alpi_lighting_destroy(stage->context, stage->lighting);
    alp_scene_destroy(stage->scene);
}

alpi_direct_options test_stage_options(const test_stage *stage, uint32_t samples)
{
    return (alpi_direct_options){.context = stage->context,
                                 .scene = stage->scene,
                                 .tracer = stage->tracer,
                                 .lighting = stage->lighting,
                                 .samples = samples,
                                 .seed = 1};
}

alpi_reference test_stage_reference(const test_stage *stage, uint32_t samples)
{
    return (alpi_reference){.context = stage->context,
                            .scene = stage->scene,
                            .tracer = stage->tracer,
                            .lighting = stage->lighting,
                            .samples = samples,
                            .next_event = true,
                            .seed = 1};
}

static void place_patch(const void *user, uint32_t receiver, uint32_t count,
                        const float (*square)[2], alpi_receiver_point *points)
{
    const test_patches *patches = user;
    const test_patch *p = &patches->patches[receiver];
    for (uint32_t i = 0; i < count; i++) {
        points[i] = (alpi_receiver_point){
            .position = vec3_mad(vec3_mad(p->corner, square[i][0], p->u), square[i][1], p->v),
            .geometric_normal = p->normal,
            .shading_normal = p->normal,
            .offset = patches->offset};
    }
}

alpi_receivers test_patches_receivers(const test_patches *patches)
{
    bool extended = false;
    for (uint32_t i = 0; i < patches->count; i++) {
        const test_patch *p = &patches->patches[i];
        extended = extended || vec3_length(p->u) + vec3_length(p->v) > 0.0f;
    }
    return (alpi_receivers){
        .count = patches->count, .extended = extended, .place = place_patch, .user = patches};
}

uint64_t test_stage_gather(const test_stage *stage, const test_patches *patches, uint32_t samples,
                           uint64_t seed, alpi_reference_value *values)
{
    const alpi_receivers receivers = test_patches_receivers(patches);
    alpi_direct_options o = test_stage_options(stage, samples);
    o.seed = seed;
    alpi_direct *direct = NULL;
    alpi_direct_output output = {.values = values};
    ASSERT_OK(stage->context, alpi_direct_create(&o, &direct));
    ASSERT_OK(stage->context, alpi_direct_irradiance(direct, &receivers, NULL, 0, NULL, &output));
    alpi_direct_destroy(direct);
    return output.rays;
}

alpi_reference_value test_stage_direct(const test_stage *stage, const test_patch *patch,
                                       uint32_t samples, uint64_t seed, uint64_t *rays)
{
    enum { COPIES = 64, SAMPLES = 1 << 17 };
    static test_patch copies[COPIES];
    static alpi_reference_value values[COPIES];
    const uint32_t room = SAMPLES / samples < COPIES ? SAMPLES / samples : COPIES;
    const test_patches patches = {.count = room > 0 ? room : 1, .patches = copies, .offset = 1e-6f};
    for (uint32_t i = 0; i < patches.count; i++) {
        copies[i] = *patch;
    }
    const uint64_t sent = test_stage_gather(stage, &patches, samples, seed, values);
    if (rays != NULL) {
        *rays = sent / patches.count;
    }
    return values[0];
}

test_patch test_point(vec3 position, vec3 normal)
{
    return (test_patch){.corner = position, .normal = normal};
}

alpi_light test_lamp(vec3 position, float candela)
{
    return (alpi_light){.kind = ALP_LIGHT_POINT,
                        .color = {1.0f, 0.5f, 0.25f},
                        .intensity = candela,
                        .position = position,
                        .range = INFINITY};
}
