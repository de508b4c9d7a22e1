// SPDX-License-Identifier: MIT
// Fuzz target: glTF text, its buffers and images in data: URIs. What can be read is written with a
// map and read again.
#include "fuzz.h"

#include "formats/gltf_read.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_run run = fuzz_begin(size);
    uint8_t *bytes = fuzz_owned(&run, data, size, 0);
    alpi_gltf_document *document = NULL;
    alp_scene *scene = NULL;
    alp_result result =
        alpi_gltf_document_parse(run.context, "absent/fuzz.gltf", bytes, size, &document);
    fuzz_result(&run, result, document);
    if (document != NULL) {
        fuzz_decoded(&run, document->decoded_size);
        result = alpi_gltf_scene_from_document(document, &scene);
        fuzz_scene(&run, result, scene);
        fuzz_peak(&run);
    }
    if (scene != NULL) {
        fuzz_write_back(&run, scene, "out.gltf");
    }
    alp_scene_destroy(scene);
    fuzz_end(&run);
    return 0;
}
