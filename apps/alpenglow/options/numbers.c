// SPDX-License-Identifier: MIT
// Numbers of the command line: strict, without blanks, hexadecimal, NaN and infinity.
#include "options/options.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT_SIZE = 160 };

number_result number_parse_whole(const char *text, uint64_t *number)
{
    if (*text == '\0' || text[strspn(text, "0123456789")] != '\0') {
        return NUMBER_NONE;
    }
    errno = 0;
    unsigned long long parsed = strtoull(text, NULL, 10);
    *number = parsed;
    return errno == ERANGE ? NUMBER_TOO_LARGE : NUMBER_OK;
}

number_result number_parse_size(const char *text, uint64_t *number)
{
    static const char units[] = "KMG";
    char digits[32];
    const size_t length = strspn(text, "0123456789");
    const char *unit = text[length] != '\0' ? strchr(units, text[length]) : NULL;
    if (length == 0 || length >= sizeof digits ||
        (text[length] != '\0' && (unit == NULL || text[length + 1] != '\0'))) {
        return NUMBER_NONE;
    }
    memcpy(digits, text, length);
    digits[length] = '\0';
    number_result result = number_parse_whole(digits, number);
    for (int i = 0; unit != NULL && i <= unit - units; i++) {
        result = *number > UINT64_MAX / 1024 ? NUMBER_TOO_LARGE : result;
        *number *= 1024;
    }
    return result;
}

/// Digits, and perhaps k for 1024. @return the end, or NULL
static const char *parse_kilo(const char *text, uint64_t *number)
{
    char digits[32];
    const size_t length = strspn(text, "0123456789");
    if (length == 0 || length >= sizeof digits) {
        return NULL;
    }
    memcpy(digits, text, length);
    digits[length] = '\0';
    const bool kilo = text[length] == 'k' || text[length] == 'K';
    if (number_parse_whole(digits, number) != NUMBER_OK || (kilo && *number > UINT32_MAX)) {
        *number = UINT64_MAX;
    } else if (kilo) {
        *number *= 1024;
    }
    return text + length + kilo;
}

number_result number_parse_side(const char *text, uint64_t *number)
{
    uint64_t other = 0;
    const char *end = parse_kilo(text, number);
    if (end != NULL && *end == 'x') {
        end = parse_kilo(end + 1, &other);
        end = end != NULL && other == *number ? end : NULL;
    }
    return end == NULL || *end != '\0' ? NUMBER_NONE
           : *number == UINT64_MAX     ? NUMBER_TOO_LARGE
                                       : NUMBER_OK;
}

number_result number_parse_real(const char *text, double *number)
{
    // strtod alone would accept leading blanks, hexadecimal, nan and inf.
    if (*text == '\0' || text[strspn(text, "0123456789+-.eE")] != '\0') {
        return NUMBER_NONE;
    }
    char *end = NULL;
    *number = strtod(text, &end);
    if (end == text || *end != '\0') {
        return NUMBER_NONE;
    }
    return isfinite(*number) ? NUMBER_OK : NUMBER_TOO_LARGE;
}

const char *number_parse_list(const char *text, double *numbers, int count)
{
    for (int i = 0; i < count; i++) {
        char word[64];
        const size_t length = strcspn(text, ",/");
        if (length == 0 || length >= sizeof word) {
            return NULL;
        }
        memcpy(word, text, length);
        word[length] = '\0';
        if (number_parse_real(word, &numbers[i]) != NUMBER_OK || fabs(numbers[i]) > 1e9) {
            return NULL;
        }
        text += length;
        if (i + 1 < count && *text++ != ',') {
            return NULL;
        }
    }
    return text;
}

void option_range(const option *o, char *text, size_t size)
{
    // %.16g prints whole numbers in full, and 1e-06 short.
    int length = o->minimum < o->maximum
                     ? snprintf(text, size, "%.16g to %.16g", o->minimum, o->maximum)
                     : snprintf(text, size, "%.16g", o->minimum);
    if (o->unit != NULL && length > 0 && (size_t)length < size) {
        length += snprintf(text + length, size - (size_t)length, " %s", o->unit);
    }
    if (o->choices != NULL && length > 0 && (size_t)length < size) {
        char words[TEXT_SIZE];
        snprintf(words, sizeof words, "%s", o->choices);
        for (char *bar = strchr(words, '|'); bar != NULL; bar = strchr(bar, '|')) {
            *bar = '/';
        }
        snprintf(text + length, size - (size_t)length, ", or %s", words);
    }
}
