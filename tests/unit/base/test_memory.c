// SPDX-License-Identifier: MIT
// Allocations: a host's allocator is used for all, sizes never wrap, and each one may fail.
#include "test_support.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <stdlib.h>

/// A host's allocator that counts, and that fails the allocation number `fail_at` (from 1).
typedef struct counting_heap {
    int allocations, releases, fail_at;
} counting_heap;

static void *counting_allocate(void *user, size_t size)
{
    counting_heap *heap = user;
    heap->allocations++;
    void *block = heap->allocations == heap->fail_at ? NULL : malloc(size);
    return block ? memset(block, 0xa5, size) : NULL; // as memory that was used before
}

static void counting_release(void *user, void *pointer)
{
    counting_heap *heap = user;
    heap->releases += pointer != NULL;
    free(pointer);
}

static alp_context_options options_with_heap(counting_heap *heap)
{
    alp_context_options options = alp_context_options_default();
    options.allocate = counting_allocate;
    options.release = counting_release;
    options.allocator_user = heap;
    return options;
}

static alp_result count_items(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    for (uint32_t i = begin; i < end; i++) {
        ((unsigned char *)user)[i]++;
    }
    return ALP_OK;
}

/// A small job with a context of its own that touches every kind of allocation in base.
static alp_result job(const alp_context_options *options)
{
    alp_context *context = NULL;
    ALP_TRY(alp_context_create(options, &context));
    unsigned char seen[100] = {0};
    void *items = NULL;
    size_t capacity = 0;
    alp_result result = alpi_parallel_for(context, 100, 3, count_items, seen, NULL);
    for (int i = 0; i < 100; i++) {
        assert_int_equal(seen[i], 1); // without memory for threads the caller works alone
    }
    result = result == ALP_OK ? alpi_grow(context, &items, &capacity, 9, 8) : result;
    result = result == ALP_OK ? alpi_grow(context, &items, &capacity, 10, 8) : result;
    char *copy = result == ALP_OK ? alpi_copy_string(context, "seven") : NULL;
    char *text = copy != NULL ? alpi_format(context, "%s of %d", copy, 9) : NULL;
    if (result == ALP_OK && text == NULL) {
        result = ALP_ERROR_OUT_OF_MEMORY;
    } else if (result == ALP_OK) {
        assert_string_equal(text, "seven of 9");
    }
    assert_true(result == ALP_OK || strstr(alp_context_message(context), "out of memory"));
    alpi_release(context, text);
    alpi_release(context, copy);
    alpi_release(context, items);
    alp_context_destroy(context);
    return result;
}

TEST(every_allocation_may_fail)
{
    counting_heap heap = {0};
    alp_context_options options = options_with_heap(&heap);
    options.worker_count = 2;
    assert_int_equal(job(&options), ALP_OK);
    assert_int_equal(heap.allocations, heap.releases);
    int total = heap.allocations;
    assert_true(total >= 6); // context, pool, threads, array twice, two strings
    int failures = 0;
    for (int i = 1; i <= total; i++) {
        heap = (counting_heap){.fail_at = i};
        alp_result result = job(&options);
        assert_true(result == ALP_OK || result == ALP_ERROR_OUT_OF_MEMORY);
        failures += result != ALP_OK;
        assert_int_equal(heap.releases, heap.allocations - 1);
    }
    assert_int_equal(failures, total - 2); // all but those for threads, which nothing depends on
}

TEST(a_failed_context_is_null)
{
    counting_heap heap = {.fail_at = 1};
    alp_context_options options = options_with_heap(&heap);
    alp_context *context = (alp_context *)&heap;
    assert_int_equal(alp_context_create(&options, &context), ALP_ERROR_OUT_OF_MEMORY);
    assert_null(context);
    assert_int_equal(heap.releases, 0);
}

TEST(half_an_allocator_is_refused)
{
    counting_heap heap = {0};
    alp_context *context = NULL;
    alp_context_options options = options_with_heap(&heap);
    options.release = NULL;
    assert_int_equal(alp_context_create(&options, &context), ALP_ERROR_INVALID_ARGUMENT);
    options = alp_context_options_default();
    options.struct_size--;
    assert_int_equal(alp_context_create(&options, &context), ALP_ERROR_INVALID_ARGUMENT);
    options = alp_context_options_default();
    options.max_isa = "avx9";
    assert_int_equal(alp_context_create(&options, &context), ALP_ERROR_INVALID_ARGUMENT);
    assert_int_equal(alp_context_create(NULL, NULL), ALP_ERROR_INVALID_ARGUMENT);
}

TEST_WITH_CONTEXT(sizes_do_not_wrap, 1)
{
    const size_t many = SIZE_MAX / 8 + 1;
    assert_null(alpi_allocate(context, many, 8)); // 8 × many wraps to 0
    assert_non_null(strstr(alp_context_message(context), "out of memory"));
    assert_null(alpi_allocate(context, SIZE_MAX, 1)); // and so would the header in front of it
    char *kept = alpi_copy_string(context, "kept");
    assert_null(alpi_reallocate(context, kept, many, 8));
    assert_string_equal(kept, "kept");
    void *items = NULL;
    size_t capacity = 0;
    assert_int_equal(alpi_grow(context, &items, &capacity, many, 8), ALP_ERROR_OUT_OF_MEMORY);
    assert_null(items);
    assert_int_equal(capacity, 0);
    alpi_release(context, kept);
}

TEST(memory_is_zero_aligned_and_counted)
{
    counting_heap heap = {0};
    alp_context_options options = options_with_heap(&heap);
    alp_context *context = NULL;
    assert_int_equal(alp_context_create(&options, &context), ALP_OK);
    assert_int_equal(alp_context_peak_memory(context), 0);
    unsigned char *bytes = alpi_allocate(context, 1000, 1);
    assert_int_equal((uintptr_t)bytes % 16, 0);
    for (int i = 0; i < 1000; i++) {
        assert_int_equal(bytes[i], 0);
        bytes[i] = 0xff;
    }
    bytes = alpi_reallocate(context, bytes, 2000, 1);
    for (int i = 0; i < 2000; i++) {
        assert_int_equal(bytes[i], i < 1000 ? 0xff : 0);
    }
    assert_int_equal(alp_context_peak_memory(context), 3000); // both, while bytes were copied
    bytes = alpi_reallocate(context, bytes, 10, 1);
    assert_int_equal(bytes[9], 0xff);
    alpi_release(context, bytes);
    alpi_release(context, alpi_allocate(context, 0, 8)); // nothing may be asked for and released
    alpi_release(context, NULL);
    assert_int_equal(alp_context_peak_memory(context), 3000);
    alp_context_destroy(context);
}

TEST_WITH_CONTEXT(a_message_may_quote_the_message_before, 1)
{
    alpi_fail(context, ALP_ERROR_IO, "buffer 2: too short");
    alpi_fail(context, ALP_ERROR_IO, "a.gltf: %s", alp_context_message(context));
    assert_string_equal(alp_context_message(context), "a.gltf: buffer 2: too short");
}

/// With memory of its own a context moves arrays as little as it can: what was there stays, what is
/// new is zero, and nothing is counted twice where less is held.
TEST(arrays_change_their_size)
{
    enum { SMALL = 1000, LARGE = 9 << 20 };
    alp_context *own = test_context(1);
    uint8_t *bytes = alpi_allocate(own, SMALL, 1);
    memset(bytes, 7, SMALL);
    const size_t sizes[] = {3 * SMALL, SMALL / 2, 2 * SMALL, LARGE, SMALL / 4, SMALL};
    size_t kept = SMALL;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        bytes = alpi_reallocate(own, bytes, sizes[i], 1);
        assert_non_null(bytes);
        kept = sizes[i] < kept ? sizes[i] : kept;
        for (size_t k = 0; k < sizes[i]; k++) {
            assert_int_equal(bytes[k], k < kept ? 7 : 0);
        }
        memset(bytes, 7, sizes[i]);
        kept = sizes[i];
    }
    alpi_release(own, bytes);
    alp_context_destroy(own);
    own = test_context(1);
    bytes = alpi_allocate(own, LARGE, 1);
    bytes = alpi_reallocate(own, bytes, SMALL, 1);
    assert_int_equal(alp_context_peak_memory(own), LARGE);
    alpi_release(own, bytes);
    alp_context_destroy(own);
}

TEST_WITH_CONTEXT(a_budget_is_kept, 1)
{
    char *before = alpi_allocate(context, 100, 1);
    assert_true(alpi_memory_left(context) == UINT64_MAX);
    assert_int_equal(alpi_set_budget(context, (alpi_budget){.limit = 1000}).limit, 0);
    assert_int_equal(alpi_memory_left(context), 900);
    char *all = alpi_allocate(context, 900, 1);
    assert_non_null(all);
    assert_int_equal(alpi_memory_left(context), 0);
    assert_null(alpi_allocate(context, 1, 1));
    assert_non_null(strstr(alp_context_message(context), "more than the budget leaves"));
    alpi_release(context, alpi_allocate(context, 0, 1)); // nothing always fits
    assert_null(alpi_reallocate(context, all, 901, 1));
    all = alpi_reallocate(context, all, 300, 1); // as does less
    assert_non_null(all);
    assert_int_equal(alpi_memory_held(context), 400);
    assert_null(alpi_reallocate(context, all, 601, 1)); // old and new are held while it moves
    all = alpi_reallocate(context, all, 600, 1);
    assert_non_null(all);
    assert_int_equal(alpi_memory_held(context), 700);
    assert_null(alpi_allocate(context, 400, 1));
    alpi_budget spent = alpi_set_budget(context, (alpi_budget){.limit = 50}); // less than is held
    assert_int_equal(spent.held, 700);
    assert_int_equal(spent.wanted, 400);
    assert_int_equal(alpi_memory_left(context), 0);
    assert_null(alpi_allocate(context, 1, 1));
    assert_null(alpi_allocate(context, SIZE_MAX / 4, 1));
    alpi_release(context, all);
    alpi_release(context, before);
    assert_int_equal(alpi_memory_held(context), 0);
    alpi_set_budget(context, spent);
    assert_int_equal(alp_context_peak_memory(context), 1000); // what was refused does not count
}

/// A true failure is not taken for the budget's.
TEST(a_failure_is_no_refusal)
{
    counting_heap heap = {0};
    alp_context_options options = options_with_heap(&heap);
    alp_context *context = NULL;
    assert_int_equal(alp_context_create(&options, &context), ALP_OK);
    alpi_set_budget(context, (alpi_budget){.limit = 100});
    assert_null(alpi_allocate(context, 101, 1));
    heap.fail_at = heap.allocations + 1;
    assert_null(alpi_allocate(context, 10, 1));
    assert_int_equal(alpi_memory_held(context), 0);
    assert_int_equal(alpi_set_budget(context, (alpi_budget){0}).wanted, 0);
    alp_context_destroy(context);
}

enum { BLOCKS = 4000, BLOCK_SIZE = 64, ROOM_FOR = 1000 };

static alp_result allocate_blocks(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    void **blocks = user;
    alp_context *context = blocks[BLOCKS];
    for (uint32_t i = begin; i < end; i++) {
        if (alpi_allocate(context, ROOM_FOR * BLOCK_SIZE + 1, 1) != NULL) { // in nobody's way
            return ALP_ERROR_LIMIT;
        }
        blocks[i] = alpi_allocate(context, BLOCK_SIZE, 1);
    }
    return ALP_OK;
}

/// Workers that allocate at once fill the budget to its last block.
TEST_WITH_CONTEXT(workers_share_a_budget, 4)
{
    void *blocks[BLOCKS + 1] = {[BLOCKS] = context};
    (void)alpi_context_pool(context); // it holds memory too
    const uint64_t held = alpi_memory_held(context);
    alpi_set_budget(context, (alpi_budget){.limit = held + ROOM_FOR * BLOCK_SIZE});
    ASSERT_OK(context, alpi_parallel_for(context, BLOCKS, 16, allocate_blocks, blocks, NULL));
    uint32_t count = 0;
    for (uint32_t i = 0; i < BLOCKS; i++) {
        count += blocks[i] != NULL;
        alpi_release(context, blocks[i]);
    }
    assert_int_equal(count, ROOM_FOR);
    assert_int_equal(alpi_memory_held(context), held);
}
