// SPDX-License-Identifier: MIT
// What the files of this room share with each other and with nobody else.
#ifndef ALPI_ATLAS_STAGES_H
#define ALPI_ATLAS_STAGES_H

#include "atlas/raster.h"

#include <math.h>

enum {
    ALPI_ATLAS_PAGE_LIMIT = 4096,
    ALPI_ATLAS_SIZE_LIMIT = 16384,
    ALPI_ATLAS_PADDING_LIMIT = 64,
    ALPI_ATLAS_BLOCK_LIMIT = 64,
    ALPI_ATLAS_MIPS_LIMIT = 8
};

/// When to ask the caller whether to go on.
struct alpi_atlas_clock {
    alp_context *context;
    alp_progress_fn *callback; // NULL: never asks
    void *user;
    double last;
};
/// Tells how far a stage is, at most 20 times a second; cheap enough for every thousandth item.
/// @return ALP_OK; CANCELLED
alp_result alpi_atlas_tick(alpi_atlas_clock *clock, const char *stage, uint64_t done,
                           uint64_t total);

// --- planes
// ---------------------------------------------------------------------------------------

/// A plane with axes t × b = n, in double: shared vertices project to the same bits.
typedef struct alpi_plane {
    double origin[3], t[3], b[3];
} alpi_plane;
alpi_plane alpi_plane_make(vec3 normal, vec3 origin);
void alpi_plane_project(const alpi_plane *plane, vec3 point, double *x, double *y);

// --- clusters → charts ---------------------------------------------------------------------------

/// Triangles that are unwrapped together, turned to their tightest box. Their coordinates are in
/// atlas.corner_uvs: first in metres from the corner of that box, at the end in pages.
typedef struct alpi_chart {
    uint32_t first, count; // in alpi_charts.triangles
    double width, height;  // of the tightest box, metres
} alpi_chart;

typedef struct alpi_charts {
    uint32_t count;
    size_t capacity;
    alpi_chart *charts;
    uint32_t *triangles;                  // [usable triangles] grouped by chart
    const struct alpi_blend_faces *blend; // BLEND: what its triangles are faces of, borrowed; NULL
} alpi_charts;

/// Projects every cluster on its plane, turns it to its tightest box and writes corner_uvs (metres)
/// and triangle_charts. A chart has the area of its triangles in the world. On failure the caller
/// destroys what was made.
alp_result alpi_charts_create(alp_atlas *atlas, const uint32_t (*neighbours)[3],
                              const alpi_clusters *clusters, alpi_charts *charts);
/// Gives all charts the area of their triangles and turns them to their tightest boxes; corner_uvs
/// are in metres already.
alp_result alpi_charts_turn(alp_atlas *atlas, const uint32_t (*neighbours)[3], alpi_charts *charts);
/// Merges charts that meet, where both have one good unwrapping, and turns them again.
alp_result alpi_charts_merge(alp_atlas *atlas, const uint32_t (*neighbours)[3],
                             alpi_charts *charts);
/// Of charts, in metres.
typedef struct alpi_cut_sides {
    double limit; // charts with a longer side are cut
    double part;  // of pieces, the most
    double page;  // of what fits a page
    double texel;
} alpi_cut_sides;
/// How much a chart may be longer than what it must fit, to be clamped to it: the rounding of its
/// 32-bit coordinates, where that is far below a texel. Sides are often whole texels.
static inline double alpi_cut_slack(const alpi_chart *chart, double texel)
{
    return fmin(0x1p-21 * fmax(chart->width, chart->height), 1e-3 * texel);
}
/// The longest side, in metres, of a chart that fits `texels` texels at a density: a box of whole
/// texels forgives what rounding adds.
static inline double alpi_part_side(uint32_t texels, double density)
{
    return (texels + 5e-6) / density;
}
/// Whether every triangle fits a page at `density` texels per metre, turned as it needs to.
/// @return ALP_OK; LIMIT: which does not, and what it takes
alp_result alpi_charts_check(const alp_atlas *atlas, double density, const alpi_charts *charts);
/// Cuts charts into connected pieces. Triangles larger than a part become pieces of their own,
/// turned where they would not fit a page.
alp_result alpi_charts_cut(alp_atlas *atlas, const uint32_t (*neighbours)[3],
                           const alpi_cut_sides *sides, alpi_charts *charts);
void alpi_charts_destroy(alp_context *context, alpi_charts *charts);

/// Finds the density, packs, and turns corner_uvs from metres into page coordinates; sets
/// triangle_pages and info.pages.
/// @param neighbours of all triangles
alp_result alpi_layout(alp_atlas *atlas, const uint32_t (*neighbours)[3], alpi_charts *charts,
                       alpi_atlas_clock *clock);

/// Texels that an item covers.
uint64_t alpi_pack_texels(const alpi_pack_item *item);

/// Packs like alpi_pack, but items of one group go to one page where one has room for all of them:
/// the largest groups first. A group that no page holds is packed item by item.
/// @param groups [count] of each item, less than count
alp_result alpi_pack_groups(alp_context *context, const alpi_pack_rules *rules,
                            alpi_pack_item *items, const uint32_t *groups, uint32_t count,
                            uint32_t page_limit, uint32_t *page_count);

/// Gives triangles that are thinner than the steps of floats on their page some steps of width, so
/// that none is flat or flipped there.
void alpi_widen_slivers(alp_atlas *atlas);

/// Packs into one page, or says that it cannot; that is no failure and leaves no message.
alp_result alpi_pack_one_page(alp_context *context, const alpi_pack_rules *rules,
                              alpi_pack_item *items, uint32_t count, bool *fits);

// --- the second UV set ---------------------------------------------------------------------------

/// Takes the scene's second UV set as it is. Where it cannot hold a bake, `reason` (released by the
/// caller) says why and names triangles, and the call gives INVALID_DATA without a message.
alp_result alpi_keep(alp_atlas *atlas, const uint32_t (*neighbours)[3], char **reason);
/// Charts of coordinates that are there: triangles on a page (not ALPI_NONE), connected in space
/// and in uv. Sets triangle_charts and info.charts.
alp_result alpi_uv_islands(alp_atlas *atlas, const uint32_t (*neighbours)[3]);

// --- texels --------------------------------------------------------------------------------------

/// A texel as its band leaves it.
typedef struct alpi_texel_record {
    uint16_t x, y;
    uint32_t triangle, piece_count; // 0 pieces: it lies wholly inside the triangle
    float barycentrics[2], area, coverage, normal[3];
} alpi_texel_record;

/// The texels of a band, row by row.
typedef struct alpi_texel_chunk {
    uint32_t page, texel_count, piece_count;
    alpi_texel_record *records; // [texel_count]
    uint32_t *piece_triangles;  // [piece_count]
    float *piece_ends;          // [piece_count]
} alpi_texel_chunk;

typedef struct alpi_texel_chunks {
    uint32_t count;
    alpi_texel_chunk *chunks; // [count] by the bands' indices
} alpi_texel_chunks;

alp_result alpi_texel_chunks_create(const alp_atlas *atlas, alpi_texel_chunks *chunks);
void alpi_texel_chunks_destroy(alp_context *context, alpi_texel_chunks *chunks);
/// Called by many threads, with a chunk each.
alp_result alpi_texel_chunk_fill(const alp_atlas *atlas, const alpi_band *band,
                                 alpi_texel_chunk *chunk);
/// Joins chunks into texels and empties them.
alp_result alpi_texels_join(const alp_atlas *atlas, alpi_texel_chunks *chunks, alpi_texels *texels);

/// Two triangles that cover the same place.
typedef struct alpi_overlap {
    uint32_t triangle, other;
} alpi_overlap;
typedef struct alpi_overlaps {
    uint32_t count;
    alpi_overlap *pairs; // [count] texel by texel
} alpi_overlaps;

/// Rasters the atlas: fills info but for mode, pages, sides and charts, and keeps the texels in
/// atlas->texels for alpi_texels_create unless they are very many.
/// @param overlaps NULL, or out: released by the caller
alp_result alpi_measure(alp_atlas *atlas, alpi_overlaps *overlaps);

#endif
