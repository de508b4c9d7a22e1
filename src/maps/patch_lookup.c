// SPDX-License-Identifier: MIT
// Where rays look up the light of patches: from a point of a triangle to the pixel of its page, and
// from there to the texel whose light is seen.
#include "maps/patch_lookup.h"

#include "base/memory.h"
#include "base/tasks.h"

// --- places --------------------------------------------------------------------------------------

static alpi_patch_place *place_of(const alpi_patches *p, uint32_t texel)
{
    const uint16_t *pixel = p->texels->pixels[texel];
    return &p->places[alpi_lattice_pixel(p->lattice, p->texels->pages[texel], pixel[0], pixel[1])];
}

/// Whether a texel is of a chart and shows itself.
static bool has_own_light(const alpi_patches *p, uint32_t texel, uint32_t chart)
{
    const alpi_patch_place *place = place_of(p, texel);
    return place->chart == chart && place->texel == texel;
}

/// The nearest texel of a chart, with light of its own, about a pixel: in rings of up to `rings`.
static uint32_t find_near(const alpi_patches *p, uint32_t page, int64_t x, int64_t y,
                          uint32_t chart, int rings)
{
    uint32_t best = ALPI_NONE;
    int best_distance = INT32_MAX;
    for (int dy = -rings; dy <= rings; dy++) {
        for (int dx = -rings; dx <= rings; dx++) {
            const uint32_t t = alpi_lattice_texel(p->lattice, page, x + dx, y + dy);
            const int distance = dx * dx + dy * dy;
            if (t != ALPI_NONE && distance < best_distance && has_own_light(p, t, chart)) {
                best = t;
                best_distance = distance;
            }
        }
    }
    return best;
}

/// A texel of each chart, and what is found at each pixel: its texel, or the nearest with light of
/// its own.
static void find_places(alpi_patches *p)
{
    enum { RINGS = 3 };
    const alpi_texels *texels = p->texels;
    for (uint32_t t = 0; t < texels->count; t++) {
        const uint32_t chart = texels->charts[t];
        const bool lit = p->blocks[t] != ALPI_NONE;
        *place_of(p, t) = (alpi_patch_place){chart, lit ? t : ALPI_NONE};
        if (chart != ALPI_NONE && p->chart_texels[chart] == ALPI_NONE && lit) {
            p->chart_texels[chart] = t;
        }
    }
    for (uint32_t t = 0; t < texels->count; t++) {
        const uint16_t *pixel = texels->pixels[t];
        const uint32_t chart = texels->charts[t];
        alpi_patch_place *place = place_of(p, t);
        if (p->blocks[t] == ALPI_NONE) {
            place->texel = find_near(p, texels->pages[t], pixel[0], pixel[1], chart, RINGS);
        }
        if (place->texel == ALPI_NONE && chart != ALPI_NONE) {
            place->texel = p->chart_texels[chart];
        }
    }
}

static alp_result find_triangles(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const alpi_patches *p = user;
    const float size[2] = {(float)p->lattice->width, (float)p->lattice->height};
    for (uint32_t i = begin; i < end; i++) {
        const float(*uv)[2] = (const float(*)[2])p->atlas->corner_uvs[i];
        alpi_patch_triangle *t = &p->triangles[i];
        t->chart = p->atlas->triangle_charts[i];
        t->page = t->chart != ALPI_NONE ? p->atlas->triangle_pages[i] : ALPI_NONE;
        for (int k = 0; k < 2; k++) {
            t->at[k] = uv[0][k] * size[k];
            t->along[k] = (uv[1][k] - uv[0][k]) * size[k];
            t->across[k] = (uv[2][k] - uv[0][k]) * size[k];
        }
    }
    return ALP_OK;
}

alp_result alpi_patch_places_create(alpi_patches *patches)
{
    enum { TRIANGLES_PER_RANGE = 4096 };
    const alpi_task_progress told = {.stage = "light"};
    const uint32_t triangles = patches->scene->triangle_count; // faces begin with those
    ALPI_TRY_NEW(patches->context, patches->triangles, triangles);
    find_places(patches);
    return alpi_parallel_for(patches->context, triangles, TRIANGLES_PER_RANGE, find_triangles,
                             patches, &told);
}

// --- look-ups ------------------------------------------------------------------------------------

/// The pixel of a point of a triangle, which may be off the page.
static inline void find_pixel(const alpi_patch_triangle *t, float b1, float b2, int32_t at[2])
{
    for (int k = 0; k < 2; k++) {
        at[k] = (int32_t)(t->at[k] + b1 * t->along[k] + b2 * t->across[k]);
    }
}

/// NULL: off the page, or on none.
static inline const alpi_patch_place *place_at(const alpi_patches *p, const alpi_patch_triangle *t,
                                               float b1, float b2)
{
    const alpi_lattice *l = p->lattice;
    int32_t at[2];
    find_pixel(t, b1, b2, at);
    const uint32_t x = (uint32_t)at[0], y = (uint32_t)at[1]; // below 0: large
    const bool on = t->page != ALPI_NONE && x < l->width && y < l->height;
    return on ? &p->places[alpi_lattice_pixel(l, t->page, x, y)] : NULL;
}

/// The place of a point whose pixel is off its chart: a corner of the texel at it may still be on.
static uint32_t find_beside(const alpi_patches *p, const alpi_patch_triangle *t, float b1, float b2)
{
    int32_t at[2];
    find_pixel(t, b1, b2, at);
    const uint32_t near = find_near(p, t->page, at[0], at[1], t->chart, 1);
    return near != ALPI_NONE ? near : p->chart_texels[t->chart];
}

uint32_t alpi_patches_find(const alpi_patches *patches, uint32_t triangle, float b1, float b2)
{
    const alpi_patch_triangle *t = &patches->triangles[triangle];
    if (t->page == ALPI_NONE) {
        return ALPI_NONE;
    }
    const alpi_patch_place *place = place_at(patches, t, b1, b2);
    return place != NULL && place->chart == t->chart ? place->texel
                                                     : find_beside(patches, t, b1, b2);
}

/// The cell of a side of a texel.
static inline uint32_t cell_of(const alpi_patches *p, uint32_t texel, bool behind)
{
    if (texel == ALPI_NONE) {
        return ALPI_CELL_BLACK;
    }
    if (!behind) {
        return alpi_patches_cell(p, texel, ALPI_FRONT);
    }
    if (!p->two_sided) {
        return ALPI_CELL_BLACK;
    }
    uint8_t *seen = &p->seen_backs[p->blocks[texel]];
    if (__atomic_load_n(seen, __ATOMIC_RELAXED) == ALPI_BACK_UNSEEN) {
        __atomic_store_n(seen, ALPI_BACK_SEEN, __ATOMIC_RELAXED);
    }
    return alpi_patches_cell(p, texel, ALPI_BACK);
}

static void look_up(const void *user, const alpi_surface_point *points, uint32_t count,
                    vec3 *radiance)
{
    const alpi_patches *p = user;
    for (uint32_t i = 0; i < count; i++) {
        const alpi_surface_point *s = &points[i];
        const uint32_t texel = alpi_patches_find(p, s->triangle, s->b1, s->b2);
        radiance[i] = vec3_load(p->cells[cell_of(p, texel, s->from_behind)]);
    }
}

/// What the points of a packet find on their way to the cells.
typedef struct packet_places {
    bool together; // eight points of one triangle
    const alpi_patch_place *at[ALPI_PACKET];
} packet_places;

/// Asks for what tells where the points are.
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

/// Eight points of one triangle. @return false: one of them is off its page
static bool find_together(const alpi_patches *p, const alpi_patch_triangle *t,
                          const alpi_hits *hits, const alpi_patch_place *places[ALPI_PACKET])
{
    const uint32_t width = p->lattice->width, height = p->lattice->height;
    uint32_t place[ALPI_PACKET], off = 0;
    for (int i = 0; i < ALPI_PACKET; i++) {
        int32_t at[2];
        find_pixel(t, hits->b1[i], hits->b2[i], at);
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
        places->at[i] = place_at(p, t, hits->b1[i], hits->b2[i]);
        if (places->at[i] != NULL) {
            __builtin_prefetch(places->at[i]);
        }
    }
}

/// Cells of eight fronts of one triangle. @return false: one of them is not that simple
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
            texel = find_beside(p, t, hits->b1[i], hits->b2[i]);
        }
        cells[i] = cell_of(p, texel, (hits->behind >> i & 1u) != 0);
        __builtin_prefetch(p->cells[cells[i]]);
    }
}

static void find_cells(const void *user, const alpi_hits *hits, const uint32_t *met, uint32_t count,
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

alpi_surface_light alpi_patches_light(const alpi_patches *patches)
{
    return (alpi_surface_light){.reflected = look_up,
                                .user = patches,
                                .find = find_cells,
                                .cells = (const float(*)[4])patches->cells};
}
