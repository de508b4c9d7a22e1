// SPDX-License-Identifier: MIT
// The good scenes: as many triangles in the world as independent tools count, all readable.
#include "test_support.h"

#include "scene/scene.h"

/// Triangles with node instancing, from SOURCES.md beside the scenes (validator and assimp).
static const struct {
    const char *file;
    uint32_t triangles, surfaces, mirrored;
} scenes[] = {
    {"architecture/zdm2.glb", 58772, 1, 0},
    {"architecture/room.glb", 63720, 17, 0},
    {"architecture/living_room.glb", 5088, 7, 0},
    {"architecture/salle_de_bain.glb", 1016615, 71, 0},
    {"objects/coffee_maker.glb", 235271, 23, 0},
    {"objects/dutch_ship/dutch_ship_medium_1k.gltf", 69162, 3, 0},
    {"objects/scallop.glb", 120000, 1, 0},
    {"objects/AlphaBlendModeTest.glb", 61, 9, 0},
    {"features/CornellBox.glb", 36, 6, 0},
    {"features/IrradianceVolumeExample.glb", 32, 4, 4},
    {"features/NegativeScaleTest/NegativeScaleTest.gltf", 7724, 11, 4},
    {"features/MultiUVTest/MultiUVTest.gltf", 12, 1, 0},
    {"features/EmissiveStrengthTest/EmissiveStrengthTest.gltf", 90, 6, 0},
    {"features/MeshPrimitiveModes/MeshPrimitiveModes.gltf", 16, 3, 0},
    {"features/SimpleInstancing/SimpleInstancing.gltf", 12 * 125, 125, 0}, // the others count one
    {"features/TextureTransformTest/TextureTransformTest.gltf", 24, 12, 0},
    {"features/emission_strength/14_emission_strength.gltf", 17280, 18, 0},
    {"features/single_vs_double_sided/01_single_vs_double_sided.gltf", 1480, 2, 0},
    {"features/cornell_measured/cornell_box_measured.glb", 38, 4, 0},
    {"features/cornell_measured/cornell_box_lights.glb", 38, 4, 0},
};

/// How well stored normals agree with the winding, by area. Wrong winding gives −1.
static double winding_agreement(const alp_scene *scene)
{
    double sum = 0.0, area = 0.0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        if (!scene->triangle_usable[t]) {
            continue;
        }
        vec3 c[3], zero = {0.0f, 0.0f, 0.0f}, mean = zero;
        alpi_triangle_corners(scene, t, c);
        for (int k = 0; k < 3; k++) {
            mean = vec3_add(mean, vec3_load(scene->normals[scene->triangles[t][k]]));
        }
        double weight = vec3_triangle_area(c[0], c[1], c[2]);
        float cosine =
            vec3_dot(vec3_normalize_or(mean, zero), vec3_triangle_normal(c[0], c[1], c[2], zero));
        sum += weight * (double)cosine;
        area += weight;
    }
    return sum / area;
}

TEST(triangle_counts)
{
    if (test_shared("scenes") == NULL) {
        skip();
    }
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        alp_context *context = test_context(1);
        alp_scene *scene = NULL;
        const char *path = test_path(test_shared("scenes"), scenes[i].file);
        ASSERT_OK(context, alp_scene_load(context, path, &scene));
        uint32_t mirrored = 0;
        for (uint32_t s = 0; s < scene->surface_count; s++) {
            mirrored += scene->surfaces[s].mirrored;
        }
        if (scene->triangle_count != scenes[i].triangles ||
            scene->surface_count != scenes[i].surfaces || mirrored != scenes[i].mirrored) {
            fail_msg("%s: %u triangles in %u surfaces, %u mirrored", scenes[i].file,
                     scene->triangle_count, scene->surface_count, mirrored);
        }
        if (winding_agreement(scene) < 0.8) {
            fail_msg("%s: normals agree with the winding by %g only", scenes[i].file,
                     winding_agreement(scene));
        }
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
}

TEST_WITH_CONTEXT(details, 1)
{
    const char *path = test_shared("scenes/features/cornell_measured/cornell_box_lights.glb");
    if (path == NULL) {
        skip();
    }
    alp_scene *scene = test_load(context, path);
    assert_int_equal(scene->light_count, 3);
    alp_scene_destroy(scene);
    path = test_shared("scenes/objects/dutch_ship/dutch_ship_medium_1k.gltf");
    ASSERT_OK(context, alp_scene_load(context, path, &scene));
    // 9 images: the normal maps are not decoded
    uint32_t decoded = 0;
    for (uint32_t i = 0; i < scene->image_count; i++) {
        decoded += scene->images[i] != NULL;
    }
    assert_int_equal(scene->image_count, 9);
    assert_int_equal(decoded, 6);
    alp_scene_destroy(scene);
}
