// SPDX-License-Identifier: MIT
// The lowest instruction set of ranks. No assertion of a library: it may be built without one.
#include "levels.h"

#include <stdio.h>
#include <string.h>

static int check(const char *wanted, const int *levels, uint32_t count)
{
    const char *found = levels_lowest(levels, count);
    const int good = wanted == NULL ? found == NULL : found != NULL && strcmp(wanted, found) == 0;
    if (!good) {
        printf("wanted %s, found %s\n", wanted ? wanted : "none", found ? found : "none");
    }
    return good ? 0 : 1;
}

int main(void)
{
    const int own = levels_own();
    int faults = own >= LEVEL_LEAST && own <= LEVEL_MOST ? 0 : 1;
    faults += check(NULL, (const int[]){4}, 1);
    faults += check(NULL, (const int[]){3, 3, 3}, 3);
    faults += check("avx2", (const int[]){4, 4, 3}, 3);
    faults += check("sse4.2", (const int[]){3, 1, 4, 2}, 4);
    faults += check("sse2", (const int[]){0, 4}, 2);
    return faults;
}
