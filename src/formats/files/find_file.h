// SPDX-License-Identifier: MIT
// Files that an asset names, found as people's files name them: with backslashes, by the path of
// another machine, in another case, in Latin-1.
#ifndef ALPI_FORMATS_FIND_FILE_H
#define ALPI_FORMATS_FIND_FILE_H

#include "base/context.h"

typedef enum alpi_found {
    ALPI_FOUND_NOTHING = 0,
    ALPI_FOUND_AS_NAMED,
    ALPI_FOUND_OTHER_CASE, // the path as named, in other letters
    ALPI_FOUND_BY_NAME     // the last parts of the path, in the asset's folder
} alpi_found;

/// Path within the asset's folder of a file that a text in its sub-folder `from` names, with
/// slashes and without "." and "..". Nothing is opened.
/// @param from with its slash, or ""
/// @param path out; released by the caller. NULL where it leaves the folder and may not; where the
///        context allows files outside, it may begin with "../" or "/"
alp_result alpi_path_resolve(alp_context *context, const char *from, const char *name, size_t size,
                             char **path);

/// The same, and finds the file: as named, in another case, then by the last parts of its path in
/// the asset's folder. The longest end of the path that is there is taken. A name that is nowhere
/// is read with percent escapes, then as Latin-1.
/// @param folder of the asset, with its slash, or ""
/// @param path out; released by the caller. With ALPI_FOUND_NOTHING as alpi_path_resolve has it
alp_result alpi_find_file(alp_context *context, const char *folder, const char *from,
                          const char *name, char **path, alpi_found *found);

/// The same for a uri whose escapes are decoded. It may begin with "file:".
/// @param path out, from the working folder; without a file the path that the uri names, or NULL
///        where that is outside
alp_result alpi_find_uri(alp_context *context, const char *folder, const char *uri, char **path,
                         alpi_found *found);

/// Whether a path is of a machine that this one is not: "C:\…", "\\host\…".
bool alpi_path_is_foreign(const char *name);

/// Notes a file that was not found as named ("image-path").
void alpi_note_found(alp_context *context, const char *name, const char *path, alpi_found found);

#endif
