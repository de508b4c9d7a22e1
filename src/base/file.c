// SPDX-License-Identifier: MIT
#include "base/file.h"

#include "base/guard.h"
#include "base/memory.h"
#include "base/tiles/tiles.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    NAME_LIMIT = 1000, // temporary names tried
    STEM_LIMIT = 200,  // bytes of a name that they begin with
    PIECE = 1 << 22,   // bytes written between two questions whether to go on
    LINK_LIMIT = 40,   // links to links, as many as Linux follows
    LINK_SIZE = 4096   // bytes of what a link names
};

static alp_result fail_io(alp_context *context, const char *verb, const char *path)
{
    return alpi_fail(context, ALP_ERROR_IO, "%s: cannot %s: %s", path, verb, strerror(errno));
}

static alp_result read_open_file(alp_context *context, const char *path, int descriptor,
                                 uint64_t limit, uint8_t **bytes, size_t *size)
{
    struct stat status;
    if (fstat(descriptor, &status) != 0) {
        return fail_io(context, "read", path);
    }
    if (S_ISDIR(status.st_mode)) {
        return alpi_fail(context, ALP_ERROR_IO, "%s: is a folder, a file is needed", path);
    }
    if (!S_ISREG(status.st_mode)) {
        return alpi_fail(context, ALP_ERROR_IO, "%s: is not a regular file", path);
    }
    uint64_t length = (uint64_t)status.st_size;
    if (length > limit) {
        return alpi_fail(context, ALP_ERROR_LIMIT, "%s: %llu bytes, more than the limit of %llu",
                         path, (unsigned long long)length, (unsigned long long)limit);
    }
    uint8_t *data = alpi_allocate(context, (size_t)length + 1, 1);
    if (data == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    size_t done = 0;
    while (done < length) {
        ssize_t got = read(descriptor, data + done, (size_t)length - done);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got <= 0) {
            alp_result result = got < 0 ? fail_io(context, "read", path)
                                        : alpi_fail(context, ALP_ERROR_IO,
                                                    "%s: became shorter while it was read", path);
            alpi_release(context, data);
            return result;
        }
        done += (size_t)got;
    }
    *bytes = data;
    *size = (size_t)length;
    return ALP_OK;
}

alp_result alpi_file_read(alp_context *context, const char *path, uint64_t limit, uint8_t **bytes,
                          size_t *size)
{
    *bytes = NULL;
    *size = 0;
    int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); // a FIFO must not hang us
    if (descriptor < 0) {
        return fail_io(context, "open", path);
    }
    alp_result result = read_open_file(context, path, descriptor, limit, bytes, size);
    close(descriptor);
    return result;
}

char *alpi_path_folder(alp_context *context, const char *path)
{
    const char *name = alpi_path_name(path);
    return alpi_format(context, "%.*s", (int)(name - path), path);
}

const char *alpi_path_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

bool alpi_path_has_ending(const char *path, const char *ending)
{
    size_t length = strlen(path), wanted = strlen(ending);
    return length >= wanted && strcasecmp(path + length - wanted, ending) == 0;
}

/// What the link `path` names, from the working folder.
static alp_result read_link(alp_context *context, const char *path, char **target)
{
    char text[LINK_SIZE];
    const ssize_t length = readlink(path, text, sizeof text);
    if (length < 0 || (size_t)length == sizeof text) {
        errno = length < 0 ? errno : ENAMETOOLONG;
        return fail_io(context, "follow the link", path);
    }
    char *folder = alpi_path_folder(context, path);
    if (folder != NULL) {
        *target = alpi_format(context, "%s%.*s", text[0] == '/' ? "" : folder, (int)length, text);
    }
    alpi_release(context, folder);
    return folder == NULL || *target == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

alp_result alpi_path_follow(alp_context *context, const char *path, char **end)
{
    struct stat status;
    *end = alpi_copy_string(context, path);
    for (int links = 0; *end != NULL; links++) {
        if (lstat(*end, &status) != 0 || !S_ISLNK(status.st_mode)) {
            return ALP_OK;
        }
        char *next = NULL;
        errno = ELOOP;
        alp_result result = links < LINK_LIMIT ? read_link(context, *end, &next)
                                               : fail_io(context, "follow the link", path);
        alpi_release(context, *end);
        *end = next;
        ALP_TRY(result);
    }
    return ALP_ERROR_OUT_OF_MEMORY;
}

static alp_result check_folder(alp_context *context, const char *path)
{
    char *end = NULL;
    ALP_TRY(alpi_path_follow(context, path, &end));
    char *folder = alpi_path_folder(context, end);
    alp_result result = folder == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
    if (folder != NULL && access(folder[0] ? folder : ".", W_OK | X_OK) != 0) {
        result = errno == ENOENT
                     ? alpi_fail(context, ALP_ERROR_IO,
                                 "%s: its folder does not exist; make it first (mkdir -p)", path)
                     : alpi_fail(context, ALP_ERROR_IO, "%s: its folder cannot be written: %s",
                                 path, strerror(errno));
    }
    alpi_release(context, folder);
    alpi_release(context, end);
    return result;
}

alp_result alpi_file_check_writable(alp_context *context, const char *path, bool overwrite)
{
    struct stat status;
    if (alpi_path_name(path)[0] == '\0') {
        return alpi_fail(context, ALP_ERROR_IO, "\"%s\": a file name is needed", path);
    }
    if (stat(path, &status) == 0) {
        if (S_ISDIR(status.st_mode)) {
            return alpi_fail(context, ALP_ERROR_IO, "%s: is a folder, a file name is needed", path);
        }
        if (!S_ISREG(status.st_mode)) { // renaming onto a device would replace the device
            return alpi_fail(context, ALP_ERROR_IO, "%s: is not a regular file", path);
        }
        if (alpi_guard_holds(*alpi_context_guard(context),
                             (alpi_file_id){status.st_dev, status.st_ino})) {
            return alpi_fail(context, ALP_ERROR_IO,
                             "%s: is a file that the scene refers to, which is never overwritten; "
                             "give the output another name",
                             path);
        }
        if (!overwrite) {
            return alpi_fail(context, ALP_ERROR_IO,
                             "%s: exists already and would be overwritten; force it (-f) or name "
                             "another file",
                             path);
        }
    } else if (errno == ENAMETOOLONG) {
        return fail_io(context, "write", path);
    }
    return check_folder(context, path);
}

/// Bytes of the path that begin a temporary name: what is added must have room in a name too.
static size_t stem_length(const char *path)
{
    const char *name = alpi_path_name(path);
    size_t length = strlen(name);
    if (length > STEM_LIMIT) {
        for (length = STEM_LIMIT; length > 0 && ((unsigned char)name[length] & 0xc0) == 0x80;) {
            length--; // whole characters of UTF-8
        }
    }
    return (size_t)(name - path) + length;
}

/// Opens a temporary file beside the final place, under the first name that is free.
static alp_result open_temporary(alpi_file_writer *writer)
{
    const int stem = (int)stem_length(writer->path);
    for (unsigned number = 0; number < NAME_LIMIT; number++) {
        writer->temporary = alpi_format(writer->context, "%.*s.part-%ld-%u", stem, writer->path,
                                        (long)getpid(), number);
        if (writer->temporary == NULL) {
            return ALP_ERROR_OUT_OF_MEMORY;
        }
        writer->descriptor =
            open(writer->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, (mode_t)0666);
        if (writer->descriptor >= 0) {
            return ALP_OK;
        }
        bool taken = errno == EEXIST; // by another thread, or by a run that was killed
        alp_result result = fail_io(writer->context, "create", writer->temporary);
        alpi_release(writer->context, writer->temporary);
        writer->temporary = NULL; // it is not ours to remove
        if (!taken) {
            return result;
        }
    }
    return ALP_ERROR_IO;
}

// --- leftovers -----------------------------------------------------------------------------------

/// Whether a process of this machine has ended. One that nobody waited for keeps its number: its
/// state in /proc, behind the name in parentheses, is then Z.
static bool has_ended(pid_t process)
{
    if (kill(process, 0) != 0) {
        return errno == ESRCH;
    }
    char path[64], line[512] = "";
    snprintf(path, sizeof path, "/proc/%ld/stat", (long)process);
    FILE *stream = fopen(path, "r");
    if (stream == NULL) {
        return false;
    }
    const size_t size = fread(line, 1, sizeof line - 1, stream);
    (void)fclose(stream);
    line[size] = '\0';
    const char *name_end = strrchr(line, ')');
    return name_end != NULL && name_end[1] == ' ' && name_end[2] == 'Z';
}

/// Whether a file is a temporary one of `name`, by a process of this machine that has ended.
static bool is_leftover(const char *file, const char *name, size_t length)
{
    static const char ending[] = ".part-";
    const size_t size = sizeof ending - 1;
    if (strncmp(file, name, length) != 0 || strncmp(file + length, ending, size) != 0) {
        return false;
    }
    char *end;
    const long process = strtol(file + length + size, &end, 10);
    return *end == '-' && process > 0 && process != (long)getpid() && has_ended((pid_t)process);
}

/// Removes temporary files of the writer's path that a killed process left. Only a bake with a
/// checkpoint may: no other process writes its outputs.
static void remove_leftovers(const alpi_file_writer *writer)
{
    const char *name = alpi_path_name(writer->path);
    char *path = alpi_path_folder(writer->context, writer->path);
    DIR *folder = path != NULL ? opendir(path[0] != '\0' ? path : ".") : NULL;
    for (struct dirent *e = folder != NULL ? readdir(folder) : NULL; e != NULL;
         e = readdir(folder)) {
        if (is_leftover(e->d_name, name, strlen(name))) {
            (void)unlinkat(dirfd(folder), e->d_name, 0);
        }
    }
    if (folder != NULL) {
        closedir(folder);
    }
    alpi_release(writer->context, path);
}

alp_result alpi_file_open(alp_context *context, const char *path, bool overwrite,
                          alpi_file_writer *writer)
{
    *writer = (alpi_file_writer){.context = context, .descriptor = -1, .overwrite = overwrite};
    ALP_TRY(alpi_file_check_writable(context, path, overwrite));
    alp_result result = alpi_path_follow(context, path, &writer->path);
    if (result == ALP_OK && alpi_context_tiles(context)->checkpoint != NULL) {
        remove_leftovers(writer);
    }
    if (result == ALP_OK) {
        result = open_temporary(writer);
    }
    if (result != ALP_OK) {
        alpi_file_abandon(writer);
    }
    return result;
}

alp_result alpi_file_append(alpi_file_writer *writer, const void *bytes, size_t size)
{
    const uint8_t *data = bytes;
    while (size > 0) {
        ALP_TRY(alpi_tick(writer->context, "write", (uint64_t)(data - (const uint8_t *)bytes),
                          (uint64_t)(data - (const uint8_t *)bytes) + size));
        ssize_t put = write(writer->descriptor, data, size < PIECE ? size : PIECE);
        if (put < 0 && errno == EINTR) {
            continue;
        }
        if (put < 0) {
            return fail_io(writer->context, "write", writer->path);
        }
        data += put;
        size -= (size_t)put;
    }
    return ALP_OK;
}

alp_result alpi_file_finish(alpi_file_writer *writer)
{
    alp_result result = ALP_OK;
    if (fsync(writer->descriptor) != 0 && errno != EINVAL) {
        result = fail_io(writer->context, "write", writer->path);
    }
    if (close(writer->descriptor) != 0 && result == ALP_OK) {
        result = fail_io(writer->context, "write", writer->path);
    }
    writer->descriptor = -1;
    return result;
}

alp_result alpi_file_place(alpi_file_writer *writer)
{
    if (!writer->overwrite && access(writer->path, F_OK) == 0) {
        return alpi_fail(writer->context, ALP_ERROR_IO,
                         "%s: was created meanwhile and would be overwritten; force it (-f) or "
                         "name another file",
                         writer->path);
    }
    if (rename(writer->temporary, writer->path) != 0) {
        return fail_io(writer->context, "rename to", writer->path);
    }
    alpi_release(writer->context, writer->temporary);
    writer->temporary = NULL;
    return ALP_OK;
}

alp_result alpi_file_commit(alpi_file_writer *writer)
{
    alp_result result = alpi_file_finish(writer);
    if (result == ALP_OK) {
        result = alpi_file_place(writer);
    }
    alpi_file_abandon(writer);
    return result;
}

void alpi_file_abandon(alpi_file_writer *writer)
{
    if (writer->descriptor >= 0) {
        close(writer->descriptor);
    }
    if (writer->temporary != NULL) {
        unlink(writer->temporary);
    }
    alpi_release(writer->context, writer->temporary);
    alpi_release(writer->context, writer->path);
    writer->temporary = NULL;
    writer->path = NULL;
    writer->descriptor = -1;
}

alp_result alpi_file_write(alp_context *context, const char *path, bool overwrite,
                           const void *bytes, size_t size)
{
    alpi_file_writer writer;
    ALP_TRY(alpi_file_open(context, path, overwrite, &writer));
    alp_result result = alpi_file_append(&writer, bytes, size);
    if (result == ALP_OK) {
        return alpi_file_commit(&writer);
    }
    alpi_file_abandon(&writer);
    return result;
}

alp_result alpi_folder_create(alp_context *context, const char *path)
{
    char *copy = alpi_copy_string(context, path);
    if (copy == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = ALP_OK;
    for (char *p = copy; result == ALP_OK && *p != '\0';) {
        p += strspn(p, "/");
        p += strcspn(p, "/");
        char kept = *p;
        *p = '\0';
        if (copy[0] != '\0' && mkdir(copy, (mode_t)0777) != 0 && errno != EEXIST) {
            result = fail_io(context, "create folder", copy);
        }
        *p = kept;
    }
    struct stat status;
    if (result == ALP_OK && (stat(path, &status) != 0 || !S_ISDIR(status.st_mode))) {
        result = alpi_fail(context, ALP_ERROR_IO, "%s: is not a folder", path);
    }
    alpi_release(context, copy);
    return result;
}
