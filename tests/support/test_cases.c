// SPDX-License-Identifier: MIT
// TEST_CASES in the environment, a pattern of * and ?, leaves the other cases of a test out.

// cmocka 1.1 needs these before it
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdlib.h>

__attribute__((constructor)) static void choose_cases(void)
{
    const char *cases = getenv("TEST_CASES");
    if (cases != NULL) {
        cmocka_set_test_filter(cases);
    }
}
