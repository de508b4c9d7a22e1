// SPDX-License-Identifier: MIT
// Fuzz target: KTX2 textures of half floats. One that was read is written and read again.
#include "fuzz.h"

#include "base/memory.h"
#include "formats/formats.h"

#include <stdlib.h>
#include <string.h>

static void read_again(fuzz_run *run, const alpi_half_texture *texture)
{
    alpi_half_texture again;
    uint8_t *bytes = NULL;
    size_t size = 0;
    if (alpi_ktx2_write(run->context, texture, true, &bytes, &size) != ALP_OK ||
        alpi_ktx2_read(run->context, "again.ktx2", bytes, size, &again) != ALP_OK) {
        fuzz_abort("a texture cannot be written and read: %s", alp_context_message(run->context));
    }
    if (memcmp(texture->texels, again.texels, alpi_half_texture_size(texture)) != 0) {
        fuzz_abort("texels did not come back");
    }
    alpi_release(run->context, bytes);
    alpi_release(run->context, again.texels);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_run run = fuzz_begin(size);
    uint8_t *bytes = fuzz_copy(data, size);
    alpi_half_texture texture;
    const alp_result result = alpi_ktx2_read(run.context, "fuzz.ktx2", bytes, size, &texture);
    fuzz_result(&run, result, texture.texels);
    fuzz_decoded(&run, fuzz_texture_promise(bytes, size));
    fuzz_peak(&run);
    if (texture.texels != NULL && alpi_half_texture_size(&texture) < 1 << 20) {
        read_again(&run, &texture);
    }
    alpi_release(run.context, texture.texels);
    free(bytes);
    fuzz_end(&run);
    return 0;
}
