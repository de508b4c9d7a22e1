// SPDX-License-Identifier: MIT
// Light propagation on the graphics card against the library's, from the same light and blockers.
#include "test_gl.h"

#include "base/random.h"
#include "fields/propagation/lpv.h"
#include "gl_lpv.h"
#include "options/options.h"

#include <alpenglow/lpv.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

TEST_CONTEXT(2);

enum { ROWS = ALPI_LPV_ROWS };
static const double UNITS = 0x1p30; // of the largest value

/// A room's worth of random surfels, which shine and block.
static void fill(alp_lpv *lpv, const alp_lpv_options *o)
{
    enum { COUNT = 600 };
    static float positions[COUNT][3], normals[COUNT][3], flux[COUNT][3], albedo[COUNT][3],
        areas[COUNT];
    uint32_t state = 7;
    for (int i = 0; i < COUNT; i++) {
        vec3 n;
        float u[9];
        for (int k = 0; k < 9; k++) {
            state = alpi_hash32(state + 0x9e3779b9u);
            u[k] = alpi_unit_float(state);
        }
        n = vec3_normalize_or((vec3){u[0] - 0.5f, u[1] - 0.5f, u[2] - 0.5f}, (vec3){0, 1, 0});
        vec3_store(normals[i], n);
        for (int k = 0; k < 3; k++) {
            const float half = 0.5f * (float)(o->cell * o->size[k]);
            positions[i][k] = half * (2.0f * u[3 + k] - 1.0f);
            flux[i][k] = i < 40 ? u[6 + k] : 0.0f;
            albedo[i][k] = u[8 - k];
        }
        areas[i] = (float)(o->cell * o->cell) * u[8];
    }
    const alp_lpv_surfels s = {.count = COUNT,
                               .positions = (const float(*)[3])positions,
                               .normals = (const float(*)[3])normals,
                               .flux = (const float(*)[3])flux,
                               .areas = areas,
                               .albedo = (const float(*)[3])albedo};
    alp_lpv_begin(lpv);
    ASSERT_OK(context, alp_lpv_add_light(lpv, ALP_LPV_ALL_CASCADES, &s));
    if (o->blockers) {
        ASSERT_OK(context, alp_lpv_add_blockers(lpv, ALP_LPV_ALL_CASCADES, &s));
    }
}

/// What was injected, to the buffer of the card.
static void copy_light(const alp_lpv *lpv, gl_lpv *v)
{
    const uint32_t *n = v->options.size;
    const size_t cells = alpi_lpv_cells(n), cascades = v->options.cascades;
    GLint *whole = malloc(cascades * cells * ROWS * sizeof *whole);
    float most = 0.0f;
    assert_non_null(whole);
    for (size_t c = 0; c < cascades; c++) {
        for (size_t i = 0; i < cells * ROWS; i++) {
            most = fmaxf(most, fabsf(lpv->grids[c].injected[i]));
        }
    }
    for (size_t i = 0; i < cascades * cells * ROWS; i++) {
        const size_t row = i / ROWS % cells / n[0], x = i / ROWS % n[0];
        const float *rows = lpv->grids[i / (cells * ROWS)].injected + row * ROWS * n[0];
        whole[i] = (GLint)lrint((double)(rows[i % ROWS * n[0] + x] / most) * UNITS);
    }
    for (int k = 0; k < 3; k++) {
        v->units[k] = (float)((double)most / UNITS);
    }
    glNamedBufferSubData(v->injected, 0, (GLsizeiptr)(cascades * cells * ROWS * sizeof *whole),
                         whole);
    free(whole);
}

static void copy_blockers(const alp_lpv *lpv, const gl_lpv *v)
{
    const uint32_t *n = v->options.size;
    const size_t nodes = alpi_lpv_nodes(n);
    float(*opacities)[4] = malloc(nodes * sizeof *opacities);
    float(*albedos)[4] = malloc(nodes * sizeof *albedos);
    assert_non_null(opacities);
    assert_non_null(albedos);
    for (uint32_t c = 0; c < v->options.cascades; c++) {
        for (size_t i = 0; i < nodes; i++) {
            const float *node = lpv->grids[c].nodes + i * ALPI_LPV_NODE_TERMS;
            memcpy(opacities[i], node, sizeof opacities[i]);
            memcpy(albedos[i], node + ALPI_LPV_TERMS, 3 * sizeof(float));
            albedos[i][3] = 0.0f;
        }
        const GLsizei size[3] = {(GLsizei)n[0] + 1, (GLsizei)n[1] + 1, (GLsizei)n[2] + 1};
        const GLint z = (GLint)(c * (n[2] + 1));
        glTextureSubImage3D(v->opacities, 0, 0, 0, z, size[0], size[1], size[2], GL_RGBA, GL_FLOAT,
                            opacities);
        glTextureSubImage3D(v->albedos, 0, 0, 0, z, size[0], size[1], size[2], GL_RGBA, GL_FLOAT,
                            albedos);
    }
    free(opacities);
    free(albedos);
}

/// Largest difference of the sums, over the largest sum of a grid.
static double compare_sums(const alp_lpv *lpv, const gl_lpv *v)
{
    const uint32_t *n = v->options.size;
    const size_t cells = alpi_lpv_cells(n), cascades = v->options.cascades;
    const size_t bytes = 3 * cascades * cells * 4 * sizeof(float);
    float(*sum)[4] = malloc(bytes);
    double worst = 0.0;
    assert_non_null(sum);
    glGetTextureImage(v->sum, 0, GL_RGBA, GL_FLOAT, (GLsizei)bytes, sum);
    for (size_t channel = 0; channel < 3; channel++) {
        for (size_t c = 0; c < cascades; c++) {
            double most = 0.0, apart = 0.0;
            for (size_t i = 0; i < 4 * cells; i++) {
                const size_t cell = i / 4, row = cell / n[0];
                const float *own = lpv->grids[c].sum +
                                   (row * ROWS + channel * ALPI_LPV_TERMS + i % 4) * n[0] +
                                   cell % n[0];
                most = fmax(most, fabs((double)*own));
                apart =
                    fmax(apart, fabs((double)*own -
                                     (double)sum[(channel * cascades + c) * cells + cell][i % 4]));
            }
            assert_true(most > 0.0);
            worst = fmax(worst, apart / most);
        }
    }
    free(sum);
    return worst;
}

TEST(light_propagates_as_in_the_library)
{
    if (!test_gl_open()) {
        skip();
    }
    static const uint32_t sizes[3][3] = {{16, 16, 16}, {7, 9, 12}, {4, 5, 6}};
    for (int i = 0; i < 24; i++) {
        alp_lpv_options o = alp_lpv_options_default();
        memcpy(o.size, sizes[i / 8], sizeof o.size);
        o.mode = i % 2 == 0 ? ALP_LPV_ACCURATE : ALP_LPV_CONFORMANCE;
        o.bounces = i % 4 / 2 == 0 ? ALP_BOUNCES_CONVERGE : 1;
        o.blockers = i % 8 != 4;
        o.cascades = i % 3 == 0 ? 3 : 1;
        alp_lpv *lpv = NULL;
        gl_lpv volume;
        ASSERT_OK(context, alp_lpv_create(context, &o, &lpv));
        assert_int_equal(gl_lpv_create(&o, &volume), EXIT_DONE);
        fill(lpv, &o);
        copy_light(lpv, &volume);
        if (o.blockers) {
            copy_blockers(lpv, &volume);
        }
        ASSERT_OK(context, alp_lpv_propagate(lpv));
        gl_lpv_propagate(&volume);
        const double apart = compare_sums(lpv, &volume);
        print_message("%2d: apart by %.2g of the largest sum\n", i, apart);
        ASSERT_NEAR(apart, 0.0, 1e-5);
        gl_lpv_destroy(&volume);
        alp_lpv_destroy(lpv);
        test_gl_check();
    }
}
