// SPDX-License-Identifier: MIT
// Result codes. Every function that can fail returns one. alp_context_message() then names the
// file, the object and the fault.
#ifndef ALPENGLOW_RESULT_H
#define ALPENGLOW_RESULT_H

#include <alpenglow/export.h>

#include <stdint.h>

ALP_BEGIN_DECLS

/// A result code. The width is fixed, so a new code never changes the ABI. Values are explicit and
/// never reused.
typedef int32_t alp_result;

enum {
    ALP_OK = 0,
    ALP_ERROR_INVALID_ARGUMENT = -1, ///< the caller broke a documented precondition
    ALP_ERROR_INVALID_DATA = -2,     ///< the scene or file is malformed
    ALP_ERROR_UNSUPPORTED = -3,      ///< well-formed, but this build cannot do it
    ALP_ERROR_LIMIT = -4,            ///< larger than a stated limit
    ALP_ERROR_IO = -5,               ///< the operating system could not read or write
    ALP_ERROR_OUT_OF_MEMORY = -6,    ///< an allocation failed
    ALP_ERROR_CANCELLED = -7,        ///< a progress callback returned false
};

/// The name of a code, such as "INVALID_DATA". Any other value gives "UNKNOWN". Static, never NULL.
ALP_API const char *alp_result_name(alp_result result);

ALP_END_DECLS

#endif
