// SPDX-License-Identifier: MIT
// UTF-16 → UTF-8 and back.
#ifndef ALPI_FORMATS_UTF16_H
#define ALPI_FORMATS_UTF16_H

#include "base/context.h"

/// Half a pair becomes three bytes that are no UTF-8. *out is released by the caller.
alp_result alpi_utf16_decode(alp_context *context, const uint8_t *bytes, size_t size, bool big,
                             uint8_t **out, size_t *out_size);
/// With a byte-order mark. `text` must be UTF-8. *out is released by the caller.
alp_result alpi_utf16_encode(alp_context *context, const char *text, size_t size, bool big,
                             uint8_t **out, size_t *out_size);

#endif
