// SPDX-License-Identifier: MIT
// Between the two files that write an OBJ.
#ifndef ALPI_FORMATS_OBJ_WRITE_H
#define ALPI_FORMATS_OBJ_WRITE_H

#include "formats/files/output_files.h"
#include "formats/obj/obj_names.h"
#include "formats/text/text_edits.h"
#include "scene/mesh_patch.h"
#include "scene/scene.h"

/// A material as it is written: of the scene, with a page or without.
typedef struct alpi_obj_use {
    uint32_t material; // ALPI_NONE = none
    uint32_t page;     // ALPI_NONE = no map
} alpi_obj_use;

typedef struct alpi_obj_writer {
    alp_context *context;
    const alp_scene *scene;
    const alpi_mesh_patch *patch;
    char *stem;         // path without its ending
    bool kept_is_first; // the kept set has the coordinates of set 0
    alpi_bytes obj, mtl;
    alpi_obj_names uses;             // alpi_obj_use as bytes, in the order of first use
    alpi_obj_names names;            // of the written materials: name i is that of use i
    bool *image_used, *texture_lost; // [image_count], [material_count]
    bool *page_used, *light_used;    // [page_count]
    uint64_t vertex_count, uv_count, normal_count; // written so far
} alpi_obj_writer;

/// Whether a page holds occlusion, or light, for a material (which may be ALPI_NONE).
bool alpi_obj_is_occluded(const alpi_obj_writer *writer, alpi_obj_use use);
bool alpi_obj_is_lit(const alpi_obj_writer *writer, alpi_obj_use use);

/// "STEM.KIND.png", "STEM.KIND.N.png"; released by the caller.
char *alpi_obj_image_path(alp_context *context, const char *stem, const char *kind, uint32_t number,
                          const char *ending);

/// The number of the written material that stands for a use; a new one is added to the MTL.
alp_result alpi_obj_write_material(alpi_obj_writer *writer, alpi_obj_use use, uint32_t *number);

/// Adds the pictures that the MTL names.
alp_result alpi_obj_add_images(alpi_obj_writer *writer, alpi_output_files *files);

#endif
