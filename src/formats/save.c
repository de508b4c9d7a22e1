// SPDX-License-Identifier: MIT
// Which writer the name of a baked scene asks for.
#include "base/file.h"
#include "formats/formats.h"

alp_result alpi_scene_write_patched(const alp_scene *scene, const alpi_mesh_patch *patch,
                                    const char *path, bool overwrite)
{
    return alpi_path_has_ending(path, ".obj")
               ? alpi_obj_write_patched(scene, patch, path, overwrite)
           : alpi_path_has_ending(path, ".dae")
               ? alpi_collada_write_patched(scene, patch, path, overwrite)
               : alpi_gltf_write_patched(scene, patch, path, overwrite);
}

alp_result alpi_scene_check_outputs(const alp_scene *scene, const alpi_gltf_images *images,
                                    const char *path, bool overwrite)
{
    return alpi_path_has_ending(path, ".obj")
               ? alpi_obj_check_outputs(scene, images, path, overwrite)
           : alpi_path_has_ending(path, ".dae")
               ? alpi_collada_check_outputs(scene, images, path, overwrite)
               : alpi_gltf_check_outputs(scene, images, path, overwrite);
}
