// SPDX-License-Identifier: MIT
// Sample points on texels and patches: how both become receivers.
#include "maps/radiosity/patch_create.h"

#include <math.h>
#include <string.h>

/// Moves points to the other side.
static void turn_over(uint32_t count, alpi_receiver_point *points)
{
    for (uint32_t i = 0; i < count; i++) {
        points[i].geometric_normal = vec3_scale(points[i].geometric_normal, -1.0f);
        points[i].shading_normal = vec3_scale(points[i].shading_normal, -1.0f);
    }
}

static void place_in_texel(const void *user, uint32_t receiver, uint32_t count,
                           const float (*square)[2], alpi_receiver_point *points)
{
    const alpi_patches *p = user;
    const alpi_receivers texels = alpi_texels_receivers(p->texels);
    const bool back = receiver >= texels.count;
    texels.place(texels.user, back ? receiver - texels.count : receiver, count, square, points);
    if (back) {
        turn_over(count, points);
    }
}

alpi_receivers alpi_patches_texel_receivers(const alpi_patches *patches)
{
    return (alpi_receivers){.count = patches->texels->count * (patches->two_sided ? 2u : 1u),
                            .extended = true,
                            .place = place_in_texel,
                            .user = patches};
}

/// The texel of a patch that holds the share u of its area.
static uint32_t find_member(const alpi_patches *p, uint32_t patch, float u)
{
    uint32_t low = p->patch_first[patch], high = p->patch_first[patch + 1] - 1;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (u < p->patch_ends[middle]) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return low;
}

enum { PLACE_BATCH = 64 };

/// Places points in a patch. The points of each texel form a list, and are placed together.
static void place_batch(const alpi_patches *p, uint32_t patch, uint32_t count,
                        const float (*square)[2], alpi_receiver_point *points)
{
    enum { NONE = UINT8_MAX };
    _Static_assert((int)PLACE_BATCH <= (int)NONE, "points are numbers below it");
    const alpi_receivers texels = alpi_texels_receivers(p->texels);
    const uint32_t first = p->patch_first[patch], members = p->patch_first[patch + 1] - first;
    if (members == 1) {
        texels.place(texels.user, p->patch_texels[first], count, square, points);
        return;
    }
    uint8_t heads[ALPI_PATCH_TEXEL_LIMIT], next[PLACE_BATCH] = {0}, lanes[PLACE_BATCH];
    float inside[PLACE_BATCH][2];
    alpi_receiver_point placed[PLACE_BATCH];
    memset(heads, NONE, members);
    for (uint32_t i = count; i-- > 0;) {
        uint8_t *head = &heads[find_member(p, patch, square[i][0]) - first];
        next[i] = *head;
        *head = (uint8_t)i;
    }
    for (uint32_t m = 0; m < members; m++) {
        const float begin = m == 0 ? 0.0f : p->patch_ends[first + m - 1];
        const float width = p->patch_ends[first + m] - begin;
        uint32_t together = 0;
        for (uint8_t i = heads[m]; i != NONE; i = next[i]) {
            const float u = width > 0.0f ? (square[i][0] - begin) / width : 0.0f;
            inside[together][0] = fminf(fmaxf(u, 0.0f), 1.0f - 0x1p-24f);
            inside[together][1] = square[i][1];
            lanes[together++] = i;
        }
        if (together > 0) {
            texels.place(texels.user, p->patch_texels[first + m], together,
                         (const float(*)[2])inside, placed);
        }
        for (uint32_t k = 0; k < together; k++) {
            points[lanes[k]] = placed[k];
        }
    }
}

static void place_in_patch(const void *user, uint32_t receiver, uint32_t count,
                           const float (*square)[2], alpi_receiver_point *points)
{
    const alpi_patches *p = user;
    const bool back = receiver >= p->patch_count;
    const uint32_t patch = back ? receiver - p->patch_count : receiver;
    for (uint32_t i = 0; i < count; i += PLACE_BATCH) {
        place_batch(p, patch, count - i < PLACE_BATCH ? count - i : PLACE_BATCH, square + i,
                    points + i);
    }
    if (back) {
        turn_over(count, points);
    }
}

alpi_receivers alpi_patches_receivers(const alpi_patches *patches)
{
    return (alpi_receivers){.count = patches->patch_count * (patches->two_sided ? 2u : 1u),
                            .extended = true,
                            .place = place_in_patch,
                            .user = patches};
}
