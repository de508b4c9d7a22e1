// SPDX-License-Identifier: MIT
// Zip archives: the directory at the end, entries by name, sizes checked before memory is asked
// for. PKWARE. APPNOTE.TXT, .ZIP File Format Specification, version 6.3.10, 2022,
// sections 4.3.7, 4.3.12 and 4.3.16.
#include "formats/collada/collada_archive.h"

#include "base/file.h"
#include "base/memory.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum {
    END_SIZE = 22,
    DIRECTORY_SIZE = 46,
    LOCAL_SIZE = 30,
    COMMENT_LIMIT = 65535,
    STORED = 0,
    DEFLATED = 8
};

typedef struct entry {
    char *name;
    uint32_t method, checksum, packed_size, size;
    size_t local; // of its local header
} entry;

/// An entry by its name.
typedef struct named {
    const char *name;
    uint32_t entry;
} named;

struct alpi_archive {
    alp_context *context;
    char *path;
    const uint8_t *bytes;
    size_t size;
    entry *entries;
    uint32_t entry_count;
    named *names;      // [entry_count] sorted: a document may ask for very many
    uint64_t inflated; // so far, of ALPI_ARCHIVE_LIMIT
};

static uint32_t read_u16(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8;
}

static uint32_t read_u32(const uint8_t *bytes)
{
    return read_u16(bytes) | read_u16(bytes + 2) << 16;
}

static alp_result fail(const alpi_archive *archive, const char *fault)
{
    return alpi_fail(archive->context, ALP_ERROR_INVALID_DATA, "%s: as a zip archive: %s",
                     archive->path, fault);
}

bool alpi_archive_is(const uint8_t *bytes, size_t size)
{
    return size >= 4 && memcmp(bytes, "PK\3\4", 4) == 0;
}

static alp_result find_end(const alpi_archive *archive, const uint8_t **end)
{
    const size_t most = END_SIZE + COMMENT_LIMIT;
    const size_t first = archive->size > most ? archive->size - most : 0;
    for (size_t at = archive->size; at >= first + END_SIZE; at--) {
        const uint8_t *here = archive->bytes + at - END_SIZE;
        if (memcmp(here, "PK\5\6", 4) == 0) {
            *end = here;
            return ALP_OK;
        }
    }
    return fail(archive, "it has no directory at its end; it may be truncated");
}

static alp_result read_entry(alpi_archive *archive, size_t *at, size_t end)
{
    if (end - *at < DIRECTORY_SIZE || memcmp(archive->bytes + *at, "PK\1\2", 4) != 0) {
        return fail(archive, "its directory is damaged");
    }
    const uint8_t *header = archive->bytes + *at;
    const size_t name_size = read_u16(header + 28);
    const size_t more = name_size + read_u16(header + 30) + read_u16(header + 32);
    if (more > end - *at - DIRECTORY_SIZE) {
        return fail(archive, "its directory is damaged");
    }
    entry *e = &archive->entries[archive->entry_count++];
    *e = (entry){.method = read_u16(header + 10),
                 .checksum = read_u32(header + 16),
                 .packed_size = read_u32(header + 20),
                 .size = read_u32(header + 24),
                 .local = read_u32(header + 42)};
    e->name = alpi_format(archive->context, "%.*s", (int)name_size, // ends at a zero byte, if any
                          (const char *)header + DIRECTORY_SIZE);
    *at += DIRECTORY_SIZE + more;
    return e->name == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

/// Of entries with one name the first comes first.
static int compare_names(const void *a, const void *b)
{
    const named *one = a, *two = b;
    const int order = strcmp(one->name, two->name);
    return order != 0 ? order : one->entry < two->entry ? -1 : one->entry > two->entry;
}

static alp_result sort_names(alpi_archive *archive)
{
    ALPI_TRY_NEW(archive->context, archive->names, archive->entry_count);
    for (uint32_t i = 0; i < archive->entry_count; i++) {
        archive->names[i] = (named){archive->entries[i].name, i};
    }
    qsort(archive->names, archive->entry_count, sizeof *archive->names, compare_names);
    return ALP_OK;
}

/// NULL when there is none.
static const entry *find_entry(const alpi_archive *archive, const char *name)
{
    uint32_t low = 0, high = archive->entry_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (strcmp(archive->names[middle].name, name) < 0) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < archive->entry_count && strcmp(archive->names[low].name, name) == 0
               ? &archive->entries[archive->names[low].entry]
               : NULL;
}

static alp_result read_directory(alpi_archive *archive)
{
    const uint8_t *end = NULL;
    ALP_TRY(find_end(archive, &end));
    const uint32_t count = read_u16(end + 10);
    size_t at = read_u32(end + 16);
    const size_t limit = (size_t)(end - archive->bytes);
    if (count == 0xffff || at == 0xffffffff || read_u16(end + 4) != 0) {
        return alpi_fail(archive->context, ALP_ERROR_UNSUPPORTED,
                         "%s: a zip archive in parts or in the 64-bit form is not read; unpack it",
                         archive->path);
    }
    if (at > limit || count > (limit - at) / DIRECTORY_SIZE) {
        return fail(archive, "its directory is damaged");
    }
    ALPI_TRY_NEW(archive->context, archive->entries, count);
    for (uint32_t i = 0; i < count; i++) {
        ALP_TRY(read_entry(archive, &at, limit));
    }
    return sort_names(archive);
}

alp_result alpi_archive_open(alp_context *context, const char *path, const uint8_t *bytes,
                             size_t size, alpi_archive **archive)
{
    *archive = NULL;
    alpi_archive *made = ALPI_NEW(context, alpi_archive, 1);
    if (made == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    *made = (alpi_archive){.context = context, .bytes = bytes, .size = size};
    made->path = alpi_copy_string(context, path);
    alp_result result = made->path == NULL ? ALP_ERROR_OUT_OF_MEMORY : read_directory(made);
    if (result != ALP_OK) {
        alpi_archive_destroy(made);
        return result;
    }
    *archive = made;
    return ALP_OK;
}

void alpi_archive_destroy(alpi_archive *archive)
{
    if (archive == NULL) {
        return;
    }
    for (uint32_t i = 0; i < archive->entry_count; i++) {
        alpi_release(archive->context, archive->entries[i].name);
    }
    alpi_release(archive->context, archive->names);
    alpi_release(archive->context, archive->entries);
    alpi_release(archive->context, archive->path);
    alpi_release(archive->context, archive);
}

const char *alpi_archive_find_ending(const alpi_archive *archive, const char *ending)
{
    for (uint32_t i = 0; i < archive->entry_count; i++) {
        if (alpi_path_has_ending(archive->entries[i].name, ending)) {
            return archive->entries[i].name;
        }
    }
    return NULL;
}

// --- entries -------------------------------------------------------------------------------------

/// The packed bytes of an entry inside the archive.
static alp_result find_data(const alpi_archive *archive, const entry *e, const uint8_t **data)
{
    if (e->local > archive->size || archive->size - e->local < LOCAL_SIZE ||
        memcmp(archive->bytes + e->local, "PK\3\4", 4) != 0) {
        return fail(archive, "an entry of its directory points nowhere");
    }
    const uint8_t *header = archive->bytes + e->local;
    const size_t skip = LOCAL_SIZE + read_u16(header + 26) + read_u16(header + 28);
    if (skip > archive->size - e->local || e->packed_size > archive->size - e->local - skip) {
        return fail(archive, "an entry passes its end; it may be truncated");
    }
    *data = header + skip;
    return ALP_OK;
}

/// Fills exactly e->size bytes, or says that they are others.
static alp_result inflate_entry(const alpi_archive *archive, const entry *e, const uint8_t *data,
                                uint8_t *out)
{
    if (e->method == STORED) {
        if (e->packed_size != e->size) {
            return fail(archive, "a stored entry has two sizes");
        }
        memcpy(out, data, e->size);
        return ALP_OK;
    }
    z_stream stream = {.avail_in = e->packed_size, .next_out = out, .avail_out = e->size};
    memcpy(&stream.next_in, &data, sizeof data); // zlib reads it, and says so by a macro only
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) {
        return alpi_fail(archive->context, ALP_ERROR_OUT_OF_MEMORY, "%s: no memory to inflate it",
                         archive->path);
    }
    int state = inflate(&stream, Z_FINISH);
    inflateEnd(&stream);
    return state == Z_STREAM_END && stream.avail_out == 0
               ? ALP_OK
               : fail(archive, "an entry does not inflate to the size that is stated");
}

/// How far deflate can go (1032 : 1, zlib's documentation): a larger claim is no honest one.
static bool size_is_possible(const entry *e)
{
    return e->size / 1032 <= e->packed_size;
}

alp_result alpi_archive_read(alpi_archive *archive, const char *name, uint8_t **bytes, size_t *size)
{
    *bytes = NULL;
    const entry *e = find_entry(archive, name);
    if (e == NULL) {
        return alpi_fail(archive->context, ALP_ERROR_IO, "%s: the archive holds no \"%.200s\"",
                         archive->path, name);
    }
    if (e->method != STORED && e->method != DEFLATED) {
        return alpi_fail(archive->context, ALP_ERROR_UNSUPPORTED,
                         "%s: \"%.200s\" is packed by method %u; only deflate is read: unpack it",
                         archive->path, name, e->method);
    }
    archive->inflated += e->size;
    if (archive->inflated > ALPI_ARCHIVE_LIMIT) {
        return alpi_fail(archive->context, ALP_ERROR_LIMIT,
                         "%s: inflates to more than %llu bytes; unpack it", archive->path,
                         (unsigned long long)ALPI_ARCHIVE_LIMIT);
    }
    const uint8_t *data = NULL;
    ALP_TRY(find_data(archive, e, &data));
    if (!size_is_possible(e)) {
        return fail(archive, "an entry says a size that it cannot have");
    }
    ALPI_TRY_NEW(archive->context, *bytes, (size_t)e->size + 1);
    alp_result result = inflate_entry(archive, e, data, *bytes);
    if (result == ALP_OK && crc32(crc32(0, NULL, 0), *bytes, e->size) != e->checksum) {
        result = fail(archive, "the checksum of an entry is wrong; it is damaged");
    }
    if (result != ALP_OK) {
        alpi_release(archive->context, *bytes);
        *bytes = NULL;
        return result;
    }
    *size = e->size;
    return ALP_OK;
}
