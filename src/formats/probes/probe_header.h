// SPDX-License-Identifier: MIT
// The JSON of a file of probes, parsed and checked.
#ifndef ALPI_FORMATS_PROBE_HEADER_H
#define ALPI_FORMATS_PROBE_HEADER_H

#include "scene/probe_volume.h"

#define ALPI_PROBE_FORMAT "alpenglow-probes"
enum { ALPI_PROBE_VERSION = 1 };
#define ALPI_PROBE_JSON_LIMIT ((uint64_t)256 << 20) // bytes

/// Control characters, which must not reach terminals.
#define ALPI_PROBE_CONTROLS                                                                        \
    "\x01\x02\x03\x04\x05\x06\x07\x08\x09\x0a\x0b\x0c\x0d\x0e\x0f\x10"                             \
    "\x11\x12\x13\x14\x15\x16\x17\x18\x19\x1a\x1b\x1c\x1d\x1e\x1f\x7f"

/// Names of values of alpi_probe_basis and of what coefficients of each are.
extern const char *const alpi_probe_basis_names[3], *const alpi_probe_quantities[3];

/// A texture that the JSON names.
typedef struct alpi_probe_texture {
    const char *file; // a plain name; lives as long as the header
    uint64_t bytes, hash;
} alpi_probe_texture;

typedef struct alpi_probe_header {
    alp_context *context;
    const char *name;         // of the file, for messages
    struct json_t *root;      // owned
    alpi_probe_volume volume; // without arrays
    bool gradients, moments;
    double scale;
    alpi_probe_texture coefficient_texture, moment_texture;
} alpi_probe_header;

/// Parses and checks all but the arrays. @param name, text live as long as the header
alp_result alpi_probe_header_parse(alp_context *context, const char *name, const char *text,
                                   size_t size, alpi_probe_header *header);
/// Allocates the volume, and fills places, names of layers and options.
alp_result alpi_probe_header_fill(const alpi_probe_header *header, const char *text, size_t size,
                                  alpi_probe_volume *volume);
void alpi_probe_header_destroy(alpi_probe_header *header);

#endif
