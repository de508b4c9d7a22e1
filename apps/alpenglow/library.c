// SPDX-License-Identifier: MIT
#include "library.h"

#include "options/options.h"
#include "printing/messages.h"

#include <alpenglow/alpenglow.h>

#include <stdio.h>

/// Reads MAJOR.MINOR.PATCH. @return a number that is larger for later versions; 0 for other text
static long read_version(const char *text)
{
    enum { PART_LIMIT = 1000 };
    int major = 0, minor = 0, patch = 0;
    if (sscanf(text, "%3d.%3d.%3d", &major, &minor, &patch) != 3) {
        return 0;
    }
    return ((long)major * PART_LIMIT + minor) * PART_LIMIT + patch;
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
