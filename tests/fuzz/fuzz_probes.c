// SPDX-License-Identifier: MIT
// Fuzz target: files of probes. An input is the JSON, a zero byte, the size of the first texture in
// four bytes, and the two textures. Checksums are not compared, or no change would get past them.
#include "fuzz.h"

#include "base/memory.h"
#include "formats/formats.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static alpi_probe_bytes split(const uint8_t *bytes, size_t size)
{
    alpi_probe_bytes files = {.name = "fuzz.probes.json", .json = bytes, .unchecked = true};
    const uint8_t *zero = size > 0 ? memchr(bytes, 0, size) : NULL;
    files.json_size = zero != NULL ? (size_t)(zero - bytes) : size;
    const size_t head = files.json_size + 5;
    if (zero == NULL || size < head) {
        return files;
    }
    const size_t left = size - head;
    const size_t first = zero[1] | (size_t)zero[2] << 8 | (size_t)zero[3] << 16;
    files.coefficients = bytes + head;
    files.coefficients_size = first < left ? first : left;
    files.moments = files.coefficients + files.coefficients_size;
    files.moments_size = left - files.coefficients_size;
    return files;
}

static void check_values(const char *what, const float *values, size_t count)
{
    for (size_t i = 0; values != NULL && i < count; i++) {
        if (!isfinite(values[i])) {
            fuzz_abort("%s: number %zu is not finite", what, i);
        }
    }
}

static void check_volume(fuzz_run *run, const alpi_probe_volume *v)
{
    const size_t values = (size_t)3 * v->coefficient_count * v->count;
    uint64_t size = sizeof(float) * values * (1 + v->layer_count);
    check_values("light", v->coefficients, values);
    check_values("moves", v->moves[0], (size_t)3 * v->count);
    check_values("gradients", v->gradients != NULL ? v->gradients : NULL, 3 * values);
    check_values("places", v->is_list ? v->places[0] : NULL, (size_t)3 * v->count);
    check_values("moments", v->moments != NULL ? v->moments[0] : NULL, (size_t)128 * v->count);
    for (uint32_t i = 0; i < v->layer_count; i++) {
        check_values("layer", v->layers[i].coefficients, values);
    }
    for (uint32_t i = 0; i < v->count; i++) {
        if (v->states[i] > ALPI_PROBE_INVALID) {
            fuzz_abort("probe %u has state %u", i, v->states[i]);
        }
    }
    size += v->gradients != NULL ? 3 * sizeof(float) * values : 0;
    size += v->moments != NULL ? sizeof(float[128]) * v->count : 0;
    fuzz_decoded(run, size + (uint64_t)v->count * (2 * sizeof(float[3]) + 1));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_run run = fuzz_begin(size);
    uint8_t *bytes = fuzz_copy(data, size);
    const alpi_probe_bytes files = split(bytes, size);
    alpi_probe_volume volume;
    const alp_result result = alpi_probes_decode(run.context, &files, &volume);
    fuzz_result(&run, result, volume.context);
    fuzz_decoded(&run, fuzz_texture_promise(files.coefficients, files.coefficients_size));
    fuzz_decoded(&run, fuzz_texture_promise(files.moments, files.moments_size));
    if (volume.context != NULL) {
        check_volume(&run, &volume);
    }
    alpi_probe_volume_destroy(&volume);
    free(bytes);
    fuzz_end(&run);
    return 0;
}
