// SPDX-License-Identifier: MIT
// Direct light of a sky's spots: looks drawn for a normal, exact values where nothing is in
// between, a roof's edge against the sum over all looks, curved receivers, stated errors.
#include "test_direct_stage.h"

#include "base/image.h"
#include "base/random.h"
#include "scene/sky/sky.h"
#include "sh/basis.h"
#include "transport/direct/direct_spots.h"

#include <math.h>
#include <stdio.h>

enum { HEIGHT = 64, WIDTH = 2 * HEIGHT, COPIES = 512 };
static const vec3 UP = {0, 1, 0}, DARK = {0, 0, 0}, GREY = {0.5f, 0.5f, 0.5f};
TEST_CONTEXT(2);

/// Dim noise, a red lamp at +X, a blue one at −X, both about 45° high, and a green one below.
static alp_image *make_picture(void)
{
    const alp_image_info info = {WIDTH, HEIGHT, 3, ALP_COMPONENT_FLOAT};
    alp_image *image = NULL;
    ASSERT_OK(context, alp_image_create(context, info, &image));
    float *values = alp_image_floats(image);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        const uint32_t x = i % WIDTH, y = i / WIDTH;
        const bool high = y >= 12 && y < 20;
        const bool red = high && x >= 92 && x < 100, blue = high && x >= 30 && x < 32;
        const bool green = y >= 44 && y < 48 && x < 9;
        const float lamp[3] = {red ? 80.0f : 0.0f, green ? 60.0f : 0.0f, blue ? 50.0f : 0.0f};
        for (uint32_t k = 0; k < 3; k++) {
            const float random = alpi_unit_float(alpi_hash32(3 * i + k + 1));
            values[3 * i + k] = red || blue || green ? lamp[k] : 0.1f * random;
        }
    }
    return image;
}

/// A floor, and a roof of 18 m over it where x < 0, 3 m up, lit by the spots of a sky alone.
typedef struct stage {
    test_stage all;
    alp_image *picture;
    alpi_lighting *whole, *soft;
    const alpi_sky_looks *looks;
} stage;

static alp_scene *make_floor(bool roof)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "floor");
    alpi_builder_surface(&b, "floor", alpi_builder_material(&b, "grey", GREY, DARK));
    alpi_builder_quad(&b, (const vec3[4]){{-10, 0, 10}, {10, 0, 10}, {10, 0, -10}, {-10, 0, -10}});
    if (roof) {
        alpi_builder_quad(&b, (const vec3[4]){{-9, 3, 9}, {0, 3, 9}, {0, 3, -9}, {-9, 3, -9}});
    }
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

/// @param others a sun and a lamp too
static stage start_with(bool roof, bool others)
{
    stage s = {.picture = make_picture()};
    alp_lighting_options o = alp_lighting_options_default();
    o.sky.kind = ALP_SKY_IMAGE;
    o.sky.image = s.picture;
    o.sun.illuminance = others ? 0.5f : 0.0f;
    o.sun.elevation = 0.8f;
    o.sun.size = 0.2f;
    const alpi_light lamp = test_lamp((vec3){1, 2, 3}, 2.0f);
    s.all = test_stage_open(context, make_floor(roof), &lamp, others ? 1 : 0, &o);
    s.whole = s.all.lighting;
    ASSERT_OK(context, alpi_lighting_split_sky(s.whole, &o, &s.soft, &s.all.lighting));
    s.looks = alpi_sky_spot_looks(alpi_lighting_sky(s.all.lighting));
    assert_non_null(s.looks);
    return s;
}

static stage start(bool roof)
{
    return start_with(roof, false);
}

static void finish(stage *s)
{
    alpi_lighting_destroy(context, s->soft);
    alpi_lighting_destroy(context, s->whole);
    test_stage_close(&s->all);
    alp_image_destroy(s->picture);
}

static vec3 look_at(const alpi_sky_looks *looks, uint32_t k)
{
    return (vec3){looks->direction[0][k], looks->direction[1][k], looks->direction[2][k]};
}

/// Whether the roof is not in between.
static bool sees(vec3 from, vec3 d)
{
    const float t = d.y > 0.0f ? (3.0f - from.y) / d.y : -1.0f;
    const float x = from.x + t * d.x, z = from.z + t * d.z;
    return !(t > 0.0f && x < 0.0f && x > -9.0f && fabsf(z) < 9.0f);
}

/// Σ over the looks. @param from NULL: nothing is in between
static void sum_looks(const alpi_sky_looks *looks, vec3 normal, const vec3 *from, double sum[3])
{
    sum[0] = sum[1] = sum[2] = 0.0;
    for (uint32_t k = 0; k < ALPI_SKY_LOOKS; k++) {
        const vec3 d = look_at(looks, k);
        const double cosine = fmax((double)vec3_dot(d, normal), 0.0);
        for (int c = 0; c < 3 && (from == NULL || sees(*from, d)); c++) {
            sum[c] += cosine * (double)looks->light[c][k];
        }
    }
}

// --- choosing ------------------------------------------------------------------------------------

/// What is picked at even distances has the looks' weights, and no weight is below a cosine that a
/// normal as far off as the slack may have.
TEST(picks_follow_the_weights)
{
    enum { PICKS = 1 << 18 };
    stage s = start(false);
    static const vec3 normals[] = {{0, 1, 0}, {0.6f, 0, 0.8f}, {-0.48f, -0.6f, 0.64f}};
    static alpi_spot_choice choice;
    static uint32_t counts[ALPI_SKY_LOOKS];
    for (int i = 0; i < 6; i++) {
        const float slack = i < 3 ? 0.0f : 0.1f;
        const vec3 n = normals[i % 3];
        alpi_spots_choose(s.looks, n, slack, &choice);
        alpi_spot_range range = {0, 0};
        memset(counts, 0, sizeof counts);
        for (uint32_t p = 0; p < PICKS; p++) {
            float weight;
            if (p % 64 == 0) {
                const double end = choice.total * (p / 64 + 1) / (PICKS / 64);
                range = alpi_spots_narrow(&choice, range, end);
            }
            const double place = choice.total * (p + 0.5) / PICKS;
            const uint32_t k = alpi_spots_pick(&choice, range, place, &weight);
            ASSERT_NEAR(weight, fmax((double)(vec3_dot(look_at(s.looks, k), n) + slack), 0.0),
                        1e-6);
            counts[k]++;
        }
        double sum = 0.0;
        for (uint32_t k = 0; k < ALPI_SKY_LOOKS; k++) {
            const double weight = fmax((double)(vec3_dot(look_at(s.looks, k), n) + slack), 0.0);
            sum += weight;
            ASSERT_NEAR(counts[k], weight / choice.total * PICKS, 1.1); // one more or less
        }
        ASSERT_NEAR(choice.total, sum, 1e-5 * sum);
        float weight;
        const alpi_spot_range all =
            alpi_spots_narrow(&choice, (alpi_spot_range){0, 0}, choice.total);
        alpi_spots_pick(&choice, all, 0.0, &weight);
        assert_true(weight > 0.0f);
        alpi_spots_pick(&choice, all, nextafter(choice.total, 0.0), &weight);
        assert_true(weight > 0.0f);
    }
    finish(&s);
}

// --- gathering -----------------------------------------------------------------------------------

/// Where nothing is in between, what there is is known: without noise, by eight rays, of colours
/// that few of the looks have or none of the eight.
TEST(an_open_floor_is_exact)
{
    stage s = start(false);
    for (int i = 0; i < 6; i++) {
        const double tilt = 0.5 * i;
        const vec3 n = {(float)sin(tilt), (float)cos(tilt), 0};
        const test_patch p = {{1, 5, 2}, {0.5f, 0, 0}, {0, 0, 0.5f}, n};
        const test_patches one = {.count = 1, .patches = &p, .offset = 1e-6f};
        double sum[3];
        alpi_reference_value v;
        sum_looks(s.looks, n, NULL, sum);
        const uint64_t rays = test_stage_gather(&s.all, &one, 8, 3, &v);
        assert_int_equal(rays, 8);
        for (int k = 0; k < 3 && i < 3; k++) { // from 1.5 on some rays meet the floor
            ASSERT_NEAR(v.mean[k], sum[k], 2e-6 * sum[k]);
            assert_true(sqrt((double)v.variance[k]) <= 1e-6 * sum[k]);
        }
    }
    finish(&s);
}

/// A roof hides the red lamp, the blue one, or a part of one; a ratio of means is as good as
/// unbiased, and what is stated is true.
TEST(a_roof_hides_looks)
{
    stage s = start(true);
    static test_patch copies[COPIES];
    static alpi_reference_value values[COPIES];
    const test_patches all = {.count = COPIES, .patches = copies, .offset = 1e-6f};
    double true_squares = 0.0, stated = 0.0;
    for (int i = 0; i <= 8; i++) {
        const vec3 at = {(float)i - 4.0f, 0, 0.3f};
        double sum[3];
        sum_looks(s.looks, UP, &at, sum);
        for (int c = 0; c < COPIES; c++) {
            copies[c] = test_point(at, UP);
        }
        test_stage_gather(&s.all, &all, 64, 7 + (uint64_t)i, values);
        for (int k = 0; k < 3; k++) {
            double mean = 0.0, squares = 0.0;
            for (int c = 0; c < COPIES; c++) {
                const double apart = (double)values[c].mean[k] - sum[k];
                mean += (double)values[c].mean[k] / COPIES;
                squares += apart * apart / COPIES;
                stated += (double)values[c].variance[k] / COPIES;
            }
            true_squares += squares;
            // Of all copies together: 5 standard errors, and what single precision leaves.
            ASSERT_NEAR(mean, sum[k], 5.0 * sqrt(squares / COPIES) + 2e-6 * sum[k]);
        }
    }
    printf("accuracy: spots behind a roof's edge, 64 samples: stated over true error %.3f\n",
           sqrt(stated / true_squares));
    ASSERT_NEAR(sqrt(stated / true_squares), 1.0, 0.1);
    finish(&s);
}

/// Normals lean from side to side of the receiver as far as the looks below its middle's horizon.
static const float LEAN = 0.8f;
static vec3 normal_at(float x)
{
    const double lean = (double)LEAN * (2.0 * (double)x - 1.0);
    return (vec3){(float)sin(lean), (float)cos(lean), 0};
}

static void place_curved(const void *user, uint32_t receiver, uint32_t count,
                         const float (*square)[2], alpi_receiver_point *points)
{
    (void)user;
    (void)receiver;
    for (uint32_t i = 0; i < count; i++) {
        const vec3 n = normal_at(square[i][0]);
        points[i] = (alpi_receiver_point){.position = {square[i][0], 9.0f, square[i][1]},
                                          .geometric_normal = n,
                                          .shading_normal = n,
                                          .offset = 1e-6f};
    }
}

TEST(a_curved_receiver_misses_nothing)
{
    enum { STEPS = 256 };
    stage s = start(false);
    double truth[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < STEPS; i++) {
        const vec3 n = normal_at(((float)i + 0.5f) / STEPS), from = {0, 9, 0};
        for (uint32_t k = 0; k < ALPI_SKY_LOOKS; k++) {
            const vec3 d = look_at(s.looks, k);
            const double cosine = fmax((double)vec3_dot(d, n), 0.0);
            // The floor of 20 m is in between where a look goes down steeply.
            const float t = d.y < 0.0f ? -from.y / d.y : -1.0f;
            const bool free = !(t > 0.0f && fabsf(t * d.x) < 9.9f && fabsf(t * d.z) < 9.9f);
            for (int c = 0; c < 3 && free; c++) {
                truth[c] += cosine * (double)s.looks->light[c][k] / STEPS;
            }
        }
    }
    const alpi_receivers receivers = {.count = COPIES, .extended = true, .place = place_curved};
    static alpi_reference_value values[COPIES];
    alpi_direct_options o = test_stage_options(&s.all, 128);
    alpi_direct *direct = NULL;
    alpi_direct_output output = {.values = values};
    ASSERT_OK(context, alpi_direct_create(&o, &direct));
    ASSERT_OK(context, alpi_direct_irradiance(direct, &receivers, NULL, 0, NULL, &output));
    alpi_direct_destroy(direct);
    double true_squares = 0.0, stated = 0.0;
    for (int k = 0; k < 3; k++) {
        double mean = 0.0, squares = 0.0;
        for (int c = 0; c < COPIES; c++) {
            const double apart = (double)values[c].mean[k] - truth[k];
            mean += (double)values[c].mean[k] / COPIES;
            squares += apart * apart / COPIES;
            stated += (double)values[c].variance[k] / COPIES;
        }
        true_squares += squares;
        // Of all light, a fiftieth; of the mean 5 standard errors, and what the edge of the floor
        // is rounded by.
        assert_true(sqrt(squares) < 0.02 * (truth[0] + truth[1] + truth[2]));
        ASSERT_NEAR(mean, truth[k], 5.0 * sqrt(squares / COPIES) + 1e-3 * truth[k]);
    }
    ASSERT_NEAR(sqrt(stated / true_squares), 1.0, 0.1);
    finish(&s);
}

/// Paths that draw spots and meet the soft sky find what paths find that draw from the picture:
/// beside other lights, and where light is asked for after a bounce.
TEST(paths_find_all_light)
{
    stage s = start_with(true, true);
    alpi_lighting *spots = s.all.lighting;
    for (int i = 0; i <= 4; i++) {
        const test_patch p = test_point((vec3){2.0f * (float)i - 4.0f, 0, 0.3f}, UP);
        const test_patches one = {.count = 1, .patches = &p, .offset = 1e-6f};
        const alpi_receivers receivers = test_patches_receivers(&one);
        alpi_reference_value values[2];
        for (int k = 0; k < 2; k++) {
            s.all.lighting = k == 0 ? s.whole : spots;
            alpi_reference r = test_stage_reference(&s.all, 1 << 14);
            r.bounces = 2;
            ASSERT_OK(context,
                      alpi_reference_irradiance(&r, &receivers, NULL, 1, NULL, &values[k]));
        }
        for (int c = 0; c < 3; c++) {
            const double apart = (double)values[1].mean[c] - (double)values[0].mean[c];
            const double variance = (double)values[1].variance[c] + (double)values[0].variance[c];
            assert_true(fabs(apart) < 4.5 * sqrt(variance) + 2e-3 * (double)values[0].mean[c]);
        }
    }
    finish(&s);
}

/// By direction it is the light of the looks, as much of it as there is.
TEST(light_has_its_directions)
{
    stage s = start(false);
    const test_patch p = test_point((vec3){1, 5, 2}, UP);
    const test_patches one = {.count = 1, .patches = &p, .offset = 1e-6f};
    const alpi_receivers receivers = test_patches_receivers(&one);
    alpi_direct_options o = test_stage_options(&s.all, 4096);
    alpi_direct *direct = NULL;
    alpi_reference_value value;
    alpi_directional by_direction = {.toward = {0.0f}};
    alpi_direct_output output = {.values = &value, .directional = &by_direction};
    ASSERT_OK(context, alpi_direct_create(&o, &direct));
    ASSERT_OK(context, alpi_direct_irradiance(direct, &receivers, NULL, 0, NULL, &output));
    alpi_direct_destroy(direct);
    double toward[3] = {0.0, 0.0, 0.0}, sh[ALPI_SH1_COUNT][3] = {{0.0}};
    for (uint32_t k = 0; k < ALPI_SKY_LOOKS; k++) {
        const vec3 d = look_at(s.looks, k);
        const double rgb[3] = {(double)s.looks->light[0][k], (double)s.looks->light[1][k],
                               (double)s.looks->light[2][k]};
        const double cosine = fmax((double)d.y, 0.0), light = alpi_luminance(rgb) * cosine;
        const double along[3] = {(double)d.x, (double)d.y, (double)d.z};
        double basis[ALPI_SH1_COUNT];
        alpi_sh1_basis(d, basis);
        for (int c = 0; c < 3; c++) {
            toward[c] += light * along[c];
            for (int i = 0; i < ALPI_SH1_COUNT && cosine > 0.0; i++) {
                sh[i][c] += rgb[c] * basis[i];
            }
        }
    }
    for (int c = 0; c < 3; c++) {
        ASSERT_NEAR(by_direction.toward[c], toward[c], 2e-3 * fabs(toward[1]));
        for (int i = 0; i < ALPI_SH1_COUNT; i++) {
            ASSERT_NEAR(by_direction.sh[i][c], sh[i][c], 2e-3 * fabs(sh[1][c]));
        }
    }
    finish(&s);
}
