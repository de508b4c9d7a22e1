// SPDX-License-Identifier: MIT
// A good asset with bytes changed or cut off, a few thousand times: whatever the reader says, it
// must not crash (the sanitizer builds look closer). The mutations are the same in every run.
#include "test_gltf.h"

#include "base/memory.h"
#include "formats/formats.h"
#include "formats/gltf_read.h"

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

static uint8_t *make_asset(alp_context *context, size_t *size)
{
    alp_image *image = NULL;
    uint8_t *png = NULL;
    size_t png_size = 0;
    ASSERT_OK(context,
              alp_image_create(context, (alp_image_info){4, 4, 4, ALP_COMPONENT_U8}, &image));
    ASSERT_OK(context, alpi_png_encode(image, &png, &png_size));
    alp_image_destroy(image);
    uint8_t bin[4096] = {0};
    for (uint32_t i = 0; i < 4; i++) {
        float position[3] = {(float)(i % 2), (float)(i / 2), 0.0f};
        memcpy(bin + (size_t)20 * i, position, sizeof position);
        bin[20 * i + 14] = 127;
    }
    memcpy(bin + 80, ((uint8_t[]){0, 1, 2, 2, 1, 3, 0, 0, 2, 0, 0, 0, 9, 9, 9, 255}), 16);
    assert_in_range(png_size, 1, sizeof bin - 96);
    memcpy(bin + 96, png, png_size);
    alpi_release(context, png);
    char *json = alpi_format(context, "%s%zu}],'buffers':[{'byteLength':%zu}]}", asset, png_size,
                             96 + png_size);
    uint8_t *bytes = test_glb(context, json, bin, 96 + png_size, size);
    alpi_release(context, json);
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

static void changed_bytes(void **state)
{
    (void)state;
    alp_context *context = test_context(1);
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
    alp_context_destroy(context);
}

static void cut_files(void **state)
{
    (void)state;
    alp_context *context = test_context(1);
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
    alp_context_destroy(context);
}

/// The same for the image inside, which is decoded from bytes of its own.
static void changed_image(void **state)
{
    (void)state;
    alp_context *context = test_context(1);
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
    alp_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(changed_bytes),
        cmocka_unit_test(cut_files),
        cmocka_unit_test(changed_image),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
