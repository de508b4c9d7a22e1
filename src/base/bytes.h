// SPDX-License-Identifier: MIT
// Growing bytes. A failure (out of memory) is remembered and later steps do nothing, so that a
// long sequence of small steps is checked once, at its end.
#ifndef ALPI_BASE_BYTES_H
#define ALPI_BASE_BYTES_H

#include "base/context.h"

#include <stdarg.h>

typedef struct alpi_bytes {
    alp_context *context;
    uint8_t *bytes; // [size], a zero after the end
    size_t size, capacity;
    bool failed;
} alpi_bytes;

static inline alpi_bytes alpi_bytes_create(alp_context *context)
{
    return (alpi_bytes){.context = context};
}
void alpi_bytes_destroy(alpi_bytes *bytes);
/// Makes room for `more` bytes and no others: what is added within them moves nothing.
void alpi_bytes_reserve(alpi_bytes *bytes, size_t more);
void alpi_bytes_add(alpi_bytes *bytes, const void *data, size_t size);
void alpi_bytes_print(alpi_bytes *bytes, const char *format, ...) ALP_PRINTF(2, 3);
void alpi_bytes_print_arguments(alpi_bytes *bytes, const char *format, va_list arguments);
/// A finite number with a point as decimal sign whatever the locale; `digits` significant.
void alpi_bytes_number(alpi_bytes *bytes, double value, int digits);
/// As many digits, 6 to 9, as bring the same float back.
void alpi_bytes_float(alpi_bytes *bytes, float value);
void alpi_bytes_base64(alpi_bytes *bytes, const uint8_t *data, size_t size);
/// A JSON string: quotes and escapes added; bytes that are no ASCII stay as they are (UTF-8).
void alpi_bytes_quote(alpi_bytes *bytes, const char *text);
void alpi_bytes_add_u32(alpi_bytes *bytes, uint32_t value); ///< little-endian
/// Fills with `filler` up to a multiple of 4.
void alpi_bytes_align(alpi_bytes *bytes, char filler);

#endif
