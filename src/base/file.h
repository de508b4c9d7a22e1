// SPDX-License-Identifier: MIT
// Whole files in, whole files out. A file is written beside its final place and renamed, so that
// nobody ever sees half of it.
#ifndef ALPI_BASE_FILE_H
#define ALPI_BASE_FILE_H

#include "base/context.h"

/// Reads all of a regular file. *bytes is released by the caller and has one zero byte after its
/// end.
/// @param limit most bytes accepted
/// @return ALP_OK; IO (missing, a folder, unreadable, shrank); LIMIT; OUT_OF_MEMORY
alp_result alpi_file_read(alp_context *context, const char *path, uint64_t limit, uint8_t **bytes,
                          size_t *size);

/// A file being written. Bytes go to "PATH.part-PID-N" in the same folder (of a long name its
/// beginning). Where PATH is a link,
/// PATH is what it names in the end, which need not be there: the link stays.
typedef struct alpi_file_writer {
    alp_context *context;
    char *path, *temporary;
    int descriptor;
    bool overwrite;
} alpi_file_writer;

/// @return ALP_OK; IO (exists and !overwrite, folder missing or not writable)
alp_result alpi_file_open(alp_context *context, const char *path, bool overwrite,
                          alpi_file_writer *writer);
alp_result alpi_file_append(alpi_file_writer *writer, const void *bytes, size_t size);
/// Completes: flushes to the disk and renames. On failure the temporary file is removed.
alp_result alpi_file_commit(alpi_file_writer *writer);
/// The two halves of it, for who writes several files; the caller abandons the writer after them.
alp_result alpi_file_finish(alpi_file_writer *writer);
alp_result alpi_file_place(alpi_file_writer *writer);
/// Gives up: removes the temporary file. Harmless after commit or a failed open.
void alpi_file_abandon(alpi_file_writer *writer);

/// Open, append, commit in one.
alp_result alpi_file_write(alp_context *context, const char *path, bool overwrite,
                           const void *bytes, size_t size);

/// Fails with IO and the reason if `path` could not be written at the end of a long job: it exists
/// and !overwrite, it is a folder or a device, or its folder is missing or not writable.
alp_result alpi_file_check_writable(alp_context *context, const char *path, bool overwrite);

/// Makes a folder and its parents where missing. @return ALP_OK; IO; OUT_OF_MEMORY
alp_result alpi_folder_create(alp_context *context, const char *path);

/// Whether `path` ends in `ending` (such as ".glb"), ASCII case ignored.
bool alpi_path_has_ending(const char *path, const char *ending);
/// Follows links from `path` to what is none, there or not; released by the caller.
/// @return ALP_OK; IO (a loop); OUT_OF_MEMORY
alp_result alpi_path_follow(alp_context *context, const char *path, char **end);
/// "a/b/c.glb" → "a/b/" (empty for a bare name); released by the caller.
char *alpi_path_folder(alp_context *context, const char *path);
/// "a/b/c.glb" → points at "c.glb" inside path.
const char *alpi_path_name(const char *path);

#endif
