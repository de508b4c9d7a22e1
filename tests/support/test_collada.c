// SPDX-License-Identifier: MIT
// COLLADA documents made in memory by tests.
#include "test_collada.h"

#include "base/memory.h"
#include "formats/collada/collada_read.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

char *test_collada_text(const char *inside, size_t *size)
{
    static const char begin[] = "<?xml version='1.0' encoding='utf-8'?>\n<COLLADA "
                                "xmlns='http://www.collada.org/2005/11/COLLADASchema' "
                                "version='1.4.1'>",
                      end[] = "</COLLADA>\n";
    *size = strlen(begin) + strlen(inside) + strlen(end);
    char *text = malloc(*size + 1);
    assert_non_null(text);
    snprintf(text, *size + 1, "%s%s%s", begin, inside, end);
    for (char *c = text; *c != '\0'; c++) {
        *c = *c == '\'' ? '"' : *c;
    }
    return text;
}

static uint32_t crc_of(const char *text)
{
    uint32_t crc = UINT32_MAX;
    for (; *text != '\0'; text++) {
        crc ^= (uint8_t)*text;
        for (int bit = 0; bit < 8; bit++) {
            crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xedb88320u : 0); // IEEE 802.3, reflected
        }
    }
    return ~crc;
}

static uint8_t *put(uint8_t *at, uint32_t value, int bytes)
{
    for (int i = 0; i < bytes; i++) {
        *at++ = (uint8_t)(value >> 8 * i);
    }
    return at;
}

/// What a local header (from byte 4) and an entry of the directory (from byte 6) have in common.
static uint8_t *put_entry(uint8_t *at, const char *name, const char *text)
{
    const uint32_t size = (uint32_t)strlen(text);
    at = put(put(at, 20, 2), 0, 2);                      // version, flags
    at = put(put(put(at, 0, 2), 0, 4), crc_of(text), 4); // stored, no time
    at = put(put(at, size, 4), size, 4);
    return put(put(at, (uint32_t)strlen(name), 2), 0, 2);
}

uint8_t *test_collada_zip(const char *const (*files)[2], size_t count, size_t *size)
{
    size_t most = 22;
    for (size_t i = 0; i < count; i++) {
        most += 76 + 2 * strlen(files[i][0]) + strlen(files[i][1]);
    }
    uint8_t *zip = malloc(most), *at = zip;
    uint32_t places[8] = {0};
    assert_true(zip != NULL && count <= 8);
    for (size_t i = 0; i < count; i++) {
        places[i] = (uint32_t)(at - zip);
        at = put_entry(put(at, 0x04034b50, 4), files[i][0], files[i][1]);
        at = (uint8_t *)stpcpy(stpcpy((char *)at, files[i][0]), files[i][1]);
    }
    const uint32_t directory = (uint32_t)(at - zip);
    for (size_t i = 0; i < count; i++) {
        at = put_entry(put(put(at, 0x02014b50, 4), 20, 2), files[i][0], files[i][1]);
        at = put(put(put(put(at, 0, 4), 0, 2), 0, 4), places[i], 4);
        at = (uint8_t *)stpcpy((char *)at, files[i][0]);
    }
    const uint32_t length = (uint32_t)(at - zip) - directory;
    at = put(put(at, 0x06054b50, 4), 0, 4);
    at = put(put(at, (uint32_t)count, 2), (uint32_t)count, 2);
    at = put(put(put(at, length, 4), directory, 4), 0, 2);
    *size = (size_t)(at - zip);
    return zip;
}

alp_result test_collada_bytes(alp_context *context, const void *bytes, size_t size,
                              alp_scene **scene)
{
    // With the zero byte that a read file has, and no more: a sanitizer sees a read past it.
    uint8_t *copy = alpi_allocate(context, size + 1, 1);
    *scene = NULL;
    if (copy == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    memcpy(copy, bytes, size);
    alpi_collada_document *document = NULL;
    alp_result result = alpi_collada_document_parse(context, "test.dae", copy, size, &document);
    return result == ALP_OK ? alpi_collada_scene_from_document(document, scene) : result;
}

alp_result test_collada_scene(alp_context *context, const char *inside, alp_scene **scene)
{
    size_t size;
    char *text = test_collada_text(inside, &size);
    alp_result result = test_collada_bytes(context, text, size, scene);
    free(text);
    return result;
}
