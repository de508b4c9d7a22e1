// SPDX-License-Identifier: MIT
// Fuzz target: Radiance pictures.
#include "fuzz.h"

#include "formats/formats.h"

#include <stdlib.h>
#include <string.h>

/// Bytes of the pixels that the header's last line promises, where the file could be long enough:
/// twelve bytes may be a line of 65536 equal ones, and all are there until a later line is bad.
static uint64_t promised(const uint8_t *bytes, size_t size)
{
    char text[128] = "";
    unsigned long long lines = 0, length = 0;
    for (size_t i = 2; i < size; i++) {
        if (bytes[i - 1] != '\n' || (bytes[i] != '\n' && bytes[i] != '\r')) {
            continue;
        }
        const size_t begin = i + (bytes[i] == '\r' ? 2 : 1);
        const size_t rest = size > begin ? size - begin : 0;
        const size_t count = rest < sizeof text - 1 ? rest : sizeof text - 1;
        memcpy(text, bytes + begin, count);
        break;
    }
    char *end = text + strspn(text, "+-XY \t");
    lines = strtoull(end, &end, 10);
    end += strspn(end, "+-XY \t");
    length = strtoull(end, &end, 10);
    const bool possible = lines < size && length <= ALPI_IMAGE_SIDE_LIMIT;
    return possible ? 3 * sizeof(float) * lines * length : 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_run run = fuzz_begin(size);
    uint8_t *bytes = fuzz_copy(data, size);
    alp_image *image = NULL;
    fuzz_decoded(&run, promised(bytes, size));
    alp_result result = alpi_hdr_decode(run.context, "fuzz.hdr", bytes, size, &image);
    fuzz_image(&run, result, image);
    free(bytes);
    fuzz_end(&run);
    return 0;
}
