// SPDX-License-Identifier: MIT
// Each allocation of fields fails once: they say so and give all memory back. Progress cancels
// them.
#include "field_scenes.h"
#include "test_small_bake.h"

/// A call whose allocations fail in turn.
typedef alp_result make_field(const alp_scene *scene, alp_progress_fn *progress);

static alp_result bake(const alp_scene *scene, alp_progress_fn *progress, bool layers)
{
    alp_lamp lamps[2] = {alp_lamp_default(), alp_lamp_default()};
    alp_probe_options o = alp_probe_options_default();
    alp_probes *probes = NULL;
    alp_field *field = NULL;
    lamps[0].intensity = lamps[1].intensity = 0.1f;
    lamps[0].position[0] = lamps[0].position[1] = 0.3f;
    lamps[1].position[0] = lamps[1].position[2] = 0.2f;
    o.lighting.lamps = lamps;
    o.lighting.lamp_count = 2;
    o.spacing = progress != NULL ? 0.02f : 0.3f;
    o.atlas_size = 32;
    o.rays = 384;
    o.layers = layers;
    o.gradients = !layers;
    o.progress = progress;
    const alp_result result = alp_probes_bake(scene, &o, &probes);
    if (result != ALP_OK) {
        assert_null(probes);
        return result;
    }
    const alp_result made = alp_field_create_probes(probes, ALP_LOOKUP_OURS, NULL, NULL, &field);
    assert_true((field != NULL) == (made == ALP_OK));
    alp_field_destroy(field);
    alp_probes_destroy(probes);
    return made;
}

static alp_result bake_layers(const alp_scene *scene, alp_progress_fn *progress)
{
    return bake(scene, progress, true);
}

static alp_result bake_gradients(const alp_scene *scene, alp_progress_fn *progress)
{
    return bake(scene, progress, false);
}

static alp_result fit(const alp_scene *scene, alp_progress_fn *progress)
{
    alp_ambient_options o = alp_ambient_options_default();
    alp_field *field = NULL;
    o.model = ALP_AMBIENT_GROUND_MAP;
    o.points = progress != NULL ? 4096 : 16;
    o.samples = progress != NULL ? 1024 : 16;
    o.progress = progress;
    const alp_result result = alp_field_create_ambient(scene, &o, &field);
    assert_true((field != NULL) == (result == ALP_OK));
    alp_field_destroy(field);
    return result;
}

static alp_result trace(const alp_scene *scene, alp_progress_fn *progress)
{
    enum { COUNT = 4 };
    float positions[COUNT][3], normals[COUNT][3], e[COUNT][3], errors[COUNT][3];
    alp_reference_options o = alp_reference_options_default();
    o.samples = progress != NULL ? 1u << 20 : 16;
    o.progress = progress;
    const alp_result result = alp_scene_free_points(scene, 1, COUNT, positions, normals);
    return result != ALP_OK
               ? result
               : alp_reference_irradiance(scene, &o, COUNT, (const float(*)[3])positions,
                                          (const float(*)[3])normals, e, errors);
}

/// A scene on a context of its own, whose next allocations are counted from 0.
static alp_result run_with(make_field *make, test_memory *memory)
{
    const long failing = memory->failing;
    memory->failing = -1;
    alp_context *context = test_memory_context(memory, 1);
    alp_scene *scene = test_load(context, "builtin:cornell");
    memory->failing = failing;
    atomic_store(&memory->count, 0);
    const alp_result result = make(scene, NULL);
    if (result != ALP_OK) {
        assert_int_equal(result, ALP_ERROR_OUT_OF_MEMORY);
        assert_non_null(strstr(alp_context_message(context), "memory"));
    }
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    assert_int_equal(atomic_load(&memory->live), 0);
    return result;
}

static void fail_each(make_field *make)
{
    test_memory whole = {.failing = -1};
    assert_int_equal(run_with(make, &whole), ALP_OK);
    const long total = atomic_load(&whole.count);
    assert_in_range(total, 4, 6000);
    // Allocations of fields are the last; many of those of the light before them are alike.
    const long last = 120, some = 101;
    for (long i = 0; i < total; i += i + last < total ? some : TEST_STEP) {
        test_memory memory = {.failing = i};
        if (run_with(make, &memory) == ALP_OK) {
            fail_msg("allocation %ld of %ld failed, and nothing noticed", i, total);
        }
    }
    print_message("%ld allocations failed in turn\n", total);
}

TEST(probes_without_memory)
{
    fail_each(bake_layers);
    fail_each(bake_gradients);
}

TEST(ambient_models_without_memory)
{
    fail_each(fit);
}

TEST(references_without_memory)
{
    fail_each(trace);
}

static bool stop(void *user, const alp_progress *progress)
{
    (void)user;
    (void)progress;
    return false;
}

TEST_WITH_CONTEXT(progress_cancels_all, 2)
{
    static make_field *const all[] = {bake_layers, fit, trace};
    alp_scene *scene = test_load(context, "builtin:cornell");
    for (int i = 0; i < 3; i++) {
        assert_int_equal(all[i](scene, stop), ALP_ERROR_CANCELLED);
    }
    alp_scene_destroy(scene);
}

// --- what is refused -----------------------------------------------------------------------------

static void expect(const alp_context *context, alp_result result, alp_result code, const char *word)
{
    assert_int_equal(result, code);
    if (strstr(alp_context_message(context), word) == NULL) {
        fail_msg("no '%s' in: %s", word, alp_context_message(context));
    }
}

TEST_WITH_CONTEXT(options_of_ambient_models_are_refused, 1)
{
    const alp_result invalid = ALP_ERROR_INVALID_ARGUMENT;
    alp_scene *scene = test_load(context, "builtin:furnace");
    alp_scene *unlit = field_room(context, (vec3){1.0f, 1.0f, 1.0f}, 0.5f, 0.0f);
    alp_field *field = NULL;
    alp_ambient_options o = alp_ambient_options_default();
    o.points = 15;
    expect(context, alp_field_create_ambient(scene, &o, &field), invalid, "points");
    o = alp_ambient_options_default();
    o.samples = 65537;
    expect(context, alp_field_create_ambient(scene, &o, &field), invalid, "samples");
    o = alp_ambient_options_default();
    o.model = ALP_AMBIENT_COUNT;
    expect(context, alp_field_create_ambient(scene, &o, &field), invalid, "model");
    o.struct_size = 0;
    expect(context, alp_field_create_ambient(scene, &o, &field), invalid, "_default()");
    expect(context, alp_field_create_ambient(unlit, NULL, &field), invalid, "light");
    assert_int_equal(alp_field_create_ambient(NULL, NULL, &field), invalid);
    alp_scene_destroy(scene);
    alp_scene_destroy(unlit);
}

TEST_WITH_CONTEXT(points_of_the_reference_are_refused, 1)
{
    const alp_result invalid = ALP_ERROR_INVALID_ARGUMENT;
    const float good[2][3] = {{0.5f, 0.5f, 0.5f}, {0.5f, 0.4f, 0.5f}};
    const float bad[2][3] = {{0.5f, 0.5f, 0.5f}, {0.5f, NAN, 0.5f}};
    const float flat[2][3] = {{0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    float e[2][3];
    alp_scene *scene = test_load(context, "builtin:furnace");
    alp_reference_options o = alp_reference_options_default();
    expect(context, alp_reference_irradiance(scene, &o, 2, bad, good, e, NULL), invalid, "point 1");
    expect(context, alp_reference_irradiance(scene, &o, 2, good, bad, e, NULL), invalid, "point 1");
    expect(context, alp_reference_irradiance(scene, &o, 2, good, flat, e, NULL), invalid,
           "point 1");
    o.samples = 0;
    expect(context, alp_reference_irradiance(scene, &o, 2, good, good, e, NULL), invalid,
           "samples");
    o = alp_reference_options_default();
    o.struct_size = 3;
    expect(context, alp_reference_irradiance(scene, &o, 2, good, good, e, NULL), invalid,
           "_default()");
    alp_scene_destroy(scene);
}

/// Normals of any length count as their unit.
TEST_WITH_CONTEXT(normals_of_the_reference_have_any_length, 1)
{
    alp_scene *scene = test_load(context, "builtin:furnace");
    alp_reference_options o = alp_reference_options_default();
    const vec3 p = {0.5f, 0.5f, 0.5f};
    const vec3 unit = field_truth(scene, &o, p, (vec3){0.6f, 0.8f, 0.0f}, NULL);
    const vec3 longer = field_truth(scene, &o, p, (vec3){6.0f, 8.0f, 0.0f}, NULL);
    ASSERT_NEAR(longer.x, unit.x, 1e-5 * (double)unit.x);
    ASSERT_NEAR(unit.x, 2.0 * FIELD_PI, 0.02 * 2.0 * FIELD_PI);
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(free_points_lie_in_free_air, 1)
{
    enum { COUNT = 500 };
    static float p[COUNT][3], n[COUNT][3];
    alpi_builder b;
    alp_scene *scene = NULL;
    vec3 sum = {0.0f, 0.0f, 0.0f};
    const vec3 grey = {0.5f, 0.5f, 0.5f}, none = {0.0f, 0.0f, 0.0f};
    alpi_builder_start(&b, context, "block in a room");
    alpi_builder_surface(&b, "all", alpi_builder_material(&b, "grey", grey, none));
    alpi_builder_box(&b, (vec3){3.0f, 3.0f, 3.0f}, none, ALPI_FACE_ALL);
    alpi_builder_box(&b, (vec3){1.0f, 0.5f, 0.5f}, (vec3){2.5f, 2.5f, 2.5f}, ALPI_FACE_ALL);
    ASSERT_OK(context, alpi_builder_finish(&b, &scene));
    ASSERT_OK(context, alp_scene_free_points(scene, 1, COUNT, p, n));
    for (int i = 0; i < COUNT; i++) {
        assert_false(p[i][0] > 1.01f && p[i][0] < 2.49f && p[i][1] > 0.51f && p[i][1] < 2.49f &&
                     p[i][2] > 0.51f && p[i][2] < 2.49f);
        ASSERT_NEAR(vec3_length(vec3_load(n[i])), 1.0, 1e-5);
        sum = vec3_add(sum, vec3_load(n[i]));
    }
    assert_true(vec3_length(sum) < 0.1f * COUNT); // of all directions
    alp_scene_destroy(scene);
}

TEST_WITH_CONTEXT(free_points_near_lie_in_their_ball, 1)
{
    enum { COUNT = 200 };
    static float p[COUNT][3], n[COUNT][3];
    const float corner[3] = {0.1f, 0.1f, 0.1f}, outside[3] = {9.0f, 0.0f, 0.0f};
    const float broken[3] = {NAN, 0.0f, 0.0f};
    alp_scene *scene = field_room(context, (vec3){3.0f, 3.0f, 3.0f}, 0.5f, 1.0f);
    ASSERT_OK(context, alp_scene_free_points_near(scene, corner, 1.0f, 1, COUNT, p, n));
    for (int i = 0; i < COUNT; i++) {
        const vec3 to = vec3_sub(vec3_load(p[i]), vec3_load(corner));
        assert_true(vec3_length(to) <= 1.0f);
        assert_true(p[i][0] >= -1e-4f && p[i][1] >= -1e-4f && p[i][2] >= -1e-4f);
        ASSERT_NEAR(vec3_length(vec3_load(n[i])), 1.0, 1e-5);
    }
    const alp_result bad = ALP_ERROR_INVALID_ARGUMENT;
    assert_int_equal(alp_scene_free_points_near(scene, outside, 1.0f, 1, COUNT, p, n), bad);
    assert_int_equal(alp_scene_free_points_near(scene, broken, 1.0f, 1, COUNT, p, n), bad);
    assert_int_equal(alp_scene_free_points_near(scene, corner, 0.0f, 1, COUNT, p, n), bad);
    assert_int_equal(alp_scene_free_points_near(scene, corner, NAN, 1, COUNT, p, n), bad);
    alp_scene_destroy(scene);
}
