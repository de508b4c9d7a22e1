// SPDX-License-Identifier: MIT
// count_triangles SCENE: prints how many triangles a file has, as `alpenglow info` does, without
// the search for faults, which takes most of the time of `info`.
#include <alpenglow/alpenglow.h>

#include <stdio.h>

int main(int count, char **words)
{
    alp_context *context = NULL;
    alp_scene *scene = NULL;
    if (count != 2 || alp_context_create(NULL, &context) != ALP_OK) {
        return 2;
    }
    const alp_result result = alp_scene_load(context, words[1], &scene);
    if (result == ALP_OK) {
        printf("%u\n", alp_scene_get_info(scene).triangles);
    } else {
        fprintf(stderr, "%s\n", alp_context_message(context));
    }
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    return result != ALP_OK;
}
