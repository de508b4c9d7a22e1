// SPDX-License-Identifier: MIT
// Between the files that write the OBJ that was read with its bake.
#ifndef ALPI_FORMATS_OBJ_PATCH_H
#define ALPI_FORMATS_OBJ_PATCH_H

#include "formats/obj/obj_write.h"

/// A coordinate that is written: a new one, or an old one by its number.
typedef struct alpi_obj_uv_key {
    uint32_t is_old;
    uint32_t value[2]; // bits of u and v; or the number and 0
} alpi_obj_uv_key;

typedef struct alpi_obj_patcher {
    alpi_obj_writer *w;
    const alpi_obj_source *source;
    alpi_obj_text text;
    const char *copied;      // the source up to here is written
    bool replaces;           // coordinates are new
    bool has_library;        // the text has an mtllib
    bool library_named;      // … and was written
    alpi_bytes *out;         // the OBJ, or `run` behind its first face
    alpi_bytes run;          // faces without other statements between them
    alpi_json_span *old_uvs; // [old_uv_count] place of each vt
    size_t old_uv_capacity;
    uint32_t old_uv_count, uvs_so_far; // of the source; of them before `text`
    uint32_t normal_count;             // of the source
    alpi_obj_names uvs;                // alpi_obj_uv_key as bytes: those that are written
    uint32_t face;                     // the next
    bool is_named;                     // a material was named in the output
    alpi_obj_use current;              // that one
    bool *material_used;               // [materials of the scene]
    alpi_obj_word *words;              // corners of the face
    uint32_t *numbers;                 // [words] of the coordinates, 0 = none
    alpi_obj_uv_key *keys;             // [words]
    bool *known;                       // [words] has a key
    uint32_t *vertices;                // [words] of the scene, of one of the triangles there
    size_t word_capacity, number_capacity, key_capacity, known_capacity, vertex_capacity;
    uint32_t word_count, divided;
} alpi_obj_patcher;

/// Writes the source up to a place.
void alpi_obj_copy_up_to(alpi_obj_patcher *p, const char *end);
/// Begin of the line of a statement.
const char *alpi_obj_line_begin(const alpi_obj_patcher *p, const char *at);
/// A statement that names the material of the next face, where it is not the current one.
alp_result alpi_obj_name_material(alpi_obj_patcher *p, alpi_obj_use use);

/// Material and page of a face by its first triangle with area. *flat: it has none.
alpi_obj_use alpi_obj_use_of_face(const alpi_obj_patcher *p, uint32_t face, uint32_t triangles,
                                  bool *flat);
/// The words of a statement, without numbers.
alp_result alpi_obj_take_words(alpi_obj_patcher *p);
/// The same with the numbers that were found for them.
void alpi_obj_print_words(alpi_obj_patcher *p);
/// A statement f.
alp_result alpi_obj_patch_face(alpi_obj_patcher *p, const char *keyword);

#endif
