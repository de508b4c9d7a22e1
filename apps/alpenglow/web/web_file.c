// SPDX-License-Identifier: MIT
#include "web/web_file.h"

#include "options/options.h"
#include "printing/messages.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

int web_fail(const char *path, const char *text)
{
    fputs("alpenglow: ", stderr);
    print_clean(stderr, path);
    fprintf(stderr, ": %s\n", text);
    return EXIT_FAILED;
}

/// Bytes of a file that a page may hold: four thirds of them are the longest text of a browser.
enum { FILE_LIMIT = 400000000 };
static const char too_large[] = "has over 400 MB, more than a browser reads as one text; bake with "
                                "smaller maps (--size)";

const char *web_reason(int number)
{
    return number == EFBIG ? too_large : strerror(number);
}

char *web_read_bytes(const char *path, size_t *size)
{
    struct stat about;
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return NULL;
    }
    char *bytes = NULL;
    errno = 0;
    if (fstat(fileno(file), &about) == 0 && S_ISREG(about.st_mode)) {
        if (about.st_size > FILE_LIMIT) {
            fclose(file);
            errno = EFBIG;
            return NULL;
        }
        *size = (size_t)about.st_size;
        bytes = allocate_or_exit(NULL, *size + 1);
        bytes[*size] = '\0';
    }
    if (bytes != NULL && fread(bytes, 1, *size, file) != *size) {
        free(bytes);
        bytes = NULL;
    }
    if (bytes == NULL && errno == 0) {
        errno = S_ISDIR(about.st_mode) ? EISDIR : EIO;
    }
    fclose(file);
    return bytes;
}

char *web_read_file(const char *path, size_t *size)
{
    char *bytes = web_read_bytes(path, size);
    if (bytes == NULL) {
        web_fail(path, web_reason(errno));
    }
    return bytes;
}

static int hex_digit(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

void web_decode_address(char *text)
{
    char *to = text;
    for (const char *at = text; *at != '\0'; to++) {
        const int high = at[0] == '%' ? hex_digit(at[1]) : -1;
        const int low = high >= 0 ? hex_digit(at[2]) : -1;
        const bool coded = low >= 0 && 16 * high + low != 0;
        *to = coded ? (char)(16 * high + low) : *at;
        at += coded ? 3 : 1;
    }
    *to = '\0';
}
