// SPDX-License-Identifier: MIT
// Fuzz target: glTF text, its buffers and images in data: URIs. What can be read is written with a
// map and read again, the maps that it has are compared with themselves, it is made ready to be
// drawn, and its animations pose it.
#include "fuzz.h"

#include <alpenglow/compare.h>
#include <alpenglow/geometry.h>

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

/// Loads normal maps, which nothing else does, and checks the frames for them.
static void draw(const fuzz_run *run, alp_scene *scene)
{
    const alp_geometry geometry = alp_scene_get_geometry(scene);
    const alp_result result = alp_scene_load_normal_maps(scene);
    fuzz_result(run, result, result == ALP_OK ? scene : NULL);
    float(*tangents)[4] = calloc((size_t)geometry.vertex_count + 1, sizeof *tangents);
    if (tangents == NULL || alp_scene_make_tangents(scene, tangents) != ALP_OK) {
        abort();
    }
    for (uint32_t v = 0; v < geometry.vertex_count; v++) {
        const float *t = tangents[v];
        const float length = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
        if (!(length > 0.999f && length < 1.001f) || (t[3] != 1.0f && t[3] != -1.0f)) {
            fuzz_abort("tangent of vertex %u: %g %g %g %g", v, (double)t[0], (double)t[1],
                       (double)t[2], (double)t[3]);
        }
    }
    free(tangents);
}

/// Poses the scene by its first animations. Its arrays keep their sizes.
static void pose(const fuzz_run *run, const alp_scene *scene)
{
    const alp_scene_info info = alp_scene_get_info(scene);
    for (uint32_t i = 0; i < info.animations && i < 4; i++) {
        alp_scene *posed = NULL;
        const double seconds = 0.5 * alp_scene_get_animation(scene, i).seconds;
        const alp_result result = alp_scene_pose(scene, i, seconds, &posed);
        fuzz_result(run, result, posed);
        const alp_scene_info made = alp_scene_get_info(posed);
        if (posed != NULL && (made.vertices != info.vertices || made.triangles != info.triangles ||
                              made.surfaces != info.surfaces)) {
            abort();
        }
        alp_scene_destroy(posed);
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
        draw(&run, scene);
        pose(&run, scene);
    }
    alp_scene_destroy(scene);
    fuzz_end(&run);
    return 0;
}
