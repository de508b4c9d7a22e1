// SPDX-License-Identifier: MIT
#include "base/tiles/tile_log.h"

#include "base/hash.h"
#include "base/memory.h"

#include <errno.h>
#include <fcntl.h>
#include <stddef.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static const uint32_t RECORD_MAGIC = 0x454c4954u; // "TILE"
static const char FILE_MAGIC[8] = {'A', 'L', 'P', 'T', 'I', 'L', 'E', '1'};

typedef struct file_head {
    char magic[8];
    uint64_t key;
    uint64_t own; // checksum of the fields above
} file_head;

uint64_t alpi_tile_checksum(const uint8_t *bytes, size_t size)
{
    uint64_t hash = ALPI_HASH_START, word;
    size_t i = 0;
    for (; size - i >= sizeof word; i += sizeof word) { // each step keeps all differences
        memcpy(&word, bytes + i, sizeof word);
        hash = (hash ^ word) * 0x100000001b3u;
        hash ^= hash >> 32;
    }
    return alpi_hash_bytes(hash, bytes + i, size - i);
}

// --- bytes in and out ----------------------------------------------------------------------------

static bool read_at(int file, uint64_t offset, void *bytes, size_t size)
{
    for (size_t done = 0; done < size;) {
        const ssize_t got =
            pread(file, (uint8_t *)bytes + done, size - done, (off_t)(offset + done));
        if (got <= 0 && !(got < 0 && errno == EINTR)) {
            return false;
        }
        done += got > 0 ? (size_t)got : 0;
    }
    return true;
}

static bool write_at(int file, uint64_t offset, const void *bytes, size_t size)
{
    for (size_t done = 0; done < size;) {
        const ssize_t put =
            pwrite(file, (const uint8_t *)bytes + done, size - done, (off_t)(offset + done));
        if (put < 0 && errno != EINTR) {
            return false;
        }
        done += put > 0 ? (size_t)put : 0;
    }
    return true;
}

static file_head make_head(uint64_t key)
{
    file_head head = {.key = key};
    memcpy(head.magic, FILE_MAGIC, sizeof head.magic);
    head.own = alpi_hash_bytes(ALPI_HASH_START, &head, offsetof(file_head, own));
    return head;
}

/// Appends bytes at the end. On failure the file keeps its former end.
static bool append(alpi_tile_log *log, const void *bytes, size_t size)
{
    if (write_at(log->file, log->end, bytes, size) && fdatasync(log->file) == 0) {
        log->end += size;
        return true;
    }
    const int why = errno;
    (void)!ftruncate(log->file, (off_t)log->end); // the bytes behind the end have no meaning
    errno = why;
    return false;
}

/// Writes the head of an empty file.
static bool begin(alpi_tile_log *log)
{
    const file_head head = make_head(log->key);
    return log->end > 0 || append(log, &head, sizeof head);
}

bool alpi_tile_log_append(alpi_tile_log *log, const uint8_t *bytes, size_t size)
{
    return begin(log) && append(log, bytes, size);
}

// --- opening -------------------------------------------------------------------------------------

static uint64_t checksum_of(const alpi_tile_head *head)
{
    return alpi_hash_bytes(ALPI_HASH_START, head, offsetof(alpi_tile_head, own));
}

/// Lists records up to the first damaged head, or the end of the file.
static alp_result list_records(alpi_tile_log *log, uint64_t size)
{
    alpi_tile_record r;
    while (size - log->end >= sizeof r.head &&
           read_at(log->file, log->end, &r.head, sizeof r.head) && r.head.magic == RECORD_MAGIC &&
           r.head.own == checksum_of(&r.head) && r.head.size <= size - log->end - sizeof r.head) {
        r.offset = log->end + sizeof r.head;
        ALP_TRY(alpi_grow(log->context, (void **)&log->records, &log->capacity, log->count + 1,
                          sizeof r));
        log->records[log->count++] = r;
        log->end = r.offset + r.head.size;
    }
    log->damaged = log->damaged || log->end < size;
    return ALP_OK;
}

static alp_result fail(const alpi_tile_log *log, const char *task)
{
    return alpi_fail(log->context, ALP_ERROR_IO, "%s: %s: %s", log->path, task, strerror(errno));
}

/// Reads what is there. Before a log is written, cuts off what is damaged.
static alp_result read_log(alpi_tile_log *log, uint64_t key)
{
    const file_head wanted = make_head(key);
    file_head found;
    struct stat status;
    if (fstat(log->file, &status) != 0) {
        return fail(log, "cannot read");
    }
    if (!S_ISREG(status.st_mode)) {
        return alpi_fail(log->context, ALP_ERROR_IO, "%s: is no file; take another folder",
                         log->path);
    }
    const uint64_t size = (uint64_t)status.st_size;
    const bool ours = size >= sizeof found && read_at(log->file, 0, &found, sizeof found) &&
                      memcmp(&found, &wanted, sizeof found) == 0;
    if (ours) {
        log->end = sizeof found;
        ALP_TRY(list_records(log, size));
    }
    log->damaged = log->damaged || (!ours && size > 0);
    if (!log->writes) {
        return ALP_OK;
    }
    if (ftruncate(log->file, (off_t)log->end) != 0) {
        return fail(log, "cannot write");
    }
    // A full disk may have room later.
    const bool begun = begin(log) || errno == ENOSPC || errno == EDQUOT || errno == EFBIG;
    return begun ? ALP_OK : fail(log, "cannot write");
}

alp_result alpi_tile_log_lock(alp_context *context, const char *path, int file, bool shared)
{
    enum { TRIES = 40 };
    const struct timespec pause = {.tv_nsec = 50000000};
    for (int i = 0; flock(file, (shared ? LOCK_SH : LOCK_EX) | LOCK_NB) != 0; i++) {
        if (errno != EWOULDBLOCK) {
            return ALP_OK; // a file system without locks
        }
        if (i == TRIES) {
            return alpi_fail(
                context, ALP_ERROR_IO,
                "%s: another process writes this checkpoint; wait for its end, or take "
                "another folder",
                path);
        }
        nanosleep(&pause, NULL);
    }
    return ALP_OK;
}

static alp_result open_file(alpi_tile_log *log)
{
    const int flags = log->writes ? O_RDWR | O_CREAT : O_RDONLY;
    log->file = open(log->path, flags | O_CLOEXEC | O_NONBLOCK, 0666);
    if (log->file < 0) {
        return fail(log, log->writes ? "cannot write" : "cannot read");
    }
    if (log->writes) {
        return alpi_tile_log_lock(log->context, log->path, log->file, false);
    }
    return ALP_OK;
}

alp_result alpi_tile_log_open(alp_context *context, const char *path, uint64_t key, bool writes,
                              alpi_tile_log *log)
{
    *log = (alpi_tile_log){.context = context, .file = -1, .writes = writes, .key = key};
    log->path = alpi_copy_string(context, path);
    alp_result result = log->path != NULL ? open_file(log) : ALP_ERROR_OUT_OF_MEMORY;
    result = result == ALP_OK ? read_log(log, key) : result;
    if (result != ALP_OK) {
        alpi_tile_log_close(log);
    }
    return result;
}

void alpi_tile_log_close(alpi_tile_log *log)
{
    if (log->context == NULL) {
        return;
    }
    if (log->file >= 0) {
        close(log->file);
    }
    alpi_release(log->context, log->path);
    alpi_release(log->context, log->records);
    *log = (alpi_tile_log){.file = -1};
}

// --- records -------------------------------------------------------------------------------------

bool alpi_tile_log_read(const alpi_tile_log *log, const alpi_tile_record *record, uint8_t *bytes)
{
    const size_t size = (size_t)record->head.size;
    return read_at(log->file, record->offset, bytes, size) &&
           alpi_tile_checksum(bytes, size) == record->head.checksum;
}

void alpi_tile_log_seal(uint32_t loop, uint64_t shape, size_t start, alpi_bytes *bytes)
{
    alpi_tile_head head = {.magic = RECORD_MAGIC, .loop = loop, .shape = shape};
    if (bytes->failed) {
        return;
    }
    const uint8_t *packed = bytes->bytes + start + sizeof head;
    head.size = bytes->size - start - sizeof head;
    head.checksum = alpi_tile_checksum(packed, (size_t)head.size);
    head.own = checksum_of(&head);
    memcpy(bytes->bytes + start, &head, sizeof head);
}
