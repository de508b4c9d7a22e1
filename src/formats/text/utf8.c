// SPDX-License-Identifier: MIT
// Text of files that state no encoding (The Unicode Standard 15.0, table 3-7).
#include "formats/text/utf8.h"

#include "base/memory.h"

#include <string.h>

size_t alpi_utf8_length(const uint8_t *at, const uint8_t *end)
{
    const uint8_t lead = at[0];
    const size_t length = lead < 0x80 ? 1 : lead < 0xc2 ? 0 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
    if (length == 1 || length == 0 || lead > 0xf4 || (size_t)(end - at) < length) {
        return length == 1;
    }
    for (size_t k = 1; k < length; k++) {
        if ((at[k] & 0xc0) != 0x80) {
            return 0;
        }
    }
    const bool shorter = (lead == 0xe0 && at[1] < 0xa0) || (lead == 0xf0 && at[1] < 0x90);
    const bool beyond = (lead == 0xed && at[1] > 0x9f) || (lead == 0xf4 && at[1] > 0x8f);
    return shorter || beyond ? 0 : length;
}

void alpi_utf8_print(const char *text, size_t size, char *out, size_t room)
{
    const uint8_t *at = (const uint8_t *)text, *end = at + size;
    while (at < end) {
        const size_t length = alpi_utf8_length(at, end);
        const size_t written = length > 0 ? length : 2;
        if (written >= room) {
            break;
        }
        if (length > 0) {
            memcpy(out, at, length);
        } else {
            out[0] = (char)(0xc0 | *at >> 6);
            out[1] = (char)(0x80 | (*at & 0x3f));
        }
        at += length > 0 ? length : 1;
        out += written;
        room -= written;
    }
    *out = '\0';
}

char *alpi_utf8_copy(alp_context *context, const char *text, size_t size)
{
    const size_t room = 2 * size + 1; // a byte becomes two at most
    char *copy = ALPI_NEW(context, char, room);
    if (copy != NULL) {
        alpi_utf8_print(text, size, copy, room);
    }
    return copy;
}
