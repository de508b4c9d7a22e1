// SPDX-License-Identifier: MIT
// Which texels a map of bounced light traces: on a square in the dark, where all is smooth, those
// alone that nothing else may stand for.
#include "test_scenes.h"

#include "maps/bounced_map.h"
#include "maps/validity.h"
#include "transport/cosine_rays.h"

enum { SIZE = 32 };

typedef struct setting {
    alp_context *context;
    alp_scene *scene;
    alp_atlas *atlas;
    alpi_texels texels;
    alpi_lattice lattice;
    const alpi_tracer *tracer;
    alpi_reference_value values[SIZE * SIZE];
    uint8_t near[SIZE * SIZE], states[SIZE * SIZE];
} setting;

/// A square that fills a page.
static void set_up(setting *s)
{
    *s = (setting){.context = test_context(2)};
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0, 0, 0}, (double[]){0, 0, 1}, (double[]){1, 0, 0});
    s->scene = test_mesh_scene(s->context, mesh, 1);
    alp_atlas_options options = alp_atlas_options_default();
    options.size = SIZE;
    options.texels_per_metre = SIZE;
    options.padding = 0;
    alpi_tracer *tracer = NULL;
    ASSERT_OK(s->context, alp_atlas_create(s->scene, &options, &s->atlas));
    ASSERT_OK(s->context, alpi_texels_create(s->atlas, &s->texels));
    ASSERT_OK(s->context, alpi_lattice_create(s->atlas, &s->texels, &s->lattice));
    ASSERT_OK(s->context, alpi_tracer_for_scene(s->scene, NULL, NULL, &tracer, NULL));
    s->tracer = tracer;
    assert_int_equal(s->texels.count, SIZE * SIZE);
}

static void tear_down(setting *s)
{
    alpi_lattice_destroy(&s->lattice);
    alpi_texels_destroy(s->context, &s->texels);
    alp_atlas_destroy(s->atlas);
    alp_scene_destroy(s->scene);
    alp_context_destroy(s->context);
}

static void map(setting *s, bool adaptive, bool wide)
{
    const alpi_gather_scene from = {.scene = s->scene, .tracer = s->tracer};
    const alpi_cosine_rays rays = {
        .context = s->context, .samples = 64, .replicates = 4, .seed = 1};
    const alpi_gatherer gatherer = alpi_cosine_rays_gatherer(&rays);
    const alpi_receivers receivers = alpi_texels_receivers(&s->texels);
    const alpi_gather_job gather = {.context = s->context,
                                    .from = &from,
                                    .gatherer = &gatherer,
                                    .receivers = &receivers,
                                    .values = s->values};
    const alpi_bounced_options options = {.gather = &gather,
                                          .order = s->lattice.order,
                                          .count = s->texels.count,
                                          .near = s->near,
                                          .adaptive = adaptive,
                                          .straight = true,
                                          .wide = wide,
                                          .beside = &gatherer};
    alpi_bounced_report report = {0};
    ASSERT_OK(s->context, alpi_bounced_map(&options, &s->lattice, NULL, s->states, &report));
    assert_int_equal(report.traced + report.interpolated, SIZE * SIZE);
}

/// Whether others could stand for a texel if all were known.
static bool has_stencil(setting *s, bool wide, uint32_t texel)
{
    alpi_stencil stencil;
    alpi_lattice l = s->lattice;
    uint8_t known[SIZE * SIZE];
    memset(known, ALPI_TEXEL_TRACED, sizeof known);
    l.states = known;
    l.along_borders = true;
    l.wide = wide;
    return alpi_lattice_stencil(&l, texel, &stencil);
}

static void hold_traced(bool wide)
{
    static const alpi_nearness all[] = {ALPI_FAR, ALPI_NEAR, ALPI_TOUCHING};
    const uint32_t of = wide ? 64 : 16;
    uint32_t traced[3] = {0};
    setting s;
    set_up(&s);
    for (int k = 0; k < 3; k++) {
        memset(s.near, (int)all[k], sizeof s.near);
        map(&s, true, wide);
        for (uint32_t t = 0; t < SIZE * SIZE; t++) {
            const bool coarse = alpi_lattice_is_coarse(s.texels.pixels[t]);
            const bool wanted = !has_stencil(&s, wide, t) || (all[k] == ALPI_TOUCHING && coarse);
            assert_int_equal(s.states[t], wanted ? ALPI_TEXEL_TRACED : ALPI_TEXEL_INTERPOLATED);
            traced[k] += wanted;
        }
    }
    // One of so many, or a quarter, and some of two borders.
    assert_true(traced[0] == traced[1] && traced[0] < SIZE * SIZE / of + 2 * SIZE);
    assert_true(traced[0] >= SIZE * SIZE / of);
    assert_true(traced[2] >= SIZE * SIZE / 4 && traced[2] < SIZE * SIZE / 4 + SIZE);
    map(&s, false, wide);
    for (uint32_t t = 0; t < SIZE * SIZE; t++) {
        assert_int_equal(s.states[t], ALPI_TEXEL_TRACED);
    }
    tear_down(&s);
}

static void touching_texels_are_traced_by_every_second(void **state)
{
    (void)state;
    hold_traced(false);
    hold_traced(true);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(touching_texels_are_traced_by_every_second),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
