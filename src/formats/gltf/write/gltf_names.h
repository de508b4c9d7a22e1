// SPDX-License-Identifier: MIT
// Names of the files that a written glTF refers to.
#ifndef ALPI_FORMATS_GLTF_NAMES_H
#define ALPI_FORMATS_GLTF_NAMES_H

#include "formats/files/output_files.h"
#include "formats/gltf/gltf_document.h"
#include "scene/mesh_patch.h"

/// Names of the files beside a written .gltf, chosen so that none is one which the document uses.
typedef struct alpi_gltf_names {
    char *bin, *data; // paths: what was the BIN chunk, what the bake adds
    char **pages;     // paths of occlusion, then packed, then light
    char *bin_uri, *data_uri;
    char **page_uris; // the same as the asset refers to them
    alpi_output_images images;
} alpi_gltf_names;
/// Of a .gltf, or of the light beside a .glb.
alp_result alpi_gltf_names_create(alp_context *context, const alpi_gltf_document *document,
                                  const char *path, const alpi_output_images *images,
                                  alpi_gltf_names *names);
/// The images that a patch brings to a file of this kind.
alpi_output_images alpi_gltf_patch_images(const alpi_mesh_patch *patch, bool to_glb);
void alpi_gltf_names_destroy(alp_context *context, alpi_gltf_names *names);

#endif
