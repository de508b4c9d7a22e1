// SPDX-License-Identifier: MIT
// Packing: nothing overlaps, the padding is free, pages are as few as they can be where that is
// known.
#include "atlas_scenes.h"

#include <stdlib.h>

/// Fails unless all items are inside their pages and `padding` apart.
static void check_places(const alpi_pack_item *items, uint32_t count, uint32_t size,
                         uint32_t padding, uint32_t pages)
{
    unsigned char *taken = calloc((size_t)pages * size * size, 1);
    assert_non_null(taken);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t w = items[i].turned ? items[i].height : items[i].width;
        uint32_t h = items[i].turned ? items[i].width : items[i].height;
        assert_true(items[i].page < pages);
        assert_true(items[i].x + w <= size && items[i].y + h <= size);
        for (uint32_t y = items[i].y; y < items[i].y + h; y++) {
            for (uint32_t x = items[i].x; x < items[i].x + w; x++) {
                unsigned char *at = &taken[((size_t)items[i].page * size + y) * size + x];
                assert_int_equal(*at, 0);
                *at = 1;
            }
        }
    }
    for (uint32_t i = 0; i < count; i++) { // what is near an item is its own, or free
        uint32_t w = items[i].turned ? items[i].height : items[i].width;
        uint32_t h = items[i].turned ? items[i].width : items[i].height;
        uint32_t x0 = items[i].x > padding ? items[i].x - padding : 0;
        uint32_t y0 = items[i].y > padding ? items[i].y - padding : 0;
        uint32_t near = 0;
        for (uint32_t y = y0; y < items[i].y + h + padding && y < size; y++) {
            for (uint32_t x = x0; x < items[i].x + w + padding && x < size; x++) {
                near += taken[((size_t)items[i].page * size + y) * size + x];
            }
        }
        assert_int_equal(near, w * h);
    }
    free(taken);
}

static void random_rectangles(void **state)
{
    (void)state;
    enum { COUNT = 300 };
    alp_context *context = test_context(1);
    for (uint32_t trial = 0; trial < 30; trial++) {
        alpi_pack_item items[COUNT], again[COUNT];
        uint32_t padding = trial % 5, size = 64, pages = 0, pages_again = 0;
        double largest = trial % 3 == 0 ? 63.0 : trial % 3 == 1 ? 20.0 : 3.0;
        for (uint32_t i = 0; i < COUNT; i++) {
            items[i] =
                (alpi_pack_item){.width = 1 + (uint32_t)(largest * keyed(trial, 2 * i)),
                                 .height = 1 + (uint32_t)(largest * keyed(trial, 2 * i + 1))};
            again[i] = items[i];
        }
        ASSERT_OK(context, alpi_pack(context, items, COUNT, size, padding, 4096, &pages));
        check_places(items, COUNT, size, padding, pages);
        ASSERT_OK(context, alpi_pack(context, again, COUNT, size, padding, 4096, &pages_again));
        assert_memory_equal(items, again, sizeof items);
    }
    alp_context_destroy(context);
}

static void a_full_page_is_filled(void **state)
{
    (void)state;
    alp_context *context = test_context(1);
    alpi_pack_item items[64];
    uint32_t pages = 0;
    for (uint32_t i = 0; i < 64; i++) {
        items[i] = (alpi_pack_item){.width = 8, .height = 8};
    }
    ASSERT_OK(context, alpi_pack(context, items, 64, 64, 0, 1, &pages));
    assert_int_equal(pages, 1);
    check_places(items, 64, 64, 0, 1);
    // With padding 2 between, 8·8 + 2·7 texels are needed and no border.
    ASSERT_OK(context, alpi_pack(context, items, 64, 78, 2, 1, &pages));
    check_places(items, 64, 78, 2, 1);
    assert_int_equal(alpi_pack(context, items, 64, 77, 2, 1, &pages), ALP_ERROR_LIMIT);
    bool fits = true;
    ASSERT_OK(context, alpi_pack_one_page(context, items, 64, 77, 2, &fits));
    assert_false(fits);
    ASSERT_OK(context, alpi_pack_one_page(context, items, 64, 78, 2, &fits));
    assert_true(fits);
    alp_context_destroy(context);
}

static void pages_are_added(void **state)
{
    (void)state;
    alp_context *context = test_context(1);
    alpi_pack_item items[5];
    uint32_t pages = 0;
    for (uint32_t i = 0; i < 5; i++) {
        items[i] = (alpi_pack_item){.width = 16, .height = 9};
    }
    ASSERT_OK(context, alpi_pack(context, items, 5, 16, 3, 5, &pages));
    assert_int_equal(pages, 5);
    check_places(items, 5, 16, 3, 5);
    assert_int_equal(alpi_pack(context, items, 5, 16, 3, 4, &pages), ALP_ERROR_LIMIT);
    assert_non_null(strstr(alp_context_message(context), "4 pages"));
    alp_context_destroy(context);
}

static void turning_helps(void **state)
{
    (void)state;
    alp_context *context = test_context(1);
    alpi_pack_item items[2] = {{.width = 10, .height = 5}, {.width = 5, .height = 10}};
    uint32_t pages = 0;
    ASSERT_OK(context, alpi_pack(context, items, 2, 10, 0, 1, &pages));
    assert_true(items[0].turned != items[1].turned);
    check_places(items, 2, 10, 0, 1);
    alp_context_destroy(context);
}

static void sides_at_their_ends(void **state)
{
    (void)state;
    alp_context *context = test_context(1);
    alpi_pack_item item = {.width = 1, .height = 1};
    uint32_t pages = 0;
    ASSERT_OK(context, alpi_pack(context, &item, 1, 1, 64, 1, &pages));
    assert_int_equal(pages, 1);
    item.width = 16384;
    item.height = 16384;
    ASSERT_OK(context, alpi_pack(context, &item, 1, 16384, 64, 1, &pages));
    assert_true(item.x == 0 && item.y == 0);
    item.height = 16385;
    assert_int_equal(alpi_pack(context, &item, 1, 16384, 0, 1, &pages), ALP_ERROR_LIMIT);
    ASSERT_OK(context, alpi_pack(context, NULL, 0, 16, 0, 1, &pages));
    assert_int_equal(pages, 0);
    alp_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_rectangles),   cmocka_unit_test(a_full_page_is_filled),
        cmocka_unit_test(pages_are_added),     cmocka_unit_test(turning_helps),
        cmocka_unit_test(sides_at_their_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
