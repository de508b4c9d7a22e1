// SPDX-License-Identifier: MIT
// A zip archive as .zae files are: stored and deflated entries, found by name.
// PKWARE. APPNOTE.TXT, .ZIP File Format Specification, version 6.3.10, 2022.
#ifndef ALPI_FORMATS_COLLADA_ARCHIVE_H
#define ALPI_FORMATS_COLLADA_ARCHIVE_H

#include "base/context.h"

typedef struct alpi_archive alpi_archive;

/// What one archive may inflate to, all that is read from it together.
#define ALPI_ARCHIVE_LIMIT ((uint64_t)2 << 30)

/// Whether the bytes begin as a zip archive does.
bool alpi_archive_is(const uint8_t *bytes, size_t size);
/// Reads the directory. The bytes must outlive the archive; `path` is for messages.
/// @return ALP_OK; INVALID_DATA; UNSUPPORTED (zip64, parts); OUT_OF_MEMORY
alp_result alpi_archive_open(alp_context *context, const char *path, const uint8_t *bytes,
                             size_t size, alpi_archive **archive);
void alpi_archive_destroy(alpi_archive *archive); // NULL does nothing
/// The first name with that ending, ASCII case ignored; NULL when there is none.
const char *alpi_archive_find_ending(const alpi_archive *archive, const char *ending);
/// Inflates an entry. *bytes is released by the caller and has one zero byte after its end.
/// @return ALP_OK; IO (no such entry); INVALID_DATA; UNSUPPORTED; LIMIT; OUT_OF_MEMORY
alp_result alpi_archive_read(alpi_archive *archive, const char *name, uint8_t **bytes,
                             size_t *size);

#endif
