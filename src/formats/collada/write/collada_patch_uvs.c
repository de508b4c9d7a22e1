// SPDX-License-Identifier: MIT
// The different bake coordinates of a geometry, and which of them each corner has.
#include "formats/collada/write/collada_patch_uvs.h"

#include "base/hash.h"
#include "base/memory.h"

#include <string.h>

alp_result alpi_collada_uvs_create(alp_context *context, uint64_t corner_count,
                                   alpi_collada_uvs *pool)
{
    pool->size = 16;
    while (pool->size < 2 * corner_count) {
        pool->size *= 2;
    }
    ALPI_TRY_NEW(context, pool->uvs, corner_count);
    ALPI_TRY_NEW(context, pool->slots, pool->size);
    memset(pool->slots, 0xff, pool->size * sizeof *pool->slots);
    return ALP_OK;
}

static uint32_t find_uv(alpi_collada_uvs *pool, const float uv[2 * ALPI_COLLADA_SETS])
{
    const size_t size = 2 * ALPI_COLLADA_SETS * sizeof *uv;
    uint64_t hash = alpi_hash_bytes(ALPI_HASH_START, uv, size);
    hash ^= hash >> 32;
    size_t slot = (size_t)hash & (pool->size - 1);
    for (; pool->slots[slot] != ALPI_NONE; slot = (slot + 1) & (pool->size - 1)) {
        const float *other = pool->uvs[pool->slots[slot]];
        bool same = true;
        for (int i = 0; i < 2 * ALPI_COLLADA_SETS; i++) {
            same &= other[i] == uv[i];
        }
        if (same) {
            return pool->slots[slot];
        }
    }
    pool->slots[slot] = pool->count;
    memcpy(pool->uvs[pool->count], uv, size);
    return pool->count++;
}

uint32_t alpi_collada_count_sets(const alpi_collada_patcher *p)
{
    return p->patch->set_uvs != NULL ? ALPI_COLLADA_SETS : 1;
}

/// Coordinates of a corner of the scene's triangle as they are written.
static void read_corner(const alpi_collada_patcher *p, uint32_t triangle, uint32_t corner,
                        float out[2 * ALPI_COLLADA_SETS])
{
    memset(out, 0, 2 * ALPI_COLLADA_SETS * sizeof *out);
    for (uint32_t k = 0; k < alpi_collada_count_sets(p); k++) {
        const float *uv = p->patch->set_uvs != NULL ? p->patch->set_uvs[triangle][k][corner]
                                                    : p->patch->corner_uvs[triangle][corner];
        out[2 * k] = uv[0] + 0.0f;     // no −0
        out[2 * k + 1] = 1.0f - uv[1]; // t counts upwards
    }
}

alp_result alpi_collada_corners_create(const alpi_collada_patcher *p, alpi_collada_uvs *pool,
                                       uint32_t surface, const alpi_collada_faces *faces,
                                       alpi_collada_corners *corners)
{
    const alpi_surface *s = &p->scene->surfaces[surface];
    ALPI_TRY_NEW(p->context, corners->of_triangle, faces->triangle_count);
    ALPI_TRY_NEW(p->context, corners->of_corner, faces->corner_count);
    memset(corners->of_corner, 0xff, faces->corner_count * sizeof *corners->of_corner);
    corners->agreed = true;
    for (int pass = 0; pass < 2; pass++) { // first those with area
        for (uint32_t t = 0; t < faces->triangle_count; t++) {
            const uint32_t scene_triangle = s->first_triangle + t;
            if (p->scene->triangle_usable[scene_triangle] != (pass == 0)) {
                continue;
            }
            for (uint32_t k = 0; k < 3; k++) {
                const uint32_t place = s->mirrored ? (3 - k) % 3 : k;
                float uv[2 * ALPI_COLLADA_SETS];
                read_corner(p, scene_triangle, place, uv);
                uint32_t *of_corner = &corners->of_corner[faces->triangles[t][k]];
                const bool known = pass == 1 && *of_corner != ALPI_NONE;
                const uint32_t index = known ? *of_corner : find_uv(pool, uv);
                corners->agreed &= *of_corner == ALPI_NONE || *of_corner == index;
                *of_corner = index;
                corners->of_triangle[t][k] = index;
            }
        }
    }
    return ALP_OK;
}

void alpi_collada_uvs_destroy(alp_context *context, alpi_collada_uvs *pool)
{
    alpi_release(context, pool->uvs);
    alpi_release(context, pool->slots);
    *pool = (alpi_collada_uvs){0};
}

void alpi_collada_corners_destroy(alp_context *context, alpi_collada_corners *corners)
{
    alpi_release(context, corners->of_triangle);
    alpi_release(context, corners->of_corner);
    *corners = (alpi_collada_corners){0};
}
