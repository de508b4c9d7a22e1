// SPDX-License-Identifier: MIT
// Baked scene → COLLADA.
#ifndef ALPI_FORMATS_COLLADA_WRITE_H
#define ALPI_FORMATS_COLLADA_WRITE_H

#include "formats/files/output_files.h"
#include "scene/mesh_patch.h"
#include "scene/scene.h"

/// Writes the COLLADA document that a scene was read from, with the patch, to `path` (.dae), and
/// the maps beside it. @return also UNSUPPORTED (another scene, values at vertices, light that is
/// not emissive)
alp_result alpi_collada_add_patched(const alp_scene *scene, const alpi_mesh_patch *patch,
                                    const char *path, alpi_file_set *files);
/// Every file of it is checked before the long work.
alp_result alpi_collada_check_outputs(const alp_scene *scene, const alpi_output_images *images,
                                      const char *path, bool overwrite);

#endif
