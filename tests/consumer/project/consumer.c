// SPDX-License-Identifier: MIT
// What a user writes first: this program stands in the README, and is built here as users build it.
#include <alpenglow/alpenglow.h>
#include <stdio.h>

int main(void)
{
    alp_context *context = NULL;
    alp_scene *scene = NULL;
    alp_result result = alp_context_create(NULL, &context);
    if (result == ALP_OK) {
        result = alp_scene_load(context, "builtin:cornell", &scene);
    }
    if (result == ALP_OK) {
        alp_bake_options options = alp_bake_options_default();
        options.atlas.size = 128;
        options.output = "cornell.glb";
        result = alp_bake(scene, &options, NULL, NULL);
    }
    if (result != ALP_OK) {
        fprintf(stderr, "%s: %s\n", alp_result_name(result), alp_context_message(context));
    }
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    return result == ALP_OK ? 0 : 1;
}
