// SPDX-License-Identifier: MIT
// Pooled variances: the mean over the traced texels of 3 × 3.
#include "base/context.h"
#include "base/random.h"
#include "maps/texels/pooled_variance.h"
#include "test_scenes.h"

#include <stdlib.h>

enum { SIZE = 96 };

typedef struct pool_setup {
    alp_context *context;
    alp_scene *scene;
    alp_atlas *atlas;
    alpi_texels texels;
    alpi_lattice lattice;
    alpi_reference_value *values, *expected; // [texels]
} pool_setup;

/// Two squares that fill a page each. Two texels in three are traced.
static void set_up(uint32_t workers, pool_setup *s)
{
    *s = (pool_setup){.context = test_context(workers)};
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0, 0, 0}, (double[]){0, 0, 1}, (double[]){1, 0, 0});
    test_mesh_quad(mesh, (double[]){3, 0, 0}, (double[]){0, 0, 1}, (double[]){1, 0, 0});
    s->scene = test_mesh_scene(s->context, mesh, 1);
    alp_atlas_options options = alp_atlas_options_default();
    options.size = SIZE;
    options.texels_per_metre = SIZE;
    options.padding = 0;
    ASSERT_OK(s->context, alp_atlas_create(s->scene, &options, &s->atlas));
    ASSERT_OK(s->context, alpi_texels_create(s->atlas, &s->texels));
    ASSERT_OK(s->context, alpi_lattice_create(s->atlas, &s->texels, &s->lattice));
    assert_int_equal(s->texels.count, 2 * SIZE * SIZE);
    s->values = calloc(s->texels.count, sizeof *s->values);
    s->expected = calloc(s->texels.count, sizeof *s->expected);
    assert_true(s->values != NULL && s->expected != NULL);
    for (uint32_t t = 0; t < s->texels.count; t++) {
        const uint32_t random = alpi_hash32(t);
        s->lattice.states[t] = random % 3 != 0   ? ALPI_TEXEL_TRACED
                               : random % 2 != 0 ? ALPI_TEXEL_INTERPOLATED
                                                 : ALPI_TEXEL_OPEN;
        for (uint32_t k = 0; k < 3; k++) {
            s->values[t].mean[k] = 1.0f;
            s->values[t].variance[k] = alpi_unit_float(alpi_hash32(3 * t + k));
        }
    }
}

static void tear_down(pool_setup *s)
{
    free(s->values);
    free(s->expected);
    alpi_lattice_destroy(&s->lattice);
    alpi_texels_destroy(s->context, &s->texels);
    alp_atlas_destroy(s->atlas);
    alp_scene_destroy(s->scene);
    alp_context_destroy(s->context);
}

/// From variances that stay as they are.
static void pool_all(const pool_setup *s)
{
    for (uint32_t t = 0; t < s->texels.count; t++) {
        s->expected[t] = s->values[t];
        if (s->lattice.states[t] != ALPI_TEXEL_TRACED) {
            continue;
        }
        uint32_t around[ALPI_NEIGHBOUR_LIMIT + 1];
        uint32_t count = alpi_lattice_traced_around(&s->lattice, t, around);
        around[count++] = t;
        for (int k = 0; k < 3; k++) {
            float sum = 0.0f;
            for (uint32_t i = 0; i < count; i++) {
                sum += s->values[around[i]].variance[k];
            }
            s->expected[t].variance[k] = sum / (float)count;
        }
    }
}

TEST(each_variance_is_the_mean_around_it)
{
    for (uint32_t workers = 1; workers <= 3; workers += 2) {
        pool_setup s;
        set_up(workers, &s);
        pool_all(&s);
        ASSERT_OK(s.context, alpi_pool_variances(&s.lattice, s.values));
        assert_memory_equal(s.values, s.expected, s.texels.count * sizeof *s.values);
        tear_down(&s);
    }
}

/// Nothing is pooled of a map without texels that were traced; an even map stays even.
TEST(what_is_even_stays)
{
    pool_setup s;
    set_up(2, &s);
    for (uint32_t t = 0; t < s.texels.count; t++) {
        for (int k = 0; k < 3; k++) {
            s.values[t].variance[k] = s.expected[t].variance[k] = 0.25f; // sums of it are exact
            s.expected[t].mean[k] = 1.0f;
        }
    }
    ASSERT_OK(s.context, alpi_pool_variances(&s.lattice, s.values));
    assert_memory_equal(s.values, s.expected, s.texels.count * sizeof *s.values);
    tear_down(&s);
}
