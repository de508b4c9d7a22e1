// SPDX-License-Identifier: MIT
// Skies from equirectangular images: where each texel is seen, turned and wrapped; drawn directions
// against sums over the texels; values that are no radiance.
#include "sky_checks.h"

#include "base/image.h"
#include "base/random.h"

#include <math.h>

static const vec3 UP = {0.0f, 1.0f, 0.0f};

static alp_image *make_image(alp_context *context, uint32_t width, uint32_t height,
                             uint32_t channels)
{
    alp_image_info info = {width, height, channels, ALP_COMPONENT_FLOAT};
    alp_image *image = NULL;
    ASSERT_OK(context, alp_image_create(context, info, &image));
    return image;
}

static alp_image *noise(alp_context *context, uint32_t width, uint32_t height, uint32_t channels)
{
    alp_image *image = make_image(context, width, height, channels);
    float *values = alp_image_floats(image);
    for (uint32_t i = 0; i < width * height * channels; i++) {
        float random = alpi_unit_float(alpi_hash32(i + 1));
        values[i] = random * random * random * 10.0f;
    }
    return image;
}

static alpi_sky *image_sky(alp_context *context, const alp_image *image, float turn)
{
    alp_sky_options o = sky_options(ALP_SKY_IMAGE);
    o.image = image;
    o.turn = turn;
    return sky_make(context, &o, UP);
}

/// Direction of a place in the picture; whole numbers are texel centres.
static vec3 toward(const alp_image *image, double x, double y)
{
    alp_image_info info = alp_image_get_info(image);
    return sky_polar((y + 0.5) * ALPI_PI / info.height,
                     2.0 * ALPI_PI * ((x + 0.5) / info.width - 0.5));
}

TEST_WITH_CONTEXT(texels_are_where_they_belong, 1)
{
    for (uint32_t channels = 3; channels <= 4; channels++) {
        alp_image *image = noise(context, 64, 32, channels);
        alpi_sky *sky = image_sky(context, image, 0.0f);
        for (uint32_t y = 0; y < 32; y++) {
            for (uint32_t x = 0; x < 64; x++) {
                float rgba[4];
                alpi_image_pixel(image, x, y, rgba);
                vec3 radiance = alpi_sky_radiance(sky, toward(image, x, y));
                // A direction's rounding is about 1e-5 of a texel here, texels differ by up to 10;
                // near the poles azimuths are coarser.
                ASSERT_NEAR(radiance.x, rgba[0], 1e-3);
                ASSERT_NEAR(radiance.z, rgba[2], 1e-3);
            }
        }
        alpi_sky_destroy(context, sky);
        alp_image_destroy(image);
    }
}

TEST_WITH_CONTEXT(it_wraps_around_and_ends_at_the_poles, 1)
{
    alp_image *image = noise(context, 16, 8, 3);
    float *p = alp_image_floats(image);
    alpi_sky *sky = image_sky(context, image, 0.0f);
    for (int y = 0; y < 8; y++) {
        float last = p[(16 * y + 15) * 3], first = p[(16 * y) * 3];
        vec3 between = alpi_sky_radiance(sky, toward(image, 15.25, y));
        ASSERT_NEAR(between.x, 0.75f * last + 0.25f * first, 1e-4);
    }
    for (int x = 0; x < 16; x++) { // half a row more of the same, up to the pole
        ASSERT_NEAR(alpi_sky_radiance(sky, toward(image, x, -0.4)).y, p[x * 3 + 1], 1e-3);
        ASSERT_NEAR(alpi_sky_radiance(sky, toward(image, x, 7.4)).y, p[(16 * 7 + x) * 3 + 1], 1e-3);
    }
    vec3 middle = alpi_sky_radiance(sky, toward(image, 4.5, 3.5));
    ASSERT_NEAR(middle.z,
                (p[(16 * 3 + 4) * 3 + 2] + p[(16 * 3 + 5) * 3 + 2] + p[(16 * 4 + 4) * 3 + 2] +
                 p[(16 * 4 + 5) * 3 + 2]) /
                    4.0f,
                1e-4);
    alpi_sky_destroy(context, sky);
    alp_image_destroy(image);
}

/// The middle looks along −Z, to its right is +X; a quarter turn takes −Z to −X.
TEST_WITH_CONTEXT(a_turn_moves_the_picture, 1)
{
    alp_image *image = make_image(context, 32, 16, 3);
    float *p = alp_image_floats(image);
    for (int i = 0; i < 16 * 32; i++) {
        p[3 * i] = (float)(i % 32); // red counts columns
    }
    const vec3 forward = {0.0f, 0.0f, -1.0f}, right = {1.0f, 0.0f, 0.0f}, left = {-1.0f, 0, 0};
    alpi_sky *sky = image_sky(context, image, 0.0f);
    ASSERT_NEAR(alpi_sky_radiance(sky, forward).x, 15.5, 1e-4);
    ASSERT_NEAR(alpi_sky_radiance(sky, right).x, 23.5, 1e-4);
    ASSERT_NEAR(alpi_sky_radiance(sky, left).x, 7.5, 1e-4);
    alpi_sky_destroy(context, sky);
    sky = image_sky(context, image, (float)(ALPI_PI / 2.0));
    ASSERT_NEAR(alpi_sky_radiance(sky, left).x, 15.5, 1e-4);
    ASSERT_NEAR(alpi_sky_radiance(sky, forward).x, 23.5, 1e-4);
    alpi_sky_destroy(context, sky);
    for (int turns = -3; turns <= 3; turns += 3) { // by one texel, and by whole turns beside it
        sky = image_sky(context, image, (float)(2.0 * ALPI_PI * (1.0 / 32.0 + turns)));
        for (int x = 0; x < 32; x++) {
            ASSERT_NEAR(alpi_sky_radiance(sky, toward(image, x, 6.0)).x, (x + 1) % 32, 1e-3);
        }
        sky_check_density(sky, 256);
        alpi_sky_destroy(context, sky);
    }
    alp_image_destroy(image);
}

/// Many directions at once find what each finds alone, bit for bit, at the poles too, in pictures
/// and in other skies.
TEST_WITH_CONTEXT(many_find_what_each_finds, 1)
{
    enum { MOST = 256 };
    static const uint32_t counts[] = {0, 1, 31, 32, 33, MOST};
    alp_image *image = noise(context, 34, 17, 3);
    const alp_sky_options clear = sky_options(ALP_SKY_CLEAR);
    for (int kind = 0; kind < 2; kind++) {
        alpi_sky *sky = kind == 0 ? image_sky(context, image, 1.0f) : sky_make(context, &clear, UP);
        vec3 directions[MOST], found[MOST + 1];
        for (int i = 0; i < MOST; i++) {
            directions[i] = sky_polar(ALPI_PI * i / (MOST - 1), 0.37 * i);
        }
        for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
            memset(found, 0x55, sizeof found);
            const vec3 untouched = found[counts[c]];
            alpi_sky_radiances(sky, directions, counts[c], found);
            for (uint32_t i = 0; i < counts[c]; i++) {
                const vec3 one = alpi_sky_radiance(sky, directions[i]);
                assert_memory_equal(&found[i], &one, sizeof one);
            }
            assert_memory_equal(&found[counts[c]], &untouched, sizeof untouched);
        }
        alpi_sky_destroy(context, sky);
    }
    alp_image_destroy(image);
}

TEST_WITH_CONTEXT(drawn_directions_follow_the_picture, 1)
{
    const uint32_t heights[] = {1, 2, 5, 32};
    for (int i = 0; i < 4; i++) {
        alp_image *image = noise(context, 2 * heights[i], heights[i], 3);
        alpi_sky *sky = image_sky(context, image, 0.3f);
        sky_check_density(sky, 512);
        const vec3 normals[] = {UP, {0.0f, -1.0f, 0.0f}, {0.48f, 0.6f, 0.64f}};
        for (int n = 0; n < 3; n++) {
            double drawn[3], error[3], sum[3];
            sky_irradiance_drawn(sky, normals[n], 40000, drawn, error);
            sky_irradiance_sum(sky, normals[n], 512, sum);
            for (int k = 0; k < 3; k++) {
                ASSERT_NEAR(drawn[k], sum[k], 4.0 * error[k] + 1e-4 * sum[k]);
            }
        }
        alpi_sky_destroy(context, sky);
        alp_image_destroy(image);
    }
}

/// The mean is exact for the bilinear function, which a picture of few texels shows best.
TEST_WITH_CONTEXT(the_mean_is_the_integral, 1)
{
    alp_image *image = noise(context, 6, 3, 3);
    alpi_sky *sky = image_sky(context, image, 0.0f);
    double up[3], down[3], sum = 0.0;
    enum { ROWS = 600 };
    double step = ALPI_PI / ROWS;
    for (int j = 0; j < ROWS; j++) {
        double area = step * (cos(j * step) - cos((j + 1) * step));
        for (int i = 0; i < 2 * ROWS; i++) {
            vec3 d = sky_polar((j + 0.5) * step, (i + 0.5) * step);
            sum += (double)alpi_sky_radiance(sky, d).y * area;
        }
    }
    sky_irradiance_sum(sky, UP, ROWS, up);
    sky_irradiance_sum(sky, (vec3){0.0f, -1.0f, 0.0f}, ROWS, down);
    ASSERT_NEAR(alpi_sky_mean(sky).y, sum / (4.0 * ALPI_PI), 1e-5 * sum); // midpoints
    alpi_sky_destroy(context, sky);
    alp_image_destroy(image);
}

/// A sun in one texel of a black sky: every direction goes there, and hardly any noise is left.
TEST_WITH_CONTEXT(one_bright_texel, 1)
{
    const uint32_t places[][2] = {{100, 40}, {0, 90}, {255, 1}, {3, 0}, {7, 127}};
    for (int i = 0; i < 5; i++) {
        alp_image *image = make_image(context, 256, 128, 3);
        uint32_t x = places[i][0], y = places[i][1];
        float *pixel = alp_image_floats(image) + ((size_t)y * 256 + x) * 3;
        pixel[0] = 1e6f;
        pixel[1] = 8e5f;
        alpi_sky *sky = image_sky(context, image, 0.0f);
        vec3 center = toward(image, x, y);
        double sum = 0.0, squares = 0.0;
        for (uint32_t k = 0; k < 4; k++) { // black cells stand before and behind the bright ones
            vec2 corner = {k & 1 ? 0.0f : 0x1.fffffep-1f, k & 2 ? 0.0f : 0x1.fffffep-1f};
            float density = 0.0f;
            vec3 d = alpi_sky_sample(sky, corner, &density);
            assert_true(density > 0.0f);
            assert_true((double)vec3_length(vec3_sub(d, center)) < 1.5 * ALPI_PI / 128.0);
        }
        for (uint32_t k = 0; k < 10000; k++) {
            float density = 0.0f;
            vec3 d = alpi_sky_sample(sky, alpi_sample_2d(1, k), &density);
            // No further than a texel in each way.
            assert_true((double)vec3_length(vec3_sub(d, center)) < 1.5 * ALPI_PI / 128.0);
            double value = (double)alpi_sky_radiance(sky, d).x / (double)density;
            sum += value;
            squares += value * value;
        }
        double mean = sum / 10000.0, deviation = sqrt(fmax(squares / 10000.0 - mean * mean, 0.0));
        // Radiance is linear in θ, the density in cosθ: across a cell they differ by about the
        // step of θ times cot θ, and by a factor of up to 2 beside the poles.
        double theta = (y + 0.5) * ALPI_PI / 128.0, step = ALPI_PI / 128.0;
        ASSERT_NEAR(deviation / mean, 0.0, 0.5 * step * fabs(cos(theta) / sin(theta)) + 1e-4);
        ASSERT_NEAR(mean / (4.0 * ALPI_PI * (double)alpi_sky_mean(sky).x), 1.0,
                    4.0 * deviation / mean / 100.0 + 1e-5);
        alpi_sky_destroy(context, sky);
        alp_image_destroy(image);
    }
}

TEST_WITH_CONTEXT(what_is_no_radiance_is_cleaned, 1)
{
    alp_image *image = make_image(context, 8, 4, 4);
    float *p = alp_image_floats(image);
    for (int i = 0; i < 8 * 4 * 4; i++) {
        p[i] = i % 4 == 3 ? NAN : 1.0f; // alpha is nobody's business
    }
    test_log_clear();
    alpi_sky *sky = image_sky(context, image, 0.0f);
    assert_false(test_log_has("sky-image"));
    alpi_sky_destroy(context, sky);
    p[4 * 9] = NAN;
    p[4 * 9 + 1] = -5.0f;
    p[4 * 9 + 2] = INFINITY;
    p[4 * 11] = 7.0f;
    p[4 * 12 + 2] = 2e30f;
    p[4 * 13 + 2] = -INFINITY;
    sky = image_sky(context, image, 0.0f);
    assert_non_null(strstr(test_log_text(), "3 values are negative or NaN"));
    assert_non_null(strstr(test_log_text(), "2 are infinite and count as its brightest, 7"));
    vec3 radiance = alpi_sky_radiance(sky, toward(image, 1, 1));
    ASSERT_NEAR(radiance.x, 0.0, 1e-4);
    ASSERT_NEAR(radiance.y, 0.0, 1e-4);
    ASSERT_NEAR(radiance.z, 7.0, 1e-4);
    ASSERT_NEAR(alpi_sky_radiance(sky, toward(image, 4, 1)).z, 7.0, 1e-4);
    alpi_sky_destroy(context, sky);
    for (int i = 0; i < 8 * 4 * 4; i++) {
        p[i] = INFINITY; // nothing to go by: black
    }
    alp_sky_options o = sky_options(ALP_SKY_IMAGE);
    o.image = image;
    ASSERT_OK(context, alpi_sky_create(context, &o, UP, &sky));
    assert_null(sky);
    alp_image_destroy(image);
}

TEST_WITH_CONTEXT(wrong_images_are_named, 1)
{
    alp_sky_options o = sky_options(ALP_SKY_IMAGE);
    sky_refuse(context, &o, UP, "the image is NULL");
    const struct {
        alp_image_info info;
        const char *word;
    } cases[] = {
        {{8, 4, 3, ALP_COMPONENT_U8}, "8 bits"},
        {{8, 4, 1, ALP_COMPONENT_FLOAT}, "1 channel;"},
        {{8, 4, 2, ALP_COMPONENT_FLOAT}, "2 channels"},
        {{8, 5, 3, ALP_COMPONENT_FLOAT}, "8 x 5"},
        {{9, 4, 3, ALP_COMPONENT_FLOAT}, "twice as wide"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alp_image *image = NULL;
        ASSERT_OK(context, alp_image_create(context, cases[i].info, &image));
        o.image = image;
        sky_refuse(context, &o, UP, cases[i].word);
        alp_image_destroy(image);
    }
    alp_image *image = noise(context, 8, 4, 3);
    o.image = image;
    o.strength = 1e30f;
    sky_refuse(context, &o, UP, "lower it");
    alp_image_destroy(image);
}

TEST(every_failed_allocation_is_reported)
{
    int left = 0;
    alp_context *context = test_context_failing(&left);
    alp_image *image = noise(context, 8, 4, 3);
    alp_sky_options o = sky_options(ALP_SKY_IMAGE);
    o.image = image;
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    alpi_sky *sky = NULL;
    int allowed = 0;
    for (; result != ALP_OK; allowed++) {
        left = allowed;
        result = alpi_sky_create(context, &o, UP, &sky);
        assert_true(result == ALP_OK || (result == ALP_ERROR_OUT_OF_MEMORY && sky == NULL));
    }
    assert_int_equal(allowed, 7); // the sky and its table's five, and one to see that it is enough
    left = 1000;
    alpi_sky_destroy(context, sky);
    alp_image_destroy(image);
    alp_context_destroy(context);
}

/// E of a level surface: 10⁵ drawn directions against the sum over the picture's texels.
TEST_WITH_CONTEXT(real_skies, 1)
{
    static const char *const files[] = {"scenes/hdr/interior_512.hdr", "scenes/hdr/sunset_512.hdr",
                                        "scenes/hdr/royal_esplanade_1k.hdr",
                                        "scenes/hdr/spiaggia_di_mondello_1k.hdr"};
    if (test_shared(files[0]) == NULL) {
        skip();
    }
    for (int i = 0; i < 4; i++) {
        alp_image *image = NULL;
        ASSERT_OK(context, alp_image_load(context, test_shared(files[i]), &image));
        alp_image_info info = alp_image_get_info(image);
        double sum[3] = {0.0}, drawn[3], error[3];
        for (uint32_t y = 0; y < info.height / 2; y++) {
            // ∫ cosθ sinθ dθ over the row
            double a = sin(y * ALPI_PI / info.height), b = sin((y + 1) * ALPI_PI / info.height);
            for (uint32_t x = 0; x < info.width; x++) {
                float rgba[4];
                alpi_image_pixel(image, x, y, rgba);
                for (int k = 0; k < 3; k++) {
                    sum[k] += (double)rgba[k] * (b * b - a * a) * ALPI_PI / info.width;
                }
            }
        }
        alpi_sky *sky = image_sky(context, image, 1.0f);
        sky_irradiance_drawn(sky, UP, 100000, drawn, error);
        for (int k = 0; k < 3; k++) {
            ASSERT_NEAR(drawn[k], sum[k], 4.0 * error[k]);
        }
        alpi_sky_destroy(context, sky);
        alp_image_destroy(image);
    }
}
