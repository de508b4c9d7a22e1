// SPDX-License-Identifier: MIT
#include "bake/files/own_files.h"

#include "base/file.h"
#include "formats/formats.h"

#include <string.h>

/// The path of the asset up to its last dot: names of the maps that a bake puts beside it begin so.
static char *copy_stem(const alp_scene *scene)
{
    const char *dot = strrchr(alpi_path_name(scene->name), '.');
    return alpi_format(scene->context, "%.*s.",
                       (int)(dot != NULL ? (size_t)(dot - scene->name) : strlen(scene->name)),
                       scene->name);
}

alp_result alpi_bake_guard(const alpi_bake_job *job, alpi_guard *guard)
{
    const alp_scene *scene = job->scene;
    const char *output = job->options.output;
    *guard = (alpi_guard){0};
    char *stem = NULL;
    if (output != NULL && alpi_is_one_file(output, scene->name) && alpi_scene_is_ours(scene)) {
        stem = copy_stem(scene);
        if (stem == NULL) {
            return ALP_ERROR_OUT_OF_MEMORY;
        }
    }
    const alp_result result = alpi_scene_guard_files(scene, stem, guard);
    alpi_release(job->context, stem);
    *alpi_context_guard(job->context) = guard;
    return result;
}

void alpi_bake_unguard(const alpi_bake_job *job, alpi_guard *guard)
{
    *alpi_context_guard(job->context) = NULL;
    alpi_guard_destroy(job->context, guard);
}
