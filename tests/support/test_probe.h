// SPDX-License-Identifier: MIT
// A stage with a hemicube on it.
#ifndef TEST_PROBE_H
#define TEST_PROBE_H

#include "test_direct_stage.h"

#include "transport/gather/hemicube.h"

typedef struct test_probe {
    test_stage stage;
    alpi_hemicube *cube;
    alpi_hemicube_options options; // emitters and sky count, nothing is reflected, not turned
} test_probe;

/// Takes the scene over.   @param lighting NULL = defaults   @param n resolution
test_probe test_probe_open(alp_context *context, alp_scene *scene,
                           const alp_lighting_options *lighting, uint32_t n);
void test_probe_set_resolution(test_probe *probe, uint32_t n);
void test_probe_close(test_probe *probe);

alpi_receiver_point test_probe_point(vec3 position, vec3 normal);
/// E, channel 0.
double test_probe_gather(const test_probe *probe, const alpi_receiver_point *point,
                         uint64_t receiver);

/// One single-sided quad of radiance 1; a speck of none far below everything where it is NULL.
alp_scene *test_probe_quad(alp_context *context, const vec3 *quad);
/// Default light with this sky.
alp_lighting_options test_sky_of(alp_sky_kind kind);

#endif
