// SPDX-License-Identifier: MIT
// Scenes of the benches: files, built-in ones, and a field of hills of any number of triangles.
#include "bench.h"

#include "base/tasks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/// A height field of n × n cells over 10 m × 10 m, pushed sideways by its height so that its slopes
/// hang over.
static void fill_hills(uint32_t n, float (*positions)[3], uint32_t (*indices)[3])
{
    for (uint32_t y = 0; y <= n; y++) {
        for (uint32_t x = 0; x <= n; x++) {
            const double u = 10.0 * x / n, v = 10.0 * y / n;
            const double h = sin(2.3 * u) * cos(1.9 * v) + 0.5 * sin(5.1 * u + 1.7 * v) +
                             0.3 * cos(7.7 * v - 2.9 * u);
            float *p = positions[y * (n + 1) + x];
            p[0] = (float)(u + 0.4 * sin(1.3 * h + v));
            p[1] = (float)(0.8 * h);
            p[2] = (float)(v + 0.4 * cos(1.7 * h - u));
        }
    }
    for (uint32_t i = 0; i < n * n; i++) {
        const uint32_t a = i / n * (n + 1) + i % n, b = a + 1, c = a + n + 1, d = c + 1;
        const uint32_t two[2][3] = {{a, c, b}, {b, c, d}};
        memcpy(indices[2 * (size_t)i], two, sizeof two);
    }
}

static alp_result make_hills(alp_context *context, uint32_t triangles, alp_scene **scene)
{
    uint32_t n = (uint32_t)sqrt(0.5 * triangles);
    n = n > 0 ? n : 1;
    const uint32_t vertex_count = (n + 1) * (n + 1);
    float(*positions)[3] = bench_allocate(vertex_count, sizeof *positions);
    uint32_t(*indices)[3] = bench_allocate(2 * (size_t)n * n, sizeof *indices);
    fill_hills(n, positions, indices);
    const alp_mesh mesh = {.name = "hills",
                           .vertex_count = vertex_count,
                           .positions = positions[0],
                           .triangle_count = 2 * n * n,
                           .indices = indices[0],
                           .base_color = {0.5f, 0.5f, 0.5f}};
    alp_result result = alp_scene_create_from_meshes(context, &mesh, 1, scene);
    free(positions);
    free(indices);
    return result;
}

bool bench_good(const bench_scene *scene, alp_result result)
{
    if (result != ALP_OK) {
        const char *text = scene->context != NULL ? alp_context_message(scene->context) : "";
        fprintf(stderr, "alpenglow bench: %s: %s\n", scene->name,
                text[0] != '\0' ? text : alp_result_name(result));
    }
    return result == ALP_OK;
}

bool bench_scene_load(const char *name, uint32_t workers, bench_scene *scene)
{
    static const char hills[] = "hills:";
    *scene = (bench_scene){.name = name};
    alp_context_options options = alp_context_options_default();
    options.worker_count = workers;
    alp_result result = alp_context_create(&options, &scene->context);
    if (result == ALP_OK && strncmp(name, hills, sizeof hills - 1) == 0) {
        const uint32_t triangles = (uint32_t)strtoul(name + sizeof hills - 1, NULL, 10);
        result = make_hills(scene->context, triangles, &scene->scene);
    } else if (result == ALP_OK) {
        result = alp_scene_load(scene->context, name, &scene->scene);
    }
    if (!bench_good(scene, result)) {
        bench_scene_close(scene);
        return false;
    }
    return true;
}

bool bench_scene_open(const char *name, uint32_t workers, bench_scene *scene)
{
    if (!bench_scene_load(name, workers, scene)) {
        return false;
    }
    if (!bench_good(scene, alpi_tracer_for_scene(scene->scene, NULL, NULL, &scene->tracer,
                                                 &scene->build_seconds))) {
        bench_scene_close(scene);
        return false;
    }
    return true;
}

void bench_scene_close(bench_scene *scene)
{
    alp_scene_destroy(scene->scene);
    alp_context_destroy(scene->context);
    *scene = (bench_scene){.name = scene->name};
}

bool bench_scene_exists(const char *name)
{
    alp_context *context = NULL;
    alp_scene *scene = NULL;
    const bool there = alp_context_create(NULL, &context) == ALP_OK &&
                       alp_scene_load(context, name, &scene) == ALP_OK;
    alp_scene_destroy(scene);
    alp_context_destroy(context);
    return there;
}

const char *bench_shared(const char *relative, const char *otherwise)
{
    static char path[1024];
    const char *folder = getenv("ALPENGLOW_SHARED");
    if (folder == NULL || folder[0] == '\0') {
        return otherwise;
    }
    const int length = snprintf(path, sizeof path, "%s/%s", folder, relative);
    return length > 0 && (size_t)length < sizeof path && access(path, R_OK) == 0 ? path : otherwise;
}

/// Looks for texels inside other geometry and near it, as a bake does.
static alp_result look_around(const bench_scene *scene, bench_map *map)
{
    const alp_occlusion_options o = alp_occlusion_options_default();
    const alpi_receivers receivers = alpi_texels_receivers(&map->texels);
    const double started = alpi_seconds();
    alpi_occlusion_setup setup;
    ALP_TRY(alpi_occlusion_prepare(scene->scene, scene->tracer, &o, &setup));
    const alp_result result =
        alpi_validity_create(&setup, &receivers, &map->texels, &map->lattice, map->lattice.order,
                             map->texels.count, NULL, &map->validity);
    alpi_occlusion_release(&setup);
    map->validity_seconds = alpi_seconds() - started;
    return result;
}

bool bench_map_open(const bench_scene *scene, uint32_t size, bench_map *map)
{
    alp_atlas_options options = alp_atlas_options_default();
    options.size = size;
    return bench_map_open_with(scene, &options, map);
}

bool bench_map_open_with(const bench_scene *scene, const alp_atlas_options *options, bench_map *map)
{
    memset(map, 0, sizeof *map);
    const double started = alpi_seconds();
    if (!bench_good(scene, alp_atlas_create(scene->scene, options, &map->atlas))) {
        return false;
    }
    const double made = alpi_seconds();
    map->atlas_seconds = made - started;
    alp_result result = alpi_texels_create(map->atlas, &map->texels);
    map->texel_seconds = alpi_seconds() - made;
    if (result == ALP_OK) {
        result = alpi_lattice_create(map->atlas, &map->texels, &map->lattice);
    }
    if (result == ALP_OK) {
        result = look_around(scene, map);
    }
    if (!bench_good(scene, result)) {
        bench_map_close(scene, map);
        return false;
    }
    return true;
}

void bench_map_close(const bench_scene *scene, bench_map *map)
{
    if (map->validity.context != NULL) {
        alpi_validity_destroy(&map->validity);
    }
    if (map->lattice.context != NULL) {
        alpi_lattice_destroy(&map->lattice);
    }
    alpi_texels_destroy(scene->context, &map->texels);
    alp_atlas_destroy(map->atlas);
    memset(map, 0, sizeof *map);
}
