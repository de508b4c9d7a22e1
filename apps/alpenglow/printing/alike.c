// SPDX-License-Identifier: MIT
// Messages that differ in values and places alone, which are printed in one line.
#include "printing/alike.h"

#include "printing/messages.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

enum { NAME_LIMIT = sizeof((alike_list *)NULL)->names / sizeof(char *) };

/// Steps over a number or a quoted text. @return whether there was one
static bool skip_value(const char **at)
{
    const char *text = *at, *end = NULL;
    if (text[0] == '"') {
        end = strchr(text + 1, '"');
        *at = end != NULL ? end + 1 : text;
        return end != NULL;
    }
    char *behind = NULL;
    if (isdigit((unsigned char)text[text[0] == '-'])) {
        strtod(text, &behind);
        *at = behind;
    }
    return behind != NULL;
}

/// The text behind the file that it begins with, as "a.png: cannot open" does.
static const char *behind_file(const char *text)
{
    const char *end = strstr(text, ": ");
    const bool is_file = end != NULL && memchr(text, '.', (size_t)(end - text)) != NULL;
    return is_file ? end : text;
}

bool texts_are_alike(const char *a, const char *b)
{
    a = behind_file(a);
    b = behind_file(b);
    for (;; a++, b++) {
        while (skip_value(&a) && skip_value(&b)) {
        }
        if (*a != *b || *a == '\0') {
            return *a == *b;
        }
    }
}

void alike_add(alike_list *list, const char *name)
{
    list->count++;
    for (size_t i = 0; i < list->name_count; i++) {
        if (strcmp(list->names[i], name) == 0) {
            return;
        }
    }
    if (list->name_count < NAME_LIMIT) {
        list->names[list->name_count++] = name;
    } else {
        list->has_more = true;
    }
}

/// A name without the file that the first name begins with too.
static const char *without_file(const char *name, const char *first)
{
    const char *end = strstr(first, ": ");
    const size_t length = end != NULL ? (size_t)(end - first) + 2 : 0;
    return strncmp(name, first, length) == 0 ? name + length : name;
}

void alike_print(FILE *stream, const alike_list *list)
{
    const bool several = list->count > 1;
    if (several) {
        fprintf(stream, "%zu like this, in ", list->count);
    }
    for (size_t i = 0; i < list->name_count; i++) {
        const char *name = list->names[i];
        name = i > 0 ? without_file(name, list->names[0]) : name;
        fputs(i > 0 ? "; " : "", stream);
        print_clean(stream, several && name[0] == '\0' ? "the scene" : name);
    }
    fputs(list->has_more ? "; ..." : "", stream);
    fputs(several || list->names[0][0] != '\0' ? ": " : "", stream);
}
