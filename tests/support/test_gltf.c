// SPDX-License-Identifier: MIT
#include "test_gltf.h"

#include "base/memory.h"
#include "formats/gltf/gltf_read.h"

static uint8_t *put_u32(uint8_t *place, size_t value)
{
    for (int i = 0; i < 4; i++) {
        place[i] = (uint8_t)(value >> (8 * i));
    }
    return place + 4;
}

static uint8_t *put_chunk(uint8_t *place, uint32_t type, const void *bytes, size_t size,
                          char padding)
{
    size_t padded = (size + 3) / 4 * 4;
    place = put_u32(put_u32(place, padded), type);
    memset(place, padding, padded);
    memcpy(place, bytes, size);
    return place + padded;
}

uint8_t *test_glb(alp_context *context, const char *json, const void *bin, size_t bin_size,
                  size_t *size)
{
    size_t length = strlen(json);
    uint8_t *bytes = alpi_allocate(context, 12 + 8 + length + 4 + 8 + bin_size + 4, 1);
    char *text = alpi_copy_string(context, json);
    assert_non_null(bytes);
    assert_non_null(text);
    for (char *c = text; *c != '\0'; c++) {
        *c = *c == '\'' ? '"' : *c;
    }
    uint8_t *end = put_chunk(bytes + 12, 0x4E4F534A /* JSON */, text, length, ' ');
    end = bin_size > 0 ? put_chunk(end, 0x004E4942 /* BIN */, bin, bin_size, '\0') : end;
    *size = (size_t)(end - bytes);
    put_u32(put_u32(put_u32(bytes, 0x46546C67 /* glTF */), 2), *size);
    alpi_release(context, text);
    return bytes;
}

alp_result test_gltf_document(alp_context *context, const char *json, const void *bin,
                              size_t bin_size, alpi_gltf_document **document)
{
    size_t size;
    uint8_t *bytes = test_glb(context, json, bin, bin_size, &size);
    return alpi_gltf_document_parse(context, "test.glb", bytes, size, document);
}

alp_result test_gltf_scene(alp_context *context, const char *json, const void *bin, size_t bin_size,
                           alp_scene **scene)
{
    alpi_gltf_document *document = NULL;
    *scene = NULL;
    alp_result result = test_gltf_document(context, json, bin, bin_size, &document);
    return result == ALP_OK ? alpi_gltf_scene_from_document(document, scene) : result;
}

void test_message_has(const alp_context *context, const char *words)
{
    if (strstr(alp_context_message(context), words) == NULL) {
        fail_msg("the message is \"%s\", without \"%s\"", alp_context_message(context), words);
    }
}
