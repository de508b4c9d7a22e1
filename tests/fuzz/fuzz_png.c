// SPDX-License-Identifier: MIT
// Fuzz target: PNG. libpng refuses a chunk whose checksum is wrong, and nearly every change makes
// one so: they are set right first, in seven of eight inputs.
#include "fuzz.h"

#include "formats/formats.h"

#include <stdlib.h>
#include <zlib.h>

enum { SIGNATURE = 8, AROUND = 12 }; // length, kind and checksum of a chunk

static uint32_t read_u32(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

static void mend_checksums(uint8_t *bytes, size_t size)
{
    for (size_t at = SIGNATURE; size >= AROUND && at <= size - AROUND;) {
        const size_t length = read_u32(bytes + at);
        if (length > size - AROUND - at) {
            return;
        }
        const unsigned long sum = crc32(0, bytes + at + 4, (unsigned)length + 4);
        for (size_t i = 0; i < 4; i++) {
            bytes[at + 8 + length + i] = (uint8_t)(sum >> (24 - 8 * i));
        }
        at += AROUND + length;
    }
}

/// Bytes of the pixels that the header promises, where the file could be long enough for them.
static uint64_t promised(const uint8_t *bytes, size_t size)
{
    static const uint8_t channels[] = {1, 0, 3, 1, 2, 0, 4};
    if (size < 33 || bytes[25] >= sizeof channels) {
        return 0;
    }
    const uint64_t pixels = (uint64_t)read_u32(bytes + 16) * read_u32(bytes + 20);
    const uint64_t bits = (uint64_t)bytes[24] * channels[bytes[25]];
    const bool possible = pixels <= ALPI_IMAGE_PIXEL_LIMIT && pixels * bits / 8 / 1032 <= size;
    return possible ? 4 * pixels : 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_run run = fuzz_begin(size);
    uint8_t *bytes = fuzz_copy(data, size);
    if (size % 8 != 0) {
        mend_checksums(bytes, size);
    }
    fuzz_decoded(&run, promised(bytes, size));
    alp_image *image = NULL;
    alp_result result = alpi_png_decode(run.context, "fuzz.png", bytes, size, &image);
    fuzz_image(&run, result, image);
    free(bytes);
    fuzz_end(&run);
    return 0;
}
