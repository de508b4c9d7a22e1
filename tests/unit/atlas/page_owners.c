// SPDX-License-Identifier: MIT
// What a packed page must hold, texel by texel, by the plainest way of asking.
#include "page_owners.h"

#include <stdlib.h>

enum { SEVERAL = 0xfffe }; // of a mip texel

/// What is within `padding` of a texel is its owner's, or free.
static void check_padding(const uint16_t *page, uint32_t size, uint32_t padding)
{
    for (uint32_t y = 0; y < size; y++) {
        for (uint32_t x = 0; x < size; x++) {
            const uint16_t owner = page[y * size + x];
            if (owner == FREE) {
                continue;
            }
            for (uint32_t v = y > padding ? y - padding : 0; v <= y + padding && v < size; v++) {
                for (uint32_t u = x; u <= x + padding && u < size; u++) {
                    assert_true(page[v * size + u] == owner || page[v * size + u] == FREE);
                }
            }
        }
    }
}

static void check_blocks(const uint16_t *page, uint32_t size, uint32_t block)
{
    for (uint32_t y = 0; y < size; y++) {
        for (uint32_t x = 0; x < size; x++) {
            if (page[y * size + x] == FREE) {
                continue;
            }
            // The first texel with an owner has the block.
            uint16_t first = FREE;
            for (uint32_t v = y / block * block; v < y / block * block + block && v < size; v++) {
                for (uint32_t u = x / block * block; u < x / block * block + block && u < size;
                     u++) {
                    first = first == FREE ? page[v * size + u] : first;
                }
            }
            assert_int_equal(page[y * size + x], first);
        }
    }
}

/// The two texels of a level that a linear look-up at `at` (in texels of that level) reads, held at
/// the border; the same twice where one of them has no weight.
static void looked_up(double at, uint32_t size, uint32_t read[2])
{
    const double low = floor(at - 0.5);
    const double high = at - 0.5 > low ? low + 1.0 : low;
    read[0] = (uint32_t)fmin(fmax(low, 0.0), size - 1.0);
    read[1] = (uint32_t)fmin(fmax(high, 0.0), size - 1.0);
}

/// Looks up at points of a texel at a level.
static void check_texel(const uint16_t *level, uint32_t side, uint32_t k, uint32_t x, uint32_t y,
                        uint16_t owner)
{
    static const double inside[4] = {0.0, 0.01, 0.5, 0.99};
    for (int i = 0; i < 16; i++) {
        uint32_t u[2], v[2];
        looked_up((x + inside[i % 4]) / (1u << k), side, u);
        looked_up((y + inside[i / 4]) / (1u << k), side, v);
        for (int j = 0; j < 4; j++) {
            const uint16_t read = level[v[j / 2] * side + u[j % 2]];
            assert_true(read == FREE || read == owner);
        }
    }
}

/// Builds the mip chain of owners and looks up at points of each texel: their owner's values alone
/// are read.
static void check_mips(const uint16_t *page, uint32_t size, uint32_t mips)
{
    uint16_t *level = malloc((size_t)size * size * sizeof *level);
    assert_non_null(level);
    memcpy(level, page, (size_t)size * size * sizeof *level);
    for (uint32_t k = 1; k <= mips; k++) {
        const uint32_t side = size >> k;
        for (uint32_t y = 0; y < side; y++) {
            for (uint32_t x = 0; x < side; x++) {
                uint16_t mean = FREE;
                for (uint32_t i = 0; i < 4; i++) {
                    const uint16_t part = level[(2 * y + i / 2) * (2 * side) + 2 * x + i % 2];
                    mean = part == FREE || part == mean ? mean : mean == FREE ? part : SEVERAL;
                }
                level[y * side + x] = mean; // before all that is still read
            }
        }
        for (uint32_t i = 0; i < size * size; i++) {
            if (page[i] != FREE) {
                check_texel(level, side, k, i % size, i / size, page[i]);
            }
        }
    }
    free(level);
}

void check_page(const uint16_t *page, const alpi_pack_rules *rules)
{
    check_padding(page, rules->size, rules->padding);
    check_blocks(page, rules->size, rules->block > 0 ? rules->block : 1);
    check_mips(page, rules->size, rules->mips);
}
