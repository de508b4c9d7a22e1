// SPDX-License-Identifier: MIT
// Fuzz target: COLLADA archives. The checksums and sizes of entries are set right first, in
// seven of eight inputs, as nearly every change makes them wrong.
#include "fuzz.h"

#include "formats/collada/collada_read.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { DIRECTORY_SIZE = 46, LOCAL_SIZE = 30, MOST_INFLATED = 1 << 20 };

static uint32_t read_u16(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8;
}

static uint32_t read_u32(const uint8_t *bytes)
{
    return read_u16(bytes) | read_u16(bytes + 2) << 16;
}

/// The checksum and size of what an entry's packed bytes hold. False: it cannot be told.
static bool examine(const uint8_t *packed, size_t packed_size, bool deflated, uint32_t *sum,
                    uint32_t *size)
{
    static uint8_t out[MOST_INFLATED];
    if (!deflated) {
        *sum = (uint32_t)crc32(0, packed, (unsigned)packed_size);
        *size = (uint32_t)packed_size;
        return true;
    }
    z_stream stream = {.avail_in = (unsigned)packed_size, .next_out = out, .avail_out = sizeof out};
    memcpy(&stream.next_in, &packed, sizeof packed);
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) {
        return false;
    }
    const int state = inflate(&stream, Z_FINISH);
    inflateEnd(&stream);
    *size = (uint32_t)stream.total_out;
    *sum = (uint32_t)crc32(0, out, *size);
    return state == Z_STREAM_END;
}

/// Writes into an entry of the directory the checksum and size that its bytes have.
static void mend_entry(uint8_t *header, const uint8_t *bytes, size_t size)
{
    const size_t local = read_u32(header + 42), packed_size = read_u32(header + 20);
    if (local > size || size - local < LOCAL_SIZE) {
        return;
    }
    const size_t begin =
        local + LOCAL_SIZE + read_u16(bytes + local + 26) + read_u16(bytes + local + 28);
    uint32_t sum, inflated;
    if (begin > size || packed_size > size - begin ||
        !examine(bytes + begin, packed_size, read_u16(header + 10) == 8, &sum, &inflated)) {
        return;
    }
    for (size_t i = 0; i < 4; i++) {
        header[16 + i] = (uint8_t)(sum >> (8 * i));
        header[24 + i] = (uint8_t)(inflated >> (8 * i));
    }
}

static void mend_directory(uint8_t *bytes, size_t size)
{
    for (size_t at = 0; at + DIRECTORY_SIZE <= size; at++) {
        if (memcmp(bytes + at, "PK\1\2", 4) == 0) {
            mend_entry(bytes + at, bytes, size);
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_run run = fuzz_begin(size);
    uint8_t *bytes = fuzz_owned(&run, data, size, 1);
    if (size % 8 != 0) {
        mend_directory(bytes, size);
    }
    alpi_collada_document *document = NULL;
    alp_scene *scene = NULL;
    alp_result result =
        alpi_collada_document_parse(run.context, "absent/fuzz.zae", bytes, size, &document);
    fuzz_result(&run, result, document);
    if (document != NULL) {
        fuzz_decoded(&run, document->text_size);
        result = alpi_collada_scene_from_document(document, &scene);
        fuzz_scene(&run, result, scene);
    }
    alp_scene_destroy(scene);
    fuzz_end(&run);
    return 0;
}
