// SPDX-License-Identifier: MIT
// Direct light by parts that add up, of ten thousand lights, and against the reference without
// bounces; its standard error.
#include "test_direct_stage.h"

#include "base/memory.h"
#include "base/random.h"
#include "scene/lights/lighting_emitters.h"

#include <math.h>
#include <stdio.h>

static const vec3 UP = {0, 1, 0}, DARK = {0, 0, 0}, GREY = {0.5f, 0.5f, 0.5f};
TEST_CONTEXT(2);

// --- parts ---------------------------------------------------------------------------------------

/// Two quads of two materials over a floor that glows a little itself, and a box in between.
static alp_scene *make_room(void)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "room");
    alpi_builder_surface(&b, "floor", alpi_builder_material(&b, "grey", GREY, DARK));
    alpi_builder_quad(&b, (const vec3[4]){{-5, 0, 5}, {5, 0, 5}, {5, 0, -5}, {-5, 0, -5}});
    alpi_builder_box(&b, (vec3){0.5f, 0, 0.5f}, (vec3){1, 1, 1}, ALPI_FACE_ALL);
    alpi_builder_surface(&b, "red", alpi_builder_material(&b, "red", GREY, (vec3){4, 0, 0}));
    alpi_builder_quad(&b, (const vec3[4]){{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}});
    alpi_builder_surface(&b, "blue", alpi_builder_material(&b, "blue", GREY, (vec3){0, 0, 9}));
    alpi_builder_quad(&b, (const vec3[4]){{2, 3, -1}, {3, 3, -1}, {3, 3, 1}, {2, 3, 1}});
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

enum { PATCHES = 48 };
/// Squares of .3 m on the floor.
static test_patches make_patches(test_patch patches[PATCHES])
{
    for (uint32_t i = 0; i < PATCHES; i++) {
        const vec2 u = alpi_sample_2d(5, i);
        patches[i] = (test_patch){{4 * u.x - 2, 0, 4 * u.y - 2}, {0.3f, 0, 0}, {0, 0, 0.3f}, UP};
    }
    return (test_patches){.count = PATCHES, .patches = patches, .offset = 1e-6f};
}

static alpi_light make_sun(float size)
{
    return (alpi_light){.kind = ALP_LIGHT_DIRECTIONAL,
                        .color = {1, 1, 0.5f},
                        .intensity = 3.0f,
                        .direction = {0.6f, -0.8f, 0},
                        .range = INFINITY,
                        .size = size};
}

TEST(parts_add_up)
{
    const alpi_light lights[5] = {test_lamp((vec3){0, 1.5f, -2}, 3.0f), make_sun(0.0f),
                                  test_lamp((vec3){0, 1, 0}, 0.0f), make_sun(0.1f),
                                  test_lamp((vec3){-2, 1, 0}, 2.0f)};
    alp_lighting_options o = alp_lighting_options_default();
    o.sky.kind = ALP_SKY_CLEAR;
    o.sky.strength = 1e-4f;
    test_stage s = test_stage_open(context, make_room(), lights, 5, &o);
    test_patch squares[PATCHES];
    const test_patches patches = make_patches(squares);
    const alpi_receivers receivers = test_patches_receivers(&patches);
    alpi_direct *direct = NULL;
    const alpi_direct_options options = test_stage_options(&s, 60);
    ASSERT_OK(context, alpi_direct_create(&options, &direct));
    assert_int_equal(alpi_direct_samples(direct), 64);
    // The lamp of 0 candela has none.
    static const alpi_direct_part expected[7] = {
        {ALPI_DIRECT_LIGHT, 0},      {ALPI_DIRECT_LIGHT, 1},    {ALPI_DIRECT_LIGHT, 3},
        {ALPI_DIRECT_LIGHT, 4},      {ALPI_DIRECT_MATERIAL, 1}, {ALPI_DIRECT_MATERIAL, 2},
        {ALPI_DIRECT_SKY, ALPI_NONE}};
    uint32_t count;
    const alpi_direct_part *parts = alpi_direct_parts(direct, &count);
    assert_int_equal(count, 7);
    assert_memory_equal(parts, expected, sizeof expected);
    static alpi_reference_value values[PATCHES], again[PATCHES], of_parts[PATCHES][7];
    alpi_direct_output output = {.values = values, .parts = of_parts[0]};
    ASSERT_OK(context, alpi_direct_irradiance(direct, &receivers, NULL, 0, NULL, &output));
    double mean[7] = {0};
    for (uint32_t i = 0; i < PATCHES; i++) {
        for (int k = 0; k < 3; k++) {
            float sum = 0.0f;
            for (uint32_t p = 0; p < count; p++) {
                sum += of_parts[i][p].mean[k];
                mean[p] += (double)of_parts[i][p].mean[k];
            }
            assert_true(sum == values[i].mean[k]); // the same bits
        }
        assert_true(of_parts[i][4].mean[1] == 0.0f && of_parts[i][5].mean[0] == 0.0f);
    }
    for (int p = 0; p < 7; p++) {
        assert_true(mean[p] > 0.0);
    }
    output = (alpi_direct_output){.values = again}; // who does not ask for parts gets the same sum
    ASSERT_OK(context, alpi_direct_irradiance(direct, &receivers, NULL, 0, NULL, &output));
    assert_memory_equal(values, again, sizeof values);
    alpi_direct_destroy(direct);
    test_stage_close(&s);
}

/// Each part is what its light gives alone.
TEST(a_part_is_a_light_alone)
{
    const alpi_light lights[3] = {test_lamp((vec3){0, 1.5f, -2}, 3.0f), make_sun(0.1f),
                                  test_lamp((vec3){-2, 1, 0}, 2.0f)};
    const test_patch p = {{-1, 0, -1}, {0.5f, 0, 0}, {0, 0, 0.5f}, UP};
    const test_patches patches = {.count = 1, .patches = &p, .offset = 1e-6f};
    const alpi_receivers receivers = test_patches_receivers(&patches);
    test_stage s = test_stage_open(context, make_room(), lights, 3, NULL);
    const alpi_direct_options options = test_stage_options(&s, 1024);
    alpi_direct *direct = NULL;
    ASSERT_OK(context, alpi_direct_create(&options, &direct));
    alpi_reference_value all, parts[5];
    alpi_direct_output output = {.values = &all, .parts = parts};
    ASSERT_OK(context, alpi_direct_irradiance(direct, &receivers, NULL, 0, NULL, &output));
    alpi_direct_destroy(direct);
    test_stage_close(&s);
    for (int i = 0; i < 3; i++) {
        alp_scene *room = make_room();
        for (int m = 1; m < 3; m++) {
            memset(room->materials[m].emission, 0, sizeof room->materials[m].emission);
        }
        test_stage alone = test_stage_open(context, room, &lights[i], 1, NULL);
        const alpi_reference_value v = test_stage_direct(&alone, &p, 1024, 77, NULL);
        ASSERT_NEAR(v.mean[0], parts[i].mean[0],
                    6.0 * sqrt((double)(v.variance[0] + parts[i].variance[0])) +
                        1e-6 * (double)v.mean[0]);
        assert_true(sqrt((double)v.variance[0]) < 1e-2 * (double)v.mean[0]);
        test_stage_close(&alone);
    }
}

// --- many ----------------------------------------------------------------------------------------

enum { MANY = 10000 };
/// Lamps, or suns, at random places, of one candela, or lux, each.
static alpi_light *make_many(bool suns)
{
    alpi_light *lights = alpi_allocate(context, MANY, sizeof *lights);
    assert_non_null(lights);
    for (uint32_t i = 0; i < MANY; i++) {
        const vec2 u = alpi_sample_2d(3, i), v = alpi_sample_2d(4, i);
        lights[i] = suns ? make_sun(0.02f)
                         : test_lamp((vec3){8 * u.x - 4, 0.5f + 3 * v.x, 8 * u.y - 4}, 1.0f);
        if (suns) {
            lights[i].direction =
                vec3_normalize_or((vec3){u.x - 0.5f, -0.1f - v.x, u.y - 0.5f}, (vec3){0, -1, 0});
        }
    }
    return lights;
}

/// Their sum where nothing is hidden, by one part with as many samples as one light has.
TEST_SLOW(ten_thousand_lights)
{
    for (int suns = 0; suns < 2; suns++) {
        alpi_builder b;
        alp_scene *scene = NULL;
        alpi_builder_start(&b, context, "floor");
        alpi_builder_surface(&b, "floor", alpi_builder_material(&b, "grey", GREY, DARK));
        alpi_builder_quad(&b, (const vec3[4]){{-5, 0, 5}, {5, 0, 5}, {5, 0, -5}, {-5, 0, -5}});
        ASSERT_OK(context, alpi_builder_finish(&b, &scene));
        alpi_light *lights = make_many(suns == 1);
        test_stage s = test_stage_open(context, scene, lights, MANY, NULL);
        const test_patch p = test_point((vec3){0.5f, 0, 0.3f}, UP);
        double exact = 0.0;
        for (uint32_t i = 0; i < MANY; i++) {
            const vec3 to = suns ? vec3_scale(lights[i].direction, -1.0f)
                                 : vec3_sub(lights[i].position, p.corner);
            const double d = suns ? 1.0 : (double)vec3_length(to);
            exact += (suns ? 3.0 : 1.0) * (double)to.y / (d * d * d);
        }
        uint64_t rays;
        const uint32_t samples = suns ? 512 : 8192;
        const alpi_reference_value v = test_stage_direct(&s, &p, samples, 1, &rays);
        ASSERT_LIGHT(v, exact);
        printf("accuracy: 10,000 %s, %u samples: standard error %.2f %%\n", suns ? "suns" : "lamps",
               samples, 100.0 * sqrt((double)v.variance[0]) / (double)v.mean[0]);
        assert_true(sqrt((double)v.variance[0]) < 0.02 * exact);
        assert_true(rays <= samples);
        alpi_release(context, lights);
        test_stage_close(&s);
    }
}

// --- the reference -------------------------------------------------------------------------------

enum { TRIANGLES = 160 };
/// A triangle of a scene as a receiver, its mean over all of it.
typedef struct triangle_list {
    const alp_scene *scene;
    uint32_t triangles[TRIANGLES];
} triangle_list;

static void place_on_triangle(const void *user, uint32_t receiver, uint32_t count,
                              const float (*square)[2], alpi_receiver_point *points)
{
    const triangle_list *list = user;
    vec3 c[3];
    alpi_triangle_corners(list->scene, list->triangles[receiver], c);
    const vec3 n = vec3_triangle_normal(c[0], c[1], c[2], UP);
    for (uint32_t i = 0; i < count; i++) {
        const float root = sqrtf(square[i][0]), b1 = root * (1 - square[i][1]);
        const float b2 = root * square[i][1];
        const vec3 p = vec3_mad(vec3_mad(c[0], b1, vec3_sub(c[1], c[0])), b2, vec3_sub(c[2], c[0]));
        points[i] = (alpi_receiver_point){p, n, n, alpi_receiver_offset(p, c)};
    }
}

/// Sums and single receivers alike: the difference over its standard error.
static void judge(const char *name, const alpi_reference_value *a, const alpi_reference_value *b,
                  uint32_t rays_each)
{
    double apart = 0.0, variance = 0.0, squares = 0.0, of[2] = {0.0, 0.0};
    double slivers = 0.0, most = 0.0;
    uint32_t lit = 0;
    for (uint32_t i = 0; i < TRIANGLES; i++) {
        const double d = (double)a[i].mean[0] - (double)b[i].mean[0];
        const double v = (double)a[i].variance[0] + (double)b[i].variance[0];
        apart += d;
        variance += v;
        of[0] += (double)a[i].variance[0];
        of[1] += (double)b[i].variance[0];
        // Of a light whose sliver above the horizon none of the reference's samples met it says 0,
        // and no error: less than a thousandth of the most.
        const bool missed = b[i].variance[0] == 0.0f && b[i].mean[0] == 0.0f;
        lit += v > 0.0 && !missed;
        squares += v > 0.0 && !missed ? d * d / v : 0.0;
        slivers = fmax(slivers, missed ? d : 0.0);
        most = fmax(most, (double)b[i].mean[0]);
    }
    assert_true(slivers <= 1e-3 * most);
    const double z = apart / sqrt(variance), spread = sqrt(squares / lit);
    printf(
        "accuracy: direct light against the reference, %s: Z = %+.2f, spread %.2f; variance %.3f "
        "of the reference's at %.2f of its rays\n",
        name, z, spread, of[0] / of[1], (double)rays_each / 2.0 / 512.0);
    assert_true(lit > 16);
    assert_true(fabs(z) < 4.0);
    // Between 1 and the 1.18 of 7 degrees of freedom; 4 standard errors of 17 squares or more
    assert_true(spread > 0.5 && spread < 1.8);
}

static void compare(const char *name, const char *label, const alp_lighting_options *o)
{
    alp_scene *scene = test_load(context, name);
    test_stage s = test_stage_open(context, scene, NULL, 0, o);
    triangle_list list = {.scene = scene};
    const bool furnace = strcmp(label, "furnace") == 0; // where all emit
    // Not on emitters: there the reference draws the others so often that it hardly ever asks for
    // sky and sun, and does not know how far off it is.
    uint64_t tried = 0;
    for (uint32_t i = 0; i < TRIANGLES; tried++) {
        const uint32_t t = (uint32_t)(alpi_hash64(tried) % scene->triangle_count);
        list.triangles[i] = t;
        i += furnace || alpi_emitters_radiance(scene, t) == 0.0;
    }
    const alpi_receivers receivers = {
        .count = TRIANGLES, .extended = true, .place = place_on_triangle, .user = &list};
    static alpi_reference_value with[TRIANGLES], truth[TRIANGLES];
    const alpi_direct_options options = test_stage_options(&s, 256);
    alpi_direct *direct = NULL;
    ASSERT_OK(context, alpi_direct_create(&options, &direct));
    alpi_direct_output output = {.values = with};
    ASSERT_OK(context, alpi_direct_irradiance(direct, &receivers, NULL, 0, NULL, &output));
    alpi_direct_destroy(direct);
    const alpi_reference reference = test_stage_reference(&s, 512);
    ASSERT_OK(context,
              alpi_reference_irradiance(&reference, &receivers, NULL, TRIANGLES, NULL, truth));
    judge(label, with, truth, (uint32_t)(output.rays / TRIANGLES));
    test_stage_close(&s);
}

TEST(agrees_with_the_reference)
{
    alp_lighting_options sky = alp_lighting_options_default();
    sky.sky.kind = ALP_SKY_CLEAR;
    sky.sky.strength = 1e-4f;
    sky.sun.illuminance = 5.0f;
    sky.sun.size = 0.05f;
    compare("builtin:cornell", "cornell", NULL);
    compare("builtin:windows", "windows", NULL);
    compare("builtin:windows", "windows, clear sky and sun", &sky);
    compare("builtin:teapot-room", "teapot-room", NULL);
    compare("builtin:teapot-room", "teapot-room, clear sky and sun", &sky);
    compare("builtin:furnace", "furnace", NULL);
}

/// Over many receivers that differ in their random numbers alone, error over standard error has
/// mean 0 and spread 1: of a lamp seen past a box's edge, of a near quad and a clear sky.
TEST(standard_error_is_true)
{
    enum { COPIES = 1024 };
    const alpi_light lamp = test_lamp((vec3){0, 1.5f, -2}, 3.0f);
    alp_lighting_options o = alp_lighting_options_default();
    o.sky.kind = ALP_SKY_CLEAR;
    o.sky.strength = 1e-4f;
    test_stage s = test_stage_open(context, make_room(), &lamp, 1, &o);
    static test_patch copies[COPIES];
    static alpi_reference_value values[COPIES];
    for (int i = 0; i < COPIES; i++) {
        copies[i] = (test_patch){{0.3f, 0, 1.0f}, {0.5f, 0, 0}, {0, 0, 0.5f}, UP};
    }
    const double truth = (double)test_stage_direct(&s, copies, 1u << 17, 999, NULL).mean[0];
    const test_patches all = {.count = COPIES, .patches = copies, .offset = 1e-6f};
    test_stage_gather(&s, &all, 128, 1, values);
    double mean = 0.0, squares = 0.0, real = 0.0, stated = 0.0;
    for (int i = 0; i < COPIES; i++) {
        const double apart = (double)values[i].mean[0] - truth;
        const double z = apart / sqrt((double)values[i].variance[0]);
        mean += z / COPIES;
        squares += z * z / COPIES;
        real += apart * apart / COPIES;
        stated += (double)values[i].variance[0] / COPIES;
    }
    printf("accuracy: direct light, error over standard error, 1024 receivers: mean %+.2f, spread "
           "%.2f; "
           "stated over true error %.3f\n",
           mean, sqrt(squares), sqrt(stated / real));
    // Student's t of 7 degrees of freedom has the spread √(7/5) = 1.18. Replicates that are one
    // sequence are now and then more alike than their mean is good: 1.5.
    ASSERT_NEAR(mean, 0.0, 0.19); // 4 standard errors
    assert_true(sqrt(squares) < 1.65);
    ASSERT_NEAR(sqrt(stated / real), 1.0, 0.12); // 4 standard errors of two sums of 1024 squares
    test_stage_close(&s);
}
