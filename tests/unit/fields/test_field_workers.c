// SPDX-License-Identifier: MIT
// Fields give the same bits for any number of workers, and are read by many threads at once without
// allocations.
#include "field_scenes.h"
#include "test_small_bake.h"

#include "fields/probes/probes.h"

#include <pthread.h>

enum { POINTS = 64 };

/// All numbers of a bake, and of fields at points.
typedef struct field_bits {
    float coefficients[64][27], layers[64][27], gradients[64][81], moments[64][128], moves[64][3];
    uint8_t states[64];
    float error, interpolation, mean;
    float probes[POINTS][3], ambient[POINTS][3], reference[POINTS][3], deviations[POINTS][3];
    float positions[POINTS][3], normals[POINTS][3];
} field_bits;

static void read_bits(const alp_probes *probes, field_bits *bits)
{
    const alpi_probe_volume *v = &probes->volume;
    assert_int_equal(v->count, 64);
    memcpy(bits->coefficients, v->coefficients, sizeof bits->coefficients);
    memcpy(bits->gradients, v->gradients, sizeof bits->gradients);
    memcpy(bits->moments, v->moments, sizeof bits->moments);
    memcpy(bits->moves, v->moves, sizeof bits->moves);
    memcpy(bits->states, v->states, sizeof bits->states);
    bits->error = v->relative_error;
    bits->interpolation = v->interpolation;
    bits->mean = v->mean;
}

static void make(uint32_t workers, const void *what, void *bytes)
{
    (void)what;
    field_bits *bits = bytes;
    alp_context *context = test_context(workers);
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_lamp lamp = alp_lamp_default();
    alp_probe_options o = alp_probe_options_default();
    alp_ambient_options a = alp_ambient_options_default();
    alp_reference_options r = alp_reference_options_default();
    alp_probes *probes = NULL;
    alp_field *field = NULL;
    lamp.intensity = 0.1f;
    lamp.position[0] = lamp.position[1] = lamp.position[2] = 0.3f;
    o.lighting.lamps = a.lighting.lamps = r.lighting.lamps = &lamp;
    o.lighting.lamp_count = a.lighting.lamp_count = r.lighting.lamp_count = 1;
    o.spacing = 0.14f; // 4 x 4 x 4, some of them in the blocks
    o.atlas_size = 32;
    o.rays = 384;
    o.layers = true;
    a.model = ALP_AMBIENT_GROUND_MAP;
    a.points = 32;
    r.samples = a.samples = 16;
    ASSERT_OK(context, alp_scene_free_points(scene, 3, POINTS, bits->positions, bits->normals));
    const float(*p)[3] = (const float(*)[3])bits->positions;
    const float(*n)[3] = (const float(*)[3])bits->normals;
    ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
    memcpy(bits->layers, probes->volume.layers[0].coefficients, sizeof bits->layers);
    alp_probes_destroy(probes);
    o.layers = false;
    o.gradients = true;
    ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
    read_bits(probes, bits);
    ASSERT_OK(context, alp_field_create_probes(probes, ALP_LOOKUP_OURS, NULL, NULL, &field));
    alp_field_irradiance(field, POINTS, p, n, bits->probes);
    alp_field_destroy(field);
    ASSERT_OK(context, alp_field_create_ambient(scene, &a, &field));
    alp_field_irradiance(field, POINTS, p, n, bits->ambient);
    alp_field_destroy(field);
    ASSERT_OK(context,
              alp_reference_irradiance(scene, &r, POINTS, p, n, bits->reference, bits->deviations));
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

TEST(workers_change_no_bit)
{
    field_bits *bits = test_any_workers(make, NULL, sizeof *bits);
    float sums[3] = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < POINTS; i++) {
        sums[0] += bits->probes[i][0];
        sums[1] += bits->ambient[i][0];
        sums[2] += bits->reference[i][0];
    }
    assert_true(sums[0] > 0.0f && sums[1] > 0.0f && sums[2] > 0.0f);
    free(bits);
}

// --- threads -------------------------------------------------------------------------------------

enum { THREADS = 8, READS = 4096 };

typedef struct reader {
    pthread_t thread;
    const alp_field *field;
    float (*irradiance)[3];
} reader;

static void *read_all(void *user)
{
    static const float zero[3] = {0.0f, 0.0f, 0.0f};
    const reader *r = user;
    for (uint32_t i = 0; i < READS; i++) {
        const float p[3] = {0.6f * (float)(i % 64) / 64.0f, 0.5f * (float)(i / 64) / 64.0f, 0.2f};
        const float n[3] = {0.6f, i % 2 != 0 ? 0.8f : -0.8f, zero[0]};
        alp_field_irradiance(r->field, 1, &p, &n, &r->irradiance[i]);
    }
    return NULL;
}

static void read_by_threads(const alp_field *field)
{
    reader readers[THREADS];
    for (int i = 0; i < THREADS; i++) {
        readers[i].field = field;
        readers[i].irradiance = calloc(READS, sizeof *readers[i].irradiance);
        assert_non_null(readers[i].irradiance);
        assert_int_equal(pthread_create(&readers[i].thread, NULL, read_all, &readers[i]), 0);
    }
    for (int i = 0; i < THREADS; i++) {
        pthread_join(readers[i].thread, NULL);
        assert_memory_equal(readers[i].irradiance, readers[0].irradiance,
                            READS * sizeof *readers[i].irradiance);
    }
    for (int i = 0; i < THREADS; i++) {
        free(readers[i].irradiance);
    }
}

TEST(threads_read_at_once_without_allocations)
{
    static const float places[][3] = {{0.1f, 0.1f, 0.3f}, {0.4f, 0.3f, 0.3f}};
    test_memory memory = {.failing = -1};
    alp_context *context = test_memory_context(&memory, 2);
    alp_scene *scene = test_load(context, "builtin:cornell");
    alp_probe_options o = alp_probe_options_default();
    alp_ambient_options a = alp_ambient_options_default();
    alp_probes *probes = NULL, *list = NULL;
    alp_field *fields[4] = {NULL};
    o.spacing = 0.14f;
    o.atlas_size = 64;
    o.rays = 384;
    a.points = 32;
    a.samples = 16;
    ASSERT_OK(context, alp_probes_bake(scene, &o, &probes));
    o.positions = places;
    o.position_count = 2;
    ASSERT_OK(context, alp_probes_bake(scene, &o, &list));
    ASSERT_OK(context, alp_field_create_probes(probes, ALP_LOOKUP_OURS, NULL, NULL, &fields[0]));
    ASSERT_OK(context, alp_field_create_probes(probes, ALP_LOOKUP_THREE, NULL, NULL, &fields[1]));
    ASSERT_OK(context, alp_field_create_probes(list, ALP_LOOKUP_OURS, NULL, NULL, &fields[2]));
    ASSERT_OK(context, alp_field_create_ambient(scene, &a, &fields[3]));
    const long count = atomic_load(&memory.count);
    for (int i = 0; i < 4; i++) {
        read_by_threads(fields[i]);
    }
    assert_int_equal(atomic_load(&memory.count), count);
    for (int i = 0; i < 4; i++) {
        alp_field_destroy(fields[i]);
    }
    alp_probes_destroy(list);
    alp_probes_destroy(probes);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    assert_int_equal(atomic_load(&memory.live), 0);
}
