// SPDX-License-Identifier: MIT
// A glTF file in, the same file with its occlusion baked out; with progress and messages.
//
//     cc 02_bake_a_file.c -o bake $(pkg-config --cflags --libs alpenglow)
//     ./bake scene.glb baked.glb
#include <alpenglow/alpenglow.h>
#include <stdio.h>
#include <string.h>

/// Notes and warnings arrive here; they have a stable code, so a program can sort them.
static void print_message(void *user, const alp_log_message *message)
{
    (void)user;
    fprintf(stderr, "%s [%s] %s: %s\n", message->level == ALP_LOG_WARNING ? "warning" : "note",
            message->code, message->object, message->text);
}

/// Called about 20 times a second. Returning false would stop the bake within 100 ms.
static bool print_progress(void *user, const alp_progress *progress)
{
    const char **last_stage = user;
    if (*last_stage == NULL || strcmp(*last_stage, progress->stage) != 0) {
        fprintf(stderr, "stage %s\n", progress->stage);
        *last_stage = progress->stage;
    }
    return true;
}

static alp_result bake(const alp_scene *scene, const char *output)
{
    const char *last_stage = NULL;
    alp_bake_report report;
    alp_bake_options options = alp_bake_options_default();
    options.atlas.size = 256;        // texels along a page
    options.occlusion.samples = 128; // rays of a texel
    options.output = output;
    options.overwrite = true;
    options.progress = print_progress;
    options.progress_user = &last_stage;
    alp_result result = alp_bake(scene, &options, NULL, &report);
    if (result == ALP_OK) {
        printf("%s: %llu texels, %llu rays, mean accessibility %.4f, %.2f s\n", output,
               (unsigned long long)report.atlas.texels, (unsigned long long)report.rays,
               report.ao_mean, report.seconds_total);
    }
    return result;
}

int main(int count, char **words)
{
    if (count != 3) {
        fprintf(stderr, "usage: %s SCENE.glb|SCENE.gltf OUT.glb\n", words[0]);
        return 2;
    }
    alp_context *context = NULL;
    alp_scene *scene = NULL;
    alp_context_options options = alp_context_options_default();
    options.log = print_message;
    alp_result result = alp_context_create(&options, &context);
    if (result == ALP_OK) {
        result = alp_scene_load(context, words[1], &scene);
    }
    if (result == ALP_OK) {
        result = bake(scene, words[2]);
    }
    if (result != ALP_OK) { // the message names file, object and fault, and what to do
        fprintf(stderr, "%s: %s\n", alp_result_name(result),
                context ? alp_context_message(context) : "no context");
    }
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    return result == ALP_OK ? 0 : 1;
}
