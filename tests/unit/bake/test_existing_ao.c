// SPDX-License-Identifier: MIT
// A material that has an occlusion map already: what the choices do to the values.
#include "test_scenes.h"

#include "base/memory.h"
#include "maps/lightmap.h"

#include <math.h>

/// A floor under a lid; the floor's material has an occlusion map of one value.
static alp_scene *make_scene(alp_context *context, uint8_t value, float strength)
{
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0, 0, 2}, (double[]){2, 0, 0}, (double[]){0, 0, -2});
    test_mesh_quad(mesh, (double[]){0, 1, 2}, (double[]){1, 0, 0}, (double[]){0, 0, -1});
    alp_scene *scene = test_mesh_scene(context, mesh, 1);
    scene->images = ALPI_NEW(context, alp_image *, 1);
    assert_non_null(scene->images);
    scene->image_count = 1;
    ASSERT_OK(context, alp_image_create(context, (alp_image_info){1, 1, 3, ALP_COMPONENT_U8},
                                        &scene->images[0]));
    alp_image_bytes(scene->images[0])[0] = value;
    alpi_material *m = &scene->materials[scene->surfaces[0].material];
    m->occlusion_texture.image = 0;
    m->occlusion_strength = strength;
    return scene;
}

static alp_lightmap *bake(const alp_scene *scene, alp_existing_ao choice)
{
    alp_bake_options options = alp_bake_options_default();
    options.atlas.size = 32;
    options.atlas.mode = ALP_ATLAS_CHARTS;
    options.occlusion.samples = 64;
    options.occlusion.distance = INFINITY;
    options.existing_ao = choice;
    alp_lightmap *lightmap = NULL;
    ASSERT_OK(scene->context, alp_bake(scene, &options, &lightmap, NULL));
    return lightmap;
}

TEST_WITH_CONTEXT(multiply_is_the_product, 2)
{
    alp_scene *scene = make_scene(context, 51, 0.5f); // 1 + 0.5 · (0.2 − 1) = 0.6
    alp_lightmap *replaced = bake(scene, ALP_EXISTING_AO_REPLACE);
    alp_lightmap *multiplied = bake(scene, ALP_EXISTING_AO_MULTIPLY);
    const float *a = alp_lightmap_page(replaced, 0, NULL, NULL);
    const float *b = alp_lightmap_page(multiplied, 0, NULL, NULL);
    int darker = 0;
    for (size_t i = 0; i < 4 * 32 * 32; i += 4) {
        ASSERT_NEAR(b[i], 0.6 * (double)a[i], 1e-6);
        darker += a[i] < 0.9f;
    }
    assert_true(darker > 100); // the lid is there
    alp_lightmap_destroy(replaced);
    alp_lightmap_destroy(multiplied);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(no_map_multiplies_by_one, 1)
{
    alp_scene *scene = make_scene(context, 51, 1.0f);
    scene->materials[scene->surfaces[0].material].occlusion_texture.image = ALPI_NONE;
    alp_lightmap *replaced = bake(scene, ALP_EXISTING_AO_REPLACE);
    alp_lightmap *multiplied = bake(scene, ALP_EXISTING_AO_MULTIPLY);
    assert_memory_equal(alp_lightmap_page(replaced, 0, NULL, NULL),
                        alp_lightmap_page(multiplied, 0, NULL, NULL), sizeof(float[32][32][4]));
    alp_lightmap_destroy(replaced);
    alp_lightmap_destroy(multiplied);
    alp_scene_destroy(scene);
}
