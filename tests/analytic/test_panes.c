// SPDX-License-Identifier: MIT
// Light through blended and transmissive surfaces, in shadow rays, along paths and to the eye.
#include "test_lit.h"
#include "test_support.h"

#include "scene/builtin/mesh_builder.h"
#include "transport/direct/direct.h"

#include <math.h>

static const double PI = 3.14159265358979323846;
static const vec3 UP = {0.0f, 1.0f, 0.0f}, DARK = {0.0f, 0.0f, 0.0f};

TEST_CONTEXT(2);

/// Adds a horizontal square of half side 50 m, facing up.
static void add_level(alpi_builder *b, float height)
{
    const vec3 corners[4] = {{-50.0f, height, 50.0f},
                             {50.0f, height, 50.0f},
                             {50.0f, height, -50.0f},
                             {-50.0f, height, -50.0f}};
    alpi_builder_quad(b, corners);
}

typedef struct pane_material {
    vec3 color;
    float alpha; // < 0: opaque
    float transmission, metallic;
} pane_material;

static uint32_t add_pane_material(alpi_builder *b, const pane_material *p, vec3 emission)
{
    const uint32_t m = alpi_builder_material(b, "pane", p->color, emission);
    b->scene->materials[m].alpha_mode = p->alpha < 0.0f ? ALPI_ALPHA_OPAQUE : ALPI_ALPHA_BLEND;
    b->scene->materials[m].base_color[3] = p->alpha < 0.0f ? 1.0f : p->alpha;
    b->scene->materials[m].transmission = p->transmission;
    b->scene->materials[m].metallic = p->metallic;
    b->scene->materials[m].double_sided = true;
    return m;
}

/// A black floor at 0 and panes above it at 1, 2, … m.
static alp_scene *make_stack(const pane_material *panes, uint32_t count)
{
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "stack");
    alpi_builder_surface(&b, "floor", alpi_builder_material(&b, "floor", DARK, DARK));
    add_level(&b, 0.0f);
    for (uint32_t i = 0; i < count; i++) {
        alpi_builder_surface(&b, "pane", add_pane_material(&b, &panes[i], DARK));
        add_level(&b, 1.0f + (float)i);
    }
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    return scene;
}

/// (1 − a) lerp(1, c, a) + a t (1 − metallic) c, of one channel.
static double through(const pane_material *p, double color)
{
    const double a = p->alpha < 0.0f ? 1.0 : (double)p->alpha;
    const double t = (double)p->transmission * (1.0 - (double)p->metallic);
    return (1.0 - a) * (1.0 - a + a * color) + a * t * color;
}

static const pane_material PANES[] = {
    {{1.0f, 0.5f, 0.0f}, 0.25f, 0.0f, 0.0f},  // blended
    {{0.2f, 0.9f, 0.4f}, -1.0f, 0.75f, 0.0f}, // transmissive
    {{0.8f, 0.6f, 1.0f}, 0.5f, 0.5f, 0.4f},   // both, with metal
    {{0.3f, 0.3f, 0.3f}, 0.0f, 0.0f, 0.0f},   // not there
};

/// Direct light by the other transport.
static alpi_reference_value direct_at(const test_lit *lit, uint32_t samples, vec3 position)
{
    float positions[1][3], normals[1][3], offsets[1] = {1e-6f};
    vec3_store(positions[0], position);
    vec3_store(normals[0], UP);
    const alpi_point_array array = {.count = 1,
                                    .positions = positions,
                                    .geometric_normals = normals,
                                    .shading_normals = normals,
                                    .offsets = offsets};
    const alpi_receivers receivers = alpi_point_array_receivers(&array);
    const alpi_direct_options options = {.context = context,
                                         .scene = lit->scene,
                                         .tracer = lit->tracer,
                                         .lighting = lit->lighting,
                                         .samples = samples,
                                         .seed = 5};
    alpi_reference_value value = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    alpi_direct_output output = {.values = &value};
    alpi_direct *direct = NULL;
    ASSERT_OK(context, alpi_direct_create(&options, &direct));
    ASSERT_OK(context, alpi_direct_irradiance(direct, &receivers, NULL, 1, NULL, &output));
    alpi_direct_destroy(direct);
    return value;
}

/// Every combination of the first 2^i panes, under a sun without size: nothing is left to chance.
TEST(a_sun_is_filtered_by_every_pane)
{
    for (uint32_t set = 1; set < 16; set++) {
        pane_material some[4];
        uint32_t count = 0;
        double expected[3] = {1000.0, 1000.0, 1000.0};
        for (uint32_t i = 0; i < 4; i++) {
            if ((set >> i & 1u) != 0) {
                some[count++] = PANES[i];
                expected[0] *= through(&PANES[i], (double)PANES[i].color.x);
                expected[1] *= through(&PANES[i], (double)PANES[i].color.y);
                expected[2] *= through(&PANES[i], (double)PANES[i].color.z);
            }
        }
        alp_lighting_options light = alp_lighting_options_default();
        light.sun.elevation = (float)(PI / 2.0);
        light.sun.illuminance = 1000.0f;
        light.sun.size = 0.0f;
        test_lit lit = test_lit_open(make_stack(some, count), &light);
        const alpi_reference r = test_lit_reference(&lit, 0, 16);
        const alpi_reference_value v = test_lit_point(&r, (vec3){0.3f, 0.0f, 0.4f}, UP);
        const alpi_reference_value direct = direct_at(&lit, 16, (vec3){0.3f, 0.0f, 0.4f});
        for (int k = 0; k < 3; k++) {
            ASSERT_NEAR(v.mean[k], expected[k], 1e-5 * expected[k] + 1e-6);
            ASSERT_NEAR(direct.mean[k], expected[k], 1e-5 * expected[k] + 1e-6);
        }
        test_lit_close(&lit);
    }
}

/// A floor in a box of panes under an even sky: E = πL through the panes, by rays that ask the sky
/// and by those that meet it alone.
TEST(a_sky_is_seen_through_panes)
{
    for (uint32_t i = 0; i < 3; i++) {
        alpi_builder b;
        alp_scene *scene = NULL;
        alpi_builder_start(&b, context, "box");
        alpi_builder_surface(&b, "box", add_pane_material(&b, &PANES[i], DARK));
        alpi_builder_box(&b, (vec3){-1.0f, -1.0f, -1.0f}, (vec3){1.0f, 1.0f, 1.0f}, ALPI_FACE_ALL);
        ASSERT_OK(context, alpi_builder_finish(&b, &scene));
        alp_lighting_options light = alp_lighting_options_default();
        light.sky.kind = ALP_SKY_CONSTANT;
        test_lit lit = test_lit_open(scene, &light);
        for (int next_event = 0; next_event < 2; next_event++) {
            alpi_reference r = test_lit_reference(&lit, 0, 1u << 13);
            r.next_event = next_event != 0;
            const alpi_reference_value v = test_lit_point(&r, (vec3){0.1f, 0.0f, 0.2f}, UP);
            const float color[3] = {PANES[i].color.x, PANES[i].color.y, PANES[i].color.z};
            const alpi_reference_value direct = direct_at(&lit, 1u << 12, (vec3){0.1f, 0.0f, 0.2f});
            for (int k = 0; k < 3; k++) {
                const double expected = PI * through(&PANES[i], (double)color[k]);
                ASSERT_NEAR(direct.mean[k], expected,
                            4.0 * sqrt((double)direct.variance[k]) + 1e-5 * expected);
                ASSERT_NEAR(v.mean[k], expected,
                            4.0 * sqrt((double)v.variance[k]) + 1e-5 * expected);
                assert_true(sqrt((double)v.variance[k]) < 0.01 * expected + 1e-6);
            }
        }
        test_lit_close(&lit);
    }
}

/// Nothing changes in a furnace when a clear pane without colour stands in it.
TEST(a_clear_pane_is_not_seen)
{
    const pane_material clear = {{1.0f, 1.0f, 1.0f}, -1.0f, 1.0f, 0.0f};
    const float rho = 0.5f;
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "furnace");
    alpi_builder_surface(
        &b, "walls",
        alpi_builder_material(&b, "walls", (vec3){rho, rho, rho}, (vec3){1.0f, 1.0f, 1.0f}));
    alpi_builder_box(&b, (vec3){1.0f, 1.0f, 1.0f}, DARK, ALPI_FACE_ALL);
    alpi_builder_surface(&b, "pane", add_pane_material(&b, &clear, DARK));
    alpi_builder_box(&b, (vec3){0.2f, 0.2f, 0.2f}, (vec3){0.8f, 0.8f, 0.8f}, ALPI_FACE_ALL);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    test_lit lit = test_lit_open(scene, NULL);
    for (int next_event = 0; next_event < 2; next_event++) {
        alpi_reference r = test_lit_reference(&lit, ALPI_REFERENCE_BOUNCE_LIMIT, 1u << 14);
        r.next_event = next_event != 0;
        const alpi_reference_value v = test_lit_point(&r, (vec3){0.3f, 0.0f, 0.4f}, UP);
        const double exact = PI / (1.0 - (double)rho);
        ASSERT_NEAR(v.mean[1], exact, 4.0 * sqrt((double)v.variance[1]) + 1e-5 * exact);
        assert_true(fabs((double)v.mean[1] / exact - 1.0) < 2e-3);
    }
    test_lit_close(&lit);
}

/// A lit room with a coloured pane across it: asking lights and meeting them agree after any number
/// of bounces, so a pane keeps and passes by the same shares for both.
TEST(both_ways_to_light_agree_behind_panes)
{
    const pane_material tinted = {{0.9f, 0.5f, 0.2f}, 0.6f, 0.5f, 0.0f};
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "room");
    const uint32_t walls = alpi_builder_material(&b, "walls", (vec3){0.7f, 0.7f, 0.7f}, DARK);
    const uint32_t lamp = alpi_builder_material(&b, "lamp", DARK, (vec3){5.0f, 5.0f, 5.0f});
    alpi_builder_surface(&b, "walls", walls);
    alpi_builder_box(&b, (vec3){1.0f, 1.0f, 1.0f}, DARK, ALPI_FACE_ALL & ~(unsigned)ALPI_FACE_TOP);
    alpi_builder_surface(&b, "lamp", lamp);
    alpi_builder_box(&b, (vec3){1.0f, 1.0f, 1.0f}, DARK, ALPI_FACE_TOP);
    alpi_builder_surface(&b, "pane", add_pane_material(&b, &tinted, (vec3){0.5f, 0.0f, 1.0f}));
    alpi_builder_box(&b, (vec3){-0.1f, 0.5f, -0.1f}, (vec3){1.1f, 0.55f, 1.1f},
                     ALPI_FACE_TOP | ALPI_FACE_BOTTOM);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    test_lit lit = test_lit_open(scene, NULL);
    alpi_reference r = test_lit_reference(&lit, 6, 1u << 15);
    const alpi_reference_value with = test_lit_point(&r, (vec3){0.3f, 0.0f, 0.4f}, UP);
    r.next_event = false;
    r.seed = 2;
    r.samples = 1u << 16;
    const alpi_reference_value without = test_lit_point(&r, (vec3){0.3f, 0.0f, 0.4f}, UP);
    for (int k = 0; k < 3; k++) {
        const double error = sqrt((double)with.variance[k] + (double)without.variance[k]);
        ASSERT_NEAR(with.mean[k], without.mean[k], 4.0 * error);
        assert_true(error < 0.01 * (double)with.mean[k]);
    }
    // The lamp fills most of the hemisphere, so that it is met, too, where light is direct alone.
    r = test_lit_reference(&lit, 0, 1u << 15);
    const alpi_reference_value path = test_lit_point(&r, (vec3){0.3f, 0.0f, 0.4f}, UP);
    const alpi_reference_value direct = direct_at(&lit, 1u << 14, (vec3){0.3f, 0.0f, 0.4f});
    for (int k = 0; k < 3; k++) {
        const double error = sqrt((double)path.variance[k] + (double)direct.variance[k]);
        ASSERT_NEAR(path.mean[k], direct.mean[k], 4.0 * error);
        assert_true(error < 0.01 * (double)direct.mean[k]);
    }
    test_lit_close(&lit);
}

static void look_down(const void *user, uint32_t count, const uint64_t *pixels, const float *u,
                      const float *v, const alpi_camera_rays *rays)
{
    (void)user;
    (void)pixels;
    for (uint32_t i = 0; i < count; i++) {
        rays->start[0][i] = 0.1f + 0.01f * u[i];
        rays->start[1][i] = 5.0f;
        rays->start[2][i] = 0.2f + 0.01f * v[i];
        rays->direction[0][i] = rays->direction[2][i] = 0.0f;
        rays->direction[1][i] = -1.0f;
    }
}

/// A mask cuts before anything is transmitted: below its cutoff there is a hole, above it the pane.
TEST(a_mask_cuts_panes)
{
    for (int cut = 0; cut < 2; cut++) {
        alp_scene *scene = make_stack(&PANES[1], 1);
        scene->materials[1].alpha_mode = ALPI_ALPHA_MASK;
        scene->materials[1].alpha_cutoff = 0.5f;
        scene->materials[1].base_color[3] = cut != 0 ? 0.4f : 0.6f;
        alp_lighting_options light = alp_lighting_options_default();
        light.sun.elevation = (float)(PI / 2.0);
        light.sun.illuminance = 10.0f;
        light.sun.size = 0.0f;
        test_lit lit = test_lit_open(scene, &light);
        const alpi_reference r = test_lit_reference(&lit, 0, 16);
        const double expected =
            cut != 0 ? 10.0 : 10.0 * through(&PANES[1], (double)PANES[1].color.y);
        const vec3 at = {0.3f, 0.0f, 0.4f};
        ASSERT_NEAR(test_lit_point(&r, at, UP).mean[1], expected, 1e-5 * expected);
        ASSERT_NEAR(direct_at(&lit, 16, at).mean[1], expected, 1e-5 * expected);
        test_lit_close(&lit);
    }
}

/// Before nothing, a black pane fills as much of a pixel as it takes from what is behind.
TEST(a_pane_covers_what_it_takes)
{
    static const float alphas[] = {0.0f, 0.25f, 1.0f};
    for (int i = 0; i < 3; i++) {
        const pane_material black = {{0.0f, 0.0f, 0.0f}, alphas[i], 0.0f, 0.0f};
        alpi_builder b;
        alp_scene *scene = NULL;
        alpi_builder_start(&b, context, "pane");
        alpi_builder_surface(&b, "pane", add_pane_material(&b, &black, DARK));
        add_level(&b, 1.0f);
        ASSERT_OK(context, alpi_builder_finish(&b, &scene));
        test_lit lit = test_lit_open(scene, NULL);
        const alpi_reference r = test_lit_reference(&lit, 0, 256);
        alpi_reference_value v;
        float covered = -1.0f;
        ASSERT_OK(context, alpi_reference_pixels(&r, look_down, NULL, 0, 1, &v, &covered));
        ASSERT_NEAR(covered, 1.0 - through(&black, 0.0), 1e-6);
        test_lit_close(&lit);
    }
}

/// A glowing pane over a lamp, seen from above: L = a Le of the pane + what it lets through of the
/// lamp's.
TEST(the_eye_sees_through_panes)
{
    const pane_material pane = {{1.0f, 0.5f, 0.25f}, 0.25f, 0.0f, 0.0f};
    alpi_builder b;
    alp_scene *scene = NULL;
    alpi_builder_start(&b, context, "lamp");
    const uint32_t lamp = alpi_builder_material(&b, "lamp", DARK, (vec3){3.0f, 3.0f, 3.0f});
    alpi_builder_surface(&b, "lamp", lamp);
    add_level(&b, 0.0f);
    alpi_builder_surface(&b, "pane", add_pane_material(&b, &pane, (vec3){1.0f, 2.0f, 4.0f}));
    add_level(&b, 1.0f);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    test_lit lit = test_lit_open(scene, NULL);
    const alpi_reference r = test_lit_reference(&lit, 0, 1u << 14);
    alpi_reference_value v;
    float covered = 0.0f;
    ASSERT_OK(context, alpi_reference_pixels(&r, look_down, NULL, 0, 1, &v, &covered));
    const double glow[3] = {1.0, 2.0, 4.0}, color[3] = {1.0, 0.5, 0.25};
    for (int k = 0; k < 3; k++) {
        const double expected = 0.25 * glow[k] + 3.0 * through(&pane, color[k]);
        ASSERT_NEAR(v.mean[k], expected, 4.0 * sqrt((double)v.variance[k]) + 1e-5 * expected);
        assert_true(fabs((double)v.mean[k] / expected - 1.0) < 0.02);
    }
    ASSERT_NEAR(covered, 1.0, 0.0);
    test_lit_close(&lit);
}
