// SPDX-License-Identifier: MIT
// Scenes without cameras: what they are looked at from.
#include "test_scenes.h"

#include "render/automatic_camera.h"

#include <math.h>

static alp_camera choose(alp_context *context, const alp_scene *scene)
{
    alp_camera camera;
    ASSERT_OK(context, alpi_camera_choose(scene, 0, NULL, NULL, &camera));
    return camera;
}

/// The six quads of the box [low, low + size], to be seen from outside, but for those in `without`
/// (bit 0: +x, 1: −x, 2: +y, 3: −y, 4: +z, 5: −z).
static void add_box(test_mesh *mesh, const double low[3], const double size[3], bool inwards,
                    unsigned without)
{
    for (int axis = 0; axis < 3; axis++) {
        for (int side = 0; side < 2; side++) {
            const int second = (axis + 1) % 3, third = (axis + 2) % 3;
            double corner[3] = {low[0], low[1], low[2]}, u[3] = {0}, v[3] = {0};
            corner[axis] += side == 0 ? size[axis] : 0.0;
            u[second] = size[second];
            v[third] = size[third];
            const bool as_it_is = (side == 0) != inwards; // u × v points along the axis
            if ((without >> (2 * axis + side) & 1u) == 0) {
                test_mesh_quad(mesh, corner, as_it_is ? u : v, as_it_is ? v : u);
            }
        }
    }
}

/// A box without one side, with a block in it.
static alp_scene *make_open_box(alp_context *context, unsigned without, bool double_sided)
{
    test_mesh *mesh = test_mesh_start();
    add_box(mesh, (double[3]){0, 0, 0}, (double[3]){1, 1, 1}, true, without);
    add_box(mesh, (double[3]){0.2, 0, 0.25}, (double[3]){0.3, 0.6, 0.3}, false, 1u << 3);
    return test_mesh_scene(context, mesh, double_sided);
}

/// A Cornell box, whichever way it stands: through its open side one sees all its walls, from
/// elsewhere three of them or their backs.
TEST_WITH_CONTEXT(an_open_box_is_seen_through_its_open_side, 1)
{
    static const float open[6][3] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                     {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    for (int i = 0; i < 12; i++) {
        const int side = i / 2;
        if (side == 3) { // nobody looks from below
            continue;
        }
        alp_scene *scene = make_open_box(context, 1u << side, i % 2 != 0);
        const alp_camera camera = choose(context, scene);
        double out = 0.0; // of the eye, from the middle of the box
        for (int k = 0; k < 3; k++) {
            ASSERT_NEAR(camera.target[k], 0.5, 1e-6);
            out += (double)(open[side][k] * (camera.position[k] - 0.5f));
        }
        assert_true(out > 1.0); // outside, .5 being the side itself
        alp_scene_destroy(scene);
    }
}

/// How many of the reds .1, .2, … (`count`) are seen in a picture with the automatic
/// camera, on four pixels (of 96 × 54) at least.
static int count_colors(alp_context *context, const alp_scene *scene, int count)
{
    alp_render_options options = alp_render_options_default();
    options.width = 96;
    options.height = 54;
    options.samples = 1;
    options.method = ALP_RENDER_ALBEDO;
    alp_image *image = NULL;
    ASSERT_OK(context, alp_render(scene, &options, &image));
    const float *pixels = alp_image_floats(image);
    int seen = 0;
    for (int color = 1; color <= count; color++) {
        int found = 0;
        for (int p = 0; p < 96 * 54; p++) {
            found += pixels[4 * p + 3] > 0.0f && fabsf(pixels[4 * p] - 0.1f * (float)color) < 1e-3f;
        }
        seen += found >= 4;
    }
    alp_image_destroy(image);
    return seen;
}

enum { ROW = 5 };

/// Five cubes in a row along x, each of another colour; with `stand` on a shelf, before a wall that
/// faces +z, and with partitions between them, as the scenes that show materials are.
static alp_scene *make_row(alp_context *context, bool stand)
{
    float positions[64 * (ROW + 1)][3];
    uint32_t triangles[32 * (ROW + 1)][3];
    alp_mesh meshes[ROW + 1];
    uint32_t vertices = 0, count = 0;
    for (int i = 0; i < ROW + (stand ? 1 : 0); i++) {
        test_mesh *mesh = test_mesh_start();
        if (i < ROW) {
            add_box(mesh, (double[3]){3.0 * i, 1, 1}, (double[3]){1, 1, 1}, false, 0);
        } else {
            for (int k = 0; k < ROW; k++) { // open in front and above
                add_box(mesh, (double[3]){3.0 * k - 1.0, 0, 0}, (double[3]){3, 4, 3}, true,
                        1u << 4 | 1u << 2);
            }
        }
        memcpy(positions[vertices], mesh->positions, sizeof *positions * mesh->vertex_count);
        memcpy(triangles[count], mesh->triangles, sizeof *triangles * mesh->triangle_count);
        const float red = i < ROW ? 0.1f * (float)(i + 1) : 0.0f;
        meshes[i] = (alp_mesh){.name = "row",
                               .vertex_count = mesh->vertex_count,
                               .positions = positions[vertices],
                               .triangle_count = mesh->triangle_count,
                               .indices = triangles[count],
                               .base_color = {red, 0.5f, 0.5f}};
        vertices += mesh->vertex_count;
        count += mesh->triangle_count;
    }
    alp_scene *scene = NULL;
    ASSERT_OK(context,
              alp_scene_create_from_meshes(context, meshes, ROW + (stand ? 1 : 0), &scene));
    return scene;
}

TEST_WITH_CONTEXT(all_of_a_row_is_seen, 1)
{
    for (int stand = 0; stand < 2; stand++) {
        alp_scene *scene = make_row(context, stand != 0);
        assert_int_equal(count_colors(context, scene, ROW), ROW);
        alp_scene_destroy(scene);
    }
}

static void assert_same(const alp_camera *a, const alp_camera *b)
{
    assert_memory_equal(a->position, b->position, sizeof a->position);
    assert_memory_equal(a->target, b->target, sizeof a->target);
}

/// Closed rooms from inside, things from above a corner: as before anyone asked rays. Six equal
/// sides, three of which are seen from anywhere: no view is better.
TEST_WITH_CONTEXT(where_no_view_is_better_the_usual_one_stays, 1)
{
    for (int inwards = 0; inwards < 2; inwards++) {
        test_mesh *mesh = test_mesh_start();
        add_box(mesh, (double[3]){0, 0, 0}, (double[3]){4, 3, 5}, inwards != 0, 0);
        alp_scene *scene = test_mesh_scene(context, mesh, 0);
        const alp_camera camera = choose(context, scene), usual = alp_scene_get_camera(scene, 0);
        assert_same(&camera, &usual);
        assert_true((camera.position[2] < 5.0f) == (inwards != 0));
        alp_scene_destroy(scene);
    }
}

/// All that is in the scene has no area: there is nothing to see, and no fault.
TEST_WITH_CONTEXT(a_scene_of_nothing_has_a_camera, 1)
{
    test_mesh *mesh = test_mesh_start();
    const double corner[3] = {1, 2, 3}, none[3] = {0, 0, 0};
    test_mesh_quad(mesh, corner, none, none);
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    const alp_camera camera = choose(context, scene), usual = alp_scene_get_camera(scene, 0);
    assert_same(&camera, &usual);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(a_camera_of_the_scene_is_taken_as_it_is, 1)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    const alp_camera camera = choose(context, scene), own = alp_scene_get_camera(scene, 0);
    assert_same(&camera, &own);
    alp_scene_destroy(scene);
}

/// The largest places of corners to the right, left, top and bottom of a picture, whose edges
/// are 1.
static void project(const alp_scene *scene, const alp_camera *c, float aspect, float edges[4])
{
    const vec3 eye = vec3_load(c->position), none = {0.0f, 0.0f, 0.0f};
    const vec3 forward = vec3_normalize_or(vec3_sub(vec3_load(c->target), eye), none);
    const vec3 right = vec3_normalize_or(vec3_cross(forward, vec3_load(c->up)), none);
    const vec3 up = vec3_cross(right, forward);
    edges[0] = edges[1] = edges[2] = edges[3] = -INFINITY;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        vec3 corners[3];
        alpi_triangle_corners(scene, t, corners);
        for (int k = 0; k < 3; k++) {
            const vec3 to = vec3_sub(corners[k], eye);
            const float half = vec3_dot(to, forward) * tanf(0.5f * c->vertical_fov);
            assert_true(half > 0.0f);
            const float x = vec3_dot(to, right) / (half * aspect), y = vec3_dot(to, up) / half;
            edges[0] = fmaxf(edges[0], x);
            edges[1] = fmaxf(edges[1], -x);
            edges[2] = fmaxf(edges[2], y);
            edges[3] = fmaxf(edges[3], -y);
        }
    }
}

/// Two opposite edges of the picture are reached up to the margin, and none is passed.
TEST_WITH_CONTEXT(things_fill_the_frame, 1)
{
    static const double sizes[][3] = {{1, 1, 1}, {8, 1, 2}, {1, 9, 1}, {3, 0.2, 3}};
    static const float aspects[] = {1.0f, 16.0f / 9.0f, 0.5f};
    for (int i = 0; i < 4 * 3; i++) {
        test_mesh *mesh = test_mesh_start();
        add_box(mesh, (double[3]){5, -2, 1}, sizes[i / 3], false, 0);
        add_box(mesh, (double[3]){5, -2, 1 - sizes[i / 3][2]}, (double[3]){0.1, 0.1, 0.1}, false,
                0);
        alp_scene *scene = test_mesh_scene(context, mesh, 0);
        alp_camera camera = choose(context, scene), before = camera;
        float e[4];
        alpi_camera_frame(scene, aspects[i % 3], &camera);
        project(scene, &camera, aspects[i % 3], e);
        const float most = fmaxf(fmaxf(e[0], e[1]), fmaxf(e[2], e[3]));
        ASSERT_NEAR(most, 0.95, 1e-3);
        const bool wide = fabsf(e[0] - most) < 1e-3f;
        ASSERT_NEAR(e[wide ? 0 : 2], 0.95, 1e-3);
        ASSERT_NEAR(e[wide ? 1 : 3], 0.95, 1e-3);
        for (int k = 0; k < 3; k++) { // it looks the same way
            const float was = before.target[k] - before.position[k];
            const float is = camera.target[k] - camera.position[k];
            const vec3 to = vec3_sub(vec3_load(camera.target), vec3_load(camera.position));
            const vec3 from = vec3_sub(vec3_load(before.target), vec3_load(before.position));
            ASSERT_NEAR(is / vec3_length(to), was / vec3_length(from), 1e-4);
        }
        alp_scene_destroy(scene);
    }
}

TEST_WITH_CONTEXT(a_camera_inside_is_not_moved, 1)
{
    test_mesh *mesh = test_mesh_start();
    add_box(mesh, (double[3]){0, 0, 0}, (double[3]){4, 3, 5}, true, 0);
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    alp_camera camera = choose(context, scene);
    const alp_camera before = camera;
    alpi_camera_frame(scene, 2.0f, &camera);
    assert_same(&camera, &before);
    alp_scene_destroy(scene);
}
