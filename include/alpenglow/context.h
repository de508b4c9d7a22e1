// SPDX-License-Identifier: MIT
// A context owns what calls share: allocator, worker threads, log, and the last error message.
#ifndef ALPENGLOW_CONTEXT_H
#define ALPENGLOW_CONTEXT_H

#include <alpenglow/result.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

ALP_BEGIN_DECLS

typedef struct alp_context alp_context;

typedef enum alp_log_level {
    ALP_LOG_NOTE = 0,    ///< worth knowing: what was assumed, what was skipped
    ALP_LOG_WARNING = 1, ///< the result may surprise
} alp_log_level;

/// One message. `code` is a short stable name such as "uv-overlap"; `object` names the file, mesh
/// or material it is about and may be empty, never NULL. Strings live for the call only.
typedef struct alp_log_message {
    alp_log_level level;
    const char *code;
    const char *object;
    const char *text;
} alp_log_message;

/// Called on the thread that made the call which logs; never from two threads of one context at
/// once.
typedef void alp_log_fn(void *user, const alp_log_message *message);

/// How far long work is. `done` and `total` count units of the stage (rays, texels, triangles);
/// `rays_per_second` and `seconds_left` are 0 and negative while unknown.
typedef struct alp_progress {
    const char *stage;
    uint64_t done;
    uint64_t total;
    double rays_per_second;
    double seconds_left;
} alp_progress;

/// Returning false cancels: the call ends within 100 ms with ALP_ERROR_CANCELLED and writes
/// nothing. Called only on the thread that made the long call, about 20 times a second.
typedef bool alp_progress_fn(void *user, const alp_progress *progress);

/// The body of a parallel loop: works on [begin, end); `worker` is in [0, worker_count).
typedef void alp_range_fn(void *body_user, uint32_t begin, uint32_t end, uint32_t worker);

/// Options of a context. Make it with alp_context_options_default(), then change fields.
typedef struct alp_context_options {
    size_t struct_size; ///< set by the default; catches forgotten defaults and old callers

    /// Allocator: aligned to 16 bytes, callable from any thread; NULL pair = malloc and free.
    /// jansson, libpng, libjpeg, OpenEXR and Embree keep their own.
    void *(*allocate)(void *user, size_t size);
    void (*release)(void *user, void *pointer);
    void *allocator_user;

    /// Worker threads including the calling one, [0, 1024]; 0 (default) = one per online core.
    /// The number changes the time taken and never a bit of the result.
    uint32_t worker_count;
    /// A host's own scheduler: must call `body` over disjoint ranges that cover [0, count), with
    /// `worker` in [0, worker_count) and never the same worker twice at once, on stacks of 1 MiB at
    /// least. NULL = own pool.
    void (*parallel_for)(void *user, uint32_t count, uint32_t grain, alp_range_fn *body,
                         void *body_user);
    void *parallel_user;

    alp_log_fn *log; ///< NULL (default) = silent
    void *log_user;

    /// Assets may name files anywhere: by "..", absolute paths and file: addresses. Default false:
    /// they may name what lies below their own folder, for a file from elsewhere could have any
    /// picture of this machine read. Links in that folder are followed either way.
    bool read_outside;

    /// Highest instruction set the ray tracer may use: "sse2", "sse4.2", "avx", "avx2", or NULL
    /// (default) for the best of this machine. Same bits are promised on one level only.
    const char *max_isa;
} alp_context_options;

ALP_API alp_context_options alp_context_options_default(void);

/// Makes a context. @param options NULL = defaults; copied. @param context out; NULL on failure.
/// @return ALP_OK; INVALID_ARGUMENT (options not from the default, half an allocator, a host
///         scheduler without worker_count); OUT_OF_MEMORY.
/// Threads: a context serves one call at a time; use one context per thread that calls.
ALP_API ALP_NODISCARD alp_result alp_context_create(const alp_context_options *options,
                                                    alp_context **context);

/// Destroys a context. Everything made with it must be destroyed before. NULL does nothing.
ALP_API void alp_context_destroy(alp_context *context);

/// What went wrong in the last call that failed: file, object and fault, and what to do. Empty if
/// none failed yet. Owned by the context, valid until its next call.
ALP_API const char *alp_context_message(const alp_context *context);

/// Number of workers this context runs, at least 1.
ALP_API uint32_t alp_context_worker_count(const alp_context *context);

/// Largest sum of bytes that our own allocations held at one time since the context was made.
ALP_API uint64_t alp_context_peak_memory(const alp_context *context);

/// Library version as "major.minor.patch". Static.
ALP_API const char *alp_version(void);

ALP_END_DECLS

#endif
