// SPDX-License-Identifier: MIT
// Pictures with known content: where things appear and what a pixel holds.
#include "test_scenes.h"

#include "scene/scene.h"

#include <math.h>

static alp_scene *make_scene(alp_context *context)
{
    // A red panel on the left of the view axis, at distance 4, one metre wide; floor below.
    static const float red[4][3] = {{-1, 0, -4}, {0, 0, -4}, {0, 1, -4}, {-1, 1, -4}};
    static const float floor[4][3] = {{-9, -1, 9}, {9, -1, 9}, {9, -1, -9}, {-9, -1, -9}};
    static const uint32_t quad[2][3] = {{0, 1, 2}, {0, 2, 3}};
    const alp_mesh meshes[] = {{.name = "red",
                                .vertex_count = 4,
                                .positions = red[0],
                                .triangle_count = 2,
                                .indices = quad[0],
                                .base_color = {0.8f, 0.1f, 0.2f}},
                               {.name = "floor",
                                .vertex_count = 4,
                                .positions = floor[0],
                                .triangle_count = 2,
                                .indices = quad[0],
                                .base_color = {0.5f, 0.5f, 0.5f}}};
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_create_from_meshes(context, meshes, 2, &scene));
    return scene;
}

static alp_render_options look_ahead(void)
{
    alp_render_options options = alp_render_options_default();
    options.width = 80;
    options.height = 40;
    options.method = ALP_RENDER_ALBEDO;
    // At distance 4 the picture is 4 m high and 8 m wide: 10 pixels a metre.
    options.camera = (alp_camera){.position = {0, 0, 0},
                                  .target = {0, 0, -1},
                                  .up = {0, 1, 0},
                                  .vertical_fov = 2.0f * atanf(0.5f)};
    return options;
}

TEST_WITH_CONTEXT(things_appear_where_the_camera_says, 2)
{
    alp_scene *scene = make_scene(context);
    alp_render_options options = look_ahead();
    alp_image *image = NULL;
    ASSERT_OK(context, alp_render(scene, &options, &image));
    const float(*pixels)[4] = (const float(*)[4])alp_image_floats(image);
    for (int y = 0; y < 40; y++) {
        for (int x = 0; x < 80; x++) {
            const float *p = pixels[80 * y + x];
            bool red = x >= 30 && x < 40 && y >= 10 && y < 20;
            if (red) { // left of the axis and above it: right-handed, rows from the top
                ASSERT_NEAR(p[0], 0.8, 1e-6);
                ASSERT_NEAR(p[1], 0.1, 1e-6);
                ASSERT_NEAR(p[3], 1.0, 0.0);
            } else if (y >= 30) { // the floor: y = −1 at the picture's lower edge is 2 m ahead
                ASSERT_NEAR(p[0], 0.5, 1e-6);
                ASSERT_NEAR(p[3], 1.0, 0.0);
            } else if (y < 20) {
                ASSERT_NEAR(p[3], 0.0, 0.0);
            }
        }
    }
    alp_image_destroy(image);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(a_single_sample_goes_through_the_middle, 2)
{
    alp_scene *scene = make_scene(context);
    alp_render_options options = look_ahead();
    options.samples = 1;
    for (int i = 0; i < 2; i++) { // the panel's left border, at x = -1, just left and right of it
        alp_image *image = NULL;
        options.camera.position[0] = i == 0 ? 0.049f : 0.051f; // half a pixel is .05 m
        options.camera.target[0] = options.camera.position[0];
        ASSERT_OK(context, alp_render(scene, &options, &image));
        for (int y = 10; y < 20; y++) {
            const float *p = alp_image_floats(image) + (size_t)4 * (80 * (size_t)y + 29);
            ASSERT_NEAR(p[3], i == 0 ? 0.0 : 1.0, 0.0);
        }
        alp_image_destroy(image);
    }
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(occlusion_by_rays_meets_the_closed_form, 2)
{
    // Seen from above, the floor beside a long wall of height 2 at distance 1: 1 − .276393202.
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){-50, 0, 900}, (double[]){100, 0, 0}, (double[]){0, 0, -1800});
    test_mesh_quad(mesh, (double[]){1, 0, -900}, (double[]){0, 0, 1800}, (double[]){0, 2, 0});
    alp_scene *scene = test_mesh_scene(context, mesh, 1);
    alp_render_options options = alp_render_options_default();
    options.width = options.height = 1;
    options.samples = 64;
    options.occlusion.samples = 1u << 16;
    options.occlusion.distance = INFINITY;
    options.camera = (alp_camera){
        .position = {0, 5, 0}, .target = {0, 0, 0}, .up = {0, 0, -1}, .vertical_fov = 0.002f};
    alp_image *image = NULL;
    ASSERT_OK(context, alp_render(scene, &options, &image));
    ASSERT_NEAR(alp_image_floats(image)[0], 1.0 - 0.276393202, 1e-3);
    alp_image_destroy(image);
    alp_scene_destroy(scene);
}

/// A picture of a few pixels that all look at the origin from `height` on the y axis.
static alp_render_options look_at_origin(float height)
{
    alp_render_options options = alp_render_options_default();
    options.width = options.height = 8;
    options.samples = 1;
    options.occlusion.samples = 1u << 10;
    options.occlusion.distance = INFINITY;
    options.camera = (alp_camera){
        .position = {0, height, 0}, .target = {0, 0, 0}, .up = {0, 0, -1}, .vertical_fov = 0.002f};
    return options;
}

/// Mean and number of different values of the pixels.
static double picture_mean(const alp_scene *scene, const alp_render_options *options,
                           int *different)
{
    alp_image *image = NULL;
    ASSERT_OK(scene->context, alp_render(scene, options, &image));
    const float(*pixels)[4] = (const float(*)[4])alp_image_floats(image);
    const uint32_t count = options->width * options->height;
    double mean = 0.0;
    *different = 0;
    for (uint32_t i = 0; i < count; i++) {
        ASSERT_NEAR(pixels[i][3], 1.0, 0.0);
        mean += (double)pixels[i][0] / count;
        *different += pixels[i][0] != pixels[0][0];
    }
    alp_image_destroy(image);
    return mean;
}

TEST_WITH_CONTEXT(each_side_has_its_own_occlusion, 2)
{
    // A floor with a rectangle of 1 × 1 m a metre below it: open above, oracle 6 below.
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){-9, 0, 9}, (double[]){18, 0, 0}, (double[]){0, 0, -18});
    test_mesh_quad(mesh, (double[]){0, -1, 1}, (double[]){1, 0, 0}, (double[]){0, 0, -1});
    alp_scene *scene = test_mesh_scene(context, mesh, 1);
    int different = 0;
    alp_render_options options = look_at_origin(0.5f);
    ASSERT_NEAR(picture_mean(scene, &options, &different), 1.0, 0.0);
    options = look_at_origin(-0.5f);
    ASSERT_NEAR(picture_mean(scene, &options, &different), 1.0 - 0.138531606, 1e-3);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(pixels_have_samples_of_their_own, 2)
{
    // What all pixels share would show as a pattern: no error may be that of its neighbour.
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){-9, 0, 9}, (double[]){18, 0, 0}, (double[]){0, 0, -18});
    test_mesh_quad(mesh, (double[]){0, 1, 1}, (double[]){1, 0, 0}, (double[]){0, 0, -1});
    alp_scene *scene = test_mesh_scene(context, mesh, 1);
    int different = 0;
    alp_render_options options = look_at_origin(0.5f);
    options.width = options.height = 32;
    options.occlusion.samples = 64;
    ASSERT_NEAR(picture_mean(scene, &options, &different), 1.0 - 0.138531606, 2e-3);
    assert_true(different > 256); // of few values near the true one
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(the_border_of_things_keeps_their_colour, 1)
{
    alp_scene *scene = make_scene(context);
    alp_render_options options = look_ahead();
    options.height = 20; // 5 pixels a metre: the panel's left side is inside a pixel
    options.width = 39;
    alp_image *image = NULL;
    ASSERT_OK(context, alp_render(scene, &options, &image));
    int partly = 0;
    for (int i = 0; i < 10 * 39; i++) {
        const float *p = alp_image_floats(image) + 4 * (size_t)i;
        partly += p[3] > 0.0f && p[3] < 1.0f;
        ASSERT_NEAR(p[0], p[3] > 0.0f ? 0.8 : 0.0, 1e-6); // not darkened by what is not covered
    }
    assert_true(partly >= 4);
    alp_image_destroy(image);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(bad_cameras_are_refused, 1)
{
    alp_scene *scene = make_scene(context);
    alp_image *image = NULL;
    alp_render_options options = look_ahead();
    options.camera.target[2] = 0.0f; // the position itself
    assert_int_equal(alp_render(scene, &options, &image), ALP_ERROR_INVALID_ARGUMENT);
    options = look_ahead();
    options.camera.up[1] = 0.0f;
    assert_int_equal(alp_render(scene, &options, &image), ALP_ERROR_INVALID_ARGUMENT);
    options = look_ahead();
    options.camera.vertical_fov = 3.2f;
    assert_int_equal(alp_render(scene, &options, &image), ALP_ERROR_INVALID_ARGUMENT);
    options = look_ahead();
    options.width = 0;
    assert_int_equal(alp_render(scene, &options, &image), ALP_ERROR_INVALID_ARGUMENT);
    options = look_ahead();
    options.samples = 65537;
    assert_int_equal(alp_render(scene, &options, &image), ALP_ERROR_INVALID_ARGUMENT);
    assert_null(image);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(the_automatic_camera_sees_the_scene, 2)
{
    const char *const names[] = {"builtin:sphere-plane", "builtin:cornell", "builtin:furnace"};
    for (int i = 0; i < 3; i++) {
        alp_scene *scene = test_load(context, names[i]);
        alp_render_options options = alp_render_options_default();
        options.width = options.height = 32;
        options.samples = 8;
        options.method = ALP_RENDER_ALBEDO;
        options.camera_index = 1000;
        alp_image *image = NULL;
        ASSERT_OK(context, alp_render(scene, &options, &image));
        double covered = 0.0;
        for (int p = 0; p < 32 * 32; p++) {
            covered += (double)alp_image_floats(image)[4 * p + 3];
        }
        assert_true(covered > 0.15 * 32 * 32);
        alp_image_destroy(image);
        alp_scene_destroy(scene);
    }
}

/// A large card and a small one in front of it: most area faces the centre, but it is no room.
TEST_WITH_CONTEXT(a_flat_scene_is_seen_from_outside, 1)
{
    const double right[3] = {3, 0, 0}, up[3] = {0, 2, 0}, behind[3] = {0, 0, 0};
    const double half_right[3] = {1, 0, 0}, half_up[3] = {0, 1, 0}, before[3] = {1, 0.5, 0.02};
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, behind, right, up);
    test_mesh_quad(mesh, before, half_right, half_up);
    alp_scene *scene = test_mesh_scene(context, mesh, 0);
    alp_camera camera = alp_scene_get_camera(scene, 0);
    assert_true(camera.position[2] > 1.0f);
    ASSERT_NEAR(camera.target[0], 1.5, 1e-5);
    ASSERT_NEAR(camera.target[1], 1.0, 1e-5);
    alp_scene_destroy(scene);
}

TEST(methods_of_zero_to_one_are_shown_as_they_are)
{
    const alp_render_method plain[] = {ALP_RENDER_AO, ALP_RENDER_ALBEDO};
    for (int i = 0; i < 2; i++) {
        alp_film_options film = alp_render_film_options(plain[i]);
        assert_int_equal(film.struct_size, sizeof film);
        assert_false(film.auto_exposure);
        assert_int_equal(film.tone, ALP_TONE_NONE);
        assert_int_equal(film.dither, ALP_DITHER_NONE);
        assert_int_equal(film.white_balance, ALP_WHITE_BALANCE_OFF);
        assert_true(film.exposure == 0.0);
    }
    const alp_render_method light[] = {ALP_RENDER_HEMISPHERE, ALP_RENDER_REFERENCE};
    for (int i = 0; i < 2; i++) {
        alp_film_options film = alp_render_film_options(light[i]);
        assert_true(film.auto_exposure);
        assert_int_equal(film.tone, ALP_TONE_FILM);
        assert_int_equal(film.dither, ALP_DITHER_HASHED);
    }
}

/// A single-sided wall seen from behind is not in the picture of occlusion, as viewers leave it
/// out; the same wall of a double-sided material is.
TEST_WITH_CONTEXT(occlusion_shows_no_backs_of_single_sided_walls, 2)
{
    for (int double_sided = 0; double_sided < 2; double_sided++) {
        test_mesh *mesh = test_mesh_start();
        test_mesh_quad(mesh, (double[]){-5, -5, -4}, (double[]){0, 10, 0}, (double[]){10, 0, 0});
        alp_scene *scene = test_mesh_scene(context, mesh, double_sided);
        alp_render_options options = look_ahead();
        alp_image *image = NULL;
        options.method = ALP_RENDER_AO;
        options.samples = 8;
        ASSERT_OK(context, alp_render(scene, &options, &image));
        ASSERT_NEAR(alp_image_floats(image)[4 * (80 * 20 + 40) + 3], double_sided, 0.0);
        alp_image_destroy(image);
        alp_scene_destroy(scene);
    }
}
