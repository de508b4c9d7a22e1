// SPDX-License-Identifier: MIT
// Made-up volumes of probes.
#include "test_volume.h"

#include "base/memory.h"
#include "base/random.h"

#include <stdio.h>

enum { DIRECTIONS = ALPI_PROBE_MOMENT_SIDE * ALPI_PROBE_MOMENT_SIDE };

float test_volume_value(uint32_t probe, uint32_t set, uint32_t k)
{
    const uint64_t bits = alpi_hash64((uint64_t)probe << 32 | set << 16 | k);
    return ((float)(bits % 1023) - 511.0f) / 64.0f;
}

static void fill_set(const alpi_probe_volume *v, float *values, size_t stride, uint32_t set,
                     float times)
{
    for (uint32_t i = 0; i < v->count; i++) {
        for (uint32_t k = 0; k < 3 * v->coefficient_count; k++) {
            values[i * stride + k] = times * test_volume_value(i, set, k);
        }
    }
}

static void fill_sets(alp_context *context, const alpi_probe_volume *v, float times)
{
    const size_t width = (size_t)3 * v->coefficient_count;
    fill_set(v, v->coefficients, width, 0, times);
    for (uint32_t i = 0; i < v->layer_count; i++) {
        v->layers[i].name = alpi_format(context, "lamp \"%u\" ä", i);
        fill_set(v, v->layers[i].coefficients, width, 1 + i, times);
    }
    for (uint32_t axis = 0; axis < 3 && v->gradients != NULL; axis++) {
        fill_set(v, v->gradients + axis * width, 3 * width, 1 + v->layer_count + axis, times);
    }
}

static void fill_probes(const alpi_probe_volume *v)
{
    for (uint32_t i = 0; i < v->count; i++) {
        v->states[i] = (uint8_t)(i % 4);
        for (int k = 0; k < 3; k++) {
            v->moves[i][k] = i % 4 == ALPI_PROBE_MOVED ? 0.125f * (float)(k - 1) : 0.0f;
            if (v->is_list) {
                v->places[i][k] = 0.1f * (float)(i * 3 + (uint32_t)k);
            }
        }
        for (uint32_t d = 0; d < DIRECTIONS && v->moments != NULL; d++) {
            const float mean = (float)(1 + (i + d) % 31) / 32.0f; // of the reach
            v->moments[(size_t)i * DIRECTIONS + d][0] = mean * v->reach;
            v->moments[(size_t)i * DIRECTIONS + d][1] = mean * mean * v->reach * v->reach;
        }
    }
}

alpi_probe_volume test_volume(alp_context *context, test_volume_options options)
{
    alpi_probe_volume v = {.is_list = options.is_list,
                           .basis = options.basis,
                           .layer_count = options.layers,
                           .reach = options.moments ? 4.0f : 0.0f,
                           .direct = options.layers > 0,
                           .scene_hash = 0xfedcba9876543210u,
                           .relative_error = 0.0125f,
                           .rays = 512,
                           .seed = 0xffffffffffffffffu};
    v.count = options.size[0];
    v.size[0] = options.size[0];
    v.size[1] = v.size[2] = 1;
    for (uint32_t k = 0; k < 3 && !options.is_list; k++) {
        v.size[k] = options.size[k];
        v.count = k == 0 ? options.size[0] : v.count * options.size[k];
        v.origin[k] = 0.1 + 1e6 * k;
        v.spacing[k] = 0.3f + 0.25f * (float)k;
    }
    ASSERT_OK(context, alpi_probe_volume_allocate(context, options.gradients, options.moments, &v));
    v.options = alpi_copy_string(context, "{\"rays\": 512, \"spacing\":0.1}");
    assert_non_null(v.options);
    fill_sets(context, &v, options.times > 0.0f ? options.times : 1.0f);
    fill_probes(&v);
    return v;
}

static void same_array(const void *a, const void *b, size_t size)
{
    assert_int_equal(a != NULL, b != NULL);
    if (a != NULL) {
        assert_memory_equal(a, b, size);
    }
}

void test_volume_same(const alpi_probe_volume *a, const alpi_probe_volume *b)
{
    assert_int_equal(a->is_list, b->is_list);
    assert_int_equal(a->count, b->count);
    assert_int_equal(a->basis, b->basis);
    assert_int_equal(a->coefficient_count, b->coefficient_count);
    assert_int_equal(a->layer_count, b->layer_count);
    assert_memory_equal(a->size, b->size, sizeof a->size);
    assert_memory_equal(a->origin, b->origin, sizeof a->origin);
    assert_memory_equal(a->spacing, b->spacing, sizeof a->spacing);
    const size_t values = sizeof(float) * 3 * a->coefficient_count * a->count;
    same_array(a->coefficients, b->coefficients, values);
    same_array(a->gradients, b->gradients, 3 * values);
    same_array(a->places, b->places, sizeof(float[3]) * a->count);
    same_array(a->moves, b->moves, sizeof(float[3]) * a->count);
    same_array(a->states, b->states, a->count);
    same_array(a->moments, b->moments, sizeof(float[2]) * DIRECTIONS * a->count);
    for (uint32_t i = 0; i < a->layer_count; i++) {
        assert_string_equal(a->layers[i].name, b->layers[i].name);
        same_array(a->layers[i].coefficients, b->layers[i].coefficients, values);
    }
    assert_true(a->reach == b->reach && a->direct == b->direct && a->rays == b->rays);
    assert_true(a->relative_error == b->relative_error && a->seed == b->seed);
    assert_true(a->scene_hash == b->scene_hash);
    assert_string_equal(a->options, b->options);
}
