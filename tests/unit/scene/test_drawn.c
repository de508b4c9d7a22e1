// SPDX-License-Identifier: MIT
// What a host draws: the arrays and values that it gets are enough to compute the library's albedo.
#include "drawn_asset.h"
#include "host_shader.h"

#include "scene/scene.h"

#include <math.h>
#include <stdio.h>

static void check_albedo(const alp_scene *scene)
{
    const alp_geometry g = alp_scene_get_geometry(scene);
    for (uint32_t t = 0; t < g.triangle_count; t++) {
        for (int i = 0; i < 25; i++) {
            const double b1 = 0.05 + 0.18 * (i % 5), b2 = (0.95 - b1) * (i / 5) / 4.0;
            double rgba[4];
            host_shade(scene, t, b1, b2, rgba);
            const vec3 albedo = alpi_surface_albedo(scene, t, (float)b1, (float)b2);
            ASSERT_NEAR(rgba[0], albedo.x, 2e-5);
            ASSERT_NEAR(rgba[1], albedo.y, 2e-5);
            ASSERT_NEAR(rgba[2], albedo.z, 2e-5);
            if (alp_scene_get_material(scene, 0).alpha_mode == ALP_ALPHA_MASK) {
                ASSERT_NEAR(rgba[3], alpi_surface_alpha(scene, t, (float)b1, (float)b2), 2e-5);
            }
        }
    }
}

// --- scenes without textures ---------------------------------------------------------------------

TEST_WITH_CONTEXT(the_cornell_box_is_drawn_from_its_arrays, 1)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    const alp_scene_info info = alp_scene_get_info(scene);
    const alp_geometry g = alp_scene_get_geometry(scene);
    assert_int_equal(g.triangle_count, info.triangles);
    assert_int_equal(g.vertex_count, info.vertices);
    double area = 0.0;
    uint32_t before = 0;
    for (uint32_t t = 0; t < g.triangle_count; t++) {
        double e[2][3], n[3];
        for (int k = 0; k < 3; k++) {
            e[0][k] = (double)g.positions[g.triangles[t][1]][k] -
                      (double)g.positions[g.triangles[t][0]][k];
            e[1][k] = (double)g.positions[g.triangles[t][2]][k] -
                      (double)g.positions[g.triangles[t][0]][k];
        }
        for (int k = 0; k < 3; k++) {
            n[k] = e[0][(k + 1) % 3] * e[1][(k + 2) % 3] - e[0][(k + 2) % 3] * e[1][(k + 1) % 3];
        }
        const double twice = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        assert_true(g.triangle_usable[t]);
        area += 0.5 * twice;
        double along = 0.0, length = 0.0;
        for (int k = 0; k < 3; k++) {
            const double m = (double)g.normals[g.triangles[t][0]][k];
            along += m * n[k] / twice;
            length += m * m;
        }
        ASSERT_NEAR(length, 1.0, 1e-6);
        ASSERT_NEAR(along, 1.0, 2e-5); // the quads are nearly flat
        const uint32_t s = g.triangle_surfaces[t];
        assert_true(s >= before && s < info.surfaces);
        const alp_surface_info surface = alp_scene_get_surface(scene, s);
        assert_true(t >= surface.first_triangle &&
                    t - surface.first_triangle < surface.triangle_count);
        assert_string_equal(alp_scene_get_material(scene, surface.material_index).name,
                            surface.material);
        before = s;
    }
    ASSERT_NEAR(area, info.area, 1e-6 * info.area);
    check_albedo(scene);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(arrays_of_a_mesh_come_back, 1)
{
    static const float positions[4][3] = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {2, 3, 0}};
    static const float normals[4][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    static const float uvs[4][2] = {{0, 1}, {1, 1}, {0, 0}, {1, 0}};
    static const uint32_t indices[3][3] = {{0, 1, 2}, {1, 3, 2}, {3, 3, 2}};
    const alp_mesh mesh = {.vertex_count = 4,
                           .positions = positions[0],
                           .normals = normals[0],
                           .uvs = uvs[0],
                           .triangle_count = 3,
                           .indices = indices[0],
                           .base_color = {0.25f, 0.5f, 0.75f},
                           .double_sided = true};
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, &mesh, 1, &scene));
    const alp_geometry g = alp_scene_get_geometry(scene);
    assert_int_equal(g.vertex_count, 4);
    assert_int_equal(g.triangle_count, 3);
    assert_memory_equal(g.positions, positions, sizeof positions);
    assert_memory_equal(g.normals, normals, sizeof normals);
    assert_memory_equal(g.uvs[1], uvs, sizeof uvs);
    assert_memory_equal(g.triangles, indices, sizeof indices);
    assert_null(g.uvs[2]);
    assert_null(g.colors);
    assert_true(g.triangle_usable[0] && g.triangle_usable[1]);
    assert_false(g.triangle_usable[2]); // without area
    const alp_surface_info surface = alp_scene_get_surface(scene, 0);
    assert_int_equal(surface.uv_slots, 3);
    assert_int_equal(surface.material_index, 0);
    for (int k = 0; k < 9; k++) { // the axes of the world
        ASSERT_NEAR(surface.axes[k / 3][k % 3], k % 4 == 0 ? 1.0 : 0.0, 0.0);
    }
    const alp_material_info m = alp_scene_get_material(scene, 0);
    ASSERT_NEAR(m.base_color[1], 0.5, 0.0);
    ASSERT_NEAR(m.base_color[3], 1.0, 0.0);
    assert_true(m.double_sided);
    assert_int_equal(m.base_color_texture.image, ALP_NONE);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(nothing_is_described_by_defaults, 1)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    const alp_scene_info info = alp_scene_get_info(scene);
    const alp_geometry g = alp_scene_get_geometry(NULL);
    assert_int_equal(g.triangle_count, 0);
    assert_null(g.positions);
    assert_null(alp_scene_get_image(scene, 0)); // it has none
    assert_null(alp_scene_get_image(NULL, 0));
    assert_null(alp_image_pixels(NULL));
    assert_int_equal(alp_scene_get_surface(scene, info.surfaces).material_index, ALP_NONE);
    const alp_material_info others[] = {alp_scene_get_material(NULL, 0),
                                        alp_scene_get_material(scene, info.materials),
                                        alp_scene_get_material(scene, ALP_NONE)};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        assert_string_equal(others[i].name, "");
        ASSERT_NEAR(others[i].base_color[0], 0.5, 0.0); // the albedo without a material
        assert_int_equal(others[i].base_color_texture.image, ALP_NONE);
        assert_int_equal(others[i].alpha_mode, ALP_ALPHA_OPAQUE);
    }
    alp_scene_destroy(scene);
}

// --- a textured material -------------------------------------------------------------------------

TEST_WITH_CONTEXT(a_textured_material_is_shaded_as_the_library_does, 1)
{
    static const char *const textures[] = {
        "'index':0", "'index':2,'texCoord':1",
        ("'index':0,'extensions':{'KHR_texture_transform':{'offset':[-0.7,0.4],'scale':[2.5,-3],"
         "'rotation':0.6,'texCoord':1}}")};
    for (size_t i = 0; i < sizeof textures / sizeof *textures; i++) {
        char material[1024];
        snprintf(material, sizeof material,
                 "{'name':'m','alphaMode':'MASK','alphaCutoff':0.3,'pbrMetallicRoughness':{"
                 "'metallicFactor':0,'baseColorFactor':[1,0.5,0.25,0.75],'baseColorTexture':{%s}}}",
                 textures[i]);
        alp_scene *scene = drawn_asset(context, material);
        const alp_material_info m = alp_scene_get_material(scene, 0);
        assert_string_equal(m.name, "m");
        assert_int_equal(m.alpha_mode, ALP_ALPHA_MASK);
        ASSERT_NEAR(m.alpha_cutoff, 0.3, 1e-7);
        assert_non_null(alp_scene_get_geometry(scene).colors);
        assert_int_equal(alp_scene_get_surface(scene, 0).uv_slots, 3);
        check_albedo(scene);
        alp_scene_destroy(scene);
    }
}

TEST_WITH_CONTEXT(a_blended_texture_is_weighed_by_the_normal, 1)
{
    static const float axes[3][3] = {{0, 2, 0.5f}, {-3, 0, 0}, {0, -0.5f, 0.75f}};
    alp_scene *scene = drawn_asset(context, "{'pbrMetallicRoughness':{'metallicFactor':0,"
                                            "'baseColorTexture':{'index':2}}}");
    alpi_texture *texture = &scene->materials[0].base_color_texture;
    for (int v = 0; v < 4; v++) {
        const vec3 n = {0.3f * (float)v, 0.5f, 1.0f - 0.4f * (float)v};
        vec3_store(scene->normals[v], vec3_normalize_or(n, n));
    }
    texture->blended = true;
    texture->slots[1] = 1;
    memcpy(scene->surfaces[0].axes, axes, sizeof axes);
    check_albedo(scene);
    memset(scene->surfaces[0].axes, 0, sizeof axes); // the world's
    check_albedo(scene);
    texture->slots[2] = 4; // which the square lacks
    check_albedo(scene);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(each_texture_comes_with_its_factor, 1)
{
    alp_scene *scene = drawn_asset(
        context,
        "{'doubleSided':true,'alphaMode':'BLEND','emissiveFactor':[0.5,1,0.25],"
        "'emissiveTexture':{'index':0},'occlusionTexture':{'index':2,'strength':0.5,'texCoord':1},"
        "'pbrMetallicRoughness':{'metallicFactor':0.125,'metallicRoughnessTexture':{'index':2}},"
        "'extensions':{'KHR_materials_emissive_strength':{'emissiveStrength':8},"
        "'KHR_materials_transmission':{'transmissionFactor':0.75,'transmissionTexture':{"
        "'index':0}}}}");
    const alp_material_info m = alp_scene_get_material(scene, 0);
    assert_true(m.double_sided);
    assert_int_equal(m.alpha_mode, ALP_ALPHA_BLEND);
    ASSERT_NEAR(m.emission[0], 4.0, 0.0);
    ASSERT_NEAR(m.emission[1], 8.0, 0.0);
    ASSERT_NEAR(m.metallic, 0.125, 0.0);
    ASSERT_NEAR(m.occlusion_strength, 0.5, 0.0);
    ASSERT_NEAR(m.transmission, 0.75, 0.0);
    assert_int_equal(m.base_color_texture.image, ALP_NONE);
    assert_int_equal(m.normal_texture.image, ALP_NONE);
    ASSERT_NEAR(m.normal_scale, 1.0, 0.0);
    assert_int_equal(m.emission_texture.image, DRAWN_IMAGE);
    assert_int_equal(m.emission_texture.wrap_u, ALP_WRAP_CLAMP);
    assert_int_equal(m.emission_texture.wrap_v, ALP_WRAP_MIRROR);
    assert_int_equal(m.metallic_texture.image, DRAWN_SAME);
    assert_int_equal(m.metallic_texture.wrap_u, ALP_WRAP_REPEAT);
    assert_int_equal(m.occlusion_texture.uv_slot, 1);
    assert_int_equal(m.transmission_texture.image, DRAWN_IMAGE);
    const alp_image *image = alp_scene_get_image(scene, DRAWN_IMAGE);
    assert_non_null(image);
    assert_int_equal(alp_image_get_info(image).width, DRAWN_WIDTH);
    assert_int_equal(((const uint8_t *)alp_image_pixels(image))[1], 90); // 83 + 7
    assert_null(alp_scene_get_image(scene, DRAWN_BROKEN));               // nothing reads it
    assert_null(alp_scene_get_image(scene, DRAWN_IMAGE_COUNT));
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(axes_are_those_of_the_node, 1)
{
    alp_scene *scene = drawn_asset(context, "{}");
    alpi_surface *surface = &scene->surfaces[0];
    const float turned[3][3] = {{0, 2, 0}, {-3, 0, 0}, {0, 0, 4}};
    memcpy(surface->axes, turned, sizeof turned);
    assert_memory_equal(alp_scene_get_surface(scene, 0).axes, turned, sizeof turned);
    memset(surface->axes, 0, sizeof surface->axes); // of a skin: the world's
    for (int k = 0; k < 9; k++) {
        ASSERT_NEAR(alp_scene_get_surface(scene, 0).axes[k / 3][k % 3], k % 4 == 0, 0.0);
    }
    alp_scene_destroy(scene);
}
