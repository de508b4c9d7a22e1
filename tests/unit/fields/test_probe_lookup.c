// SPDX-License-Identifier: MIT
// Look-ups of probes that are made by hand: linear light, wrapped octahedral maps, continuity, NaN.
#include "field_scenes.h"

#include "fields/probes/probe_lookup.h"

TEST_CONTEXT(1);

static float random_unit(uint32_t *state)
{
    *state = *state * 747796405u + 2891336453u;
    return (float)((*state >> 9) + 0.5) * 0x1p-23f;
}

/// A lattice 1 m apart from the origin, zeroed.
static alpi_probe_volume make_volume(uint32_t side, alpi_probe_basis basis, bool gradients,
                                     bool moments)
{
    alpi_probe_volume v = {.count = side * side * side,
                           .size = {side, side, side},
                           .spacing = {1.0f, 1.0f, 1.0f},
                           .basis = basis};
    ASSERT_OK(context, alpi_probe_volume_allocate(context, gradients, moments, &v));
    return v;
}

static alp_field *open_field(const alpi_probe_volume *v, alp_probe_lookup lookup)
{
    alp_field *field = NULL;
    ASSERT_OK(context, alpi_probe_field_create(v, lookup, NULL, NULL, &field));
    return field;
}

static void set_even(const alpi_probe_volume *v, uint32_t probe, float light)
{
    for (uint32_t k = 0; k < 3; k++) {
        v->coefficients[(size_t)probe * v->coefficient_count * 3 + k] = light;
    }
}

static void see_everything(const alpi_probe_volume *v)
{
    for (uint32_t i = 0; i < v->count * 64; i++) {
        v->moments[i][0] = 10.0f;
        v->moments[i][1] = 100.0f;
    }
}

/// Light that is linear in space is read exactly.
static double linear(double x, double y, double z)
{
    return 3.0 + 0.5 * x - 0.7 * y + 0.2 * z;
}

TEST(linear_light_is_read_exactly)
{
    const double even = FIELD_PI * 0.28209479; // E of c00 = 1
    for (int basis = ALPI_PROBE_SH9; basis <= ALPI_PROBE_SH4; basis++) {
        alpi_probe_volume v = make_volume(3, (alpi_probe_basis)basis, false, false);
        for (uint32_t i = 0; i < v.count; i++) {
            set_even(&v, i, (float)linear(i % 3, i / 3 % 3, i / 9));
        }
        alp_field *field = open_field(&v, ALP_LOOKUP_OURS),
                  *three = open_field(&v, ALP_LOOKUP_THREE);
        for (int i = 0; i < 50; i++) {
            const vec3 p = {0.04f * (float)i, 0.5f + 0.02f * (float)i, 1.5f - 0.03f * (float)i};
            const vec3 n = field_tilted(0.06 * i, 0.9 * i);
            ASSERT_NEAR(field_read(field, p, n).x,
                        even * linear((double)p.x, (double)p.y, (double)p.z), 1e-5);
            const vec3 q = vec3_mad((vec3){1.0f, 1.0f, 1.0f}, 0.5f, n); // read half a cell along n
            ASSERT_NEAR(field_read(three, (vec3){1.0f, 1.0f, 1.0f}, n).x,
                        even * linear((double)q.x, (double)q.y, (double)q.z), 1e-5);
        }
        alp_field_destroy(field);
        alp_field_destroy(three);
        alpi_probe_volume_destroy(&v);
    }
}

/// With gradients, the light of one probe alone is linear.
TEST(gradients_carry_linear_light)
{
    alpi_probe_volume v = make_volume(2, ALPI_PROBE_SH9, true, true);
    const double even = FIELD_PI * 0.28209479;
    see_everything(&v);
    for (uint32_t i = 0; i < 8; i++) {
        static const float slope[3] = {0.5f, -0.7f, 0.2f};
        set_even(&v, i, (float)linear(i % 2, i / 2 % 2, i / 4));
        for (uint32_t axis = 0; axis < 3; axis++) {
            for (uint32_t k = 0; k < 3; k++) {
                v.gradients[(i * 3 + axis) * 27 + k] = slope[axis];
            }
        }
    }
    alp_field *field = open_field(&v, ALP_LOOKUP_OURS);
    for (int i = 0; i < 50; i++) {
        const vec3 p = {0.02f * (float)i, 0.3f + 0.01f * (float)i, 0.9f - 0.017f * (float)i};
        const vec3 e = field_read(field, p, field_tilted(0.06 * i, 0.9 * i));
        ASSERT_NEAR(e.y, even * linear((double)p.x, (double)p.y, (double)p.z), 1e-5);
    }
    // They reach half a cell beyond the outer probes, and no further.
    const vec3 up = {0.0f, 1.0f, 0.0f};
    ASSERT_NEAR(field_read(field, (vec3){1.5f, 0.5f, 0.5f}, up).x, even * linear(1.5, 0.5, 0.5),
                1e-5);
    ASSERT_NEAR(field_read(field, (vec3){9.0f, 0.5f, 0.5f}, up).x, even * linear(1.5, 0.5, 0.5),
                1e-5);
    ASSERT_NEAR(field_read(field, (vec3){0.5f, 0.5f, -1e9f}, up).x, even * linear(0.5, 0.5, -0.5),
                1e-5);
    alp_field_destroy(field);
    alpi_probe_volume_destroy(&v);
}

/// The ambient cube: E = Σ n_i² E(±axis i).
TEST(a_cube_is_read_by_squares)
{
    alpi_probe_volume v = make_volume(1, ALPI_PROBE_AMBIENT_CUBE, false, false);
    for (uint32_t i = 0; i < 18; i++) {
        v.coefficients[i] = (float)(i / 3 + 1);
    }
    alp_field *field = open_field(&v, ALP_LOOKUP_OURS);
    const vec3 p = {0.3f, -4.0f, 2.0f};
    ASSERT_NEAR(field_read(field, p, (vec3){1.0f, 0.0f, 0.0f}).x, 1.0, 1e-6);
    ASSERT_NEAR(field_read(field, p, (vec3){-1.0f, 0.0f, 0.0f}).x, 2.0, 1e-6);
    ASSERT_NEAR(field_read(field, p, (vec3){0.6f, 0.0f, -0.8f}).x, 0.36 * 1.0 + 0.64 * 6.0, 1e-6);
    ASSERT_NEAR(field_read(field, p, (vec3){0.0f, -0.8f, 0.6f}).x, 0.64 * 4.0 + 0.36 * 5.0, 1e-6);
    alp_field_destroy(field);
    alpi_probe_volume_destroy(&v);
}

// --- visibility ----------------------------------------------------------------------------------

TEST(hidden_probes_do_not_count)
{
    alpi_probe_volume v = make_volume(2, ALPI_PROBE_SH9, false, true);
    see_everything(&v);
    for (uint32_t i = 0; i < 8; i++) {
        const bool hidden = i % 2 != 0; // those at x = 1, which see 20 cm
        set_even(&v, i, hidden ? 10.0f : 1.0f);
        for (uint32_t t = 0; t < 64 && hidden; t++) {
            v.moments[i * 64 + t][0] = 0.2f;
            v.moments[i * 64 + t][1] = 0.2f * 0.2f;
        }
    }
    alp_field *field = open_field(&v, ALP_LOOKUP_OURS);
    const double even = FIELD_PI * 0.28209479;
    for (int i = 0; i < 8; i++) {
        const vec3 e = field_read(field, (vec3){0.5f, 0.4f, 0.6f}, field_tilted(0.4 * i, 2.0 * i));
        ASSERT_NEAR(e.x, even, 0.1 * even); // 1 % of the weight at most
    }
    alp_field_destroy(field);
    alpi_probe_volume_destroy(&v);
}

/// The border of a map continues round the sphere: each texel of it equals one that touches it
/// there.
TEST(borders_of_maps_wrap)
{
    enum { SIDE = ALPI_PROBE_MOMENT_SIDE };
    alpi_probe_volume v = make_volume(1, ALPI_PROBE_SH9, false, true);
    for (int i = 0; i < SIDE * SIDE; i++) {
        v.moments[i][0] = (float)i;
    }
    alp_field *field = open_field(&v, ALP_LOOKUP_OURS);
    float(*map)[2] = ((alpi_probe_field *)field)->moments;
    for (int i = 0; i < SIDE; i++) {
        const int line = ALPI_LOOKUP_SIDE, mirrored = SIDE - 1 - i;
        ASSERT_NEAR(map[1 + i][0], mirrored, 0.0);
        ASSERT_NEAR(map[(SIDE + 1) * line + 1 + i][0], (SIDE - 1) * SIDE + mirrored, 0.0);
        ASSERT_NEAR(map[(1 + i) * line][0], mirrored * SIDE, 0.0);
        ASSERT_NEAR(map[(1 + i) * line + SIDE + 1][0], mirrored * SIDE + SIDE - 1, 0.0);
    }
    ASSERT_NEAR(map[0][0], SIDE * SIDE - 1, 0.0); // all corners are −z
    alp_field_destroy(field);
    alpi_probe_volume_destroy(&v);
}

/// Round the middle probe of random ones, through all octants and the borders of its map: no step
/// of .1 mm changes light by a hundredth.
TEST(light_is_continuous_round_a_probe)
{
    enum { STEPS = 20000 };
    uint32_t state = 5;
    alpi_probe_volume v = make_volume(3, ALPI_PROBE_SH9, false, true);
    for (uint32_t i = 0; i < v.count; i++) {
        set_even(&v, i, random_unit(&state));
        for (uint32_t t = 0; t < 64; t++) {
            const float m = 0.4f + 0.2f * random_unit(&state);
            v.moments[i * 64 + t][0] = m;
            v.moments[i * 64 + t][1] = m * m + 0.02f;
        }
    }
    alp_field *field = open_field(&v, ALP_LOOKUP_OURS);
    const vec3 n = field_tilted(1.0, 2.0);
    for (int way = 0; way < 3; way++) {
        double before = -1.0;
        for (int i = 0; i <= STEPS; i++) {
            const double turn = 2.0 * FIELD_PI * i / STEPS;
            const float a = (float)(0.4 * cos(turn)), b = (float)(0.4 * sin(turn));
            const float c = 0.1f * a - 0.05f;
            const vec3 at[3] = {{a, b, c}, {c, a, b}, {b, c, a}};
            const vec3 p = vec3_add(at[way], (vec3){1.0f, 1.0f, 1.0f});
            const double e = (double)field_read(field, p, n).x;
            if (before >= 0.0) {
                ASSERT_NEAR(e, before, 0.005);
            }
            before = e;
        }
    }
    alp_field_destroy(field);
    alpi_probe_volume_destroy(&v);
}

/// Lines through the air above the blocks of a baked room: no step of .1 mm across cells changes E
/// by a twentieth of its mean.
TEST(light_is_continuous_across_cells)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_probe_options o = alp_probe_options_default();
    alp_probes *probes = NULL;
    alp_field *field = NULL;
    uint32_t state = 9;
    double worst = 0.0;
    o.spacing = 0.1f;
    o.atlas_size = 64;
    ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
    ASSERT_OK(context, alp_field_create_probes(probes, ALP_LOOKUP_OURS, NULL, NULL, &field));
    for (int line = 0; line < 50; line++) {
        vec3 p = {0.1f + 0.3f * random_unit(&state), 0.38f, 0.1f + 0.3f * random_unit(&state)};
        const vec3 n = field_tilted(0.06 * line, 3.0 * line);
        const vec3 step = {(float)(5e-5 * cos(line)), 2e-5f, (float)(5e-5 * sin(line))};
        float before = field_read(field, p, n).y;
        for (int i = 0; i < 3000; i++) {
            p = vec3_add(p, step);
            const float e = field_read(field, p, n).y;
            worst = fmax(worst, fabs((double)(e - before)));
            before = e;
        }
    }
    const double mean = (double)alp_probes_get_info(probes).mean;
    print_message("a step of .1 mm changes E by %.2f %% of its mean at most\n",
                  100.0 * worst / mean);
    assert_true(worst < 0.05 * mean);
    alp_field_destroy(field);
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
}

// --- places and numbers --------------------------------------------------------------------------

TEST(origins_move_the_positions_of_scenes)
{
    alpi_probe_volume v = make_volume(2, ALPI_PROBE_SH9, false, false);
    const double far_away[3] = {1e6 + 0.25, -3e6, 5e5};
    alp_field *field = NULL;
    for (uint32_t i = 0; i < 8; i++) {
        set_even(&v, i, (float)linear(i % 2, i / 2 % 2, i / 4));
    }
    for (int k = 0; k < 3; k++) {
        v.origin[k] = far_away[k] + 0.5;
    }
    ASSERT_OK(context, alpi_probe_field_create(&v, ALP_LOOKUP_OURS, far_away, NULL, &field));
    const vec3 e = field_read(field, (vec3){0.75f, 0.9f, 1.2f}, (vec3){0.0f, 1.0f, 0.0f});
    ASSERT_NEAR(e.x, FIELD_PI * 0.28209479 * linear(0.25, 0.4, 0.7), 1e-5);
    alp_field_destroy(field);
    alpi_probe_volume_destroy(&v);
}

static void check_numbers(bool moments)
{
    alpi_probe_volume v = make_volume(2, ALPI_PROBE_SH9, false, moments);
    if (moments) {
        see_everything(&v);
    }
    for (uint32_t i = 0; i < 8; i++) {
        set_even(&v, i, 1.0f);
    }
    alp_field *field = open_field(&v, ALP_LOOKUP_OURS);
    const float p[4][3] = {
        {NAN, 0.0f, 0.0f}, {0.5f, 0.5f, 0.5f}, {0.5f, INFINITY, 0.0f}, {0.5f, 0.2f, 0.3f}};
    const float n[4][3] = {
        {0.0f, 1.0f, 0.0f}, {0.0f, NAN, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};
    float e[4][3];
    memset(e, 0xff, sizeof e);
    alp_field_irradiance(field, 4, p, n, e);
    for (int i = 0; i < 3; i++) {
        ASSERT_NEAR(e[i][0] + e[i][1] + e[i][2], 0.0, 0.0);
    }
    ASSERT_NEAR(e[3][1], FIELD_PI * 0.28209479, 1e-6);
    const vec3 up = {0.0f, 1.0f, 0.0f};
    ASSERT_NEAR(field_read(field, (vec3){1e30f, -1e30f, 3e38f}, up).x, FIELD_PI * 0.28209479, 1e-5);
    ASSERT_NEAR(field_read(field, (vec3){1.0f, 0.0f, 1.0f}, up).x, FIELD_PI * 0.28209479, 1e-6);
    alp_field_irradiance(NULL, 4, p, n, e);
    alp_field_destroy(NULL);
    alp_field_errors(NULL, 4, p, n, e[0]);
    alp_field_destroy(field);
    alpi_probe_volume_destroy(&v);
}

TEST(numbers_that_are_not_finite_read_0)
{
    check_numbers(false);
    check_numbers(true);
}

/// E below 0, which harmonics of one bright direction have behind it, reads 0.
TEST(light_is_never_below_0)
{
    alpi_probe_volume v = make_volume(1, ALPI_PROBE_SH9, false, false);
    v.coefficients[0] = 1.0f;
    v.coefficients[3] = 3.0f; // y
    alp_field *field = open_field(&v, ALP_LOOKUP_OURS);
    const vec3 p = {0.0f, 0.0f, 0.0f};
    assert_true(field_read(field, p, (vec3){0.0f, 1.0f, 0.0f}).x > 1.0f);
    ASSERT_NEAR(field_read(field, p, (vec3){0.0f, -1.0f, 0.0f}).x, 0.0, 0.0);
    alp_field_destroy(field);
    alpi_probe_volume_destroy(&v);
}

TEST(baseline_and_v3_give_the_same_bits)
{
#ifdef ALPI_HAS_V3
    enum { COUNT = 2000 };
    static float p[COUNT][3], n[COUNT][3], a[COUNT][3], b[COUNT][3];
    uint32_t state = 3;
    if (!alpi_context_has_v3(context)) {
        skip();
    }
    for (int i = 0; i < COUNT; i++) {
        for (int k = 0; k < 3; k++) {
            p[i][k] = 3.0f * random_unit(&state) - 0.5f;
        }
        vec3_store(n[i], field_tilted(3.1 * (double)random_unit(&state), 0.1 * i));
    }
    for (int basis = 0; basis < 3; basis++) {
        alpi_probe_volume v = make_volume(3, (alpi_probe_basis)basis, true, true);
        const uint32_t floats = v.count * v.coefficient_count * 3;
        for (uint32_t i = 0; i < floats; i++) {
            v.coefficients[i] = random_unit(&state);
            v.gradients[3 * i] = v.gradients[3 * i + 1] = random_unit(&state) - 0.5f;
        }
        for (uint32_t i = 0; i < v.count * 64; i++) {
            v.moments[i][0] = random_unit(&state);
            v.moments[i][1] = v.moments[i][0] * v.moments[i][0] + 0.05f * random_unit(&state);
        }
        alp_field *field = open_field(&v, ALP_LOOKUP_OURS);
        alpi_probe_lookup_baseline(field, COUNT, (const float(*)[3])p, (const float(*)[3])n, a);
        alpi_probe_lookup_v3(field, COUNT, (const float(*)[3])p, (const float(*)[3])n, b);
        assert_memory_equal(a, b, sizeof a);
        alp_field_destroy(field);
        alpi_probe_volume_destroy(&v);
    }
#else
    skip();
#endif
}
