// SPDX-License-Identifier: MIT
// Pictures of hemicubes: what is seen from a point, against cameras there, and what it counts for.
#include "test_support.h"

#include "base/vec.h"

#include <math.h>

enum { N = 32, SIDE = 2 * N, PIXELS = SIDE * SIDE };
typedef float picture[PIXELS][4];

TEST_CONTEXT(2);

static alp_camera camera_at(vec3 position, vec3 target, float fov)
{
    alp_camera c = {.vertical_fov = fov};
    vec3_store(c.position, position);
    vec3_store(c.target, target);
    const bool level = fabsf(target.x - position.x) + fabsf(target.z - position.z) > 1e-6f;
    c.up[1] = level ? 1.0f : 0.0f;
    c.up[2] = level ? 0.0f : -1.0f;
    return c;
}

static alp_render_options options_of(alp_hemicube_show show, vec3 position, vec3 target)
{
    alp_render_options o = alp_render_options_default();
    o.method = ALP_RENDER_HEMICUBE;
    o.hemicube = N;
    o.hemicube_show = show;
    o.camera = camera_at(position, target, 1.0f);
    o.atlas.size = 256;
    return o;
}

static void draw(const alp_scene *scene, const alp_render_options *o, picture pixels)
{
    alp_image *image = NULL;
    ASSERT_OK(context, alp_render(scene, o, &image));
    const alp_image_info info = alp_image_get_info(image);
    assert_true(info.width == SIDE && info.height == SIDE && info.channels == 4);
    memcpy(pixels, alp_image_floats(image), sizeof(picture));
    alp_image_destroy(image);
}

static bool is_corner(uint32_t i)
{
    const uint32_t c = i % SIDE, r = i / SIDE;
    return (c < N / 2 || c >= N + N / 2) && (r < N / 2 || r >= N + N / 2);
}

static const vec3 ON_WALL = {0.0f, 0.25f, 0.28f}, INTO_ROOM = {0.5f, 0.25f, 0.28f};

/// Weights make 1, a Lambertian π; the product is what is seen times them; corners are black.
TEST(weights_and_products)
{
    static picture seen, product, weight, cosines[2];
    alp_scene *scene = test_load(context, "builtin:cornell");
    float(*const pictures[])[4] = {seen, product, weight, cosines[0], cosines[1]};
    double sum = 0.0;
    test_log_clear();
    for (int k = 0; k < 5; k++) {
        const alp_render_options o = options_of((alp_hemicube_show)k, ON_WALL, INTO_ROOM);
        draw(scene, &o, pictures[k]);
        for (uint32_t i = 0; i < PIXELS; i++) {
            assert_true(pictures[k][i][3] == 1.0f);
            assert_true(!is_corner(i) || pictures[k][i][0] == 0.0f);
        }
    }
    assert_false(test_log_has("camera-inside")); // on a wall is not in it
    for (uint32_t i = 0; i < PIXELS; i++) {
        sum += (double)weight[i][0] * 4.0 / (ALPI_PI * N * N);
        for (int k = 0; k < 3; k++) {
            assert_true(product[i][k] == seen[i][k] * weight[i][0]);
            // The middle of a pixel against its mean: .065 % at 64, as the square of its size.
            ASSERT_NEAR(weight[i][k], cosines[0][i][k] * cosines[1][i][k],
                        0.0026 * (double)weight[i][k]);
        }
    }
    ASSERT_NEAR(ALPI_PI * sum, ALPI_PI, 1e-6); // floats
    alp_scene_destroy(scene);
}

/// The means of 4 × 4 pixels in the middle of the front face.
static void middle_of(const float (*pixels)[4], uint32_t side, double mean[3])
{
    for (int k = 0; k < 3; k++) {
        mean[k] = 0.0;
        for (uint32_t i = 0; i < 16; i++) {
            const uint32_t c = side / 2 - 2 + i % 4, r = side / 2 - 2 + i / 4;
            mean[k] += (double)pixels[r * side + c][k] / 16.0;
        }
    }
}

/// A camera of 90° at the same place shows what the front face shows, by paths: of plain walls,
/// which pixels cut alike.
TEST_SLOW(the_front_face_sees_what_a_camera_sees)
{
    static const vec3 places[3][2] = {{{0.0f, 0.45f, 0.28f}, {0.5f, 0.45f, 0.28f}},
                                      {{0.278f, 0.45f, 0.01f}, {0.278f, 0.45f, 0.5f}},
                                      {{0.15f, 0.1f, 0.4f}, {0.15f, 1.0f, 0.4f}}};
    static const uint32_t bounces[3] = {ALP_BOUNCES_CONVERGE, 0, 1};
    static picture seen;
    alp_scene *scene = test_load(context, "builtin:cornell");
    for (int i = 0; i < 3; i++) {
        alp_render_options o = options_of(ALP_HEMICUBE_SEEN, places[i][0], places[i][1]);
        alp_image *image = NULL, *errors = NULL;
        double cube[3], camera[3], errors_mean[3];
        o.bounces = bounces[i];
        draw(scene, &o, seen);
        middle_of((const float(*)[4])seen, SIDE, cube);
        o.method = ALP_RENDER_REFERENCE;
        o.width = o.height = N;
        o.samples = 512;
        o.camera = camera_at(places[i][0], places[i][1], (float)(ALPI_PI / 2.0));
        o.camera.position[0] += i == 0 ? 1e-5f : 0.0f; // a camera stands before the wall

        o.error = &errors;
        ASSERT_OK(context, alp_render(scene, &o, &image));
        middle_of((const float(*)[4])alp_image_floats(image), N, camera);
        middle_of((const float(*)[4])alp_image_floats(errors), N, errors_mean);
        for (int k = 0; k < 3; k++) {
            // Four standard errors of 16 pixels, and a radiosity's own: rays of its blocks, 16
            // samples of direct light on texels, and their size.
            ASSERT_NEAR(cube[k], camera[k], errors_mean[k] + 0.02 * camera[k]);
            assert_true(camera[k] > 0.0);
        }
        alp_image_destroy(image);
        alp_image_destroy(errors);
    }
    alp_scene_destroy(scene);
}

/// Straight up to the lamp: what it emits, and no lamp is seen that is a point.
TEST(emitters_and_skies_are_seen)
{
    static picture seen;
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_render_options o =
        options_of(ALP_HEMICUBE_SEEN, (vec3){0.278f, 0.4f, 0.28f}, (vec3){0.278f, 0.5f, 0.28f});
    o.bounces = 0;
    draw(scene, &o, seen);
    const float *ahead = seen[N * SIDE + N];
    assert_true(ahead[0] > ahead[1] && ahead[1] > ahead[2]);
    ASSERT_NEAR(ahead[0], 20.717, 0.05); // and a little that it reflects
    alp_scene_destroy(scene);
    scene = test_load(context, "builtin:sphere-plane");
    o = options_of(ALP_HEMICUBE_SEEN, (vec3){0.0f, 8.0f, 0.0f}, (vec3){0.0f, 9.0f, 0.0f});
    alp_lamp lamp = alp_lamp_default();
    lamp.position[1] = 9.0f;
    o.lighting.lamps = &lamp;
    o.lighting.lamp_count = 1;
    o.lighting.sky =
        (alp_sky_options){.kind = ALP_SKY_CONSTANT, .up = {1.0f, 2.0f, 3.0f}, .strength = 2.0f};
    draw(scene, &o, seen);
    for (uint32_t i = 0; i < PIXELS; i++) {
        for (int k = 0; k < 3; k++) {
            assert_true(seen[i][k] == (is_corner(i) ? 0.0f : 2.0f * (float)(k + 1)));
        }
    }
    alp_scene_destroy(scene);
}

TEST(any_number_of_workers)
{
    static picture pictures[2];
    for (int i = 0; i < 2; i++) {
        alp_context *own = test_context(i == 0 ? 1 : 3);
        alp_scene *scene = test_load(own, "builtin:cornell");
        alp_render_options o = options_of(ALP_HEMICUBE_PRODUCT, ON_WALL, INTO_ROOM);
        o.atlas.size = 64;
        draw(scene, &o, pictures[i]);
        alp_scene_destroy(scene);
        alp_context_destroy(own);
    }
    assert_memory_equal(pictures[0], pictures[1], sizeof(picture));
}

TEST(what_is_no_hemicube_is_refused)
{
    static const struct {
        uint32_t pixels;
        int show;
    } bad[] = {{0, 0}, {31, 0}, {1026, 0}, {32, -1}, {32, 5}};
    alp_scene *scene = test_load(context, "builtin:cornell");
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        alp_render_options o = options_of((alp_hemicube_show)bad[i].show, ON_WALL, INTO_ROOM);
        alp_image *image = NULL;
        o.hemicube = bad[i].pixels;
        assert_int_equal(alp_render(scene, &o, &image), ALP_ERROR_INVALID_ARGUMENT);
        assert_null(image);
    }
    alp_scene_destroy(scene);
}

/// Every allocation of it may fail.
TEST(lack_of_memory_is_told)
{
    int left = 1 << 30;
    alp_context *failing = test_context_failing(&left);
    alp_scene *scene = test_load(failing, "builtin:furnace");
    alp_render_options o = options_of(ALP_HEMICUBE_SEEN, (vec3){0, 0, 0}, (vec3){0, 0, 1});
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    o.hemicube = 8;
    o.atlas.size = 16;
    for (int most = 0; result == ALP_ERROR_OUT_OF_MEMORY; most += 3) {
        alp_image *image = NULL;
        left = most;
        result = alp_render(scene, &o, &image);
        assert_true((image != NULL) == (result == ALP_OK));
        alp_image_destroy(image);
    }
    assert_int_equal(result, ALP_OK);
    left = 1 << 30;
    alp_scene_destroy(scene);
    alp_context_destroy(failing);
}
