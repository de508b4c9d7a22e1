// SPDX-License-Identifier: MIT
// The log of tiles: records come back, damage costs the records behind it or its own, and never
// gives wrong bytes.
#include "test_support.h"

#include "base/random.h"
#include "base/tiles/tile_log.h"
#include "test_obj.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

enum { RECORDS = 5, KEY = 77, HEAD = 24 };

TEST_CONTEXT(1);
static char path[1024];
static uint8_t *whole; // bytes of the file of write_log; malloc'ed
static size_t whole_size;

static size_t size_of(uint32_t record)
{
    return 40 + 50 * (size_t)record;
}

/// Appends records [from, to), in one piece.
static bool append(alpi_tile_log *log, uint32_t from, uint32_t to)
{
    alpi_bytes bytes = alpi_bytes_create(context);
    for (uint32_t i = from; i < to; i++) {
        static const alpi_tile_head room = {0};
        const size_t start = bytes.size;
        alpi_bytes_add(&bytes, &room, sizeof room);
        for (size_t k = 0; k < size_of(i); k++) {
            const uint8_t byte = (uint8_t)(7 * i + k);
            alpi_bytes_add(&bytes, &byte, 1);
        }
        alpi_tile_log_seal(i, 100 + i, start, &bytes);
    }
    const bool good = alpi_tile_log_append(log, bytes.bytes, bytes.size);
    alpi_bytes_destroy(&bytes);
    return good;
}

/// Whether a record has its bytes. Fails the test if wrong bytes count as right ones.
static bool has_record(const alpi_tile_log *log, size_t i)
{
    const alpi_tile_record *r = &log->records[i];
    uint8_t *bytes = malloc((size_t)r->head.size + 1);
    assert_non_null(bytes);
    const bool good = alpi_tile_log_read(log, r, bytes);
    if (good) {
        const uint32_t n = r->head.loop;
        assert_int_equal(r->head.shape, 100 + n);
        assert_int_equal(r->head.size, size_of(n));
        for (size_t k = 0; k < size_of(n); k++) {
            assert_int_equal(bytes[k], (uint8_t)(7 * n + k));
        }
    }
    free(bytes);
    return good;
}

/// Opens the log, counts records with right bytes, which must follow each other, and closes it.
static size_t count_good(uint64_t key, bool writes, bool *damaged)
{
    alpi_tile_log log;
    size_t good = 0;
    ASSERT_OK(context, alpi_tile_log_open(context, path, key, writes, &log));
    for (size_t i = 0; i < log.count; i++) {
        assert_int_equal(log.records[i].head.loop, i);
        good += has_record(&log, i) ? 1 : 0;
    }
    *damaged = log.damaged;
    alpi_tile_log_close(&log);
    return good;
}

static void write_log(void)
{
    alpi_tile_log log;
    snprintf(path, sizeof path, "%s/bake.tiles", test_folder());
    ASSERT_OK(context, alpi_tile_log_open(context, path, KEY, true, &log));
    assert_false(log.damaged);
    assert_int_equal(log.count, 0);
    assert_true(append(&log, 0, 2));
    assert_true(append(&log, 2, RECORDS));
    alpi_tile_log_close(&log);
    free(whole);
    whole = test_read_file(path, &whole_size);
}

/// Record that holds this byte, its head included; RECORDS: behind all; −1: head of the file.
static long record_at(size_t byte)
{
    size_t end = HEAD;
    if (byte < end) {
        return -1;
    }
    for (uint32_t i = 0; i < RECORDS; i++) {
        end += sizeof(alpi_tile_head) + size_of(i);
        if (byte < end) {
            return i;
        }
    }
    return RECORDS;
}

TEST(records_come_back)
{
    bool damaged = true;
    write_log();
    assert_int_equal(record_at(whole_size), RECORDS);
    assert_int_equal(record_at(whole_size - 1), RECORDS - 1);
    assert_int_equal(count_good(KEY, false, &damaged), RECORDS);
    assert_false(damaged);
    assert_int_equal(count_good(KEY, true, &damaged), RECORDS);
    assert_false(damaged);
}

/// A writer cuts off what is damaged, and appends in its place.
static void go_on_from(size_t good)
{
    alpi_tile_log log;
    bool damaged = true;
    struct stat about;
    ASSERT_OK(context, alpi_tile_log_open(context, path, KEY, true, &log));
    assert_int_equal(log.count, good);
    assert_int_equal(stat(path, &about), 0);
    assert_int_equal(about.st_size, log.end);
    assert_true(append(&log, (uint32_t)good, RECORDS));
    alpi_tile_log_close(&log);
    assert_int_equal(count_good(KEY, false, &damaged), RECORDS);
    assert_false(damaged);
}

static void cut_at(size_t size)
{
    bool damaged = false;
    const long cut = record_at(size);
    test_write_file(path, whole, size);
    const size_t expected = cut > 0 ? (size_t)cut : 0;
    assert_int_equal(count_good(KEY, false, &damaged), expected);
    size_t end = HEAD;
    for (uint32_t i = 0; i < expected; i++) {
        end += sizeof(alpi_tile_head) + size_of(i);
    }
    assert_int_equal(damaged, size > 0 && size != end);
    go_on_from(expected);
}

TEST(truncated_at_each_sixteenth_and_anywhere)
{
    uint64_t seed = 5;
    write_log();
    for (size_t k = 0; k < 16; k++) {
        cut_at(whole_size * k / 16);
    }
    for (int k = 0; k < 200; k += TEST_STEP) {
        seed = alpi_hash64(seed);
        cut_at(seed % whole_size);
    }
}

/// One bit: of a payload, it costs this record; of a head, this record and those behind it; of the
/// file's head, all.
TEST(one_bit_flipped)
{
    write_log();
    for (size_t at = 0; at < whole_size; at += at < HEAD + sizeof(alpi_tile_head) ? 1 : 5) {
        bool damaged = false;
        whole[at] ^= (uint8_t)(1u << at % 8);
        test_write_file(path, whole, whole_size);
        whole[at] ^= (uint8_t)(1u << at % 8);
        const size_t good = count_good(KEY, false, &damaged);
        const long record = record_at(at);
        size_t begin = HEAD;
        for (long i = 0; i < record; i++) {
            begin += sizeof(alpi_tile_head) + size_of((uint32_t)i);
        }
        const bool in_head = record < 0 || at < begin + sizeof(alpi_tile_head);
        assert_int_equal(damaged, in_head);
        assert_int_equal(good, record < 0 ? 0 : in_head ? (size_t)record : RECORDS - 1);
    }
}

TEST(other_keys_and_versions_are_empty)
{
    bool damaged = false;
    write_log();
    assert_int_equal(count_good(KEY + 1, false, &damaged), 0);
    assert_true(damaged);
    whole[7]++; // "ALPTILE2"
    test_write_file(path, whole, whole_size);
    assert_int_equal(count_good(KEY, false, &damaged), 0);
    assert_true(damaged);
    go_on_from(0);
    test_write_text(path, "something else");
    assert_int_equal(count_good(KEY, false, &damaged), 0);
    assert_true(damaged);
    go_on_from(0);
}

TEST(a_second_writer_is_refused)
{
    alpi_tile_log log, second;
    bool damaged = false;
    write_log();
    ASSERT_OK(context, alpi_tile_log_open(context, path, KEY, true, &log));
    assert_int_equal(alpi_tile_log_open(context, path, KEY, true, &second), ALP_ERROR_IO);
    assert_non_null(strstr(alp_context_message(context), "another process writes"));
    assert_int_equal(count_good(KEY, false, &damaged), RECORDS); // readers are not
    alpi_tile_log_close(&log);
    ASSERT_OK(context, alpi_tile_log_open(context, path, KEY, true, &second));
    alpi_tile_log_close(&second);
}

/// A log that cannot be opened or written says why.
TEST(no_log)
{
    alpi_tile_log log;
    snprintf(path, sizeof path, "%s/missing/bake.tiles", test_folder());
    assert_int_equal(alpi_tile_log_open(context, path, KEY, true, &log), ALP_ERROR_IO);
    assert_int_equal(alpi_tile_log_open(context, path, KEY, false, &log), ALP_ERROR_IO);
    assert_non_null(strstr(alp_context_message(context), "No such file"));
    snprintf(path, sizeof path, "%s/pipe", test_folder());
    assert_int_equal(mkfifo(path, 0600), 0);
    assert_int_equal(alpi_tile_log_open(context, path, KEY, false, &log), ALP_ERROR_IO);
    assert_int_equal(alpi_tile_log_open(context, path, KEY, true, &log), ALP_ERROR_IO);
}

/// A full disk: the file keeps its end, and takes the records later.
TEST(a_full_disk)
{
    alpi_tile_log log;
    bool damaged = true;
    struct rlimit limit, small;
    write_log();
    unlink(path);
    ASSERT_OK(context, alpi_tile_log_open(context, path, KEY, true, &log));
    assert_true(append(&log, 0, 2));
    void (*former)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    small = limit;
    small.rlim_cur = log.end + 100; // a part of the next record
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    const bool taken = append(&log, 2, RECORDS);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    signal(SIGXFSZ, former);
    assert_false(taken);
    assert_int_equal(count_good(KEY, false, &damaged), 2);
    assert_false(damaged);
    assert_true(append(&log, 2, RECORDS));
    alpi_tile_log_close(&log);
    assert_int_equal(count_good(KEY, false, &damaged), RECORDS);
    assert_false(damaged);
    free(whole);
    whole = NULL;
}
