// SPDX-License-Identifier: MIT
// Private side of alp_context: errors, warnings, and the pieces the other rooms call.
#ifndef ALPI_BASE_CONTEXT_H
#define ALPI_BASE_CONTEXT_H

#include <alpenglow/context.h>

/// Returns the failure of `expr` from the calling function, if it fails.
#define ALP_TRY(expr)                                                                              \
    do {                                                                                           \
        alp_result try_result_ = (expr);                                                           \
        if (try_result_ != ALP_OK) {                                                               \
            return try_result_;                                                                    \
        }                                                                                          \
    } while (0)

/// Stores the message "what, where, what to do" and returns `code`. May be called from a worker.
alp_result alpi_fail(alp_context *context, alp_result code, const char *format, ...)
    ALP_PRINTF(3, 4);
#ifdef __clang_analyzer__ // it looks at one file at a time: let it know that this returns `code`
static inline alp_result alpi_failed_with(alp_result code, alp_result same)
{
    (void)same;
    return code;
}
#define alpi_fail(context, code, ...)                                                              \
    alpi_failed_with((code), (alpi_fail)((context), (code), __VA_ARGS__))
#endif

/// Sends a warning or a note to the context's log. `object` may be NULL.
void alpi_warn(alp_context *context, const char *code, const char *object, const char *format, ...)
    ALP_PRINTF(4, 5);
void alpi_note(alp_context *context, const char *code, const char *object, const char *format, ...)
    ALP_PRINTF(4, 5);
/// From now on, until it is called with false as often, what is sent is not told. By one thread.
void alpi_hush(alp_context *context, bool hushed);

struct alpi_pool;
/// The context's thread pool, started at its first use; NULL when threads cannot be started.
struct alpi_pool *alpi_context_pool(alp_context *context);
struct alpi_watch;
/// Where the context keeps who is asked whether to go on: see tasks.h.
struct alpi_watch *alpi_context_watch(alp_context *context);
struct alpi_loop;
/// Where the context keeps the parallel loop that runs: see tasks.h.
struct alpi_loop **alpi_context_loop(alp_context *context);
struct alpi_tiles;
/// The tiles of the context: see tiles/tiles.h.
struct alpi_tiles *alpi_context_tiles(alp_context *context);
struct alp_ranks;
/// The processes that share loops; NULL: this one alone.
const struct alp_ranks *alpi_context_ranks(const alp_context *context);
/// Whether code for x86-64-v3 (AVX2) may run: this machine has it, and max_isa allows it.
bool alpi_context_has_v3(const alp_context *context);
/// The highest instruction set that may run, whose level decides the bits of results.
const char *alpi_context_isa(const alp_context *context);
/// Chooses name_v3 if it may run, else name_baseline: functions, or tables of functions, that
/// alp_compile_twice of CMakeLists.txt compiles.
#ifdef ALPI_HAS_V3
#define ALPI_COMPILED_FOR(context, name)                                                           \
    (*(alpi_context_has_v3(context) ? &name##_v3 : &name##_baseline))
#else
#define ALPI_COMPILED_FOR(context, name) (*((void)(context), &name##_baseline))
#endif
/// The host's scheduler, or NULL.
const alp_context_options *alpi_context_options(const alp_context *context);

#endif
