// SPDX-License-Identifier: MIT
// A context owns the allocator, the worker threads, the log and the last error message of its
// calls.
#ifndef ALPENGLOW_CONTEXT_H
#define ALPENGLOW_CONTEXT_H

#include <alpenglow/ranks.h>
#include <alpenglow/result.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

ALP_BEGIN_DECLS

/// Opaque. A context serves one call at a time: use one context for each thread that calls.
typedef struct alp_context alp_context;

typedef enum alp_log_level {
    ALP_LOG_NOTE = 0,    ///< an assumption that was made, or a part that was skipped
    ALP_LOG_WARNING = 1, ///< the result may be wrong or unexpected
} alp_log_level;

/// One message of the log. Its strings are valid during the call only, and never NULL.
typedef struct alp_log_message {
    alp_log_level level;
    const char *code;   ///< short stable name, such as "uv-overlap"
    const char *object; ///< name of the file, mesh or material; may be empty
    const char *text;   ///< the message, in English
} alp_log_message;

/// Receives messages. It runs on the thread that called the library, and never on two threads of
/// one context at once.
typedef void alp_log_fn(void *user, const alp_log_message *message);

/// Progress of long work.
typedef struct alp_progress {
    const char *stage;      ///< name of the stage; valid during the call only
    uint64_t done;          ///< units of the stage: rays, texels or triangles
    uint64_t total;         ///< the same units
    double rays_per_second; ///< 0 while unknown
    double seconds_left;    ///< negative while unknown
} alp_progress;

/// Receives progress, about 20 times a second, on the thread that made the long call. Returning
/// false cancels: the call ends within 100 ms with ALP_ERROR_CANCELLED and writes nothing.
typedef bool alp_progress_fn(void *user, const alp_progress *progress);

/// The body of a parallel loop. It works on items [begin, end). `worker` is in [0, worker_count).
typedef void alp_range_fn(void *body_user, uint32_t begin, uint32_t end, uint32_t worker);

/// Options of a context. Fill them with alp_context_options_default(), then change fields.
typedef struct alp_context_options {
    size_t struct_size; ///< set by the default; detects missing defaults and older callers

    /// The host's allocator: aligned to 16 bytes, callable from any thread. Both NULL (default):
    /// malloc and free. jansson, libpng, libjpeg, OpenEXR and Embree keep their own allocators.
    void *(*allocate)(void *user, size_t size);
    void (*release)(void *user, void *pointer);
    void *allocator_user;

    /// Worker threads, the calling one included, [0, 1024]; 0 (default) = one for each online core.
    /// The number changes the time and never a bit of the result.
    uint32_t worker_count;
    /// The host's scheduler, which needs worker_count above 0. It must call `body` over disjoint
    /// ranges that cover [0, count), with `worker` in [0, worker_count). No worker may run twice at
    /// once. Stacks need at least 1 MiB. NULL (default): a pool of our own.
    void (*parallel_for)(void *user, uint32_t count, uint32_t grain, alp_range_fn *body,
                         void *body_user);
    void *parallel_user;

    /// Processes that share the loops that trace rays; copied. NULL (default): this one alone.
    const alp_ranks *ranks;

    alp_log_fn *log; ///< receives warnings and notes; NULL (default): none are given
    void *log_user;

    /// true: assets may name files anywhere, by "..", absolute paths and file: addresses. Default
    /// false: only files below the asset's own folder, so that an untrusted asset cannot read other
    /// pictures of this machine. Symbolic links in that folder are always followed.
    bool read_outside;

    /// Highest instruction set that the ray tracer and the library's own loops may use: "sse2",
    /// "sse4.2", "avx" or "avx2". NULL (default): the best of this machine. Results are the same
    /// bits on one level only.
    const char *max_isa;
} alp_context_options;

ALP_API alp_context_options alp_context_options_default(void);

/// Makes a context.
/// @param options NULL = defaults; copied
/// @param context out; NULL on failure
/// @return ALP_OK; INVALID_ARGUMENT (options not from the default, half an allocator, a host
///         scheduler without worker_count, an unknown max_isa, bad ranks); OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_context_create(const alp_context_options *options,
                                                    alp_context **context);

/// Destroys a context. Destroy everything made with it first. NULL does nothing.
ALP_API void alp_context_destroy(alp_context *context);

/// Error message of the last call that failed: file, object, fault and remedy. Empty if none failed
/// yet. Owned by the context, valid until its next call.
ALP_API const char *alp_context_message(const alp_context *context);

/// Number of workers of this context, at least 1.
ALP_API uint32_t alp_context_worker_count(const alp_context *context);

/// Most bytes that our own allocations held at one time since the context was made.
ALP_API uint64_t alp_context_peak_memory(const alp_context *context);

/// Version of the library, "major.minor.patch". Static.
ALP_API const char *alp_version(void);

ALP_END_DECLS

#endif
