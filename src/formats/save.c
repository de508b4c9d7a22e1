// SPDX-License-Identifier: MIT
// Which writer the name of a baked scene asks for.
#include "formats/formats.h"

alp_result alpi_scene_add_patched(const alp_scene *scene, const alpi_mesh_patch *patch,
                                  const char *path, alpi_file_set *files)
{
    if (alpi_path_has_ending(path, ".dae")) {
        return alpi_collada_add_patched(scene, patch, path, files);
    }
    alpi_collada_tell_losses(scene);
    if (alpi_path_has_ending(path, ".obj")) {
        return alpi_obj_add_patched(scene, patch, path, files);
    }
    ALP_TRY(alpi_obj_note_losses(scene));
    return alpi_gltf_add_patched(scene, patch, path, files);
}

alp_result alpi_scene_write_patched(const alp_scene *scene, const alpi_mesh_patch *patch,
                                    const char *path, bool overwrite)
{
    alpi_file_set files = alpi_file_set_create(scene->context, overwrite);
    return alpi_file_set_end(&files, alpi_scene_add_patched(scene, patch, path, &files));
}

alp_result alpi_scene_check_outputs(const alp_scene *scene, const alpi_output_images *images,
                                    const char *path, bool overwrite)
{
    return alpi_path_has_ending(path, ".obj")
               ? alpi_obj_check_outputs(scene, images, path, overwrite)
           : alpi_path_has_ending(path, ".dae")
               ? alpi_collada_check_outputs(scene, images, path, overwrite)
               : alpi_gltf_check_outputs(scene, images, path, overwrite);
}
