// SPDX-License-Identifier: MIT
// The object of pictures as a scene: where its triangles are, and what is refused.
#include "test_support.h"

#include <alpenglow/geometry.h>
#include <alpenglow/render.h>

#include <math.h>

TEST_WITH_CONTEXT(an_object_has_its_size_place_and_colour, 2)
{
    const alp_object_kind kinds[] = {ALP_OBJECT_SPHERE, ALP_OBJECT_TEAPOT};
    for (int i = 0; i < 2; i++) {
        const alp_render_object object = {kinds[i], {1.0f, 2.0f, -3.0f}, 0.5f};
        alp_scene *scene = NULL;
        ASSERT_OK(context, alp_render_object_mesh(context, &object, &scene));
        const alp_scene_info info = alp_scene_get_info(scene);
        const alp_material_info material = alp_scene_get_material(scene, 0);
        assert_int_equal(info.surfaces, 1);
        assert_false(material.double_sided);
        ASSERT_NEAR(info.bounds_min[1], 1.5, 1e-5);
        ASSERT_NEAR(info.bounds_max[1], 2.5, 1e-5);
        for (int k = 0; k < 3; k++) {
            ASSERT_NEAR(material.base_color[k], 0.8, 1e-6);
            assert_true(info.bounds_min[k] < object.position[k]);
            assert_true(info.bounds_max[k] > object.position[k]);
        }
        alp_scene_destroy(scene);
    }
}

TEST_WITH_CONTEXT(an_object_without_kind_or_size_is_refused, 2)
{
    const alp_render_object bad[] = {{ALP_OBJECT_NONE, {0.0f, 0.0f, 0.0f}, 1.0f},
                                     {ALP_OBJECT_SPHERE, {0.0f, 0.0f, 0.0f}, 0.0f},
                                     {ALP_OBJECT_SPHERE, {0.0f, 0.0f, 0.0f}, (float)INFINITY},
                                     {ALP_OBJECT_TEAPOT, {0.0f, (float)NAN, 0.0f}, 1.0f}};
    const alp_render_object good = {ALP_OBJECT_SPHERE, {0.0f, 0.0f, 0.0f}, 1.0f};
    alp_scene *scene = NULL;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(alp_render_object_mesh(context, &bad[i], &scene),
                         ALP_ERROR_INVALID_ARGUMENT);
        assert_null(scene);
    }
    assert_int_equal(alp_render_object_mesh(NULL, &good, &scene), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_render_object_mesh(context, NULL, &scene), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_render_object_mesh(context, &good, NULL), ALP_ERROR_INVALID_ARGUMENT);
}
