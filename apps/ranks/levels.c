// SPDX-License-Identifier: MIT
#include "levels.h"

#include <stddef.h>

// Values of max_isa. Machines with AVX-512 have the last level, which is none: nothing limits them.
static const char *const names[] = {"sse2", "sse4.2", "avx", "avx2", NULL};

int levels_own(void)
{
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx512f")  ? 4
           : __builtin_cpu_supports("avx2")   ? 3
           : __builtin_cpu_supports("avx")    ? 2
           : __builtin_cpu_supports("sse4.2") ? 1
                                              : 0;
#else
    return LEVEL_MOST;
#endif
}

const char *levels_lowest(const int *levels, uint32_t count)
{
    int least = LEVEL_MOST, most = LEVEL_LEAST;
    for (uint32_t i = 0; i < count; i++) {
        least = levels[i] < least ? levels[i] : least;
        most = levels[i] > most ? levels[i] : most;
    }
    return least < most ? names[least] : NULL;
}
