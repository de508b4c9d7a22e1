// SPDX-License-Identifier: MIT
// All memory of ours passes here: overflow is checked, bytes are counted and kept within a budget,
// failure has a message.
#ifndef ALPI_BASE_MEMORY_H
#define ALPI_BASE_MEMORY_H

#include "base/context.h"

#include <stdarg.h>

/// Zeroed memory for count × size bytes, aligned to 16; NULL with OUT_OF_MEMORY set on overflow,
/// failure, or where the budget would be exceeded. count × size == 0 gives a pointer that may be
/// released.
void *alpi_allocate(alp_context *context, size_t count, size_t size);
/// Grows or shrinks; the old bytes are kept, new ones are zero. On failure NULL, `pointer` is kept.
void *alpi_reallocate(alp_context *context, void *pointer, size_t count, size_t size);
void alpi_release(alp_context *context, void *pointer); ///< NULL does nothing

/// The bytes that allocations of a context may hold together.
typedef struct alpi_budget {
    uint64_t limit; // bytes, whatever was allocated before included; 0: none
    // Set when the last allocation that failed was refused by the budget; else both are 0.
    uint64_t held, wanted; // bytes held then, bytes asked for
} alpi_budget;
/// Sets the budget and returns the one before. Not while a loop runs.
alpi_budget alpi_set_budget(alp_context *context, alpi_budget budget);
uint64_t alpi_memory_held(const alp_context *context); ///< bytes allocated and not released
/// Bytes that the budget leaves; UINT64_MAX without a budget.
uint64_t alpi_memory_left(const alp_context *context);

/// Typed allocation: `float *a = ALPI_NEW(context, float, n);`
#define ALPI_NEW(context, type, count) ((type *)alpi_allocate((context), (count), sizeof(type)))

/// Allocates into `pointer` or returns OUT_OF_MEMORY from the calling function. Only for functions
/// whose caller frees what was allocated before (owner structs).
#define ALPI_TRY_NEW(context, pointer, count)                                                      \
    do {                                                                                           \
        (pointer) = alpi_allocate((context), (count), sizeof(*(pointer)));                         \
        if ((pointer) == NULL) {                                                                   \
            return ALP_ERROR_OUT_OF_MEMORY;                                                        \
        }                                                                                          \
    } while (0)

/// Makes room for `needed` elements in *items (doubling). *capacity counts elements.
alp_result alpi_grow(alp_context *context, void **items, size_t *capacity, size_t needed,
                     size_t size);

/// Copy of a string, or formatted string; NULL with OUT_OF_MEMORY set.
char *alpi_copy_string(alp_context *context, const char *text);
char *alpi_format(alp_context *context, const char *format, ...) ALP_PRINTF(2, 3);

#endif
