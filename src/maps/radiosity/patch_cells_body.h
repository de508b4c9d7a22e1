// SPDX-License-Identifier: MIT
// Cells of packets of rays, included once for each instruction set. Memory latency dominates: each
// step prefetches what the next one reads, first triangles, then places, then cells.
#include "maps/radiosity/patch_lookup.h"

/// Places of the points of a packet; NULL: off the page.
typedef const alpi_patch_place *packet_places[ALPI_PACKET];

/// Prefetches the triangles of a packet.
static void fetch_triangles(const alpi_patches *p, const alpi_hits *hits, uint32_t met)
{
    for (; met != 0; met &= met - 1) {
        __builtin_prefetch(&p->triangles[hits->triangle[__builtin_ctz(met)]]);
    }
}

static void find_packet_places(const alpi_patches *p, const alpi_hits *hits, uint32_t met,
                               packet_places places)
{
    for (; met != 0; met &= met - 1) {
        const int i = __builtin_ctz(met);
        const alpi_patch_triangle *t = &p->triangles[hits->triangle[i]];
        places[i] = alpi_patches_place_at(p, t, hits->b1[i], hits->b2[i]);
        if (places[i] != NULL) {
            __builtin_prefetch(places[i]);
        }
    }
}

static void find_packet_cells(const alpi_patches *p, const alpi_hits *hits, uint32_t met,
                              const packet_places places, uint32_t cells[ALPI_PACKET])
{
    for (; met != 0; met &= met - 1) {
        const int i = __builtin_ctz(met);
        const alpi_patch_triangle *t = &p->triangles[hits->triangle[i]];
        const alpi_patch_place *place = places[i];
        uint32_t texel = ALPI_NONE;
        if (place != NULL && place->chart == t->chart) {
            texel = place->texel;
        } else if (t->page != ALPI_NONE) {
            texel = alpi_patches_find_nearest(p, t, hits->b1[i], hits->b2[i]);
        }
        cells[i] = alpi_patches_side_cell(p, texel, (hits->behind >> i & 1u) != 0);
        __builtin_prefetch(p->cells[cells[i]]);
    }
}

void ALPI_VARIANT(alpi_patches_find_cells)(const void *user, const alpi_hits *hits,
                                           const uint32_t *met, uint32_t count,
                                           uint32_t (*cells)[ALPI_PACKET])
{
    const alpi_patches *p = user;
    packet_places places[ALPI_LIGHT_BATCH];
    for (uint32_t k = 0; k < count; k++) {
        fetch_triangles(p, &hits[k], met[k]);
    }
    for (uint32_t k = 0; k < count; k++) {
        find_packet_places(p, &hits[k], met[k], places[k]);
    }
    for (uint32_t k = 0; k < count; k++) {
        find_packet_cells(p, &hits[k], met[k], places[k], cells[k]);
    }
}
