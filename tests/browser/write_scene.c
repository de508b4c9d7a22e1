// SPDX-License-Identifier: MIT
// write_scene FOLDER: bakes the Cornell box, writes it there for three.js, and writes down what
// pixels of a picture must be: albedo, irradiance where the pixel's ray ends, emission.
#include "test_support.h"

#include "atlas/atlas.h"
#include "base/file.h"
#include "base/memory.h"
#include "formats/formats.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 128, MARGIN = 2 };

typedef struct job {
    alp_context *context;
    alp_scene *scene;
    alp_lightmap *lightmap;
    alpi_light_pages light;
    const float *pages[16];
} job;

/// What a pixel's ray meets.
typedef struct view {
    uint32_t triangle; // ALPI_NONE: nothing
    float b1, b2;
} view;

static void check(const job *j, alp_result result)
{
    if (result != ALP_OK) {
        fprintf(stderr, "%s\n", alp_context_message(j->context));
        exit(1);
    }
}

static void bake(job *j)
{
    alp_bake_options options = alp_bake_options_default();
    options.maps = ALP_MAP_LIGHT;
    options.atlas.size = 64;
    options.light.samples = 256;
    j->context = test_context(2);
    check(j, alp_scene_load(j->context, "builtin:cornell", &j->scene));
    check(j, alp_bake(j->scene, &options, &j->lightmap, NULL));
    const alp_atlas *atlas = alp_lightmap_atlas(j->lightmap);
    j->light = (alpi_light_pages){.page_count = alp_lightmap_page_count(j->lightmap),
                                  .corner_uvs = (const float(*)[3][2])atlas->corner_uvs,
                                  .triangle_pages = alp_atlas_triangle_pages(atlas),
                                  .pages = j->pages,
                                  .irradiance_per_unit = 1.0f};
    for (uint32_t p = 0; p < j->light.page_count && p < 16; p++) {
        j->pages[p] =
            alp_lightmap_map_page(j->lightmap, ALP_MAP_LIGHT, p, &j->light.width, &j->light.height);
    }
}

static void write_file(const job *j, const char *folder)
{
    uint8_t *bytes = NULL;
    size_t size = 0;
    check(j, alpi_three_encode(j->scene, &j->light, &bytes, &size));
    check(j, alpi_file_write(j->context, test_path(folder, "cornell.json"), true, bytes, size));
    alpi_release(j->context, bytes);
}

// --- what the pixels are -------------------------------------------------------------------------

/// Möller, Trumbore: Fast, Minimum Storage Ray/Triangle Intersection. 1997. In double, and by hand:
/// this is the reference.
static double meet(const alp_scene *scene, uint32_t t, const double o[3], const double d[3],
                   view *at)
{
    double p[3][3];
    for (int k = 0; k < 3; k++) {
        for (int axis = 0; axis < 3; axis++) {
            p[k][axis] = (double)scene->positions[scene->triangles[t][k]][axis];
        }
    }
    double u[3], v[3], s[3];
    for (int i = 0; i < 3; i++) {
        u[i] = p[1][i] - p[0][i];
        v[i] = p[2][i] - p[0][i];
        s[i] = o[i] - p[0][i];
    }
    const double h[3] = {d[1] * v[2] - d[2] * v[1], d[2] * v[0] - d[0] * v[2],
                         d[0] * v[1] - d[1] * v[0]};
    const double q[3] = {s[1] * u[2] - s[2] * u[1], s[2] * u[0] - s[0] * u[2],
                         s[0] * u[1] - s[1] * u[0]};
    double det = u[0] * h[0] + u[1] * h[1] + u[2] * h[2];
    if (det <= 1e-12) { // from behind, or edge-on
        return HUGE_VAL;
    }
    double b1 = (s[0] * h[0] + s[1] * h[1] + s[2] * h[2]) / det;
    double b2 = (d[0] * q[0] + d[1] * q[1] + d[2] * q[2]) / det;
    double distance = (v[0] * q[0] + v[1] * q[1] + v[2] * q[2]) / det;
    *at = (view){t, (float)b1, (float)b2};
    return b1 >= 0 && b2 >= 0 && b1 + b2 <= 1 && distance > 0 ? distance : HUGE_VAL;
}

/// Through a point of the picture, in pixels; the box's camera looks along +z with +y up, so +x is
/// left.
static view look(const job *j, double x, double y)
{
    const alp_camera *camera = &j->scene->cameras[0];
    double half = tan((double)camera->vertical_fov / 2);
    const double o[3] = {(double)camera->position[0], (double)camera->position[1],
                         (double)camera->position[2]};
    const double d[3] = {-half * (x * 2 / SIDE - 1), half * (1 - y * 2 / SIDE), 1};
    view best = {.triangle = ALPI_NONE}, at = best;
    double nearest = HUGE_VAL;
    for (uint32_t t = 0; t < j->scene->triangle_count; t++) {
        double distance = meet(j->scene, t, o, d, &at);
        if (distance < nearest) {
            nearest = distance;
            best = at;
        }
    }
    return best;
}

/// Bilinear, and how much the four texels differ: the least and most of each channel.
static void read_map(const job *j, const view *at, double irradiance[3], double spread[3])
{
    const float(*uvs)[2] = j->light.corner_uvs[at->triangle];
    const float *page = j->pages[j->light.triangle_pages[at->triangle]];
    double uv[2];
    for (int i = 0; i < 2; i++) {
        uv[i] = (double)uvs[0][i] + (double)at->b1 * ((double)uvs[1][i] - (double)uvs[0][i]) +
                (double)at->b2 * ((double)uvs[2][i] - (double)uvs[0][i]);
    }
    double x = uv[0] * j->light.width - 0.5, y = uv[1] * j->light.height - 0.5;
    double x0 = floor(x), y0 = floor(y);
    for (size_t k = 0; k < 3; k++) {
        double low = HUGE_VAL, high = 0, sum = 0;
        for (int i = 0; i < 4; i++) {
            double column = fmin(fmax(x0 + (i & 1), 0), j->light.width - 1);
            double row = fmin(fmax(y0 + (i >> 1), 0), j->light.height - 1);
            double value = (double)page[4 * ((size_t)row * j->light.width + (size_t)column) + k];
            sum += value * (i & 1 ? x - x0 : x0 + 1 - x) * (i >> 1 ? y - y0 : y0 + 1 - y);
            low = fmin(low, value);
            high = fmax(high, value);
        }
        irradiance[k] = sum;
        spread[k] = high - low;
    }
}

/// How much the map changes over the 1/16 pixel to which a rasteriser snaps vertices (OpenGL
/// ES 3.0, 2.12.1: four bits at least).
static void read_drift(const job *j, int x, int y, const double irradiance[3], double drift[3])
{
    for (int i = 0; i < 4; i++) {
        const double step = 1.0 / 16;
        view at = look(j, x + 0.5 + (i & 1 ? step : -step), y + 0.5 + (i & 2 ? step : -step));
        double moved[3], ignored[3];
        read_map(j, &at, moved, ignored);
        for (int k = 0; k < 3; k++) {
            drift[k] = fmax(drift[k], fabs(moved[k] - irradiance[k]));
        }
    }
}

/// Whether all pixels within MARGIN show the same surface from the same side.
static bool is_inside(const job *j, const view *views, int x, int y)
{
    const uint32_t t = views[y * SIDE + x].triangle;
    if (t == ALPI_NONE || x < MARGIN || y < MARGIN || x >= SIDE - MARGIN || y >= SIDE - MARGIN) {
        return false;
    }
    for (int i = 0; i < (2 * MARGIN + 1) * (2 * MARGIN + 1); i++) {
        int column = x + i % (2 * MARGIN + 1) - MARGIN, row = y + i / (2 * MARGIN + 1) - MARGIN;
        uint32_t other = views[row * SIDE + column].triangle;
        if (other == ALPI_NONE ||
            j->scene->triangle_surface[other] != j->scene->triangle_surface[t] ||
            // The very same normal. NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
            memcmp(j->scene->normals[j->scene->triangles[other][0]],
                   j->scene->normals[j->scene->triangles[t][0]], 3 * sizeof(float)) != 0) {
            return false;
        }
    }
    return true;
}

static void add_triple(json_t *object, const char *name, double red, double green, double blue)
{
    json_object_set_new(object, name, json_pack("[f,f,f]", red, green, blue));
}

static json_t *describe(const job *j, const view *at, int x, int y)
{
    uint32_t surface = j->scene->triangle_surface[at->triangle];
    const alpi_surface *s = &j->scene->surfaces[surface];
    const float *emission = j->scene->materials[s->material].emission;
    vec3 albedo = alpi_surface_albedo(j->scene, at->triangle, at->b1, at->b2);
    double irradiance[3], spread[3], drift[3] = {0.0, 0.0, 0.0};
    read_map(j, at, irradiance, spread);
    read_drift(j, x, y, irradiance, drift);
    json_t *pixel = json_pack("{s:i,s:i,s:s,s:s}", "x", x, "y", y, "surface", s->name, "material",
                              j->scene->materials[s->material].name);
    add_triple(pixel, "albedo", (double)albedo.x, (double)albedo.y, (double)albedo.z);
    add_triple(pixel, "emission", (double)emission[0], (double)emission[1], (double)emission[2]);
    add_triple(pixel, "irradiance", irradiance[0], irradiance[1], irradiance[2]);
    add_triple(pixel, "spread", spread[0], spread[1], spread[2]);
    add_triple(pixel, "drift", drift[0], drift[1], drift[2]);
    return pixel;
}

static void write_pixels(const job *j, const char *folder)
{
    static view views[SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE; i++) {
        views[i] = look(j, i % SIDE + 0.5, i / SIDE + 0.5);
    }
    json_t *pixels = json_array();
    for (int i = 0; i < SIDE * SIDE; i++) {
        if (is_inside(j, views, i % SIDE, i / SIDE)) {
            json_array_append_new(pixels, describe(j, &views[i], i % SIDE, i / SIDE));
        }
    }
    const alp_camera *c = &j->scene->cameras[0];
    json_t *camera = json_pack("{s:f}", "fov", (double)c->vertical_fov);
    add_triple(camera, "position", (double)c->position[0], (double)c->position[1],
               (double)c->position[2]);
    add_triple(camera, "target", (double)c->target[0], (double)c->target[1], (double)c->target[2]);
    add_triple(camera, "up", (double)c->up[0], (double)c->up[1], (double)c->up[2]);
    json_t *root = json_pack("{s:i,s:o,s:o}", "side", SIDE, "camera", camera, "pixels", pixels);
    if (root == NULL || json_dump_file(root, test_path(folder, "expected.json"), 0) != 0) {
        fprintf(stderr, "%s: expected.json could not be written\n", folder);
        exit(1);
    }
    json_decref(root);
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: write_scene FOLDER\n");
        return 2;
    }
    job j = {0};
    bake(&j);
    write_file(&j, argv[1]);
    write_pixels(&j, argv[1]);
    alp_lightmap_destroy(j.lightmap);
    alp_scene_destroy(j.scene);
    alp_context_destroy(j.context);
    return 0;
}
