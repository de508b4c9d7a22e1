// SPDX-License-Identifier: MIT
// Result codes. Every function that can fail returns one; alp_context_message() says what and
// where.
#ifndef ALPENGLOW_RESULT_H
#define ALPENGLOW_RESULT_H

#include <alpenglow/export.h>

#include <stdint.h>

ALP_BEGIN_DECLS

/// Fixed width, so that a new code never changes the ABI. Values are explicit and never reused.
typedef int32_t alp_result;

enum {
    ALP_OK = 0,
    ALP_ERROR_INVALID_ARGUMENT = -1, ///< the caller broke a documented precondition
    ALP_ERROR_INVALID_DATA = -2,     ///< the scene or file is malformed
    ALP_ERROR_UNSUPPORTED = -3,      ///< well-formed, but asks for what this build cannot do
    ALP_ERROR_LIMIT = -4,            ///< larger than a stated limit
    ALP_ERROR_IO = -5,               ///< the operating system refused to read or write
    ALP_ERROR_OUT_OF_MEMORY = -6,    ///< an allocation failed
    ALP_ERROR_CANCELLED = -7,        ///< a progress callback returned false
};

/// The name of a code, such as "INVALID_DATA"; "UNKNOWN" for a value that is none. Never NULL,
/// static.
ALP_API const char *alp_result_name(alp_result result);

ALP_END_DECLS

#endif
