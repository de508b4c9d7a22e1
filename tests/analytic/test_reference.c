// SPDX-License-Identifier: MIT
// The path tracer against closed forms: furnaces, closed rooms of one albedo, a lit cube, a sky;
// with and without next-event estimation; its standard error.
#include "test_support.h"

#include "base/random.h"
#include "scene/mesh_builder.h"
#include "transport/reference.h"

#include <math.h>
#include <stdio.h>

static const double PI = 3.14159265358979323846;

static alp_context *context;

static int setup(void **state)
{
    (void)state;
    context = test_context(2);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    alp_context_destroy(context);
    return 0;
}

// --- scenes and points ---------------------------------------------------------------------------

/// A scene with what the path tracer needs of it.
typedef struct lit {
    alp_scene *scene;
    alpi_tracer *tracer;
    alpi_lighting *lighting;
} lit;

static void light(lit *l, const alp_lighting_options *options)
{
    const alp_lighting_options dark = alp_lighting_options_default();
    ASSERT_OK(context, alpi_tracer_for_scene(l->scene, NULL, NULL, &l->tracer, NULL));
    ASSERT_OK(context,
              alpi_lighting_create(l->scene, options != NULL ? options : &dark, &l->lighting));
}

static void close_lit(lit *l)
{
    alpi_lighting_destroy(context, l->lighting);
    alp_scene_destroy(l->scene);
}

static alpi_reference reference_of(const lit *l, uint32_t bounces, uint32_t samples)
{
    return (alpi_reference){.context = context,
                            .scene = l->scene,
                            .tracer = l->tracer,
                            .lighting = l->lighting,
                            .bounces = bounces,
                            .samples = samples,
                            .next_event = true,
                            .seed = 1};
}

enum { POINT_LIMIT = 4096 };
static float positions[POINT_LIMIT][3], normals[POINT_LIMIT][3], offsets[POINT_LIMIT];

static alpi_receivers point_receivers(alpi_point_array *array, uint32_t count)
{
    *array = (alpi_point_array){.count = count,
                                .positions = positions,
                                .geometric_normals = normals,
                                .shading_normals = normals,
                                .offsets = offsets};
    return alpi_point_array_receivers(array);
}

static void set_point(uint32_t i, vec3 position, vec3 normal)
{
    vec3_store(positions[i], position);
    vec3_store(normals[i], normal);
    offsets[i] = 1e-6f;
}

static alpi_reference_value irradiance_at(const alpi_reference *r, vec3 position, vec3 normal)
{
    alpi_point_array array;
    alpi_reference_value value;
    set_point(0, position, normal);
    const alpi_receivers receivers = point_receivers(&array, 1);
    ASSERT_OK(context, alpi_reference_irradiance(r, &receivers, NULL, 1, NULL, &value));
    return value;
}

/// The unit cube from inside; its ceiling is a surface of its own.
static alp_scene *make_cube(float albedo, float emission, float ceiling_albedo,
                            float ceiling_emission)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    const vec3 high = {1.0f, 1.0f, 1.0f}, low = {0.0f, 0.0f, 0.0f};
    alpi_builder_start(&b, context, "cube");
    const uint32_t walls = alpi_builder_material(&b, "walls", (vec3){albedo, albedo, albedo},
                                                 (vec3){emission, emission, emission});
    const uint32_t ceiling =
        alpi_builder_material(&b, "ceiling", (vec3){ceiling_albedo, ceiling_albedo, ceiling_albedo},
                              (vec3){ceiling_emission, ceiling_emission, ceiling_emission});
    alpi_builder_surface(&b, "walls", walls);
    alpi_builder_box(&b, high, low, ALPI_FACE_ALL & ~(unsigned)ALPI_FACE_TOP);
    alpi_builder_surface(&b, "ceiling", ceiling);
    alpi_builder_box(&b, high, low, ALPI_FACE_TOP);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

// --- furnaces ------------------------------------------------------------------------------------

/// Oracle 14: with M = πLe and albedo ρ, E = M Σ ρ^k over k = 0 … n after n bounces.
static void furnace_after_n_bounces(void **state)
{
    (void)state;
    static const float albedos[] = {0.2f, 0.5f, 0.8f, 0.95f};
    static const uint32_t bounces[] = {0, 1, 2, 5, 15, ALPI_REFERENCE_BOUNCE_LIMIT};
    double worst = 0.0;
    for (size_t a = 0; a < 4; a++) {
        lit l = {.scene = make_cube(albedos[a], 1.0f, albedos[a], 1.0f)};
        light(&l, NULL);
        for (size_t n = 0; n < 6; n++) {
            const double rho = (double)albedos[a];
            const double exact = PI * (1.0 - pow(rho, bounces[n] + 1.0)) / (1.0 - rho);
            alpi_reference r = reference_of(&l, bounces[n], 1u << 13);
            alpi_reference_value v =
                irradiance_at(&r, (vec3){0.3f, 0.0f, 0.4f}, (vec3){0.0f, 1.0f, 0.0f});
            // 4 standard errors, and a millionth for single precision
            ASSERT_NEAR(v.mean[1], exact, 4.0 * sqrt((double)v.variance[1]) + 1e-6 * exact);
            r.samples = 1u << 16;
            r.next_event = false; // every ray brings the same: only roulette makes noise
            v = irradiance_at(&r, (vec3){0.3f, 0.0f, 0.4f}, (vec3){0.0f, 1.0f, 0.0f});
            ASSERT_NEAR(v.mean[1], exact, 4.0 * sqrt((double)v.variance[1]) + 1e-5 * exact);
            const double error = fabs((double)v.mean[1] / exact - 1.0);
            worst = fmax(worst, error);
            assert_true(error <= 1e-3);
        }
        close_lit(&l);
    }
    printf("accuracy: furnace, 4 albedos x 6 numbers of bounces, largest relative error: %.1e\n",
           worst);
}

/// The mean of E over the walls of a room.
static double mean_irradiance(const alpi_reference *r, double *standard_error)
{
    static alpi_reference_value values[POINT_LIMIT];
    static const vec3 axes[3] = {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    const uint32_t grid = 16;
    uint32_t count = 0;
    for (uint32_t face = 0; face < 6; face++) {
        const vec3 n = vec3_scale(axes[face / 2], face % 2 == 0 ? 1.0f : -1.0f);
        const vec3 u = axes[(face / 2 + 1) % 3], v = axes[(face / 2 + 2) % 3];
        for (uint32_t i = 0; i < grid * grid; i++) {
            const float a = ((float)(i % grid) + 0.5f) / (float)grid;
            const float c = ((float)(i / grid) + 0.5f) / (float)grid;
            const vec3 base = face % 2 == 0 ? (vec3){0.0f, 0.0f, 0.0f} : axes[face / 2];
            set_point(count++, vec3_mad(vec3_mad(base, a, u), c, v), n);
        }
    }
    alpi_point_array array;
    const alpi_receivers receivers = point_receivers(&array, count);
    ASSERT_OK(context, alpi_reference_irradiance(r, &receivers, NULL, count, NULL, values));
    double sum = 0.0, variance = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        sum += (double)values[i].mean[0];
        variance += (double)values[i].variance[0];
    }
    *standard_error = sqrt(variance) / count;
    return sum / count;
}

/// In a closed room of one albedo the mean of E is Φ / ((1 − ρ) A), wherever the light is.
static void mean_of_a_closed_room(void **state)
{
    (void)state;
    lit l = {.scene = make_cube(0.6f, 0.0f, 0.6f, 2.0f)};
    light(&l, NULL);
    const alpi_reference r = reference_of(&l, ALPI_REFERENCE_BOUNCE_LIMIT, 256);
    double error;
    const double mean = mean_irradiance(&r, &error);
    const double exact = 2.0 * PI / (0.4 * 6.0);
    // 4 standard errors, and the midpoint rule of the 16 × 16 points: E is steep along the edges
    // of the glowing face (16 points: 1.3e-3, 32: 4e-4, computed from the direct part)
    ASSERT_NEAR(mean / exact, 1.0, 4.0 * error / exact + 2e-3);
    printf("accuracy: area mean of E in a closed room, relative error: %.1e\n",
           fabs(mean / exact - 1.0));
    close_lit(&l);
}

/// Oracle 16: ceiling M = 1 and ρ = 0, ρ = .5 elsewhere: B at the middle of the floor is .179.
static void cube_with_a_glowing_ceiling(void **state)
{
    (void)state;
    lit l = {.scene = make_cube(0.5f, 0.0f, 0.0f, (float)(1.0 / PI))};
    light(&l, NULL);
    alpi_reference r = reference_of(&l, ALPI_REFERENCE_BOUNCE_LIMIT, 1u << 16);
    const alpi_reference_value v =
        irradiance_at(&r, (vec3){0.5f, 0.0f, 0.5f}, (vec3){0.0f, 1.0f, 0.0f});
    assert_true(sqrt((double)v.variance[0]) < 5e-4);   // half of it counts
    ASSERT_NEAR(0.5 * (double)v.mean[0], 0.179, 1e-3); // known to 3 digits
    // Direct light alone is the form factor of opposite unit squares from the middle (oracle 6):
    // four rectangles ½ × ½ at distance 1.
    const double a = 0.5, s = sqrt(1.0 + a * a);
    const double exact = 4.0 * (2.0 * a / s * atan(a / s)) / (2.0 * PI);
    r.bounces = 0;
    const alpi_reference_value direct =
        irradiance_at(&r, (vec3){0.5f, 0.0f, 0.5f}, (vec3){0.0f, 1.0f, 0.0f});
    ASSERT_NEAR(direct.mean[0], exact, 4.0 * sqrt((double)direct.variance[0]));
    assert_true(sqrt((double)direct.variance[0]) < 1e-3 * exact);
    close_lit(&l);
}

/// Oracle 1: under an even sky an open plane gets E = πL, and the sky is white behind it.
static void even_sky_over_a_plane(void **state)
{
    (void)state;
    alp_lighting_options o = alp_lighting_options_default();
    o.sky.kind = ALP_SKY_CONSTANT;
    o.sky.strength = 3.0f;
    alpi_builder b;
    lit l = {.scene = NULL};
    alpi_builder_start(&b, context, "plane");
    alpi_builder_surface(
        &b, "plane",
        alpi_builder_material(&b, "grey", (vec3){0.5f, 0.5f, 0.5f}, (vec3){0.0f, 0.0f, 0.0f}));
    alpi_builder_quad(&b,
                      (const vec3[4]){{-9, 0.0f, 9}, {9, 0.0f, 9}, {9, 0.0f, -9}, {-9, 0.0f, -9}});
    ASSERT_OK(context, alpi_builder_finish(&b, &l.scene));
    light(&l, &o);
    const alpi_reference r = reference_of(&l, 8, 4096);
    const alpi_reference_value v =
        irradiance_at(&r, (vec3){0.1f, 0.0f, 0.2f}, (vec3){0.0f, 1.0f, 0.0f});
    ASSERT_NEAR(v.mean[2], 3.0 * PI, 4.0 * sqrt((double)v.variance[2]) + 1e-5);
    assert_true(sqrt((double)v.variance[2]) < 0.02 * 3.0 * PI);
    close_lit(&l);
}

// --- statistics ----------------------------------------------------------------------------------

/// Both ways to find light have the same mean.
static void next_event_changes_no_mean(void **state)
{
    (void)state;
    static const char *names[] = {"builtin:cornell", "builtin:furnace", "cube"};
    for (size_t k = 0; k < 3; k++) {
        lit l = {.scene = NULL};
        if (strcmp(names[k], "cube") == 0) {
            l.scene = make_cube(0.7f, 0.0f, 0.3f, 1.0f);
        } else {
            ASSERT_OK(context, alp_scene_load(context, names[k], &l.scene));
        }
        light(&l, NULL);
        // Points on the faces of the bounding box, looking in.
        const vec3 low = l.scene->bounds_min, size = vec3_sub(l.scene->bounds_max, low);
        const uint32_t count = 64;
        for (uint32_t i = 0; i < count; i++) {
            const vec2 u = alpi_sample_2d(7, i);
            set_point(i, (vec3){low.x + u.x * size.x, low.y + 1e-3f * size.y, low.z + u.y * size.z},
                      (vec3){0.0f, 1.0f, 0.0f});
        }
        static alpi_reference_value with[64], without[64];
        alpi_point_array array;
        const alpi_receivers receivers = point_receivers(&array, count);
        alpi_reference r = reference_of(&l, 6, 2048);
        ASSERT_OK(context, alpi_reference_irradiance(&r, &receivers, NULL, count, NULL, with));
        r.next_event = false;
        r.seed = 2;
        ASSERT_OK(context, alpi_reference_irradiance(&r, &receivers, NULL, count, NULL, without));
        double apart = 0.0, variance = 0.0;
        for (uint32_t i = 0; i < count; i++) {
            apart += (double)with[i].mean[0] - (double)without[i].mean[0];
            variance += (double)with[i].variance[0] + (double)without[i].variance[0];
        }
        const double z = apart / sqrt(variance);
        printf("accuracy: with against without next-event estimation, %s: Z = %+.2f\n", names[k],
               z);
        assert_true(fabs(z) < 4.0);
        close_lit(&l);
    }
}

/// Over seeds, error over standard error has mean 0 and spread 1.
static void standard_error_is_true(void **state)
{
    (void)state;
    lit l = {.scene = make_cube(0.5f, 0.0f, 0.5f, 1.0f)};
    light(&l, NULL);
    const vec3 at = {0.2f, 0.0f, 0.7f}, up = {0.0f, 1.0f, 0.0f};
    alpi_reference many = reference_of(&l, 4, 1u << 18);
    many.seed = 999;
    const double truth = (double)irradiance_at(&many, at, up).mean[0];
    double mean = 0.0, squares = 0.0;
    enum { SEEDS = 256 };
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        alpi_reference r = reference_of(&l, 4, 256);
        r.seed = seed;
        const alpi_reference_value v = irradiance_at(&r, at, up);
        const double z = ((double)v.mean[0] - truth) / sqrt((double)v.variance[0]);
        mean += z / SEEDS;
        squares += z * z / SEEDS;
    }
    // Student's t of 15 degrees of freedom has the spread √(15/13) = 1.07; 4 standard errors of
    // 256 draws are .25 and .19.
    ASSERT_NEAR(mean, 0.0, 0.27);
    ASSERT_NEAR(sqrt(squares), 1.07, 0.2);
    printf("accuracy: reference, error over standard error, 256 seeds: mean %+.2f, spread %.2f\n",
           mean, sqrt(squares));
    close_lit(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(furnace_after_n_bounces),     cmocka_unit_test(mean_of_a_closed_room),
        cmocka_unit_test(cube_with_a_glowing_ceiling), cmocka_unit_test(even_sky_over_a_plane),
        cmocka_unit_test(next_event_changes_no_mean),  cmocka_unit_test(standard_error_is_true),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
