// SPDX-License-Identifier: MIT
// What must not change radiosity: workers, whether rays are kept, in what order light is added, and
// mirrors.
#include "test_radiant.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>

static const vec3 ONE = {1, 1, 1}, ZERO = {0, 0, 0}, HALF = {0.5f, 0.6f, 0.7f};
static const vec3 PLACES[2] = {{0.2f, 0.7f, 0.3f}, {0.8f, 0.4f, 0.6f}};

/// A room without a ceiling, with a double-sided leaf across it, and lamps: bit i for lamp i.
static alp_scene *make_room(alp_context *context, unsigned lamps)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_light lights[2];
    uint32_t count = 0;
    alpi_builder_start(&b, context, "room");
    alpi_builder_surface(&b, "room", alpi_builder_material(&b, "room", HALF, ZERO));
    alpi_builder_box(&b, ONE, ZERO, ALPI_FACE_ALL & ~(unsigned)ALPI_FACE_TOP);
    alpi_builder_surface(&b, "leaf", alpi_builder_material(&b, "leaf", HALF, ZERO));
    alpi_builder_quad(
        &b, (const vec3[4]){
                {0.5f, 0.2f, 0.8f}, {0.6f, 0.2f, 0.2f}, {0.6f, 0.8f, 0.2f}, {0.5f, 0.8f, 0.8f}});
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    scene->materials[1].double_sided = true;
    for (uint32_t i = 0; i < 2; i++) {
        if (lamps >> i & 1u) {
            lights[count++] = (alpi_light){.kind = ALP_LIGHT_POINT,
                                           .color = {1.0f, 0.5f, 0.25f},
                                           .intensity = (float)(i + 1),
                                           .position = PLACES[i],
                                           .range = INFINITY};
        }
    }
    if (count > 0) {
        test_lit_set_lamps(scene, lights, count);
    }
    return scene;
}

static test_radiant_options options_of(uint32_t hemicube)
{
    test_radiant_options o = test_radiant_default();
    o.size = 48;
    o.bounces = 3;
    o.hemicube = hemicube;
    o.direct_samples = 16;
    return o;
}

enum { TEXEL_LIMIT = 4096 };

TEST(kept_or_not_and_workers)
{
    static const uint32_t workers[3] = {1, 2, 7};
    static alpi_reference_value first[TEXEL_LIMIT];
    static float cells[2 * TEXEL_LIMIT][4];
    for (uint32_t cube = 0; cube <= 8; cube += 8) {
        for (int i = 0; i < 6; i++) {
            alp_context *context = test_context(workers[i / 2]);
            test_radiant r;
            test_radiant_options o = options_of(cube);
            o.kept_limit = i % 2 ? 0 : 1ull << 30;
            test_radiant_open(make_room(context, 3), &o, &r);
            test_radiant_gather(&r, 32);
            assert_true(r.texels.count <= TEXEL_LIMIT && r.solution.patches.two_sided);
            assert_true(r.solution.kept == (i % 2 == 0) && r.solution.passes == 3);
            assert_true(r.solution.receiver_count > r.solution.patches.patch_count); // backs
            const size_t size = r.texels.count * sizeof *first;
            const size_t cells_size = 2 * (size_t)r.texels.count * sizeof *cells;
            if (i == 0) {
                memcpy(first, r.values, size);
                memcpy(cells, r.solution.patches.cells, cells_size);
            }
            assert_memory_equal(r.values, first, size);
            assert_memory_equal(r.solution.patches.cells, cells, cells_size);
            test_radiant_close(&r);
            alp_context_destroy(context);
        }
    }
}

/// The light of two lamps is the sum of that of each, along the same rays. Each value is a sum of
/// hundreds of floats of the cells, three bounces deep.
TEST_WITH_CONTEXT(light_adds_up, 2)
{
    static alpi_reference_value alone[3][TEXEL_LIMIT];
    double worst = 0.0;
    for (unsigned lamps = 1; lamps <= 3; lamps++) {
        test_radiant r;
        const test_radiant_options o = options_of(0);
        test_radiant_open(make_room(context, lamps), &o, &r);
        test_radiant_gather(&r, 32);
        memcpy(alone[lamps - 1], r.values, r.texels.count * sizeof *r.values);
        for (uint32_t t = 0; lamps == 3 && t < r.texels.count; t++) {
            for (int k = 0; k < 3; k++) {
                const double sum = (double)alone[0][t].mean[k] + (double)alone[1][t].mean[k];
                ASSERT_NEAR(r.values[t].mean[k], sum, 1e-5 * sum);
                worst = fmax(worst, fabs((double)r.values[t].mean[k] - sum) / sum);
            }
        }
        test_radiant_close(&r);
    }
    printf("accuracy: radiosity of two lamps and its sum over each: %.1e apart\n", worst);
}

/// A lamp in the middle of a cube: the six faces have the same mean, and so have the
/// quarters of each. 1,024 rays a patch.
TEST_WITH_CONTEXT(a_symmetric_room_has_a_symmetric_map, 2)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    test_radiant r;
    test_radiant_options o = test_radiant_default();
    double sums[6][4] = {{0.0}}, areas[6][4] = {{0.0}}, worst = 0.0;
    alpi_builder_start(&b, context, "cube");
    const uint32_t dull = test_grey(&b, "dull", 0.7, 0.0);
    for (unsigned face = 0; face < 6; face++) {
        alpi_builder_surface(&b, "face", dull);
        alpi_builder_box(&b, ONE, vec3_scale(ONE, -1.0f), 1u << face);
    }
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    test_lit_set_lamps(
        scene,
        &(alpi_light){.kind = ALP_LIGHT_POINT, .color = ONE, .intensity = 1.0f, .range = INFINITY},
        1);
    o.rays = 1024;
    o.size = 48;
    o.direct_samples = 64;
    test_radiant_open(scene, &o, &r);
    test_radiant_gather(&r, 128);
    for (uint32_t t = 0; t < r.texels.count; t++) {
        const vec3 p = test_radiant_position(&r, t);
        const uint32_t face = test_radiant_surface(&r, t);
        const float u = face < 2 ? p.y : p.x, v = face < 4 ? p.z : p.y;
        const int quarter = (u > 0.0f ? 1 : 0) + (v > 0.0f ? 2 : 0);
        const double a = (double)r.texels.areas[t];
        sums[face][quarter] += a * (double)r.values[t].mean[0];
        areas[face][quarter] += a;
    }
    const double all = test_radiant_mean(&r, ALPI_NONE, 0, NULL);
    for (int f = 0; f < 6; f++) {
        double face = 0.0, area = 0.0;
        for (int q = 0; q < 4; q++) {
            face += sums[f][q];
            area += areas[f][q];
            // Texels on the middle lines count for one side: of two equal sides they are alike.
            ASSERT_NEAR(sums[f][q] / areas[f][q], all, 3e-2 * all);
        }
        ASSERT_NEAR(face / area, all, 2e-3 * all);
        worst = fmax(worst, fabs(face / area / all - 1.0));
    }
    printf("accuracy: radiosity of a lamp in the middle of a cube: its faces' means are within "
           "%.1e\n",
           worst);
    test_radiant_close(&r);
}
