// SPDX-License-Identifier: MIT
// Messages that differ in values and places alone, which are printed in one line.
#ifndef COMMAND_ALIKE_H
#define COMMAND_ALIKE_H

#include <stdbool.h>
#include <stdio.h>

/// Whether two texts differ in numbers, in quoted texts and in the file they begin with alone.
bool texts_are_alike(const char *a, const char *b);

/// Messages that are printed in one line, and the first places that they name.
typedef struct alike_list {
    size_t count;
    const char *names[3]; // borrowed
    size_t name_count;
    bool has_more; // other names
} alike_list;

void alike_add(alike_list *list, const char *name);
/// Prints what stands before the text: "name: " of one message, "40 like this, in a; b; c; ...: "
/// of several.
void alike_print(FILE *stream, const alike_list *list);

#endif
