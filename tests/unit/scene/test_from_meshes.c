// SPDX-License-Identifier: MIT
// Scenes from arrays: what arrives in the scene, and what is refused.
#include "test_support.h"

#include "scene/scene.h"

#include <stdlib.h>

static const float SQUARE[4][3] = {{0, 0, 0}, {2, 0, 0}, {2, 0, -2}, {0, 0, -2}};
static const float UP[4][3] = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}};
static const float UVS[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
static const uint32_t TWO_TRIANGLES[2][3] = {{0, 1, 2}, {0, 2, 3}};

static alp_mesh square(void)
{
    return (alp_mesh){.name = "square",
                      .vertex_count = 4,
                      .positions = SQUARE[0],
                      .normals = UP[0],
                      .uvs = UVS[0],
                      .triangle_count = 2,
                      .indices = TWO_TRIANGLES[0],
                      .base_color = {0.5f, 0.25f, 0.75f}};
}

TEST_WITH_CONTEXT(arrays_arrive, 1)
{
    alp_mesh meshes[2] = {square(), square()};
    meshes[0].emission[1] = 3.0f;
    meshes[1].name = NULL;
    meshes[1].normals = NULL;
    meshes[1].uvs = NULL;
    meshes[1].double_sided = true;
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, 2, &scene));

    alp_scene_info info = alp_scene_get_info(scene);
    assert_int_equal(info.triangles, 4);
    assert_int_equal(info.usable_triangles, 4);
    assert_int_equal(info.surfaces, 2);
    assert_int_equal(info.vertices, 4 + 6); // the flat one has three vertices per triangle
    assert_int_equal(info.materials, 2);
    ASSERT_NEAR(info.area, 8.0, 1e-12);
    ASSERT_NEAR(info.bounds_max[0], 2.0, 0.0);
    ASSERT_NEAR(info.bounds_min[2], -2.0, 0.0);

    alp_surface_info first = alp_scene_get_surface(scene, 0);
    alp_surface_info second = alp_scene_get_surface(scene, 1);
    assert_string_equal(first.name, "square");
    assert_string_equal(second.name, "mesh 1");
    assert_int_equal(first.uv_sets, 2); // set 0 and the same as set 1, for ALP_ATLAS_KEEP
    assert_int_equal(second.uv_sets, 0);
    assert_false(first.normals_generated);
    assert_true(second.normals_generated);
    assert_true(second.double_sided);
    assert_int_equal(second.first_triangle, 2);

    vec3 albedo = alpi_surface_albedo(scene, 0, 0.25f, 0.25f);
    ASSERT_NEAR(albedo.y, 0.25, 0.0);
    ASSERT_NEAR(alp_scene_get_surface(scene, 0).emission[1], 3.0, 0.0);
    ASSERT_NEAR(second.emission[1], 0.0, 0.0);
    vec2 uv = alpi_triangle_uv(scene, 0, 1, 0.0f, 1.0f);
    ASSERT_NEAR(uv.x, 1.0, 0.0);
    ASSERT_NEAR(uv.y, 1.0, 0.0);
    for (uint32_t v = 0; v < info.vertices; v++) {
        ASSERT_NEAR(scene->normals[v][1], 1.0, 0.0);
    }
    // A vertex made for a flat triangle knows which vertex of the source it came from.
    assert_int_equal(scene->vertex_source[scene->triangles[3][2]], 3);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(every_array_is_in_the_hash, 1)
{
    uint64_t hashes[7] = {0};
    float moved[4][3], tilted[4][3], shifted[4][2];
    memcpy(moved, SQUARE, sizeof moved);
    memcpy(tilted, UP, sizeof tilted);
    memcpy(shifted, UVS, sizeof shifted);
    moved[3][1] = 1e-6f;
    tilted[2][0] = 1e-6f;
    shifted[1][1] = 1e-6f;
    static const uint32_t other[2][3] = {{0, 1, 2}, {2, 3, 0}};
    for (int i = 0; i < 7; i++) {
        alp_mesh mesh = square();
        mesh.positions = i == 1 ? moved[0] : mesh.positions;
        mesh.normals = i == 2 ? tilted[0] : mesh.normals;
        mesh.uvs = i == 3 ? shifted[0] : mesh.uvs;
        mesh.indices = i == 4 ? other[0] : mesh.indices;
        mesh.base_color[0] = i == 5 ? 0.25f : mesh.base_color[0];
        mesh.emission[2] = i == 6 ? 1.0f : 0.0f;
        alp_scene *scene = NULL;
        ASSERT_OK(context, alp_scene_create_from_meshes(context, &mesh, 1, &scene));
        hashes[i] = scene->input_hash;
        alp_scene_destroy(scene);
        for (int k = 0; k < i; k++) {
            assert_true(hashes[i] != hashes[k]);
        }
    }
}

TEST_WITH_CONTEXT(bad_arrays_are_refused, 1)
{
    alp_scene *scene = NULL;
    alp_mesh meshes[2] = {square(), square()};
    assert_int_equal(alp_scene_create_from_meshes(context, NULL, 1, &scene),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_scene_create_from_meshes(context, meshes, 2, NULL),
                     ALP_ERROR_INVALID_ARGUMENT);

    static const uint32_t outside[2][3] = {{0, 1, 2}, {0, 2, 4}};
    meshes[1].indices = outside[0];
    assert_int_equal(alp_scene_create_from_meshes(context, meshes, 2, &scene),
                     ALP_ERROR_INVALID_DATA);
    assert_null(scene);
    assert_non_null(strstr(alp_context_message(context), "mesh 1 (square): triangle 1"));

    meshes[1].positions = NULL;
    assert_int_equal(alp_scene_create_from_meshes(context, meshes, 2, &scene),
                     ALP_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(alp_context_message(context), "positions is NULL"));
}

TEST_WITH_CONTEXT(nothing_is_an_empty_scene, 1)
{
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, NULL, 0, &scene));
    assert_int_equal(alp_scene_get_info(scene).triangles, 0);
    alp_scene_destroy(scene);
    alp_mesh empty = {.name = "empty"};
    ASSERT_OK(context, alp_scene_create_from_meshes(context, &empty, 1, &scene));
    assert_int_equal(alp_scene_get_info(scene).surfaces, 1);
    alp_scene_destroy(scene);
}

TEST(every_failed_allocation_is_reported)
{
    int left = 0;
    alp_context *context = test_context_failing(&left);
    alp_mesh meshes[2] = {square(), square()};
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    int allowed = 0;
    for (; result != ALP_OK; allowed++) {
        left = allowed;
        alp_scene *scene = NULL;
        result = alp_scene_create_from_meshes(context, meshes, 2, &scene);
        assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
        assert_true((scene != NULL) == (result == ALP_OK));
        alp_scene_destroy(scene);
    }
    assert_in_range(allowed, 10, 40);
    alp_context_destroy(context);
}
