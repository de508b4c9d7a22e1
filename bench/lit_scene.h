// SPDX-License-Identifier: MIT
// A scene with its light solved for: what gatherers of the last bounce look at.
#ifndef BENCH_LIT_SCENE_H
#define BENCH_LIT_SCENE_H

#include "bench.h"

#include "maps/radiosity/radiosity.h"

typedef struct lit_scene {
    bench_scene scene;
    bench_map map;
    alpi_receivers receivers;     // texels of the map
    uint32_t *order, count;       // those that have light of their own
    alpi_lighting *lighting;      // all light
    alpi_lighting *soft, *direct; // it in two, where the sky is gathered with what bounces
    alpi_radiosity solution;
} lit_scene;

/// Makes lighting, map and solution of a scene that is open in `lit`, the rest of which is zero.
/// @return false after a message; lit_scene_close releases what there is
bool lit_scene_make(const alp_lighting_options *lighting, const alp_atlas_options *atlas,
                    lit_scene *lit);
/// Also closes the scene. What is zero is left alone.
void lit_scene_close(lit_scene *lit);

/// The solution once more. @param bounces UINT32_MAX: until nothing is left
alp_result lit_scene_solve(const lit_scene *lit, uint32_t bounces, alpi_radiosity *solution);

#endif
