// SPDX-License-Identifier: MIT
// alp_scene_load: which reader a path or a file's first bytes ask for.
#include "base/file.h"
#include "formats/formats.h"

#include <string.h>

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
                         "alp_scene_load needs a path and an output pointer");
    }
    if (strncmp(path, builtin, sizeof builtin - 1) == 0) {
        return alpi_builtin_create(context, path + sizeof builtin - 1, scene);
    }
    if (alpi_path_has_ending(path, ".dae") || alpi_path_has_ending(path, ".zae")) {
        return alpi_collada_read_scene(context, path, scene);
    }
    if (alpi_path_has_ending(path, ".obj")) {
        return alpi_obj_read_scene(context, path, scene);
    }
    return alpi_gltf_read_scene(context, path, scene); // .glb and .gltf are told apart by content
}

alp_result alp_scene_load_choice(alp_context *context, const char *path, const char *choice,
                                 alp_scene **scene)
{
    static const char *const of_one[] = {".dae", ".zae", ".obj"};
    if (choice == NULL || context == NULL || path == NULL || scene == NULL || path[0] == '\0') {
        return alp_scene_load(context, path, scene);
    }
    *scene = NULL;
    bool one = strncmp(path, "builtin:", 8) == 0;
    for (size_t i = 0; i < sizeof of_one / sizeof *of_one; i++) {
        one |= alpi_path_has_ending(path, of_one[i]);
    }
    if (one) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "%s: has one scene; \"%.100s\" can be chosen only in a .gltf or .glb",
                         path, choice);
    }
    return alpi_gltf_read_choice(context, path, choice, scene);
}
