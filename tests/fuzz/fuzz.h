// SPDX-License-Identifier: MIT
// What fuzz targets share. A target is one reader: LLVMFuzzerTestOneInput takes any bytes, reads
// them between fuzz_begin and fuzz_end, and shows what came of it to fuzz_scene or fuzz_image.
// What must hold is checked here, and abort() tells the fuzzer where it does not:
//
//   a failure has a message, and leaves nothing; a success leaves finite, indexed geometry;
//   memory at its highest is at most 4 × decoded + 64 MiB (fuzz_decoded says what counts);
//   nothing is left behind (LeakSanitizer).
#ifndef FUZZ_H
#define FUZZ_H

#include "base/image.h"
#include "scene/scene.h"

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

/// Every target's entry; libFuzzer or driver.c calls it.
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

typedef struct fuzz_run {
    alp_context *context;
    uint64_t decoded;
    uint64_t before; // bytes that were allocated before it began
    bool checked;
} fuzz_run;

/// A run over an input of that many bytes, which count as decoded.
fuzz_run fuzz_begin(size_t size);
/// Checks the memory until now, before something else begins (such as writing).
void fuzz_peak(fuzz_run *run);
/// Checks the memory, unless that was done, and ends it; all that was made with the context is
/// destroyed before.
void fuzz_end(fuzz_run *run);

/// A copy exactly as long as it is, so that a sanitizer sees a step past it: for readers that
/// borrow bytes; freed by the caller.
uint8_t *fuzz_copy(const uint8_t *data, size_t size);
/// The same for readers that take bytes over. @param zeros bytes of zero behind, which the reader
///        of whole files puts there
uint8_t *fuzz_owned(const fuzz_run *run, const uint8_t *data, size_t size, size_t zeros);

/// Adds to what counts as decoded: the input, text and streams that were inflated, images that were
/// decoded or that a header promised and the file is long enough for, arrays of the scene.
void fuzz_decoded(fuzz_run *run, uint64_t bytes);

/// Bytes of texels that the header of a KTX2 file promises, where the file is long enough for them.
uint64_t fuzz_texture_promise(const uint8_t *bytes, size_t size);

/// Checks what a reader gave; prints it where $FUZZ_TELL is set.
void fuzz_result(const fuzz_run *run, alp_result result, const void *object);
/// The same, and the scene; its geometry and images count as decoded.
void fuzz_scene(fuzz_run *run, alp_result result, const alp_scene *scene);
/// Reads a glTF asset, whose bytes are taken over, and checks what came of it and the memory until
/// now. @return its scene, NULL where it was refused
alp_scene *fuzz_gltf_scene(fuzz_run *run, const char *path, uint8_t *bytes, size_t size);
/// The same of an image, which is destroyed.
void fuzz_image(fuzz_run *run, alp_result result, alp_image *image);

/// Writes the scene with made-up coordinates on two pages as `name` (.glb, .gltf, .dae, .obj),
/// reads that again and compares.
void fuzz_write_back(fuzz_run *run, const alp_scene *scene, const char *name);

/// A folder of this process below $TMPDIR, removed at its end.
const char *fuzz_folder(void);

/// Prints and aborts.
#define fuzz_abort(...) (fuzz_print(__VA_ARGS__), abort())
void fuzz_print(const char *format, ...) ALP_PRINTF(1, 2);

#endif
