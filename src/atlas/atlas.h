// SPDX-License-Identifier: MIT
// Private side of alp_atlas: what the maps room reads. Pure geometry; no light here.
#ifndef ALPI_ATLAS_ATLAS_H
#define ALPI_ATLAS_ATLAS_H

#include "scene/receivers.h"
#include "scene/scene.h"

#include <alpenglow/atlas.h>

struct alpi_texels;
struct alpi_face_shape;

struct alp_atlas {
    const alp_scene *scene;
    alp_context *context;
    alp_atlas_options options;
    alp_atlas_info info;
    float (*corner_uvs)[3][2]; // [faces]
    uint32_t *triangle_pages;  // [faces]; ALPI_NONE: of a surface that was not chosen
    uint32_t *triangle_charts; // [faces] chart of each; ALPI_NONE for triangles without
                               // texels of their own: unusable, not chosen, or of an instance.
                               // KEEP: chart = connected island in uv
    // Faces: the triangles in their order, and behind them, BLEND alone, those that lie in further
    // charts once more. NULL, 0: as many faces as triangles.
    uint32_t *face_triangles; // [face_count]
    uint8_t *face_axes;       // [face_count] of whose charts they are in
    uint32_t face_count;
    float (*set_uvs)[3][3][2];  // BLEND: [triangle_count][set][corner], else NULL
    uint8_t *set_members;       // BLEND: [triangle_count] bit k: it is in a chart of axis k, else
                                // set k repeats the chart of its strongest axis
    bool world_axes;            // BLEND: the axes are those of the world
    float *factors;             // [surface_count] of options.densities; NULL: all 1
    struct alpi_texels *texels; // made when it was measured, until somebody takes them; or NULL
};

static inline uint32_t alpi_atlas_face_count(const alp_atlas *atlas)
{
    return atlas->face_triangles != NULL ? atlas->face_count : atlas->scene->triangle_count;
}
static inline uint32_t alpi_atlas_triangle(const alp_atlas *atlas, uint32_t face)
{
    return atlas->face_triangles != NULL ? atlas->face_triangles[face] : face;
}

/// Whether the scene's own coordinates will do: not where something is asked for that only new
/// charts can have.
static inline bool alpi_atlas_may_keep(const alp_atlas_options *options)
{
    return options->mode == ALP_ATLAS_KEEP ||
           (options->mode == ALP_ATLAS_AUTO && options->block <= 1 && options->mips == 0 &&
            options->densities == NULL);
}

/// Coordinate sets that a look-up reads, and those of a triangle's corners in one of them.
static inline int alpi_atlas_set_count(const alp_atlas *atlas)
{
    return atlas->set_uvs != NULL ? 3 : 1;
}
static inline const float *alpi_atlas_set_uv(const alp_atlas *atlas, uint32_t triangle, int set,
                                             int corner)
{
    return atlas->set_uvs != NULL ? atlas->set_uvs[triangle][set][corner]
                                  : atlas->corner_uvs[triangle][corner];
}

/// What is special about a texel.
enum {
    ALPI_TEXEL_NO_LIFT = 1, // its points stay on their triangles: the lift to the smooth surface
                            // would pass through something
    ALPI_TEXEL_HIDDEN = 2   // it lies wholly inside other geometry: no light reaches it
};

/// The covered texels of an atlas, page by page, row by row: index i is receiver i. About 50 bytes
/// a texel and 8 a piece, and 16 a texel at most of shapes.
typedef struct alpi_texels {
    uint32_t count;
    uint32_t *pages;          // [count]
    uint16_t (*pixels)[2];    // [count] x, y
    uint32_t *triangles;      // [count] the triangle its representative point lies on
    uint32_t *faces;          // [count] the face it is of; BLEND: else the array of triangles
    float (*barycentrics)[2]; // [count] of that point: weights of corners 1 and 2
    float (*normals)[3];      // [count] shading normal there, unit
    float *areas;             // [count] world area of the chart inside the texel, m²
    float *coverages;         // [count] share of the texel inside its chart(s), (0, 1]
    float *shares;            // [count] of areas that count, where charts overlap; NULL: 1
    uint32_t *charts;         // [count]
    uint32_t *page_first;     // [pages + 1] first texel of each page
    uint8_t *flags;           // [count] ALPI_TEXEL_…; 0 as made
    uint16_t *valid; // [count] or NULL (as made): which strata of its unit square hold points. Bit
                     // 4·floor(4·sy) + floor(4·sx); all bits or none: all of it

    // Pieces: the faces with area in the texel, neighbours after each other. A texel without
    // any lies wholly inside triangles[i].
    uint32_t *piece_first;     // [count + 1]
    uint32_t *piece_triangles; // [piece_first[count]] faces
    float *piece_ends; // [piece_first[count]] share of the texel's area up to the end of the piece:
                       // ascending, the last is 1

    struct alpi_face_shape *shapes; // [faces] or NULL: what places in a face share, where there are
                                    // so many texels that it pays to keep it
    const alp_atlas *atlas;         // must outlive the texels
} alpi_texels;

/// What a texel counts in sums over the surface, m²: overlapping charts have each place up to three
/// times, with weights that sum to 1.
static inline float alpi_texels_area(const alpi_texels *texels, uint32_t texel)
{
    return texels->shares != NULL ? texels->areas[texel] * texels->shares[texel]
                                  : texels->areas[texel];
}

/// A texel is covered when a usable triangle has area inside it. Its representative point lies at
/// its centre where the centre is inside a triangle, else at the centroid of the largest piece of a
/// triangle inside it; off the triangle's edges by a twentieth of a texel, as far as the triangle
/// has room. The first call takes what the atlas has at hand, others make the texels anew.
alp_result alpi_texels_create(const alp_atlas *atlas, alpi_texels *texels);
void alpi_texels_destroy(alp_context *context, alpi_texels *texels);

// --- a UV set that is there already --------------------------------------------------------------

/// What is to be known of a set before it is trusted. Triangles outside and flat ones count as
/// neither islands' texels nor overlaps.
typedef struct alpi_uv_set_facts {
    uint32_t surfaces, missing_surfaces; // with usable triangles: that have it, that do not
    uint32_t triangles;                  // usable, of surfaces that have it
    uint32_t outside, flat, overlapping; // of those
    uint32_t first_missing;              // surface, ALPI_NONE = none
    uint32_t first_outside, first_flat, first_overlap; // triangles, ALPI_NONE = none
    uint32_t islands, touching;       // connected in space and uv; without a free texel to another
    double coverage, overlap, shared; // shares: of the page covered; of its texels where triangles
                                      // overlap; of these, where instances of one mesh do
    double density_ratio;             // of the surfaces of 1 % of the area or more
    uint32_t finest, coarsest;        // surfaces, ALPI_NONE = none
} alpi_uv_set_facts;
/// Measures set `set` of all surfaces on a page of size × size texels.
/// @param layout out: the triangles inside [0, 1] on page 0 at the set's coordinates, others on
///               ALPI_NONE; charts are islands
/// @param neighbours what alpi_adjacency_create gives, NULL = it is made here
alp_result alpi_uv_set_survey(const alp_scene *scene, uint32_t set, uint32_t size,
                              const uint32_t (*neighbours)[3], alpi_uv_set_facts *facts,
                              alp_atlas **layout);

/// What will be seen of a bake in a set that can hold one.
typedef struct alpi_uv_quality {
    uint32_t tiny;       // islands whose area is below a texel
    double tiny_share;   // of the surface, that they hold
    uint32_t tiny_worst; // triangle of the one of them with most surface, ALPI_NONE = none
    double tiny_texels;  // its area
    uint32_t free;       // texels between the two islands that are nearest; the page's side where
                         // there is but one island
    uint32_t near[2];    // a triangle of each, ALPI_NONE = there is but one island
    float gap[2];        // u, v between them
    double stretch;      // L2 stretch of the surface with most, of those of 1 % of the area
    uint32_t stretched;  // that surface, ALPI_NONE = none
    uint32_t stretched_worst; // its triangle that is stretched most
    double own_stretch;       // of that triangle
} alpi_uv_quality;
/// Measures a layout of alpi_uv_set_survey.
alp_result alpi_uv_set_quality(const alp_atlas *layout, alpi_uv_quality *quality);

// --- the layout of a texture that is there already -----------------------------------------------

/// An atlas of one page, width × height, on which each surface s with textures[s] ≠ NULL lies where
/// that texture is read: coordinate set, KHR_texture_transform, and each triangle moved from its
/// tile into [0, 1] as the wrap mode has it. Its triangles' page is 0, that of others ALPI_NONE; it
/// has no charts.
/// @param textures [surface_count]
/// @param reason   out: where the layout cannot hold a bake (a missing set, triangles that reach
///                 across tiles, surface without area in it), why; released by the caller. The call
///                 then gives INVALID_DATA without a message.
alp_result alpi_uv_layout_create(const alp_scene *scene, const alpi_texture *const *textures,
                                 uint32_t width, uint32_t height, alp_atlas **layout,
                                 char **reason);
/// INVALID_DATA and a reason, as above, where triangles overlap by more than the border of a texel.
alp_result alpi_uv_layout_check(const alp_atlas *layout, char **reason);

/// A cell that a triangle covers some of, and a point of that triangle inside it: the middle of the
/// cell where a triangle holds it, else the middle of the largest piece.
typedef struct alpi_uv_cell {
    uint32_t x, y, triangle;
    float barycentrics[2]; // weights of corners 1 and 2
    float coverage;        // (0, 1]
} alpi_uv_cell;
typedef void alpi_uv_cell_fn(void *user, const alpi_uv_cell *cell);
/// Hands out all cells, each texel divided into parts × parts of them, on all workers at once and
/// in any order.
alp_result alpi_uv_layout_visit(const alp_atlas *layout, uint32_t parts, alpi_uv_cell_fn *each,
                                void *user);
/// The same of a page of any atlas.
alp_result alpi_atlas_visit(const alp_atlas *atlas, uint32_t page, uint32_t parts,
                            alpi_uv_cell_fn *each, void *user);
/// Side of a texel on the surface, metres.
float alpi_texels_side(const alpi_texels *texels, uint32_t texel);
/// A texel's representative point.
void alpi_texels_point(const alpi_texels *texels, uint32_t texel, alpi_receiver_point *point);

/// Whether any triangle of a texel lifts its points.
bool alpi_texels_are_lifted(const alpi_texels *texels, uint32_t texel);

/// Texels as receivers: their points are spread over the surface inside the texel, over its pieces
/// by their areas, lifted to the smooth surface that the vertex normals describe. The texels must
/// outlive the receivers.
alpi_receivers alpi_texels_receivers(const alpi_texels *texels);

/// Points of a texel as its receivers place them with all strata valid, and where each lies before
/// its lift.
void alpi_texels_lifts(const alpi_texels *texels, uint32_t texel, uint32_t count,
                       const float (*square)[2], alpi_receiver_point *points, vec3 *lows);

/// A place on the surface inside a texel.
typedef struct alpi_texel_spot {
    uint32_t triangle;
    float b1, b2; // weights of corners 1 and 2
} alpi_texel_spot;
/// The spot that a point of the unit square stands for, as in alpi_texels_receivers with all strata
/// valid and without the lift.
void alpi_texels_spot(const alpi_texels *texels, uint32_t texel, const float square[2],
                      alpi_texel_spot *spot);

// --- the stages, each alone in its file ----------------------------------------------------------

/// Triangles that can be projected together on one plane without folding.
typedef struct alpi_clusters {
    uint32_t count;
    uint32_t *of_triangle; // [triangle_count], ALPI_NONE for unusable triangles
    float (*planes)[3];    // [count] unit normal of the plane of each
} alpi_clusters;
typedef struct alpi_atlas_clock alpi_atlas_clock; // see stages.h
/// Clusters of all usable triangles: regions whose normals stay within max_angle of their plane,
/// in parts whose projection does not fold over itself. Triangles of one cluster belong to one mesh
/// instance (node).
/// @param clock NULL = runs to its end; else may end the call with CANCELLED
alp_result alpi_clusters_create(const alp_scene *scene, const uint32_t (*neighbours)[3],
                                float max_angle, alpi_atlas_clock *clock, alpi_clusters *clusters);
void alpi_clusters_destroy(alp_context *context, alpi_clusters *clusters);

/// Something to be packed and where it went, in texels.
typedef struct alpi_pack_item {
    uint32_t width, height; // ≥ 1, of its box
    const uint64_t *mask;   // [height][(width + 63) / 64] the texels of the box that it covers, the
                            // first in the lowest bit, none behind the last; at least one of all;
                            // NULL = all
    uint32_t x, y, page;    // out: of the box after turning
    uint32_t turns;         // out: quarters; one takes texel (x, y) to (height − 1 − y, x)
} alpi_pack_item;
/// What must be free between two items.
typedef struct alpi_pack_rules {
    uint32_t size;    // side of a page
    uint32_t padding; // texels between covered ones of two items, rows and columns alike
    uint32_t block; // no block of block × block texels, counted from the page's corner, has texels
                    // of two items; 0 and 1: no matter
    uint32_t mips;  // two cells of 2^(mips − 1) texels are free between those with texels of two
                    // items; 0: no matter. See alp_atlas_options.mips
    bool by_middle; // to where an item's middle comes lowest, not its upper side
    uint64_t *rows_tried; // NULL, or: grows by how often a row was looked at for room
} alpi_pack_rules;
/// Packs shapes into pages: the large first, each turned by quarters, to where its upper side ends
/// lowest on the first page that has room for it; holes are used. The page's border needs no gap.
/// Items larger than a page fail with LIMIT. Deterministic.
alp_result alpi_pack(alp_context *context, const alpi_pack_rules *rules, alpi_pack_item *items,
                     uint32_t count, uint32_t page_limit, uint32_t *page_count);

#endif
