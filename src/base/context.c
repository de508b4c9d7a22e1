// SPDX-License-Identifier: MIT
// The context: allocator with counting, error message, log, lazily started thread pool.
#include "base/context.h"

#include "base/guard.h"
#include "base/memory.h"
#include "base/tasks.h"
#include "base/tiles/tiles.h"

#include <alpenglow/version.h>
#include <assert.h>

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { MESSAGE_SIZE = 1024, WORKER_LIMIT = 1024, ISA_SIZE = 16 };
enum { LARGE_PAGE = 1 << 21, LARGE_BLOCK = 2 * LARGE_PAGE };

/// Stands before every block, so that a release knows its size. 16 bytes keep the alignment.
typedef struct block_header {
    size_t size;
    size_t padding;
} block_header;

struct alp_context {
    alp_context_options options;
    char max_isa[ISA_SIZE];
    uint32_t worker_count;
    struct alpi_pool *pool;
    alpi_watch watch;
    const alpi_guard *guard;
    struct alpi_loop *loop;
    alpi_tiles tiles;
    alp_ranks ranks;
    pthread_mutex_t message_lock; // workers may fail too
    char message[MESSAGE_SIZE];
    uint32_t hushed;    // how often
    alpi_budget budget; // `limit` is set between loops, the rest under message_lock
    _Atomic uint64_t memory_now;
    _Atomic uint64_t memory_peak;
};

/// Asks for large pages under a large block: what rays meet is looked up all over it, and with
/// small ones each look misses the table of pages too.
static void ask_for_large_pages(void *block, size_t size)
{
#ifdef MADV_HUGEPAGE
    const uintptr_t page = LARGE_PAGE, first = ((uintptr_t)block + page - 1) / page * page;
    const uintptr_t end = ((uintptr_t)block + size) / page * page;
    if (end > first) {
        (void)madvise((char *)block + (first - (uintptr_t)block), end - first, MADV_HUGEPAGE);
    }
#else
    (void)block;
    (void)size;
#endif
}

static void *default_allocate(void *user, size_t size)
{
    (void)user;
    void *block = calloc(1, size); // fresh pages come zeroed and cost nothing before they are used
    if (block != NULL && size >= LARGE_BLOCK) {
        ask_for_large_pages(block, size);
    }
    return block;
}

static void default_release(void *user, void *pointer)
{
    (void)user;
    free(pointer);
}

alp_context_options alp_context_options_default(void)
{
    return (alp_context_options){.struct_size = sizeof(alp_context_options)};
}

static uint32_t online_cores(void)
{
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    return cores < 1 ? 1 : cores > WORKER_LIMIT ? WORKER_LIMIT : (uint32_t)cores;
}

static bool ranks_are_valid(const alp_ranks *r)
{
    return r == NULL || (r->struct_size == sizeof *r && r->count > 0 && r->rank < r->count &&
                         (r->count == 1 || (r->claim != NULL && r->exchange != NULL)));
}

static bool options_are_valid(const alp_context_options *o)
{
    static const char *const levels[] = {"sse2", "sse4.2", "avx", "avx2"};
    bool isa_known = o->max_isa == NULL;
    for (size_t i = 0; i < sizeof levels / sizeof *levels && !isa_known; i++) {
        isa_known = strcmp(o->max_isa, levels[i]) == 0;
    }
    return o->struct_size == sizeof *o && (o->allocate == NULL) == (o->release == NULL) &&
           o->worker_count <= WORKER_LIMIT && (o->parallel_for == NULL || o->worker_count > 0) &&
           isa_known && ranks_are_valid(o->ranks);
}

alp_result alp_context_create(const alp_context_options *options, alp_context **context)
{
    if (context == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *context = NULL;
    alp_context_options o = options ? *options : alp_context_options_default();
    if (!options_are_valid(&o)) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    if (o.allocate == NULL) {
        o.allocate = default_allocate;
        o.release = default_release;
    }
    alp_context *c = o.allocate(o.allocator_user, sizeof *c);
    if (c == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    memset(c, 0, sizeof *c);
    c->options = o;
    if (o.max_isa != NULL) {
        snprintf(c->max_isa, sizeof c->max_isa, "%s", o.max_isa);
        c->options.max_isa = c->max_isa;
    }
    c->ranks = o.ranks != NULL ? *o.ranks : alp_ranks_default();
    c->options.ranks = NULL; // copied
    c->worker_count = o.worker_count > 0 ? o.worker_count : online_cores();
    pthread_mutex_init(&c->message_lock, NULL);
    *context = c;
    return ALP_OK;
}

void alp_context_destroy(alp_context *context)
{
    if (context == NULL) {
        return;
    }
    alpi_pool_destroy(context->pool);
    pthread_mutex_destroy(&context->message_lock);
    context->options.release(context->options.allocator_user, context);
}

alpi_tiles *alpi_context_tiles(alp_context *context)
{
    return &context->tiles;
}

const alp_ranks *alpi_context_ranks(const alp_context *context)
{
    return context->ranks.count > 1 ? &context->ranks : NULL;
}

const char *alp_context_message(const alp_context *context)
{
    return context ? context->message : "";
}

uint32_t alp_context_worker_count(const alp_context *context)
{
    return context ? context->worker_count : 1;
}

uint64_t alp_context_peak_memory(const alp_context *context)
{
    return context ? atomic_load_explicit(&context->memory_peak, memory_order_relaxed) : 0;
}

const char *alp_version(void)
{
    return ALP_VERSION_STRING;
}

const char *alp_result_name(alp_result result)
{
    switch (result) {
    case ALP_OK:
        return "OK";
    case ALP_ERROR_INVALID_ARGUMENT:
        return "INVALID_ARGUMENT";
    case ALP_ERROR_INVALID_DATA:
        return "INVALID_DATA";
    case ALP_ERROR_UNSUPPORTED:
        return "UNSUPPORTED";
    case ALP_ERROR_LIMIT:
        return "LIMIT";
    case ALP_ERROR_IO:
        return "IO";
    case ALP_ERROR_OUT_OF_MEMORY:
        return "OUT_OF_MEMORY";
    case ALP_ERROR_CANCELLED:
        return "CANCELLED";
    default:
        return "UNKNOWN";
    }
}

alp_result(alpi_fail)(alp_context *context, alp_result code, const char *format, ...)
{
    char text[MESSAGE_SIZE]; // an argument may be the old message, to which more is said
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    pthread_mutex_lock(&context->message_lock);
    memcpy(context->message, text, sizeof text);
    pthread_mutex_unlock(&context->message_lock);
    return code;
}

static void log_message(alp_context *context, alp_log_level level, const char *code,
                        const char *object, const char *format, va_list arguments)
{
    if (context->options.log == NULL || context->hushed > 0) {
        return;
    }
    char text[MESSAGE_SIZE];
    vsnprintf(text, sizeof text, format, arguments);
    alp_log_message message = {level, code, object ? object : "", text};
    context->options.log(context->options.log_user, &message);
}

void alpi_warn(alp_context *context, const char *code, const char *object, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    log_message(context, ALP_LOG_WARNING, code, object, format, arguments);
    va_end(arguments);
}

void alpi_note(alp_context *context, const char *code, const char *object, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    log_message(context, ALP_LOG_NOTE, code, object, format, arguments);
    va_end(arguments);
}

void alpi_hush(alp_context *context, bool hushed)
{
    if (hushed) {
        context->hushed++;
    } else {
        assert(context->hushed > 0);
        context->hushed--;
    }
}

struct alpi_pool *alpi_context_pool(alp_context *context)
{
    if (context->pool == NULL && context->worker_count > 1) {
        context->pool = alpi_pool_create(context, context->worker_count);
    }
    return context->pool;
}

struct alpi_watch *alpi_context_watch(alp_context *context)
{
    return &context->watch;
}

const alpi_guard **alpi_context_guard(alp_context *context)
{
    return &context->guard;
}

struct alpi_loop **alpi_context_loop(alp_context *context)
{
    return &context->loop;
}

bool alpi_context_has_v3(const alp_context *context)
{
    const char *isa = context->options.max_isa;
#if defined(__x86_64__)
    return (isa == NULL || strcmp(isa, "avx2") == 0) && __builtin_cpu_supports("avx2") &&
           __builtin_cpu_supports("bmi2");
#else
    (void)isa;
    return false;
#endif
}

const char *alpi_context_isa(const alp_context *context)
{
    if (context->options.max_isa != NULL) {
        return context->options.max_isa;
    }
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx512f") ? "avx512"
           : __builtin_cpu_supports("avx2")  ? "avx2"
           : __builtin_cpu_supports("avx")   ? "avx"
                                             : "sse4.2";
#else
    return "other";
#endif
}

const alp_context_options *alpi_context_options(const alp_context *context)
{
    return &context->options;
}

// --- memory -------------------------------------------------------------------------------------

alpi_budget alpi_set_budget(alp_context *context, alpi_budget budget)
{
    const alpi_budget former = context->budget;
    context->budget = budget;
    return former;
}

uint64_t alpi_memory_held(const alp_context *context)
{
    return atomic_load_explicit(&context->memory_now, memory_order_relaxed);
}

uint64_t alpi_memory_left(const alp_context *context)
{
    const uint64_t held = alpi_memory_held(context), limit = context->budget.limit;
    return limit == 0 ? UINT64_MAX : limit > held ? limit - held : 0;
}

/// Fails an allocation. @param held bytes at that time  @param refused by the budget
static void *fail_allocation(alp_context *context, size_t size, uint64_t held, bool refused)
{
    pthread_mutex_lock(&context->message_lock);
    context->budget.held = refused ? held : 0;
    context->budget.wanted = refused ? size : 0;
    pthread_mutex_unlock(&context->message_lock);
    alpi_fail(context, ALP_ERROR_OUT_OF_MEMORY, "out of memory: %zu bytes asked%s", size,
              refused ? ", more than the budget leaves" : "");
    return NULL;
}

/// Counts bytes as held, unless the budget leaves no room for them: a refused size is never seen
/// by another worker. @param held out: bytes held after that, or now if they are refused
static bool take_memory(alp_context *context, size_t size, uint64_t *held)
{
    const uint64_t limit = context->budget.limit;
    uint64_t now = alpi_memory_held(context);
    do {
        *held = now;
        if (limit > 0 && size > (limit > now ? limit - now : 0)) {
            return false;
        }
    } while (!atomic_compare_exchange_weak_explicit(&context->memory_now, &now, now + size,
                                                    memory_order_relaxed, memory_order_relaxed));
    *held = now + size;
    return true;
}

static void give_back(alp_context *context, size_t size)
{
    atomic_fetch_sub_explicit(&context->memory_now, size, memory_order_relaxed);
}

/// @param now bytes held once an allocation had succeeded
static void raise_peak(alp_context *context, uint64_t now)
{
    uint64_t peak = atomic_load_explicit(&context->memory_peak, memory_order_relaxed);
    while (now > peak &&
           !atomic_compare_exchange_weak_explicit(&context->memory_peak, &peak, now,
                                                  memory_order_relaxed, memory_order_relaxed)) {
    }
}

void *alpi_allocate(alp_context *context, size_t count, size_t size)
{
    size_t bytes = 0;
    if (__builtin_mul_overflow(count, size, &bytes) || bytes > SIZE_MAX / 2) {
        alpi_fail(context, ALP_ERROR_OUT_OF_MEMORY,
                  "out of memory: %zu elements of %zu bytes asked", count, size);
        return NULL;
    }
    uint64_t held;
    if (!take_memory(context, bytes, &held)) {
        return fail_allocation(context, bytes, held, true);
    }
    block_header *block =
        context->options.allocate(context->options.allocator_user, sizeof *block + bytes);
    if (block == NULL) {
        give_back(context, bytes);
        return fail_allocation(context, bytes, held, false);
    }
    block->size = bytes;
    raise_peak(context, held);
    bool zeroed = context->options.allocate == default_allocate;
    return zeroed ? block + 1 : memset(block + 1, 0, bytes);
}

void alpi_release(alp_context *context, void *pointer)
{
    if (pointer == NULL) {
        return;
    }
    block_header *block = (block_header *)pointer - 1;
    give_back(context, block->size);
    context->options.release(context->options.allocator_user, block);
}

/// Of memory that is ours to move: mostly nothing is, where it is made smaller.
static void *resize(alp_context *context, block_header *block, size_t bytes)
{
    const size_t had = block->size, more = bytes > had ? bytes : 0; // both places, while it moves
    uint64_t held;
    if (!take_memory(context, more, &held)) {
        return fail_allocation(context, bytes, held, true);
    }
    block_header *moved = realloc(block, sizeof *block + bytes);
    if (moved == NULL) {
        give_back(context, more);
        return fail_allocation(context, bytes, held, false);
    }
    moved->size = bytes;
    if (bytes > had) {
        memset((char *)(moved + 1) + had, 0, bytes - had);
        raise_peak(context, held);
    }
    give_back(context, bytes > had ? had : had - bytes);
    return moved + 1;
}

void *alpi_reallocate(alp_context *context, void *pointer, size_t count, size_t size)
{
    const bool ours = pointer != NULL && context->options.allocate == default_allocate &&
                      context->options.release == default_release;
    if (ours && (size == 0 || count <= SIZE_MAX / 2 / size)) {
        block_header *block = (block_header *)pointer - 1;
        const size_t bytes = count * size;
        if (bytes <= block->size || bytes < LARGE_BLOCK) { // what is larger gets large pages
            return resize(context, block, bytes);
        }
    }
    void *larger = alpi_allocate(context, count, size);
    if (larger != NULL && pointer != NULL) {
        size_t old_size = ((block_header *)pointer - 1)->size;
        memcpy(larger, pointer, old_size < count * size ? old_size : count * size);
        alpi_release(context, pointer);
    }
    return larger;
}

alp_result alpi_grow(alp_context *context, void **items, size_t *capacity, size_t needed,
                     size_t size)
{
    if (needed <= *capacity) {
        return ALP_OK;
    }
    size_t larger = *capacity < 8 ? 8 : *capacity * 2;
    larger = larger < needed ? needed : larger;
    void *moved = alpi_reallocate(context, *items, larger, size);
    if (moved == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    *items = moved;
    *capacity = larger;
    return ALP_OK;
}

char *alpi_copy_string(alp_context *context, const char *text)
{
    size_t size = strlen(text) + 1;
    char *copy = alpi_allocate(context, size, 1);
    return copy ? memcpy(copy, text, size) : NULL;
}

char *alpi_format(alp_context *context, const char *format, ...)
{
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    int length = vsnprintf(NULL, 0, format, arguments);
    char *text = length < 0 ? NULL : alpi_allocate(context, (size_t)length + 1, 1);
    if (text != NULL) {
        vsnprintf(text, (size_t)length + 1, format, again);
    }
    va_end(again);
    va_end(arguments);
    return text;
}
