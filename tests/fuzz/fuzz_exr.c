// SPDX-License-Identifier: MIT
// Fuzz target: OpenEXR.
#include "fuzz.h"

#include "formats/formats.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_run run = fuzz_begin(size);
    uint8_t *bytes = fuzz_copy(data, size);
    alp_image *image = NULL;
    alp_result result = alpi_exr_decode(run.context, "fuzz.exr", bytes, size, &image);
    fuzz_image(&run, result, image);
    free(bytes);
    fuzz_end(&run);
    return 0;
}
