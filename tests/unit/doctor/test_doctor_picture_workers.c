// SPDX-License-Identifier: MIT
// The doctor's pictures are the same for any number of workers.
#include "test_support.h"

static alp_image *draw(const alp_diagnosis *d, uint32_t index)
{
    alp_image *image = NULL;
    assert_int_equal(alp_diagnosis_picture(d, index, &image), ALP_OK);
    return image;
}

/// Two squares, whose islands of the second set overlap.
static alp_scene *make(alp_context *context)
{
    static const float square[4][3] = {{0, 0, 0}, {2, 0, 0}, {2, 0, -2}, {0, 0, -2}};
    static const float beside[4][3] = {{3, 0, 0}, {5, 0, 0}, {5, 0, -2}, {3, 0, -2}};
    static const float up[4][3] = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}};
    static const float first[4][2] = {{0, 0}, {0.5f, 0}, {0.5f, 0.5f}, {0, 0.5f}};
    static const float across[4][2] = {
        {0.25f, 0.25f}, {0.75f, 0.25f}, {0.75f, 0.75f}, {0.25f, 0.75f}};
    static const uint32_t triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
    const alp_mesh mesh = {.vertex_count = 4,
                           .positions = square[0],
                           .normals = up[0],
                           .uvs = first[0],
                           .triangle_count = 2,
                           .indices = triangles[0],
                           .base_color = {0.5f, 0.5f, 0.5f}};
    alp_mesh meshes[2] = {mesh, mesh};
    meshes[1].positions = beside[0];
    meshes[1].uvs = across[0];
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, 2, &scene));
    return scene;
}

TEST(any_number_of_workers_draws_the_same)
{
    enum { PICTURES = 2 };
    const int drawn = TEST_STEP > 1 ? 1 : PICTURES;
    const int first = test_is_quick() ? 1 : 0; // a sanitizer finds races without another to compare
    static const uint32_t pictures[2] = {0, 2}; // of the scene, and of the second set
    alp_image *images[2][PICTURES];
    alp_context *contexts[2];
    for (int i = first; i < 2; i++) {
        contexts[i] = test_context(i == 0 ? 1 : 3);
        alp_scene *scene = make(contexts[i]);
        alp_diagnosis *d = NULL;
        ASSERT_OK(contexts[i], alp_scene_diagnose(scene, NULL, &d));
        for (int k = 0; k < drawn; k++) {
            images[i][k] = draw(d, pictures[k]);
        }
        alp_diagnosis_destroy(d);
        alp_scene_destroy(scene);
    }
    for (int k = 0; k < drawn; k++) {
        const alp_image_info info = alp_image_get_info(images[first][k]);
        assert_memory_equal(alp_image_bytes(images[first][k]), alp_image_bytes(images[1][k]),
                            (size_t)info.width * info.height * info.channels);
    }
    for (int i = first; i < 2; i++) {
        for (int k = 0; k < drawn; k++) {
            alp_image_destroy(images[i][k]);
        }
        alp_context_destroy(contexts[i]);
    }
}
