// SPDX-License-Identifier: MIT
#include "fields/ambience/ambience_lights.h"

#include "base/memory.h"

#include <string.h>

alp_result alpi_grow_tightly(alp_context *context, void **items, size_t *capacity, size_t needed,
                             size_t size)
{
    if (needed <= *capacity) {
        return ALP_OK;
    }
    const size_t larger = needed + needed / 8 + 8;
    void *moved = alpi_reallocate(context, *items, larger, size);
    if (moved == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    *items = moved;
    *capacity = larger;
    return ALP_OK;
}

alp_result alpi_fit(alp_context *context, void **items, size_t *capacity, size_t needed,
                    size_t size)
{
    if (*capacity > needed + needed / 2 + 64) { // shrinking may fail: then all stays
        const size_t smaller = needed + needed / 8 + 8;
        void *moved = alpi_reallocate(context, *items, smaller, size);
        if (moved == NULL) {
            return ALP_OK;
        }
        *items = moved;
        *capacity = smaller;
    }
    return alpi_grow_tightly(context, items, capacity, needed, size);
}

void alpi_lights_open(alp_context *context, bool visibility, alpi_light_pool *pool)
{
    *pool = (alpi_light_pool){.context = context, .visibility = visibility, .free = ALPI_NO_SLOT};
}

void alpi_lights_close(alpi_light_pool *pool)
{
    alpi_release(pool->context, pool->light);
    alpi_release(pool->context, pool->moments);
    *pool = (alpi_light_pool){.free = ALPI_NO_SLOT};
}

alp_result alpi_lights_take(alpi_light_pool *pool, uint32_t *slot)
{
    if (pool->free != ALPI_NO_SLOT) {
        *slot = pool->free;
        memcpy(&pool->free, pool->light[*slot], sizeof pool->free);
    } else {
        const size_t needed = (size_t)pool->end + 1;
        if (pool->visibility) {
            ALP_TRY(alpi_grow_tightly(pool->context, (void **)&pool->moments,
                                      &pool->moment_capacity, needed, sizeof *pool->moments));
        }
        ALP_TRY(alpi_grow_tightly(pool->context, (void **)&pool->light, &pool->capacity, needed,
                                  sizeof *pool->light));
        *slot = pool->end++;
    }
    pool->count++;
    return ALP_OK;
}

void alpi_lights_give(alpi_light_pool *pool, uint32_t *slot)
{
    if (*slot != ALPI_NO_SLOT) {
        memcpy(pool->light[*slot], &pool->free, sizeof pool->free);
        pool->free = *slot;
        pool->count--;
        *slot = ALPI_NO_SLOT;
    }
}

void alpi_lights_copy(alpi_light_pool *to, uint32_t slot, const alpi_light_pool *from,
                      uint32_t other)
{
    memcpy(to->light[slot], from->light[other], sizeof *to->light);
    if (to->visibility) {
        memcpy(to->moments[slot], from->moments[other], sizeof *to->moments);
    }
}

static void blend(float *restrict to, const float *restrict from, int count, float share)
{
    for (int i = 0; i < count; i++) {
        to[i] += share * (from[i] - to[i]);
    }
}

void alpi_lights_blend(alpi_light_pool *to, uint32_t slot, const alpi_light_pool *from,
                       uint32_t other, float share)
{
    blend(to->light[slot], from->light[other], ALPI_AMBIENCE_FLOATS, share);
    if (to->visibility) {
        blend(to->moments[slot][0], from->moments[other][0], 2 * ALPI_AMBIENCE_MOMENTS, share);
    }
}

alp_result alpi_lights_compact(alpi_light_pool *pool, uint32_t **slots, uint32_t count)
{
    bool *taken = ALPI_NEW(pool->context, bool, count);
    if (taken == NULL) {
        return ALP_OK; // all stays
    }
    for (uint32_t i = 0; i < count; i++) {
        if (*slots[i] < count) {
            taken[*slots[i]] = true;
        }
    }
    uint32_t hole = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (*slots[i] < count) {
            continue;
        }
        while (taken[hole]) {
            hole++;
        }
        alpi_lights_copy(pool, hole, pool, *slots[i]);
        *slots[i] = hole++;
    }
    alpi_release(pool->context, taken);
    pool->end = count;
    pool->free = ALPI_NO_SLOT;
    ALP_TRY(alpi_fit(pool->context, (void **)&pool->light, &pool->capacity, count,
                     sizeof *pool->light));
    return pool->visibility ? alpi_fit(pool->context, (void **)&pool->moments,
                                       &pool->moment_capacity, count, sizeof *pool->moments)
                            : ALP_OK;
}
