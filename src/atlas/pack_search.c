// SPDX-License-Identifier: MIT
// Other orders of packing: where few large shapes must share a page, which goes first decides how
// much is left. Each round tries some changes of the best order known and keeps the best of them:
// what found no room comes earlier, and some others change places.
#include "atlas/pack.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"

#include <string.h>

alp_result alpi_pack_search_create(alp_context *context, const alpi_pack_rules *rules,
                                   const alpi_pack_item *items, uint32_t count,
                                   alpi_pack_search *search)
{
    *search = (alpi_pack_search){.context = context, .rules = rules, .count = count};
    for (uint32_t v = 0; v <= ALPI_PACK_VARIANTS; v++) {
        alpi_pack_variant *made = &search->variants[v];
        ALPI_TRY_NEW(context, made->order, count);
        ALPI_TRY_NEW(context, made->items, count);
        ALPI_TRY_NEW(context, made->left, count);
    }
    return alpi_pack_order(context, items, count, search->variants[ALPI_PACK_VARIANTS].order);
}

void alpi_pack_search_destroy(alpi_pack_search *search)
{
    for (uint32_t v = 0; v <= ALPI_PACK_VARIANTS; v++) {
        alpi_release(search->context, search->variants[v].order);
        alpi_release(search->context, search->variants[v].items);
        alpi_release(search->context, search->variants[v].left);
    }
}

static uint32_t random_below(uint32_t key, uint32_t *step, uint32_t limit)
{
    return (uint32_t)((uint64_t)alpi_hash32(key + 0x9e3779b9u * ++*step) * limit >> 32);
}

static void change_order(const alpi_pack_variant *base, uint32_t count, uint32_t key,
                         uint32_t *order)
{
    uint32_t step = 0;
    memcpy(order, base->order, count * sizeof *order);
    for (uint32_t i = 1; i < count; i++) {
        const uint32_t item = order[i];
        if (base->left[item]) {
            const uint32_t to = random_below(key, &step, i);
            memmove(order + to + 1, order + to, (i - to) * sizeof *order);
            order[to] = item;
        }
    }
    const uint32_t swaps = 1 + random_below(key, &step, 3);
    for (uint32_t k = 0; k < swaps; k++) {
        const uint32_t a = random_below(key, &step, count);
        const uint32_t near = a + 1 + random_below(key, &step, count / 4 + 1);
        const uint32_t b = near < count ? near : count - 1, item = order[a];
        order[a] = order[b];
        order[b] = item;
    }
}

static alp_result try_variants(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    alpi_pack_search *s = user;
    const alpi_pack_variant *base = &s->variants[ALPI_PACK_VARIANTS];
    for (uint32_t v = begin; v < end; v++) {
        alpi_pack_variant *own = &s->variants[v];
        change_order(base, s->count, alpi_random_key(s->round, v, 0), own->order);
        memcpy(own->items, s->items, s->count * sizeof *own->items);
        memset(own->left, 0, s->count * sizeof *own->left);
        own->left_texels = 0;
        own->most_left = s->first ? UINT64_MAX : base->left_texels; // what is worse is not taken
        own->by_middle = v % 2 == 1;
        ALP_TRY(alpi_pack_in_order(s->context, s->rules, own, s->count));
    }
    return ALP_OK;
}

alp_result alpi_pack_search_round(alpi_pack_search *s, alpi_pack_item *items, bool first,
                                  bool *fits)
{
    alpi_pack_variant *base = &s->variants[ALPI_PACK_VARIANTS];
    s->items = items;
    s->first = first;
    ALP_TRY(alpi_parallel_for(s->context, ALPI_PACK_VARIANTS, 1, try_variants, s, NULL));
    uint32_t best = 0;
    for (uint32_t v = 1; v < ALPI_PACK_VARIANTS; v++) {
        best = s->variants[v].left_texels < s->variants[best].left_texels ? v : best;
    }
    s->round++;
    if (first || s->variants[best].left_texels <= base->left_texels) {
        const alpi_pack_variant former = *base;
        *base = s->variants[best];
        s->variants[best] = former;
    }
    *fits = base->left_texels == 0;
    if (*fits) {
        memcpy(items, base->items, s->count * sizeof *items);
    }
    return ALP_OK;
}
