// SPDX-License-Identifier: MIT
// What a surface says of itself at a point: which channel of which image, in which encoding.
#include "test_support.h"

#include "base/image.h"
#include "base/memory.h"
#include "scene/scene.h"

/// A triangle whose second UV set lies in a picture of one colour that all its textures show.
static alp_scene *make_scene(alp_context *context, const uint8_t rgba[4])
{
    static const float positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    static const float uvs[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    static const uint32_t indices[3] = {0, 1, 2};
    const alp_mesh mesh = {.vertex_count = 3,
                           .positions = positions[0],
                           .uvs = uvs[0],
                           .triangle_count = 1,
                           .indices = indices,
                           .base_color = {0.5f, 0.5f, 0.5f}};
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, &mesh, 1, &scene));
    scene->images = ALPI_NEW(context, alp_image *, 1);
    assert_non_null(scene->images);
    scene->image_count = 1;
    ASSERT_OK(context, alp_image_create(context, (alp_image_info){1, 1, 4, ALP_COMPONENT_U8},
                                        &scene->images[0]));
    memcpy(alp_image_bytes(scene->images[0]), rgba, 4);
    return scene;
}

static alpi_texture texture(void)
{
    alpi_texture t = alpi_texture_none();
    t.image = 0;
    t.uv_set = 1;
    return t;
}

TEST_WITH_CONTEXT(base_colour_is_encoded_and_metal_is_the_blue_channel, 1)
{
    alp_scene *scene = make_scene(context, (uint8_t[]){188, 255, 51, 102});
    alpi_material *m = &scene->materials[scene->surfaces[0].material];
    m->base_color_texture = texture();
    vec3 albedo = alpi_surface_albedo(scene, 0, 0.25f, 0.25f);
    ASSERT_NEAR(albedo.x, 0.5 * 0.50288646, 1e-5); // sRGB 188
    ASSERT_NEAR(albedo.y, 0.5, 1e-6);
    ASSERT_NEAR(albedo.z, 0.5 * 0.033104767, 1e-6); // sRGB 51
    m->metallic = 0.5f;
    m->metallic_texture = texture(); // 51 / 255 = 0.2, as it is stored
    albedo = alpi_surface_albedo(scene, 0, 0.25f, 0.25f);
    ASSERT_NEAR(albedo.y, 0.5, 1e-6); // metals are diffuse by default
    alp_scene_set_metals(scene, ALP_METALS_BLACK);
    albedo = alpi_surface_albedo(scene, 0, 0.25f, 0.25f);
    ASSERT_NEAR(albedo.y, 0.5 * (1.0 - 0.5 * 0.2), 1e-6);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(albedo_stays_below_one, 1)
{
    alp_scene *scene = make_scene(context, (uint8_t[]){255, 255, 255, 255});
    alpi_material *m = &scene->materials[scene->surfaces[0].material];
    m->base_color[0] = 1.0f;
    ASSERT_NEAR(alpi_surface_albedo(scene, 0, 0.0f, 0.0f).x, 0.95, 1e-6);
    scene->surfaces[0].material = ALPI_NONE;
    ASSERT_NEAR(alpi_surface_albedo(scene, 0, 0.0f, 0.0f).x, 0.5, 1e-6);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(occlusion_is_the_red_channel_by_its_strength, 1)
{
    alp_scene *scene = make_scene(context, (uint8_t[]){51, 255, 255, 255});
    alpi_material *m = &scene->materials[scene->surfaces[0].material];
    float value = -1.0f;
    assert_false(alpi_surface_occlusion(scene, 0, 0.0f, 0.0f, &value)); // it has no map
    m->occlusion_texture = texture();
    const float strengths[] = {0.0f, 0.5f, 1.0f};
    const double expected[] = {1.0, 0.6, 0.2}; // 1 + strength · (0.2 − 1), as glTF says
    for (int i = 0; i < 3; i++) {
        m->occlusion_strength = strengths[i];
        assert_true(alpi_surface_occlusion(scene, 0, 0.0f, 0.0f, &value));
        ASSERT_NEAR(value, expected[i], 1e-6);
    }
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(a_cut_is_below_the_cutoff, 1)
{
    alp_scene *scene = make_scene(context, (uint8_t[]){255, 255, 255, 102}); // alpha 0.4
    alpi_material *m = &scene->materials[scene->surfaces[0].material];
    m->base_color_texture = texture();
    m->alpha_cutoff = 0.45f;
    assert_false(alpi_surface_is_cut(scene, 0, 0.0f, 0.0f)); // opaque: alpha is not looked at
    m->alpha_mode = ALPI_ALPHA_MASK;
    assert_true(alpi_surface_is_cut(scene, 0, 0.0f, 0.0f));
    m->alpha_cutoff = 0.35f;
    assert_false(alpi_surface_is_cut(scene, 0, 0.0f, 0.0f));
    m->base_color[3] = 0.5f; // 0.4 · 0.5
    assert_true(alpi_surface_is_cut(scene, 0, 0.0f, 0.0f));
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(transmission_is_the_red_channel, 1)
{
    alp_scene *scene = make_scene(context, (uint8_t[]){51, 255, 102, 153});
    alpi_material *m = &scene->materials[scene->surfaces[0].material];
    ASSERT_NEAR(alpi_surface_transmission(scene, 0, 0.25f, 0.25f), 0.0, 0.0); // the default
    m->transmission_texture = texture();
    ASSERT_NEAR(alpi_surface_transmission(scene, 0, 0.25f, 0.25f), 0.0, 0.0);
    m->transmission = 0.5f;
    ASSERT_NEAR(alpi_surface_transmission(scene, 0, 0.25f, 0.25f), 0.5 * 0.2, 1e-7); // linear
    m->transmission_texture = alpi_texture_none();
    ASSERT_NEAR(alpi_surface_transmission(scene, 0, 0.25f, 0.25f), 0.5, 0.0);
    scene->surfaces[0].material = ALPI_NONE;
    ASSERT_NEAR(alpi_surface_transmission(scene, 0, 0.25f, 0.25f), 0.0, 0.0);
    alp_scene_destroy(scene);
}
