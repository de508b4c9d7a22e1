// SPDX-License-Identifier: MIT
#include "library.h"

#include "options/options.h"
#include "printing/messages.h"

#include <alpenglow/alpenglow.h>

#include <stdio.h>
#include <stdlib.h>

/// Reads MAJOR.MINOR.PATCH. @return a number that is larger for later versions
static long read_version(const char *text)
{
    enum { PARTS = 3, PART_LIMIT = 1000 };
    long version = 0;
    for (int i = 0; i < PARTS; i++) {
        char *end;
        version = version * PART_LIMIT + strtol(text, &end, 10);
        text = *end == '.' ? end + 1 : end;
    }
    return version;
}

int library_check(void)
{
    const char *found = alp_version();
    if (read_version(found) >= read_version(ALP_VERSION_STRING)) {
        return EXIT_DONE;
    }
    char text[256];
    snprintf(text, sizeof text,
             "the library libalpenglow is of version %.32s, older than this program (%s); install "
             "both of one version",
             found, ALP_VERSION_STRING);
    return failure(text);
}
