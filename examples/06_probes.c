// SPDX-License-Identifier: MIT
// Light for things that move: probes of a room, and the irradiance that an engine needs at a point.
//
//     cc 06_probes.c -o probes $(pkg-config --cflags --libs alpenglow)
//
// Prints E above and below a point of the Cornell box, by probes and by the path tracer.
#include <alpenglow/alpenglow.h>

#include <stdio.h>

static alp_result measure(const alp_scene *scene, const alp_probes *probes)
{
    static const float positions[2][3] = {{0.1f, 0.3f, 0.15f}, {0.1f, 0.3f, 0.15f}};
    static const float normals[2][3] = {{0.0f, 1.0f, 0.0f}, {0.0f, -1.0f, 0.0f}};
    float by_probes[2][3], by_paths[2][3];
    alp_field *field = NULL;
    alp_result result = alp_field_create_probes(probes, ALP_LOOKUP_OURS, NULL, NULL, &field);
    if (result == ALP_OK) {
        alp_field_irradiance(field, 2, positions, normals, by_probes); // any thread, no allocation
        result = alp_reference_irradiance(scene, NULL, 2, positions, normals, by_paths, NULL);
    }
    for (int i = 0; i < 2 && result == ALP_OK; i++) {
        printf("%s: probes %.3f %.3f %.3f, reference %.3f %.3f %.3f W/m2\n",
               i == 0 ? "above" : "below", by_probes[i][0], by_probes[i][1], by_probes[i][2],
               by_paths[i][0], by_paths[i][1], by_paths[i][2]);
    }
    alp_field_destroy(field);
    return result;
}

int main(void)
{
    alp_context *context = NULL;
    alp_scene *scene = NULL;
    alp_probes *probes = NULL;
    alp_result result = alp_context_create(NULL, &context);
    if (result == ALP_OK) {
        result = alp_scene_load(context, "builtin:cornell", &scene);
    }
    if (result == ALP_OK) {
        alp_probe_options options = alp_probe_options_default();
        options.spacing = 0.05f; // metres
        result = alp_probes_bake(scene, &options, &probes);
    }
    if (result == ALP_OK) {
        const alp_probes_info info = alp_probes_get_info(probes);
        printf("%u probes, %u of them moved out of solids\n", info.count,
               info.states[ALP_PROBE_MOVED]);
        result = measure(scene, probes);
    }
    if (result != ALP_OK) {
        fprintf(stderr, "%s: %s\n", alp_result_name(result), alp_context_message(context));
    }
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    return result == ALP_OK ? 0 : 1;
}
