// SPDX-License-Identifier: MIT
// Pictures of what hemicubes see and of their weights.
#include "test_direct_stage.h"

#include "transport/gather/hemicube_picture.h"

#include <math.h>

static const vec3 BLACK = {0, 0, 0};
/// Of the walls towards −x, +x, −y, +y, −z, +z.
static const vec3 COLORS[6] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}};
static alp_context *context;
static test_stage room; // [−1, 1]³ seen from inside, each wall of another emission
static alpi_hemicube *cube;

enum { N = 8, SIDE = 2 * N };

static void open_room(void)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    context = test_context(1);
    alpi_builder_start(&b, context, "room");
    for (int i = 0; i < 6; i++) {
        alpi_builder_surface(&b, "wall", alpi_builder_material(&b, "wall", BLACK, COLORS[i]));
        alpi_builder_box(&b, (vec3){1, 1, 1}, (vec3){-1, -1, -1}, 1u << i);
    }
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    room = test_stage_open(context, scene, NULL, 0, NULL);
    ASSERT_OK(context, alpi_hemicube_create(context, N, &cube));
}

static void close_room(void)
{
    alpi_hemicube_destroy(cube);
    test_stage_close(&room);
    alp_context_destroy(context);
}
TEST_AROUND(open_room, close_room);

static alpi_hemicube_options room_options(void)
{
    return (alpi_hemicube_options){
        .context = context,
        .from = {.scene = room.scene, .tracer = room.tracer, .emitters = true},
        .cube = cube};
}

static const float *pixel(alp_image *image, uint32_t column, uint32_t row)
{
    return alp_image_floats(image) + 4 * (SIDE * row + column);
}

static void assert_color(alp_image *image, uint32_t column, uint32_t row, vec3 expected)
{
    float rgb[3];
    vec3_store(rgb, expected);
    for (int k = 0; k < 3; k++) {
        assert_true(pixel(image, column, row)[k] == rgb[k]);
    }
    assert_true(pixel(image, column, row)[3] == 1.0f);
}

/// In the middle of a room each face of the cube sees one wall, and all of its pixels do.
TEST(each_face_sees_its_wall)
{
    // Walls seen ahead, above, below, left and right. Looking along −z, +x is on the right.
    static const struct {
        vec3 normal;
        int walls[5];
    } looks[] = {{{0, 0, -1}, {4, 3, 2, 0, 1}}, {{0, 0, 1}, {5, 3, 2, 1, 0}},
                 {{1, 0, 0}, {1, 3, 2, 4, 5}},  {{-1, 0, 0}, {0, 3, 2, 5, 4}},
                 {{0, 1, 0}, {3, 4, 5, 1, 0}},  {{0, -1, 0}, {2, 4, 5, 0, 1}}};
    for (int i = 0; i < 6; i++) {
        const alpi_hemicube_options o = room_options();
        const alpi_receiver_point p = {BLACK, looks[i].normal, looks[i].normal, 0.0f};
        const alpi_hemicube_frame f = alpi_hemicube_frame_upright(looks[i].normal);
        alp_image *image = NULL;
        ASSERT_OK(context, alpi_hemicube_draw_view(&o, &p, &f, false, &image));
        for (uint32_t r = 0; r < SIDE; r++) {
            for (uint32_t c = 0; c < SIDE; c++) {
                const bool aside = c < N / 2 || c >= N + N / 2, high = r < N / 2;
                const bool low = r >= N + N / 2;
                if (aside && (high || low)) {
                    assert_true(pixel(image, c, r)[3] == 0.0f && pixel(image, c, r)[0] == 0.0f);
                    continue;
                }
                const int face = high ? 1 : (low ? 2 : (c < N / 2 ? 3 : (aside ? 4 : 0)));
                assert_color(image, c, r, COLORS[looks[i].walls[face]]);
            }
        }
        alp_image_destroy(image);
    }
}

/// The seed's third column: the sum of its pixels is the light gathered.
TEST(weighted_pixels_sum_to_the_light)
{
    const alpi_hemicube_options o = room_options();
    const vec3 n = {0.48f, -0.6f, 0.64f};
    const alpi_receiver_point p = {{0.3f, 0.2f, -0.5f}, n, n, 0.0f};
    const alpi_hemicube_frame f = alpi_hemicube_frame_upright(n);
    alp_image *image = NULL;
    float e[3];
    double sum[3] = {0.0, 0.0, 0.0};
    ASSERT_OK(context, alpi_hemicube_gather_in(&o, &p, &f, e));
    ASSERT_OK(context, alpi_hemicube_draw_view(&o, &p, &f, true, &image));
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        for (int k = 0; k < 3; k++) {
            sum[k] += (double)pixel(image, i % SIDE, i / SIDE)[k];
        }
    }
    for (int k = 0; k < 3; k++) {
        assert_true(e[k] > 0.5f);
        ASSERT_NEAR(sum[k] * 4.0 / (N * N), e[k], 1e-6 * (double)e[k]); // floats are summed
    }
    alp_image_destroy(image);
}

/// 1 straight ahead, and the product of the other two maps up to what a pixel's middle misses:
/// known cosines at some pixels.
TEST(maps_of_multipliers)
{
    alp_image *maps[3];
    for (int k = 0; k < 3; k++) {
        ASSERT_OK(context, alpi_hemicube_draw_map(cube, (alpi_hemicube_map)k, &maps[k]));
        assert_true(pixel(maps[k], 0, 0)[3] == 0.0f);
    }
    const double ahead = 1.0 / sqrt(1.0 + 2.0 / (N * N)); // half a pixel off the axis, both ways
    ASSERT_NEAR(pixel(maps[0], N, N)[0], pow(ahead, 3), 1e-6);
    ASSERT_NEAR(pixel(maps[1], N, N)[0], ahead, 1e-6);
    const double x = 1.0 / N, z = 1.0 / N, low = 1.0 / sqrt(1.0 + x * x + z * z);
    ASSERT_NEAR(pixel(maps[0], N, 0)[0], pow(low, 3), 1e-6);
    ASSERT_NEAR(pixel(maps[1], N, 0)[0], z * low, 1e-6);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const uint32_t c = i % SIDE, r = i / SIDE;
        const double product = (double)pixel(maps[0], c, r)[0] * (double)pixel(maps[1], c, r)[0];
        // .065 % at 64 pixels, and as the square of a pixel's size.
        ASSERT_NEAR(pixel(maps[2], c, r)[0], product, 0.00065 * 64 * product);
        assert_true(pixel(maps[2], c, r)[1] == pixel(maps[2], c, r)[0]);
    }
    for (int k = 0; k < 3; k++) {
        alp_image_destroy(maps[k]);
    }
}

TEST(lack_of_memory_is_told)
{
    int left;
    alp_context *failing = test_context_failing(&left);
    alpi_hemicube_options o = room_options();
    const vec3 n = {0, 0, 1};
    const alpi_receiver_point p = {BLACK, n, n, 0.0f};
    const alpi_hemicube_frame f = alpi_hemicube_frame_upright(n);
    alp_image *image = NULL;
    o.context = failing;
    left = 0;
    assert_int_equal(alpi_hemicube_draw_view(&o, &p, &f, false, &image), ALP_ERROR_OUT_OF_MEMORY);
    assert_null(image);
    alp_context_destroy(failing);
}
