// SPDX-License-Identifier: MIT
// Scenes with coordinates of a national grid: read in double, baked as near the origin, and written
// with the digits of their file.
#include "test_obj.h"
#include "test_scenes.h"

#include "base/bytes.h"
#include "scene/scene.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

TEST_CONTEXT(2);

enum { VERTICES = 12, TRIANGLES = 14 };

/// A floor, and a box of .9 m that stands in its middle.
static const float points[VERTICES][3] = {
    {-2, 0, 2},         {2, 0, 2},         {2, 0, -2},         {-2, 0, -2},
    {-.45f, 0, .45f},   {.45f, 0, .45f},   {.45f, 0, -.45f},   {-.45f, 0, -.45f},
    {-.45f, .9f, .45f}, {.45f, .9f, .45f}, {.45f, .9f, -.45f}, {-.45f, .9f, -.45f}};
static const uint32_t triangles[TRIANGLES][3] = {
    {0, 1, 2}, {0, 2, 3},  {8, 9, 10}, {8, 10, 11}, {4, 7, 6},   {4, 6, 5}, {4, 5, 9},
    {4, 9, 8}, {5, 6, 10}, {5, 10, 9}, {6, 7, 11},  {6, 11, 10}, {7, 4, 8}, {7, 8, 11}};
static const double NEAR[3] = {0.0, 0.0, 0.0}, FAR[3] = {500000.25, 112.5, 4000000.75};

// --- files ---------------------------------------------------------------------------------------

static const char *write_text(const char *folder, const char *name, alpi_bytes *text)
{
    static char path[1024];
    assert_false(text->failed);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    test_write_file(path, text->bytes, text->size);
    alpi_bytes_destroy(text);
    return path;
}

static void print_points(alpi_bytes *text, const double at[3], const char *before)
{
    for (int v = 0; v < VERTICES; v++) {
        alpi_bytes_print(text, "%s", before);
        for (int k = 0; k < 3; k++) { // hundredths of a metre
            alpi_bytes_print(text, " %.2f", at[k] + (double)points[v][k]);
        }
    }
}

static const char *write_obj(const double at[3])
{
    alpi_bytes text = alpi_bytes_create(context);
    print_points(&text, at, "\nv");
    for (int t = 0; t < TRIANGLES; t++) {
        alpi_bytes_print(&text, "\nf %u %u %u", triangles[t][0] + 1, triangles[t][1] + 1,
                         triangles[t][2] + 1);
    }
    return write_text(test_folder(), "scene.obj", &text);
}

/// @param node, array where the distance is: both may have a part of it
static const char *write_dae(const double node[3], const double array[3])
{
    alpi_bytes text = alpi_bytes_create(context);
    alpi_bytes_print(&text,
                     "<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
                     "version='1.4.1'><asset><unit meter='1'/><up_axis>Y_UP</up_axis></asset>"
                     "<library_geometries><geometry id='g'><mesh><source id='p'>"
                     "<float_array id='a' count='%d'>",
                     3 * VERTICES);
    print_points(&text, array, "");
    alpi_bytes_print(&text,
                     "</float_array><technique_common><accessor source='#a' count='%d' stride='3'>"
                     "<param name='X' type='float'/><param name='Y' type='float'/>"
                     "<param name='Z' type='float'/></accessor></technique_common></source>"
                     "<vertices id='v'><input semantic='POSITION' source='#p'/></vertices>"
                     "<triangles count='%d'><input semantic='VERTEX' source='#v' offset='0'/><p>",
                     VERTICES, TRIANGLES);
    for (int t = 0; t < TRIANGLES; t++) {
        alpi_bytes_print(&text, " %u %u %u", triangles[t][0], triangles[t][1], triangles[t][2]);
    }
    alpi_bytes_print(
        &text,
        "</p></triangles></mesh></geometry></library_geometries>"
        "<library_cameras><camera id='c'><optics><technique_common><perspective>"
        "<yfov>40</yfov></perspective></technique_common></optics></camera>"
        "</library_cameras>"
        "<library_visual_scenes><visual_scene id='s'><node><translate>%.2f %.2f %.2f"
        "</translate><instance_geometry url='#g'/><instance_camera url='#c'/></node></visual_scene>"
        "</library_visual_scenes><scene><instance_visual_scene url='#s'/></scene>"
        "</COLLADA>",
        node[0], node[1], node[2]);
    return write_text(test_folder(), "scene.dae", &text);
}

/// A camera and a lamp stand beside it, 2 m above. @param instanced by EXT_mesh_gpu_instancing
static const char *write_gltf(const double at[3], bool instanced)
{
    alpi_bytes text = alpi_bytes_create(context), bin = alpi_bytes_create(context);
    const float zero[3] = {0.0f, 0.0f, 0.0f};
    alpi_bytes_add(&bin, points, sizeof points);
    alpi_bytes_add(&bin, triangles, sizeof triangles);
    alpi_bytes_add(&bin, zero, sizeof zero);
    alpi_bytes_print(
        &text,
        "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_lights_punctual\","
        "\"EXT_mesh_gpu_instancing\"],\"buffers\":[{\"uri\":\"scene.bin\",\"byteLength\":%zu}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu},{\"buffer\":0,\"byteOffset\":%zu,"
        "\"byteLength\":%zu},{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":12}],\"accessors\":["
        "{\"bufferView\":0,\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\","
        "\"min\":[-2,0,-2],\"max\":[2,0.9,2]},{\"bufferView\":1,\"componentType\":5125,"
        "\"count\":%d,\"type\":\"SCALAR\"},{\"bufferView\":2,\"componentType\":5126,\"count\":1,"
        "\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},"
        "\"indices\":1}]}],\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,"
        "\"znear\":0.1}}],\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":"
        "\"point\"}]}},\"nodes\":[{\"children\":[1,2,3],\"translation\":[%.2f,%.2f,%.2f]},"
        "{\"mesh\":0%s},{\"camera\":0,\"translation\":[0,2,0]},{\"extensions\":{"
        "\"KHR_lights_punctual\":{\"light\":0}},\"translation\":[0,2,0]}],\"scenes\":[{\"nodes\":"
        "[0]}],\"scene\":0}",
        bin.size, sizeof points, sizeof points, sizeof triangles, sizeof points + sizeof triangles,
        VERTICES, 3 * TRIANGLES, at[0], at[1], at[2],
        instanced
            ? ",\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":2}}}"
            : "");
    const char *folder = test_folder();
    write_text(folder, "scene.bin", &bin);
    return write_text(folder, "scene.gltf", &text);
}

// --- bakes ---------------------------------------------------------------------------------------

static double mean_of(const alp_scene *scene, uint32_t size, const char *output)
{
    alp_bake_options o = alp_bake_options_default();
    alp_bake_report report;
    o.atlas.size = size;
    o.occlusion.samples = 256;
    o.output = output;
    o.overwrite = true;
    ASSERT_OK(context, alp_bake(scene, &o, NULL, &report));
    return report.ao_mean;
}

/// Vertices lie as near the origin, and as the digits say.
static void check_places(const alp_scene *scene, const double at[3])
{
    for (uint32_t v = 0; v < scene->vertex_count; v++) {
        double nearest = HUGE_VAL;
        for (int i = 0; i < VERTICES; i++) {
            double off = 0.0;
            for (int k = 0; k < 3; k++) {
                const double world = scene->origin[k] + (double)scene->positions[v][k];
                off = fmax(off, fabs(world - at[k] - round(100.0 * (double)points[i][k]) / 100.0));
            }
            nearest = fmin(nearest, off);
        }
        assert_true(nearest < 5e-7); // half a step of a float of up to 8 m
    }
}

TEST(far_scenes_are_as_near_ones)
{
    alp_scene *scene = test_load(context, write_obj(NEAR));
    assert_true(scene->origin[0] == 0.0 && scene->origin[1] == 0.0 && scene->origin[2] == 0.0);
    const double near = mean_of(scene, 64, NULL);
    alp_scene_destroy(scene);
    for (int kind = 0; kind < 5; kind++) {
        test_log_clear();
        scene = test_load(context, kind == 0   ? write_obj(FAR)
                                   : kind == 1 ? write_dae(FAR, NEAR)
                                   : kind == 2 ? write_dae(NEAR, FAR)
                                               : write_gltf(FAR, kind == 4));
        assert_false(test_log_has("precision"));
        assert_true(scene->origin[0] != 0.0 && scene->origin[2] != 0.0);
        assert_true(fabs(scene->origin[0] - FAR[0]) <= 4.0); // the grain of 4 m is 4 m
        check_places(scene, FAR);
        // The same texels by the same rays: edges of triangles differ by rounding alone.
        ASSERT_NEAR(mean_of(scene, 64, NULL), near, 1e-3);
        alp_scene_destroy(scene);
    }
}

/// Vertices that are floats of large coordinates have lost their detail before: the user is told.
TEST(rounded_files_are_told)
{
    static const double far[3] = {6378136.0, 0.0, 6378136.0};
    for (int rounded = 0; rounded < 2; rounded++) {
        alpi_bytes text = alpi_bytes_create(context), bin = alpi_bytes_create(context);
        float corners[3][3] = {{0, 0, 0}, {2, 0, 0}, {0, 0, 2}};
        for (int i = 0; rounded && i < 9; i++) {
            corners[i / 3][i % 3] += (float)far[i % 3];
        }
        alpi_bytes_add(&bin, corners, sizeof corners);
        alpi_bytes_print(&text,
                         "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"scene.bin\","
                         "\"byteLength\":36}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
                         "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,"
                         "\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
                         "\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0,\"translation\":[%g,0,%g]}]}",
                         rounded ? 0.0 : far[0] + 1.0, rounded ? 0.0 : far[2] + 1.0);
        const char *folder = test_folder();
        write_text(folder, "scene.bin", &bin);
        test_log_clear();
        alp_scene *scene = test_load(context, write_text(folder, "scene.gltf", &text));
        assert_int_equal(test_log_has("precision"), rounded);
        assert_true(scene->origin[0] != 0.0);
        alp_scene_destroy(scene);
    }
}

TEST(cameras_and_lights_move_along)
{
    alp_scene *scene = test_load(context, write_gltf(FAR, false));
    assert_int_equal(scene->camera_count, 1);
    assert_int_equal(scene->light_count, 1);
    const float at[3] = {scene->lights[0].position.x, scene->lights[0].position.y,
                         scene->lights[0].position.z};
    for (int k = 0; k < 3; k++) {
        const double wanted = FAR[k] + (k == 1 ? 2.0 : 0.0);
        ASSERT_NEAR(scene->origin[k] + (double)scene->cameras[0].position[k], wanted, 1e-6);
        ASSERT_NEAR(scene->origin[k] + (double)at[k], wanted, 1e-6);
    }
    alp_scene_destroy(scene);
}

// --- what is written -----------------------------------------------------------------------------

/// The coordinates of the v statements of an OBJ.
static int read_points(const char *path, double values[3 * VERTICES])
{
    size_t size;
    char *text = (char *)test_read_file(path, &size);
    int count = 0;
    for (char *line = strtok(text, "\n"); line != NULL; line = strtok(NULL, "\n")) {
        char *at = line + 1;
        for (int k = 0; strncmp(line, "v ", 2) == 0 && k < 3 && count < 3 * VERTICES; k++) {
            values[count++] = strtod(at, &at);
        }
    }
    free(text);
    return count;
}

static int compare_numbers(const void *left, const void *right)
{
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

TEST(an_obj_keeps_its_digits)
{
    double before[3 * VERTICES], after[3 * VERTICES];
    const char *output = test_path(test_folder(), "baked.obj");
    const char *input = write_obj(FAR);
    alp_scene *scene = test_load(context, input);
    mean_of(scene, 64, output);
    assert_int_equal(read_points(input, before), 3 * VERTICES);
    assert_int_equal(read_points(output, after), 3 * VERTICES);
    qsort(before, 3 * VERTICES, sizeof *before, compare_numbers);
    qsort(after, 3 * VERTICES, sizeof *after, compare_numbers);
    assert_memory_equal(before, after, sizeof before); // not a bit of a double has changed
    alp_scene_destroy(scene);
}

/// A scene without a file of its own kind is written with transforms, and read again in the same
/// place.
TEST(other_files_as_gltf)
{
    const char *output = test_path(test_folder(), "baked.glb");
    for (int dae = 0; dae < 2; dae++) {
        alp_scene *scene = test_load(context, dae ? write_dae(FAR, NEAR) : write_obj(FAR));
        const double mean = mean_of(scene, 64, output);
        alp_scene *again = test_load(context, output);
        for (int k = 0; k < 3; k++) {
            assert_true(again->origin[k] == scene->origin[k]);
        }
        check_places(again, FAR);
        assert_int_equal(again->camera_count, dae);
        for (int k = 0; dae && k < 3; k++) {
            ASSERT_NEAR(again->origin[k] + (double)again->cameras[0].position[k], FAR[k], 1e-6);
        }
        ASSERT_NEAR(mean_of(again, 64, NULL), mean, 1e-3);
        alp_scene_destroy(again);
        alp_scene_destroy(scene);
    }
}

TEST(viewers_get_a_transform)
{
    static const char *const names[2] = {"baked.json", "baked.babylon"};
    alp_scene *scene = test_load(context, write_gltf(FAR, false));
    for (int i = 0; i < 2; i++) {
        alp_bake_options o = alp_bake_options_default();
        o.atlas.size = 32;
        o.maps = ALP_MAP_LIGHT;
        o.light.samples = 32;
        o.lightmap_as = i == 0 ? ALP_LIGHTMAP_AS_THREE : ALP_LIGHTMAP_AS_BABYLON;
        o.output = test_path(test_folder(), names[i]);
        ASSERT_OK(context, alp_bake(scene, &o, NULL, NULL));
        size_t size;
        char *text = (char *)test_read_file(o.output, &size);
        assert_non_null(strstr(text, i == 0 ? "\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,500000,112,"
                                            : "\"position\":[500000,112,"));
        assert_non_null(strstr(text, "500000.25,114.5,4000000.75")); // the camera
        free(text);
    }
    alp_scene_destroy(scene);
}

// --- files of others -----------------------------------------------------------------------------

TEST(reported_files)
{
    static const char *const names[] = {"scenes/reports/far_utm.near.obj",
                                        "scenes/reports/far_utm.obj",
                                        "scenes/reports/dae_far_utm.dae"};
    for (int i = 0; i < 3; i++) {
        const char *path = test_shared(names[i]);
        if (path == NULL) {
            skip();
        }
        alp_scene *scene = test_load(context, path);
        // .938 has three digits, and 256 texels to a side differ from more by less than .001.
        ASSERT_NEAR(mean_of(scene, 256, NULL), 0.938, 0.0015);
        alp_scene_destroy(scene);
    }
}
