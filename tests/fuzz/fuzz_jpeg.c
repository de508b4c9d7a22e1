// SPDX-License-Identifier: MIT
// Fuzz target: JPEG.
#include "fuzz.h"

#include "formats/formats.h"

#include <stdlib.h>

/// Memory goes by the size that a header promises, also where the rest is missing. The largest of
/// them are left out: a few would take all the time there is.
enum { MOST_PIXELS = 1 << 22 };

/// The most pixels that a frame header promises; what looks like one counts too.
static uint64_t promised_pixels(const uint8_t *data, size_t size)
{
    uint64_t most = 0;
    for (size_t i = 0; i + 9 < size; i++) {
        const bool is_frame = (data[i + 1] & 0xf0) == 0xc0 && // but tables of Huffman and such
                              data[i + 1] != 0xc4 && data[i + 1] != 0xc8 && data[i + 1] != 0xcc;
        if (data[i] == 0xff && is_frame) {
            const uint64_t height = (uint64_t)data[i + 5] << 8 | data[i + 6];
            const uint64_t width = (uint64_t)data[i + 7] << 8 | data[i + 8];
            most = width * height > most ? width * height : most;
        }
    }
    return most;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const uint64_t pixels = promised_pixels(data, size);
    if (pixels > MOST_PIXELS && pixels <= ALPI_IMAGE_PIXEL_LIMIT) {
        return -1; // not for the corpus
    }
    fuzz_run run = fuzz_begin(size);
    uint8_t *bytes = fuzz_copy(data, size);
    alp_image *image = NULL;
    fuzz_decoded(&run, pixels <= MOST_PIXELS ? 3 * pixels : 0);
    alp_result result = alpi_jpeg_decode(run.context, "fuzz.jpg", bytes, size, &image);
    fuzz_image(&run, result, image);
    free(bytes);
    fuzz_end(&run);
    return 0;
}
