// SPDX-License-Identifier: MIT
// Paths of files that an asset names: below the asset's folder, unless the context allows others.
// Links are followed: the maker of the folder put them there, the asset's text did not.
#ifndef ALPI_FORMATS_OUTSIDE_H
#define ALPI_FORMATS_OUTSIDE_H

#include "base/context.h"

/// Ends messages about a file that lies outside.
#define ALPI_OUTSIDE_HINT "only files below it are read, unless --allow-outside"

/// Decodes %XX in place; a sign that is no escape stays. False for an escaped zero byte.
bool alpi_uri_decode(char *text);
/// A file name with percent escapes for all but the unreserved characters (RFC 3986, section 2.3).
/// Released by the caller; NULL: no memory.
char *alpi_uri_encode(alp_context *context, const char *name);

/// Whether a relative path never climbs: no empty name, no "/…", no ".." part (either slash).
bool alpi_path_stays_below(const char *path);

/// Whether the address is "file:…" and the context allows those.
bool alpi_outside_takes(const alp_context *context, const char *uri);

/// Path of the file that an asset in `folder` (with its slash, or "") names, released by the
/// caller; NULL in *path where it lies outside and may not, or names none.
/// @param name with escapes resolved; "file://…" where outside is allowed
alp_result alpi_outside_path(alp_context *context, const char *folder, const char *name,
                             char **path);

#endif
