// SPDX-License-Identifier: MIT
// Lists the states of a folder.
#include "base/file.h"
#include "base/memory.h"
#include "base/tiles/checkpoint.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/// The name of a process, if a file is a state, or the older one of a state that is not there.
static char *process_of(alp_context *context, const char *file)
{
    const char *end = strstr(file, ".state");
    if (end == NULL || end == file || (end[6] != '\0' && strcmp(end + 6, ".old") != 0)) {
        return NULL;
    }
    char *name = alpi_copy_string(context, file);
    if (name != NULL) {
        name[end - file] = '\0';
    }
    return name;
}

static alp_result list_names(alpi_checkpoint_list *l, DIR *folder)
{
    size_t capacity = 0;
    for (struct dirent *entry = readdir(folder); entry != NULL; entry = readdir(folder)) {
        char *name = process_of(l->context, entry->d_name);
        if (name == NULL) {
            continue;
        }
        const alp_result result =
            alpi_grow(l->context, (void **)&l->names, &capacity, l->count + 1, sizeof *l->names);
        if (result != ALP_OK) {
            alpi_release(l->context, name);
            return result;
        }
        l->names[l->count++] = name;
    }
    return ALP_OK;
}

/// Each name once: a state and its older one are one process.
static void drop_repeated(alpi_checkpoint_list *l)
{
    size_t kept = 0;
    if (l->count > 1) {
        qsort(l->names, l->count, sizeof *l->names, compare_names);
    }
    for (size_t i = 0; i < l->count; i++) {
        if (kept > 0 && strcmp(l->names[kept - 1], l->names[i]) == 0) {
            alpi_release(l->context, l->names[i]);
        } else {
            l->names[kept++] = l->names[i];
        }
    }
    l->count = kept;
}

/// Reads the states; names of damaged ones are dropped.
static alp_result read_states(alpi_checkpoint_list *l, const char *folder)
{
    size_t kept = 0;
    l->states = ALPI_NEW(l->context, alpi_checkpoint_state, l->count);
    if (l->states == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (size_t i = 0; i < l->count; i++) {
        bool damaged = false;
        char *path = alpi_format(l->context, "%s/%s.state", folder, l->names[i]);
        const bool good = path != NULL &&
                          alpi_checkpoint_state_read(l->context, path, &l->states[kept], &damaged);
        l->damaged += damaged || !good ? 1 : 0;
        if (good) {
            l->names[kept++] = l->names[i];
        } else {
            alpi_release(l->context, l->names[i]);
        }
        alpi_release(l->context, path);
    }
    l->count = kept;
    return ALP_OK;
}

alp_result alpi_checkpoint_list_states(alp_context *context, const char *folder,
                                       alpi_checkpoint_list *list)
{
    *list = (alpi_checkpoint_list){.context = context};
    DIR *opened = opendir(folder);
    if (opened == NULL) {
        return errno == ENOENT ? ALP_OK
                               : alpi_fail(context, ALP_ERROR_IO, "%s: cannot read the folder: %s",
                                           folder, strerror(errno));
    }
    alp_result result = list_names(list, opened);
    closedir(opened);
    if (result == ALP_OK) {
        drop_repeated(list);
        result = read_states(list, folder);
    } else {
        for (size_t i = 0; i < list->count; i++) {
            alpi_release(context, list->names[i]);
        }
        list->count = 0;
    }
    if (result != ALP_OK) {
        alpi_checkpoint_list_clear(list);
    }
    return result;
}

bool alpi_checkpoint_is_free(alp_context *context, const char *folder, const char *name)
{
    char *path = alpi_format(context, "%s/%s.tiles", folder, name);
    const int file = path != NULL ? open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK) : -1;
    const bool is_free = file >= 0 && flock(file, LOCK_SH | LOCK_NB) == 0; // others may read too
    if (file >= 0) {
        close(file);
    }
    alpi_release(context, path);
    return is_free;
}

void alpi_checkpoint_list_clear(alpi_checkpoint_list *list)
{
    for (size_t i = 0; i < list->count; i++) {
        if (list->states != NULL) {
            alpi_checkpoint_state_clear(list->context, &list->states[i]);
        }
        alpi_release(list->context, list->names[i]);
    }
    alpi_release(list->context, list->states);
    alpi_release(list->context, list->names);
    *list = (alpi_checkpoint_list){.context = NULL};
}
