// SPDX-License-Identifier: MIT
#include "quad_asset.h"

#include "base/memory.h"
#include "formats/text/json_spans.h"
#include "text_check.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

// --- the asset -----------------------------------------------------------------------------------

static const struct {
    const char *type;
    int component_type, count, size; // size in bytes, padded to 4
    bool has_bounds;
} arrays[] = {
    {"VEC3", 5126, 4, 48, true},    {"VEC3", 5126, 4, 48, false}, {"VEC2", 5126, 4, 32, false},
    {"VEC4", 5121, 4, 16, false},   {"VEC4", 5126, 4, 64, false}, {"VEC3", 5121, 4, 16, false},
    {"SCALAR", 5123, 6, 12, false}, {"VEC3", 5126, 4, 48, true},  {"SCALAR", 5121, 4, 4, false},
    {"MAT2", 5121, 4, 32, false},   {"VEC4", 5121, 4, 16, false}};
enum { ARRAY_COUNT = sizeof arrays / sizeof *arrays };

typedef struct quad_data {
    float positions[4][3], normals[4][3], uvs[4][2];
    uint8_t joints[4][4];
    float weights[4][4];
    uint8_t custom[4][4]; // the fourth is padding
    uint16_t indices[6];
    float morph[4][3];
    uint8_t strip[4];
    uint8_t matrices[4][8]; // two columns of two bytes and two of padding
    uint8_t colors[4][4];
} quad_data;

static void fill_data(quad_data *data)
{
    *data = (quad_data){.indices = {0, 1, 2, 0, 2, 3}, .strip = {0, 1, 3, 2}};
    for (int v = 0; v < 4; v++) {
        data->positions[v][0] = v == 1 || v == 2 ? 1.0f : 0.0f;
        data->positions[v][1] = v >= 2 ? 1.0f : 0.0f;
        data->normals[v][2] = 1.0f;
        data->uvs[v][0] = 0.25f * (float)v;
        data->joints[v][0] = 0;
        data->weights[v][0] = 1.0f;
        data->morph[v][2] = 0.5f + (float)v;
        for (int k = 0; k < 3; k++) {
            data->custom[v][k] = (uint8_t)(10 * v + k);
        }
        for (int k = 0; k < 4; k++) {
            data->colors[v][k] = (uint8_t)(50 + 40 * v + 10 * k);
        }
        for (int k = 0; k < 8; k++) {
            data->matrices[v][k] = (uint8_t)(k % 4 < 2 ? 10 * v + k : 0);
        }
    }
}

static size_t print_json(char *json, size_t size, const char *uri, const char *asset,
                         const char *rest)
{
    size_t at =
        (size_t)snprintf(json, size, "{ \"asset\":%s,\n \"buffers\" : [{%s\"byteLength\":%zu}],",
                         asset, uri, sizeof(quad_data));
    at += (size_t)snprintf(json + at, size - at, "\"bufferViews\":[");
    int offset = 0;
    for (int i = 0; i < ARRAY_COUNT; i++) {
        bool is_index = i == 6 || i == 8;
        at +=
            (size_t)snprintf(json + at, size - at,
                             "%s{\"buffer\":0,\"byteOffset\":%d,\"byteLength\":%d%s,\"target\":%d}",
                             i ? "," : "", offset, arrays[i].size,
                             i == 5   ? ",\"byteStride\":4"
                             : i == 3 ? ",\"byteStride\":4"
                                      : "",
                             is_index ? 34963 : 34962);
        offset += arrays[i].size;
    }
    at += (size_t)snprintf(json + at, size - at, "],\"accessors\":[");
    for (int i = 0; i < ARRAY_COUNT; i++) {
        at += (size_t)snprintf(
            json + at, size - at,
            "%s{\"bufferView\":%d,\"componentType\":%d,\"count\":%d,\"type\":\"%s\"%s}",
            i ? "," : "", i, arrays[i].component_type, arrays[i].count, arrays[i].type,
            i == 0    ? ",\"min\":[0,0,0],\"max\":[1,1,0]"
            : i == 7  ? ",\"min\":[0,0,0.5],\"max\":[0,0,3.5]"
            : i == 10 ? ",\"normalized\":true"
                      : "");
    }
    at += (size_t)snprintf(json + at, size - at, "],%s}", rest);
    assert_true(at < size);
    return at;
}

static void put_u32(FILE *file, size_t value)
{
    const uint8_t bytes[4] = {(uint8_t)value, (uint8_t)(value >> 8), (uint8_t)(value >> 16),
                              (uint8_t)(value >> 24)};
    fwrite(bytes, 1, 4, file);
}

const char *quad_folder(void)
{
    const char *kept = getenv("ALPENGLOW_WRITTEN");
    static char folder[600];
    static int counter;
    if (kept == NULL) {
        return test_folder();
    }
    snprintf(folder, sizeof folder, "%s/quad%ld-%d", kept, (long)getpid(), counter++);
    char command[700];
    snprintf(command, sizeof command, "mkdir -p '%s'", folder);
    assert_int_equal(system(command), 0);
    return folder;
}

const char *quad_write_glb(const char *asset, const char *rest)
{
    static char path[1024];
    char json[16384];
    quad_data data;
    fill_data(&data);
    size_t size = print_json(json, sizeof json - 4, "", asset, rest);
    while (size % 4 != 0) {
        json[size++] = ' ';
    }
    snprintf(path, sizeof path, "%s/quad.glb", quad_folder());
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    static const char extra[] = "\4\0\0\0EXTRmore"; // a chunk that nobody knows
    size_t extra_size = sizeof extra - 1;
    fwrite("glTF\2\0\0\0", 1, 8, file);
    put_u32(file, 12 + 8 + size + 8 + sizeof data + extra_size);
    put_u32(file, size);
    fwrite("JSON", 1, 4, file);
    fwrite(json, 1, size, file);
    put_u32(file, sizeof data);
    fwrite("BIN\0", 1, 4, file);
    fwrite(&data, 1, sizeof data, file);
    fwrite(extra, 1, extra_size, file);
    fclose(file);
    return path;
}

const char *quad_write_gltf(const char *asset, const char *rest)
{
    static char path[1024];
    char json[16384];
    quad_data data;
    fill_data(&data);
    const char *folder = quad_folder();
    size_t size = print_json(json, sizeof json, "\"uri\":\"quad%20data.bin\",", asset, rest);
    snprintf(path, sizeof path, "%s/quad data.bin", folder);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fwrite(&data, 1, sizeof data, file);
    fclose(file);
    snprintf(path, sizeof path, "%s/quad.gltf", folder);
    file = fopen(path, "wb");
    assert_non_null(file);
    fwrite(json, 1, size, file);
    fclose(file);
    return path;
}

// --- the bake ------------------------------------------------------------------------------------

static uint8_t page_png[256]; // of one grey pixel, the same for all pages
static const uint8_t *page_pngs[4];
static size_t page_png_sizes[4];

static void make_pages(alp_context *context)
{
    alp_image *image = NULL;
    ASSERT_OK(context,
              alp_image_create(context, (alp_image_info){1, 1, 1, ALP_COMPONENT_U8}, &image));
    alp_image_bytes(image)[0] = 128;
    uint8_t *png = NULL;
    size_t size = 0;
    ASSERT_OK(context, alpi_png_encode(image, &png, &size));
    alp_image_destroy(image);
    assert_true(size <= sizeof page_png);
    memcpy(page_png, png, size);
    alpi_release(context, png);
    for (int i = 0; i < 4; i++) {
        page_pngs[i] = page_png;
        page_png_sizes[i] = size;
    }
}

quad_bake quad_open(const char *path, uint32_t pages)
{
    quad_bake bake = {.context = test_context(1)};
    make_pages(bake.context);
    snprintf(bake.path, sizeof bake.path, "%s", path);
    ASSERT_OK(bake.context, alpi_gltf_read_scene(bake.context, path, &bake.scene));
    bake.uvs = calloc(bake.scene->triangle_count + 1, sizeof *bake.uvs);
    bake.pages = calloc(bake.scene->triangle_count + 1, sizeof *bake.pages);
    assert_non_null(bake.uvs);
    assert_non_null(bake.pages);
    for (uint32_t t = 0; t < bake.scene->triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            uint32_t vertex = bake.scene->vertex_source[bake.scene->triangles[t][k]];
            bake.uvs[t][k][0] = 0.125f + 0.125f * (float)vertex;
            bake.uvs[t][k][1] = 0.0625f * (float)(t / 2);
        }
    }
    bake.patch = (alpi_mesh_patch){.page_count = pages,
                                   .corner_uvs = (void *)bake.uvs,
                                   .triangle_pages = bake.pages,
                                   .page_pngs = page_pngs,
                                   .page_png_sizes = page_png_sizes,
                                   .occlusion_strength = 1.0f,
                                   .extras_json = "{\"version\":\"test\"}"};
    return bake;
}

void quad_part_triangles(quad_bake *bake)
{
    for (uint32_t t = 0; t < bake->scene->triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            bake->uvs[t][k][1] = 0.0625f * (float)(t + 1);
        }
    }
}

void quad_list(const char *before, const char *after)
{
    const char *kept = getenv("ALPENGLOW_WRITTEN");
    if (kept != NULL) {
        FILE *list = fopen(test_path(kept, "list"), "a");
        assert_non_null(list);
        fprintf(list, "%s\t%s\n", before, after);
        fclose(list);
    }
}

void quad_write(quad_bake *bake, const char *ending)
{
    char before[1024];
    memcpy(before, bake->path, sizeof before);
    const char *old_ending = strrchr(before, '.');
    snprintf(bake->path, sizeof bake->path, "%.*s baked%s", (int)(old_ending - before), before,
             ending);
    ASSERT_OK(bake->context,
              alpi_scene_write_patched(bake->scene, &bake->patch, bake->path, false));
    quad_list(before, bake->path);
    ASSERT_OK(bake->context, alpi_gltf_read_scene(bake->context, bake->path, &bake->result));
    assert_int_equal(bake->result->triangle_count, bake->scene->triangle_count);
    const alpi_gltf_document *old = quad_old(bake), *new = quad_new(bake);
    if (old->is_glb == new->is_glb) {
        const size_t gone = assert_text_kept(old->text, old->text_size, new->text, new->text_size,
                                             patch_may_change);
        if (gone == 0 || !old->is_glb) { // else their bytes went too
            assert_memory_equal(old->buffers[0].bytes, new->buffers[0].bytes, old->buffers[0].size);
        }
        assert_int_equal(old->more_chunks_size, new->more_chunks_size);
        if (old->more_chunks_size > 0) {
            assert_memory_equal(old->more_chunks, new->more_chunks, old->more_chunks_size);
        }
    }
}

void quad_unmark(const char *path)
{
    static const char mark[] = "\"alpenglow\":\"", other[] = "\"somebodys\":\"";
    size_t size, found = 0;
    unsigned char *bytes = test_read_file(path, &size);
    for (size_t i = 0; i + sizeof mark - 1 <= size; i++) {
        if (memcmp(bytes + i, mark, sizeof mark - 1) == 0) {
            memcpy(bytes + i, other, sizeof other - 1);
            found++;
        }
    }
    assert_true(found > 0);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fwrite(bytes, 1, size, file);
    fclose(file);
    free(bytes);
}

void quad_close(quad_bake *bake)
{
    alp_scene_destroy(bake->result);
    alp_scene_destroy(bake->scene);
    free(bake->uvs);
    free(bake->pages);
    alp_context_destroy(bake->context);
}

const alpi_gltf_document *quad_old(const quad_bake *bake)
{
    return bake->scene->attachments[ALPI_ATTACHMENT_DOCUMENT].data;
}

const alpi_gltf_document *quad_new(const quad_bake *bake)
{
    return bake->result->attachments[ALPI_ATTACHMENT_DOCUMENT].data;
}

const char *quad_text(const quad_bake *bake, const char *path)
{
    static char text[4][4096];
    static int next;
    const alpi_gltf_document *document = quad_new(bake);
    alpi_json_span root, span = {0, 0};
    assert_true(alpi_json_value(document->text, 0, document->text_size, &root));
    char *out = text[next++ % 4];
    out[0] = '\0';
    if (alpi_json_at(document->text, root, path, &span)) {
        snprintf(out, sizeof text[0], "%.*s", (int)(span.end - span.begin),
                 document->text + span.begin);
    }
    return out;
}

int quad_number(const quad_bake *bake, const char *path)
{
    const char *text = quad_text(bake, path);
    return text[0] == '\0' ? -1 : (int)strtol(text, NULL, 10);
}

void quad_require_corners(const quad_bake *bake, uint32_t set)
{
    const alp_scene *a = bake->scene, *b = bake->result;
    assert_non_null(b->uvs[set]);
    for (uint32_t t = 0; t < a->triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            uint32_t va = a->triangles[t][k], vb = b->triangles[t][k];
            assert_memory_equal(a->positions[va], b->positions[vb], sizeof a->positions[va]);
            assert_memory_equal(b->uvs[set][vb], bake->uvs[t][k], sizeof bake->uvs[t][k]);
        }
    }
}
