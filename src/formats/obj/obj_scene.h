// SPDX-License-Identifier: MIT
// OBJ → scene, and baked scene → OBJ.
#ifndef ALPI_FORMATS_OBJ_SCENE_H
#define ALPI_FORMATS_OBJ_SCENE_H

#include "formats/files/output_files.h"
#include "scene/mesh_patch.h"
#include "scene/scene.h"

/// Reads an .obj and its material libraries into a scene. No unit is stated: metres are taken.
alp_result alpi_obj_read_scene(alp_context *context, const char *path, alp_scene **scene);

/// Notes the statements in a scene's material libraries that glTF has no place for, each kind once.
/// Nothing for a scene of another format.
alp_result alpi_obj_note_losses(const alp_scene *scene);

/// Writes a scene with the patch as OUT.obj, OUT.mtl and pictures. A scene read from an OBJ is
/// written as the text that was read, with coordinates and maps of the bake; any other in world
/// space, triangles without area left out, its pictures as OUT.image.png. Baked coordinates take
/// the place of vt, and textures that need others are left out with a warning; with kept ones both
/// stay. Occlusion: map_Ka, and map_Kd where that is free; light: Kd 0, Ke and map_Ke (other forms,
/// values at vertices and packed images are UNSUPPORTED).
alp_result alpi_obj_add_patched(const alp_scene *scene, const alpi_mesh_patch *patch,
                                const char *path, alpi_file_set *files);
/// Every file that it would make is checked before the long work.
alp_result alpi_obj_check_outputs(const alp_scene *scene, const alpi_output_images *images,
                                  const char *path, bool overwrite);

#endif
