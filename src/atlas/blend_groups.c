// SPDX-License-Identifier: MIT
// Which overlapping charts belong on one page. A material has one map, so a triangle loses a chart
// that lies on another page than that of its strongest axis.
#include "atlas/blend.h"

#include "base/memory.h"

#include <stdlib.h>

// Of a page, covered texels with half of the gaps round them: what nearly always fits. A group that
// does not is packed chart by chart, and loses more than one that was not joined.
static const double SAFE_SHARE = 0.75;

/// Two charts that share triangles.
typedef struct link {
    uint32_t low, high; // low < high
    double weight; // what a separation costs: m², by the share of the weaker axis in the blend
} link;

static int compare_pairs(const void *a, const void *b)
{
    const link *s = a, *t = b;
    if (s->low != t->low) {
        return s->low < t->low ? -1 : 1;
    }
    return s->high < t->high ? -1 : s->high > t->high;
}

static int compare_weights(const void *a, const void *b)
{
    const link *s = a, *t = b;
    return s->weight != t->weight ? (s->weight > t->weight ? -1 : 1) : compare_pairs(a, b);
}

/// One link for each triangle and chart beside that of its strongest axis.
static uint32_t list_shared(const alp_atlas *atlas, const alpi_blend_faces *faces, link *links)
{
    uint32_t count = 0;
    for (uint32_t f = 0; f < faces->count; f++) {
        const alpi_blend_face *face = &faces->faces[f];
        const uint32_t own = atlas->triangle_charts[f];
        const uint32_t strongest = atlas->triangle_charts[face->triangle];
        if (own == strongest || own == ALPI_NONE || strongest == ALPI_NONE) {
            continue;
        }
        vec3 c[3];
        alpi_triangle_corners(atlas->scene, f, c);
        links[count++] = (link){.low = own < strongest ? own : strongest,
                                .high = own < strongest ? strongest : own,
                                .weight = vec3_triangle_area(c[0], c[1], c[2]) *
                                          (double)face->cosine * (double)face->cosine};
    }
    return count;
}

/// Adds up the links of each pair of charts and sorts them, heaviest first.
static uint32_t add_up(link *links, uint32_t count)
{
    uint32_t kept = 0;
    qsort(links, count, sizeof *links, compare_pairs);
    for (uint32_t i = 0; i < count; i++) {
        if (kept > 0 && compare_pairs(&links[kept - 1], &links[i]) == 0) {
            links[kept - 1].weight += links[i].weight;
        } else {
            links[kept++] = links[i];
        }
    }
    qsort(links, kept, sizeof *links, compare_weights);
    return kept;
}

static double room_of(const alpi_pack_item *item, uint32_t padding)
{
    return (double)alpi_pack_texels(item) + padding * ((double)item->width + item->height);
}

static uint32_t root_of(uint32_t *groups, uint32_t chart)
{
    while (groups[chart] != chart) {
        groups[chart] = groups[groups[chart]];
        chart = groups[chart];
    }
    return chart;
}

/// @param rooms [charts] of the groups; of their roots as they grow
static void join(const link *links, uint32_t count, double most, double *rooms, uint32_t *groups)
{
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t a = root_of(groups, links[i].low), b = root_of(groups, links[i].high);
        if (a != b && rooms[a] + rooms[b] <= most) {
            groups[a > b ? a : b] = a < b ? a : b;
            rooms[a < b ? a : b] += rooms[a > b ? a : b];
        }
    }
}

alp_result alpi_blend_groups(const alp_atlas *atlas, const alpi_charts *charts,
                             const alpi_pack_item *items, uint32_t **groups)
{
    const double most = SAFE_SHARE * atlas->options.size * atlas->options.size;
    link *links = ALPI_NEW(atlas->context, link, charts->blend->count);
    double *rooms = ALPI_NEW(atlas->context, double, charts->count);
    uint32_t *made = ALPI_NEW(atlas->context, uint32_t, charts->count);
    const bool has_room = links != NULL && rooms != NULL && made != NULL;
    if (has_room) {
        for (uint32_t c = 0; c < charts->count; c++) {
            made[c] = c;
            rooms[c] = room_of(&items[c], atlas->options.padding);
        }
        const uint32_t count = list_shared(atlas, charts->blend, links);
        join(links, add_up(links, count), most, rooms, made);
        for (uint32_t c = 0; c < charts->count; c++) {
            made[c] = root_of(made, c);
        }
        *groups = made;
    } else {
        alpi_release(atlas->context, made);
    }
    alpi_release(atlas->context, links);
    alpi_release(atlas->context, rooms);
    return has_room ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
}
