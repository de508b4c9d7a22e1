// SPDX-License-Identifier: MIT
// UTF-16 → UTF-8 and back (The Unicode Standard 15.0, section 3.9).
#include "formats/text/utf16.h"

#include "base/memory.h"

static uint32_t unit_at(const uint8_t *bytes, size_t i, bool big)
{
    return (uint32_t)bytes[2 * i + (big ? 0 : 1)] << 8 | bytes[2 * i + (big ? 1 : 0)];
}

static size_t put_utf8(uint8_t *out, uint32_t code)
{
    static const uint8_t first[5] = {0, 0, 0xc0, 0xe0, 0xf0};
    const size_t length = code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
    for (size_t k = length - 1; k > 0; k--) {
        out[k] = (uint8_t)(0x80 | (code & 0x3f));
        code >>= 6;
    }
    out[0] = (uint8_t)(first[length] | code);
    return length;
}

alp_result alpi_utf16_decode(alp_context *context, const uint8_t *bytes, size_t size, bool big,
                             uint8_t **out, size_t *out_size)
{
    const size_t count = size / 2;
    ALPI_TRY_NEW(context, *out, 3 * count + 1); // a pair of units takes four bytes
    size_t at = 0;
    for (size_t i = 0; i < count; i++) {
        uint32_t code = unit_at(bytes, i, big);
        if (code >= 0xd800 && code < 0xdc00 && i + 1 < count) {
            const uint32_t low = unit_at(bytes, i + 1, big);
            if (low >= 0xdc00 && low < 0xe000) {
                code = 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00);
                i++;
            }
        }
        at += put_utf8(*out + at, code); // half a pair stays alone
    }
    *out_size = at;
    return ALP_OK;
}

/// The code at text[*at], which is UTF-8.
static uint32_t take_utf8(const char *text, size_t size, size_t *at)
{
    const uint8_t lead = (uint8_t)text[(*at)++];
    const int more = lead < 0xc0 ? 0 : lead < 0xe0 ? 1 : lead < 0xf0 ? 2 : 3;
    uint32_t code = more == 0 ? lead : lead & (0x3fu >> more);
    for (int k = 0; k < more && *at < size; k++) {
        code = code << 6 | ((uint8_t)text[(*at)++] & 0x3f);
    }
    return code;
}

static void put_unit(uint8_t *out, size_t *at, uint32_t unit, bool big)
{
    out[(*at)++] = (uint8_t)(big ? unit >> 8 : unit);
    out[(*at)++] = (uint8_t)(big ? unit : unit >> 8);
}

alp_result alpi_utf16_encode(alp_context *context, const char *text, size_t size, bool big,
                             uint8_t **out, size_t *out_size)
{
    ALPI_TRY_NEW(context, *out, 2 * size + 2);
    size_t at = 0;
    put_unit(*out, &at, 0xfeff, big);
    for (size_t i = 0; i < size;) {
        const uint32_t code = take_utf8(text, size, &i);
        if (code >= 0x10000) {
            put_unit(*out, &at, 0xd800 + ((code - 0x10000) >> 10), big);
            put_unit(*out, &at, 0xdc00 + ((code - 0x10000) & 0x3ff), big);
        } else {
            put_unit(*out, &at, code, big);
        }
    }
    *out_size = at;
    return ALP_OK;
}
