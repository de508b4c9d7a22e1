// SPDX-License-Identifier: MIT
// The colours of ambient models, put into the formulas that alpenglow/field.h states.
#include "test_support.h"

#include <alpenglow/probes.h>

#include <math.h>

enum { POINTS = 200, SIDE = ALP_GROUND_MAP_SIDE };

static double read_ground(const alp_ambient_info *m, const float p[3], int channel)
{
    const double least = 0.5, most = SIDE - 0.5;
    const double u = ((double)p[0] - (double)m->ground_low[0]) * (double)m->ground_scale[0];
    const double v = ((double)p[2] - (double)m->ground_low[1]) * (double)m->ground_scale[1];
    const double x = fmin(fmax(u, least), most) - 0.5, y = fmin(fmax(v, least), most) - 0.5;
    double sum = 0.0;
    for (int row = 0; row < SIDE; row++) {
        for (int column = 0; column < SIDE; column++) {
            const double weight =
                fmax(1.0 - fabs(x - column), 0.0) * fmax(1.0 - fabs(y - row), 0.0);
            sum += weight * (double)m->ground[row * SIDE + column][channel];
        }
    }
    return sum;
}

static double read_cube(const alp_ambient_info *m, const float n[3], int channel)
{
    double sum = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        const int color = 2 * axis + (n[axis] > 0.0f ? 0 : 1);
        sum += (double)n[axis] * (double)n[axis] * (double)m->colors[color][channel];
    }
    return sum;
}

static double read_harmonics(const alp_ambient_info *m, const float n[3], int channel)
{
    static const double cosine[3] = {M_PI, 2.0 * M_PI / 3.0, M_PI / 4.0};
    const double x = (double)n[0], y = (double)n[1], z = (double)n[2];
    const double basis[9] = {sqrt(1.0 / (4.0 * M_PI)),
                             sqrt(3.0 / (4.0 * M_PI)) * y,
                             sqrt(3.0 / (4.0 * M_PI)) * z,
                             sqrt(3.0 / (4.0 * M_PI)) * x,
                             sqrt(15.0 / (4.0 * M_PI)) * x * y,
                             sqrt(15.0 / (4.0 * M_PI)) * y * z,
                             sqrt(5.0 / (16.0 * M_PI)) * (3.0 * z * z - 1.0),
                             sqrt(15.0 / (4.0 * M_PI)) * x * z,
                             sqrt(15.0 / (16.0 * M_PI)) * (x * x - y * y)};
    double sum = 0.0;
    for (int l = 0; l < 3; l++) {
        for (int k = -l; k <= l; k++) {
            const int i = l * (l + 1) + k;
            sum += cosine[l] * (double)m->colors[i][channel] * basis[i];
        }
    }
    return sum;
}

static double evaluate(const alp_ambient_info *m, const float p[3], const float n[3], int channel)
{
    const double up = 0.5 * (1.0 + (double)n[1]), down = 0.5 * (1.0 - (double)n[1]);
    const double c[3] = {(double)m->colors[0][channel], (double)m->colors[1][channel],
                         (double)m->colors[2][channel]};
    switch (m->model) {
    case ALP_AMBIENT_HEMISPHERE:
        return c[0] * up + c[1] * down;
    case ALP_AMBIENT_GROUND_MAP:
        return c[0] * up + (c[1] + c[2] * read_ground(m, p, channel)) * down;
    case ALP_AMBIENT_CUBE:
        return read_cube(m, n, channel);
    case ALP_AMBIENT_ENVIRONMENT:
        return read_harmonics(m, n, channel);
    default:
        return c[0];
    }
}

TEST_WITH_CONTEXT(colours_of_ambient_models_give_their_light, 2)
{
    static const uint32_t counts[ALP_AMBIENT_COUNT] = {1, 2, 3, 6, 9};
    static float positions[POINTS][3], normals[POINTS][3], e[POINTS][3];
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_ambient_options o = alp_ambient_options_default();
    o.points = 64;
    o.samples = 16;
    ASSERT_OK(context, alp_scene_free_points(scene, 7, POINTS, positions, normals));
    positions[0][0] = -100.0f; // beyond the ground map
    for (int i = 0; i < ALP_AMBIENT_COUNT; i++) {
        alp_field *field = NULL;
        o.model = (alp_ambient_model)i;
        ASSERT_OK(context, alp_field_create_ambient(scene, &o, &field));
        const alp_ambient_info m = alp_field_get_ambient(field);
        assert_int_equal(m.model, i);
        assert_int_equal(m.color_count, counts[i]);
        assert_true((m.ground != NULL) == (i == ALP_AMBIENT_GROUND_MAP));
        alp_field_irradiance(field, POINTS, (const float(*)[3])positions,
                             (const float(*)[3])normals, e);
        for (int k = 0; k < 3 * POINTS; k++) {
            const double expected =
                fmax(evaluate(&m, positions[k / 3], normals[k / 3], k % 3), 0.0);
            ASSERT_NEAR((double)e[k / 3][k % 3], expected, 1e-5 * (1.0 + expected));
        }
        alp_field_destroy(field);
    }
    alp_scene_destroy(scene);
}

TEST_SLOW_WITH_CONTEXT(other_fields_have_no_ambient_colours, 1)
{
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_probe_options o = alp_probe_options_default();
    alp_probes *probes = NULL;
    alp_field *field = NULL;
    const double origin[3] = {0.0, 0.0, 0.0};
    o.spacing = 0.3f;
    o.rays = 384;
    ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
    ASSERT_OK(context, alp_field_create_probes(probes, (alp_probe_lookup)0, origin, NULL, &field));
    assert_int_equal(alp_field_get_ambient(field).color_count, 0);
    assert_int_equal(alp_field_get_ambient(NULL).color_count, 0);
    assert_null(alp_field_get_ambient(field).ground);
    alp_field_destroy(field);
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
}
