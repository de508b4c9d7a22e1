// SPDX-License-Identifier: MIT
// Fuzz target: OBJ, and behind a zero byte the text of the material library a.mtl.
// What can be read is written as glTF or OBJ and read again.
#include "fuzz.h"

#include "formats/obj/obj.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Writes the library where it is another than the last.
static void put_library(const char *folder, const uint8_t *text, size_t size)
{
    enum { KEPT = 1 << 16 };
    static uint8_t kept[KEPT];
    static size_t kept_size;
    if (size == kept_size && (size == 0 || memcmp(kept, text, size) == 0)) {
        return;
    }
    char path[320];
    snprintf(path, sizeof path, "%s/a.mtl", folder);
    FILE *file = fopen(path, "wb");
    if (file == NULL || fwrite(text, 1, size, file) != size || fclose(file) != 0) {
        fuzz_abort("cannot write %s", path);
    }
    kept_size = size <= KEPT ? size : 0;
    if (kept_size > 0) {
        memcpy(kept, text, kept_size);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[320];
    const uint8_t *zero = size > 0 ? memchr(data, 0, size) : NULL;
    const size_t length = zero != NULL ? (size_t)(zero - data) : size;
    const size_t skip = zero != NULL ? length + 1 : length;
    put_library(fuzz_folder(), size > skip ? data + skip : (const uint8_t *)"", size - skip);
    snprintf(path, sizeof path, "%s/fuzz.obj", fuzz_folder());
    fuzz_run run = fuzz_begin(size);
    uint8_t *bytes = fuzz_copy(data, length);
    alp_scene *scene = NULL;
    alp_result result = alpi_obj_scene_from_bytes(run.context, path, bytes, length, &scene);
    fuzz_scene(&run, result, scene);
    fuzz_peak(&run);
    if (scene != NULL && scene->usable_count > 0) {
        fuzz_write_back(&run, scene, size % 2 == 0 ? "out.glb" : "out.obj");
    }
    alp_scene_destroy(scene);
    free(bytes);
    fuzz_end(&run);
    return 0;
}
