// SPDX-License-Identifier: MIT
#include "formats/files/find_file.h"

#include "base/file.h"
#include "base/memory.h"
#include "formats/files/outside.h"
#include "formats/text/utf8.h"

#include <ctype.h>
#include <dirent.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

// --- paths ---------------------------------------------------------------------------------------

/// Drops the last part of a path that ends in a slash. With none left it climbs out, or, where
/// that is not allowed, false.
static bool climb(char *path, size_t *size, bool outside)
{
    if (*size == 1 && path[0] == '/') {
        return outside; // nothing is above the root
    }
    const bool climbed = *size >= 3 && memcmp(path + *size - 3, "../", 3) == 0;
    if (*size == 0 || climbed) {
        memcpy(path + *size, "../", 3);
        *size += 3;
        return outside;
    }
    do {
        --*size;
    } while (*size > 0 && path[*size - 1] != '/');
    return true;
}

/// Length of the part of a path at `at`: slashes of both kinds end it.
static size_t part_length(const char *at, size_t size)
{
    size_t length = 0;
    while (length < size && at[length] != '/' && at[length] != '\\') {
        length++;
    }
    return length;
}

static bool is_foreign(const char *name, size_t size)
{
    return size > 0 &&
           (name[0] == '\\' || (size > 1 && name[1] == ':' && isalpha((unsigned char)name[0])));
}

/// Appends the parts of a name to a path of *size bytes; false where it leaves the folder and may
/// not (`outside`).
static bool walk(char *path, size_t *size, const char *name, size_t length, bool outside)
{
    if (length == 0 || (name[0] == '/' && !outside) || is_foreign(name, length) ||
        memchr(name, '\0', length) != NULL) {
        return false;
    }
    if (name[0] == '/') {
        path[0] = '/';
        *size = 1;
    }
    for (size_t at = 0; at < length;) {
        const char *part = name + at;
        const size_t count = part_length(part, length - at);
        const bool last = at + count >= length;
        at += count + 1;
        if (count == 2 && part[0] == '.' && part[1] == '.') {
            if (!climb(path, size, outside)) {
                return false;
            }
        } else if (count > 0 && !(count == 1 && part[0] == '.')) {
            memcpy(path + *size, part, count);
            *size += count;
            path[*size] = '/';
            *size += !last;
        }
    }
    path[*size] = '\0';
    return *size > 0 && path[*size - 1] != '/';
}

alp_result alpi_path_resolve(alp_context *context, const char *from, const char *name, size_t size,
                             char **path)
{
    size_t length = strlen(from);
    *path = ALPI_NEW(context, char, length + size + 4); // a slash that ".." lacks, and 0
    if (*path == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    memcpy(*path, from, length);
    if (!walk(*path, &length, name, size, alpi_context_options(context)->read_outside)) {
        alpi_release(context, *path);
        *path = NULL;
    }
    return ALP_OK;
}

bool alpi_path_is_foreign(const char *name)
{
    return is_foreign(name, strlen(name));
}

// --- files that are there ------------------------------------------------------------------------

/// *there: whether folder + inner is a file. An absolute `inner` stands alone.
static alp_result is_there(alp_context *context, const char *folder, const char *inner, bool *there)
{
    struct stat state;
    char *path = alpi_format(context, "%s%s", inner[0] == '/' ? "" : folder, inner);
    if (path == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    *there = stat(path, &state) == 0 && S_ISREG(state.st_mode);
    alpi_release(context, path);
    return ALP_OK;
}

/// Writes over a part of a path, in a folder, the entry that it names in another case: the first by
/// its bytes. An entry of the same letters goes before.
static bool match_entry(const char *folder, char *part, size_t length)
{
    bool found = false;
    char best[256];
    DIR *entries = opendir(folder[0] != '\0' ? folder : ".");
    for (const struct dirent *e; entries != NULL && (e = readdir(entries)) != NULL;) {
        const char *name = e->d_name;
        if (strlen(name) != length || length >= sizeof best ||
            strncasecmp(name, part, length) != 0) {
            continue;
        }
        const bool same = memcmp(name, part, length) == 0;
        if (same || !found || strcmp(name, best) < 0) {
            memcpy(best, name, length + 1);
        }
        found = true;
        if (same) {
            break;
        }
    }
    if (entries != NULL) {
        closedir(entries);
    }
    if (found) {
        memcpy(part, best, length);
    }
    return found;
}

/// Changes the case of a relative path to that of a file in the folder. *there: whether there is
/// one; else the path may be changed in part.
static alp_result match_case(alp_context *context, const char *folder, char *inner, bool *there)
{
    char *path = alpi_format(context, "%s%s", folder, inner);
    if (path == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    bool matches = inner[0] != '/';
    const size_t start = strlen(folder);
    for (size_t at = start; matches && path[at] != '\0';) {
        const size_t length = strcspn(path + at, "/");
        const char first = path[at];
        char part[256];
        if (length >= sizeof part) {
            matches = false;
            break;
        }
        memcpy(part, path + at, length);
        path[at] = '\0';
        matches = match_entry(path, part, length);
        path[at] = first;
        memcpy(path + at, part, matches ? length : 0);
        at += length + (path[at + length] == '/');
    }
    memcpy(inner, path + start, strlen(inner));
    alpi_release(context, path);
    *there = false;
    return matches ? is_there(context, folder, inner, there) : ALP_OK;
}

// --- the search ----------------------------------------------------------------------------------

/// Tries a path as it is, then in another case; *path is changed then.
static alp_result try_path(alp_context *context, const char *folder, char *path, alpi_found *found)
{
    bool there;
    ALP_TRY(is_there(context, folder, path, &there));
    *found = there ? ALPI_FOUND_AS_NAMED : ALPI_FOUND_NOTHING;
    if (there) {
        return ALP_OK;
    }
    char *other = alpi_copy_string(context, path);
    if (other == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = match_case(context, folder, other, &there);
    if (result == ALP_OK && there) {
        memcpy(path, other, strlen(path));
        *found = ALPI_FOUND_OTHER_CASE;
    }
    alpi_release(context, other);
    return result;
}

/// The longest end of a path that is in the folder; ends that begin with ".." are none.
static alp_result try_ends(alp_context *context, const char *folder, const char *name, char **path,
                           alpi_found *found)
{
    const size_t size = strlen(name);
    *path = NULL;
    for (size_t at = part_length(name, size); at < size; at += part_length(name + at, size - at)) {
        at++; // the slash
        char *end = NULL;
        if (!alpi_path_stays_below(name + at)) {
            continue;
        }
        ALP_TRY(alpi_path_resolve(context, "", name + at, size - at, &end));
        if (end == NULL) {
            continue;
        }
        const alp_result result = try_path(context, folder, end, found);
        if (result == ALP_OK && *found != ALPI_FOUND_NOTHING) {
            *found = ALPI_FOUND_BY_NAME;
            *path = end;
            return ALP_OK;
        }
        alpi_release(context, end);
        ALP_TRY(result);
    }
    return ALP_OK;
}

static alp_result find(alp_context *context, const char *folder, const char *from, const char *name,
                       char **path, alpi_found *found)
{
    char *end = NULL;
    *found = ALPI_FOUND_NOTHING;
    ALP_TRY(alpi_path_resolve(context, from, name, strlen(name), path));
    alp_result result = *path != NULL ? try_path(context, folder, *path, found) : ALP_OK;
    if (result == ALP_OK && *found == ALPI_FOUND_NOTHING) {
        result = try_ends(context, folder, name, &end, found);
    }
    if (end != NULL || result != ALP_OK) {
        alpi_release(context, *path);
        *path = end;
    }
    return result;
}

/// Another spelling of a name that was not found as it is; takes over `other`, which may be NULL.
static alp_result find_other(alp_context *context, const char *folder, const char *from,
                             const char *name, char *other, char **path, alpi_found *found)
{
    char *there = NULL;
    const bool differs = other != NULL && strcmp(other, name) != 0;
    alp_result result = ALP_OK;
    if (differs && *found == ALPI_FOUND_NOTHING) {
        result = find(context, folder, from, other, &there, found);
    }
    if (result == ALP_OK && *found != ALPI_FOUND_NOTHING && there != NULL) {
        alpi_release(context, *path);
        *path = there;
    } else {
        alpi_release(context, there);
    }
    alpi_release(context, other);
    return result;
}

static alp_result find_spellings(alp_context *context, const char *folder, const char *from,
                                 const char *name, char **path, alpi_found *found)
{
    ALP_TRY(find(context, folder, from, name, path, found));
    if (*found != ALPI_FOUND_NOTHING) {
        return ALP_OK;
    }
    char *decoded = alpi_copy_string(context, name);
    if (decoded == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    if (!alpi_uri_decode(decoded) || strstr(decoded, "..") != NULL) {
        alpi_release(context, decoded);
        decoded = NULL;
    }
    ALP_TRY(find_other(context, folder, from, name, decoded, path, found));
    char *utf8 = alpi_utf8_copy(context, name, strlen(name));
    return utf8 == NULL ? ALP_ERROR_OUT_OF_MEMORY
                        : find_other(context, folder, from, name, utf8, path, found);
}

alp_result alpi_find_file(alp_context *context, const char *folder, const char *from,
                          const char *name, char **path, alpi_found *found)
{
    const alp_result result = find_spellings(context, folder, from, name, path, found);
    if (result != ALP_OK) {
        alpi_release(context, *path);
        *path = NULL;
    }
    return result;
}

static bool has_scheme(const char *uri)
{
    const size_t length = strcspn(uri, ":/\\?#");
    return length > 0 && uri[length] == ':';
}

static alp_result find_uri(alp_context *context, const char *folder, const char *uri, char **path,
                           alpi_found *found)
{
    char *inner = NULL;
    bool there = false;
    ALP_TRY(alpi_outside_path(context, folder, uri, path));
    if (*path != NULL) {
        ALP_TRY(is_there(context, "", *path, &there));
    }
    if (there) {
        *found = ALPI_FOUND_AS_NAMED;
        return ALP_OK;
    }
    ALP_TRY(alpi_find_file(context, folder, "", uri, &inner, found));
    if (*found != ALPI_FOUND_NOTHING) {
        alpi_release(context, *path);
        *path = alpi_format(context, "%s%s", inner[0] == '/' ? "" : folder, inner);
    }
    alpi_release(context, inner);
    return *found != ALPI_FOUND_NOTHING && *path == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

alp_result alpi_find_uri(alp_context *context, const char *folder, const char *uri, char **path,
                         alpi_found *found)
{
    *path = NULL;
    *found = ALPI_FOUND_NOTHING;
    const alp_result result = find_uri(context, folder, uri, path, found);
    const bool elsewhere =
        *found == ALPI_FOUND_NOTHING && has_scheme(uri) && !alpi_outside_takes(context, uri);
    if (result != ALP_OK || elsewhere) {
        alpi_release(context, *path);
        *path = NULL;
    }
    return result;
}

void alpi_note_found(alp_context *context, const char *name, const char *path, alpi_found found)
{
    if (found == ALPI_FOUND_OTHER_CASE) {
        alpi_note(context, "image-path", name,
                  "is read from \"%.200s\", whose name has other capitals; some systems do not "
                  "find it: rename one of them",
                  path);
    } else if (found == ALPI_FOUND_BY_NAME) {
        alpi_note(context, "image-path", name, "is read from \"%.200s\" in the asset's folder",
                  path);
    }
}
