// SPDX-License-Identifier: MIT
// Typed members of a glTF object. Absent members keep their default, wrong ones are named errors.
// `owner` names the object for the message, such as "mesh 3".
#ifndef ALPI_FORMATS_GLTF_TREE_H
#define ALPI_FORMATS_GLTF_TREE_H

#include "formats/gltf/gltf_document.h"

enum { ALPI_GLTF_OWNER_SIZE = 96 };

/// INVALID_DATA with "path: owner: fault".
alp_result alpi_gltf_fail(const alpi_gltf_document *document, const char *owner, const char *format,
                          ...) ALP_PRINTF(3, 4);
#ifdef __clang_analyzer__
#define alpi_gltf_fail(...) alpi_failed_with(ALP_ERROR_INVALID_DATA, (alpi_gltf_fail)(__VA_ARGS__))
#endif

/// A non-negative integer, `fallback` when absent.
alp_result alpi_gltf_size_or(const alpi_gltf_document *document, json_t *object, const char *member,
                             const char *owner, size_t fallback, size_t *value);
/// The same, INVALID_DATA when absent.
alp_result alpi_gltf_size(const alpi_gltf_document *document, json_t *object, const char *member,
                          const char *owner, size_t *value);
/// A number; *value stays as it is when absent.
alp_result alpi_gltf_number(const alpi_gltf_document *document, json_t *object, const char *member,
                            const char *owner, double *value);
/// An array of exactly `count` numbers; *values stay as they are when absent.
alp_result alpi_gltf_numbers(const alpi_gltf_document *document, json_t *object, const char *member,
                             const char *owner, size_t count, double *values);
/// How many elements of a kind there are, in words: "there is only 1 mesh". @return text
const char *alpi_gltf_state_count(size_t count, const char *kind, char text[ALPI_GLTF_OWNER_SIZE]);
/// An index that must be there.
alp_result alpi_gltf_needed_index(const alpi_gltf_document *document, json_t *object,
                                  const char *member, const char *kind, const char *owner,
                                  size_t *index);

/// A string, or NULL when absent or something else.
const char *alpi_gltf_text(json_t *object, const char *member);
/// object.extensions[name], or NULL when there is no such object.
json_t *alpi_gltf_extension(json_t *object, const char *name);

/// Replaces control characters by '?': names from a file reach terminals.
void alpi_gltf_clean(char *text);

/// object.name with control characters replaced; "" when there is none. Released by the caller.
char *alpi_gltf_copy_name(alp_context *context, json_t *object);

/// Double to float without overflow: ±FLT_MAX at most.
float alpi_gltf_float(double value);

#endif
