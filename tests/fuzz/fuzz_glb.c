// SPDX-License-Identifier: MIT
// Fuzz target: GLB. What can be read is written with a map and read again.
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_run run = fuzz_begin(size);
    uint8_t *bytes = fuzz_owned(&run, data, size, 0);
    alp_scene *scene = fuzz_gltf_scene(&run, "absent/fuzz.glb", bytes, size);
    if (scene != NULL) {
        fuzz_write_back(&run, scene, "out.glb");
    }
    alp_scene_destroy(scene);
    fuzz_end(&run);
    return 0;
}
