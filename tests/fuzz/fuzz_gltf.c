// SPDX-License-Identifier: MIT
// Fuzz target: glTF text, its buffers and images in data: URIs. What can be read is written with a
// map and read again, and the maps that it has are compared with themselves.
#include "fuzz.h"

#include <alpenglow/compare.h>

/// Reads the maps of light, which nothing else does.
static void compare(const fuzz_run *run, const alp_scene *scene)
{
    alp_map_compare_options options = alp_map_compare_options_default();
    alp_map_difference difference;
    options.points = 64;
    options.map = ALP_MAP_LIGHT;
    const alp_result result = alp_scene_compare_maps(scene, scene, &options, &difference);
    fuzz_result(run, result, result == ALP_OK ? scene : NULL);
    if (result == ALP_OK && difference.rmse != 0.0) {
        abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_run run = fuzz_begin(size);
    uint8_t *bytes = fuzz_owned(&run, data, size, 0);
    alp_scene *scene = fuzz_gltf_scene(&run, "absent/fuzz.gltf", bytes, size);
    if (scene != NULL) {
        fuzz_write_back(&run, scene, "out.gltf");
        compare(&run, scene);
    }
    alp_scene_destroy(scene);
    fuzz_end(&run);
    return 0;
}
