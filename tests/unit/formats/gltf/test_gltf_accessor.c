// SPDX-License-Identifier: MIT
// Accessors: component types, normalised integers, strides, sparse values; and where bytes come
// from.
#include "test_gltf.h"

#include "base/memory.h"
#include "formats/gltf/gltf_bytes.h"

#include <stdio.h>

#define ASSET "'asset':{'version':'2.0'}"

static char *join(const char *buffer_size, const char *views, const char *accessors)
{
    static char text[4096];
    snprintf(text, sizeof text,
             "{" ASSET ",'buffers':[{'byteLength':%s}],'bufferViews':[%s],'accessors':[%s]}",
             buffer_size, views, accessors);
    return text;
}

static alp_result read_first(alp_context *context, const char *json, const void *bin, size_t size,
                             alpi_gltf_values *values)
{
    alpi_gltf_document *document = NULL;
    ASSERT_OK(context, test_gltf_document(context, json, bin, size, &document));
    alp_result result = alpi_gltf_accessor_read(document, 0, values);
    alpi_gltf_document_destroy(document);
    return result;
}

TEST_WITH_CONTEXT(component_types, 1)
{
    static const uint8_t bin[] = {0x80, 0x7f, 0xff, 0xff, 0x00, 0x80, 0xff, 0x7f,
                                  0x00, 0x00, 0x20, 0xc0, 0x01, 0x02, 0x03, 0x04};
    static const struct {
        int type, offset;
        const char *normalized;
        double expected[2];
    } cases[] = {
        {5120, 0, "false", {-128, 127}},
        {5120, 0, "true", {-1, 1}},
        {5121, 0, "false", {128, 127}},
        {5121, 0, "true", {128.0 / 255, 127.0 / 255}},
        {5122, 4, "false", {-32768, 32767}},
        {5122, 4, "true", {-1, 1}},
        {5123, 4, "false", {32768, 32767}},
        {5123, 4, "true", {32768.0 / 65535, 32767.0 / 65535}},
        {5125, 8, "false", {3223322624.0, 67305985}},
        {5126, 8, "false", {-2.5, 1.5399896e-36}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char accessor[200];
        snprintf(accessor, sizeof accessor,
                 "{'bufferView':0,'byteOffset':%d,'componentType':%d,'normalized':%s,"
                 "'type':'SCALAR','count':2}",
                 cases[i].offset, cases[i].type, cases[i].normalized);
        alpi_gltf_values values;
        ASSERT_OK(context, read_first(context, join("16", "{'buffer':0,'byteLength':16}", accessor),
                                      bin, sizeof bin, &values));
        for (uint32_t k = 0; k < 2; k++) {
            double expected = cases[i].expected[k];
            ASSERT_NEAR(alpi_gltf_values_float(&values, k, 0), expected, 1e-6 * fabs(expected));
        }
        alpi_release(context, values.bytes);
    }
}

TEST_WITH_CONTEXT(strides_and_offsets, 1)
{
    uint8_t bin[40] = {0};
    for (uint8_t i = 0; i < 40; i++) {
        bin[i] = i;
    }
    alpi_gltf_values values;
    ASSERT_OK(context,
              read_first(context,
                         join("40", "{'buffer':0,'byteOffset':4,'byteLength':36,'byteStride':12}",
                              "{'bufferView':0,'byteOffset':1,'componentType':5121,"
                              "'type':'VEC3','count':3}"),
                         bin, sizeof bin, &values));
    assert_int_equal(values.count, 3);
    assert_int_equal(values.components, 3);
    static const uint8_t expected[] = {5, 6, 7, 17, 18, 19, 29, 30, 31};
    assert_memory_equal(values.bytes, expected, sizeof expected);
    alpi_release(context, values.bytes);
}

#define SPARSE                                                                                     \
    "'sparse':{'count':2,'indices':{'bufferView':0,'componentType':5123},"                         \
    "'values':{'bufferView':0,'byteOffset':4}}"

TEST_WITH_CONTEXT(sparse_values, 1)
{
    // indices 1 and 3; values 70 and 80; then the base 1 2 3 4
    static const uint8_t bin[] = {1, 0, 3, 0, 70, 80, 0, 0, 1, 2, 3, 4};
    alpi_gltf_values values;
    ASSERT_OK(context, read_first(context,
                                  join("12", "{'buffer':0,'byteLength':12}",
                                       "{'bufferView':0,'byteOffset':8,'componentType':5121,"
                                       "'type':'SCALAR','count':4," SPARSE "}"),
                                  bin, sizeof bin, &values));
    assert_memory_equal(values.bytes, ((uint8_t[]){1, 70, 3, 80}), 4);
    alpi_release(context, values.bytes);
    // without a base: zeros
    ASSERT_OK(context,
              read_first(context,
                         join("12", "{'buffer':0,'byteLength':12}",
                              "{'componentType':5121,'type':'SCALAR','count':5," SPARSE "}"),
                         bin, sizeof bin, &values));
    assert_memory_equal(values.bytes, ((uint8_t[]){0, 70, 0, 80, 0}), 5);
    alpi_release(context, values.bytes);
    // index 3 of 3 elements
    assert_int_equal(read_first(context,
                                join("12", "{'buffer':0,'byteLength':12}",
                                     "{'componentType':5121,'type':'SCALAR','count':3," SPARSE "}"),
                                bin, sizeof bin, &values),
                     ALP_ERROR_INVALID_DATA);
    test_message_has(context, "accessor 0: sparse index 1 is 3 of 3");
}

TEST_WITH_CONTEXT(bad_accessors, 1)
{
    static const struct {
        const char *view, *accessor, *words;
        alp_result code;
    } cases[] = {
        {"{'buffer':0,'byteLength':16}",
         "{'bufferView':0,'componentType':5126,'type':'VEC3','count':2}",
         "accessor 0: 2 elements of 12 bytes", ALP_ERROR_INVALID_DATA},
        {"{'buffer':0,'byteLength':16}",
         "{'bufferView':0,'componentType':5126,'type':'VEC3','count':4294967294}",
         "do not fit into bufferView 0", ALP_ERROR_INVALID_DATA},
        {"{'buffer':0,'byteLength':16}",
         "{'bufferView':0,'byteOffset':9007199254740992,'componentType':5126,'type':'VEC3',"
         "'count':1}",
         "do not fit into bufferView 0", ALP_ERROR_INVALID_DATA},
        {"{'buffer':0,'byteLength':16,'byteStride':8}",
         "{'bufferView':0,'componentType':5126,'type':'VEC3','count':1}",
         "byteStride 8, less than an element (12 bytes)", ALP_ERROR_INVALID_DATA},
        {"{'buffer':0,'byteOffset':8,'byteLength':16}",
         "{'bufferView':0,'componentType':5126,'type':'SCALAR','count':1}",
         "bufferView 0: byteOffset 8 + byteLength 16 pass the end of buffer 0",
         ALP_ERROR_INVALID_DATA},
        {"{'buffer':0,'byteLength':16}",
         "{'bufferView':0,'componentType':5124,'type':'SCALAR','count':1}", "componentType 5124",
         ALP_ERROR_INVALID_DATA},
        {"{'buffer':0,'byteLength':16}",
         "{'bufferView':0,'componentType':5126,'type':'MAT4','count':1}", "type \"MAT4\"",
         ALP_ERROR_INVALID_DATA},
        {"{'buffer':0,'byteLength':16}",
         "{'bufferView':0,'componentType':5126,'type':'SCALAR','count':-1}",
         "count must be a non-negative integer", ALP_ERROR_INVALID_DATA},
        {"{'buffer':0,'byteLength':16}",
         "{'bufferView':0,'componentType':5126,'type':'SCALAR','count':1.5}",
         "count must be a non-negative integer", ALP_ERROR_INVALID_DATA},
        {"{'buffer':0,'byteLength':16}", "{'componentType':5126,'type':'VEC4','count':4000000000}",
         "4000000000 elements without a bufferView", ALP_ERROR_LIMIT},
    };
    static const uint8_t bin[16] = {0};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alpi_gltf_values values;
        assert_int_equal(read_first(context, join("16", cases[i].view, cases[i].accessor), bin,
                                    sizeof bin, &values),
                         cases[i].code);
        test_message_has(context, cases[i].words);
        test_message_has(context, "test.glb: ");
        assert_null(values.bytes);
    }
}

/// Reads a uri as buffer 0 of an asset in `folder`.
static alp_result read_uri(alp_context *context, const char *folder, const char *uri,
                           alpi_gltf_document **document)
{
    char json[1024];
    snprintf(json, sizeof json, "{" ASSET ",'buffers':[{'byteLength':5,'uri':'%s'}]}", uri);
    for (char *c = json; *c != '\0'; c++) {
        *c = *c == '\'' ? '"' : *c;
    }
    uint8_t *bytes = (uint8_t *)alpi_copy_string(context, json);
    return alpi_gltf_document_parse(context, test_path(folder, "asset.gltf"), bytes, strlen(json),
                                    document);
}

TEST_WITH_CONTEXT(uris, 1)
{
    const char *folder = test_folder();
    FILE *file = fopen(test_path(folder, "a b.bin"), "wb");
    fputs("hello", file);
    fclose(file);
    static const char *const good[] = {"data:;base64,aGVsbG8=",
                                       "data:application/octet-stream;base64,aGVsbG8",
                                       "DATA:x;BASE64,aGVsbG8=",
                                       "a%20b.bin",
                                       "a b.bin",
                                       "./a%20b.bin"};
    static const struct {
        const char *uri, *words;
        alp_result code;
    } bad[] = {
        {"../a b.bin", "leaves the asset's folder", ALP_ERROR_INVALID_DATA},
        {"%2e%2E/a b.bin", "leaves the asset's folder", ALP_ERROR_INVALID_DATA},
        {"x/..%2fa b.bin", "leaves the asset's folder", ALP_ERROR_INVALID_DATA},
        {"x\\\\..\\\\a b.bin", "leaves the asset's folder", ALP_ERROR_INVALID_DATA},
        {"%2Fetc/hostname", "leaves the asset's folder", ALP_ERROR_INVALID_DATA},
        {"/etc/hostname", "leaves the asset's folder", ALP_ERROR_INVALID_DATA},
        {"a%20b.bin%00.png", "leaves the asset's folder", ALP_ERROR_INVALID_DATA},
        {"", "leaves the asset's folder", ALP_ERROR_INVALID_DATA},
        {"file:///etc/hostname", "has a scheme", ALP_ERROR_UNSUPPORTED},
        {"http://localhost/a.bin", "has a scheme", ALP_ERROR_UNSUPPORTED},
        {"absent.bin", "buffer 0: ", ALP_ERROR_IO},
        {".", "is a folder", ALP_ERROR_IO},
        {"data:;base64,aGV$bG8=", "not valid base64", ALP_ERROR_INVALID_DATA},
        {"data:;base64,aGVsb", "not valid base64", ALP_ERROR_INVALID_DATA},
        {"data:;base64,aGVs=G8=", "not valid base64", ALP_ERROR_INVALID_DATA},
        {"data:;base64,aGVs", "byteLength is 5, but there are only 3", ALP_ERROR_INVALID_DATA},
        {"data:text/plain,hello", "does not say ;base64", ALP_ERROR_INVALID_DATA},
    };
    alpi_gltf_document *document;
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        ASSERT_OK(context, read_uri(context, folder, good[i], &document));
        assert_int_equal(document->buffers[0].size, 5);
        assert_memory_equal(document->buffers[0].bytes, "hello", 5);
        alpi_gltf_document_destroy(document);
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(read_uri(context, folder, bad[i].uri, &document), bad[i].code);
        assert_null(document);
        test_message_has(context, bad[i].words);
        test_message_has(context, "asset.gltf: ");
    }
}
