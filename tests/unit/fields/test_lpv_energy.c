// SPDX-License-Identifier: MIT
// Light propagation against its slow twin, and the laws that it keeps: energy, symmetry, scaling,
// moves of the grid, and its known reach.
#include "lpv_twin.h"
#include "lpv_volumes.h"

#include "base/random.h"

TEST_CONTEXT(2);

static const double PI = 3.14159265358979323846;

static alp_lpv *make(const uint32_t size[3], alp_lpv_mode mode, bool blockers, uint32_t iterations)
{
    alp_lpv_options o = alp_lpv_options_default();
    memcpy(o.size, size, sizeof o.size);
    o.cell = 1.0;
    o.mode = mode;
    o.blockers = blockers;
    o.iterations = iterations;
    return lpv_open(context, o);
}

static void add_one(alp_lpv *lpv, const float position[3], const float normal[3], float flux)
{
    lpv_add_one(context, lpv, position, normal, flux);
}

static float random_unit(uint32_t *state)
{
    *state = alpi_hash32(*state + 0x9e3779b9u);
    return alpi_unit_float(*state);
}

/// Lights and blockers at random places.
static void add_random(alp_lpv *lpv, uint32_t count, bool blockers)
{
    uint32_t state = 7;
    for (uint32_t i = 0; i < count; i++) {
        float p[3], n[3], squares = 0.0f;
        for (int k = 0; k < 3; k++) {
            p[k] = ((float)lpv->options.size[k] - 2.0f) * (random_unit(&state) - 0.5f);
            n[k] = random_unit(&state) - 0.5f;
            squares += n[k] * n[k];
        }
        for (int k = 0; k < 3; k++) {
            n[k] /= sqrtf(squares);
        }
        if (!blockers) {
            add_one(lpv, p, n, random_unit(&state));
        } else {
            const float area = random_unit(&state);
            const float albedo[1][3] = {
                {random_unit(&state), random_unit(&state), random_unit(&state)}};
            const alp_lpv_surfels s = {.count = 1,
                                       .positions = (const float(*)[3])p,
                                       .normals = (const float(*)[3])n,
                                       .areas = &area,
                                       .albedo = albedo};
            ASSERT_OK(context, alp_lpv_add_blockers(lpv, ALP_LPV_ALL_CASCADES, &s));
        }
    }
}

/// Sum of intensities of one channel in a cell, by lattice index.
static const float *sum_at(const alp_lpv *lpv, int x, int y, int z, uint32_t row)
{
    const alpi_lpv_grid *g = &lpv->grids[0];
    const int64_t at[3] = {x - g->corner[0], y - g->corner[1], z - g->corner[2]};
    const size_t index = ((size_t)at[2] * g->size[1] + (size_t)at[1]) * ALPI_LPV_ROWS + row;
    return g->sum + index * g->size[0] + (size_t)at[0];
}

static void compare_with_twin(alp_lpv_mode mode, bool wraps, bool blockers, uint32_t bounces)
{
    const uint32_t size[3] = {11, 7, 9}; // no multiple of a vector
    enum { STEPS = 6 };
    alp_lpv *lpv = make(size, mode, blockers, STEPS);
    lpv->wraps = wraps;
    lpv->options.bounces = bounces;
    add_random(lpv, 60, false);
    if (blockers) {
        add_random(lpv, 80, true);
    }
    twin t;
    twin_open(&t, (const int[3]){11, 7, 9}, twin_scheme_of(mode), wraps);
    twin_take(&t, &lpv->grids[0]);
    t.nodes = lpv->grids[0].nodes;
    t.reflects = bounces != 1;
    for (int i = 0; i < STEPS; i++) {
        twin_step(&t, blockers && i > 0);
    }
    ASSERT_OK(context, alp_lpv_propagate(lpv));
    double largest = 0.0, apart = 0.0;
    for (int z = 0; z < 9; z++) {
        for (int y = 0; y < 7; y++) {
            for (int x = 0; x < 11; x++) {
                const int cell[3] = {x, y, z};
                const double *expected = twin_cell(&t, t.sum, cell);
                for (uint32_t k = 0; k < TWIN_ROWS; k++) {
                    const size_t row = ((size_t)z * 7 + (size_t)y) * TWIN_ROWS + k;
                    const double v = (double)lpv->grids[0].sum[row * 11 + (size_t)x];
                    apart = fmax(apart, fabs(v - expected[k]));
                    largest = fmax(largest, fabs(expected[k]));
                }
            }
        }
    }
    assert_true(largest > 0.0);
    ASSERT_NEAR(apart / largest, 0.0, 2e-6);
    twin_close(&t);
    alp_lpv_destroy(lpv);
}

TEST(steps_agree_with_the_twin)
{
    const alp_lpv_mode modes[2] = {ALP_LPV_ACCURATE, ALP_LPV_CONFORMANCE};
    for (int m = 0; m < 2; m++) {
        compare_with_twin(modes[m], false, false, 1);
        compare_with_twin(modes[m], true, false, 1);
        compare_with_twin(modes[m], false, true, 1);
        compare_with_twin(modes[m], false, true, ALP_BOUNCES_CONVERGE);
    }
}

/// A step keeps all light: in float within 1e-7 a step, in the twin's double within 1e-12.
TEST(steps_keep_energy)
{
    const uint32_t size[3] = {16, 16, 16};
    for (int mode = 0; mode < ALP_LPV_MODE_COUNT; mode++) {
        enum { STEPS = 64 };
        alp_lpv *lpv = make(size, (alp_lpv_mode)mode, false, STEPS);
        lpv->wraps = true;
        add_random(lpv, 30, false);
        const double before = lpv_flux(&lpv->grids[0], lpv->grids[0].injected);
        ASSERT_OK(context, alp_lpv_propagate(lpv));
        // The sum holds each of 65 states whole.
        const double all = lpv_flux(&lpv->grids[0], lpv->grids[0].sum);
        ASSERT_NEAR(all / (before * (STEPS + 1)), 1.0, 1e-7 * STEPS / 2);
        alp_lpv_destroy(lpv);
    }
    for (int mode = 0; mode < 2; mode++) {
        twin t;
        alp_lpv *lpv = make(size, (alp_lpv_mode)mode, false, 1);
        add_random(lpv, 30, false);
        twin_open(&t, (const int[3]){16, 16, 16}, twin_scheme_of((alp_lpv_mode)mode), true);
        twin_take(&t, &lpv->grids[0]);
        double last = twin_flux(&t, t.light);
        for (int i = 0; i < 8; i++) {
            twin_step(&t, false);
            const double now = twin_flux(&t, t.light);
            ASSERT_NEAR(now / last, 1.0, 1e-12);
            last = now;
        }
        twin_close(&t);
        alp_lpv_destroy(lpv);
    }
}

/// E on the axis of one light over Φ/(πr²), after 32 steps.
TEST(light_reaches_as_far_as_is_known)
{
    static const int distances[6] = {1, 2, 3, 4, 6, 8};
    static const double reach[2][6] = {{.492, .823, .819, .693, .451, .305},
                                       {.391, .547, .508, .431, .250, .111}};
    const uint32_t size[3] = {40, 40, 40};
    const float position[3] = {0.5f, 0.5f, 0.0f}, up[3] = {0.0f, 0.0f, 1.0f};
    for (int mode = 0; mode < 2; mode++) {
        alp_lpv *lpv = make(size, (alp_lpv_mode)mode, false, 32);
        add_one(lpv, position, up, 1.0f);
        ASSERT_OK(context, alp_lpv_propagate(lpv));
        for (int i = 0; i < 6; i++) {
            const int r = distances[i];
            const double i0 = (double)*sum_at(lpv, 0, 0, r, 0);
            const double iz = (double)*sum_at(lpv, 0, 0, r, 3);
            const double e = (PI * i0 + 2.0 * PI / 3.0 * iz) / ALP_LPV_GAIN;
            ASSERT_NEAR(e * PI * r * r, reach[mode][i], 6e-4);
        }
        alp_lpv_destroy(lpv);
    }
}

/// Light of one lamp along x, seen after all 48 turns and mirrors of the cube.
TEST(accurate_light_has_the_symmetry_of_the_cube)
{
    const uint32_t size[3] = {15, 15, 15};
    alp_lpv *lpv = make(size, ALP_LPV_ACCURATE, false, 10);
    const float centre[3] = {0.5f, 0.5f, 0.5f}; // of cell 0
    for (int a = 0; a < 3; a++) {               // the same light along all six axes
        for (int s = -1; s <= 1; s += 2) {
            float n[3] = {0.0f, 0.0f, 0.0f}, p[3];
            n[a] = (float)s;
            for (int k = 0; k < 3; k++) {
                p[k] = centre[k] - 0.4f * n[k];
            }
            add_one(lpv, p, n, 1.0f);
        }
    }
    ASSERT_OK(context, alp_lpv_propagate(lpv));
    // Cell 0 of the lattice holds the lights; the grid reaches from −7 to 7.
    static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                     {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    const alpi_lpv_grid *g = &lpv->grids[0];
    assert_int_equal(g->corner[0], -7);
    const int at[3] = {1, 3, -5};
    const float expected = *sum_at(lpv, at[0], at[1], at[2], 0);
    assert_true(expected > 0.0f);
    for (int i = 0; i < 48; i++) {
        const int *order = orders[i / 8];
        int to[3], sign[3];
        for (int k = 0; k < 3; k++) {
            sign[k] = (i >> k & 1) != 0 ? -1 : 1;
            to[k] = sign[k] * at[order[k]];
        }
        ASSERT_NEAR(*sum_at(lpv, to[0], to[1], to[2], 0) / expected, 1.0, 2e-6);
        for (int k = 0; k < 3; k++) {
            const float v = *sum_at(lpv, to[0], to[1], to[2], (uint32_t)(1 + k));
            const float w = *sum_at(lpv, at[0], at[1], at[2], (uint32_t)(1 + order[k]));
            ASSERT_NEAR(v, (float)sign[k] * w, 2e-6f * expected);
        }
    }
    alp_lpv_destroy(lpv);
}

TEST(light_scales_with_its_source)
{
    const uint32_t size[3] = {12, 12, 12};
    const float p[3] = {0.1f, 0.2f, 0.3f}, n[3] = {0.6f, 0.0f, 0.8f};
    float values[2];
    for (int i = 0; i < 2; i++) {
        alp_lpv *lpv = make(size, ALP_LPV_ACCURATE, false, 12);
        add_one(lpv, p, n, i == 0 ? 1.0f : 1024.0f);
        ASSERT_OK(context, alp_lpv_propagate(lpv));
        values[i] = *sum_at(lpv, 2, 1, 3, 0);
        alp_lpv_destroy(lpv);
    }
    assert_true(values[0] > 0.0f);
    assert_true(values[1] == 1024.0f * values[0]); // a power of two: the same bits
}

/// Two opposed lights in one cell, against the sum of each alone, after 8 steps: RMS difference of
/// p0 of the sums over its RMS. The clamp alone is not linear.
TEST(superposition_departs_as_is_known)
{
    static const double known[3] = {.1273, .0928, 0.0};
    const int n[3] = {17, 17, 17};
    for (int mode = 0; mode < 3; mode++) { // the third: without the clamp
        twin t[3];
        twin_scheme scheme = twin_scheme_of(mode == 1 ? ALP_LPV_CONFORMANCE : ALP_LPV_ACCURATE);
        scheme.clamps = mode < 2;
        const int centre[3] = {8, 8, 8};
        for (int i = 0; i < 3; i++) {
            const double up[3] = {0.0, 0.0, 1.0}, down[3] = {0.0, 0.0, -1.0};
            twin_open(&t[i], n, scheme, false);
            if (i != 1) {
                twin_give(twin_cell(&t[i], t[i].light, centre), 1.0, up);
            }
            if (i != 0) {
                twin_give(twin_cell(&t[i], t[i].light, centre), 1.0, down);
            }
            for (int s = 0; s < 8; s++) {
                twin_step(&t[i], false);
            }
        }
        double apart = 0.0, all = 0.0;
        for (size_t i = 0; i < twin_cells(&t[0]) * TWIN_ROWS; i += 4) {
            const double d = t[2].sum[i] - t[0].sum[i] - t[1].sum[i];
            apart += d * d;
            all += t[2].sum[i] * t[2].sum[i];
        }
        ASSERT_NEAR(sqrt(apart / all), known[mode], mode < 2 ? 5e-4 : 1e-14);
        for (int i = 0; i < 3; i++) {
            twin_close(&t[i]);
        }
    }
}

/// A grid that lies elsewhere by whole cells holds the same light at the same places.
TEST(whole_cells_do_not_matter)
{
    const uint32_t size[3] = {24, 24, 24};
    float values[2];
    for (int i = 0; i < 2; i++) {
        alp_lpv *lpv = make(size, ALP_LPV_ACCURATE, true, 4);
        const double eye[3] = {i * 3.0, i * -2.0, i * 1.0}, nowhere[3] = {0.0, 0.0, 0.0};
        ASSERT_OK(context, alp_lpv_follow(lpv, eye, nowhere));
        alp_lpv_begin(lpv);
        const float p[3] = {0.3f, 0.4f, 0.2f}, n[3] = {0.0f, 1.0f, 0.0f};
        const float area = 0.8f, q[1][3] = {{1.1f, 1.9f, 0.3f}}, m[1][3] = {{0.0f, -1.0f, 0.0f}};
        const alp_lpv_surfels wall = {.count = 1, .positions = q, .normals = m, .areas = &area};
        add_one(lpv, p, n, 1.0f);
        ASSERT_OK(context, alp_lpv_add_blockers(lpv, ALP_LPV_ALL_CASCADES, &wall));
        ASSERT_OK(context, alp_lpv_propagate(lpv));
        alp_field *field = NULL;
        ASSERT_OK(context, alp_field_create_lpv(lpv, &field));
        const float at[1][3] = {{0.9f, 2.7f, 1.4f}}, normal[1][3] = {{0.0f, -1.0f, 0.0f}};
        float e[1][3];
        alp_field_irradiance(field, 1, at, normal, e);
        values[i] = e[0][0];
        alp_field_destroy(field);
        alp_lpv_destroy(lpv);
    }
    assert_true(values[0] > 0.0f);
    ASSERT_NEAR(values[1] / values[0], 1.0, 1e-6);
}

/// A closed box whose walls emit the radiance 1, at its centre: E = π there.
static double box_centre(uint32_t side, alp_lpv_mode mode, uint32_t iterations)
{
    const uint32_t size[3] = {side, side, side};
    alp_lpv *lpv = make(size, mode, false, iterations);
    const float half = 0.5f * (float)side;
    for (int a = 0; a < 3; a++) {
        for (int s = -1; s <= 1; s += 2) {
            for (uint32_t i = 0; i < side * side; i++) {
                float p[3], n[3] = {0.0f, 0.0f, 0.0f};
                n[a] = (float)-s;
                p[a] = (float)s * half;
                p[(a + 1) % 3] = (float)(i % side) + 0.5f - half;
                p[(a + 2) % 3] = (float)(i / side) + 0.5f - half;
                add_one(lpv, p, n, (float)PI);
            }
        }
    }
    ASSERT_OK(context, alp_lpv_propagate(lpv));
    const double i0 = (double)*sum_at(lpv, 0, 0, 0, 0);
    alp_lpv_destroy(lpv);
    return i0 / ALP_LPV_GAIN;
}

TEST(a_closed_box_is_as_bright_as_is_known)
{
    ASSERT_NEAR(box_centre(8, ALP_LPV_CONFORMANCE, 64), 1.44, 5e-3);
    ASSERT_NEAR(box_centre(8, ALP_LPV_ACCURATE, 64), .90, 5e-3);
    ASSERT_NEAR(box_centre(16, ALP_LPV_ACCURATE, 192), .86, 5e-3);
}
