// SPDX-License-Identifier: MIT
// The format of the maps in the maps folder.
#ifndef ALPI_BAKE_MAP_FILES_H
#define ALPI_BAKE_MAP_FILES_H

#include "bake/job.h"

/// Ending of the maps that are no PNGs: ".exr" …
const char *alpi_bake_map_ending(const alp_bake_options *options);

/// An encoded file of the maps folder.
typedef struct alpi_map_file {
    uint8_t *bytes; // the caller releases them
    size_t size;
} alpi_map_file;
/// Encodes a page of a map, a float image of four channels, and notes where it was scaled.
/// @param name of the map, for the note
alp_result alpi_bake_encode_map(const alpi_bake_job *job, const alp_image *image, const char *name,
                                uint32_t page, alpi_map_file *file);

#endif
