// SPDX-License-Identifier: MIT
// write_blend FOLDER: bakes a sphere on a plane with overlapping charts, writes it there, and
// writes down what pixels of a picture must be: what the map gives, blended by the normal, where
// the pixel's ray ends. Once as it is (blend), and once without normals and with all four sets that
// viewers know taken (full).
#include "test_support.h"

#include "atlas/atlas.h"
#include "maps/lightmap.h"
#include "trace/trace.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 160 };

static const double EYE[3] = {1.5, 2.0, 3.0};

static void check(alp_context *context, alp_result result)
{
    if (result != ALP_OK) {
        fprintf(stderr, "%s\n", alp_context_message(context));
        exit(1);
    }
}

// --- a file whose objects stand askew ------------------------------------------------------------

/// Turns every node that shows a mesh by a rotation of its own, in the text of a .gltf.
static void turn_nodes(const char *path)
{
    static const double turns[2][4] = {{0, 0, 0, 1}, {0.18, 0.28, 0.1, 0.0}};
    json_t *root = json_load_file(path, 0, NULL);
    json_t *nodes = json_object_get(root, "nodes");
    for (size_t i = 0; i < json_array_size(nodes); i++) {
        json_t *node = json_array_get(nodes, i);
        if (json_object_get(node, "mesh") != NULL) {
            const double *q = turns[i % 2];
            const double w = sqrt(1.0 - q[0] * q[0] - q[1] * q[1] - q[2] * q[2]);
            json_object_set_new(node, "rotation",
                                json_pack("[f,f,f,f]", q[0], q[1], q[2], i % 2 == 0 ? q[3] : w));
        }
    }
    if (root == NULL || json_dump_file(root, path, 0) != 0) {
        fprintf(stderr, "%s: could not be turned\n", path);
        exit(1);
    }
    json_decref(root);
}

/// Takes the normals of all meshes, and gives them four coordinate sets, which are the same.
static void fill_sets(const char *path)
{
    json_t *root = json_load_file(path, 0, NULL);
    json_t *meshes = json_object_get(root, "meshes");
    for (size_t i = 0; i < json_array_size(meshes); i++) {
        json_t *primitives = json_object_get(json_array_get(meshes, i), "primitives");
        for (size_t k = 0; k < json_array_size(primitives); k++) {
            json_t *attributes = json_object_get(json_array_get(primitives, k), "attributes");
            json_t *set = json_object_get(attributes, "TEXCOORD_0");
            json_object_del(attributes, "NORMAL");
            json_object_set(attributes, "TEXCOORD_1", set);
            json_object_set(attributes, "TEXCOORD_2", set);
            json_object_set(attributes, "TEXCOORD_3", set);
        }
    }
    if (root == NULL || json_dump_file(root, path, 0) != 0) {
        fprintf(stderr, "%s: its sets could not be filled\n", path);
        exit(1);
    }
    json_decref(root);
}

static alp_scene *make_scene(alp_context *context, const char *folder, bool full)
{
    const char *path = test_path(folder, full ? "full.gltf" : "askew.gltf");
    alp_scene *scene = NULL;
    alp_bake_options options = alp_bake_options_default();
    options.atlas.size = 16;
    options.occlusion.samples = 8;
    options.output = path;
    check(context, alp_scene_load(context, "builtin:sphere-plane", &scene));
    check(context, alp_bake(scene, &options, NULL, NULL));
    alp_scene_destroy(scene);
    turn_nodes(path);
    if (full) {
        fill_sets(path);
    }
    check(context, alp_scene_load(context, path, &scene));
    return scene;
}

// --- what the pixels are -------------------------------------------------------------------------

typedef struct view {
    uint32_t triangle; // ALPI_NONE: nothing
    float b1, b2;
} view;

/// Through a point of the picture, in pixels, of a camera at EYE that looks at (0, .5, 0), 40°
/// high.
static view look(const alpi_tracer *tracer, double x, double y)
{
    const double half = tan(20.0 * ALPI_PI / 180.0);
    const vec3 eye = {(float)EYE[0], (float)EYE[1], (float)EYE[2]};
    const vec3 forward =
        vec3_normalize_or(vec3_sub((vec3){0.0f, 0.5f, 0.0f}, eye), (vec3){0.0f, 0.0f, 0.0f});
    const vec3 right =
        vec3_normalize_or(vec3_cross(forward, (vec3){0.0f, 1.0f, 0.0f}), (vec3){0.0f, 0.0f, 0.0f});
    const vec3 up = vec3_cross(right, forward);
    const vec3 aside = vec3_mad(forward, (float)(half * (x * 2 / SIDE - 1)), right);
    const vec3 direction = vec3_mad(aside, (float)(half * (1 - y * 2 / SIDE)), up);
    alpi_rays rays;
    alpi_hits hits;
    alpi_rays_clear(&rays);
    alpi_rays_set(&rays, 0, eye, vec3_normalize_or(direction, forward), 100.0f);
    hits.triangle[0] = ALPI_NONE;
    alpi_trace_nearest(tracer, &rays, 1, (alpi_trace_filter){0}, &hits);
    return (view){hits.triangle[0], hits.b1[0], hits.b2[0]};
}

static double value_at(const alp_lightmap *lightmap, const view *at)
{
    float rgb[3];
    alpi_lightmap_sample(lightmap, at->triangle, at->b1, at->b2, rgb);
    return (double)rgb[0];
}

/// How much the map changes over the 1/16 pixel to which a rasteriser snaps vertices (OpenGL
/// ES 3.0, 2.12.1); −1 where not all of the pixel's surroundings show the same surface.
static double find_drift(const alp_lightmap *lightmap, const alpi_tracer *tracer, int x, int y)
{
    const alp_scene *scene = lightmap->scene;
    const view middle = look(tracer, x + 0.5, y + 0.5);
    double drift = middle.triangle == ALPI_NONE ? -1.0 : 0.0;
    for (int i = 0; i < 8 && drift >= 0.0; i++) {
        const double step = i < 4 ? 1.0 / 16 : 1.0; // the outer four: only what is there
        const view at =
            look(tracer, x + 0.5 + (i & 1 ? step : -step), y + 0.5 + (i & 2 ? step : -step));
        if (at.triangle == ALPI_NONE ||
            scene->triangle_surface[at.triangle] != scene->triangle_surface[middle.triangle]) {
            return -1.0;
        }
        if (i < 4) {
            drift = fmax(drift, fabs(value_at(lightmap, &at) - value_at(lightmap, &middle)));
        }
    }
    return drift;
}

static void write_pixels(const alp_lightmap *lightmap, const alpi_tracer *tracer, const char *path)
{
    json_t *pixels = json_array();
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double drift = find_drift(lightmap, tracer, i % SIDE, i / SIDE);
        if (drift >= 0.0) {
            const view at = look(tracer, i % SIDE + 0.5, i / SIDE + 0.5);
            json_array_append_new(pixels,
                                  json_pack("{s:i,s:i,s:f,s:f}", "x", i % SIDE, "y", i / SIDE,
                                            "value", value_at(lightmap, &at), "drift", drift));
        }
    }
    json_t *camera =
        json_pack("{s:f,s:[f,f,f],s:[f,f,f],s:[f,f,f]}", "fov", 40.0 * ALPI_PI / 180.0, "position",
                  EYE[0], EYE[1], EYE[2], "target", 0.0, 0.5, 0.0, "up", 0.0, 1.0, 0.0);
    json_t *root = json_pack("{s:i,s:o,s:o}", "side", SIDE, "camera", camera, "pixels", pixels);
    if (root == NULL || json_dump_file(root, path, 0) != 0) {
        fprintf(stderr, "%s: could not be written\n", path);
        exit(1);
    }
    json_decref(root);
}

static void write_case(const char *folder, bool full)
{
    alp_context *context = test_context(2);
    alp_scene *scene = make_scene(context, folder, full);
    alp_bake_options options = alp_bake_options_default();
    options.atlas.mode = ALP_ATLAS_BLEND;
    options.atlas.size = 128;
    options.occlusion.samples = 64;
    options.output = test_path(folder, full ? "full.glb" : "blend.glb");
    alp_lightmap *lightmap = NULL;
    check(context, alp_bake(scene, &options, &lightmap, NULL));
    alpi_tracer *tracer = NULL;
    check(context, alpi_tracer_for_scene(scene, NULL, NULL, &tracer, NULL));
    write_pixels(lightmap, tracer, test_path(folder, full ? "full.json" : "blend.json"));
    alp_lightmap_destroy(lightmap);
    alp_scene_destroy(scene);
    alp_context_destroy(context);
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: write_blend FOLDER\n");
        return 2;
    }
    write_case(argv[1], false);
    write_case(argv[1], true);
    return 0;
}
