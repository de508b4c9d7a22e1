// SPDX-License-Identifier: MIT
// Fuzz target: what glTF keeps in buffers. The text is put together from accessors_input.h, so that
// every input reaches views, accessors, meshopt, Draco, skins, targets and instances.
#include "accessors_input.h"
#include "fuzz.h"

#include "base/memory.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

typedef struct text {
    char bytes[8192];
    size_t size;
} text;

static void add(text *t, const char *format, ...) ALP_PRINTF(2, 3);
static void add(text *t, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    // Just started. NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized)
    const int length = vsnprintf(t->bytes + t->size, sizeof t->bytes - t->size, format, arguments);
    va_end(arguments);
    if (length < 0 || (size_t)length >= sizeof t->bytes - t->size) {
        fuzz_abort("the text is too long");
    }
    t->size += (size_t)length;
}

static unsigned long long large(uint16_t value)
{
    return value < INPUT_LARGE ? value : ((unsigned long long)1 << (value - INPUT_LARGE)) * 256 - 1;
}

/// Numbers of elements: a few, so that an input takes no long time, or past every limit.
static unsigned long long elements(uint16_t value)
{
    enum { FEW = 512 };
    return value < INPUT_LARGE ? value % FEW : large(value);
}

static void add_view(text *t, const input_view *view, bool comma)
{
    static const char *const modes[] = {"", "ATTRIBUTES", "TRIANGLES", "INDICES"};
    static const char *const filters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
    add(t, "%s{\"buffer\":0,\"byteOffset\":%llu,\"byteLength\":%llu", comma ? "," : "",
        view->packing % 4 == 0 ? large(view->offset) : 0, large(view->length));
    if (view->stride != 0) {
        add(t, ",\"byteStride\":%u", view->stride);
    }
    if (view->packing % 4 != 0) {
        add(t,
            ",\"extensions\":{\"EXT_meshopt_compression\":{\"buffer\":0,\"byteOffset\":%llu,"
            "\"byteLength\":%llu,\"byteStride\":%u,\"count\":%llu,\"mode\":\"%s\",\"filter\":\"%s\""
            "}}",
            large(view->offset), large(view->packed_length), view->stride, large(view->count),
            modes[view->packing % 4], filters[view->packing / 4 % 4]);
    }
    add(t, "}");
}

static void add_accessor(text *t, const input_accessor *a, bool comma)
{
    static const char *const types[] = {"MAT2", "SCALAR", "VEC2", "VEC3", "VEC4", "MAT4"};
    add(t, "%s{\"componentType\":%u,\"type\":\"%s\",\"count\":%llu", comma ? "," : "",
        5120u + a->component_type, types[a->type % 6], elements(a->count));
    if (a->view != 255) {
        add(t, ",\"bufferView\":%u,\"byteOffset\":%llu", a->view, large(a->offset));
    }
    if ((a->flags & 1) != 0) {
        add(t, ",\"normalized\":true");
    }
    if ((a->flags & 2) != 0) {
        add(t,
            ",\"sparse\":{\"count\":%u,\"indices\":{\"bufferView\":%u,\"componentType\":%u},"
            "\"values\":{\"bufferView\":%u}}",
            a->sparse_count, a->sparse_indices, 5120u + a->sparse_type, a->sparse_values);
    }
    add(t, "}");
}

static void add_primitive(text *t, const input_head *head)
{
    static const char *const attributes[] = {",\"NORMAL\":1",
                                             ",\"TEXCOORD_0\":2",
                                             ",\"COLOR_0\":3",
                                             "",
                                             "",
                                             ",\"JOINTS_0\":6,\"WEIGHTS_0\":7"};
    add(t, "{\"mode\":%u,\"material\":0,\"attributes\":{\"POSITION\":0", head->mode);
    for (unsigned i = 0; i < sizeof attributes / sizeof *attributes; i++) {
        add(t, "%s", (head->parts >> i & 1) != 0 ? attributes[i] : "");
    }
    add(t, "}");
    if ((head->parts & INPUT_INDICES) != 0) {
        add(t, ",\"indices\":4");
    }
    if ((head->parts & INPUT_TARGET) != 0) {
        add(t, ",\"targets\":[{\"POSITION\":5}]");
    }
    if ((head->parts & INPUT_DRACO) != 0) {
        add(t,
            ",\"extensions\":{\"KHR_draco_mesh_compression\":{\"bufferView\":%u,\"attributes\":{"
            "\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2}}}",
            head->draco_view);
    }
    add(t, "}");
}

static void add_nodes(text *t, const input_head *head)
{
    add(t, "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0%s%s},{\"scale\":[1,2,3]}]",
        (head->parts & INPUT_SKIN) != 0 ? ",\"skin\":0" : "",
        (head->parts & INPUT_INSTANCES) != 0
            ? ",\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":9,"
              "\"ROTATION\":10,\"SCALE\":11}}}"
            : "");
    if ((head->parts & INPUT_SKIN) != 0) {
        add(t, ",\"skins\":[{\"joints\":[0,1],\"inverseBindMatrices\":8}]");
    }
}

static void make_text(text *t, const input *from, size_t bin_size)
{
    add(t, "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":%zu}],\"bufferViews\":[",
        bin_size);
    for (int i = 0; i < INPUT_VIEWS; i++) {
        add_view(t, &from->views[i], i > 0);
    }
    add(t, "],\"accessors\":[");
    for (int i = 0; i < INPUT_ACCESSORS; i++) {
        add_accessor(t, &from->accessors[i], i > 0);
    }
    add(t, "],\"materials\":[{}],\"meshes\":[{%s\"primitives\":[",
        (from->head.parts & INPUT_TARGET) != 0 ? "\"weights\":[0.5]," : "");
    add_primitive(t, &from->head);
    add(t, "]}],");
    add_nodes(t, &from->head);
    add(t, "}");
    while (t->size % 4 != 0) {
        add(t, " ");
    }
}

static uint8_t *put_u32(uint8_t *place, size_t value)
{
    for (int i = 0; i < 4; i++) {
        *place++ = (uint8_t)(value >> (8 * i));
    }
    return place;
}

/// The GLB, given to its reader.
static uint8_t *make_glb(const fuzz_run *run, const text *json, const uint8_t *bin, size_t bin_size,
                         size_t *size)
{
    const size_t padded = (bin_size + 3) / 4 * 4;
    *size = 12 + 8 + json->size + 8 + padded;
    uint8_t *bytes = alpi_allocate(run->context, *size, 1);
    if (bytes == NULL) {
        fuzz_abort("no memory for a GLB");
    }
    uint8_t *end = put_u32(put_u32(put_u32(bytes, 0x46546C67), 2), *size);
    end = put_u32(put_u32(end, json->size), 0x4E4F534A);
    memcpy(end, json->bytes, json->size);
    end = put_u32(put_u32(end + json->size, padded), 0x004E4942);
    if (bin_size > 0) {
        memcpy(end, bin, bin_size);
    }
    return bytes;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    input from = {0};
    text json = {.size = 0};
    const size_t head = size < sizeof from ? size : sizeof from;
    if (head > 0) {
        memcpy(&from, data, head);
    }
    make_text(&json, &from, size - head);
    fuzz_run run = fuzz_begin(size + json.size);
    size_t glb_size;
    uint8_t *glb = make_glb(&run, &json, size > head ? data + head : NULL, size - head, &glb_size);
    alp_scene *scene = fuzz_gltf_scene(&run, "absent/fuzz.glb", glb, glb_size);
    if (scene != NULL && scene->triangle_count < 10000) {
        fuzz_write_back(&run, scene, "out.glb");
    }
    alp_scene_destroy(scene);
    fuzz_end(&run);
    return 0;
}
