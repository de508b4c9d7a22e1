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

/// Pieces of one triangle, each a mesh of its own, in a lattice of 0.1 m; a third of them are
/// alike, the others get thinner with their number.
static alp_result make_pieces(alp_context *context, uint32_t count, alp_scene **scene)
{
    float(*positions)[3][3] = bench_allocate(count, sizeof *positions);
    alp_mesh *meshes = bench_allocate(count, sizeof *meshes);
    static const uint32_t corners[3] = {0, 1, 2};
    const uint32_t side = (uint32_t)ceil(cbrt(count));
    for (uint32_t i = 0; i < count; i++) {
        const float thin = i % 3 == 0 ? 1.0f : 1.0f / (float)(1 + i % 1000);
        const uint32_t row = i / side, layer = row / side;
        const float at[3] = {0.1f * (float)(i % side), 0.1f * (float)(row % side),
                             0.1f * (float)layer};
        for (int k = 0; k < 3; k++) {
            positions[i][k][0] = at[0] + (k == 1 ? 0.05f : 0.0f);
            positions[i][k][1] = at[1] + (k == 2 ? 0.05f * thin : 0.0f);
            positions[i][k][2] = at[2] + (k == 2 ? 0.01f : 0.0f);
        }
        meshes[i] = (alp_mesh){.name = "piece",
                               .vertex_count = 3,
                               .positions = positions[i][0],
                               .triangle_count = 1,
                               .indices = corners,
                               .base_color = {0.5f, 0.5f, 0.5f}};
    }
    const alp_result result = alp_scene_create_from_meshes(context, meshes, count, scene);
    free(meshes);
    free(positions);
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
    static const char hills[] = "hills:", pieces[] = "pieces:";
    *scene = (bench_scene){.name = name};
    alp_context_options options = alp_context_options_default();
    options.worker_count = workers;
    alp_result result = alp_context_create(&options, &scene->context);
    if (result == ALP_OK && strncmp(name, hills, sizeof hills - 1) == 0) {
        const uint32_t triangles = (uint32_t)strtoul(name + sizeof hills - 1, NULL, 10);
        result = make_hills(scene->context, triangles, &scene->scene);
    } else if (result == ALP_OK && strncmp(name, pieces, sizeof pieces - 1) == 0) {
        const uint32_t count = (uint32_t)strtoul(name + sizeof pieces - 1, NULL, 10);
        result = make_pieces(scene->context, count, &scene->scene);
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

uint32_t bench_pick_texels(const uint32_t *order, uint32_t count, uint32_t wanted, uint32_t run,
                           uint32_t **list)
{
    const uint32_t run_count = wanted < count && wanted > run ? wanted / run : 1;
    const uint32_t each = wanted < count ? (run < wanted ? run : wanted) : count;
    uint32_t picked = 0;
    *list = bench_allocate((size_t)run_count * each, sizeof **list);
    for (uint32_t r = 0; r < run_count; r++) {
        const uint32_t first =
            (uint32_t)((double)r * count / run_count) / ALPI_PACKET * ALPI_PACKET;
        for (uint32_t i = 0; i < each && first + i < count; i++) {
            (*list)[picked++] = order[first + i];
        }
    }
    return picked / ALPI_PACKET * ALPI_PACKET;
}
