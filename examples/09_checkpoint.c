// SPDX-License-Identifier: MIT
// A bake that outlives its process: started again, it goes on from the folder "kept", and ends with
// the bits of an undisturbed bake.
//
//     cc 09_checkpoint.c -o checkpoint $(pkg-config --cflags --libs alpenglow)
#include <alpenglow/alpenglow.h>
#include <signal.h>
#include <stdio.h>

static volatile sig_atomic_t stopping;

static void stop(int signal)
{
    (void)signal;
    stopping = 1;
}

/// Ends the bake when the process is told to stop. Its work is written then.
static bool go_on(void *user, const alp_progress *progress)
{
    (void)user;
    (void)progress;
    return !stopping;
}

int main(void)
{
    alp_context *context = NULL;
    alp_scene *scene = NULL;
    alp_bake_report report = {0};
    signal(SIGTERM, stop);
    alp_result result = alp_context_create(NULL, &context);
    if (result == ALP_OK) {
        result = alp_scene_load(context, "builtin:cornell", &scene);
    }
    if (result == ALP_OK) {
        alp_bake_options options = alp_bake_options_default();
        options.checkpoint.folder = "kept"; // a kill loses the work of at most 10 s
        options.output = "cornell.glb";
        options.overwrite = true;
        options.progress = go_on;
        result = alp_bake(scene, &options, NULL, &report);
    }
    if (result == ALP_OK) {
        printf("%llu tiles were traced, %llu read\n", (unsigned long long)report.tiles_run,
               (unsigned long long)report.tiles_read);
    } else {
        fprintf(stderr, "%s: %s\n", alp_result_name(result), alp_context_message(context));
    }
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    return result == ALP_OK ? 0 : result == ALP_ERROR_CANCELLED ? 75 : 1;
}
