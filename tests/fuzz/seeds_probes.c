// SPDX-License-Identifier: MIT
// Small volumes of probes, and textures of half floats.
#include "seeds.h"

#include "base/file.h"
#include "base/memory.h"
#include "formats/formats.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void check(alp_context *context, alp_result result)
{
    if (result != ALP_OK) {
        seed_fail(alp_context_message(context));
    }
}

static alpi_probe_volume make_volume(alp_context *context, alpi_probe_basis basis, bool is_list,
                                     bool all)
{
    alpi_probe_volume v = {.is_list = is_list,
                           .count = 4,
                           .size = {is_list ? 4 : 2, is_list ? 1 : 2, 1},
                           .basis = basis,
                           .layer_count = all,
                           .reach = 2.0f};
    for (int k = 0; k < 3; k++) {
        v.spacing[k] = is_list ? 0.0f : 0.5f;
    }
    check(context, alpi_probe_volume_allocate(context, all, all, &v));
    for (uint32_t i = 0; i < v.count * v.coefficient_count * 3; i++) {
        v.coefficients[i] = (float)i / 8.0f;
    }
    for (uint32_t i = 0; i < v.count; i++) {
        v.states[i] = (uint8_t)i;
    }
    if (all) {
        v.layers[0].name = alpi_copy_string(context, "lamp");
        v.options = alpi_copy_string(context, "{\"rays\":8}");
    }
    return v;
}

static void put_volume(alp_context *context, const char *folder, const char *name,
                       alpi_probe_volume v)
{
    static const char *const endings[3] = {"json", "ktx2", "moments.ktx2"};
    char paths[3][256];
    uint8_t *parts[3] = {NULL}, *joined = NULL;
    size_t sizes[3] = {0}, at = 0;
    for (int i = 0; i < 3; i++) {
        snprintf(paths[i], sizeof paths[i], "%s/%s.%s", folder, name, endings[i]);
    }
    check(context, alpi_probes_save(&v, paths[0], true));
    for (int i = 0; i < (v.moments != NULL ? 3 : 2); i++) {
        check(context, alpi_file_read(context, paths[i], 1 << 20, &parts[i], &sizes[i]));
        unlink(paths[i]);
    }
    joined = ALPI_NEW(context, uint8_t, sizes[0] + 5 + sizes[1] + sizes[2]);
    for (int i = 0; i < 3 && joined != NULL; i++) {
        if (parts[i] != NULL) {
            memcpy(joined + at, parts[i], sizes[i]);
        }
        at += sizes[i];
        if (i == 0) { // a zero and the size of the next
            joined[at + 1] = (uint8_t)sizes[1];
            joined[at + 2] = (uint8_t)(sizes[1] >> 8);
            at += 5;
        }
        alpi_release(context, parts[i]);
    }
    seed_put("probes", name, joined, at);
    alpi_release(context, joined);
    alpi_probe_volume_destroy(&v);
}

static void put_texture(alp_context *context, const char *name, uint32_t depth, uint32_t channels,
                        bool zstandard)
{
    uint8_t texels[2 * 3 * 2 * 4 * 2] = {0}, *bytes = NULL;
    size_t size = 0;
    const alpi_half_texture t = {
        .width = 2, .height = 3, .depth = depth, .channels = channels, .texels = texels};
    check(context, alpi_ktx2_write(context, &t, zstandard, &bytes, &size));
    seed_put("ktx2", name, bytes, size);
    alpi_release(context, bytes);
}

void seeds_probes(alp_context *context)
{
    char folder[] = "/tmp/fuzz-seeds-XXXXXX";
    if (mkdtemp(folder) == NULL) {
        seed_fail(folder);
    }
    put_volume(context, folder, "grid", make_volume(context, ALPI_PROBE_SH9, false, false));
    put_volume(context, folder, "all", make_volume(context, ALPI_PROBE_SH4, false, true));
    put_volume(context, folder, "list", make_volume(context, ALPI_PROBE_SH4, true, false));
    put_volume(context, folder, "list_all",
               make_volume(context, ALPI_PROBE_AMBIENT_CUBE, true, true));
    rmdir(folder);
    put_texture(context, "flat.ktx2", 0, 4, true);
    put_texture(context, "deep.ktx2", 2, 4, false);
    put_texture(context, "pairs.ktx2", 2, 2, true);
}
