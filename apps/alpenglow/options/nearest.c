// SPDX-License-Identifier: MIT
// The known word nearest to a misspelt one.
#include "options/options.h"

#include <stdio.h>
#include <string.h>

/// Edits between two words: insert, delete, replace, exchange two neighbours.
/// Based on: F. Damerau. A technique for computer detection and correction of spelling errors.
/// CACM 1964 (the restricted form: no part is edited twice).
static size_t edit_distance(const char *a, const char *b)
{
    enum { LONGEST = 40 };
    size_t rows[3][LONGEST + 1];
    size_t a_length = strlen(a), b_length = strlen(b);
    if (a_length > LONGEST || b_length > LONGEST) {
        return SIZE_MAX;
    }
    size_t *before = rows[0], *last = rows[1], *now = rows[2];
    for (size_t j = 0; j <= b_length; j++) {
        last[j] = j;
        before[j] = 0;
    }
    for (size_t i = 1; i <= a_length; i++) {
        now[0] = i;
        for (size_t j = 1; j <= b_length; j++) {
            size_t replaced = last[j - 1] + (a[i - 1] != b[j - 1]);
            size_t dropped = (last[j] < now[j - 1] ? last[j] : now[j - 1]) + 1;
            now[j] = replaced < dropped ? replaced : dropped;
            bool exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (exchanged && before[j - 2] + 1 < now[j]) {
                now[j] = before[j - 2] + 1;
            }
        }
        size_t *oldest = before;
        before = last;
        last = now;
        now = oldest;
    }
    return last[b_length];
}

/// Distance of a known word from the written one. It is 1 if the known one begins with the written
/// one, of 4 letters or more.
static size_t word_distance(const char *written, const char *known)
{
    size_t length = strlen(written);
    if (length >= 4 && strncmp(written, known, length) == 0) {
        return 1;
    }
    return edit_distance(written, known);
}

/// A third of the letters may be wrong.
static size_t distance_limit(const char *written)
{
    return strlen(written) / 3 + 1;
}

void choice_nearest(const char *choices, const char *word, size_t length, char *nearest,
                    size_t size)
{
    enum { LONGEST = 40 };
    char written[LONGEST + 1], known[LONGEST + 1];
    nearest[0] = '\0';
    if (choices == NULL || length < 3 || length > LONGEST) {
        return;
    }
    snprintf(written, sizeof written, "%.*s", (int)length, word);
    size_t best = distance_limit(written);
    for (const char *at = choices; at != NULL;) {
        const size_t end = strcspn(at, "|");
        snprintf(known, sizeof known, "%.*s", (int)end, at);
        const size_t distance = end < 2 || end > LONGEST ? SIZE_MAX : word_distance(written, known);
        if (distance < best) {
            best = distance;
            snprintf(nearest, size, "%s", known);
        }
        at = at[end] == '|' ? at + end + 1 : NULL;
    }
}

const char *option_nearest(command_id command, const char *name)
{
    size_t best = distance_limit(name);
    const char *nearest = NULL;
    for (const option *o = option_after(command, NULL); o != NULL; o = option_after(command, o)) {
        const char *names[2] = {o->name, o->alias};
        for (int k = 0; k < 2; k++) {
            if (names[k] == NULL || strlen(names[k]) < 3) {
                continue;
            }
            size_t distance = word_distance(name, names[k]);
            if (distance < best) {
                best = distance;
                nearest = names[k];
            }
        }
    }
    return nearest;
}

const char *command_nearest(const char *name)
{
    size_t best = distance_limit(name);
    const char *nearest = NULL;
    for (int i = 0; i < COMMAND_COUNT; i++) {
        size_t distance = word_distance(name, command_table()[i].name);
        if (distance < best) {
            best = distance;
            nearest = command_table()[i].name;
        }
    }
    return nearest;
}
