// SPDX-License-Identifier: MIT
// Runs a fuzz target without libFuzzer: every file of a folder as it is, and changed some hundred
// times, the same in every run.
//
//   fuzz_NAME FOLDER|FILE... [-mutations=N]
#include "fuzz.h"

#include "base/random.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { FILE_LIMIT = 1 << 22, MOST_FILES = 512 };

typedef struct piece {
    uint8_t *bytes;
    size_t size, capacity;
} piece;

static uint64_t next_random(uint64_t *seed)
{
    return *seed = alpi_hash64(*seed);
}

// --- changes -------------------------------------------------------------------------------------

/// Replaces `length` bytes at `at`.
static void replace(piece *p, size_t at, size_t length, const void *bytes, size_t size)
{
    if (p->size - length + size > p->capacity) {
        return;
    }
    memmove(p->bytes + at + size, p->bytes + at + length, p->size - at - length);
    if (size > 0) {
        memcpy(p->bytes + at, bytes, size);
    }
    p->size += size - length;
}

/// A number of the text becomes one of those that break readers.
static void change_number(piece *p, size_t at)
{
    static const char *const numbers[] = {"-1",
                                          "0",
                                          "1",
                                          "65536",
                                          "1e39",
                                          "2147483648",
                                          "4294967295",
                                          "1.5",
                                          "-1e308",
                                          "255",
                                          "99999999999999999999",
                                          "1e-9",
                                          "3",
                                          "nan"};
    const uint64_t pick = (uint64_t)p->bytes[at] + at + p->size;
    const char *number = numbers[pick % (sizeof numbers / sizeof *numbers)];
    size_t end = at;
    while (at > 0 && strchr("0123456789.-", p->bytes[at - 1]) != NULL && p->bytes[at - 1] != 0) {
        at--;
    }
    while (end < p->size && p->bytes[end] != 0 && strchr("0123456789.e", p->bytes[end]) != NULL) {
        end++;
    }
    replace(p, at, end - at, number, strlen(number));
}

static void change_once(piece *p, uint64_t *seed)
{
    static const char signs[] = "0123456789-+.eE/ \t\n\\#\"'{}[]<>,:=&!\0\x7f\xff\x80\x01\x10";
    const size_t at = next_random(seed) % p->size, from = next_random(seed) % p->size;
    const size_t most = next_random(seed) % 4 == 0 ? 256 : 16;
    size_t length = 1 + next_random(seed) % most;
    uint8_t copy[256];
    length = length < p->size - from ? length : p->size - from;
    switch (next_random(seed) % 8) {
    case 0:
        p->bytes[at] = (uint8_t)next_random(seed);
        break;
    case 1:
        p->bytes[at] ^= (uint8_t)(1u << next_random(seed) % 8);
        break;
    case 2: // a piece goes
        replace(p, from, length, NULL, 0);
        break;
    case 3: // a piece comes a second time, here, in place of what was or before it
        memcpy(copy, p->bytes + from, length);
        replace(p, at, next_random(seed) % 2 == 0 || length > p->size - at ? 0 : length, copy,
                length);
        break;
    case 4:
        p->bytes[at] = (uint8_t)(p->bytes[at] + (next_random(seed) % 2 == 0 ? 1 : -1));
        break;
    case 5:
        if (p->bytes[at] >= '0' && p->bytes[at] <= '9') {
            change_number(p, at);
            break;
        } // else as the others
        p->bytes[at] = next_random(seed) % 2 == 0 ? 0 : 0xff;
        break;
    default:
        p->bytes[at] = (uint8_t)signs[next_random(seed) % (sizeof signs - 1)];
    }
}

static void change(piece *p, uint64_t *seed)
{
    const uint64_t changes = 1 + next_random(seed) % 5;
    for (uint64_t i = 0; i < changes && p->size > 0; i++) {
        change_once(p, seed);
    }
    if (next_random(seed) % 8 == 0 && p->size > 0) {
        p->size = next_random(seed) % p->size;
    }
}

// --- files ---------------------------------------------------------------------------------------

static piece read_piece(const char *path)
{
    static uint8_t bytes[FILE_LIMIT];
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        fuzz_abort("cannot open %s", path);
    }
    const size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    piece p = {fuzz_copy(bytes, size), size, 0};
    return p;
}

/// @return inputs that were run
static long run_file(const char *path, long mutations)
{
    piece good = read_piece(path);
    piece bad = {malloc(2 * good.size + 4096), 0, 2 * good.size + 4096};
    uint64_t seed = good.size;
    if (bad.bytes == NULL) {
        fuzz_abort("no memory for %s", path);
    }
    (void)LLVMFuzzerTestOneInput(good.bytes, good.size);
    for (long i = 0; i < mutations; i++) {
        memcpy(bad.bytes, good.bytes, good.size);
        bad.size = good.size;
        change(&bad, &seed);
        (void)LLVMFuzzerTestOneInput(bad.bytes, bad.size);
    }
    free(good.bytes);
    free(bad.bytes);
    return 1 + mutations;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static long run_folder(const char *path, long mutations)
{
    char *names[MOST_FILES] = {NULL}, full[1024];
    size_t count = 0;
    long runs = 0;
    DIR *folder = opendir(path);
    if (folder == NULL) {
        fuzz_abort("cannot open %s", path);
    }
    for (const struct dirent *e; (e = readdir(folder)) != NULL;) {
        if (e->d_name[0] != '.' && count < MOST_FILES) {
            names[count++] = strdup(e->d_name);
        }
    }
    closedir(folder);
    qsort(names, count, sizeof *names, by_name);
    for (size_t i = 0; i < count; i++) {
        snprintf(full, sizeof full, "%s/%s", path, names[i]);
        runs += run_file(full, mutations);
        free(names[i]);
    }
    if (count == 0) {
        fuzz_abort("%s is empty", path);
    }
    return runs;
}

int main(int count, char **arguments)
{
    long mutations = 500, runs = 0;
    static const char option[] = "-mutations=";
    for (int i = 1; i < count; i++) {
        if (strncmp(arguments[i], option, sizeof option - 1) == 0) {
            mutations = strtol(arguments[i] + sizeof option - 1, NULL, 10);
        }
    }
    for (int i = 1; i < count; i++) {
        struct stat status;
        if (arguments[i][0] == '-') {
            continue;
        }
        const bool is_folder = stat(arguments[i], &status) == 0 && S_ISDIR(status.st_mode);
        runs += is_folder ? run_folder(arguments[i], mutations) : run_file(arguments[i], mutations);
    }
    printf("%ld inputs\n", runs);
    return runs > 0 ? 0 : 2;
}
