// SPDX-License-Identifier: MIT
// Fuzz target: COLLADA text. What can be read is written with a map and read again.
#include "fuzz.h"

#include "formats/collada/collada_read.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_run run = fuzz_begin(size);
    uint8_t *bytes = fuzz_owned(&run, data, size, 1);
    alpi_collada_document *document = NULL;
    alp_scene *scene = NULL;
    alp_result result =
        alpi_collada_document_parse(run.context, "absent/fuzz.dae", bytes, size, &document);
    fuzz_result(&run, result, document);
    if (document != NULL) {
        result = alpi_collada_scene_from_document(document, &scene);
        fuzz_scene(&run, result, scene);
        fuzz_peak(&run);
    }
    if (scene != NULL) {
        fuzz_write_back(&run, scene, size % 4 == 0 ? "out.glb" : "out.dae");
    }
    alp_scene_destroy(scene);
    fuzz_end(&run);
    return 0;
}
