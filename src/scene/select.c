// SPDX-License-Identifier: MIT
// Surfaces by the patterns of their names.
#include "scene/select.h"

#include "base/glob.h"
#include "base/memory.h"

#include <stdio.h>
#include <string.h>

enum {
    NAMED_LIMIT = 8,    // names that a message lists
    NAMED_SIZE = 200,   // bytes of a pattern that it repeats
    COMPARED_SIZE = 64, // bytes of a name that tell whether it is near
};

/// Insertions, deletions and exchanges of bytes that make one text of the other, small letters and
/// capitals alike; of long texts the beginnings count. A pattern's * costs nothing.
static uint32_t edit_distance(const char *pattern, size_t size, const char *name)
{
    uint32_t row[COMPARED_SIZE + 1];
    const size_t length = strnlen(name, COMPARED_SIZE);
    for (size_t j = 0; j <= length; j++) {
        row[j] = (uint32_t)j;
    }
    for (size_t i = 0; i < size && i < COMPARED_SIZE; i++) {
        if (pattern[i] == '*') {
            continue;
        }
        uint32_t diagonal = row[0]++;
        for (size_t j = 0; j < length; j++) {
            const bool same = (pattern[i] | 0x20) == (name[j] | 0x20);
            const uint32_t exchanged = diagonal + !same;
            const uint32_t shorter = (row[j] < row[j + 1] ? row[j] : row[j + 1]) + 1;
            diagonal = row[j + 1];
            row[j + 1] = exchanged < shorter ? exchanged : shorter;
        }
    }
    return row[length];
}

/// The names nearest to a pattern that matches none, each once, nearest first.
typedef struct near_names {
    const char *names[NAMED_LIMIT];
    uint32_t distances[NAMED_LIMIT];
    int count;
    bool more; // there are others
} near_names;

static void add_name(near_names *list, const char *name, uint32_t distance)
{
    for (int i = 0; i < list->count; i++) {
        if (strcmp(list->names[i], name) == 0) {
            return;
        }
    }
    int at = list->count;
    while (at > 0 && distance < list->distances[at - 1]) {
        at--;
    }
    list->more = list->more || list->count == NAMED_LIMIT;
    if (at == NAMED_LIMIT) {
        return;
    }
    list->count += list->count < NAMED_LIMIT;
    for (int i = list->count - 1; i > at; i--) {
        list->names[i] = list->names[i - 1];
        list->distances[i] = list->distances[i - 1];
    }
    list->names[at] = name;
    list->distances[at] = distance;
}

/// As many of the names as there is room for.
static void print_names(const near_names *list, char *text, size_t size)
{
    size_t used = 0;
    bool more = list->more;
    text[0] = '\0';
    for (int i = 0; i < list->count; i++) {
        const int length =
            snprintf(text + used, size - used, "%s\"%s\"", i > 0 ? ", " : "", list->names[i]);
        if (length < 0 || (size_t)length >= size - used - sizeof ", …") {
            text[used] = '\0'; // no half names
            more = true;
            break;
        }
        used += (size_t)length;
    }
    snprintf(text + used, size - used, "%s%s", more && used > 0 ? ", " : "",
             list->count == 0 ? "none"
             : more           ? "…"
                              : "");
}

static alp_result fail_without_match(const alp_scene *scene, const char *pattern, size_t size)
{
    char names[512];
    near_names list = {.count = 0};
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const char *name = scene->surfaces[s].name;
        add_name(&list, name, edit_distance(pattern, size, name));
    }
    print_names(&list, names, sizeof names);
    return alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                     "%s: no surface has a name like \"%.*s\"; the nearest names are %s",
                     scene->name, size < NAMED_SIZE ? (int)size : NAMED_SIZE, pattern, names);
}

/// Marks the surfaces that one pattern matches.
static bool mark_matches(const alp_scene *scene, const char *pattern, size_t size, bool *surfaces)
{
    bool found = false;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        if (alpi_glob_match(pattern, size, scene->surfaces[s].name)) {
            surfaces[s] = true;
            found = true;
        }
    }
    return found;
}

alp_result alpi_scene_select(const alp_scene *scene, const char *pattern, bool **surfaces)
{
    *surfaces = NULL;
    if (pattern == NULL) {
        return ALP_OK;
    }
    bool *marks = ALPI_NEW(scene->context, bool, scene->surface_count);
    if (marks == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (const char *at = pattern;; at++) {
        const size_t size = alpi_glob_length(at);
        if (!mark_matches(scene, at, size, marks)) {
            alpi_release(scene->context, marks);
            return fail_without_match(scene, at, size);
        }
        at += size;
        if (*at == '\0') {
            break;
        }
    }
    *surfaces = marks;
    return ALP_OK;
}
