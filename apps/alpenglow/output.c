// SPDX-License-Identifier: MIT
// Files that the command itself writes: checked before the work, written completely or not at all.
#include "output.h"

#include "options/options.h"
#include "printing/messages.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LINK_LIMIT = 40, LINK_SIZE = 4096 };

static int fail_path(const char *path, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static int fail_path(const char *path, const char *format, ...)
{
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    fputs("alpenglow: ", stderr);
    print_clean(stderr, path);
    fputs(": ", stderr);
    print_clean(stderr, text);
    fputc('\n', stderr);
    return EXIT_FAILED;
}

/// The folder of a path, malloc'ed.
static char *folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    size_t length = slash == NULL || slash == path ? 1 : (size_t)(slash - path);
    char *folder = allocate_or_exit(NULL, length + 1);
    memcpy(folder, slash == NULL ? "." : path, length);
    folder[length] = '\0';
    return folder;
}

/// Target of the link `path`, malloc'ed; NULL with errno.
static char *read_link(const char *path)
{
    char text[LINK_SIZE];
    const ssize_t length = readlink(path, text, sizeof text - 1);
    if (length < 0) {
        return NULL;
    }
    text[length] = '\0';
    if (text[0] == '/' || strchr(path, '/') == NULL) {
        return strdup(text);
    }
    char *folder = folder_of(path);
    const size_t size = strlen(folder) + (size_t)length + 2;
    char *target = allocate_or_exit(NULL, size);
    snprintf(target, size, "%s/%s", folder, text);
    free(folder);
    return target;
}

/// Follows links from `path` to the first that is not a link, existing or not; malloc'ed. NULL with
/// errno.
static char *follow_links(const char *path)
{
    struct stat about;
    char *end = strdup(path);
    for (int links = 0; end != NULL && lstat(end, &about) == 0 && S_ISLNK(about.st_mode); links++) {
        char *next = links < LINK_LIMIT ? read_link(end) : NULL;
        free(end);
        end = next;
        errno = links < LINK_LIMIT ? errno : ELOOP;
    }
    return end;
}

static int check_folder(const char *path)
{
    struct stat about;
    char *end = follow_links(path);
    if (end == NULL) {
        return fail_path(path, "cannot follow the link: %s", strerror(errno));
    }
    char *folder = folder_of(end);
    int code = EXIT_DONE;
    bool there = stat(folder, &about) == 0;
    if (!there || !S_ISDIR(about.st_mode) || access(folder, W_OK | X_OK) != 0) {
        int fault = there && !S_ISDIR(about.st_mode) ? ENOTDIR : errno;
        code = fault == ENOENT
                   ? fail_path(path, "its folder does not exist; make it first (mkdir -p)")
                   : fail_path(path, "its folder cannot be written: %s", strerror(fault));
    }
    free(folder);
    free(end);
    return code;
}

int output_check(const char *path, bool overwrite)
{
    struct stat about;
    if (stat(path, &about) == 0) {
        if (S_ISDIR(about.st_mode)) {
            return fail_path(path, "is a folder, a file name is needed");
        }
        if (!overwrite) {
            return fail_path(path, "exists already and would be overwritten; force it (-f) or name "
                                   "another file");
        }
        if (!S_ISREG(about.st_mode)) { // a rename would replace a device by a file
            return fail_path(path, "is not an ordinary file");
        }
    } else if (errno == ENAMETOOLONG) {
        return fail_path(path, "cannot be written: %s", strerror(errno));
    }
    return check_folder(path);
}

bool output_is_stdout(const char *path)
{
    return path != NULL && strcmp(path, "-") == 0;
}

int output_check_json(const char *path, bool overwrite)
{
    return output_is_stdout(path) ? EXIT_DONE : output_check(path, overwrite);
}

static bool is_one_file(const char *a, const char *b)
{
    struct stat first, second;
    return stat(a, &first) == 0 && stat(b, &second) == 0 && first.st_dev == second.st_dev &&
           first.st_ino == second.st_ino;
}

static const char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash == NULL ? path : slash + 1;
}

bool output_is_same(const char *a, const char *b)
{
    if (strcmp(a, b) == 0 || is_one_file(a, b)) {
        return true;
    }
    if (strcmp(name_of(a), name_of(b)) != 0) {
        return false;
    }
    char *first = folder_of(a), *second = folder_of(b);
    const bool same = is_one_file(first, second);
    free(first);
    free(second);
    return same;
}

static bool write_all(FILE *file, const char *text)
{
    const size_t length = strlen(text);
    const bool ended = length > 0 && text[length - 1] == '\n';
    const bool good = fputs(text, file) >= 0 && (ended || fputc('\n', file) != EOF);
    return fclose(file) == 0 && good;
}

/// @param path as given; `end` is the target of its links
static int write_beside(const char *text, const char *path, const char *end, const char *temporary)
{
    int descriptor = open(temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    FILE *file = descriptor < 0 ? NULL : fdopen(descriptor, "w");
    if (file == NULL) {
        int code = fail_path(path, "cannot be written: %s", strerror(errno));
        if (descriptor >= 0) {
            close(descriptor);
            unlink(temporary);
        }
        return code;
    }
    if (!write_all(file, text) || rename(temporary, end) != 0) {
        int code = fail_path(path, "cannot be written: %s", strerror(errno));
        unlink(temporary);
        return code;
    }
    return EXIT_DONE;
}

/// A link stays: its target is written.
static int write_and_rename(const char *text, const char *path)
{
    char *end = follow_links(path);
    if (end == NULL) {
        return fail_path(path, "cannot follow the link: %s", strerror(errno));
    }
    char *folder = folder_of(end);
    const size_t size = strlen(folder) + 64;
    char *temporary = allocate_or_exit(NULL, size);
    snprintf(temporary, size, "%s/alpenglow.%ld.tmp", folder, (long)getpid());
    free(folder);
    const int code = write_beside(text, path, end, temporary);
    free(temporary);
    free(end);
    return code;
}
int output_write_json(const json_t *document, const char *path, bool overwrite)
{
    int code = output_check_json(path, overwrite); // again: the work may have taken hours
    if (code != EXIT_DONE) {
        return code;
    }
    char *text = json_dumps(document, JSON_STYLE);
    if (text == NULL) {
        return failure("out of memory");
    }
    if (output_is_stdout(path)) { // main checks the stream at the end
        puts(text);
    } else {
        code = write_and_rename(text, path);
    }
    free(text);
    return code;
}

int output_write_text(const char *text, const char *path, bool overwrite)
{
    const int code = output_check(path, overwrite); // again: the work may have taken hours
    return code == EXIT_DONE ? write_and_rename(text, path) : code;
}

json_t *json_number(double number)
{
    return isfinite(number) ? json_real(number) : json_null();
}

json_t *json_text(const char *text)
{
    json_t *json = json_string(text);
    if (json == NULL) {
        size_t size = strlen(text) + 1;
        char *ascii = memcpy(allocate_or_exit(NULL, size), text, size);
        for (char *at = ascii; *at != '\0'; at++) {
            *at = (*at & 0x80) != 0 ? '?' : *at;
        }
        json = json_string(ascii);
        free(ascii);
    }
    return json;
}

double two_digits(double value)
{
    const double step = value > 0.0 ? pow(10.0, floor(log10(value)) - 1.0) : 1.0;
    return round(value / step) * step;
}

void print_percent(FILE *stream, double share)
{
    if (share > 0.0 && share < 1e-5) {
        fputs("under 0.001 %", stream);
    } else {
        fprintf(stream, "%g %%", two_digits(100.0 * share));
    }
}

bool path_ends(const char *path, const char *ending)
{
    size_t length = strlen(path), ending_length = strlen(ending);
    return length >= ending_length && strcasecmp(path + length - ending_length, ending) == 0;
}
