// SPDX-License-Identifier: MIT
// A sky of an image, parted into a soft one and bright spots: both add up to it; looks drawn
// beforehand against sums over the picture, and their order.
#include "sky_checks.h"

#include "base/image.h"
#include "base/memory.h"
#include "base/random.h"
#include "scene/sky/sky_spots.h"

#include <math.h>

static const vec3 UP = {0.0f, 1.0f, 0.0f};
enum { HEIGHT = 32, WIDTH = 2 * HEIGHT };

/// Dim noise with a sun of one texel and a lamp of a dozen.
static alp_image *make_picture(alp_context *context)
{
    const alp_image_info info = {WIDTH, HEIGHT, 3, ALP_COMPONENT_FLOAT};
    alp_image *image = NULL;
    ASSERT_OK(context, alp_image_create(context, info, &image));
    float *values = alp_image_floats(image);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        const uint32_t x = i % WIDTH, y = i / WIDTH;
        const bool sun = x == 20 && y == 9, lamp = x >= 40 && x < 44 && y >= 4 && y < 7;
        for (uint32_t k = 0; k < 3; k++) {
            const float random = alpi_unit_float(alpi_hash32(3 * i + k + 1));
            values[3 * i + k] = sun ? 900.0f - 200.0f * (float)k : lamp ? 30.0f : random;
        }
    }
    return image;
}

typedef struct stage {
    alp_context *context;
    alp_image *image;
    alpi_sky *sky, *soft, *spots;
} stage;

static stage start(float turn)
{
    stage s = {.context = test_context(1)};
    s.image = make_picture(s.context);
    alp_sky_options o = sky_options(ALP_SKY_IMAGE);
    o.image = s.image;
    o.turn = turn;
    s.sky = sky_make(s.context, &o, UP);
    ASSERT_OK(s.context, alpi_sky_split(s.context, s.sky, &s.soft, &s.spots));
    assert_non_null(s.soft);
    assert_non_null(s.spots);
    assert_true(alpi_sky_spot_looks(s.spots) != NULL && alpi_sky_spot_looks(s.soft) == NULL);
    return s;
}

static void finish(stage *s)
{
    alpi_sky_destroy(s->context, s->sky);
    alpi_sky_destroy(s->context, s->soft);
    alpi_sky_destroy(s->context, s->spots);
    alp_image_destroy(s->image);
    alp_context_destroy(s->context);
}

TEST(both_add_up)
{
    stage s = start(0.7f);
    double squares = 0.0, sum = 0.0;
    enum { LOOKS = 20000 };
    for (uint32_t i = 0; i < LOOKS; i++) {
        const vec2 u = alpi_sample_2d(1, i);
        const vec3 d =
            sky_polar(acos(1.0 - 2.0 * (double)u.x), 2.0 * ALPI_PI * (double)u.y - ALPI_PI);
        const vec3 whole = alpi_sky_radiance(s.sky, d);
        const vec3 soft = alpi_sky_radiance(s.soft, d), spot = alpi_sky_radiance(s.spots, d);
        ASSERT_NEAR(soft.x + spot.x, whole.x, 1e-6 * (double)whole.x); // three roundings
        ASSERT_NEAR(soft.z + spot.z, whole.z, 1e-6 * (double)whole.z);
        assert_true(spot.y >= 0.0f && soft.y >= 0.0f);
        sum += alpi_sky_brightness(soft) / LOOKS;
        squares += alpi_sky_brightness(soft) * alpi_sky_brightness(soft) / LOOKS;
    }
    // Means over pixels, between which it is bilinear and a little more even.
    assert_true(squares / (sum * sum) < 1.45 && squares / (sum * sum) > 1.2);
    const vec3 mean = alpi_sky_mean(s.sky), soft = alpi_sky_mean(s.soft);
    ASSERT_NEAR(soft.x + alpi_sky_mean(s.spots).x, mean.x, 1e-6 * (double)mean.x);
    finish(&s);
}

/// All looks are a sum over the picture, and one in many of them, from anywhere on, nearly so.
TEST(looks_are_the_light_of_the_spots)
{
    stage s = start(0.3f);
    const alpi_sky_looks *looks = alpi_sky_spot_looks(s.spots);
    const vec3 normals[] = {UP, {0.6f, 0.0f, 0.8f}, {-0.48f, 0.6f, 0.64f}};
    for (int n = 0; n < 3; n++) {
        double sum[3];
        sky_irradiance_sum(s.spots, normals[n], 1024, sum);
        for (uint32_t every = 1; every <= 64; every *= 64) {
            double drawn = 0.0;
            for (uint32_t k = every / 3; k < ALPI_SKY_LOOKS; k += every) {
                const vec3 d = {looks->direction[0][k], looks->direction[1][k],
                                looks->direction[2][k]};
                drawn +=
                    fmax((double)vec3_dot(d, normals[n]), 0.0) * (double)looks->light[0][k] * every;
            }
            // Sums of 1024 rows, and what is left to chance in cells of which many looks are one.
            ASSERT_NEAR(drawn, sum[0], (every == 1 ? 1e-3 : 1e-2) * sum[0]);
        }
    }
    finish(&s);
}

/// Of an even table Hilbert's curve goes from cell to neighbouring cell.
TEST_WITH_CONTEXT(looks_that_follow_each_other_are_neighbours, 1)
{
    alpi_sky_table table;
    alpi_sky_looks *looks = NULL;
    ASSERT_OK(context, alpi_sky_table_create(context, 64, 32, 0.0f, &table));
    for (uint32_t i = 0; i < 64 * 32; i++) {
        table.pixels[i] = (vec3){1.0f, 1.0f, 1.0f};
    }
    alpi_sky_table_finish(&table);
    ASSERT_OK(context, alpi_sky_spots_look(context, &table, &looks));
    // A cell's sides are at most π/32; two neighbours are at most √5 of that apart, and from the
    // half rows at the poles it is as far.
    for (uint32_t i = 1; i < ALPI_SKY_LOOKS; i++) {
        double squares = 0.0;
        for (int c = 0; c < 3; c++) {
            const double step = (double)looks->direction[c][i] - (double)looks->direction[c][i - 1];
            squares += step * step;
        }
        assert_true(sqrt(squares) < sqrt(5.0) * ALPI_PI / 32.0);
    }
    alpi_release(context, looks);
    alpi_sky_table_release(context, &table);
}

/// A gradient over a black ground is uneven at any level: it stays soft, its lamp does not.
TEST_WITH_CONTEXT(black_ground_leaves_the_sky_soft, 1)
{
    alpi_sky_table table, soft, spots;
    ASSERT_OK(context, alpi_sky_table_create(context, WIDTH, HEIGHT, 0.0f, &table));
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        const uint32_t y = i / WIDTH;
        const float up = y < HEIGHT / 2 ? 1.0f + 0.02f * (float)y : 0.0f;
        const float lamp = y == 5 && i % WIDTH == 7 ? 500.0f : up;
        table.pixels[i] = (vec3){lamp, lamp, lamp};
    }
    alpi_sky_table_finish(&table);
    ASSERT_OK(context, alpi_sky_spots_part(context, &table, 1.4, &soft, &spots));
    uint32_t lit = 0;
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        lit += spots.pixels[i].x > 0.0f;
    }
    assert_int_equal(lit, 1);
    alpi_sky_table_release(context, &spots);
    alpi_sky_table_release(context, &soft);
    alpi_sky_table_release(context, &table);
}

/// The cell of a sum, one by one. @return its index  @param rest out: the place in it
static uint32_t search(const double *sums, double u, float *rest)
{
    uint32_t i = 0;
    while (sums[i] <= u) {
        i++;
    }
    const double below = i > 0 ? sums[i - 1] : 0.0;
    *rest = (float)((u - below) / (sums[i] - below));
    return i;
}

/// Rows that are black, have one lit texel, many black ones, and fewer cells than there are guides.
TEST_WITH_CONTEXT(guides_lead_to_the_cell, 1)
{
    enum { ROWS = 5, TRIES = 4096 };
    static const uint32_t widths[3] = {3, 64, 1000};
    for (int w = 0; w < 3; w++) {
        alpi_sky_table t;
        const uint32_t width = widths[w];
        ASSERT_OK(context, alpi_sky_table_create(context, width, ROWS, 0.2f, &t));
        for (uint32_t i = 0; i < width * ROWS; i++) {
            const uint32_t x = i % width, y = i / width, random = alpi_hash32(i);
            const bool lit[ROWS] = {false, false, x == width - 1, random % 16 == 0, true};
            const float light = lit[y] ? 1.0f + (float)(random % 7) : 0.0f;
            t.pixels[i] = (vec3){light, light, light};
        }
        alpi_sky_table_finish(&t);
        for (uint32_t i = 0; i < TRIES; i++) {
            const vec2 u = i < TRIES / 2 ? alpi_sample_2d(3, i)
                                         : (vec2){(float)(i % 65) / 65.0f, (float)(i % 64) / 64.0f};
            vec2 place;
            const uint32_t row = search(t.rows, (double)u.y, &place.y);
            const uint32_t column = search(t.cells + (size_t)row * width, (double)u.x, &place.x);
            const vec3 expected = alpi_sky_table_in_cell(&t, column, row, place);
            const vec3 apart = vec3_sub(alpi_sky_table_sample(&t, u), expected);
            assert_true(vec3_length(apart) < 1e-5f);
        }
        alpi_sky_table_release(context, &t);
    }
}

/// A lamp in the dark, and a window of an eighth of the sphere, are spots whole.
TEST_WITH_CONTEXT(what_is_lit_in_the_dark_is_spots, 1)
{
    for (uint32_t side = 2; side <= WIDTH / 4; side += WIDTH / 4 - 2) {
        alpi_sky_table table, soft, spots;
        ASSERT_OK(context, alpi_sky_table_create(context, WIDTH, HEIGHT, 0.0f, &table));
        for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
            const bool lit = i % WIDTH < side && i / WIDTH >= 8 && i / WIDTH < 8 + side;
            const float light = lit ? 3.0f + 0.1f * (float)(i % 7) : 0.0f;
            table.pixels[i] = (vec3){light, light, light};
        }
        alpi_sky_table_finish(&table);
        ASSERT_OK(context, alpi_sky_spots_part(context, &table, 1.4, &soft, &spots));
        assert_true(soft.total == 0.0 && spots.total == table.total);
        alpi_sky_table_release(context, &spots);
        alpi_sky_table_release(context, &soft);
        alpi_sky_table_release(context, &table);
    }
}

TEST_WITH_CONTEXT(even_skies_have_no_spots, 1)
{
    const alp_sky_kind kinds[] = {ALP_SKY_CONSTANT, ALP_SKY_HEMISPHERE, ALP_SKY_CLEAR};
    for (int i = 0; i < 3; i++) {
        alp_sky_options o = sky_options(kinds[i]);
        alpi_sky *soft, *spots;
        alpi_sky *sky = sky_make(context, &o, (vec3){0.6f, 0.8f, 0.0f});
        ASSERT_OK(context, alpi_sky_split(context, sky, &soft, &spots));
        assert_null(spots);
        for (uint32_t k = 0; k < 100; k++) {
            const vec2 u = alpi_sample_2d(5, k);
            const vec3 d = sky_polar(ALPI_PI * (double)u.x, 2.0 * ALPI_PI * (double)u.y);
            assert_true(alpi_sky_radiance(sky, d).y == alpi_sky_radiance(soft, d).y);
            assert_true(alpi_sky_density(sky, d) == alpi_sky_density(soft, d));
        }
        alpi_sky_destroy(context, sky);
        alpi_sky_destroy(context, soft);
    }
}

TEST(every_failed_allocation_leaves_nothing)
{
    int left = 1000;
    alp_context *context = test_context_failing(&left);
    alp_image *image = make_picture(context);
    alp_sky_options o = sky_options(ALP_SKY_IMAGE);
    o.image = image;
    alpi_sky *sky = sky_make(context, &o, UP), *soft = NULL, *spots = NULL;
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    int allowed = 0;
    for (; result != ALP_OK; allowed++) {
        left = allowed;
        result = alpi_sky_split(context, sky, &soft, &spots);
        assert_true(result == ALP_OK || (result == ALP_ERROR_OUT_OF_MEMORY && soft == NULL));
    }
    assert_true(allowed > 10); // two skies, two tables of four, looks and cells
    left = 1000;
    alpi_sky_destroy(context, sky);
    alpi_sky_destroy(context, soft);
    alpi_sky_destroy(context, spots);
    alp_image_destroy(image);
    alp_context_destroy(context);
}
