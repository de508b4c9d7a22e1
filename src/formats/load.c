// SPDX-License-Identifier: MIT
// alp_scene_load: which reader a path or a file's first bytes ask for.
#include "base/file.h"
#include "formats/formats.h"

#include <string.h>
#include <unistd.h>

/// Refuses files of other programs by their ending, with the format to export instead. A file that
/// is not there is left to the reader.
static alp_result refuse_foreign(alp_context *context, const char *path)
{
    static const struct {
        const char *ending, *remedy;
    } foreign[] = {
        {".fbx", "export glTF (.glb) from its program, or import it into Blender and export that"},
        {".kmz", "it is a ZIP archive: unpack it and give the .dae in it, or export glTF (.glb)"},
        {".stl", "it has no materials and no texture coordinates; export glTF (.glb) or OBJ"},
        {".ply", "export glTF (.glb) or OBJ"},
        {".3mf", "export glTF (.glb) or OBJ"},
        {".3ds", "export glTF (.glb), COLLADA (.dae) or OBJ"},
        {".usdz", "export glTF (.glb), or import it into Blender and export that"},
        {".usda", "export glTF (.glb), or import it into Blender and export that"},
        {".usdc", "export glTF (.glb), or import it into Blender and export that"},
        {".usd", "export glTF (.glb), or import it into Blender and export that"},
        {".abc", "export glTF (.glb), or import it into Blender and export that"},
        {".blend", "open it in Blender and export glTF (.glb)"},
        {".max", "export glTF (.glb) from 3ds Max"},
        {".ma", "export glTF (.glb) or COLLADA (.dae) from Maya"},
        {".mb", "export glTF (.glb) or COLLADA (.dae) from Maya"},
        {".c4d", "export glTF (.glb) from Cinema 4D"},
        {".skp", "export glTF (.glb) or COLLADA (.dae) from SketchUp"},
        {".dwg",
         "it is a drawing of AutoCAD; export glTF (.glb) or OBJ from a program that reads it"},
        {".dxf",
         "it is a drawing of AutoCAD; export glTF (.glb) or OBJ from a program that reads it"},
        {".ifc", "export glTF (.glb) or OBJ from its program, or by IfcConvert"},
        {".rvt", "export glTF (.glb) or OBJ from Revit"},
        {".3dm", "export glTF (.glb) or OBJ from Rhino"},
        {".zip", "it is an archive: unpack it and give the scene in it"},
        {".7z", "it is an archive: unpack it and give the scene in it"},
        {".rar", "it is an archive: unpack it and give the scene in it"},
        {".x3d", "export glTF (.glb) or COLLADA (.dae)"},
        {".wrl", "export glTF (.glb) or COLLADA (.dae)"},
        {".step", "it has surfaces and no triangles; export glTF (.glb) or OBJ from its program"},
        {".stp", "it has surfaces and no triangles; export glTF (.glb) or OBJ from its program"},
        {".mtl", "it has materials alone; give the .obj that names it"},
        {".bin", "it has buffers alone; give the .gltf that names it"},
        {".png", "it is a picture; give a scene"},
        {".jpg", "it is a picture; give a scene"},
        {".exr", "it is a picture; give a scene"},
        {".hdr", "it is a picture; give a scene, and this one by --sky"}};
    for (size_t i = 0; i < sizeof foreign / sizeof *foreign; i++) {
        if (alpi_path_has_ending(path, foreign[i].ending) && access(path, F_OK) == 0) {
            return alpi_fail(context, ALP_ERROR_UNSUPPORTED,
                             "%s: %s files are not read, only .glb, .gltf, .obj, .dae and .zae; %s",
                             path, foreign[i].ending, foreign[i].remedy);
        }
    }
    return ALP_OK;
}

alp_result alp_scene_load(alp_context *context, const char *path, alp_scene **scene)
{
    static const char builtin[] = "builtin:";
    if (scene != NULL) {
        *scene = NULL;
    }
    if (context == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    if (path == NULL || scene == NULL || path[0] == '\0') {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "alp_scene_load needs a path and an output pointer");
    }
    if (strncmp(path, builtin, sizeof builtin - 1) == 0) {
        return alpi_builtin_create(context, path + sizeof builtin - 1, scene);
    }
    if (alpi_path_has_ending(path, ".dae") || alpi_path_has_ending(path, ".zae")) {
        return alpi_collada_read_scene(context, path, scene);
    }
    if (alpi_path_has_ending(path, ".obj")) {
        return alpi_obj_read_scene(context, path, scene);
    }
    ALP_TRY(refuse_foreign(context, path));
    return alpi_gltf_read_scene(context, path, scene); // .glb and .gltf are told apart by content
}

alp_result alp_scene_load_choice(alp_context *context, const char *path, const char *choice,
                                 alp_scene **scene)
{
    static const char *const of_one[] = {".dae", ".zae", ".obj"};
    if (choice == NULL || context == NULL || path == NULL || scene == NULL || path[0] == '\0') {
        return alp_scene_load(context, path, scene);
    }
    *scene = NULL;
    bool one = strncmp(path, "builtin:", 8) == 0;
    for (size_t i = 0; i < sizeof of_one / sizeof *of_one; i++) {
        one |= alpi_path_has_ending(path, of_one[i]);
    }
    if (one) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "%s: has one scene; \"%.100s\" can be chosen only in a .gltf or .glb",
                         path, choice);
    }
    return alpi_gltf_read_choice(context, path, choice, scene);
}
