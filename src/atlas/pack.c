// SPDX-License-Identifier: MIT
// Packing of shapes: each goes, turned by quarters, to the place where its upper side ends lowest,
// on the first page that has one; the largest go first, and the small into what they leave.
// Based on: E. K. Burke, R. S. R. Hellier, G. Kendall, G. Whitwell. A New Bottom-Left-Fill
// Heuristic Algorithm for the Two-Dimensional Irregular Packing Problem. Operations Research 54(3),
// 2006; B. Lévy, S. Petitjean, N. Ray, J. Maillot. Least Squares Conformal Maps for Automatic
// Texture Atlas Generation. SIGGRAPH, 2002 (the shapes as texels). Places are sought in bits, all
// columns of a row at a time.
#include "atlas/pack.h"

#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

enum {
    EXACT_SIDES = 16, // sides up to this are classes of their own; longer ones by quarter octaves
    CLASSES = EXACT_SIDES + 4 * 11,
    PATIENCE = 1 << 22 // words of rows looked at, after which large ones have hints as well
};

/// Where the last item of about this size went: those after it look no lower, the tiny from the
/// start and all others once so many rows were looked at that there must be very many of them.
/// What they leave open below goes to smaller ones.
typedef struct hint {
    uint32_t page, y;
} hint;

typedef struct packer {
    alp_context *context;
    const alpi_pack_rules *rules;
    uint32_t page_limit;
    alpi_pack_page *pages;
    size_t page_capacity;
    uint32_t page_count;
    bool quiet;          // no message when the pages are full
    bool by_middle;      // see alpi_pack_variant
    uint64_t rows_tried; // times a row was looked at for room
    alpi_shapes shapes;
    hint hints[CLASSES][CLASSES];
} packer;

typedef struct place {
    uint32_t x, y, top, turns;
    bool found;
} place;

typedef struct order_entry {
    uint64_t area; // of the box: a slender or hollow shape takes much room with it
    uint32_t longer, item;
} order_entry;

uint64_t alpi_pack_texels(const alpi_pack_item *item)
{
    const size_t words = (size_t)((item->width + 63) / 64) * item->height;
    uint64_t texels = item->mask == NULL ? (uint64_t)item->width * item->height : 0;
    for (size_t i = 0; item->mask != NULL && i < words; i++) {
        texels += (uint64_t)__builtin_popcountll(item->mask[i]);
    }
    return texels;
}

static int compare_entries(const void *a, const void *b)
{
    const order_entry *p = a, *q = b;
    if (p->area != q->area) {
        return p->area > q->area ? -1 : 1;
    }
    if (p->longer != q->longer) {
        return p->longer > q->longer ? -1 : 1;
    }
    return p->item < q->item ? -1 : 1;
}

static uint32_t class_of_side(uint32_t side)
{
    if (side < EXACT_SIDES) {
        return side;
    }
    const uint32_t octave = 31u - (uint32_t)__builtin_clz(side);
    return EXACT_SIDES + 4 * (octave - 4) + (side >> (octave - 2) & 3u);
}

/// How far the middle of what is placed lies up (axis 1) or to the right (0), times its texels.
static uint64_t middle(const packer *p, const place *at, int axis)
{
    const uint64_t corner = axis == 0 ? at->x : at->y;
    return 2 * corner * p->shapes.texels + p->shapes.turned[at->turns].moment[axis];
}

/// Whether the upper side (or the middle) lies lower, or as low and the middle further left: what
/// is left free is on the right, where the next goes.
static bool is_better(const packer *p, const place *a, const place *b)
{
    const uint64_t low = p->by_middle ? middle(p, a, 1) : a->top;
    const uint64_t other = p->by_middle ? middle(p, b, 1) : b->top;
    return low < other || (low == other && middle(p, a, 0) < middle(p, b, 0));
}

/// The place whose upper side ends lowest, of equal ones the leftmost middle, from row `from` on.
static place find_place(packer *p, const alpi_pack_page *on, uint32_t from)
{
    place best = {.found = false};
    for (uint32_t turns = 0; turns < 4; turns++) {
        const alpi_shape *shape = &p->shapes.turned[turns];
        if (!p->shapes.differs[turns] || shape->width > on->size || shape->height > on->size) {
            continue;
        }
        const uint32_t end = best.found && !p->by_middle ? best.top : on->size;
        for (uint32_t y = from, x; y + shape->height <= end; y++) {
            p->rows_tried++;
            if (alpi_pack_page_find(on, shape, y, &x)) {
                const place at = {x, y, y + shape->height, turns, true};
                best = !best.found || is_better(p, &at, &best) ? at : best;
                break;
            }
        }
    }
    return best;
}

static alp_result add_page(packer *p)
{
    if (p->page_count == p->page_limit && p->quiet) {
        return ALP_ERROR_LIMIT;
    }
    if (p->page_count == p->page_limit) {
        return alpi_fail(p->context, ALP_ERROR_LIMIT,
                         "the charts need more than %u page%s of %u texels; use fewer texels per "
                         "metre, a larger size or less padding",
                         p->page_limit, p->page_limit == 1 ? "" : "s", p->rules->size);
    }
    ALP_TRY(alpi_grow(p->context, (void **)&p->pages, &p->page_capacity, (size_t)p->page_count + 1,
                      sizeof *p->pages));
    return alpi_pack_page_create(p->context, p->rules->size, &p->pages[p->page_count++]);
}

static alp_result place_item(packer *p, alpi_pack_item *item)
{
    ALP_TRY(alpi_shapes_make(&p->shapes, item));
    const uint32_t longer = item->width > item->height ? item->width : item->height;
    const uint32_t shorter = item->width > item->height ? item->height : item->width;
    hint *near = &p->hints[class_of_side(longer)][class_of_side(shorter)];
    place at = {.found = false};
    const uint32_t words = (p->rules->size + 63) / 64;
    const bool all = longer >= EXACT_SIDES && p->rows_tried * words <= PATIENCE;
    for (uint32_t i = all ? 0 : near->page; !at.found; i++) {
        if (i == p->page_count) {
            ALP_TRY(add_page(p));
        }
        alpi_pack_page *on = &p->pages[i];
        if (on->free_texels < p->shapes.texels) {
            continue;
        }
        const bool tired = p->rows_tried * on->words > PATIENCE;
        at = find_place(p, on, i == near->page && (longer < EXACT_SIDES || tired) ? near->y : 0);
        if (at.found) {
            alpi_pack_page_take(on, &p->shapes.turned[at.turns], at.x, at.y, p->rules);
            const uint32_t slack = tired ? longer / 4 : longer;
            *near = (hint){i, at.y > slack ? at.y - slack : 0};
            item->page = i;
        }
    }
    item->x = at.x;
    item->y = at.y;
    item->turns = at.turns;
    return ALP_OK;
}

alp_result alpi_pack_order(alp_context *context, const alpi_pack_item *items, uint32_t count,
                           uint32_t *order)
{
    order_entry *entries = ALPI_NEW(context, order_entry, count);
    if (entries == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t w = items[i].width, h = items[i].height;
        entries[i] = (order_entry){(uint64_t)w * h, w > h ? w : h, i};
    }
    qsort(entries, count, sizeof *entries, compare_entries);
    for (uint32_t i = 0; i < count; i++) {
        order[i] = entries[i].item;
    }
    alpi_release(context, entries);
    return ALP_OK;
}

static alp_result check_items(const packer *p, const alpi_pack_item *items, uint32_t count)
{
    const uint32_t size = p->rules->size;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t w = items[i].width, h = items[i].height;
        if (w == 0 || h == 0 || w > size || h > size) {
            return alpi_fail(p->context, ALP_ERROR_LIMIT,
                             "a chart of %u x %u texels does not fit a page of %u texels", w, h,
                             size);
        }
    }
    return ALP_OK;
}

static alp_result place_all(packer *p, alpi_pack_item *items, uint32_t count, uint32_t *order)
{
    ALP_TRY(check_items(p, items, count));
    ALP_TRY(alpi_pack_order(p->context, items, count, order));
    for (uint32_t i = 0; i < count; i++) {
        ALP_TRY(place_item(p, &items[order[i]]));
    }
    return ALP_OK;
}

static void packer_destroy(packer *p)
{
    for (uint32_t i = 0; i < p->page_count; i++) {
        alpi_pack_page_destroy(p->context, &p->pages[i]);
    }
    alpi_release(p->context, p->pages);
    alpi_shapes_destroy(&p->shapes);
}

static alp_result pack(packer *p, alpi_pack_item *items, uint32_t count)
{
    p->shapes.context = p->context;
    uint32_t *order = ALPI_NEW(p->context, uint32_t, count);
    alp_result result = order == NULL ? ALP_ERROR_OUT_OF_MEMORY : place_all(p, items, count, order);
    alpi_release(p->context, order);
    if (p->rules->rows_tried != NULL) {
        *p->rules->rows_tried += p->rows_tried;
    }
    packer_destroy(p);
    return result;
}

alp_result alpi_pack_in_order(alp_context *context, const alpi_pack_rules *rules,
                              alpi_pack_variant *variant, uint32_t count)
{
    packer p = {.context = context,
                .rules = rules,
                .page_limit = 1,
                .quiet = true,
                .by_middle = variant->by_middle,
                .shapes.context = context};
    alp_result result = ALP_OK;
    for (uint32_t i = 0;
         i < count && result == ALP_OK && variant->left_texels <= variant->most_left; i++) {
        const uint32_t item = variant->order[i];
        result = place_item(&p, &variant->items[item]);
        if (result == ALP_ERROR_LIMIT) {
            variant->left[item] = true;
            variant->left_texels += p.shapes.texels;
            result = ALP_OK;
        }
    }
    packer_destroy(&p);
    return result;
}

alp_result alpi_pack(alp_context *context, const alpi_pack_rules *rules, alpi_pack_item *items,
                     uint32_t count, uint32_t page_limit, uint32_t *page_count)
{
    packer p = {.context = context,
                .rules = rules,
                .page_limit = page_limit,
                .by_middle = rules->by_middle};
    alp_result result = pack(&p, items, count);
    *page_count = p.page_count;
    return result;
}

alp_result alpi_pack_one_page(alp_context *context, const alpi_pack_rules *rules,
                              alpi_pack_item *items, uint32_t count, bool *fits)
{
    packer p = {.context = context, .rules = rules, .page_limit = 1, .quiet = true};
    uint64_t room = (uint64_t)rules->size * rules->size;
    *fits = false;
    for (uint32_t i = 0; i < count; i++) {
        const uint64_t texels = alpi_pack_texels(&items[i]);
        if (items[i].width > rules->size || items[i].height > rules->size || texels > room) {
            return ALP_OK;
        }
        room -= texels;
    }
    alp_result result = pack(&p, items, count);
    *fits = result == ALP_OK;
    return result == ALP_ERROR_LIMIT ? ALP_OK : result;
}

// --- groups --------------------------------------------------------------------------------------

/// Items of one group, largest box first.
typedef struct pack_group {
    uint64_t texels;              // covered
    uint32_t first, count, least; // in the order; its first item of all
} pack_group;

typedef struct group_packer {
    packer pack;
    alpi_pack_item *items;
    uint32_t *order;              // [items] grouped
    pack_group *groups;           // [group_count] in turn
    hint hints[CLASSES][CLASSES]; // of groups, by their largest item: pages that have no room for
                                  // one may have room for an item
    uint64_t *blocked;            // [size][words] a page as it was
    uint16_t *gaps;               // [size]
} group_packer;

static int compare_groups(const void *a, const void *b)
{
    const pack_group *s = a, *t = b;
    if ((s->count == 0) != (t->count == 0)) {
        return s->count == 0 ? 1 : -1;
    }
    if (s->texels != t->texels) {
        return s->texels > t->texels ? -1 : 1;
    }
    return s->least < t->least ? -1 : s->least > t->least;
}

/// Groups in turn, and in each its items in the order of all.
static alp_result order_groups(group_packer *g, const uint32_t *groups, uint32_t count)
{
    alp_context *context = g->pack.context;
    uint32_t *order = ALPI_NEW(context, uint32_t, count);
    uint32_t *filled = ALPI_NEW(context, uint32_t, count);
    alp_result result = order != NULL && filled != NULL
                            ? alpi_pack_order(context, g->items, count, order)
                            : ALP_ERROR_OUT_OF_MEMORY;
    for (uint32_t i = 0; result == ALP_OK && i < count; i++) {
        pack_group *group = &g->groups[groups[i]];
        group->least = group->count++ == 0 ? i : group->least;
        group->texels += alpi_pack_texels(&g->items[i]);
    }
    for (uint32_t i = 0, first = 0; result == ALP_OK && i < count; i++) {
        g->groups[i].first = filled[i] = first;
        first += g->groups[i].count;
    }
    for (uint32_t i = 0; result == ALP_OK && i < count; i++) {
        g->order[filled[groups[order[i]]]++] = order[i];
    }
    if (result == ALP_OK) {
        qsort(g->groups, count, sizeof *g->groups, compare_groups); // the empty last
    }
    alpi_release(context, order);
    alpi_release(context, filled);
    return result;
}

/// Places a group on one page, or leaves the page as it was.
static alp_result place_together(group_packer *g, const pack_group *group, uint32_t page,
                                 bool *fits)
{
    packer *p = &g->pack;
    alpi_pack_page *on = &p->pages[page];
    const size_t words = (size_t)on->size * on->words;
    const uint64_t free_texels = on->free_texels;
    memcpy(g->blocked, on->blocked, words * sizeof *g->blocked);
    memcpy(g->gaps, on->gaps, on->size * sizeof *g->gaps);
    *fits = true;
    for (uint32_t i = group->first; *fits && i < group->first + group->count; i++) {
        alpi_pack_item *item = &g->items[g->order[i]];
        ALP_TRY(alpi_shapes_make(&p->shapes, item));
        const place at = find_place(p, on, 0);
        *fits = at.found;
        if (at.found) {
            alpi_pack_page_take(on, &p->shapes.turned[at.turns], at.x, at.y, p->rules);
            *item =
                (alpi_pack_item){item->width, item->height, item->mask, at.x, at.y, page, at.turns};
        }
    }
    if (!*fits) {
        memcpy(on->blocked, g->blocked, words * sizeof *g->blocked);
        memcpy(on->gaps, g->gaps, on->size * sizeof *g->gaps);
        on->free_texels = free_texels;
    }
    return ALP_OK;
}

/// Tries the pages that there are, those behind the last group of about this size alone once so
/// many rows were looked at that there must be very many groups, and then a new one.
static alp_result place_on_one_page(group_packer *g, const pack_group *group, bool *fits)
{
    packer *p = &g->pack;
    const alpi_pack_item *first = &g->items[g->order[group->first]];
    const uint32_t longer = first->width > first->height ? first->width : first->height;
    const uint32_t shorter = first->width > first->height ? first->height : first->width;
    hint *near = &g->hints[class_of_side(longer)][class_of_side(shorter)];
    const bool tired = p->rows_tried * ((p->rules->size + 63) / 64) > PATIENCE;
    uint32_t page = tired ? near->page : 0;
    for (; page < p->page_count && !*fits; page++) {
        if (p->pages[page].free_texels >= group->texels) {
            ALP_TRY(place_together(g, group, page, fits));
        }
    }
    const uint64_t room = (uint64_t)p->rules->size * p->rules->size;
    if (!*fits && group->texels <= room && p->page_count < p->page_limit) {
        ALP_TRY(add_page(p));
        ALP_TRY(place_together(g, group, page++, fits));
    }
    if (*fits) {
        *near = (hint){page - 1, 0};
    }
    return ALP_OK;
}

static alp_result place_group(group_packer *g, const pack_group *group)
{
    packer *p = &g->pack;
    bool fits = false;
    if (group->count > 1) {
        ALP_TRY(place_on_one_page(g, group, &fits));
    }
    for (uint32_t i = group->first; !fits && i < group->first + group->count; i++) {
        ALP_TRY(place_item(p, &g->items[g->order[i]]));
    }
    const uint64_t room = (uint64_t)p->rules->size * p->rules->size;
    if (p->page_count > 0 && p->pages[p->page_count - 1].free_texels == room) {
        alpi_pack_page_destroy(p->context, &p->pages[--p->page_count]); // was tried in vain
    }
    return ALP_OK;
}

static alp_result pack_in_groups(group_packer *g, const uint32_t *groups, uint32_t count)
{
    alp_context *context = g->pack.context;
    const uint32_t size = g->pack.rules->size;
    ALP_TRY(check_items(&g->pack, g->items, count));
    ALPI_TRY_NEW(context, g->order, count);
    ALPI_TRY_NEW(context, g->groups, count);
    ALPI_TRY_NEW(context, g->blocked, (size_t)size * ((size + 63) / 64));
    ALPI_TRY_NEW(context, g->gaps, size);
    ALP_TRY(order_groups(g, groups, count));
    for (uint32_t i = 0; i < count && g->groups[i].count > 0; i++) {
        ALP_TRY(place_group(g, &g->groups[i]));
    }
    return ALP_OK;
}

alp_result alpi_pack_groups(alp_context *context, const alpi_pack_rules *rules,
                            alpi_pack_item *items, const uint32_t *groups, uint32_t count,
                            uint32_t page_limit, uint32_t *page_count)
{
    group_packer g = {.pack = {.context = context,
                               .rules = rules,
                               .page_limit = page_limit,
                               .shapes.context = context},
                      .items = items};
    const alp_result result = pack_in_groups(&g, groups, count);
    *page_count = g.pack.page_count;
    packer_destroy(&g.pack);
    alpi_release(context, g.order);
    alpi_release(context, g.groups);
    alpi_release(context, g.blocked);
    alpi_release(context, g.gaps);
    return result;
}
