// SPDX-License-Identifier: MIT
// Shapes on pages, in bits: what the packer moves about.
#ifndef ALPI_ATLAS_PACK_H
#define ALPI_ATLAS_PACK_H

#include "atlas/stages.h"

/// The texels [begin, end) of a row, all covered.
typedef struct alpi_run {
    uint16_t row, begin, end;
} alpi_run;

/// What an item covers when it is turned in one of the four ways.
typedef struct alpi_shape {
    uint32_t width, height;
    uint64_t moment[2]; // twice the sums of its texels' middles, x and y
    uint32_t run_count;
    size_t capacity;
    alpi_run *runs; // [run_count] those first that are most likely to hit something
} alpi_shape;

/// The shapes of one item, turned by 0 to 3 quarters; turns that look like another are not there.
typedef struct alpi_shapes {
    alp_context *context;
    alpi_shape turned[4];
    bool differs[4];
    uint64_t texels;  // covered
    uint64_t *bits;   // scratch
    alpi_run *sorted; // scratch
    size_t bit_capacity, sorted_capacity;
} alpi_shapes;
alp_result alpi_shapes_make(alpi_shapes *shapes, const alpi_pack_item *item);
void alpi_shapes_destroy(alpi_shapes *shapes);

/// A page: which texels nothing else may cover.
typedef struct alpi_pack_page {
    uint32_t size, words;   // texels and words of a row
    uint64_t *blocked;      // [size][words] bits after the page's last column are set
    uint16_t *gaps;         // [size] the longest stretch of a row that is free
    uint64_t free_texels;   // not blocked
    uint64_t *open, *moved; // [words] scratch
} alpi_pack_page;
alp_result alpi_pack_page_create(alp_context *context, uint32_t size, alpi_pack_page *page);
void alpi_pack_page_destroy(alp_context *context, alpi_pack_page *page);

/// Whether the shape has room with its first row at `y`, and then the least x for it.
bool alpi_pack_page_find(const alpi_pack_page *page, const alpi_shape *shape, uint32_t y,
                         uint32_t *x);
/// Blocks what no other chart may cover once the shape is at (x, y).
void alpi_pack_page_take(alpi_pack_page *page, const alpi_shape *shape, uint32_t x, uint32_t y,
                         const alpi_pack_rules *rules);

// --- other orders --------------------------------------------------------------------------------

enum { ALPI_PACK_VARIANTS = 8 }; // of a round; not by workers: the same for any number of them

/// A packing of one page in an order of its own.
typedef struct alpi_pack_variant {
    uint32_t *order;       // [count] items, in turn
    alpi_pack_item *items; // [count]
    bool *left;            // [count] by item: found no room
    uint64_t left_texels;  // of those
    uint64_t most_left;    // more than these, and the packing is given up
    bool by_middle;        // to where the middle comes lowest, not the upper side
} alpi_pack_variant;

typedef struct alpi_pack_search {
    alp_context *context;
    const alpi_pack_rules *rules;
    const alpi_pack_item *items;
    uint32_t count, round;
    bool first;                                         // of this density
    alpi_pack_variant variants[ALPI_PACK_VARIANTS + 1]; // the last is the best known
} alpi_pack_search;

/// The order in which items are packed without a search: the largest boxes first.
alp_result alpi_pack_order(alp_context *context, const alpi_pack_item *items, uint32_t count,
                           uint32_t *order);
/// Packs one page in the variant's order, and marks what finds no room; ends early where that is
/// more than most_left.
alp_result alpi_pack_in_order(alp_context *context, const alpi_pack_rules *rules,
                              alpi_pack_variant *variant, uint32_t count);
/// On failure the caller destroys what was made.
alp_result alpi_pack_search_create(alp_context *context, const alpi_pack_rules *rules,
                                   const alpi_pack_item *items, uint32_t count,
                                   alpi_pack_search *search);
void alpi_pack_search_destroy(alpi_pack_search *search);
/// Tries changes of the best order known, on all workers.
/// @param first the items are of another density than in the round before
/// @param items in: none larger than a page; out, where they fit: their places
alp_result alpi_pack_search_round(alpi_pack_search *search, alpi_pack_item *items, bool first,
                                  bool *fits);

#endif
