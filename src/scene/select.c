// SPDX-License-Identifier: MIT
// Surfaces by the patterns of their names.
#include "scene/select.h"

#include "base/glob.h"
#include "base/memory.h"

#include <stdio.h>
#include <string.h>

enum { NAMED_LIMIT = 8, NAMED_SIZE = 200 }; // names that a message lists, and bytes of a pattern

/// The first names of the scene, each once, as far as there is room.
static void list_names(const alp_scene *scene, char *text, size_t size)
{
    const char *listed[NAMED_LIMIT];
    size_t used = 0;
    int count = 0;
    text[0] = '\0';
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const char *name = scene->surfaces[s].name;
        bool repeated = false;
        for (int i = 0; i < count; i++) {
            repeated = repeated || strcmp(listed[i], name) == 0;
        }
        if (repeated) {
            continue;
        }
        if (count == NAMED_LIMIT) {
            snprintf(text + used, size - used, ", …");
            return;
        }
        const int length =
            snprintf(text + used, size - used, "%s\"%s\"", count > 0 ? ", " : "", name);
        if (length < 0 || (size_t)length >= size - used) {
            text[used] = '\0'; // no half names
            return;
        }
        used += (size_t)length;
        listed[count++] = name;
    }
}

static alp_result fail_without_match(const alp_scene *scene, const char *pattern, size_t size)
{
    char names[512];
    list_names(scene, names, sizeof names);
    return alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                     "%s: no surface has a name like \"%.*s\"; the names are %s", scene->name,
                     size < NAMED_SIZE ? (int)size : NAMED_SIZE, pattern,
                     names[0] != '\0' ? names : "none");
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
