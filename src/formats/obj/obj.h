// SPDX-License-Identifier: MIT
// Between the files that read and write OBJ and MTL (B. Reddy's description of Wavefront's
// "Advanced Visualizer" appendix B1, and the PBR-free part of its material library).
//
//   obj_text.c       lines, words, numbers
//   obj_names.c      texts with numbers
//   obj_read.c       statements of an OBJ → alpi_obj
//   obj_mesh.c       alpi_obj → surfaces, vertices, triangles of a scene
//   obj_materials.c  MTL files → materials of a scene
//   obj_images.c     the pictures that they name
//   obj_pictures.c   their names, kept for those that are read later
//   obj_write.c      a scene with its bake → OBJ
//   obj_write_mtl.c  its MTL and pictures
#ifndef ALPI_FORMATS_OBJ_H
#define ALPI_FORMATS_OBJ_H

#include "formats/obj/obj_names.h"
#include "formats/obj/obj_text.h"
#include "scene/scene.h"

/// A face: its corners end where those of the next begin.
typedef struct alpi_obj_face {
    uint32_t first_corner;
    uint32_t surface;
    uint32_t line; // for messages; the last 32 bits
} alpi_obj_face;

/// What is alike in object, group and material becomes one surface.
typedef struct alpi_obj_surface {
    uint32_t object;   // number of its name
    uint32_t material; // number in material_names, ALPI_NONE = none
} alpi_obj_surface;

/// An OBJ as it stands.
typedef struct alpi_obj {
    alp_context *context;
    const char *path;
    char *folder;           // with a slash, or ""
    double (*positions)[3]; // of the file; each rounds to the float nearest to its digits
    float (*normals)[3];
    float (*uvs)[2];        // v = 0 at the top, as everywhere in the scene
    uint32_t (*corners)[3]; // position, uv, normal: from 0, ALPI_NONE = not given
    alpi_obj_face *faces;   // [face_count + 1], the last only ends the corners
    alpi_obj_surface *surfaces;
    uint32_t position_count, normal_count, uv_count, corner_count, face_count, surface_count;
    size_t position_capacity, normal_capacity, uv_capacity, corner_capacity, face_capacity,
        surface_capacity;
    alpi_obj_names objects;        // of surfaces
    alpi_obj_names material_names; // of usemtl
    alpi_obj_names libraries;      // of mtllib, in their order
    uint64_t hash;
} alpi_obj;

/// Reads the statements of a file; destroy also after a failure.
alp_result alpi_obj_parse(alp_context *context, const char *path, const uint8_t *bytes, size_t size,
                          alpi_obj *obj);
void alpi_obj_destroy(alpi_obj *obj);

/// A scene from an OBJ whose bytes are there; textures and libraries are read beside `path`.
alp_result alpi_obj_scene_from_bytes(alp_context *context, const char *path, const uint8_t *bytes,
                                     size_t size, alp_scene **scene);

/// Surfaces, vertices and triangles. scene_materials[m] = the scene's material of material_names m.
alp_result alpi_obj_fill_meshes(const alpi_obj *obj, const uint32_t *scene_materials,
                                alp_scene *scene);

/// Reads the libraries: the scene's materials, and which of them each of material_names is
/// (ALPI_NONE and a warning where there is none such). Their bytes go into obj->hash; pictures that
/// they name into `images`, as paths within the asset's folder. *scene_materials is released by
/// the caller.
alp_result alpi_obj_read_materials(alpi_obj *obj, alp_scene *scene, alpi_obj_names *images,
                                   uint32_t **scene_materials);

/// Path within the asset's folder of a file that a library in `folder` (within it) names, with
/// slashes and without "." and ".."; NULL in *path where it leaves the folder, released by the
/// caller. Where assets may name files outside it may begin with "../" or "/".
alp_result alpi_obj_resolve(alp_context *context, const char *folder, alpi_obj_word name,
                            char **path);
/// From the working folder; released by the caller.
char *alpi_obj_path(const alpi_obj *obj, const char *inner);

/// Decodes the pictures that materials of surfaces use for light.
alp_result alpi_obj_read_images(const alpi_obj *obj, const alpi_obj_names *images,
                                alp_scene *scene);
/// One of them; NULL, with a warning, where it cannot be read. @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_obj_read_image(const alpi_obj *obj, const char *name, alp_image **image);
/// Keeps their names and the folder with a scene that has normal maps, for alpi_obj_read_picture.
/// It takes both over then.
alp_result alpi_obj_keep_pictures(alpi_obj *obj, alpi_obj_names *images, alp_scene *scene);

#endif
