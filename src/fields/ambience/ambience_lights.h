// SPDX-License-Identifier: MIT
// Pools of light: coefficients, and with visibility distances. Anchors that have light hold a slot
// of one pool, those whose light is being replaced hold a second slot of another pool.
#ifndef ALPI_FIELDS_AMBIENCE_LIGHTS_H
#define ALPI_FIELDS_AMBIENCE_LIGHTS_H

#include "base/context.h"

enum { ALPI_AMBIENCE_FLOATS = 27 /* nine coefficients of three channels */ };
enum { ALPI_AMBIENCE_MOMENTS = 64 };
#define ALPI_NO_SLOT UINT32_MAX

typedef struct alpi_light_pool {
    alp_context *context;
    bool visibility;
    float (*light)[ALPI_AMBIENCE_FLOATS];
    float (
        *moments)[ALPI_AMBIENCE_MOMENTS][2]; // NULL without visibility: mean distance, of squares
    size_t capacity, moment_capacity;
    uint32_t end, free, count; // free: first of a list; count: in use
} alpi_light_pool;

void alpi_lights_open(alp_context *context, bool visibility, alpi_light_pool *pool);
void alpi_lights_close(alpi_light_pool *pool);
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_lights_take(alpi_light_pool *pool, uint32_t *slot);
void alpi_lights_give(alpi_light_pool *pool, uint32_t *slot); ///< sets it to NO_SLOT
/// Copies light and distances from a slot of another pool.
void alpi_lights_copy(alpi_light_pool *to, uint32_t slot, const alpi_light_pool *from,
                      uint32_t other);
/// Moves a slot towards that of another pool by a share of the difference, in [0, 1].
void alpi_lights_blend(alpi_light_pool *to, uint32_t slot, const alpi_light_pool *from,
                       uint32_t other, float share);

/// As alpi_grow, by an eighth at a time: memory of anchors is counted by its users.
alp_result alpi_grow_tightly(alp_context *context, void **items, size_t *capacity, size_t needed,
                             size_t size);
/// The same, and shrinks arrays of which over a third is not needed.
alp_result alpi_fit(alp_context *context, void **items, size_t *capacity, size_t needed,
                    size_t size);

/// Moves slots so that the first `count` are in use, and gives memory back.
/// @param slots [count] of the anchors that hold one; changed
alp_result alpi_lights_compact(alpi_light_pool *pool, uint32_t **slots, uint32_t count);

#endif
