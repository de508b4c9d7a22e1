// SPDX-License-Identifier: MIT
// Baked scene → glTF 2.0.
#ifndef ALPI_FORMATS_GLTF_WRITE_H
#define ALPI_FORMATS_GLTF_WRITE_H

#include "formats/files/output_files.h"
#include "scene/mesh_patch.h"
#include "scene/scene.h"

/// Writes the scene's document with the patch to `path` (.glb or .gltf by its ending). A scene that
/// came from no file is first exported to glTF. Its files are added to a set, the asset last.
alp_result alpi_gltf_add_patched(const alp_scene *scene, const alpi_mesh_patch *patch,
                                 const char *path, alpi_file_set *files);

/// Every file that alpi_gltf_add_patched would make for `path` is checked before the long work:
/// writable, not there already unless overwrite.
alp_result alpi_gltf_check_output(const alp_scene *scene, uint32_t page_count, const char *path,
                                  bool overwrite);
/// The same for a patch with other images than occlusion.
alp_result alpi_gltf_check_outputs(const alp_scene *scene, const alpi_output_images *images,
                                   const char *path, bool overwrite);

/// A scene without a document as GLB bytes: node i, mesh i, primitive 0 = surface i; materials and
/// cameras too (png.c encodes images). *bytes is released by the caller.
/// @param keeps_sets a second set equal to the first is written too, for a map that reads it
alp_result alpi_gltf_export_scene(const alp_scene *scene, bool keeps_sets, uint8_t **bytes,
                                  size_t *size);

#endif
