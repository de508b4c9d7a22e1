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

void alpi_lights_blend(alpi_light_pool *to, uint32_t slot, const alpi_light_pool *from,
                       uint32_t other, float share)
{
    for (int i = 0; i < ALPI_AMBIENCE_FLOATS; i++) {
        float *light = &to->light[slot][i];
        *light += share * (from->light[other][i] - *light);
    }
    for (int i = 0; i < 2 * ALPI_AMBIENCE_MOMENTS && to->visibility; i++) {
        float *distance = &to->moments[slot][i / 2][i % 2];
        *distance += share * (from->moments[other][i / 2][i % 2] - *distance);
    }
}
