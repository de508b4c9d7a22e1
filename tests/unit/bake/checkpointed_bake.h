// SPDX-License-Identifier: MIT
// Small bakes of every kind with checkpoints, which can be stopped in the middle of a loop.
#ifndef CHECKPOINTED_BAKE_H
#define CHECKPOINTED_BAKE_H

#include "test_small_bake.h"

/// In place of the name of a scene: a two-sided room with a pane across it.
#define CHECKPOINTED_PANES "panes"

typedef struct checkpointed_kind {
    const char *name;
    const char *scene; // NULL: builtin:cornell
    unsigned maps;
    float accuracy, error; // error: of occlusion, and of light a tenth
    bool ao_self, layers, denoise;
    alp_gather gather;
    alp_direct direct;
    uint32_t bounces, lamps;
    const char *only;
    uint32_t size; // of a page; 0: 32, or 64 with an error
} checkpointed_kind;

typedef struct checkpointed_bake {
    const checkpointed_kind *kind;
    uint32_t workers;
    const char *folder; // of the checkpoint; NULL: none
    double every;
    uint32_t stop_after; // ranges of its loops; 0: never
    uint64_t budget;     // of the context, bytes beside the scene; 0: none
    test_memory *memory; // of the bake, without that of loading; NULL: any
    // Out:
    uint32_t first, ranges; // ranges of loops before rays are traced; all
    uint64_t files;         // fingerprint of all maps as files
    size_t largest;         // bytes of the largest of them
    alp_bake_report report;
    char message[512]; // of a failure
} checkpointed_bake;

/// Loads the scene and bakes. A bake that fails leaves no maps.
/// @return of alp_bake; files and report only if ALP_OK
alp_result checkpointed_run(checkpointed_bake *bake);

#endif
