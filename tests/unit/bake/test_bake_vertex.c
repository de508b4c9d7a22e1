// SPDX-License-Identifier: MIT
// The whole job at vertices: closed forms, the written file read again, the same bits for any
// workers, what is refused, and the warning of triangles that are too large.
#include "test_scenes.h"

#include "base/memory.h"
#include "maps/lightmap.h"
#include "scene/scene.h"

#include <math.h>
#include <stdlib.h>

static alp_bake_options vertex_options(uint32_t samples)
{
    alp_bake_options options = alp_bake_options_default();
    options.atlas.mode = ALP_ATLAS_VERTEX;
    options.occlusion.samples = samples;
    return options;
}

// --- values --------------------------------------------------------------------------------------

static bool is_same(const float a[3], const float b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

TEST_WITH_CONTEXT(a_convex_mesh_is_open, 2)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_sphere(mesh, (double[]){10, 0, 0}, 1.0, 16, 9, 1.0, 1);
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    alp_bake_options options = vertex_options(64);
    alp_lightmap *lightmap = NULL;
    alp_bake_report report;
    test_log_clear();
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, &report));
    uint32_t count = 0;
    const float *values = alp_lightmap_vertex_values(lightmap, 0, &count);
    assert_non_null(values);
    assert_int_equal(count, 3 * mesh->triangle_count); // flat: three a triangle
    for (uint32_t v = 0; v < count; v++) {
        ASSERT_NEAR(values[v], 1.0, 1e-6);
    }
    ASSERT_NEAR(report.ao_mean, 1.0, 1e-6);
    assert_false(test_log_has("coarse-vertices"));
    assert_int_equal(report.atlas.mode, ALP_ATLAS_VERTEX);
    assert_int_equal(report.atlas.pages, 0);
    assert_true(report.vertices > 0 && report.rays >= (uint64_t)report.vertices * 64);
    assert_null(alp_lightmap_vertex_values(lightmap, 1, &count)); // no such surface
    assert_int_equal(count, 0);
    assert_int_equal(alp_lightmap_page_count(lightmap), 0);
    assert_null(alp_lightmap_page(lightmap, 0, NULL, NULL));
    assert_null(alp_lightmap_atlas(lightmap));
    float rgb[3];
    alpi_lightmap_sample(lightmap, 3, 0.2f, 0.5f, rgb);
    ASSERT_NEAR(rgb[2], 1.0, 1e-6);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(vertices_of_unusable_triangles_are_open, 1)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0, 0, 2}, (double[]){2, 0, 0}, (double[]){0, 0, -2});
    test_mesh_quad(mesh, (double[]){0, 0.1, 2}, (double[]){2, 0, 0}, (double[]){0, 0, -2});
    test_mesh_vertex(mesh, (double)NAN, 0, 0);
    test_mesh_triangle(mesh, 0, 1, 8);
    test_mesh_triangle(mesh, 0, 0, 0);
    alp_scene *scene = test_mesh_scene(context, mesh, 1);
    alp_bake_options options = vertex_options(64);
    options.occlusion.distance = INFINITY;
    options.occlusion.falloff = ALP_FALLOFF_NONE;
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, NULL));
    const float *values = alp_lightmap_vertex_values(lightmap, 0, NULL);
    for (int v = 0; v < 6; v++) {
        assert_true(values[v] < 0.5f);         // below the lid
        ASSERT_NEAR(values[6 + v], 1.0, 1e-6); // the lid
        ASSERT_NEAR(values[12 + v], 1.0, 0.0); // of no usable triangle
    }
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(equal_vertices_have_equal_values, 2)
{
    alp_scene *scene = test_load(context, "builtin:teapot-room");
    alp_bake_options options = vertex_options(16);
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, NULL));
    const float *values = lightmap->vertex_values;
    uint32_t pairs = 0;
    bool *used = calloc(scene->vertex_count, sizeof *used);
    assert_non_null(used);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            used[scene->triangles[t][k]] |= scene->triangle_usable[t];
        }
    }
    for (uint32_t a = 0; a < scene->vertex_count; a += 3) {
        for (uint32_t b = a + 1; b < scene->vertex_count; b++) {
            if (used[a] && used[b] && is_same(scene->positions[a], scene->positions[b]) &&
                is_same(scene->normals[a], scene->normals[b])) {
                ASSERT_NEAR(values[a], values[b], 0.0);
                pairs++;
            }
        }
    }
    assert_true(pairs > 50);
    free(used);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

TEST(workers_change_no_bit)
{
    const uint32_t workers[] = {1, 2, 7, 32};
    float *first = NULL;
    for (int i = 0; i < 4; i++) {
        alp_context *context = test_context(workers[i]);
        alp_scene *scene = test_load(context, "builtin:torus-plane");
        alp_bake_options options = vertex_options(16);
        alp_lightmap *lightmap = NULL;
        ASSERT_OK(context, alp_bake(scene, &options, &lightmap, NULL));
        size_t size = scene->vertex_count * sizeof *first;
        if (first == NULL) {
            first = malloc(size);
            assert_non_null(first);
            memcpy(first, lightmap->vertex_values, size);
        }
        assert_memory_equal(first, lightmap->vertex_values, size);
        alp_lightmap_destroy(lightmap);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
    free(first);
}

// --- files ---------------------------------------------------------------------------------------

TEST_WITH_CONTEXT(the_written_file_reads_back, 2)
{
    alp_scene *scene = test_load(context, "builtin:teapot-room");
    alp_bake_options options = vertex_options(16);
    options.output = test_path(test_folder(), "out.glb");
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(context, alp_bake(scene, &options, &lightmap, NULL));
    alp_scene *baked = test_load(context, options.output);
    assert_int_equal(baked->triangle_count, scene->triangle_count);
    assert_non_null(baked->colors);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            uint32_t a = scene->triangles[t][k], b = baked->triangles[t][k];
            for (int c = 0; c < 3; c++) {
                ASSERT_NEAR(baked->colors[b][c], lightmap->vertex_values[a], 0.51 / 65535.0);
            }
            ASSERT_NEAR(baked->colors[b][3], 1.0, 0.0);
        }
    }
    assert_int_equal(baked->material_count, scene->material_count);
    assert_int_equal(baked->image_count, 0);
    alp_scene_destroy(baked);
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
}

// --- triangles that are too large ----------------------------------------------------------------

/// A floor of 4 m in `parts`² squares with a box of 1 m on it, in 8² squares a side.
static alp_scene *floor_with_box(alp_context *context, int parts)
{
    static float floor_positions[40000][3];
    static uint32_t floor_triangles[40000][3];
    test_mesh *mesh = test_mesh_start();
    for (int i = 0; i < parts * parts; i++) {
        double side = 4.0 / parts, x = side * (i % parts) - 2.0, z = 2.0 - side * (i / parts);
        test_mesh_quad(mesh, (double[]){x, 0, z}, (double[]){side, 0, 0}, (double[]){0, 0, -side});
    }
    alp_mesh meshes[2] = {{.name = "floor",
                           .vertex_count = mesh->vertex_count,
                           .triangle_count = mesh->triangle_count},
                          {.name = "box"}};
    memcpy(floor_positions, mesh->positions, mesh->vertex_count * sizeof *floor_positions);
    memcpy(floor_triangles, mesh->triangles, mesh->triangle_count * sizeof *floor_triangles);
    meshes[0].positions = floor_positions[0];
    meshes[0].indices = floor_triangles[0];
    mesh = test_mesh_start();
    const double s = 0.125;
    static const double walls[4][2][3] = {{{-0.5, 0, 0.5}, {1, 0, 0}},
                                          {{0.5, 0, 0.5}, {0, 0, -1}},
                                          {{0.5, 0, -0.5}, {-1, 0, 0}},
                                          {{-0.5, 0, -0.5}, {0, 0, 1}}};
    for (int i = 0; i < 64; i++) {
        double a = s * (i % 8), b = s * (i / 8);
        test_mesh_quad(mesh, (double[]){a - 0.5, 1, 0.5 - b}, (double[]){s, 0, 0},
                       (double[]){0, 0, -s});
        for (int w = 0; w < 4; w++) {
            const double *p = walls[w][0], *u = walls[w][1];
            test_mesh_quad(mesh, (double[]){p[0] + a * u[0], b, p[2] + a * u[2]},
                           (double[]){s * u[0], 0, s * u[2]}, (double[]){0, s, 0});
        }
    }
    meshes[1].vertex_count = mesh->vertex_count;
    meshes[1].triangle_count = mesh->triangle_count;
    meshes[1].positions = mesh->positions[0];
    meshes[1].indices = mesh->triangles[0];
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, 2, &scene));
    return scene;
}

TEST(large_triangles_are_told)
{
    int parts[] = {1, 40, 0, 40}; // the third as the warning advises, the last with noise
    for (int i = 0; i < 4; i++) {
        alp_context *context = test_context(2);
        alp_scene *scene = floor_with_box(context, parts[i]);
        alp_bake_options options = vertex_options(i < 3 ? 256 : 8);
        options.occlusion.distance = 2.0f;
        test_log_clear();
        ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL));
        assert_int_equal(test_log_has("coarse-vertices"), i == 0);
        if (i == 0) {
            assert_non_null(strstr(test_log_text(), "coarse-vertices floor"));
            assert_null(strstr(test_log_text(), "coarse-vertices box"));
            assert_non_null(strstr(test_log_text(), "--atlas charts"));
            const char *advice = strstr(test_log_text(), "edges of about ");
            assert_non_null(advice);
            double edge = strtod(advice + strlen("edges of about "), NULL);
            assert_true(edge > 0.1 && edge < 2.0);
            parts[2] = (int)ceil(4.0 * sqrt(2.0) / edge); // the longest edge is the diagonal
        }
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

// --- options and faults --------------------------------------------------------------------------

TEST_WITH_CONTEXT(what_has_no_meaning_is_refused, 1)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_bake_options options = vertex_options(4);
    options.maps_folder = test_path(test_folder(), "maps");
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    options = vertex_options(4);
    options.existing_ao = ALP_EXISTING_AO_MULTIPLY;
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    options = vertex_options(4);
    options.vertex_attribute = (alp_vertex_attribute)2;
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    options.atlas.mode = ALP_ATLAS_CHARTS;
    options.vertex_attribute = ALP_VERTEX_OCCLUSION;
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    options = vertex_options(4);
    options.sampling.error = 0.01f;
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    options = vertex_options(4);
    options.sampling.memory_limit = 1000;
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_LIMIT);
    options.sampling.memory_limit = 1 << 20;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL));
    alp_atlas *atlas = NULL;
    options = vertex_options(4);
    assert_int_equal(alp_atlas_create(scene, &options.atlas, &atlas), ALP_ERROR_INVALID_ARGUMENT);
    assert_null(alp_lightmap_vertex_values(NULL, 0, NULL));
    options = vertex_options(4);
    options.vertex_attribute = ALP_VERTEX_OCCLUSION;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, NULL));
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(chosen_occluders_alone_occlude, 2)
{
    alp_scene *scene = test_load(context, "builtin:sphere-plane");
    alp_bake_options options = vertex_options(64);
    alp_bake_report report;
    ASSERT_OK(context, alp_bake(scene, &options, NULL, &report));
    assert_true(report.ao_mean < 0.999);
    options.occluders = "ground"; // a plane, which nothing of the sphere is behind
    ASSERT_OK(context, alp_bake(scene, &options, NULL, &report));
    const double ground = report.ao_mean;
    options.occluders = "sphere";
    ASSERT_OK(context, alp_bake(scene, &options, NULL, &report));
    assert_true(report.ao_mean != ground);
    options.occluders = "cube";
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    options.occluders = NULL;
    options.only = "sphere";
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    options.only = NULL;
    options.ao_self = true;
    assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
    alp_scene_destroy(scene);
}

TEST(every_allocation_may_fail)
{
    int left = 0;
    alp_context *context = test_context_failing(&left);
    left = 1 << 20;
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_bake_options options = vertex_options(4);
    options.overwrite = true;
    options.output = test_path(test_folder(), "out.glb");
    int failures = 0;
    for (int room = 0; room < 4000; room++, failures++) {
        left = room;
        alp_lightmap *lightmap = NULL;
        alp_result result = alp_bake(scene, &options, &lightmap, NULL);
        left = 1 << 20;
        if (result == ALP_OK) {
            alp_lightmap_destroy(lightmap);
            break;
        }
        assert_int_equal(result, ALP_ERROR_OUT_OF_MEMORY);
        assert_null(lightmap);
    }
    assert_in_range(failures, 20, 3999);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

static bool stop_at(void *user, const alp_progress *progress)
{
    return strcmp(progress->stage, user) != 0;
}

TEST_WITH_CONTEXT(cancelling_leaves_nothing, 2)
{
    char stages[4][16] = {"vertices", "build", "occlusion", "write"};
    alp_scene *scene = test_load(context, "builtin:torus-plane");
    for (int i = 0; i < 4; i++) {
        alp_bake_options options = vertex_options(64);
        options.output = test_path(test_folder(), "out.glb");
        options.progress = stop_at;
        options.progress_user = stages[i];
        assert_int_equal(alp_bake(scene, &options, NULL, NULL), ALP_ERROR_CANCELLED);
        alp_scene *baked = NULL;
        assert_int_not_equal(alp_scene_load(context, options.output, &baked), ALP_OK);
    }
    alp_scene_destroy(scene);
}
