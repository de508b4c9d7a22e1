// SPDX-License-Identifier: MIT
// Bytes ↔ scene, image, patched scene. All untrusted input ends in this room. Other rooms include
// this header; the rest of the room includes the headers of its parts.
#ifndef ALPI_FORMATS_FORMATS_H
#define ALPI_FORMATS_FORMATS_H

#include "base/guard.h"
#include "formats/collada/collada_scene.h"
#include "formats/collada/write/collada_write.h"
#include "formats/gltf/gltf_scene.h"
#include "formats/gltf/write/gltf_write.h"
#include "formats/images/images.h"
#include "formats/obj/obj_scene.h"
#include "formats/probes/probe_format.h"
#include "formats/viewers/viewers.h"

/// Writes a baked scene by the ending of `path`: .obj, .dae, else glTF.
alp_result alpi_scene_add_patched(const alp_scene *scene, const alpi_mesh_patch *patch,
                                  const char *path, alpi_file_set *files);
/// As a set of its own: all files are put in place together.
alp_result alpi_scene_write_patched(const alp_scene *scene, const alpi_mesh_patch *patch,
                                    const char *path, bool overwrite);
alp_result alpi_scene_check_outputs(const alp_scene *scene, const alpi_output_images *images,
                                    const char *path, bool overwrite);

/// Adds the files that the asset names: buffers, pictures, material libraries (named_files.c). The
/// members of an archive are none. @param except paths that begin so stay out; NULL: none
alp_result alpi_scene_guard_files(const alp_scene *scene, const char *except, alpi_guard *guard);
/// Whether a bake wrote the asset.
bool alpi_scene_is_ours(const alp_scene *scene);

#endif
