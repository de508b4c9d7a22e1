// SPDX-License-Identifier: MIT
// Files that a writer makes, as a list: a baked scene and what lies beside it. All writers collect
// the bytes first, so that all files of a bake are put in their places together.
#ifndef ALPI_FORMATS_OUTPUT_FILES_H
#define ALPI_FORMATS_OUTPUT_FILES_H

#include "base/file_set.h"

typedef struct alpi_output_file {
    char *path;
    const uint8_t *bytes;
    size_t size;
    uint8_t *owned; // released with the list, or NULL
} alpi_output_file;
typedef struct alpi_output_files {
    alp_context *context;
    alpi_output_file *items;
    size_t count, capacity;
    bool silent; // warns when files are written, not when places are checked
} alpi_output_files;

/// Takes over path and owned, also on failure.
alp_result alpi_output_files_add(alpi_output_files *files, alpi_output_file file);
/// Copies a file that the document refers to. Adds nothing if the list has that path, or if the
/// file exists with these bytes. Takes over path and bytes.
alp_result alpi_output_files_add_copy(alpi_output_files *files, char *path, uint8_t *bytes,
                                      size_t size);
/// Makes the folders of all files.
alp_result alpi_output_files_make_folders(const alpi_output_files *files);
/// Whether two folders ("" or "dir/") are the same one.
bool alpi_same_folder(const char *a, const char *b);
void alpi_output_files_destroy(alpi_output_files *files);
/// Writes all files, as members of a set.
alp_result alpi_output_files_add_to(const alpi_output_files *files, alpi_file_set *set);

/// Images that a bake adds to a file.
typedef struct alpi_output_images {
    uint32_t occlusion, packed, light;
    const char *light_ending; // ".png"; NULL without light
    bool light_is_beside;     // a .glb too has them as files beside it
} alpi_output_images;

#endif
