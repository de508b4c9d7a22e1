// SPDX-License-Identifier: MIT
// A good asset with bytes changed or cut off, a few thousand times: whatever the reader says, it
// must not crash (the sanitizer builds look closer). The mutations are the same in every run.
#include "test_gltf.h"

#include "base/memory.h"
#include "formats/formats.h"
#include "formats/gltf/gltf_read.h"

#include <stdlib.h>

enum { ROUNDS = 4000 };

/// Everything the reader knows, in one small asset: strided and sparse accessors, two UV sets,
/// colours, a strip, a texture in the BIN chunk, lights, cameras, nested nodes.
static const char asset[] =
    "{'asset':{'version':'2.0'},'scene':0,'scenes':[{'nodes':[0]}],"
    "'extensionsUsed':['KHR_lights_punctual','KHR_texture_transform'],"
    "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'spot','spot':{'innerConeAngle':0.2}},"
    "{'type':'point','range':3}]}},"
    "'nodes':[{'children':[1,2],'scale':[1,2,-1]},{'mesh':0,'rotation':[0,0,1,0],"
    "'extensions':{'KHR_lights_punctual':{'light':0}}},{'camera':0,"
    "'matrix':[1,0,0,0,0,1,0,0,0,0,1,0,1,2,3,1],'mesh':0,'extensions':"
    "{'KHR_lights_punctual':{'light':1}}}],"
    "'cameras':[{'type':'perspective','perspective':{'yfov':0.9,'znear':0.1}}],"
    "'meshes':[{'name':'m','primitives':[{'attributes':{'POSITION':0,'NORMAL':1,'TEXCOORD_0':2,"
    "'COLOR_0':3},'indices':4,'material':0},{'attributes':{'POSITION':0},'mode':5}]}],"
    "'materials':[{'alphaMode':'MASK','pbrMetallicRoughness':{'baseColorTexture':{'index':0,"
    "'extensions':{'KHR_texture_transform':{'rotation':1,'texCoord':0}}},'metallicFactor':0.5}}],"
    "'textures':[{'source':0,'sampler':0}],'samplers':[{'wrapS':33071}],"
    "'images':[{'bufferView':2,'mimeType':'image/png'}],"
    "'accessors':[{'bufferView':0,'componentType':5126,'type':'VEC3','count':4},"
    "{'bufferView':0,'byteOffset':12,'componentType':5120,'normalized':true,'type':'VEC3',"
    "'count':4},{'bufferView':0,'byteOffset':16,'componentType':5123,'normalized':true,"
    "'type':'VEC2','count':4},{'componentType':5121,'normalized':true,'type':'VEC4','count':4,"
    "'sparse':{'count':1,'indices':{'bufferView':1,'byteOffset':8,'componentType':5121},"
    "'values':{'bufferView':1,'byteOffset':12}}},"
    "{'bufferView':1,'componentType':5121,'type':'SCALAR','count':6}],"
    "'bufferViews':[{'buffer':0,'byteLength':80,'byteStride':20},"
    "{'buffer':0,'byteOffset':80,'byteLength':16},{'buffer':0,'byteOffset':96,'byteLength':";

typedef struct parts {
    char *json; // released by the caller
    uint8_t bin[4096];
    size_t bin_size;
} parts;

static parts make_parts(alp_context *context)
{
    alp_image *image = NULL;
    uint8_t *png = NULL;
    size_t png_size = 0;
    ASSERT_OK(context,
              alp_image_create(context, (alp_image_info){4, 4, 4, ALP_COMPONENT_U8}, &image));
    ASSERT_OK(context, alpi_png_encode(image, &png, &png_size));
    alp_image_destroy(image);
    parts p = {.bin_size = 96 + png_size};
    for (uint32_t i = 0; i < 4; i++) {
        float position[3] = {(float)(i & 1), (float)(i >> 1), 0.0f};
        memcpy(p.bin + (size_t)20 * i, position, sizeof position);
        p.bin[20 * i + 14] = 127;
    }
    memcpy(p.bin + 80, ((uint8_t[]){0, 1, 2, 2, 1, 3, 0, 0, 2, 0, 0, 0, 9, 9, 9, 255}), 16);
    assert_in_range(png_size, 1, sizeof p.bin - 96);
    memcpy(p.bin + 96, png, png_size);
    alpi_release(context, png);
    p.json = alpi_format(context, "%s%zu}],'buffers':[{'byteLength':%zu}]}", asset, png_size,
                         p.bin_size);
    assert_non_null(p.json);
    return p;
}

static uint8_t *make_asset(alp_context *context, size_t *size)
{
    parts p = make_parts(context);
    uint8_t *bytes = test_glb(context, p.json, p.bin, p.bin_size, size);
    alpi_release(context, p.json);
    return bytes;
}

static alp_result read_copy(alp_context *context, const uint8_t *bytes, size_t size)
{
    // Exactly as long as the data, so that a sanitizer sees a read past the end.
    uint8_t *copy = alpi_allocate(context, size, 1);
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    alpi_gltf_document *document = NULL;
    alp_scene *scene = NULL;
    alp_result result = alpi_gltf_document_parse(context, "mutated.glb", copy, size, &document);
    if (result == ALP_OK) {
        result = alpi_gltf_scene_from_document(document, &scene);
    }
    alp_scene_destroy(scene);
    return result;
}

static uint32_t next_random(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u; // Knuth's MMIX
    return (uint32_t)(*state >> 33);
}

static void mutate(uint8_t *bytes, size_t size, uint64_t *state)
{
    static const char tokens[] = "0123456789-{}[]\",:e.";
    uint32_t changes = 1 + next_random(state) % 4;
    for (uint32_t i = 0; i < changes; i++) {
        size_t place = next_random(state) % size;
        uint32_t kind = next_random(state) % 4;
        uint8_t flipped = (uint8_t)(bytes[place] ^ 1u << next_random(state) % 8);
        uint8_t token = (uint8_t)tokens[next_random(state) % (sizeof tokens - 1)];
        bytes[place] = kind == 0 ? (uint8_t)next_random(state) : kind == 1 ? flipped : token;
    }
}

TEST_WITH_CONTEXT(changed_bytes, 1)
{
    size_t size;
    uint8_t *good = make_asset(context, &size);
    ASSERT_OK(context, read_copy(context, good, size));
    uint8_t *bad = alpi_allocate(context, size, 1);
    uint64_t seed = 1;
    int accepted = 0, refused = 0;
    for (int round = 0; round < ROUNDS; round++) {
        memcpy(bad, good, size);
        mutate(bad, size, &seed);
        alp_result result = read_copy(context, bad, size);
        accepted += result == ALP_OK;
        refused += result != ALP_OK;
        assert_true(result == ALP_OK || alp_context_message(context)[0] != '\0');
    }
    print_message("%d of %d mutations accepted\n", accepted, ROUNDS);
    assert_true(accepted > ROUNDS / 20 && refused > ROUNDS / 20); // both sides were exercised
    alpi_release(context, bad);
    alpi_release(context, good);
}

/// Reads the asset with `length` bytes at `place` of its JSON replaced by `text`.
static alp_result read_replaced(alp_context *context, const parts *p, size_t place, size_t length,
                                const char *text)
{
    char *json =
        alpi_format(context, "%.*s%s%s", (int)place, p->json, text, p->json + place + length);
    size_t size;
    uint8_t *bytes = test_glb(context, json, p->bin, p->bin_size, &size);
    alp_result result = read_copy(context, bytes, size);
    alpi_release(context, bytes);
    alpi_release(context, json);
    return result;
}

/// Every number of the JSON in turn becomes one of those that break readers, every member goes
/// missing once.
TEST_WITH_CONTEXT(changed_values, 1)
{
    static const char *const values[] = {
        "-1",  "0",      "1",      "2",     "3",          "7",          "97",
        "255", "5121",   "5125",   "65536", "2147483648", "4294967295", "9007199254740993",
        "1.5", "1e30",   "-1e308", "null",  "true",       "[]",         "{}",
        "'x'", "[0,0,0]"};
    parts p = make_parts(context);
    int numbers = 0, members = 0, accepted = 0;
    for (size_t i = 1; p.json[i] != '\0'; i++) {
        size_t length = strspn(p.json + i, "-.0123456789");
        if (length > 0 && strchr(":[,", p.json[i - 1]) != NULL) {
            for (size_t k = 0; k < sizeof values / sizeof *values; k++) {
                accepted += read_replaced(context, &p, i, length, values[k]) == ALP_OK;
            }
            numbers++;
            i += length;
        } else if (p.json[i] == '\'' && strchr("{,", p.json[i - 1]) != NULL) {
            accepted += read_replaced(context, &p, i + 1, 0, "no_") == ALP_OK;
            members++;
        }
    }
    print_message("%d numbers, %d members, %d changes accepted\n", numbers, members, accepted);
    assert_in_range(numbers, 80, 1000);
    assert_in_range(members, 80, 1000);
    assert_in_range(accepted, 100, numbers * 15);
    alpi_release(context, p.json);
}

TEST_WITH_CONTEXT(cut_files, 1)
{
    size_t size;
    uint8_t *good = make_asset(context, &size);
    for (size_t cut = 0; cut < size; cut++) {
        assert_int_not_equal(read_copy(context, good, cut), ALP_OK);
        // with a header that admits it, so that the cut is found further in
        uint8_t *bad = alpi_allocate(context, size, 1);
        memcpy(bad, good, size);
        for (size_t k = 0; k < 4; k++) {
            bad[8 + k] = (uint8_t)(cut >> (8 * k));
        }
        (void)!read_copy(context, bad, cut);
        alpi_release(context, bad);
    }
    alpi_release(context, good);
}

/// Every allocation of ours fails once; the sanitizer build sees what is not given back.
TEST(failing_allocations)
{
    alp_context *plain = test_context(1);
    size_t size;
    uint8_t *good = make_asset(plain, &size);
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    int allowed = 0;
    for (; result != ALP_OK; allowed++) {
        int left = 0;
        alp_context *context = test_context_failing(&left);
        uint8_t *copy = alpi_allocate(context, size, 1);
        memcpy(copy, good, size);
        left = allowed;
        alpi_gltf_document *document = NULL;
        alp_scene *scene = NULL;
        result = alpi_gltf_document_parse(context, "x.glb", copy, size, &document);
        result = result == ALP_OK ? alpi_gltf_scene_from_document(document, &scene) : result;
        assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
        assert_int_equal(result == ALP_OK, scene != NULL);
        alp_scene_destroy(scene);
        alp_context_destroy(context);
    }
    print_message("%d allocations failed in turn\n", allowed - 1);
    assert_in_range(allowed, 40, 10000);
    alpi_release(plain, good);
    alp_context_destroy(plain);
}

/// The same for the image inside, which is decoded from bytes of its own.
TEST_WITH_CONTEXT(changed_image, 1)
{
    alp_image *image = NULL;
    uint8_t *png = NULL;
    size_t size = 0;
    ASSERT_OK(context,
              alp_image_create(context, (alp_image_info){9, 7, 3, ALP_COMPONENT_U8}, &image));
    ASSERT_OK(context, alpi_png_encode(image, &png, &size));
    alp_image_destroy(image);
    uint8_t *bad = alpi_allocate(context, size, 1);
    uint64_t seed = 2;
    for (int round = 0; round < ROUNDS; round++) {
        memcpy(bad, png, size);
        mutate(bad, size, &seed);
        size_t length = round % 2 == 0 ? size : next_random(&seed) % size;
        image = NULL;
        (void)!alpi_image_decode(context, "mutated.png", bad, length, &image);
        alp_image_destroy(image);
    }
    alpi_release(context, bad);
    alpi_release(context, png);
}
