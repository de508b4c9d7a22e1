// SPDX-License-Identifier: MIT
// Look-ups of probes against their formula, and the same bits by every instruction set.
#include "test_volume.h"

#include "base/octahedral.h"
#include "base/random.h"
#include "base/warp.h"
#include "fields/probes/probe_lookup.h"

#include <math.h>

TEST_CONTEXT(1);

enum { POINTS = 1021, SIDE = ALPI_PROBE_MOMENT_SIDE };
static float positions[POINTS][3], normals[POINTS][3], irradiance[POINTS][3];

/// Light that is above 0 for all normals, and distances that hide some probes in part.
static alpi_probe_volume make_volume(alpi_probe_basis basis, bool moments)
{
    alpi_probe_volume v = test_volume(
        context, (test_volume_options){.size = {5, 4, 3}, .basis = basis, .moments = moments});
    for (uint32_t i = 0; i < v.count; i++) {
        for (uint32_t k = 0; k < 3 * v.coefficient_count; k++) {
            v.coefficients[i * 3 * v.coefficient_count + k] +=
                k < 3 || basis == ALPI_PROBE_AMBIENT_CUBE ? 64.0f : 0.0f;
        }
        for (uint32_t d = 0; d < SIDE * SIDE && moments; d++) {
            float *m = v.moments[i * SIDE * SIDE + d];
            m[0] *= 0.25f; // many are nearer than the next probe
            m[1] *= 0.0625f * 1.25f;
        }
    }
    return v;
}

/// Points in the lattice and round it; the first are at probes.
static void draw_points(const alpi_probe_volume *v)
{
    for (uint32_t i = 0; i < POINTS; i++) {
        for (uint32_t k = 0; k < 3; k++) {
            const float u = alpi_unit_float(alpi_hash32(8 * i + k));
            const float cells = 1.5f * u * (float)(v->size[k] - 1) - 0.25f;
            positions[i][k] = v->spacing[k] * (i < 8 ? floorf(cells) : cells);
        }
        const vec2 u = {alpi_unit_float(alpi_hash32(8 * i + 3)),
                        alpi_unit_float(alpi_hash32(8 * i + 4))};
        vec3_store(normals[i], alpi_warp_uniform_cone(u, -1.0f));
    }
}

/// A texel, which may lie one beyond an edge: there the map goes on, mirrored along the edge.
static const float *texel(const alpi_probe_volume *v, uint32_t probe, int x, int y)
{
    const bool aside = x < 0 || x >= SIDE, above = y < 0 || y >= SIDE;
    const int column = x < 0 ? 0 : x >= SIDE ? SIDE - 1 : x;
    const int row = y < 0 ? 0 : y >= SIDE ? SIDE - 1 : y;
    const int i = above ? SIDE - 1 - column : column, j = aside ? SIDE - 1 - row : row;
    return v->moments[probe * SIDE * SIDE + (uint32_t)(j * SIDE + i)];
}

static double see(const alpi_probe_volume *v, uint32_t probe, const double way[3], double distance)
{
    if (!(distance > 0.0)) {
        return 1.0;
    }
    const vec2 uv = alpi_octahedral_encode((vec3){(float)-way[0], (float)-way[1], (float)-way[2]});
    const double x = (double)uv.x * SIDE - 0.5, y = (double)uv.y * SIDE - 0.5;
    const int column = (int)floor(x), row = (int)floor(y);
    double m[2] = {0.0, 0.0};
    for (int i = 0; i < 4; i++) {
        const float *at = texel(v, probe, column + i % 2, row + i / 2);
        const double a = x - column, b = y - row;
        const double share = (i % 2 == 1 ? a : 1.0 - a) * (i / 2 == 1 ? b : 1.0 - b);
        m[0] += share * (double)at[0];
        m[1] += share * (double)at[1];
    }
    if (distance <= m[0]) {
        return 1.0;
    }
    const double variance = fabs(m[1] - m[0] * m[0]);
    return fmax(pow(variance / (variance + (distance - m[0]) * (distance - m[0])), 3.0), 0.05);
}

static double weigh(const alpi_probe_volume *v, uint32_t probe, const uint32_t at[3], uint32_t i)
{
    double way[3], distance = 0.0, cosine = 0.0;
    for (int k = 0; k < 3; k++) {
        way[k] =
            (double)v->spacing[k] * at[k] + (double)v->moves[probe][k] - (double)positions[i][k];
        distance += way[k] * way[k];
        cosine += way[k] * (double)normals[i][k];
    }
    distance = sqrt(distance);
    const double half = 0.5 * (cosine / fmax(distance, 1e-12) + 1.0);
    const double w = see(v, probe, way, distance) * (half * half + 0.2);
    return w < 0.2 ? w * w * w / 0.04 : w;
}

/// E by the formula of probe_lookup.h. @param most the last state that counts
static bool expect(const alpi_probe_volume *v, uint32_t i, int most, bool seen, double e[3])
{
    uint32_t low[3];
    double part[3], total = 0.0;
    float weights[ALPI_SH9_COUNT];
    alpi_probe_weights(v->basis, vec3_load(normals[i]), weights);
    e[0] = e[1] = e[2] = 0.0;
    for (int k = 0; k < 3; k++) {
        const double x =
            fmin(fmax((double)positions[i][k] / (double)v->spacing[k], 0.0), v->size[k] - 1.0);
        low[k] = x < v->size[k] - 1.0 ? (uint32_t)x : v->size[k] - 2;
        part[k] = x - low[k];
    }
    for (uint32_t corner = 0; corner < 8; corner++) {
        uint32_t at[3];
        double w = 1.0;
        for (uint32_t k = 0; k < 3; k++) {
            at[k] = low[k] + (corner >> k & 1);
            w *= (corner >> k & 1) != 0 ? part[k] : 1.0 - part[k];
        }
        const uint32_t probe = at[0] + v->size[0] * (at[1] + v->size[1] * at[2]);
        w *= v->states[probe] > most ? 0.0 : seen ? weigh(v, probe, at, i) : 1.0;
        total += w;
        for (uint32_t c = 0; c < 3 * v->coefficient_count; c++) {
            e[c % 3] += w * (double)weights[c / 3] *
                        (double)v->coefficients[probe * 3 * v->coefficient_count + c];
        }
    }
    for (int k = 0; k < 3; k++) {
        e[k] = total > 1e-9 ? e[k] / total : 0.0;
    }
    return total > 1e-9;
}

static void follow_formula(alpi_probe_basis basis, bool moments)
{
    alpi_probe_volume v = make_volume(basis, moments);
    alp_field *field = NULL;
    ASSERT_OK(context, alpi_probe_field_create(&v, ALP_LOOKUP_OURS, v.origin, NULL, &field));
    draw_points(&v);
    alp_field_irradiance(field, POINTS, (const float(*)[3])positions, (const float(*)[3])normals,
                         irradiance);
    for (uint32_t i = 0; i < POINTS; i++) {
        double e[3];
        if (!moments || !expect(&v, i, ALPI_PROBE_MOVED, true, e)) {
            (void)expect(&v, i, ALPI_PROBE_FILLED, false, e);
        }
        for (int k = 0; k < 3; k++) {
            ASSERT_NEAR(irradiance[i][k], e[k], 2e-4 * 64.0);
        }
    }
    alp_field_destroy(field);
    alpi_probe_volume_destroy(&v);
}

TEST(look_ups_follow_their_formula)
{
    for (int basis = 0; basis < 3; basis++) {
        follow_formula((alpi_probe_basis)basis, false);
        follow_formula((alpi_probe_basis)basis, true);
    }
}

#ifdef ALPI_HAS_V3
TEST(instruction_sets_give_the_same_bits)
{
    static float other[POINTS][3];
    for (int kind = 0; kind < 6 && alpi_context_has_v3(context); kind++) {
        alpi_probe_volume v = make_volume((alpi_probe_basis)(kind / 2), kind % 2 == 1);
        alp_field *field = NULL;
        ASSERT_OK(context, alpi_probe_field_create(&v, ALP_LOOKUP_OURS, v.origin, NULL, &field));
        draw_points(&v);
        alpi_probe_lookup_baseline(field, POINTS, (const float(*)[3])positions,
                                   (const float(*)[3])normals, irradiance);
        alpi_probe_lookup_v3(field, POINTS, (const float(*)[3])positions,
                             (const float(*)[3])normals, other);
        assert_memory_equal(irradiance, other, sizeof other);
        alp_field_destroy(field);
        alpi_probe_volume_destroy(&v);
    }
}
#endif
