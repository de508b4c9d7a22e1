// SPDX-License-Identifier: MIT
// KTX2 textures of half floats: what is written comes back, and other kinds are refused by name.
#include "test_support.h"

#include "base/memory.h"
#include "formats/formats.h"

TEST_CONTEXT(1);

static alpi_half_texture make_texture(uint32_t depth, uint32_t channels)
{
    alpi_half_texture t = {.width = 5, .height = 3, .depth = depth, .channels = channels};
    const size_t size = alpi_half_texture_size(&t);
    t.texels = ALPI_NEW(context, uint8_t, size);
    assert_non_null(t.texels);
    for (size_t i = 0; i < size; i++) {
        t.texels[i] = (uint8_t)(i * 7 + i / 256);
    }
    return t;
}

static uint64_t number(const uint8_t *bytes, int size)
{
    uint64_t value = 0;
    for (int i = 0; i < size; i++) {
        value |= (uint64_t)bytes[i] << 8 * i;
    }
    return value;
}

TEST(textures_come_back)
{
    for (int kind = 0; kind < 12; kind++) {
        const uint32_t depth = kind % 3 == 2 ? 7 : (uint32_t)kind % 3; // 0, 1, 7
        const bool zstandard = kind / 3 % 2 != 0;
        alpi_half_texture t = make_texture(depth, kind < 6 ? 2 : 4), again;
        uint8_t *bytes = NULL;
        size_t size = 0;
        ASSERT_OK(context, alpi_ktx2_write(context, &t, zstandard, &bytes, &size));
        assert_int_equal(number(bytes + 12, 4), t.channels == 2 ? 83 : 97);
        assert_int_equal(number(bytes + 28, 4), depth);
        assert_int_equal(number(bytes + 44, 4), zstandard ? 2 : 0);
        assert_int_equal(number(bytes + 104, 4), 28 + 16 * t.channels); // descriptor
        assert_int_equal(number(bytes + 124, 8), 2 * t.channels);       // bytes of plane 0
        assert_true(zstandard || number(bytes + 80, 8) % 8 == 0);
        ASSERT_OK(context, alpi_ktx2_read(context, "t.ktx2", bytes, size, &again));
        assert_int_equal(again.width, 5);
        assert_int_equal(again.height, 3);
        assert_int_equal(again.depth, depth);
        assert_int_equal(again.channels, t.channels);
        assert_memory_equal(again.texels, t.texels, alpi_half_texture_size(&t));
        alpi_release(context, bytes);
        alpi_release(context, t.texels);
        alpi_release(context, again.texels);
    }
}

TEST(sizes_that_overflow_are_refused)
{
    const alpi_half_texture huge = {
        .width = UINT32_MAX, .height = UINT32_MAX, .depth = UINT32_MAX, .channels = 4};
    uint8_t *bytes = NULL;
    size_t size = 0;
    assert_int_equal(alpi_half_texture_size(&huge), 0);
    assert_int_equal(alpi_ktx2_write(context, &huge, true, &bytes, &size), ALP_ERROR_LIMIT);
    assert_null(bytes);
}

/// A number of the header is replaced.
typedef struct change {
    int at, size;
    uint64_t value;
    alp_result code;
    const char *word;
} change;

static const change changes[] = {
    {0, 1, 0, ALP_ERROR_INVALID_DATA, "first bytes"},
    {12, 4, 98, ALP_ERROR_UNSUPPORTED, "vkFormat 98"},
    {16, 4, 4, ALP_ERROR_INVALID_DATA, "typeSize"},
    {20, 4, 0, ALP_ERROR_INVALID_DATA, "0 x 3 x 7"},
    {20, 4, 6, ALP_ERROR_INVALID_DATA, "bytes of texels"},
    {24, 4, UINT32_MAX, ALP_ERROR_INVALID_DATA, "bytes of texels"},
    {28, 4, 0, ALP_ERROR_INVALID_DATA, "bytes of texels"},
    {32, 4, 2, ALP_ERROR_UNSUPPORTED, "2 layers"},
    {36, 4, 6, ALP_ERROR_UNSUPPORTED, "6 faces"},
    {40, 4, 3, ALP_ERROR_UNSUPPORTED, "3 levels"},
    {44, 4, 1, ALP_ERROR_UNSUPPORTED, "supercompression 1"},
    {80, 8, UINT64_MAX, ALP_ERROR_INVALID_DATA, "copy it anew"},
    {80, 8, 0, ALP_ERROR_INVALID_DATA, "copy it anew"},
    {88, 8, UINT64_MAX, ALP_ERROR_INVALID_DATA, "copy it anew"},
    {96, 8, 1, ALP_ERROR_INVALID_DATA, "bytes of texels"},
};

TEST(changed_headers_are_refused)
{
    alpi_half_texture t = make_texture(7, 4), again;
    for (int way = 0; way < 2; way++) {
        uint8_t *bytes = NULL;
        size_t size = 0;
        ASSERT_OK(context, alpi_ktx2_write(context, &t, way != 0, &bytes, &size));
        for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
            const change *c = &changes[i];
            uint8_t kept[8];
            memcpy(kept, bytes + c->at, sizeof kept);
            for (int k = 0; k < c->size; k++) {
                bytes[c->at + k] = (uint8_t)(c->value >> 8 * k);
            }
            assert_int_equal(alpi_ktx2_read(context, "t.ktx2", bytes, size, &again), c->code);
            assert_non_null(strstr(alp_context_message(context), c->word));
            assert_null(again.texels);
            memcpy(bytes + c->at, kept, sizeof kept);
        }
        alpi_release(context, bytes);
    }
    alpi_release(context, t.texels);
}

/// 4 KiB that claim 2 GiB: no memory is taken for them.
TEST(small_files_cannot_claim_large_textures)
{
    alpi_half_texture t = make_texture(7, 4), again;
    uint8_t *bytes = NULL;
    size_t size = 0;
    ASSERT_OK(context, alpi_ktx2_write(context, &t, true, &bytes, &size));
    const uint64_t raw = (uint64_t)2048 * 2048 * 64 * 8;
    const struct {
        int at, size;
        uint64_t value;
    } numbers[] = {{20, 4, 2048}, {24, 4, 2048}, {28, 4, 64}, {96, 8, raw}};
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < numbers[i].size; k++) {
            bytes[numbers[i].at + k] = (uint8_t)(numbers[i].value >> 8 * k);
        }
    }
    assert_int_equal(alpi_ktx2_read(context, "t.ktx2", bytes, size, &again),
                     ALP_ERROR_INVALID_DATA);
    assert_non_null(strstr(alp_context_message(context), "cannot hold"));
    alpi_release(context, bytes);
    alpi_release(context, t.texels);
}
