// SPDX-License-Identifier: MIT
#include "pack_asset.h"

#include "base/memory.h"
#include "formats/formats.h"
#include "quad_asset.h"
#include "test_gltf.h"
#include "test_scenes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// --- assets --------------------------------------------------------------------------------------

pack_asset *pack_start(void)
{
    static pack_asset asset;
    memset(&asset, 0, sizeof asset);
    return &asset;
}

static size_t put(pack_asset *asset, const void *bytes, size_t size)
{
    size_t offset = (asset->bin_size + 3) / 4 * 4;
    assert_true(offset + size <= PACK_BIN_LIMIT);
    memcpy(asset->bin + offset, bytes, size);
    asset->bin_size = offset + size;
    return offset;
}

static void append(char *text, const char *item)
{
    size_t length = strlen(text);
    assert_true(length + strlen(item) + 2 < PACK_TEXT_LIMIT);
    snprintf(text + length, PACK_TEXT_LIMIT - length, "%s%s", length > 0 ? "," : "", item);
}

int pack_view(pack_asset *asset, const void *bytes, size_t size, size_t stride)
{
    char item[256], more[64] = "";
    if (stride != 0) {
        snprintf(more, sizeof more, ",'byteStride':%zu", stride);
    }
    snprintf(item, sizeof item, "{'buffer':0,'byteOffset':%zu,'byteLength':%zu%s}",
             put(asset, bytes, size), size, more);
    append(asset->views, item);
    return asset->view_count++;
}

int pack_meshopt(pack_asset *asset, const void *encoded, size_t size, const char *mode,
                 const char *filter, size_t count, size_t stride)
{
    char item[512], more[64] = "", own[64] = "";
    if (filter != NULL) {
        snprintf(more, sizeof more, ",'filter':'%s'", filter);
    }
    if (strcmp(mode, "ATTRIBUTES") == 0) { // indices have no stride
        snprintf(own, sizeof own, ",'byteStride':%zu", stride);
    }
    snprintf(item, sizeof item,
             "{'buffer':1,'byteOffset':%zu,'byteLength':%zu%s,'extensions':{"
             "'EXT_meshopt_compression':{'buffer':0,'byteOffset':%zu,'byteLength':%zu,"
             "'byteStride':%zu,'mode':'%s','count':%zu%s}}}",
             asset->fallback_size, count * stride, own, put(asset, encoded, size), size, stride,
             mode, count, more);
    asset->fallback_size += (count * stride + 3) / 4 * 4;
    append(asset->views, item);
    return asset->view_count++;
}

int pack_accessor(pack_asset *asset, int view, int component_type, size_t count, const char *type,
                  const char *more)
{
    char item[256], place[32] = "";
    if (view >= 0) {
        snprintf(place, sizeof place, "'bufferView':%d,", view);
    }
    snprintf(item, sizeof item, "{%s'componentType':%d,'count':%zu,'type':'%s'%s}", place,
             component_type, count, type, more);
    append(asset->accessors, item);
    return asset->accessor_count++;
}

static void write_bytes(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
}

const char *pack_write(pack_asset *asset, const char *rest)
{
    static char path[1024], json[3 * PACK_TEXT_LIMIT];
    const char *folder = quad_folder();
    char fallback[200] = "";
    if (asset->fallback_size > 0) {
        snprintf(fallback, sizeof fallback,
                 ",{%s'byteLength':%zu,'extensions':{'EXT_meshopt_compression':{'fallback':true}}}",
                 asset->as_gltf ? "'uri':'none.bin'," : "", asset->fallback_size);
    }
    snprintf(json, sizeof json,
             "{'asset':{'version':'2.0'},'buffers':[{%s'byteLength':%zu}%s],'bufferViews':[%s],"
             "'accessors':[%s],%s}",
             asset->as_gltf ? "'uri':'packed.bin'," : "", asset->bin_size, fallback, asset->views,
             asset->accessors, rest);
    snprintf(path, sizeof path, "%s/packed.%s", folder, asset->as_gltf ? "gltf" : "glb");
    if (asset->as_gltf) {
        for (char *c = json; *c != '\0'; c++) {
            *c = *c == '\'' ? '"' : *c;
        }
        write_bytes(path, json, strlen(json));
        write_bytes(test_path(folder, "packed.bin"), asset->bin, asset->bin_size);
        return path;
    }
    alp_context *context = test_context(1);
    size_t size;
    uint8_t *bytes = test_glb(context, json, asset->bin, asset->bin_size, &size);
    write_bytes(path, bytes, size);
    alpi_release(context, bytes);
    alp_context_destroy(context);
    return path;
}

// --- the wave ------------------------------------------------------------------------------------

static float on_grid(double value)
{
    return (float)(round(value * 4096.0) / 4096.0);
}

/// Vertex (x, z) of sheet 0 (the ground, normal up) or 1 (the wall at z = 0, normal +z).
static void wave_vertex(wave *w, int sheet, int i, int j)
{
    int v = (sheet * WAVE_SIDE + j) * WAVE_SIDE + i;
    double a = i / (WAVE_SIDE - 1.0), b = j / (WAVE_SIDE - 1.0);
    double height = 0.125 * (1.0 - cos(12.0 * a) * cos(9.0 * b)) * 0.5;
    double slope_a = 0.0625 * 12.0 * sin(12.0 * a) * cos(9.0 * b);
    double slope_b = 0.0625 * 9.0 * cos(12.0 * a) * sin(9.0 * b);
    const double n[3] = {sheet ? 0.0 : -slope_a, sheet ? 0.0 : 1.0, sheet ? 1.0 : -slope_b};
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    w->positions[v][0] = on_grid(a);
    w->positions[v][1] = on_grid(sheet ? b : height);
    w->positions[v][2] = on_grid(sheet ? 0.0 : b);
    for (int k = 0; k < 3; k++) {
        w->normals[v][k] = (float)(n[k] / length);
    }
    w->uvs[v][0] = on_grid(a * 0.5);
    w->uvs[v][1] = on_grid(b * 0.5 + 0.5 * sheet);
}

const wave *wave_mesh(void)
{
    static wave w;
    uint32_t *index = w.indices;
    for (int sheet = 0; sheet < 2; sheet++) {
        for (int j = 0; j < WAVE_SIDE; j++) {
            for (int i = 0; i < WAVE_SIDE; i++) {
                wave_vertex(&w, sheet, i, j);
                uint32_t v = (uint32_t)((sheet * WAVE_SIDE + j) * WAVE_SIDE + i),
                         up = v + WAVE_SIDE;
                if (i + 1 < WAVE_SIDE && j + 1 < WAVE_SIDE) {
                    uint32_t ground[6] = {v, up, v + 1, v + 1, up, up + 1};
                    uint32_t wall[6] = {v, v + 1, up, v + 1, up + 1, up};
                    memcpy(index, sheet ? wall : ground, sizeof ground);
                    index += 6;
                }
            }
        }
    }
    return &w;
}

alp_scene *wave_scene(alp_context *context)
{
    const wave *w = wave_mesh();
    pack_asset *asset = pack_start();
    pack_accessor(asset, pack_view(asset, w->positions, sizeof w->positions, 0), 5126,
                  WAVE_VERTICES, "VEC3", WAVE_BOUNDS);
    pack_accessor(asset, pack_view(asset, w->normals, sizeof w->normals, 0), 5126, WAVE_VERTICES,
                  "VEC3", "");
    pack_accessor(asset, pack_view(asset, w->uvs, sizeof w->uvs, 0), 5126, WAVE_VERTICES, "VEC2",
                  "");
    pack_accessor(asset, pack_view(asset, w->indices, sizeof w->indices, 0), 5125,
                  3 * WAVE_TRIANGLES, "SCALAR", "");
    const char *path =
        pack_write(asset, "'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],'meshes':[{"
                          "'primitives':[{'attributes':{'POSITION':0,'NORMAL':1,'TEXCOORD_0':2},"
                          "'indices':3}]}]");
    alp_scene *scene = test_load(context, path);
    return scene;
}

double wave_distance(const alp_scene *a, const alp_scene *b)
{
    double most = 0.0;
    assert_int_equal(a->triangle_count, b->triangle_count);
    for (uint32_t t = 0; t < a->triangle_count; t++) {
        vec3 one[3], two[3];
        alpi_triangle_corners(a, t, one);
        alpi_triangle_corners(b, t, two);
        for (int k = 0; k < 3; k++) {
            most = fmax(most, (double)vec3_length(vec3_sub(one[k], two[k])));
        }
    }
    return most;
}

double wave_occlusion_difference(const alp_scene *a, const alp_scene *b)
{
    enum { SIDE = 12 };
    alp_occlusion_options options = alp_occlusion_options_default();
    const double up[3] = {0.0, 1.0, 0.0};
    double sum = 0.0, low = 1.0;
    options.samples = 256;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double place[3] = {(i % SIDE + 0.37) / SIDE, 0.13, (i / SIDE + 0.41) / SIDE};
        const double first = test_occlusion(a, place, up, &options);
        const double difference = first - test_occlusion(b, place, up, &options);
        sum += difference * difference;
        low = fmin(low, first);
    }
    assert_true(low < 0.7); // there is something to compare
    return sqrt(sum / (SIDE * SIDE));
}

// --- patching ------------------------------------------------------------------------------------

/// Coordinates by chart, so that some vertices are parted and others are not.
static void invent(const alp_scene *scene, float (*uvs)[3][2])
{
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            uvs[t][k][0] = (float)(t / 50 % 64) / 64.0f;
            uvs[t][k][1] = (float)(scene->vertex_source[scene->triangles[t][k]] % 512) / 512.0f;
        }
    }
}

alp_scene *pack_patch(alp_context *context, const char *path, const char *ending, double distance)
{
    alp_scene *scene = NULL, *again = NULL;
    uint8_t *png = NULL;
    size_t png_size = 0;
    alp_image *image = NULL;
    ASSERT_OK(context, alp_scene_load(context, path, &scene));
    ASSERT_OK(context,
              alp_image_create(context, (alp_image_info){1, 1, 1, ALP_COMPONENT_U8}, &image));
    ASSERT_OK(context, alpi_png_encode(image, &png, &png_size));
    alp_image_destroy(image);
    float(*uvs)[3][2] = calloc(scene->triangle_count, sizeof *uvs);
    assert_non_null(uvs);
    invent(scene, uvs);
    const uint8_t *pngs[1] = {png};
    const size_t sizes[1] = {png_size};
    alpi_mesh_patch patch = {.page_count = 1,
                             .corner_uvs = (void *)uvs,
                             .page_pngs = pngs,
                             .page_png_sizes = sizes,
                             .occlusion_strength = 1.0f,
                             .extras_json = "{\"version\":\"test\"}"};
    const char *out =
        test_path(quad_folder(), ending[1] == 'g' && ending[4] == 'f' ? "baked.gltf" : "baked.glb");
    ASSERT_OK(context, alpi_scene_write_patched(scene, &patch, out, true));
    quad_list(path, out);
    ASSERT_OK(context, alp_scene_load(context, out, &again));
    ASSERT_NEAR(wave_distance(scene, again), 0.0, distance);
    assert_int_equal(again->surfaces[0].uv_sets, scene->surfaces[0].uv_sets + 1);
    const float(*ours)[2] = (const float(*)[2])again->uvs[scene->surfaces[0].uv_sets];
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            assert_memory_equal(ours[again->triangles[t][k]], uvs[t][k], sizeof uvs[t][k]);
        }
    }
    alp_scene_destroy(scene);
    alpi_release(context, png);
    free(uvs);
    return again;
}
