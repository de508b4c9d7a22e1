// SPDX-License-Identifier: MIT
// Cells of packets of rays, included once for each instruction set. Memory latency dominates: each
// step prefetches what the next one reads, first triangles, then places, then cells.
#include "maps/radiosity/patch_lookup.h"

/// Places of the points of a packet.
typedef struct packet_places {
    bool together; // all eight points lie on one triangle
    const alpi_patch_place *at[ALPI_PACKET];
} packet_places;

/// Prefetches the triangles of a packet.
static void fetch_triangles(const alpi_patches *p, const alpi_hits *hits, uint32_t met,
                            packet_places *places)
{
    const uint32_t first = hits->triangle[0];
    uint32_t apart = met ^ ((1u << ALPI_PACKET) - 1u);
    for (int i = 1; i < ALPI_PACKET; i++) {
        apart |= hits->triangle[i] ^ first;
    }
    places->together = apart == 0;
    for (uint32_t left = places->together ? 1 : met; left != 0; left &= left - 1) {
        __builtin_prefetch(&p->triangles[hits->triangle[__builtin_ctz(left)]]);
    }
}

/// Places of eight points of one triangle. @return false: one of them is off its page
static bool find_together(const alpi_patches *p, const alpi_patch_triangle *t,
                          const alpi_hits *hits, const alpi_patch_place *places[ALPI_PACKET])
{
    const uint32_t width = p->lattice->width, height = p->lattice->height;
    uint32_t place[ALPI_PACKET], off = 0;
    for (int i = 0; i < ALPI_PACKET; i++) {
        int32_t at[2];
        alpi_patches_pixel(t, hits->b1[i], hits->b2[i], at);
        off |= (uint32_t)at[0] >= width || (uint32_t)at[1] >= height ? 1u : 0u;
        place[i] = (uint32_t)at[1] * width + (uint32_t)at[0];
    }
    if (t->page == ALPI_NONE || off != 0) {
        return false;
    }
    const alpi_patch_place *page = p->places + (size_t)t->page * width * height;
    for (int i = 0; i < ALPI_PACKET; i++) {
        places[i] = page + place[i];
        __builtin_prefetch(places[i]);
    }
    return true;
}

static void find_packet_places(const alpi_patches *p, const alpi_hits *hits, uint32_t met,
                               packet_places *places)
{
    places->together =
        places->together && find_together(p, &p->triangles[hits->triangle[0]], hits, places->at);
    for (; met != 0 && !places->together; met &= met - 1) {
        const int i = __builtin_ctz(met);
        const alpi_patch_triangle *t = &p->triangles[hits->triangle[i]];
        places->at[i] = alpi_patches_place_at(p, t, hits->b1[i], hits->b2[i]);
        if (places->at[i] != NULL) {
            __builtin_prefetch(places->at[i]);
        }
    }
}

/// Cells of eight fronts of one triangle. @return false: a point needs the general look-up
static bool find_cells_together(const alpi_patches *p, const alpi_hits *hits,
                                const packet_places *places, uint32_t cells[ALPI_PACKET])
{
    const uint32_t chart = p->triangles[hits->triangle[0]].chart;
    uint32_t other = hits->behind;
    for (int i = 0; i < ALPI_PACKET; i++) {
        const alpi_patch_place *place = places->at[i];
        other |= (place->chart ^ chart) | (place->texel == ALPI_NONE ? 1u : 0u);
        cells[i] = alpi_patches_cell(p, place->texel, ALPI_FRONT);
    }
    for (int i = 0; i < ALPI_PACKET && other == 0; i++) {
        __builtin_prefetch(p->cells[cells[i]]);
    }
    return other == 0;
}

static void find_packet_cells(const alpi_patches *p, const alpi_hits *hits, uint32_t met,
                              const packet_places *places, uint32_t cells[ALPI_PACKET])
{
    const bool found = places->together && find_cells_together(p, hits, places, cells);
    for (; met != 0 && !found; met &= met - 1) {
        const int i = __builtin_ctz(met);
        const alpi_patch_triangle *t = &p->triangles[hits->triangle[i]];
        const alpi_patch_place *place = places->at[i];
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
        fetch_triangles(p, &hits[k], met[k], &places[k]);
    }
    for (uint32_t k = 0; k < count; k++) {
        find_packet_places(p, &hits[k], met[k], &places[k]);
    }
    for (uint32_t k = 0; k < count; k++) {
        find_packet_cells(p, &hits[k], met[k], &places[k], cells[k]);
    }
}
