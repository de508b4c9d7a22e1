// SPDX-License-Identifier: MIT
// Bytes of tiles: outputs with and without lists come back to their places, and hostile bytes
// change nothing.
#include "test_support.h"

#include "base/tiles/tile_bytes.h"

#include <stdatomic.h>
#include <stdlib.h>

enum { ITEMS = 23, GRAIN = 4, TILES = 6, EACH = 3, PLACES = 80, ELEMENTS = 68 };

/// Outputs of a loop: one number an item, in order; and ELEMENTS triples of bytes, three an item
/// and two of the last, in places of a list.
typedef struct outputs {
    uint32_t numbers[ITEMS];
    uint8_t listed[PLACES][3];
    uint32_t list[ELEMENTS];
    _Atomic uint8_t states[TILES];
    alpi_tile_output outputs[3];
    alpi_tile_loop loop;
} outputs;

static void set_outputs(outputs *o, uint8_t fill)
{
    memset(o, fill, sizeof o->numbers + sizeof o->listed);
    for (uint32_t i = 0; i < ELEMENTS; i++) {
        o->list[i] = i * 37 % PLACES; // 37 and 80 have no factor in common
    }
    for (uint32_t t = 0; t < TILES; t++) {
        o->states[t] = ALPI_TILE_OPEN;
    }
    o->outputs[0] = (alpi_tile_output){.data = o->numbers, .size = 4, .count = ITEMS};
    o->outputs[1] = (alpi_tile_output){.data = NULL, .size = 8, .count = ITEMS};
    o->outputs[2] = (alpi_tile_output){
        .data = o->listed, .size = 3, .list = o->list, .count = ELEMENTS, .each = EACH};
    o->loop = (alpi_tile_loop){
        .name = "test", .count = ITEMS, .grain = GRAIN, .outputs = o->outputs, .output_count = 3};
}

/// Fills the outputs as the loop would.
static void run_loop(outputs *o)
{
    for (uint32_t i = 0; i < ITEMS; i++) {
        o->numbers[i] = 1000 + i;
    }
    for (uint32_t i = 0; i < ELEMENTS; i++) {
        memset(o->listed[o->list[i]], 100 + (int)i, 3);
    }
    for (uint32_t t = 0; t < TILES; t++) {
        o->states[t] = ALPI_TILE_RAN;
    }
}

/// Fails unless the items of these tiles have the loop's results, and no others have.
static void assert_outputs(const outputs *o, unsigned tiles)
{
    bool owned[PLACES] = {false};
    for (uint32_t i = 0; i < ITEMS; i++) {
        const bool has = tiles >> i / GRAIN & 1u;
        assert_int_equal(o->numbers[i], has ? 1000 + i : 0xeeeeeeeeu);
    }
    for (uint32_t i = 0; i < ELEMENTS; i++) {
        const bool has = tiles >> i / EACH / GRAIN & 1u;
        for (int k = 0; k < 3; k++) {
            assert_int_equal(o->listed[o->list[i]][k], has ? 100 + i : 0xee);
        }
        owned[o->list[i]] = true;
    }
    for (uint32_t p = 0; p < PLACES; p++) {
        assert_true(owned[p] || o->listed[p][0] == 0xee);
    }
}

static outputs made, taken;
TEST_CONTEXT(1);

static alpi_bytes pack(unsigned tiles, size_t most, uint32_t *from, uint32_t expected)
{
    alpi_bytes bytes = alpi_bytes_create(context);
    for (uint32_t t = 0; t < TILES; t++) {
        made.states[t] = tiles >> t & 1u ? ALPI_TILE_RAN : ALPI_TILE_OPEN;
    }
    assert_int_equal(
        alpi_tile_pack(&made.loop, made.states, 1u << ALPI_TILE_RAN, true, from, most, &bytes),
        expected);
    return bytes;
}

static uint32_t count_bits(unsigned tiles)
{
    uint32_t count = 0;
    for (; tiles != 0; tiles &= tiles - 1) {
        count++;
    }
    return count;
}

TEST(tiles_cover_the_items)
{
    set_outputs(&made, 0);
    assert_int_equal(alpi_tile_count(&made.loop), TILES);
    assert_int_equal(alpi_tile_begin(&made.loop, 5), 20);
    assert_int_equal(alpi_tile_begin(&made.loop, TILES), ITEMS);
    assert_int_equal(alpi_tile_size(&made.loop, (alpi_tile_run){0, 1}), 4 * 4 + 12 * 3);
    assert_int_equal(alpi_tile_size(&made.loop, (alpi_tile_run){5, 1}), 3 * 4 + 8 * 3);
    assert_int_equal(alpi_tile_size(&made.loop, (alpi_tile_run){0, TILES}),
                     ITEMS * 4 + ELEMENTS * 3);
}

TEST(any_tiles_come_back)
{
    set_outputs(&made, 0xee);
    run_loop(&made);
    for (unsigned tiles = 1; tiles < 1u << TILES; tiles++) {
        uint32_t from = 0;
        set_outputs(&taken, 0xee);
        alpi_bytes bytes = pack(tiles, SIZE_MAX, &from, count_bits(tiles));
        assert_true(alpi_tile_unpack(&taken.loop, bytes.bytes, bytes.size, taken.states));
        assert_outputs(&taken, tiles);
        for (uint32_t t = 0; t < TILES; t++) {
            const bool has = tiles >> t & 1u;
            assert_int_equal(taken.states[t], has ? ALPI_TILE_READ : ALPI_TILE_OPEN);
            assert_int_equal(made.states[t], has ? ALPI_TILE_KEPT : ALPI_TILE_OPEN);
        }
        alpi_bytes_destroy(&bytes);
    }
}

/// Packed by and by, in records of about one tile.
TEST(records_of_few_bytes)
{
    set_outputs(&made, 0xee);
    set_outputs(&taken, 0xee);
    run_loop(&made);
    uint32_t from = 0, records = 0;
    while (from < TILES) {
        alpi_bytes bytes = alpi_bytes_create(context);
        assert_int_equal(
            alpi_tile_pack(&made.loop, made.states, 1u << ALPI_TILE_RAN, true, &from, 60, &bytes),
            2);
        assert_true(alpi_tile_unpack(&taken.loop, bytes.bytes, bytes.size, taken.states));
        alpi_bytes_destroy(&bytes);
        records++;
    }
    assert_int_equal(records, 3);
    assert_outputs(&taken, (1u << TILES) - 1);
}

TEST(packed_bytes_follow_others)
{
    set_outputs(&made, 0xee);
    set_outputs(&taken, 0xee);
    run_loop(&made);
    uint32_t from = 2;
    alpi_bytes bytes = alpi_bytes_create(context);
    alpi_bytes_add(&bytes, "before", 6);
    assert_int_equal(alpi_tile_pack(&made.loop, made.states, 1u << ALPI_TILE_RAN, false, &from,
                                    SIZE_MAX, &bytes),
                     TILES - 2);
    assert_int_equal(made.states[3], ALPI_TILE_RAN); // not kept
    assert_memory_equal(bytes.bytes, "before", 6);
    assert_true(alpi_tile_unpack(&taken.loop, bytes.bytes + 6, bytes.size - 6, taken.states));
    assert_outputs(&taken, (1u << TILES) - 4);
    alpi_bytes_destroy(&bytes);
}

/// Unpacks a copy as long as it is, so that a sanitizer sees a read past it.
static bool unpack(const uint8_t *bytes, size_t size)
{
    uint8_t *copy = malloc(size > 0 ? size : 1);
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    const bool good = alpi_tile_unpack(&taken.loop, copy, size, taken.states);
    free(copy);
    return good;
}

TEST(truncated_bytes_change_nothing)
{
    uint32_t from = 0;
    set_outputs(&made, 0xee);
    run_loop(&made);
    set_outputs(&taken, 0xee);
    alpi_bytes bytes = pack(0x2d, SIZE_MAX, &from, 4); // runs 0, 2-3, 5
    for (size_t size = 0; size < bytes.size; size++) {
        assert_false(unpack(bytes.bytes, size));
    }
    alpi_bytes_add(&bytes, "", 1);
    assert_false(unpack(bytes.bytes, bytes.size));
    assert_outputs(&taken, 0);
    for (uint32_t t = 0; t < TILES; t++) {
        assert_int_equal(taken.states[t], ALPI_TILE_OPEN);
    }
    alpi_bytes_destroy(&bytes);
}

/// Counts and places that lie outside of the loop.
TEST(wrong_runs_change_nothing)
{
    static const uint32_t wrong[] = {3,          4,          6,          7,          0x1fffffff,
                                     0x20000000, 0x7fffffff, 0x80000000, 0xfffffffe, 0xffffffff};
    uint32_t from = 0;
    set_outputs(&made, 0xee);
    run_loop(&made);
    set_outputs(&taken, 0xee);
    alpi_bytes bytes = pack(0x05, SIZE_MAX, &from, 2); // 2 runs: (0, 1), (2, 1)
    for (size_t word = 0; word < 5; word++) {
        for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
            uint32_t was, changed = wrong[i];
            memcpy(&was, bytes.bytes + 4 * word, 4);
            memcpy(bytes.bytes + 4 * word, &changed, 4);
            const bool is_in_loop = word % 2 == 1 && changed < TILES - 1; // of a run's first tile
            assert_int_equal(unpack(bytes.bytes, bytes.size), is_in_loop);
            if (is_in_loop) {
                set_outputs(&taken, 0xee);
            }
            assert_outputs(&taken, 0);
            memcpy(bytes.bytes + 4 * word, &was, 4);
        }
    }
    alpi_bytes_destroy(&bytes);
}

/// More tiles than there are, with the bytes of all of them.
TEST(a_run_past_the_end_changes_nothing)
{
    static const uint32_t counts[] = {TILES + 1, 1000, 0xffffffff};
    uint32_t from = 0;
    set_outputs(&made, 0xee);
    run_loop(&made);
    set_outputs(&taken, 0xee);
    alpi_bytes bytes = pack((1u << TILES) - 1, SIZE_MAX, &from, TILES); // one run
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        memcpy(bytes.bytes + 8, &counts[i], 4);
        assert_false(unpack(bytes.bytes, bytes.size));
        assert_outputs(&taken, 0);
    }
    alpi_bytes_destroy(&bytes);
}

TEST(shapes_differ)
{
    set_outputs(&made, 0);
    const uint64_t shape = alpi_tile_shape(&made.loop);
    set_outputs(&taken, 1); // other values, the same shape
    assert_true(alpi_tile_shape(&taken.loop) == shape);
    taken.loop.name = "tess";
    assert_true(alpi_tile_shape(&taken.loop) != shape);
    set_outputs(&taken, 0);
    taken.loop.grain = 5;
    assert_true(alpi_tile_shape(&taken.loop) != shape);
    set_outputs(&taken, 0);
    taken.outputs[0].size = 2;
    assert_true(alpi_tile_shape(&taken.loop) != shape);
    set_outputs(&taken, 0);
    taken.outputs[1].data = taken.numbers;
    assert_true(alpi_tile_shape(&taken.loop) != shape);
    set_outputs(&taken, 0);
    taken.outputs[2].each = 4;
    assert_true(alpi_tile_shape(&taken.loop) != shape);
    set_outputs(&taken, 0);
    taken.list[ELEMENTS - 1]++;
    assert_true(alpi_tile_shape(&taken.loop) != shape);
}

TEST(without_memory_nothing_is_packed)
{
    int left = 1000;
    alp_context *poor = test_context_failing(&left);
    set_outputs(&made, 0xee);
    run_loop(&made);
    left = 0;
    uint32_t from = 0;
    alpi_bytes bytes = alpi_bytes_create(poor);
    assert_int_equal(
        alpi_tile_pack(&made.loop, made.states, 1u << ALPI_TILE_RAN, true, &from, SIZE_MAX, &bytes),
        0);
    assert_true(bytes.failed);
    for (uint32_t t = 0; t < TILES; t++) {
        assert_int_equal(made.states[t], ALPI_TILE_RAN);
    }
    alpi_bytes_destroy(&bytes);
    alp_context_destroy(poor);
}
