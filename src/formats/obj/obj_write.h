// SPDX-License-Identifier: MIT
// Between the files that write an OBJ.
#ifndef ALPI_FORMATS_OBJ_WRITE_H
#define ALPI_FORMATS_OBJ_WRITE_H

#include "formats/files/output_files.h"
#include "formats/obj/obj.h"
#include "formats/text/text_edits.h"
#include "scene/mesh_patch.h"

/// A material as it is written: of the scene, with a page or without.
typedef struct alpi_obj_use {
    uint32_t material; // ALPI_NONE = none
    uint32_t page;     // ALPI_NONE = no map
} alpi_obj_use;

/// How a picture is written.
typedef enum alpi_obj_picture {
    ALPI_OBJ_PICTURE_WHOLE,
    ALPI_OBJ_PICTURE_ROUGHNESS, // its green
    ALPI_OBJ_PICTURE_METALNESS, // its blue
    ALPI_OBJ_PICTURE_COUNT
} alpi_obj_picture;

typedef struct alpi_obj_writer {
    alp_context *context;
    const alp_scene *scene;
    const alpi_mesh_patch *patch;
    char *stem;         // path without its ending
    bool kept_is_first; // the kept set has the coordinates of set 0
    alpi_bytes obj, mtl;
    alpi_obj_names uses;                      // alpi_obj_use as bytes, in the order of first use
    alpi_obj_names names;                     // of the written materials: name i is that of use i
    alp_image **images;                       // [image_count] pictures that were opened
    bool *image_used[ALPI_OBJ_PICTURE_COUNT]; // [image_count]
    bool *texture_lost;                       // [material_count]
    bool *page_used, *light_used;             // [page_count]
    uint64_t vertex_count, uv_count, normal_count; // written so far
    alpi_output_files *files;
} alpi_obj_writer;

/// Whether a page holds occlusion, or light, for a material (which may be ALPI_NONE).
bool alpi_obj_is_occluded(const alpi_obj_writer *writer, alpi_obj_use use);
bool alpi_obj_is_lit(const alpi_obj_writer *writer, alpi_obj_use use);

/// "STEM.KIND.png", "STEM.KIND.N.png"; released by the caller.
char *alpi_obj_image_path(alp_context *context, const char *stem, const char *kind, uint32_t number,
                          const char *ending);

/// The number of the written material that stands for a use; a new one is added to the MTL.
alp_result alpi_obj_write_material(alpi_obj_writer *writer, alpi_obj_use use, uint32_t *number);

/// The statements of a material behind its name, as the scene has it.
void alpi_obj_print_material(alpi_obj_writer *writer, alpi_obj_use use);
/// A picture of a page: "map_Ka OUT.ao.png".
void alpi_obj_print_page(alpi_obj_writer *writer, const char *what, const char *kind, uint32_t page,
                         const char *ending);
/// The statement of a texture where it can be written. @return whether it was
bool alpi_obj_print_texture(alpi_obj_writer *writer, alpi_obj_use use, const char *what,
                            const alpi_texture *texture, alpi_obj_picture picture);
/// Gloss and relief of a material.
void alpi_obj_print_shine(alpi_obj_writer *writer, alpi_obj_use use, const alpi_material *material);
void alpi_obj_print_color(alpi_obj_writer *writer, const char *what, const float color[3]);
/// Notes what an OBJ has no place for, each kind once.
void alpi_obj_note_scene_losses(const alp_scene *scene);
/// Warns of textures that were left out.
void alpi_obj_warn_of_textures(alpi_obj_writer *writer, const alpi_material *material);

/// "vt u v" of a coordinate with v = 0 at the top, with digits that bring it back.
void alpi_obj_print_uv(alpi_bytes *text, const float uv[2]);
/// Behind the lines that an earlier bake began a text with.
const char *alpi_obj_skip_header(const char *text, size_t size);

/// The OBJ that a scene was read from, with its bake: every statement stays but those of the bake.
alp_result alpi_obj_patch(alpi_obj_writer *writer, const alpi_obj_source *source);
/// The libraries of the scene as one, with copies of their pictures. After all uses are known.
alp_result alpi_obj_patch_libraries(alpi_obj_writer *writer, const alpi_obj_source *source);
/// Checks the places of these copies.
alp_result alpi_obj_check_copies(const alp_scene *scene, const char *path, bool overwrite);

/// Adds the maps, and pictures of the scene that the MTL names.
alp_result alpi_obj_add_images(alpi_obj_writer *writer, alpi_output_files *files);

#endif
