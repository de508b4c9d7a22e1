// SPDX-License-Identifier: MIT
// Files that the asset of a scene names, and that no bake overwrites.
#include "test_obj.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static const char floor_obj[] = "mtllib sub/room.mtl\nv 0 0 0\nv 1 0 0\nv 0 0 1\nusemtl wall\n"
                                "f 1 3 2\n";

static const char floor_dae[] =
    "<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">"
    "<asset><unit meter=\"1\"/><up_axis>Y_UP</up_axis></asset><library_images><image id=\"i\">"
    "<init_from>./wood%2egrey.png</init_from></image></library_images><library_geometries>"
    "<geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"a\" count=\"9\">0 0 0 0 0 1 1 0 0"
    "</float_array><technique_common><accessor source=\"#a\" count=\"3\" stride=\"3\">"
    "<param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/>"
    "<param name=\"Z\" type=\"float\"/></accessor></technique_common></source><vertices id=\"v\">"
    "<input semantic=\"POSITION\" source=\"#p\"/></vertices><triangles count=\"1\">"
    "<input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 2</p></triangles></mesh>"
    "</geometry></library_geometries><library_visual_scenes><visual_scene id=\"s\"><node>"
    "<instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes>"
    "<scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>";

static const char floor_gltf[] =
    "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
    "\"images\":[{\"uri\":\"wood.grey.png\"}],"
    "\"buffers\":[{\"uri\":\"sub/room.bin\",\"byteLength\":36}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,"
    "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,0,1]}]}";

static void write_picture(alp_context *context, const char *path)
{
    alp_image *image = NULL;
    ASSERT_OK(context,
              alp_image_create(context, (alp_image_info){1, 1, 3, ALP_COMPONENT_U8}, &image));
    ASSERT_OK(context, alp_image_save(image, path, true));
    alp_image_destroy(image);
}

/// The three scenes with their files in one folder, and a file that none of them names.
static const char *make_folder(alp_context *context)
{
    static const float corners[3][3] = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
    const char *folder = test_folder();
    mkdir(test_path(folder, "sub"), 0777);
    test_write_text(test_path(folder, "floor.obj"), floor_obj);
    test_write_text(test_path(folder, "floor.dae"), floor_dae);
    test_write_text(test_path(folder, "floor.gltf"), floor_gltf);
    test_write_text(test_path(folder, "sub/room.mtl"), "newmtl wall\nmap_Kd ../wood.grey.png\n");
    FILE *file = fopen(test_path(folder, "sub/room.bin"), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(corners, sizeof corners, 1, file), 1);
    assert_int_equal(fclose(file), 0);
    write_picture(context, test_path(folder, "wood.grey.png"));
    write_picture(context, test_path(folder, "other.png"));
    return folder;
}

TEST_WITH_CONTEXT(scenes_refer_to_their_files, 1)
{
    static const struct {
        const char *scene;
        bool mtl, bin;
    } cases[] = {
        {"floor.obj", true, false}, {"floor.dae", false, false}, {"floor.gltf", false, true}};
    const char *folder = make_folder(context);
    assert_int_equal(symlink("wood.grey.png", test_path(folder, "link.png")), 0);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_scene *scene = test_load(context, test_path(folder, cases[i].scene));
        assert_true(alp_scene_refers_to(scene, test_path(folder, "wood.grey.png")));
        assert_true(alp_scene_refers_to(scene, test_path(folder, "sub/../link.png")));
        assert_int_equal(alp_scene_refers_to(scene, test_path(folder, "sub/room.mtl")),
                         cases[i].mtl);
        assert_int_equal(alp_scene_refers_to(scene, test_path(folder, "sub/room.bin")),
                         cases[i].bin);
        assert_false(alp_scene_refers_to(scene, test_path(folder, "other.png")));
        assert_false(alp_scene_refers_to(scene, test_path(folder, "absent.png")));
        assert_false(alp_scene_refers_to(scene, test_path(folder, cases[i].scene)));
        alp_scene_destroy(scene);
    }
    assert_false(alp_scene_refers_to(NULL, folder));
    alp_scene *builtin = test_load(context, "builtin:sphere-plane");
    assert_false(alp_scene_refers_to(builtin, test_path(folder, "other.png")));
    alp_scene_destroy(builtin);
}

/// The output "wood.obj" would need "wood.mtl"; here that is the library of the scene.
TEST_WITH_CONTEXT(a_bake_spares_them_even_by_force, 1)
{
    const char *folder = make_folder(context);
    assert_int_equal(rename(test_path(folder, "sub/room.mtl"), test_path(folder, "wood.mtl")), 0);
    test_write_text(test_path(folder, "floor.obj"),
                    "mtllib wood.mtl\nv 0 0 0\nv 1 0 0\nv 0 0 1\nusemtl wall\nf 1 3 2\n");
    alp_scene *scene = test_load(context, test_path(folder, "floor.obj"));
    alp_bake_options options = alp_bake_options_default();
    options.atlas.size = 8;
    options.occlusion.samples = 4;
    options.overwrite = true;
    options.output = test_path(folder, "wood.obj");
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_IO);
    assert_non_null(strstr(alp_context_message(context), "wood.mtl: is a file that the scene"));
    size_t size = 0;
    unsigned char *text = test_read_file(test_path(folder, "wood.mtl"), &size);
    assert_memory_equal(text, "newmtl wall", 11);
    free(text);
    options.output = test_path(folder, "fine.obj");
    ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL));
    ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL)); // over its own files
    alp_scene_destroy(scene);
    write_picture(context, test_path(folder, "wood.grey.png")); // no guard stays behind
}

/// A scene that a bake wrote may be baked over itself: its maps and its library are that bake's.
TEST_WITH_CONTEXT(a_bake_replaces_its_own_output, 1)
{
    static const char *const names[] = {"again.obj", "again.gltf", "again.dae"};
    const char *folder = make_folder(context);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char source[32];
        snprintf(source, sizeof source, "floor%s", strchr(names[i], '.'));
        alp_bake_options options = alp_bake_options_default();
        options.atlas.size = 8;
        options.occlusion.samples = 4;
        options.overwrite = true;
        options.output = test_path(folder, names[i]);
        alp_scene *scene = test_load(context, test_path(folder, source));
        ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL));
        alp_scene_destroy(scene);
        scene = test_load(context, options.output);
        assert_true(alp_scene_refers_to(scene, test_path(folder, "again.ao.png")));
        ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL));
        alp_scene_destroy(scene);
    }
}
