// SPDX-License-Identifier: MIT
// Projection of equirectangular images.
#include "sh_directions.h"
#include "test_support.h"

#include "sh/cube_map.h"
#include "sh/equirect.h"

#include <stdlib.h>

typedef vec3 environment_fn(vec3 direction);

static alp_image *make_image(alp_context *context, uint32_t height, uint32_t channels,
                             environment_fn *environment)
{
    alp_image *image;
    const alp_image_info info = {2 * height, height, channels, ALP_COMPONENT_FLOAT};
    ASSERT_OK(context, alp_image_create(context, info, &image));
    float *pixel = alp_image_floats(image);
    for (uint32_t i = 0; i < info.width * height; i++, pixel += channels) {
        vec3_store(pixel, environment(alpi_equirect_direction(info.width, height, i % info.width,
                                                              i / info.width)));
    }
    return image;
}

static vec3 constant(vec3 direction)
{
    (void)direction;
    return (vec3){1.0f, 0.5f, 3.0f};
}

/// Bright around +Y, −Z and +X in red, green and blue.
static vec3 axes(vec3 d)
{
    return (vec3){fmaxf(d.y, 0.0f), fmaxf(-d.z, 0.0f), fmaxf(d.x, 0.0f)};
}

TEST(rows_sum_to_4_pi)
{
    for (uint32_t height = 1; height < 100; height++) {
        double one = 0.0, up = 0.0, aside = 0.0, up_up = 0.0, up_aside = 0.0;
        for (uint32_t y = 0; y < height; y++) {
            const alpi_equirect_row r = alpi_equirect_row_integrals(y, height);
            one += 2.0 * ALPI_PI * r.one;
            up += r.up;
            aside += r.aside;
            up_up += r.up_up;
            up_aside += r.up_aside;
        }
        ASSERT_NEAR(one, 4.0 * ALPI_PI, 1e-12);
        ASSERT_NEAR(up, 0.0, 1e-13);
        ASSERT_NEAR(aside, ALPI_PI / 2.0, 1e-13);
        ASSERT_NEAR(up_up, 2.0 / 3.0, 1e-13);
        ASSERT_NEAR(up_aside, 0.0, 1e-13);
    }
}

TEST_WITH_CONTEXT(constant_image_is_its_first_coefficient, 1)
{
    for (uint32_t height = 1; height < 40; height += 6) {
        alp_image *image = make_image(context, height, 3, constant);
        alp_sh9 c;
        ASSERT_OK(context, alp_sh_project_image(image, &c));
        for (int i = 0; i < 9; i++) {
            ASSERT_NEAR(c.c[i][0], i == 0 ? 2.0 * sqrt(ALPI_PI) : 0.0, 1e-6);
            ASSERT_NEAR(c.c[i][2], i == 0 ? 6.0 * sqrt(ALPI_PI) : 0.0, 2e-6);
        }
        alp_image_destroy(image);
    }
}

TEST_WITH_CONTEXT(the_layout_is_that_of_skies, 1)
{
    // A clamped cosine about d has c = Y(d) · (π, 2π/3, π/4).
    static const vec3 directions[3] = {{0, 1, 0}, {0, 0, -1}, {1, 0, 0}};
    alp_image *image = make_image(context, 256, 4, axes);
    alp_sh9 c;
    ASSERT_OK(context, alp_sh_project_image(image, &c));
    for (int k = 0; k < 3; k++) {
        float expected[9];
        alpi_sh9_irradiance_weights(directions[k], expected);
        for (int i = 0; i < 9; i++) {
            ASSERT_NEAR(c.c[i][k], expected[i], 1e-4);
        }
    }
    alp_image_destroy(image);
}

TEST_WITH_CONTEXT(images_and_cube_maps_agree, 2)
{
    enum { SIZE = 64 };
    alp_image *image = make_image(context, 128, 3, test_environment);
    float *pixels = malloc(sizeof(float) * 18 * SIZE * SIZE);
    const float *faces[6];
    alp_sh_projection *projection;
    alp_sh9 a, b;
    assert_non_null(pixels);
    for (uint32_t i = 0; i < 6 * SIZE * SIZE; i++) {
        const vec3 d = alpi_cube_texel_direction((alp_cube_face)(i / (SIZE * SIZE)), SIZE, i % SIZE,
                                                 i / SIZE % SIZE);
        vec3_store(pixels + (size_t)3 * i, test_environment(d));
    }
    for (size_t f = 0; f < 6; f++) {
        faces[f] = pixels + f * 3 * SIZE * SIZE;
    }
    ASSERT_OK(context, alp_sh_project_image(image, &a));
    ASSERT_OK(context, alp_sh_projection_create(context, SIZE, &projection));
    ASSERT_OK(context, alp_sh_project_cube(projection, faces, &b));
    for (int i = 0; i < 27; i++) {
        ASSERT_NEAR(a.c[i / 3][i % 3], b.c[i / 3][i % 3], 0.001);
    }
    alp_sh_projection_destroy(projection);
    alp_image_destroy(image);
    free(pixels);
}

static void project_with(uint32_t workers, const void *what, void *bytes)
{
    alp_context *context = test_context(workers);
    alp_image *image = make_image(context, 37, 3, test_environment);
    (void)what;
    ASSERT_OK(context, alp_sh_project_image(image, bytes));
    alp_image_destroy(image);
    alp_context_destroy(context);
}

TEST(any_workers_give_the_same_bits)
{
    free(test_any_workers(project_with, NULL, sizeof(alp_sh9)));
}

TEST_WITH_CONTEXT(unusable_values_count_as_for_skies, 1)
{
    alp_image *image = make_image(context, 4, 3, constant);
    float *pixels = alp_image_floats(image);
    alp_sh9 ours, expected;
    pixels[0] = -5.0f;
    pixels[4] = NAN;
    pixels[8] = INFINITY;
    pixels[11] = 2e30f;
    ASSERT_OK(context, alp_sh_project_image(image, &ours));
    assert_true(test_log_has("sky-image"));
    pixels[0] = pixels[4] = 0.0f;
    pixels[8] = pixels[11] = 3.0f;
    test_log_clear();
    ASSERT_OK(context, alp_sh_project_image(image, &expected));
    assert_false(test_log_has("sky-image"));
    assert_memory_equal(&ours, &expected, sizeof ours);
    alp_image_destroy(image);
}

TEST_WITH_CONTEXT(other_images_are_refused, 1)
{
    static const alp_image_info infos[] = {{4, 4, 3, ALP_COMPONENT_FLOAT},
                                           {8, 4, 2, ALP_COMPONENT_FLOAT},
                                           {8, 4, 3, ALP_COMPONENT_U8}};
    alp_sh9 c;
    for (int i = 0; i < 3; i++) {
        alp_image *image;
        ASSERT_OK(context, alp_image_create(context, infos[i], &image));
        assert_int_equal(alp_sh_project_image(image, &c), ALP_ERROR_INVALID_ARGUMENT);
        alp_image_destroy(image);
    }
    assert_int_equal(alp_sh_project_image(NULL, &c), ALP_ERROR_INVALID_ARGUMENT);
}

TEST(out_of_memory_is_reported)
{
    int left = 0;
    alp_context *context = test_context_failing(&left);
    alp_image *image = make_image(context, 4, 3, constant);
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    alp_sh9 c;
    int allowed = 0;
    for (; result == ALP_ERROR_OUT_OF_MEMORY; allowed++) {
        left = allowed;
        result = alp_sh_project_image(image, &c);
    }
    assert_int_equal(result, ALP_OK);
    assert_true(allowed > 2);
    alp_image_destroy(image);
    alp_context_destroy(context);
}
