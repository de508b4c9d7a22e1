// SPDX-License-Identifier: MIT
#include "base/tiles/checkpoint_compare.h"

#include <stdio.h>
#include <string.h>

/// The value of a setting, with its length; NULL: there is none of this name.
static const char *find_setting(const char *settings, const char *name, size_t length,
                                size_t *value_length)
{
    for (const char *line = settings; *line != '\0';) {
        const size_t size = strcspn(line, "\n");
        if (size > length && line[length] == ' ' && strncmp(line, name, length) == 0) {
            *value_length = size - length - 1;
            return line + length + 1;
        }
        line += size + (line[size] == '\n' ? 1 : 0);
    }
    return NULL;
}

/// Part of a text.
typedef struct words {
    const char *text;
    size_t length;
} words;

static void add_difference(words name, words was, words is, char *text, size_t room)
{
    const size_t used = strlen(text);
    if (used + 1 < room) {
        snprintf(text + used, room - used, "%s%.*s was %.*s and is %.*s", used > 0 ? "; " : "",
                 (int)name.length, name.text, (int)was.length, was.text, (int)is.length, is.text);
    }
}

/// Adds the settings of `ours` that `theirs` lacks or has with another value.
/// @param gone `ours` are those of the folder; settings with another value are left out
static void add_differences(const char *ours, const char *theirs, bool gone, char *text,
                            size_t room)
{
    const words none = {"none", 4};
    for (const char *line = ours; *line != '\0';) {
        const size_t size = strcspn(line, "\n"), length = strcspn(line, " \n");
        const words own = {line + length + 1, size > length ? size - length - 1 : 0};
        words other = {NULL, 0};
        other.text = find_setting(theirs, line, length, &other.length);
        if (other.text == NULL) {
            add_difference((words){line, length}, gone ? own : none, gone ? none : own, text, room);
        } else if (!gone &&
                   (other.length != own.length || strncmp(other.text, own.text, own.length) != 0)) {
            add_difference((words){line, length}, other, own, text, room);
        }
        line += size + (line[size] == '\n' ? 1 : 0);
    }
}

alp_result alpi_checkpoint_compare(alp_context *context, const char *folder, const char *ours,
                                   const char *theirs)
{
    char text[600] = "";
    if (strcmp(theirs, ours) == 0) {
        return ALP_OK;
    }
    add_differences(ours, theirs, false, text, sizeof text);
    add_differences(theirs, ours, true, text, sizeof text);
    return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                     "%s: the folder keeps the checkpoint of another bake: %s; use the same "
                     "command, another folder, or remove this one",
                     folder, text);
}
