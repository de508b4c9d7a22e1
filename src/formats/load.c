// SPDX-License-Identifier: MIT
// alp_scene_load: which reader a path or a file's first bytes ask for.
#include "base/file.h"
#include "formats/formats.h"

#include <string.h>

static alp_result refuse_kind(alp_context *context, const char *path, const char *kind)
{
    return alpi_fail(context, ALP_ERROR_UNSUPPORTED,
                     "%s: reading %s files is not built yet; convert it to .glb or .gltf", path,
                     kind);
}

alp_result alp_scene_load(alp_context *context, const char *path, alp_scene **scene)
{
    static const char builtin[] = "builtin:";
    if (scene != NULL) {
        *scene = NULL;
    }
    if (context == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    if (path == NULL || scene == NULL || path[0] == '\0') {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "alp_scene_load needs a path and a place for the scene");
    }
    if (strncmp(path, builtin, sizeof builtin - 1) == 0) {
        return alpi_builtin_create(context, path + sizeof builtin - 1, scene);
    }
    if (alpi_path_has_ending(path, ".dae") || alpi_path_has_ending(path, ".zae")) {
        return alpi_collada_read_scene(context, path, scene);
    }
    if (alpi_path_has_ending(path, ".obj")) {
        return refuse_kind(context, path, "OBJ");
    }
    return alpi_gltf_read_scene(context, path, scene); // .glb and .gltf are told apart by content
}
