// SPDX-License-Identifier: MIT
// Text of files that state no encoding: UTF-8, or else Latin-1.
#ifndef ALPI_FORMATS_UTF8_H
#define ALPI_FORMATS_UTF8_H

#include "base/context.h"

/// Bytes of the character of UTF-8 at `at`, before `end`; 0 where there is none.
size_t alpi_utf8_length(const uint8_t *at, const uint8_t *end);

/// Writes text as UTF-8 and a zero: bytes that are no UTF-8 become the characters that they are in
/// Latin-1. The text ends before the first character that has no room.
void alpi_utf8_print(const char *text, size_t size, char *out, size_t room);
/// The whole text so; released by the caller. NULL: no memory.
char *alpi_utf8_copy(alp_context *context, const char *text, size_t size);

#endif
