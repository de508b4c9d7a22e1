// SPDX-License-Identifier: MIT
// How a test file declares its cases. They register themselves; test_main.c runs them in the order
// in which they stand in the file.
#ifndef TEST_CASES_H
#define TEST_CASES_H

#include <alpenglow/alpenglow.h>

#include <stdbool.h>
#include <stdint.h>

/// A case: TEST(corners_are_shared) { ... } It starts with an empty log.
#define TEST(name) TEST_CASE_(name, false)

/// A case that spends seconds on figures. It is left out of `make test-fast` and under sanitizers,
/// where other cases must run the same code.
#define TEST_SLOW(name) TEST_CASE_(name, true)

/// A case that gets an `alp_context *context` with this many workers, destroyed at its end.
/// Messages that are logged in it can be read with test_log_has and test_log_text.
#define TEST_WITH_CONTEXT(name, workers) TEST_CASE_WITH_(name, workers, false)
#define TEST_SLOW_WITH_CONTEXT(name, workers) TEST_CASE_WITH_(name, workers, true)

/// Two functions without parameters that are called before and after every case of the file. The
/// second is also called after a case that failed.
#define TEST_AROUND(before, after)                                                                 \
    static test_surroundings test_surroundings_ = {__FILE__, before, after, NULL};                 \
    __attribute__((constructor)) static void test_register_surroundings_(void)                     \
    {                                                                                              \
        test_register_surroundings(&test_surroundings_);                                           \
    }                                                                                              \
    struct test_surroundings // takes the semicolon

/// A static `context` with this many workers, new in every case of the file.
#define TEST_CONTEXT(workers)                                                                      \
    static alp_context *context;                                                                   \
    static void test_open_context_(void)                                                           \
    {                                                                                              \
        context = test_context(workers);                                                           \
    }                                                                                              \
    static void test_close_context_(void)                                                          \
    {                                                                                              \
        alp_context_destroy(context);                                                              \
        context = NULL;                                                                            \
    }                                                                                              \
    TEST_AROUND(test_open_context_, test_close_context_)

// --- what the macros are made of -----------------------------------------------------------------

typedef struct test_case {
    const char *file, *name;
    int line;
    bool slow;
    void (*run)(void);                      // this, or
    void (*run_with)(alp_context *context); // this
    uint32_t workers;                       // of the context for run_with
    struct test_case *next;
} test_case;

typedef struct test_surroundings {
    const char *file;
    void (*before)(void), (*after)(void);
    struct test_surroundings *next;
} test_surroundings;

void test_register(test_case *added);
void test_register_surroundings(test_surroundings *added);

#define TEST_REGISTER_(name)                                                                       \
    __attribute__((constructor)) static void name##_register_(void)                                \
    {                                                                                              \
        test_register(&name##_case_);                                                              \
    }

#define TEST_CASE_(name, slow)                                                                     \
    static void name(void);                                                                        \
    static test_case name##_case_ = {__FILE__, #name, __LINE__, slow, name, NULL, 0, NULL};        \
    TEST_REGISTER_(name)                                                                           \
    static void name(void)

#define TEST_CASE_WITH_(name, workers, slow)                                                       \
    static void name(alp_context *context);                                                        \
    static test_case name##_case_ = {__FILE__, #name, __LINE__, slow, NULL, name, workers, NULL};  \
    TEST_REGISTER_(name)                                                                           \
    static void name(alp_context *context)

#endif
