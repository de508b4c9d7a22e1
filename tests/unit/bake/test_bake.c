// SPDX-License-Identifier: MIT
// The whole job: files appear complete or not at all, the same bits for any workers, sane at the
// ends of every range, and what was written reads back.
#include "test_scenes.h"

#include "bake/bake_memory.h"
#include "maps/lightmap.h"
#include "scene/scene.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static alp_bake_options small_options(void)
{
    alp_bake_options options = alp_bake_options_default();
    options.atlas.size = 64;
    options.atlas.mode = ALP_ATLAS_CHARTS;
    options.occlusion.samples = 16;
    return options;
}

static int count_files(const char *folder)
{
    DIR *directory = opendir(folder);
    assert_non_null(directory);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(directory)) != NULL;) {
        count += entry->d_name[0] != '.';
    }
    closedir(directory);
    return count;
}

TEST_WITH_CONTEXT(a_baked_scene_reads_back, 2)
{
    const char *folder = test_folder();
    alp_scene *scene = test_load(context, "builtin:sphere-plane");
    alp_bake_options options = small_options();
    options.output = test_path(folder, "out.glb");
    options.maps_folder = test_path(folder, "maps");
    alp_bake_report report;
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, &report));
    assert_int_equal(report.traced + report.interpolated + report.dropped, report.atlas.texels);
    assert_true(report.dropped <= 1); // where the sphere stands
    assert_true(report.interpolated > 0 && report.traced > 0 && report.unknown == 0);
    // Those traced, the held-out ones twice, and the near ones' 8.
    assert_true(report.rays >= report.traced * 16 && report.rays <= report.atlas.texels * 56);
    assert_true(report.ao_mean > 0.3 && report.ao_mean < 1.0);
    ASSERT_NEAR(report.ao_distance,
                0.2 *
                    hypot(hypot((double)(report.scene.bounds_max[0] - report.scene.bounds_min[0]),
                                (double)(report.scene.bounds_max[1] - report.scene.bounds_min[1])),
                          (double)(report.scene.bounds_max[2] - report.scene.bounds_min[2])),
                1e-5);

    alp_image *map = NULL; // the EXR holds the lightmap's page as it is
    ASSERT_OK(context, alp_image_load(context, test_path(folder, "maps/ao.exr"), &map));
    assert_memory_equal(alp_image_floats(map), alp_lightmap_page(lightmap, 0, NULL, NULL),
                        sizeof(float) * 64 * 64 * 4);
    alp_image_destroy(map);

    alp_scene *baked =
        test_load(context, options.output); // the asset carries the same map and coordinates
    assert_int_equal(baked->triangle_count, scene->triangle_count);
    const float *uvs = alp_atlas_corner_uvs(alp_lightmap_atlas(lightmap));
    for (uint32_t t = 0; t < baked->triangle_count; t += 7) {
        const alpi_material *m =
            &baked->materials[baked->surfaces[baked->triangle_surface[t]].material];
        assert_int_not_equal(m->occlusion_texture.image, ALPI_NONE);
        for (int k = 0; k < 3; k++) {
            vec2 uv = alpi_triangle_uv(baked, t, m->occlusion_texture.uv_set, k == 1, k == 2);
            ASSERT_NEAR(uv.x, uvs[6 * (size_t)t + 2 * (size_t)k], 1e-7);
            ASSERT_NEAR(uv.y, uvs[6 * (size_t)t + 2 * (size_t)k + 1], 1e-7);
        }
        // 8 bits of the same map: what the asset reads is what the lightmap reads.
        float expected[3], found = -1.0f;
        alpi_lightmap_sample(lightmap, t, 0.3f, 0.3f, expected);
        assert_true(alpi_surface_occlusion(baked, t, 0.3f, 0.3f, &found));
        ASSERT_NEAR(found, expected[0], 0.51 / 255.0);
    }
    alp_scene_destroy(baked);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

TEST(workers_change_no_byte)
{
    const int ways = TEST_STEP > 1 ? 2 : 3;
    const uint32_t workers[] = {2, 7, 1};
    unsigned char *first = NULL;
    size_t first_size = 0;
    for (int i = 0; i < ways; i++) {
        alp_context *context = test_context(workers[i]);
        alp_scene *scene = test_load(context, "builtin:torus-plane");
        alp_bake_options options = small_options();
        options.output = test_path(test_folder(), "out.glb");
        ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL));
        size_t size = 0;
        unsigned char *bytes = test_read_file(options.output, &size);
        if (first == NULL) {
            first = bytes;
            first_size = size;
        } else {
            assert_int_equal(size, first_size);
            assert_memory_equal(bytes, first, size);
            free(bytes);
        }
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
    free(first);
}

typedef struct stopper {
    const char *stage;
    int calls;
} stopper;

static bool stop_at_stage(void *user, const alp_progress *progress)
{
    stopper *s = user;
    s->calls++;
    return strcmp(progress->stage, s->stage) != 0;
}

TEST(cancelling_leaves_nothing)
{
    const char *const stages[] = {"atlas", "build", "occlusion", "write"};
    for (int i = 0; i < 4; i++) {
        alp_context *context = test_context(2);
        alp_scene *scene = test_load(context, "builtin:sphere-plane");
        const char *folder = test_folder();
        stopper s = {stages[i], 0};
        alp_bake_options options = small_options();
        options.output = test_path(folder, "out.glb");
        options.maps_folder = test_path(folder, "new"); // made for the bake, and gone with it
        options.progress = stop_at_stage;
        options.progress_user = &s;
        assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_CANCELLED);
        assert_true(s.calls > 0);
        assert_int_equal(count_files(folder), 0);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

TEST_WITH_CONTEXT(nothing_is_overwritten_unasked, 1)
{
    alp_scene *scene = test_load(context, "builtin:furnace");
    const char *folder = test_folder();
    alp_bake_options options = small_options();
    options.output = test_path(folder, "out.glb");
    FILE *file = fopen(options.output, "w");
    assert_non_null(file);
    fputs("mine", file);
    fclose(file);
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_IO);
    size_t size = 0;
    unsigned char *bytes = test_read_file(options.output, &size);
    assert_string_equal((char *)bytes, "mine");
    free(bytes);
    options.overwrite = true;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL));
    options.maps_folder = test_path(folder, "maps"); // a later page is looked for before the rays
    options.atlas.texels_per_metre = 40.0;           // six walls of 40² on pages of 64²
    ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL));
    assert_int_equal(remove(test_path(folder, "maps/ao.exr")), 0);
    assert_int_equal(remove(test_path(folder, "maps/ao.png")), 0);
    assert_int_equal(remove(test_path(folder, "maps/ao.error.exr")), 0);
    assert_int_equal(remove(test_path(folder, "maps/ao.sampling.png")), 0);
    assert_int_equal(remove(options.output), 0);
    options.overwrite = false;
    stopper never = {"occlusion", 0};
    options.progress = stop_at_stage;
    options.progress_user = &never;
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_IO);
    assert_non_null(strstr(alp_context_message(context), "ao.1."));
    options.output = test_path(folder, "no/such/folder/out.glb");
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_IO);
    options.output = test_path(folder, "out.fbx");
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_UNSUPPORTED);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(the_ends_of_ranges_are_sane, 2)
{
    alp_scene *scene = test_load(context, "builtin:furnace");
    alp_bake_options options = small_options();
    options.atlas.size = 1; // one texel for six walls
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, NULL));
    float value = alp_lightmap_page(lightmap, 0, NULL, NULL)[0];
    assert_true(value >= 0.0f && value <= 1.0f);
    alp_lightmap_destroy(lightmap);

    options = small_options();
    options.occlusion.samples = 1;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL));
    options.occlusion.samples = 0;
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    options = small_options();
    options.atlas.size = 0;
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    options.atlas.size = 16385;
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);

    options = small_options(); // a closed room without a limit is black, and says so
    options.occlusion.distance = INFINITY;
    test_log_clear();
    alp_bake_report report;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, &report));
    assert_true(report.ao_mean == 0.0);
    assert_true(test_log_has("dark"));
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(what_cannot_be_baked_says_so, 1)
{
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, NULL, 0, &scene));
    assert_int_equal(alp_bake(scene, NULL, NULL, NULL), ALP_ERROR_INVALID_DATA);
    assert_non_null(strstr(alp_context_message(context), "no triangles"));
    alp_scene_destroy(scene);

    test_mesh *mesh = test_mesh_start(); // a scene that is one point
    uint32_t v = test_mesh_vertex(mesh, 1, 2, 3);
    test_mesh_triangle(mesh, v, v, v);
    scene = test_mesh_scene(context, mesh, 0);
    assert_int_equal(alp_bake(scene, NULL, NULL, NULL), ALP_ERROR_INVALID_DATA);
    alp_scene_destroy(scene);

    mesh = test_mesh_start(); // coordinates of 1e8: coarse, warned of, finite
    test_mesh_quad(mesh, (double[]){1e8, 0, 1e8}, (double[]){1000, 0, 0}, (double[]){0, 0, -1000});
    scene = test_mesh_scene(context, mesh, 0);
    alp_bake_options options = small_options();
    alp_bake_report report;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, &report));
    ASSERT_NEAR(report.ao_mean, 1.0, 0.0);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(rays_clear_their_own_surface, 2)
{
    // Planes in general position, kilometres wide, near and far from the origin: every texel is
    // open, exactly. Near the origin only the triangle's size tells how far a ray must be lifted.
    const double origins[] = {0.0, 1e4};
    for (int i = 0; i < 2; i++) {
        double o = origins[i];
        test_mesh *mesh = test_mesh_start();
        test_mesh_quad(mesh, (double[]){o, o, o}, (double[]){8123.4, 1030.7, -3011.9},
                       (double[]){1017.3, 3141.5, -7219.1});
        alp_scene *scene = test_mesh_scene(context, mesh, 0);
        alp_bake_options options = small_options();
        options.occlusion.samples = 256;
        options.occlusion.distance = INFINITY;
        alp_bake_report report;
        ASSERT_OK(context, alp_bake(scene, &options, NULL, &report));
        assert_true(report.ao_mean == 1.0);
        alp_scene_destroy(scene);
    }
}
