// SPDX-License-Identifier: MIT
// Made-up volumes of probes, whose values are known for every probe and are exact half floats.
#ifndef TEST_VOLUME_H
#define TEST_VOLUME_H

#include "test_support.h"

#include "scene/probe_volume.h"

typedef struct test_volume_options {
    uint32_t size[3]; // of a lattice; a list has size[0] probes
    bool is_list;
    alpi_probe_basis basis;
    uint32_t layers;
    bool gradients, moments;
    float times; // coefficients are multiplied by this power of two; 0: by 1
} test_volume_options;

/// Destroyed by the caller. Fails the test where memory is short.
alpi_probe_volume test_volume(alp_context *context, test_volume_options options);

/// Coefficient k (of 3 C) of a probe: a multiple of 1/64 in (-8, 8). `set` is 0 for the light, then
/// counts layers and gradients.
float test_volume_value(uint32_t probe, uint32_t set, uint32_t k);

/// Fails the test unless both hold the same, in all bits.
void test_volume_same(const alpi_probe_volume *a, const alpi_probe_volume *b);

#endif
