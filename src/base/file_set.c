// SPDX-License-Identifier: MIT
// Files that belong together. A rename that fails after others went well is undone by second names
// (hard links) of the files that were there before, so that a path always names a whole file.
#include "base/file_set.h"

#include "base/memory.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/// What was at a path before.
typedef enum former { FORMER_NONE, FORMER_KEPT, FORMER_LOST } former;

alp_result alpi_file_set_add(alpi_file_set *set, const char *path, const void *bytes, size_t size)
{
    void *writers = set->writers;
    ALP_TRY(
        alpi_grow(set->context, &writers, &set->capacity, set->count + 1, sizeof *set->writers));
    set->writers = writers;
    alpi_file_writer *writer = &set->writers[set->count];
    ALP_TRY(alpi_file_open(set->context, path, set->overwrite, writer));
    set->count++;
    ALP_TRY(alpi_file_append(writer, bytes, size));
    return alpi_file_finish(writer); // now: descriptors are few
}

/// The second name of what is at a path.
static char *former_name(const alpi_file_set *set, const alpi_file_writer *writer)
{
    return alpi_format(set->context, "%s.old", writer->temporary);
}

static former keep_former(const alpi_file_writer *writer, const char *name)
{
    if (access(writer->path, F_OK) != 0) {
        return FORMER_NONE;
    }
    return link(writer->path, name) == 0 ? FORMER_KEPT : FORMER_LOST;
}

static void take_back(const alpi_file_writer *writer, former state, const char *name)
{
    if (state == FORMER_KEPT) {
        (void)!rename(name, writer->path); // nothing more can be done if this fails as well
    } else if (state == FORMER_NONE) {
        unlink(writer->path);
    }
}

/// @param names, states [count] out, of those that were put in place
static alp_result place_all(alpi_file_set *set, char **names, former *states)
{
    size_t placed = 0;
    alp_result result = ALP_OK;
    for (; placed < set->count && result == ALP_OK; placed++) {
        alpi_file_writer *writer = &set->writers[placed];
        states[placed] = keep_former(writer, names[placed]);
        result = alpi_file_place(writer);
        if (result != ALP_OK && states[placed] == FORMER_KEPT) {
            unlink(names[placed]);
        }
    }
    if (result != ALP_OK) {
        for (size_t i = placed - 1; i-- > 0;) {
            take_back(&set->writers[i], states[i], names[i]);
        }
        return result;
    }
    for (size_t i = 0; i < set->count; i++) {
        if (states[i] == FORMER_KEPT) {
            unlink(names[i]);
        }
    }
    return ALP_OK;
}

alp_result alpi_file_set_commit(alpi_file_set *set)
{
    char **names = ALPI_NEW(set->context, char *, set->count);
    former *states = ALPI_NEW(set->context, former, set->count);
    bool complete = names != NULL && states != NULL;
    for (size_t i = 0; complete && i < set->count; i++) {
        names[i] = former_name(set, &set->writers[i]);
        complete = names[i] != NULL;
    }
    alp_result result = complete ? place_all(set, names, states) : ALP_ERROR_OUT_OF_MEMORY;
    for (size_t i = 0; names != NULL && i < set->count; i++) {
        alpi_release(set->context, names[i]);
    }
    alpi_release(set->context, names);
    alpi_release(set->context, states);
    alpi_file_set_abandon(set);
    return result;
}

void alpi_file_set_abandon(alpi_file_set *set)
{
    for (size_t i = 0; i < set->count; i++) {
        alpi_file_abandon(&set->writers[i]);
    }
    alpi_release(set->context, set->writers);
    *set = alpi_file_set_create(set->context, set->overwrite);
}

alp_result alpi_file_set_end(alpi_file_set *set, alp_result result)
{
    if (result == ALP_OK) {
        return alpi_file_set_commit(set);
    }
    alpi_file_set_abandon(set);
    return result;
}
