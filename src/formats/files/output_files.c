// SPDX-License-Identifier: MIT
#include "formats/files/output_files.h"

#include "base/memory.h"

#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

alp_result alpi_output_files_add(alpi_output_files *files, alpi_output_file file)
{
    void *items = files->items;
    if (file.path == NULL || alpi_grow(files->context, &items, &files->capacity, files->count + 1,
                                       sizeof *files->items) != ALP_OK) {
        alpi_release(files->context, file.path);
        alpi_release(files->context, file.owned);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    files->items = items;
    files->items[files->count++] = file;
    return ALP_OK;
}

/// Whether a file holds exactly these bytes; one that cannot be read does not.
static alp_result compare_file(alp_context *context, const char *path, const uint8_t *bytes,
                               size_t size, bool *same)
{
    uint8_t *there = NULL;
    size_t there_size = 0;
    *same = false;
    if (access(path, F_OK) != 0) {
        return ALP_OK;
    }
    const alp_result result = alpi_file_read(context, path, size, &there, &there_size);
    *same = result == ALP_OK && there_size == size && memcmp(there, bytes, size) == 0;
    alpi_release(context, there);
    return result == ALP_ERROR_OUT_OF_MEMORY ? result : ALP_OK;
}

alp_result alpi_output_files_add_copy(alpi_output_files *files, char *path, uint8_t *bytes,
                                      size_t size)
{
    bool repeated = false;
    const alp_result result = path == NULL
                                  ? ALP_ERROR_OUT_OF_MEMORY
                                  : compare_file(files->context, path, bytes, size, &repeated);
    for (size_t i = 0; result == ALP_OK && i < files->count; i++) {
        repeated |= strcmp(files->items[i].path, path) == 0; // two images, one file
    }
    if (repeated || result != ALP_OK) {
        alpi_release(files->context, path);
        alpi_release(files->context, bytes);
        return result;
    }
    return alpi_output_files_add(files, (alpi_output_file){path, bytes, size, bytes});
}

void alpi_output_files_destroy(alpi_output_files *files)
{
    for (size_t i = 0; i < files->count; i++) {
        alpi_release(files->context, files->items[i].path);
        alpi_release(files->context, files->items[i].owned);
    }
    alpi_release(files->context, files->items);
    *files = (alpi_output_files){.context = files->context};
}

alp_result alpi_output_files_make_folders(const alpi_output_files *files)
{
    for (size_t i = 0; i < files->count; i++) {
        char *folder = alpi_path_folder(files->context, files->items[i].path);
        alp_result result = folder == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
        if (result == ALP_OK && folder[0] != '\0') {
            result = alpi_folder_create(files->context, folder);
        }
        alpi_release(files->context, folder);
        ALP_TRY(result);
    }
    return ALP_OK;
}

alp_result alpi_output_files_add_to(const alpi_output_files *files, alpi_file_set *set)
{
    for (size_t i = 0; i < files->count; i++) {
        const alpi_output_file *file = &files->items[i];
        ALP_TRY(alpi_file_set_add(set, file->path, file->bytes, file->size));
    }
    return ALP_OK;
}

bool alpi_same_folder(const char *a, const char *b)
{
    struct stat first, second;
    return stat(a[0] != '\0' ? a : ".", &first) == 0 &&
           stat(b[0] != '\0' ? b : ".", &second) == 0 && first.st_dev == second.st_dev &&
           first.st_ino == second.st_ino;
}
