// SPDX-License-Identifier: MIT
// Texels inside other geometry are found stratum by stratum, and lifts that would pass through
// something are not made.
#include "atlas/facet.h"
#include "base/context.h"
#include "maps/validity.h"
#include "test_scenes.h"

#include <math.h>

enum { SIZE = 16 };

typedef struct validity_setup {
    alp_context *context;
    alp_scene *scene;
    alp_atlas *atlas;
    alpi_texels texels;
    alpi_receivers receivers;
    alpi_lattice lattice;
    alpi_occlusion_setup setup;
    alpi_validity validity;
} validity_setup;

/// Looks at all texels of a scene at SIZE texels per metre.
static void look(validity_setup *s, alp_scene *scene, alp_context *context)
{
    *s = (validity_setup){.context = context, .scene = scene};
    alp_atlas_options atlas = alp_atlas_options_default();
    atlas.size = 128;
    atlas.texels_per_metre = SIZE;
    ASSERT_OK(context, alp_atlas_create(scene, &atlas, &s->atlas));
    ASSERT_OK(context, alpi_texels_create(s->atlas, &s->texels));
    ASSERT_OK(context, alpi_lattice_create(s->atlas, &s->texels, &s->lattice));
    s->receivers = alpi_texels_receivers(&s->texels);
    alpi_tracer *tracer = NULL;
    ASSERT_OK(context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    const alp_occlusion_options options = alp_occlusion_options_default();
    ASSERT_OK(context, alpi_occlusion_prepare(scene, tracer, &options, &s->setup));
    ASSERT_OK(context, alpi_validity_create(&s->setup, &s->receivers, &s->texels, &s->lattice,
                                            s->lattice.order, s->texels.count, NULL, &s->validity));
}

static void end(validity_setup *s)
{
    alpi_validity_destroy(&s->validity);
    alpi_occlusion_release(&s->setup);
    alpi_lattice_destroy(&s->lattice);
    alpi_texels_destroy(s->context, &s->texels);
    alp_atlas_destroy(s->atlas);
    alp_scene_destroy(s->scene);
    alp_context_destroy(s->context);
}

/// A floor of 2 × 2 m and a closed box that stands on it, its sides at odd parts of texels.
static test_mesh *box_on_floor(void)
{
    const double a = 0.52, b = 1.4, h = 0.5; // 8.32 and 22.4 texels
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0, 0, 0}, (double[]){0, 0, 2}, (double[]){2, 0, 0});
    test_mesh_quad(mesh, (double[]){a, h, a}, (double[]){0, 0, b - a}, (double[]){b - a, 0, 0});
    test_mesh_quad(mesh, (double[]){a, 0, a}, (double[]){0, h, 0}, (double[]){b - a, 0, 0});
    test_mesh_quad(mesh, (double[]){a, 0, b}, (double[]){b - a, 0, 0}, (double[]){0, h, 0});
    test_mesh_quad(mesh, (double[]){a, 0, a}, (double[]){0, 0, b - a}, (double[]){0, h, 0});
    test_mesh_quad(mesh, (double[]){b, 0, a}, (double[]){0, h, 0}, (double[]){0, 0, b - a});
    return mesh;
}

static bool is_under_box(vec3 p)
{
    return p.x > 0.52f && p.x < 1.4f && p.z > 0.52f && p.z < 1.4f;
}

static void strata_under_a_box_are_left_out(void **state)
{
    (void)state;
    alp_context *context = test_context(2);
    validity_setup s;
    look(&s, test_mesh_scene(context, box_on_floor(), 0), context);
    assert_non_null(s.texels.valid);
    uint32_t mixed = 0, dropped = 0;
    for (uint32_t t = 0; t < s.texels.count; t++) {
        if (s.texels.triangles[t] > 1) {
            continue; // of the box
        }
        uint16_t *mask = s.texels.valid;
        const uint16_t valid = mask[t];
        s.texels.valid = NULL; // so that the square is the whole texel
        int inside = 0, wrong = 0;
        for (int i = 0; i < 16; i++) {
            const float square[1][2] = {
                {((float)(i % 4) + 0.5f) / 4.0f, ((float)(i / 4) + 0.5f) / 4.0f}};
            alpi_receiver_point p;
            s.receivers.place(s.receivers.user, t, 1, square, &p);
            const bool under = is_under_box(p.position);
            inside += under;
            wrong += valid != 0 && ((valid >> i & 1) == 0) != under;
        }
        s.texels.valid = mask;
        if (inside > 0 && inside < 16) {
            assert_int_equal(wrong, 0);
            assert_true(valid != 0);
            mixed++;
        }
        dropped += s.validity.dropped[t];
        assert_true(!s.validity.dropped[t] || inside == 16);
    }
    assert_true(mixed >= 4 * 13);      // the box is 14.1 texels wide
    assert_int_equal(dropped, 4 * 12); // the rim of the 13 × 13 wholly under it
    assert_int_equal(s.validity.moved_count >= mixed, 1);
    end(&s);
}

static void double_sided_walls_hide_no_inside(void **state)
{
    (void)state;
    alp_context *context = test_context(2);
    validity_setup s;
    look(&s, test_mesh_scene(context, box_on_floor(), 1), context);
    assert_null(s.texels.valid);
    assert_int_equal(s.validity.moved_count + s.validity.dropped_count, 0);
    uint32_t near = 0;
    for (uint32_t t = 0; t < s.texels.count; t++) {
        near += s.validity.near[t];
    }
    assert_true(near > 0 && near < s.texels.count);
    end(&s);
}

static void a_one_sided_wall_has_a_behind(void **state)
{
    (void)state;
    // Seen from +x only, at 8.4 texels: what lies within a texel behind it is left out.
    alp_context *context = test_context(2);
    test_mesh *mesh = test_mesh_start();
    test_mesh_quad(mesh, (double[]){0, 0, 0}, (double[]){0, 0, 2}, (double[]){2, 0, 0});
    test_mesh_quad(mesh, (double[]){0.525, 0, 0}, (double[]){0, 1, 0}, (double[]){0, 0, 2});
    validity_setup s;
    look(&s, test_mesh_scene(context, mesh, 0), context);
    assert_non_null(s.texels.valid);
    for (uint32_t t = 0; t < s.texels.count; t++) {
        alpi_receiver_point middle;
        alpi_texels_point(&s.texels, t, &middle);
        if (s.texels.triangles[t] > 1) {
            continue;
        }
        const float x = middle.position.x * (float)SIZE;
        if (x > 9.0f || x < 6.0f) {
            assert_true(s.texels.valid[t] == 0);
        } else if (x > 8.0f) { // cut by the wall: its part in front stays
            assert_true(s.texels.valid[t] != 0 && s.texels.valid[t] != UINT16_MAX);
        }
    }
    end(&s);
}

static void lifts_end_at_what_they_would_pass(void **state)
{
    (void)state;
    // A coarse ball of smooth normals rests on a floor: between its vertices the smooth surface
    // that they describe is below the floor.
    alp_context *context = test_context(2);
    alp_scene *scene = NULL;
    ASSERT_OK(context, alp_scene_load(context, "builtin:sphere-plane", &scene));
    validity_setup s;
    look(&s, scene, context);
    uint32_t low = 0, lifted = 0;
    for (uint32_t t = 0; t < s.texels.count; t++) {
        low += (s.texels.flags[t] & ALPI_TEXEL_NO_LIFT) != 0;
        lifted += alpi_texels_are_lifted(&s.texels, t);
    }
    assert_true(lifted > 0 && low < lifted);
    for (uint32_t t = 0; t < s.texels.count; t++) {
        const float square[2][2] = {{0.3f, 0.4f}, {0.8f, 0.7f}};
        alpi_receiver_point p[2];
        s.receivers.place(s.receivers.user, t, 2, square, p);
        assert_true(p[0].position.y > -1e-4f && p[1].position.y > -1e-4f);
    }
    end(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strata_under_a_box_are_left_out),
        cmocka_unit_test(double_sided_walls_hide_no_inside),
        cmocka_unit_test(a_one_sided_wall_has_a_behind),
        cmocka_unit_test(lifts_end_at_what_they_would_pass),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
