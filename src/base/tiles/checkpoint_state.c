// SPDX-License-Identifier: MIT
#include "base/tiles/checkpoint_state.h"

#include "base/bytes.h"
#include "base/decimal.h"
#include "base/hash.h"
#include "base/memory.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define FIRST_LINE "alpenglow checkpoint 1\n"
enum {
    CHECKSUM_LINE = 26, // "checksum " + 16 digits + \n
    PATH_EXTRA = 8,
    SIZE_LIMIT = 1 << 24,
    SHARD_LIMIT = 1 << 16
};
static const double SECONDS_LIMIT = 1e12;

// --- writing -------------------------------------------------------------------------------------

/// A line that has the same bytes in any locale; NaN is "none".
static void add_number(alpi_bytes *b, const char *name, double value)
{
    alpi_bytes_print(b, "%s ", name);
    if (isfinite(value)) {
        alpi_bytes_number(b, value, 9);
    } else {
        alpi_bytes_print(b, "none");
    }
    alpi_bytes_print(b, "\n");
}

static alpi_bytes make_text(alp_context *context, const alpi_checkpoint_state *s)
{
    alpi_bytes b = alpi_bytes_create(context);
    alpi_bytes_print(&b, FIRST_LINE "phase %s\nstage %s\ndone %" PRIu64 "\ntotal %" PRIu64 "\n",
                     s->phase, s->stage, s->done, s->total);
    add_number(&b, "seconds", s->seconds);
    add_number(&b, "left", s->seconds_left);
    add_number(&b, "error", s->error);
    alpi_bytes_print(&b, "tiles %" PRIu64 "\n", s->tiles);
    alpi_bytes_print(&b, "written %" PRIu64 "\nshard %" PRIu32 "\nshards %" PRIu32 "\n", s->written,
                     s->shard, s->count);
    alpi_bytes_print(&b, "restart %s\nsettings\n%s", s->restart != NULL ? s->restart : "",
                     s->settings);
    if (!b.failed) {
        const uint64_t sum = alpi_hash_bytes(ALPI_HASH_START, b.bytes, b.size);
        alpi_bytes_print(&b, "checksum %016" PRIx64 "\n", sum);
    }
    return b;
}

static bool write_flushed(const char *path, const alpi_bytes *b)
{
    const int file = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    bool good = file >= 0;
    for (size_t done = 0; good && done < b->size;) {
        const ssize_t put = write(file, b->bytes + done, b->size - done);
        good = put > 0 || (put < 0 && errno == EINTR);
        done += put > 0 ? (size_t)put : 0;
    }
    good = good && fsync(file) == 0;
    const int why = errno;
    good = (file < 0 || close(file) == 0) && good;
    errno = good ? errno : why;
    return good;
}

/// PATH.new becomes PATH, and the former PATH stays as PATH.old. PATH is there at every moment, but
/// on a disk without links.
static bool replace(const char *path, const char *fresh, const char *old)
{
    (void)unlink(old);
    const bool kept = link(path, old) == 0 || errno == ENOENT || rename(path, old) == 0;
    return kept && rename(fresh, path) == 0;
}

bool alpi_checkpoint_state_write(alp_context *context, const char *path,
                                 const alpi_checkpoint_state *state)
{
    alpi_bytes text = make_text(context, state);
    const size_t size = strlen(path) + PATH_EXTRA;
    char *fresh = ALPI_NEW(context, char, size), *old = ALPI_NEW(context, char, size);
    bool good = !text.failed && fresh != NULL && old != NULL;
    errno = good ? 0 : ENOMEM;
    if (good) {
        snprintf(fresh, size, "%s.new", path);
        snprintf(old, size, "%s.old", path);
        good = write_flushed(fresh, &text) && replace(path, fresh, old);
        const int why = errno;
        if (!good) {
            (void)unlink(fresh);
        }
        errno = why;
    }
    alpi_bytes_destroy(&text);
    alpi_release(context, fresh);
    alpi_release(context, old);
    return good;
}

// --- reading -------------------------------------------------------------------------------------

/// The text of a regular file, with a zero after it; NULL: unreadable.
static char *read_text(alp_context *context, const char *path, size_t *size)
{
    struct stat status;
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    char *text = NULL;
    if (file >= 0 && fstat(file, &status) == 0 && S_ISREG(status.st_mode) &&
        status.st_size < SIZE_LIMIT) {
        text = ALPI_NEW(context, char, (size_t)status.st_size + 1);
        const ssize_t got = text != NULL ? read(file, text, (size_t)status.st_size) : -1;
        if (got != status.st_size) {
            alpi_release(context, text);
            text = NULL;
        }
        *size = (size_t)status.st_size;
    }
    if (file >= 0) {
        close(file);
    }
    return text;
}

/// Cuts off the last line, if it is the checksum of the text before it.
static bool check(char *text, size_t size)
{
    char last[CHECKSUM_LINE + 1];
    if (size < CHECKSUM_LINE || strlen(text) != size) {
        return false;
    }
    const size_t before = size - CHECKSUM_LINE;
    snprintf(last, sizeof last, "checksum %016" PRIx64 "\n",
             alpi_hash_bytes(ALPI_HASH_START, text, before));
    if (strcmp(text + before, last) != 0) {
        return false;
    }
    text[before] = '\0';
    return true;
}

/// The value of the next line, which must have this name; NULL: it has not.
static const char *value(char **at, const char *name)
{
    char *line = *at, *end = line != NULL ? strchr(line, '\n') : NULL;
    const size_t length = strlen(name);
    if (end == NULL || strncmp(line, name, length) != 0 || line[length] != ' ') {
        *at = NULL;
        return "";
    }
    *end = '\0';
    *at = end + 1;
    return line + length + 1;
}

/// @return NaN: there is none
static double number(char **at, const char *name)
{
    const char *text = value(at, name), *end = text + strlen(text);
    double n = (double)NAN;
    return alpi_decimal_double(text, end, &n) == end ? n : (double)NAN;
}

/// Whether the values are those of a process.
static bool is_sound(const alpi_checkpoint_state *s)
{
    const bool known = strcmp(s->phase, "running") == 0 || strcmp(s->phase, "stopped") == 0 ||
                       strcmp(s->phase, "complete") == 0;
    return known && s->seconds >= 0.0 && s->seconds < SECONDS_LIMIT &&
           !(s->seconds_left >= SECONDS_LIMIT) && !isinf(s->error) &&
           (s->count == 0 ? s->shard == 0 : s->shard < s->count && s->count <= SHARD_LIMIT);
}

static bool parse(char *text, alpi_checkpoint_state *s)
{
    const size_t first = strlen(FIRST_LINE), settings = strlen("settings\n");
    if (strncmp(text, FIRST_LINE, first) != 0) {
        return false;
    }
    char *at = text + first;
    s->phase = value(&at, "phase");
    s->stage = value(&at, "stage");
    s->done = strtoull(value(&at, "done"), NULL, 10);
    s->total = strtoull(value(&at, "total"), NULL, 10);
    s->seconds = number(&at, "seconds");
    s->seconds_left = number(&at, "left");
    s->error = number(&at, "error");
    s->tiles = strtoull(value(&at, "tiles"), NULL, 10);
    s->written = strtoull(value(&at, "written"), NULL, 10);
    s->shard = (uint32_t)strtoul(value(&at, "shard"), NULL, 10);
    s->count = (uint32_t)strtoul(value(&at, "shards"), NULL, 10);
    s->restart = value(&at, "restart");
    if (at == NULL || strncmp(at, "settings\n", settings) != 0) {
        return false;
    }
    s->settings = at + settings;
    return is_sound(s);
}

static bool read_one(alp_context *context, const char *path, alpi_checkpoint_state *state,
                     bool *there)
{
    size_t size = 0;
    *state = (alpi_checkpoint_state){.text = read_text(context, path, &size)};
    *there = state->text != NULL;
    if (*there && check(state->text, size) && parse(state->text, state)) {
        return true;
    }
    alpi_checkpoint_state_clear(context, state);
    return false;
}

bool alpi_checkpoint_state_read(alp_context *context, const char *path,
                                alpi_checkpoint_state *state, bool *damaged)
{
    bool there = false, old_there = false;
    if (read_one(context, path, state, &there)) {
        *damaged = false;
        return true;
    }
    *damaged = there;
    char *old = alpi_format(context, "%s.old", path);
    const bool good = old != NULL && read_one(context, old, state, &old_there);
    alpi_release(context, old);
    return good;
}

void alpi_checkpoint_state_clear(alp_context *context, alpi_checkpoint_state *state)
{
    alpi_release(context, state->text);
    *state = (alpi_checkpoint_state){.text = NULL};
}
