// SPDX-License-Identifier: MIT
// glTF assets made in memory by tests. In the JSON, ' stands for " so that it can be read here.
#ifndef TEST_GLTF_H
#define TEST_GLTF_H

#include "test_support.h"

#include "formats/gltf/gltf_document.h"
#include "scene/scene.h"

/// GLB bytes of the JSON and a BIN chunk (none when bin_size is 0), owned by the context.
uint8_t *test_glb(alp_context *context, const char *json, const void *bin, size_t bin_size,
                  size_t *size);

/// Parses such a GLB as "test.glb".
alp_result test_gltf_document(alp_context *context, const char *json, const void *bin,
                              size_t bin_size, alpi_gltf_document **document);
/// Reads one into a scene.
alp_result test_gltf_scene(alp_context *context, const char *json, const void *bin, size_t bin_size,
                           alp_scene **scene);

/// Fails the test unless the context's message has these words.
void test_message_has(const alp_context *context, const char *words);

#endif
