// SPDX-License-Identifier: MIT
// Fields against closed forms: furnaces, even skies, and lamps.
#include "field_scenes.h"

TEST_CONTEXT(2);

static const double PI = FIELD_PI;

// --- furnace -------------------------------------------------------------------------------------

/// Oracle 14: c00 = 2√π B/π with B = πLe/(1 − ρ), and nothing else but the noise that is stated.
TEST(a_furnace_has_one_coefficient)
{
    static const double cosine[9] = {1.0, 2.0 / 3, 2.0 / 3, 2.0 / 3, 0.25, 0.25, 0.25, 0.25, 0.25};
    alp_scene *scene = test_load(context, "builtin:furnace"); // unit cube, ρ = ½, Le = 1
    alp_probe_options o = alp_probe_options_default();
    alp_probes *probes = NULL;
    o.spacing = 0.2f;
    o.atlas_size = 64;
    ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
    const alp_probes_info info = alp_probes_get_info(probes);
    const double exact = 2.0 * sqrt(PI) * 2.0;
    double squares = 0.0;
    for (uint32_t i = 0; i < info.count; i++) {
        ASSERT_NEAR(field_coefficient(probes, i, 0)[1], exact, 4e-3 * exact);
        for (uint32_t j = 1; j < 9; j++) {
            const double c = (double)field_coefficient(probes, i, j)[1];
            squares += cosine[j] * cosine[j] * PI * PI * c * c / (4.0 * PI) / info.count;
            ASSERT_NEAR(c, 0.0, 0.03 * exact);
        }
    }
    const double error = sqrt(squares) / (2.0 * PI);
    print_message("furnace: E errs by %.4f %%, states %.4f %%\n", 100.0 * error,
                  100.0 * (double)info.error);
    ASSERT_NEAR(info.error, error, 0.15 * error);
    ASSERT_NEAR(info.mean, 2.0 * PI, 2e-3 * PI);
    assert_int_equal(info.states[ALP_PROBE_VALID], info.count);
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
}

TEST(bounces_count_in_a_furnace)
{
    static const uint32_t bounces[] = {0, 1, 2};
    alp_scene *scene = field_room(context, (vec3){2.0f, 1.0f, 1.5f}, 0.8f, 1.0f);
    for (int i = 0; i < 3; i++) {
        alp_probe_options o = alp_probe_options_default();
        alp_probes *probes = NULL;
        o.spacing = 0.5f;
        o.atlas_size = 64;
        o.bounces = bounces[i];
        ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
        const double exact = PI * (1.0 - pow(0.8, bounces[i] + 1.0)) / 0.2;
        ASSERT_NEAR(alp_probes_get_info(probes).mean, exact, 5e-3 * exact);
        alp_probes_destroy(probes);
    }
    alp_scene_destroy(scene);
}

// --- a sun alone ---------------------------------------------------------------------------------

/// A sun of E overhead gives E max(y, 0). Over all normals the nearest sum of an upper and a lower
/// colour is E (1/4 + y/2): colours 3/4 E and −1/4 E. It is below 0 where y < −1/2, and look-ups
/// are 0 there. The error that is left has the root mean square E / 8; without the bound it would
/// be E / √48.
TEST(a_negative_colour_gives_no_negative_light)
{
    static const alp_ambient_model models[] = {ALP_AMBIENT_HEMISPHERE, ALP_AMBIENT_GROUND_MAP};
    const double sun = 10.0;
    alp_scene *scene = field_specks(context);
    for (int i = 0; i < 2; i++) {
        alp_ambient_options o = alp_ambient_options_default();
        alp_field *field = NULL;
        o.model = models[i];
        o.direct = true;
        o.points = 40000;
        o.samples = 16;
        o.lighting.sun.illuminance = (float)sun;
        o.lighting.sun.elevation = (float)(0.5 * PI);
        o.lighting.sun.size = 0.0f;
        ASSERT_OK(context, alp_field_create_ambient(scene, &o, &field));
        const alp_ambient_info m = alp_field_get_ambient(field);
        const float position[1][3] = {{0.1f, 0.2f, 0.3f}}, normal[1][3] = {{0.0f, 1.0f, 0.0f}};
        float error;
        alp_field_errors(field, 1, position, normal, &error);
        for (int k = 0; k < 3; k++) {
            ASSERT_NEAR(m.colors[0][k], 0.75 * sun, 0.02 * sun);
            ASSERT_NEAR(m.colors[1][k], -0.25 * sun, 0.02 * sun);
        }
        for (int step = 0; step <= 12; step++) {
            const double tilt = PI * step / 12.0;
            const double expected = fmax(sun * (0.25 + 0.5 * cos(tilt)), 0.0);
            const vec3 e = field_read(field, (vec3){0.1f, 0.2f, 0.3f}, field_tilted(tilt, step));
            ASSERT_NEAR(e.z, expected, 0.02 * sun);
            assert_true(e.x >= 0.0f && e.y >= 0.0f && e.z >= 0.0f);
        }
        ASSERT_NEAR(error, sun / 8.0, 0.02 * sun / 8.0);
        alp_field_destroy(field);
    }
    alp_scene_destroy(scene);
}

// --- skies ---------------------------------------------------------------------------------------

typedef struct sky_case {
    alp_sky_kind kind;
    float up, down;
} sky_case;

/// E of a sky, up above the horizon and down below: (up (1 + cos t) + down (1 − cos t)) π/2.
static double exact_sky(const sky_case *sky, double tilt)
{
    const double down = sky->kind == ALP_SKY_CONSTANT ? (double)sky->up : (double)sky->down;
    return 0.5 * PI * ((double)sky->up * (1.0 + cos(tilt)) + down * (1.0 - cos(tilt)));
}

static alp_lighting_options light_by(const sky_case *sky)
{
    alp_lighting_options light = alp_lighting_options_default();
    light.sky.kind = sky->kind;
    for (int k = 0; k < 3; k++) {
        light.sky.up[k] = sky->up;
        light.sky.down[k] = sky->down;
    }
    return light;
}

static void check_field(const alp_field *field, const sky_case *sky, double tolerance)
{
    for (int i = 0; i <= 6; i++) {
        const double tilt = PI * i / 6.0, exact = exact_sky(sky, tilt);
        const vec3 e = field_read(field, (vec3){0.1f, 0.2f, -0.3f}, field_tilted(tilt, 0.4 + i));
        ASSERT_NEAR(e.y, exact, tolerance * PI * (double)sky->up);
    }
}

static void check_probes(const alp_scene *scene, const sky_case *sky, alp_probe_basis basis,
                         double tolerance)
{
    alp_probe_options o = field_probes_at_origin(0.5f, 1.0f);
    alp_probes *probes = NULL;
    alp_field *field = NULL;
    o.lighting = light_by(sky);
    o.basis = basis;
    ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
    for (int lookup = 0; lookup < 2; lookup++) {
        ASSERT_OK(context,
                  alp_field_create_probes(probes, (alp_probe_lookup)lookup, NULL, NULL, &field));
        check_field(field, sky, tolerance);
        alp_field_destroy(field);
    }
    alp_probes_destroy(probes);
}

static const sky_case even = {ALP_SKY_CONSTANT, 3.0f, 0.0f};
static const sky_case half = {ALP_SKY_HEMISPHERE, 3.0f, 0.0f};
static const sky_case halves = {ALP_SKY_HEMISPHERE, 3.0f, 1.0f};

/// Oracles 1 and 2.
TEST(skies_light_probes)
{
    alp_scene *scene = field_specks(context);
    check_probes(scene, &even, ALP_PROBE_SH9, 3e-3);
    check_probes(scene, &even, ALP_PROBE_SH4, 3e-3);
    check_probes(scene, &even, ALP_PROBE_AMBIENT_CUBE, 3e-3);
    check_probes(scene, &half, ALP_PROBE_SH9, 4e-3);
    check_probes(scene, &halves, ALP_PROBE_SH9, 4e-3);
    alp_scene_destroy(scene);
}

TEST(skies_light_the_reference)
{
    static const sky_case *const skies[] = {&even, &half, &halves};
    alp_scene *scene = field_specks(context);
    for (int s = 0; s < 3; s++) {
        alp_reference_options o = alp_reference_options_default();
        o.lighting = light_by(skies[s]);
        for (int i = 0; i <= 6; i++) {
            double error = 0.0;
            const double tilt = PI * i / 6.0, exact = exact_sky(skies[s], tilt);
            const vec3 e = field_truth(scene, &o, (vec3){0.1f, 0.2f, -0.3f},
                                       field_tilted(tilt, 0.4 + i), &error);
            ASSERT_NEAR(e.y, exact, 5.0 * error + 1e-5 * exact);
            assert_true(error < 0.01 * PI * 3.0);
        }
    }
    alp_scene_destroy(scene);
}

/// A fit recovers a field that is of its model: a hemisphere sky over the models that hold it.
TEST(a_fit_recovers_what_is_of_its_model)
{
    static const struct {
        alp_ambient_model model;
        const sky_case *sky;
    } pairs[] = {{ALP_AMBIENT_CONSTANT, &even},     {ALP_AMBIENT_HEMISPHERE, &halves},
                 {ALP_AMBIENT_GROUND_MAP, &halves}, {ALP_AMBIENT_CUBE, &even},
                 {ALP_AMBIENT_ENVIRONMENT, &half},  {ALP_AMBIENT_ENVIRONMENT, &halves}};
    alp_scene *scene = field_specks(context);
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        alp_ambient_options o = alp_ambient_options_default();
        alp_field *field = NULL;
        o.model = pairs[i].model;
        o.lighting = light_by(pairs[i].sky);
        ASSERT_OK(context, alp_field_create_ambient(scene, &o, &field));
        check_field(field, pairs[i].sky, 3e-3);
        alp_field_destroy(field);
    }
    alp_scene_destroy(scene);
}

// --- lamps ---------------------------------------------------------------------------------------

/// Oracle 3: SH9 of light from one direction reads 3/32 + c/2 + 15/32 c² of E⊥, clamped at 0.
TEST(direct_light_of_a_lamp_is_that_of_its_harmonics)
{
    alp_scene *scene = field_specks(context);
    alp_lamp lamp = alp_lamp_default();
    alp_probe_options o = field_probes_at_origin(0.5f, 0.5f);
    alp_probes *probes = NULL;
    alp_field *field = NULL;
    lamp.intensity = 400.0f;
    lamp.position[1] = 20.0f;
    o.lighting.lamps = &lamp;
    o.lighting.lamp_count = 1;
    o.direct = true;
    ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
    assert_true(alp_probes_get_info(probes).direct);
    ASSERT_OK(context, alp_field_create_probes(probes, ALP_LOOKUP_OURS, NULL, NULL, &field));
    for (uint32_t i = 0; i < 5; i++) { // at the place of the first probe, (-¼, -¼, -¼)
        const vec3 p = {-0.25f, -0.25f, -0.25f};
        const vec3 way = vec3_sub((vec3){0.0f, 20.0f, 0.0f}, p);
        const vec3 n = field_tilted(0.7 * i, 1.0);
        const double square = (double)vec3_dot(way, way);
        const double cosine = (double)vec3_dot(n, way) / sqrt(square);
        const double share = 3.0 / 32.0 + 0.5 * cosine + 15.0 / 32.0 * cosine * cosine;
        const vec3 e = field_read(field, p, n);
        ASSERT_NEAR(e.x, 400.0 / square * fmax(share, 0.0), 1e-4);
    }
    alp_field_destroy(field);
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
}

/// Oracle 3 of a sun, whose disk is sampled.
TEST(direct_light_of_a_sun)
{
    alp_scene *scene = field_specks(context);
    alp_probe_options o = field_probes_at_origin(0.5f, 0.5f);
    alp_probes *probes = NULL;
    alp_field *field = NULL;
    o.lighting.sun.illuminance = 10.0f;
    o.lighting.sun.elevation = (float)(0.5 * PI);
    o.direct = true;
    ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
    ASSERT_OK(context, alp_field_create_probes(probes, ALP_LOOKUP_OURS, NULL, NULL, &field));
    for (uint32_t i = 0; i < 5; i++) {
        const double cosine = cos(0.7 * i);
        const double share = 3.0 / 32.0 + 0.5 * cosine + 15.0 / 32.0 * cosine * cosine;
        const vec3 e = field_read(field, (vec3){0.0f, 0.0f, 0.0f}, field_tilted(0.7 * i, 1.0));
        ASSERT_NEAR(e.x, 10.0 * fmax(share, 0.0), 0.01);
    }
    alp_field_destroy(field);
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
}

// --- an integrating room -------------------------------------------------------------------------

/// Direct off leaves out the light of a lamp itself, and keeps what walls reflect of it.
TEST(direct_off_keeps_reflected_light)
{
    alp_scene *scene = field_room(context, (vec3){2.0f, 2.0f, 2.0f}, 0.5f, 0.0f);
    alp_lamp lamp = alp_lamp_default();
    const vec3 p = {0.75f, 0.75f, 0.75f};
    vec3 truth[2];
    double held[2];
    lamp.intensity = 10.0f;
    lamp.position[0] = 1.2f;
    lamp.position[1] = 1.3f;
    lamp.position[2] = 1.1f;
    for (int direct = 0; direct < 2; direct++) {
        alp_probe_options o = alp_probe_options_default();
        alp_reference_options r = alp_reference_options_default();
        alp_probes *probes = NULL;
        double error = 0.0;
        o.lighting.lamps = r.lighting.lamps = &lamp;
        o.lighting.lamp_count = r.lighting.lamp_count = 1;
        o.direct = r.direct = direct != 0;
        o.spacing = 0.5f;
        o.atlas_size = 64;
        ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
        // The mean of E over normals and the light from all directions: π Y₀₀ c₀₀, of the probe at
        // p.
        held[direct] = PI * 0.28209479 * (double)field_coefficient(probes, 1 + 4 + 16, 0)[1];
        const vec3 up = field_truth(scene, &r, p, (vec3){0.0f, 1.0f, 0.0f}, &error);
        const vec3 down = field_truth(scene, &r, p, (vec3){0.0f, -1.0f, 0.0f}, &error);
        truth[direct] = vec3_add(up, down);
        if (direct == 0) { // far from walls, E of opposite normals has nearly the mean
            ASSERT_NEAR(2.0 * held[0], truth[0].y, 0.1 * (double)truth[0].y);
        }
        alp_probes_destroy(probes);
    }
    const vec3 way = vec3_sub((vec3){1.2f, 1.3f, 1.1f}, p);
    const double straight = 10.0 / (double)vec3_dot(way, way);
    // A light of E⊥ has c₀₀ = E⊥ Y₀₀, and the mean of E over normals is E⊥/4.
    ASSERT_NEAR(held[1] - held[0], straight / 4.0, 1e-3 * straight);
    assert_true(truth[1].y > truth[0].y);
    alp_scene_destroy(scene);
}

/// Oracle 15, in a cube: with flux Φ = 4πI and uniform ρ, the area mean of reflected light on walls
/// is Φρ/((1 − ρ)A).
TEST(reflected_light_balances_in_a_closed_room)
{
    enum { SIDE = 8, FACES = 6, COUNT = SIDE * SIDE * FACES };
    static float positions[COUNT][3], normals[COUNT][3], e[COUNT][3];
    alp_scene *scene = field_room(context, (vec3){1.0f, 1.0f, 1.0f}, 0.5f, 0.0f);
    alp_lamp lamp = alp_lamp_default();
    alp_reference_options r = alp_reference_options_default();
    double mean = 0.0;
    lamp.intensity = 1.0f;
    lamp.position[0] = lamp.position[1] = lamp.position[2] = 0.5f;
    r.lighting.lamps = &lamp;
    r.lighting.lamp_count = 1;
    r.samples = 256;
    for (int i = 0; i < COUNT; i++) {
        const int face = i / (SIDE * SIDE), axis = face / 2;
        const float a = ((float)(i % SIDE) + 0.5f) / SIDE;
        const float b = ((float)(i / SIDE % SIDE) + 0.5f) / SIDE;
        const bool high = face % 2 != 0;
        positions[i][axis] = high ? 1.0f - 1e-4f : 1e-4f;
        positions[i][(axis + 1) % 3] = a;
        positions[i][(axis + 2) % 3] = b;
        normals[i][axis] = high ? -1.0f : 1.0f;
    }
    ASSERT_OK(context, alp_reference_irradiance(scene, &r, COUNT, (const float(*)[3])positions,
                                                (const float(*)[3])normals, e, NULL));
    for (int i = 0; i < COUNT; i++) {
        mean += (double)e[i][0] / COUNT;
    }
    const double exact = 4.0 * PI * 0.5 / (0.5 * 6.0);
    ASSERT_NEAR(mean, exact, 0.01 * exact);
    alp_scene_destroy(scene);
}
