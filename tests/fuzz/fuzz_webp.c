// SPDX-License-Identifier: MIT
// Fuzz target: WebP.
#include "fuzz.h"

#include "formats/formats.h"

#include <webp/decode.h>

#include <stdlib.h>

/// Thirty bytes are a picture of 2^28 equal pixels in this format, and rightly so: the largest of
/// them are left out, as a few would take all the time there is.
enum { MOST_PIXELS = 1 << 22 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    int width = 0, height = 0;
    uint8_t *bytes = fuzz_copy(data, size);
    const uint64_t pixels =
        WebPGetInfo(bytes, size, &width, &height) ? (uint64_t)width * (uint64_t)height : 0;
    if (pixels > MOST_PIXELS && pixels <= ALPI_IMAGE_PIXEL_LIMIT) {
        free(bytes);
        return -1; // not for the corpus
    }
    fuzz_run run = fuzz_begin(size);
    alp_image *image = NULL;
    fuzz_decoded(&run, pixels <= MOST_PIXELS ? 4 * pixels : 0);
    alp_result result = alpi_webp_decode(run.context, "fuzz.webp", bytes, size, &image);
    fuzz_image(&run, result, image);
    free(bytes);
    fuzz_end(&run);
    return 0;
}
