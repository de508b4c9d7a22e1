// SPDX-License-Identifier: MIT
// What tests share: cmocka, a context that collects log messages, temporary folders, shared files.
#ifndef TEST_SUPPORT_H
#define TEST_SUPPORT_H

// cmocka 1.1 needs these before it
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdbool.h>
#include <string.h>

#include <alpenglow/alpenglow.h>

#include "test_cases.h"

/// Whether slow cases are left out: under sanitizers, and in `make test-fast` (TEST_FAST).
bool test_is_quick(void);
/// Loops that try each of many like cases go on by so many: by 13 where slow cases are left out.
#define TEST_STEP (test_is_quick() ? 13 : 1)

/// Fails the test with the numbers unless |actual − expected| ≤ tolerance (NaN fails).
#define ASSERT_NEAR(actual, expected, tolerance)                                                   \
    test_assert_near((double)(actual), (double)(expected), (double)(tolerance), #actual, __FILE__, \
                     __LINE__)
void test_assert_near(double actual, double expected, double tolerance, const char *text,
                      const char *file, int line);

/// Fails the test with the context's message unless the call gives ALP_OK.
#define ASSERT_OK(context, call) test_assert_ok((context), (call), #call, __FILE__, __LINE__)
void test_assert_ok(alp_context *context, alp_result result, const char *text, const char *file,
                    int line);

/// A context with this many workers whose log messages test_log_contains can find.
alp_context *test_context(uint32_t workers);
/// The scene of a file or "builtin:", which must load.
alp_scene *test_load(alp_context *context, const char *name);
/// A bake of light alone on new charts, by as many rays as there may be.
alp_bake_options test_light_options(uint32_t size);
/// A silent context with one worker whose next `*left` allocations succeed and whose later ones
/// fail; `*left` counts down and may be set again at any time. It begins with room enough. A
/// program that ends with memory of such contexts not released fails.
alp_context *test_context_failing(int *left);
/// Forgets logged messages.
void test_log_clear(void);
/// Whether a message with this code was logged since the last clear (by any test context).
int test_log_has(const char *code);
/// All messages, one "code object: text" a line, for asserting on words.
const char *test_log_text(void);

/// Fails unless a function writes the same bytes for 1, 2, 7 and 32 workers; a quick run tries 1
/// and
/// 7. Gives the bytes, which the caller frees.
/// @param make  writes `size` bytes, zeroed before, of what it is given
typedef void test_make(uint32_t workers, const void *what, void *bytes);
void *test_any_workers(test_make *make, const void *what, size_t size);

/// A new empty folder for this test, removed at exit. Ends in no slash.
const char *test_folder(void);
/// "folder/name", in one of 8 static buffers.
const char *test_path(const char *folder, const char *name);

/// Path of a file below $ALPENGLOW_SHARED (default ../shared from the source tree), or NULL when
/// the folder is absent: then call skip() — the test shows as skipped.
const char *test_shared(const char *relative);

/// Whole file, malloc'ed; fails the test when it cannot be read.
unsigned char *test_read_file(const char *path, size_t *size);

#endif
