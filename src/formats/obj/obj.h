// SPDX-License-Identifier: MIT
// Between the files that read and write OBJ and MTL (B. Reddy's description of Wavefront's
// "Advanced Visualizer" appendix B1, and the PBR-free part of its material library).
//
//   obj_text.c       lines, words, numbers
//   obj_names.c      texts with numbers
//   obj_read.c       statements of an OBJ → alpi_obj
//   obj_mesh.c       alpi_obj → surfaces, vertices, triangles of a scene
//   obj_libraries.c  MTL files, and which of them has a material
//   obj_materials.c  their statements → materials of a scene
//   obj_textures.c   texture statements: options and the name of the file
//   obj_images.c     the pictures that they name
//   obj_losses.c     statements that glTF has no place for
//   obj_source.c     the texts as read, kept with the scene for the writer
//   obj_scene.c      all of these in their order
//   obj_write.c      any scene with its bake → OBJ
//   obj_write_mtl.c  its MTL and pictures
//   obj_write_shine.c  gloss and relief in it
//   obj_patch.c      the OBJ that was read, with its bake
//   obj_patch_faces.c  faces with new coordinates in it
//   obj_patch_mtl.c  its libraries as one, and the files that they name
#ifndef ALPI_FORMATS_OBJ_H
#define ALPI_FORMATS_OBJ_H

#include "formats/obj/obj_names.h"
#include "formats/obj/obj_text.h"
#include "scene/scene.h"

/// An index that was negative where there was nothing before it.
#define ALPI_OBJ_BEFORE_FIRST (ALPI_NONE - 1)

/// A face: its corners end where those of the next begin.
typedef struct alpi_obj_face {
    uint32_t first_corner;
    uint32_t surface;
    uint32_t line; // for messages; the last 32 bits
} alpi_obj_face;

/// Faces of one object, group and material become one surface.
typedef struct alpi_obj_surface {
    uint32_t object;   // number of its name
    uint32_t material; // number in material_names, ALPI_NONE = none
} alpi_obj_surface;

/// A text of a file, as UTF-8.
typedef struct alpi_obj_file {
    char *name;     // of a library: its path within the asset's folder; of the OBJ itself NULL
    char *folder;   // of a library within the asset's: with a slash, or ""; of the OBJ itself NULL
    uint8_t *bytes; // what is released
    const char *text; // behind a byte-order mark
    size_t size;
} alpi_obj_file;

/// The statements of an OBJ.
typedef struct alpi_obj {
    alp_context *context;
    const char *path;
    char *folder;           // with a slash, or ""
    double (*positions)[3]; // of the file; each rounds to the float nearest to its digits
    float (*colors)[3];     // [position_count] in the numbers of the file; NULL: it has none
    float (*normals)[3];
    float (*uvs)[2];        // v = 0 at the top, as everywhere in the scene
    uint32_t (*corners)[3]; // position, uv, normal: from 0, ALPI_NONE = not given
    alpi_obj_face *faces;   // [face_count + 1], the last only ends the corners
    alpi_obj_surface *surfaces;
    uint32_t position_count, normal_count, uv_count, corner_count, face_count, surface_count;
    size_t position_capacity, color_capacity, normal_capacity, uv_capacity, corner_capacity,
        face_capacity, surface_capacity;
    alpi_obj_names objects;        // of surfaces
    alpi_obj_names material_names; // of usemtl
    alpi_obj_names libraries;      // of mtllib, in their order
    alpi_obj_names materials;      // of the scene, by their names in the libraries
    alpi_obj_file *read_libraries;
    uint32_t read_library_count;
    size_t read_library_capacity;
    uint32_t *face_triangles;        // [face_count] first triangle of the scene
    uint32_t (*triangle_corners)[3]; // [triangles] corners of the face; NULL: all faces have three
    uint64_t hash;
} alpi_obj;

/// An OBJ with its libraries, kept with its scene (ALPI_ATTACHMENT_OBJ).
typedef struct alpi_obj_source {
    char *folder;          // of the asset
    alpi_obj_file file;    // its text
    alpi_obj_names images; // paths within the folder: name i is that of image i of the scene
    alpi_obj_names materials;
    alpi_obj_file *libraries;
    uint32_t library_count, face_count;
    uint32_t *face_triangles;
    uint32_t (*triangle_corners)[3];
} alpi_obj_source;

/// Takes over the bytes of a file, also on failure; UTF-16 becomes UTF-8.
alp_result alpi_obj_file_take(alp_context *context, uint8_t *bytes, size_t size,
                              alpi_obj_file *file);
void alpi_obj_file_destroy(alp_context *context, alpi_obj_file *file);

/// Reads the statements of a text; destroy also after a failure.
alp_result alpi_obj_parse(alp_context *context, const char *path, const char *text, size_t size,
                          alpi_obj *obj);
void alpi_obj_destroy(alpi_obj *obj);

/// A scene from an OBJ whose bytes are there; textures and libraries are read beside `path`.
alp_result alpi_obj_scene_from_bytes(alp_context *context, const char *path, const uint8_t *bytes,
                                     size_t size, alp_scene **scene);

/// Surfaces, vertices and triangles; and which of them each face became. scene_materials[m] = the
/// scene's material of material_names m.
alp_result alpi_obj_fill_meshes(alpi_obj *obj, const uint32_t *scene_materials, alp_scene *scene);

/// Reads the libraries: the scene's materials, and which of them each of material_names is
/// (ALPI_NONE and a warning where there is none such). Their bytes go into obj->hash; pictures that
/// they name into `images`, as paths within the asset's folder. *scene_materials is released by
/// the caller.
alp_result alpi_obj_read_materials(alpi_obj *obj, alp_scene *scene, alpi_obj_names *images,
                                   uint32_t **scene_materials);

/// From the working folder; released by the caller.
char *alpi_obj_path(const alpi_obj *obj, const char *inner);

/// Decodes the pictures that materials of surfaces use for light.
alp_result alpi_obj_read_images(const alpi_obj *obj, const alpi_obj_names *images,
                                alp_scene *scene);
/// One of them; NULL, with a warning, where it cannot be read. @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_obj_read_image(const alpi_obj *obj, const char *name, alp_image **image);

/// Moves what the writer needs out of the OBJ to its scene: `file`, `images`, libraries.
alp_result alpi_obj_keep_source(alpi_obj *obj, alpi_obj_file *file, alpi_obj_names *images,
                                alp_scene *scene);
/// The source of a scene; NULL: it comes from no OBJ.
const alpi_obj_source *alpi_obj_source_of(const alp_scene *scene);

#endif
