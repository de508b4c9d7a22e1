// SPDX-License-Identifier: MIT
// Files of baked probes: OUT.probes.json beside OUT.probes.ktx2 and OUT.probes.moments.ktx2.
// docs/manual/probe-format.md states their format.
#ifndef ALPI_FORMATS_PROBE_FORMAT_H
#define ALPI_FORMATS_PROBE_FORMAT_H

#include "base/file_set.h"
#include "scene/probe_volume.h"

/// Writes the two or three files together. Coefficients become half floats over a power of two.
/// @param path ends in ".json"; the others replace that by ".ktx2" and ".moments.ktx2"
/// @return ALP_OK; INVALID_ARGUMENT (another ending, numbers that are not finite, options that are
///         no JSON object); LIMIT; IO; OUT_OF_MEMORY; CANCELLED
alp_result alpi_probes_save(const alpi_probe_volume *volume, const char *path, bool overwrite);
/// The same into a set that the caller commits.
alp_result alpi_probes_add_files(const alpi_probe_volume *volume, const char *path,
                                 alpi_file_set *files);
/// Fails if the files could not be written at the end of a long job.
alp_result alpi_probes_check_outputs(alp_context *context, const char *path, bool moments,
                                     bool overwrite);

/// Reads them. The caller destroys the volume; after a failure it is zeroed.
/// @return ALP_OK; INVALID_DATA; UNSUPPORTED (a newer version, another kind of texture); LIMIT; IO;
///         OUT_OF_MEMORY
alp_result alpi_probes_load(alp_context *context, const char *path, alpi_probe_volume *volume);

/// The same three files in memory.
typedef struct alpi_probe_bytes {
    const char *name; // of the JSON, for messages
    const uint8_t *json, *coefficients, *moments;
    size_t json_size, coefficients_size, moments_size;
    bool unchecked; // sizes and checksums of the textures are not compared
} alpi_probe_bytes;
alp_result alpi_probes_decode(alp_context *context, const alpi_probe_bytes *files,
                              alpi_probe_volume *volume);

#endif
