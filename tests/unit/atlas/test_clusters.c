// SPDX-License-Identifier: MIT
// Clusters: connected, within their angle, never folded; as few as the shape needs.
#include "atlas_scenes.h"

#include "base/memory.h"

#include "atlas/fold.h"
#include "scene/adjacency.h"

static alpi_clusters clusters_of(alp_context *context, const alp_scene *scene, float max_angle)
{
    uint32_t(*neighbours)[3] = NULL;
    alpi_clusters clusters;
    ASSERT_OK(context, alpi_adjacency_create(scene, &neighbours));
    ASSERT_OK(context, alpi_clusters_create(scene, (const uint32_t(*)[3])neighbours, max_angle,
                                            NULL, &clusters));
    alpi_release(context, neighbours);
    return clusters;
}

static void check_angles(const alp_scene *scene, const alpi_clusters *clusters, double max_angle)
{
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        uint32_t cluster = clusters->of_triangle[t];
        assert_int_equal(cluster == ALPI_NONE, !scene->triangle_usable[t]);
        if (cluster != ALPI_NONE) {
            assert_true(cluster < clusters->count);
            vec3 c[3];
            alpi_triangle_corners(scene, t, c);
            vec3 normal = vec3_triangle_normal(c[0], c[1], c[2], (vec3){0, 0, 0});
            assert_true((double)vec3_dot(normal, vec3_load(clusters->planes[cluster])) >=
                        cos(max_angle) - 1e-5);
        }
    }
}

/// How many pairs of triangles of one cluster lie over each other in its plane.
static uint32_t folded_pairs(const alp_scene *scene, const alpi_clusters *clusters)
{
    uint32_t pairs = 0;
    for (uint32_t s = 0; s < scene->triangle_count; s++) {
        for (uint32_t t = 0; t < s; t++) {
            if (clusters->of_triangle[s] != clusters->of_triangle[t] ||
                clusters->of_triangle[s] == ALPI_NONE) {
                continue;
            }
            alpi_plane plane = alpi_plane_make(
                vec3_load(clusters->planes[clusters->of_triangle[s]]), (vec3){0, 0, 0});
            alpi_flat flat[2];
            vec3 c[3];
            for (int i = 0; i < 2; i++) {
                alpi_triangle_corners(scene, i == 0 ? s : t, c);
                for (int k = 0; k < 3; k++) {
                    alpi_plane_project(&plane, c[k], &flat[i].x[k], &flat[i].y[k]);
                }
            }
            pairs += alpi_flat_overlap(&flat[0], &flat[1], 1e-5);
        }
    }
    return pairs;
}

TEST_WITH_CONTEXT(a_cube_has_six, 1)
{
    alp_scene *scene = scene_cube(context);
    alpi_clusters clusters = clusters_of(context, scene, 0.78f);
    assert_int_equal(clusters.count, 6);
    for (uint32_t t = 0; t < 12; t += 2) {
        assert_int_equal(clusters.of_triangle[t], clusters.of_triangle[t + 1]);
    }
    alpi_clusters_destroy(context, &clusters);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(a_plane_has_one, 1)
{
    alp_scene *scene = scene_plane(context, 70); // more triangles than one round takes
    alpi_clusters clusters = clusters_of(context, scene, 0.1f);
    assert_int_equal(clusters.count, 1);
    ASSERT_NEAR(clusters.planes[0][1], 1.0, 1e-6);
    alpi_clusters_destroy(context, &clusters);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(a_sphere_has_a_handful, 1)
{
    alp_scene *scene = scene_sphere(context, 24, 48);
    const float angles[] = {0.4f, 0.785f, 1.2f};
    // A cap of angle a has the share (1 − cos a)/2 of the sphere: fewer clusters than 1/share is
    // impossible, and greedy growing leaves gaps.
    const uint32_t bounds[] = {120, 40, 20};
    for (int i = 0; i < 3; i++) {
        alpi_clusters clusters = clusters_of(context, scene, angles[i]);
        double least = 2.0 / (1.0 - cos((double)angles[i]));
        assert_true((double)clusters.count >= 0.8 * least);
        assert_in_range(clusters.count, 1, bounds[i]);
        check_angles(scene, &clusters, (double)angles[i]);
        assert_int_equal(folded_pairs(scene, &clusters), 0);
        alpi_clusters_destroy(context, &clusters);
    }
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(a_spiral_is_cut_each_turn, 1)
{
    for (uint32_t turns = 2; turns <= 20; turns += 9) {
        alp_scene *scene = scene_spiral(context, turns);
        alpi_clusters clusters = clusters_of(context, scene, 1.0f);
        check_angles(scene, &clusters, 1.0);
        assert_int_equal(folded_pairs(scene, &clusters), 0);
        assert_in_range(clusters.count, turns, 4 * turns);
        alpi_clusters_destroy(context, &clusters);
        alp_scene_destroy(scene);
    }
}

TEST_WITH_CONTEXT(meshes_keep_apart, 1)
{
    // Two halves of one square, each a mesh of its own.
    static const float p[2][3][3] = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}},
                                     {{1, 1, 0}, {0, 1, 0}, {0, 0, 0}}};
    static const uint32_t index[1][3] = {{0, 1, 2}};
    alp_mesh meshes[2];
    for (int i = 0; i < 2; i++) {
        meshes[i] = (alp_mesh){.vertex_count = 3,
                               .positions = &p[i][0][0],
                               .triangle_count = 1,
                               .indices = &index[0][0]};
    }
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, 2, &scene));
    alpi_clusters clusters = clusters_of(context, scene, 0.5f);
    assert_int_equal(clusters.count, 2);
    alpi_clusters_destroy(context, &clusters);
    alp_scene_destroy(scene);
}

TEST(touching_is_not_overlapping)
{
    alpi_flat a = {{0, 1, 0}, {0, 0, 1}}, b = {{1, 1, 0}, {0, 1, 1}},
              c = {{0.1, 0.2, 0.1}, {0.1, 0.1, 0.2}};
    alpi_flat corner = {{1, 2, 2}, {0, 0, 1}}, crossing = {{-1, 2, 2}, {0.2, 0.2, 0.3}};
    assert_false(alpi_flat_overlap(&a, &b, 1e-9));
    assert_false(alpi_flat_overlap(&a, &corner, 1e-9));
    assert_true(alpi_flat_overlap(&a, &c, 1e-9));
    assert_true(alpi_flat_overlap(&c, &a, 1e-9));
    assert_true(alpi_flat_overlap(&a, &crossing, 1e-9));
    assert_true(alpi_flat_overlap(&a, &a, 1e-9));
    assert_false(alpi_flat_overlap(&a, &crossing, 1.0));
}
