// SPDX-License-Identifier: MIT
// Packing: no texel of two shapes, what must be free is free, shapes are turned and never mirrored,
// and pages are as few as they can be where that is known.
#include "atlas_scenes.h"
#include "page_owners.h"

#include "atlas/pack.h"

#include <stdlib.h>

static bool covers(const alpi_pack_item *item, uint32_t x, uint32_t y)
{
    const size_t words = (item->width + 63) / 64;
    return item->mask == NULL || (item->mask[y * words + x / 64] >> (x % 64) & 1) != 0;
}

/// Where texel (x, y) of an item's box lies on its page.
static void turned_place(const alpi_pack_item *item, uint32_t x, uint32_t y, uint32_t at[2])
{
    const uint32_t w = item->width - 1, h = item->height - 1;
    const uint32_t turned[4][2] = {{x, y}, {h - y, x}, {w - x, h - y}, {y, w - x}};
    assert_true(item->turns < 4);
    at[0] = item->x + turned[item->turns][0];
    at[1] = item->y + turned[item->turns][1];
}

/// Which item has each texel, [pages][size][size]; fails where two have one, or one is outside.
static uint16_t *owners(const alpi_pack_item *items, uint32_t count, uint32_t size, uint32_t pages)
{
    uint16_t *taken = malloc((size_t)pages * size * size * sizeof *taken);
    assert_non_null(taken);
    memset(taken, 0xff, (size_t)pages * size * size * sizeof *taken);
    for (uint32_t i = 0; i < count; i++) {
        assert_true(items[i].page < pages);
        for (uint32_t y = 0; y < items[i].height; y++) {
            for (uint32_t x = 0; x < items[i].width; x++) {
                uint32_t at[2];
                turned_place(&items[i], x, y, at);
                assert_true(at[0] < size && at[1] < size);
                uint16_t *owner = &taken[((size_t)items[i].page * size + at[1]) * size + at[0]];
                if (covers(&items[i], x, y)) {
                    assert_int_equal(*owner, FREE);
                    *owner = (uint16_t)i;
                }
            }
        }
    }
    return taken;
}

static void check_places(const alpi_pack_rules *rules, const alpi_pack_item *items, uint32_t count,
                         uint32_t pages)
{
    const size_t room = (size_t)rules->size * rules->size;
    uint16_t *taken = owners(items, count, rules->size, pages);
    for (uint32_t page = 0; page < pages; page++) {
        check_page(taken + page * room, rules);
    }
    free(taken);
}

static void pack_and_check(alp_context *context, const alpi_pack_rules *rules,
                           alpi_pack_item *items, uint32_t count, uint32_t *pages)
{
    ASSERT_OK(context, alpi_pack(context, rules, items, count, 4096, pages));
    check_places(rules, items, count, *pages);
}

TEST_WITH_CONTEXT(random_rectangles, 1)
{
    enum { COUNT = 300 };
    for (uint32_t trial = 0; trial < 30; trial++) {
        alpi_pack_item items[COUNT], again[COUNT];
        const alpi_pack_rules rules = {.size = 64, .padding = trial % 5};
        uint32_t pages = 0;
        double largest = trial % 3 == 0 ? 63.0 : trial % 3 == 1 ? 20.0 : 3.0;
        for (uint32_t i = 0; i < COUNT; i++) {
            items[i] =
                (alpi_pack_item){.width = 1 + (uint32_t)(largest * keyed(trial, 2 * i)),
                                 .height = 1 + (uint32_t)(largest * keyed(trial, 2 * i + 1))};
            again[i] = items[i];
        }
        pack_and_check(context, &rules, items, COUNT, &pages);
        pack_and_check(context, &rules, again, COUNT, &pages);
        assert_memory_equal(items, again, sizeof items);
    }
}

/// A shape grown texel by texel from the middle of its box; it may have holes. [height][words]
static uint64_t *random_mask(uint32_t key, uint32_t width, uint32_t height)
{
    const size_t words = (width + 63) / 64;
    uint64_t *mask = calloc(words * height, sizeof *mask);
    assert_non_null(mask);
    uint32_t x = width / 2, y = height / 2;
    for (uint32_t step = 0; step < 3 * width * height; step++) {
        mask[y * words + x / 64] |= (uint64_t)1 << (x % 64);
        const uint32_t way = (uint32_t)(4.0 * keyed(key, step));
        x = way == 0 && x + 1 < width ? x + 1 : way == 1 && x > 0 ? x - 1 : x;
        y = way == 2 && y + 1 < height ? y + 1 : way == 3 && y > 0 ? y - 1 : y;
    }
    return mask;
}

TEST_WITH_CONTEXT(random_shapes, 1)
{
    enum { COUNT = 60 };
    static const alpi_pack_rules rules[] = {{.size = 64},
                                            {.size = 100, .padding = 3},
                                            {.size = 128, .padding = 2},
                                            {.size = 96, .padding = 1, .block = 4},
                                            {.size = 70, .padding = 0, .block = 12},
                                            {.size = 64, .padding = 1, .mips = 1},
                                            {.size = 128, .padding = 0, .mips = 2},
                                            {.size = 128, .padding = 2, .block = 6, .mips = 3},
                                            {.size = 256, .padding = 17, .block = 8, .mips = 4}};
    for (uint32_t r = 0; r < sizeof rules / sizeof *rules; r++) {
        alpi_pack_item items[COUNT] = {0};
        uint64_t *masks[COUNT];
        uint32_t pages = 0;
        for (uint32_t i = 0; i < COUNT; i++) {
            const double largest = i % 8 == 0 ? 63.0 : 20.0;
            items[i].width = 1 + (uint32_t)(largest * keyed(r + 100, 2 * i));
            items[i].height = 1 + (uint32_t)(largest * keyed(r + 100, 2 * i + 1));
            masks[i] = random_mask(1000 * r + i, items[i].width, items[i].height);
            items[i].mask = masks[i];
        }
        pack_and_check(context, &rules[r], items, COUNT, &pages);
        for (uint32_t i = 0; i < COUNT; i++) {
            free(masks[i]);
        }
    }
}

TEST_WITH_CONTEXT(a_full_page_is_filled, 1)
{
    alpi_pack_item items[64];
    uint32_t pages = 0;
    alpi_pack_rules rules = {.size = 64};
    for (uint32_t i = 0; i < 64; i++) {
        items[i] = (alpi_pack_item){.width = 8, .height = 8};
    }
    pack_and_check(context, &rules, items, 64, &pages);
    assert_int_equal(pages, 1);
    // With padding 2 between, 8·8 + 2·7 texels are needed and no border.
    rules = (alpi_pack_rules){.size = 78, .padding = 2};
    pack_and_check(context, &rules, items, 64, &pages);
    assert_int_equal(pages, 1);
    bool fits = false;
    ASSERT_OK(context, alpi_pack_one_page(context, &rules, items, 64, &fits));
    assert_true(fits);
    rules.size = 77;
    assert_int_equal(alpi_pack(context, &rules, items, 64, 1, &pages), ALP_ERROR_LIMIT);
    ASSERT_OK(context, alpi_pack_one_page(context, &rules, items, 64, &fits));
    assert_false(fits);
}

/// Two Ls of four texels make 2 × 4, eight of those a square of 8; a mirrored one would not fit
/// with them.
TEST_WITH_CONTEXT(tetrominoes_fill_a_square, 1)
{
    static const uint64_t ways[2][2] = {{7, 1}, {7, 4}}; // an L and a J
    const alpi_pack_rules rules = {.size = 8};
    for (int way = 0; way < 2; way++) {
        alpi_pack_item items[16];
        uint32_t pages = 0;
        for (uint32_t i = 0; i < 16; i++) {
            items[i] = (alpi_pack_item){.width = 3, .height = 2, .mask = ways[way]};
        }
        pack_and_check(context, &rules, items, 16, &pages);
        assert_int_equal(pages, 1);
    }
}

TEST_WITH_CONTEXT(a_hole_is_used, 1)
{
    uint64_t ring[12];
    for (uint32_t y = 0; y < 12; y++) { // 12 × 12 with a hole of 8 × 8
        ring[y] = y < 2 || y >= 10 ? 0xfff : 0xc03;
    }
    static const struct {
        uint32_t padding, square, pages;
    } cases[] = {{0, 8, 1}, {0, 9, 2}, {1, 6, 1}, {1, 7, 2}, {3, 2, 1}, {3, 3, 2}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const alpi_pack_rules rules = {.size = 12, .padding = cases[i].padding};
        alpi_pack_item items[2] = {{.width = cases[i].square, .height = cases[i].square},
                                   {.width = 12, .height = 12, .mask = ring}};
        uint32_t pages = 0;
        pack_and_check(context, &rules, items, 2, &pages);
        assert_int_equal(pages, cases[i].pages);
    }
}

/// Small shapes go into what large ones left on earlier pages.
TEST_WITH_CONTEXT(earlier_pages_are_filled, 1)
{
    alpi_pack_item items[12];
    uint32_t pages = 0;
    const alpi_pack_rules rules = {.size = 16};
    for (uint32_t i = 0; i < 12; i++) { // 16 × 9 and 16 × 7: two to a page, if only that
        items[i] = (alpi_pack_item){.width = 16, .height = i < 6 ? 9 : 7};
    }
    pack_and_check(context, &rules, items, 12, &pages);
    assert_int_equal(pages, 6);
}

/// What the gaps are for, counted out: blocks and mip levels take the least they must.
TEST_WITH_CONTEXT(gaps_are_as_small_as_they_can_be, 1)
{
    static const struct {
        alpi_pack_rules rules;
        uint32_t pages; // for two items of 2 × 8
    } cases[] = {
        {{.size = 8}, 1},
        {{.size = 8, .block = 4}, 1},               // columns 0–1 and 4–5
        {{.size = 8, .block = 8}, 2},               // one block
        {{.size = 8, .padding = 4}, 1},             // columns 0–1 and 6–7
        {{.size = 8, .padding = 4, .block = 4}, 1}, // the same
        {{.size = 8, .mips = 1}, 1},                // 2 free texels
        {{.size = 8, .mips = 2}, 1},                // 2 free cells of 2: columns 0–1 and 6–7
        {{.size = 16, .mips = 3}, 1},               // of 4: cells 0 and 3
        {{.size = 8, .mips = 3}, 2},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        alpi_pack_item items[2] = {{.width = 2, .height = 8}, {.width = 2, .height = 8}};
        uint32_t pages = 0;
        pack_and_check(context, &cases[i].rules, items, 2, &pages);
        assert_int_equal(pages, cases[i].pages);
    }
}

/// Other orders never leave more than the best before, what they say to fit does, and any number of
/// workers finds the same.
TEST(other_orders_are_no_worse)
{
    enum { COUNT = 24, ROUNDS = 12 };
    uint64_t left[2][ROUNDS], first[ROUNDS] = {0};
    uint32_t fitted = 0;
    for (int k = 0; k < 2; k++) {
        alp_context *context = test_context(k == 0 ? 1 : 5);
        for (uint32_t size = 40; size < 72; size += 4) {
            const alpi_pack_rules rules = {.size = size, .padding = 1};
            alpi_pack_item items[COUNT] = {0};
            for (uint32_t i = 0; i < COUNT; i++) {
                items[i].width = 2 + (uint32_t)(18.0 * keyed(77, 2 * i));
                items[i].height = 2 + (uint32_t)(18.0 * keyed(77, 2 * i + 1));
            }
            alpi_pack_search search;
            bool fits = false;
            ASSERT_OK(context, alpi_pack_search_create(context, &rules, items, COUNT, &search));
            for (uint32_t r = 0; r < ROUNDS && !fits; r++) {
                ASSERT_OK(context, alpi_pack_search_round(&search, items, r == 0, &fits));
                const uint64_t now = search.variants[ALPI_PACK_VARIANTS].left_texels;
                assert_true(r == 0 || now <= left[k][r - 1]);
                assert_true(k == 0 || size > 40 || now == first[r]);
                left[k][r] = now;
                first[r] = k == 0 && size == 40 ? now : first[r];
                assert_int_equal(fits, now == 0);
            }
            if (fits) {
                check_places(&rules, items, COUNT, 1);
                fitted++;
            }
            alpi_pack_search_destroy(&search);
        }
        alp_context_destroy(context);
    }
    assert_true(fitted > 0 && fitted < 16 && fitted % 2 == 0);
}

TEST_WITH_CONTEXT(pages_are_added, 1)
{
    alpi_pack_item items[5];
    uint32_t pages = 0;
    const alpi_pack_rules rules = {.size = 16, .padding = 3};
    for (uint32_t i = 0; i < 5; i++) {
        items[i] = (alpi_pack_item){.width = 16, .height = 9};
    }
    ASSERT_OK(context, alpi_pack(context, &rules, items, 5, 5, &pages));
    assert_int_equal(pages, 5);
    check_places(&rules, items, 5, 5);
    assert_int_equal(alpi_pack(context, &rules, items, 5, 4, &pages), ALP_ERROR_LIMIT);
    assert_non_null(strstr(alp_context_message(context), "4 pages"));
}

TEST_WITH_CONTEXT(turning_helps, 1)
{
    alpi_pack_item items[2] = {{.width = 10, .height = 5}, {.width = 5, .height = 10}};
    uint32_t pages = 0;
    const alpi_pack_rules rules = {.size = 10};
    ASSERT_OK(context, alpi_pack(context, &rules, items, 2, 1, &pages));
    assert_true(items[0].turns % 2 != items[1].turns % 2);
    check_places(&rules, items, 2, 1);
}

/// Half squares of unlike sizes, as loose triangles are: work grows as their number does, not as
/// its square. Looked for all over their pages, each takes thousands of rows.
TEST_SLOW_WITH_CONTEXT(work_is_linear, 1)
{
    enum { COUNT = 16000, LEAST = 16, MOST = 47 };
    uint64_t masks[MOST + 1][MOST] = {0};
    for (uint32_t side = LEAST; side <= MOST; side++) {
        for (uint32_t y = 0; y < side; y++) {
            masks[side][y] = ((uint64_t)1 << (y + 1)) - 1;
        }
    }
    alpi_pack_item *items = calloc(COUNT, sizeof *items);
    assert_non_null(items);
    uint64_t rows[2] = {0, 0};
    for (uint32_t k = 0; k < 2; k++) {
        const uint32_t count = k == 0 ? COUNT / 4 : COUNT;
        const alpi_pack_rules rules = {
            .size = k == 0 ? 2048 : 4096, .padding = 2, .rows_tried = &rows[k]};
        uint32_t pages = 0;
        for (uint32_t i = 0; i < count; i++) {
            const uint32_t side = LEAST + (uint32_t)((MOST + 1 - LEAST) * keyed(i, k));
            const uint32_t height = side - (uint32_t)(8 * keyed(i, 2 + k));
            items[i] = (alpi_pack_item){.width = side, .height = height, .mask = masks[side]};
        }
        ASSERT_OK(context, alpi_pack(context, &rules, items, count, 1, &pages));
        assert_true(rows[k] < (uint64_t)500 * count); // 4 turns, 1.4 sides of slack each, and the
                                                      // first look over the page of each class
    }
    assert_true(rows[1] < 5 * rows[0]);
    free(items);
}

TEST_SLOW_WITH_CONTEXT(sides_at_their_ends, 1)
{
    alpi_pack_item item = {.width = 1, .height = 1};
    alpi_pack_rules rules = {.size = 1, .padding = 64};
    uint32_t pages = 0;
    ASSERT_OK(context, alpi_pack(context, &rules, &item, 1, 1, &pages));
    assert_int_equal(pages, 1);
    rules.size = 16384;
    item.width = 16384;
    item.height = 16384;
    ASSERT_OK(context, alpi_pack(context, &rules, &item, 1, 1, &pages));
    assert_true(item.x == 0 && item.y == 0);
    item.height = 16385;
    assert_int_equal(alpi_pack(context, &rules, &item, 1, 1, &pages), ALP_ERROR_LIMIT);
    rules.size = 16;
    ASSERT_OK(context, alpi_pack(context, &rules, NULL, 0, 1, &pages));
    assert_int_equal(pages, 0);
}

TEST_WITH_CONTEXT(groups_stay_together, 1)
{
    enum { COUNT = 90, GROUPS = 30 };
    const alpi_pack_rules rules = {.size = 64, .padding = 2};
    alpi_pack_item items[COUNT] = {0};
    uint32_t groups[COUNT], pages = 0;
    for (uint32_t i = 0; i < COUNT; i++) { // three of a group side by side fit 64 in any case
        items[i].width = 1 + (uint32_t)(19.0 * keyed(5, 2 * i));
        items[i].height = 1 + (uint32_t)(19.0 * keyed(5, 2 * i + 1));
        groups[i] = i % GROUPS;
    }
    ASSERT_OK(context, alpi_pack_groups(context, &rules, items, groups, COUNT, 4096, &pages));
    check_places(&rules, items, COUNT, pages);
    assert_true(pages > 1);
    for (uint32_t i = GROUPS; i < COUNT; i++) {
        assert_int_equal(items[i].page, items[i % GROUPS].page);
    }
    assert_int_equal(alpi_pack_groups(context, &rules, items, groups, COUNT, 1, &pages),
                     ALP_ERROR_LIMIT);
}

/// Two squares of 33 do not fit a page of 64; each fits the corner that a larger item leaves. The
/// page on which both were tried goes.
TEST_WITH_CONTEXT(groups_that_fit_no_page_are_parted, 1)
{
    const alpi_pack_rules rules = {.size = 64};
    uint64_t mask[64];
    for (uint32_t y = 0; y < 64; y++) {
        mask[y] = y < 33 ? UINT64_MAX << 33 : UINT64_MAX;
    }
    alpi_pack_item items[4] = {{.width = 33, .height = 33},
                               {.width = 64, .height = 64, .mask = mask},
                               {.width = 33, .height = 33},
                               {.width = 64, .height = 64, .mask = mask}};
    static const uint32_t groups[4] = {0, 1, 0, 3};
    uint32_t pages = 0;
    ASSERT_OK(context, alpi_pack_groups(context, &rules, items, groups, 4, 4096, &pages));
    check_places(&rules, items, 4, pages);
    assert_int_equal(pages, 2);
}
