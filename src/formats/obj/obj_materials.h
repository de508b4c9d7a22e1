// SPDX-License-Identifier: MIT
// Between the files that read material libraries.
#ifndef ALPI_FORMATS_OBJ_MATERIALS_H
#define ALPI_FORMATS_OBJ_MATERIALS_H

#include "formats/files/find_file.h"
#include "formats/obj/obj.h"

/// While libraries are read.
typedef struct alpi_mtl_reader {
    alpi_obj *obj;
    alp_scene *scene;
    alpi_obj_names *images; // paths in the asset's folder
    alpi_obj_names names;   // of scene.materials
    alpi_obj_names read;    // paths of libraries, in the asset's folder: each is read once
    size_t capacity;        // of scene.materials
    char *folder;           // of the library, in the asset's
    bool skipping;          // a material that is there already
    bool has_color;         // the material said Kd
    bool has_emission;      // … and Ke
    bool has_opacity;       // … and d
    bool has_roughness;     // … and Pr
    bool occlusion;         // map_Ka holds occlusion (our own files mark it)
    float transparency;     // Tr
    float exponent;         // Ns, negative = none
    int model;              // illum
    alpi_texture mask;      // map_d
    uint32_t invisible;     // materials with Tr 1 and without d
} alpi_mtl_reader;

/// A texture statement behind its keyword.
typedef struct alpi_mtl_picture {
    alpi_texture texture; // wrap, scale and offset; no image
    float bump;           // -bm
    alpi_obj_word name;   // of the file, without quotes; size 0 = none
    alpi_obj_word place;  // with them
    char *path;           // in the asset's folder; NULL = outside, or none. Released by the caller
    alpi_found found;
} alpi_mtl_picture;

/// Takes options, the name and options behind it. The name may have blanks and quotes: the reading
/// is taken by which a file is there.
/// @param folder of the asset
/// @param from folder of the library in it
alp_result alpi_mtl_take_picture(alpi_obj_text *text, const char *folder, const char *from,
                                 alpi_mtl_picture *picture);

/// A word that may begin a number.
bool alpi_mtl_is_number(alpi_obj_word word);
/// A copy of a word for messages: UTF-8 without control characters.
void alpi_mtl_show(alpi_obj_word word, char text[128]);

/// Reads a statement of a library.
alp_result alpi_mtl_read_statement(alpi_mtl_reader *reader, alpi_obj_text *text);
/// Ends the last material: values that follow from several of its statements.
alp_result alpi_mtl_finish_material(alpi_mtl_reader *reader);

#endif
