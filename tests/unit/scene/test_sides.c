// SPDX-License-Identifier: MIT
// Which side of a double-sided surface a map holds: the outer one of solids, however they are
// wound.
#include "scene/sides.h"

#include "test_support.h"

#include <math.h>

enum { MESHES = 6 };

/// Boxes, each a mesh of its own.
typedef struct boxes {
    float corners[MESHES][8][3];
    uint32_t triangles[MESHES][12][3];
    alp_mesh meshes[MESHES];
    uint32_t count;
} boxes;

/// Adds a box of half the side around a point. @param inwards whether its triangles face inwards
static alp_mesh *add(boxes *b, float x, float y, float half, bool inwards)
{
    static const uint32_t cube[12][3] = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5},
                                         {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                         {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    const uint32_t m = b->count++;
    const float middle[3] = {x, y, 0.0f};
    for (int i = 0; i < 8; i++) {
        for (int k = 0; k < 3; k++) {
            b->corners[m][i][k] = middle[k] + ((i >> k & 1) != 0 ? half : -half);
        }
    }
    for (int t = 0; t < 12; t++) {
        b->triangles[m][t][0] = cube[t][0];
        b->triangles[m][t][1] = cube[t][inwards ? 2 : 1];
        b->triangles[m][t][2] = cube[t][inwards ? 1 : 2];
    }
    b->meshes[m] = (alp_mesh){.positions = &b->corners[m][0][0],
                              .indices = &b->triangles[m][0][0],
                              .vertex_count = 8,
                              .triangle_count = 12,
                              .double_sided = true,
                              .base_color = {0.5f, 0.5f, 0.5f}};
    return &b->meshes[m];
}

static alp_scene *make_scene(alp_context *context, const boxes *b)
{
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, b->meshes, b->count, &scene));
    return scene;
}

/// Bits of the meshes whose triangles are all turned; a mesh may not be turned in part.
static uint32_t find_turned(const alp_scene *scene)
{
    uint32_t turned = 0;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const alpi_surface *surface = &scene->surfaces[s];
        uint32_t count = 0;
        for (uint32_t i = 0; i < surface->triangle_count; i++) {
            count += alpi_sides_is_turned(scene, surface->first_triangle + i);
        }
        assert_true(count == 0 || count == surface->triangle_count);
        turned |= (count > 0 ? 1u : 0u) << s;
    }
    return turned;
}

static uint32_t turned_of(alp_context *context, const boxes *b)
{
    alp_scene *scene = make_scene(context, b);
    const uint32_t turned = find_turned(scene);
    alp_scene_destroy(scene);
    return turned;
}

TEST_WITH_CONTEXT(a_box_wound_inwards_is_turned, 1)
{
    boxes b = {.count = 0};
    add(&b, 0.0f, 0.0f, 1.0f, false);
    add(&b, 3.0f, 0.0f, 1.0f, true);
    add(&b, 6.0f, 0.0f, 1.0f, true)->double_sided = false;
    add(&b, 9.0f, 0.0f, 1.0f, true)->triangle_count = 11; // open
    assert_int_equal(turned_of(context, &b), 1u << 1);
}

/// A box within a box is hidden, so the outer one is a room; beside it, a box is none.
TEST_WITH_CONTEXT(a_room_keeps_its_inside, 1)
{
    boxes b = {.count = 0};
    add(&b, 0.0f, 0.0f, 4.0f, true);
    assert_int_equal(turned_of(context, &b), 1);
    add(&b, 0.0f, -3.0f, 1.0f, false); // on the floor
    assert_int_equal(turned_of(context, &b), 0);
    add(&b, 20.0f, 0.0f, 4.0f, true);
    assert_int_equal(turned_of(context, &b), 1u << 2);
    add(&b, 24.0f, 0.0f, 1.0f, false); // through its wall
    assert_int_equal(turned_of(context, &b), 1u << 2);
}

/// Furniture of a room may be wound inwards too; the inner shell of a thick wall is right as it is.
TEST_WITH_CONTEXT(solids_within_solids, 1)
{
    boxes b = {.count = 0};
    add(&b, 0.0f, 0.0f, 4.0f, true);
    add(&b, 0.0f, -3.0f, 1.0f, true);
    assert_int_equal(turned_of(context, &b), 1u << 1);
    add(&b, 0.0f, 0.0f, 5.0f, false); // the outer shell of the room
    assert_int_equal(turned_of(context, &b), 1u << 1);
    add(&b, 30.0f, 0.0f, 5.0f, false);
    add(&b, 30.0f, 0.0f, 4.0f, true); // a cavity
    assert_int_equal(turned_of(context, &b), 1u << 1);
}

/// Solids that share an edge are told apart.
TEST_WITH_CONTEXT(neighbours_at_an_edge, 1)
{
    boxes b = {.count = 0};
    add(&b, 0.0f, 0.0f, 1.0f, true);
    add(&b, 2.0f, 2.0f, 1.0f, false);
    add(&b, 4.0f, 0.0f, 1.0f, true);
    assert_int_equal(turned_of(context, &b), 1u << 0 | 1u << 2);
}

TEST_WITH_CONTEXT(a_lamp_or_a_camera_makes_a_room, 1)
{
    boxes b = {.count = 0};
    add(&b, 0.0f, 0.0f, 1.0f, true);
    add(&b, 3.0f, 0.0f, 1.0f, true);
    alp_scene *scene = make_scene(context, &b);
    assert_int_equal(find_turned(scene), 3);
    const vec3 lamps[2] = {{0.0f, 1.1f, 0.0f}, {3.0f, 0.5f, 0.0f}};
    alpi_sides_choose(scene, lamps, 2);
    assert_int_equal(find_turned(scene), 1);
    alpi_sides_choose(scene, NULL, 0);
    assert_int_equal(find_turned(scene), 3);
    // The file's own.
    alpi_sides_destroy(context, scene->sides);
    scene->sides = NULL;
    alpi_light light = {.kind = ALP_LIGHT_SPOT, .position = {0.0f, 0.0f, 0.5f}};
    scene->lights = &light;
    scene->light_count = 1;
    ASSERT_OK(context, alpi_sides_create(scene));
    assert_int_equal(find_turned(scene), 2);
    alpi_sides_destroy(context, scene->sides);
    scene->sides = NULL;
    alp_camera camera = {.position = {3.0f, 0.0f, 0.0f}};
    scene->cameras = &camera;
    scene->camera_count = 1;
    ASSERT_OK(context, alpi_sides_create(scene));
    assert_null(scene->sides);
    scene->lights = NULL;
    scene->cameras = NULL;
    scene->light_count = scene->camera_count = 0;
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(normals_are_those_of_the_side, 1)
{
    for (int reversed = 0; reversed < 2; reversed++) {
        boxes b = {.count = 0};
        float normals[8][3];
        add(&b, 0.0f, 0.0f, 1.0f, true);
        for (int i = 0; i < 8; i++) { // away from the middle where reversed, as the outer side's
            for (int k = 0; k < 3; k++) {
                normals[i][k] = b.corners[0][i][k] * (reversed ? 1.0f : -1.0f) / sqrtf(3.0f);
            }
        }
        b.meshes[0].normals = &normals[0][0];
        alp_scene *scene = make_scene(context, &b);
        for (uint32_t t = 0; t < 12; t++) {
            vec3 c[3], corner_normals[3];
            alpi_triangle_corners(scene, t, c);
            alpi_sides_corner_normals(scene, t, corner_normals);
            for (int k = 0; k < 3; k++) {
                ASSERT_NEAR(vec3_dot(c[k], alpi_sides_normal(scene, t)), 1.0, 1e-6);
                ASSERT_NEAR(vec3_dot(c[k], corner_normals[k]), sqrt(3.0), 1e-6);
            }
        }
        alp_scene_destroy(scene);
    }
}

TEST(memory_that_ends_is_said)
{
    int left = 1000000;
    alp_context *context = test_context_failing(&left);
    boxes b = {.count = 0};
    add(&b, 0.0f, 0.0f, 1.0f, true);
    alp_scene *scene = NULL;
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    int allocations = 0;
    for (; result == ALP_ERROR_OUT_OF_MEMORY; allocations++) {
        left = allocations;
        result = alp_scene_create_from_meshes(context, b.meshes, b.count, &scene);
    }
    ASSERT_OK(context, result);
    assert_true(allocations > 20);
    left = 1000000;
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}
