// SPDX-License-Identifier: MIT
// Texels as receivers: area-preserving maps from the unit square to the surface inside a texel. A
// whole texel is a parallelogram of its triangle: the map is affine. A texel of pieces is a row of
// convex polygons, each a fan of triangles about its first corner: the square's first coordinate
// goes through pieces and fans by their areas, the second goes from that corner outwards. So
// neighbours in the square stay neighbours in a piece, and strata stay strata.
#include "atlas/face_shapes.h"

#include <math.h>

enum { BATCH = 64, STRATA = 16 };

// --- facets --------------------------------------------------------------------------------------

/// The facet of a face. @param own where it is made if none is kept   @return it
static const alpi_facet *find_facet(const alpi_texels *texels, uint32_t face, bool lift,
                                    alpi_facet *own)
{
    const alpi_facet *kept = texels->shapes != NULL ? &texels->shapes[face].facet : NULL;
    if (kept != NULL && (lift || !kept->lifted)) {
        return kept;
    }
    const alp_atlas *atlas = texels->atlas;
    alpi_facet_load(atlas->scene, alpi_atlas_triangle(atlas, face), lift, own);
    return own;
}

static bool may_lift(const alpi_texels *texels, uint32_t texel)
{
    return (texels->flags[texel] & ALPI_TEXEL_NO_LIFT) == 0;
}

// --- cut texels ----------------------------------------------------------------------------------

/// A triangle's part of a texel, as a fan.
typedef struct fan {
    alpi_facet own;
    const alpi_facet *facet;
    alpi_facet_patch map; // from the texel's corner
    alpi_polygon shape;
    double ends[ALPI_POLYGON_LIMIT]; // of each triangle, ascending to 1
} fan;

/// A fan of no area: one point of the triangle. Rounding may leave nothing of a sliver where the
/// raster, which clips in another order, found something.
static void make_point(const alpi_page_triangle *page, const uint16_t pixel[2], fan *f)
{
    for (int k = 0; k < 2; k++) {
        const double middle = (page->p[0][k] + page->p[1][k] + page->p[2][k]) / 3.0 - pixel[k];
        for (int i = 0; i < 3; i++) {
            f->shape.p[i][k] = alpi_lesser(alpi_greater(middle, 0.0), 1.0);
        }
    }
    f->shape.count = 3;
    f->ends[0] = 1.0;
}

static void load_fan(const alpi_texels *texels, uint32_t texel, uint32_t piece, fan *f)
{
    const alp_atlas *atlas = texels->atlas;
    const uint16_t *pixel = texels->pixels[texel];
    const uint32_t triangle = texels->piece_triangles[piece];
    alpi_page_triangle page;
    alpi_page_triangle_load(atlas, triangle, &page);
    alpi_page_triangle_cut(&page, pixel[0], pixel[1], &f->shape);
    f->map = alpi_page_triangle_patch(&page, pixel[0], pixel[1]);
    f->facet = find_facet(texels, triangle, may_lift(texels, texel), &f->own);
    for (int i = 0; i < f->shape.count; i++) {
        f->shape.p[i][0] -= pixel[0];
        f->shape.p[i][1] -= pixel[1];
    }
    double sum = 0.0;
    const double *o = f->shape.p[0];
    for (int i = 1; i + 1 < f->shape.count; i++) {
        const double *a = f->shape.p[i], *b = f->shape.p[i + 1];
        const double part = (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
        sum += alpi_greater(part, 0.0);
        f->ends[i - 1] = sum;
    }
    if (!(sum > 0.0)) {
        make_point(&page, pixel, f);
        return;
    }
    for (int i = 0; i + 2 < f->shape.count; i++) {
        f->ends[i] /= sum;
    }
}

/// Barycentrics of the point of a fan at (u, v) of its own unit square.
static void find_in_fan(const fan *f, double u, double v, double b[2])
{
    int i = 0;
    while (i + 3 < f->shape.count && u >= f->ends[i]) {
        i++;
    }
    const double begin = i > 0 ? f->ends[i - 1] : 0.0;
    const double along =
        f->ends[i] > begin ? alpi_lesser((u - begin) / (f->ends[i] - begin), 1.0) : 0.0;
    const double outward = sqrt(v); // as many points at a distance as the fan is wide there
    double at[2];
    for (int k = 0; k < 2; k++) {
        const double o = f->shape.p[0][k], near = f->shape.p[i + 1][k];
        const double far = f->shape.p[i + 2][k];
        at[k] = o + outward * (near + along * (far - near) - o);
    }
    for (int k = 0; k < 2; k++) {
        b[k] = f->map.at[k] + at[0] * f->map.by_x[k] + at[1] * f->map.by_y[k];
        b[k] = alpi_lesser(alpi_greater(b[k], 0.0), 1.0);
    }
    const double sum = b[0] + b[1]; // rounding only: the polygon lies in the triangle
    if (sum > 1.0) {
        b[0] /= sum;
        b[1] /= sum;
    }
}

/// The piece that holds u of a texel's area.
static uint32_t find_piece(const alpi_texels *texels, uint32_t texel, float u)
{
    uint32_t low = texels->piece_first[texel], count = texels->piece_first[texel + 1] - low;
    while (count > 1) { // chosen, not branched to: which half it is, nobody can foresee
        const uint32_t half = count / 2;
        low = u >= texels->piece_ends[low + half - 1] ? low + half : low;
        count -= half;
    }
    return low;
}

/// Where a piece begins, and how much it has, of its texel's area.
static double piece_begin(const alpi_texels *texels, uint32_t texel, uint32_t piece, double *width)
{
    const bool first = piece == texels->piece_first[texel];
    const double begin = first ? 0.0 : (double)texels->piece_ends[piece - 1];
    *width = (double)texels->piece_ends[piece] - begin;
    return begin;
}

/// Each piece is clipped once for all points that fall into it.
static void place_in_pieces(const alpi_texels *texels, uint32_t texel, uint32_t count,
                            const float (*square)[2], alpi_receiver_point *points, vec3 *lows)
{
    uint32_t pieces[BATCH];
    for (uint32_t i = 0; i < count; i++) {
        pieces[i] = find_piece(texels, texel, square[i][0]);
    }
    fan f;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t piece = pieces[i];
        if (piece == ALPI_NONE) {
            continue; // placed
        }
        load_fan(texels, texel, piece, &f);
        double width;
        const double begin = piece_begin(texels, texel, piece, &width);
        for (uint32_t j = i; j < count; j++) {
            if (pieces[j] == piece) {
                const double u = width > 0.0 ? ((double)square[j][0] - begin) / width : 0.0;
                double b[2];
                find_in_fan(&f, u, (double)square[j][1], b);
                alpi_facet_point(f.facet, b, &points[j], lows != NULL ? &lows[j] : NULL);
                pieces[j] = ALPI_NONE;
            }
        }
    }
}

// --- valid strata --------------------------------------------------------------------------------

/// Maps the unit square to those of its 4 × 4 strata that are valid, each as likely: the first
/// coordinate goes through them one after the other.
static void keep_valid(uint32_t valid, uint32_t count, const float (*square)[2], float (*out)[2])
{
    uint8_t strata[STRATA] = {0};
    uint32_t strata_count = 0;
    for (uint32_t s = 0; s < STRATA; s++) {
        if ((valid >> s & 1u) != 0) {
            strata[strata_count++] = (uint8_t)s;
        }
    }
    const float below_one = 1.0f - 0x1p-24f;
    for (uint32_t i = 0; i < count; i++) {
        const float u = square[i][0] * (float)strata_count;
        uint32_t k = (uint32_t)u;
        k = k < strata_count ? k : strata_count - 1;
        const uint32_t column = strata[k] % 4u, row = strata[k] / 4u;
        const float x = (float)column + fminf(u - (float)k, below_one);
        const float y = (float)row + square[i][1];
        out[i][0] = fminf(0.25f * x, below_one);
        out[i][1] = fminf(0.25f * y, below_one);
    }
}

// --- texels --------------------------------------------------------------------------------------

/// Barycentrics of a whole texel's triangle, from the texel's corner on.
static alpi_facet_patch find_map(const alpi_texels *texels, uint32_t texel)
{
    const uint16_t *pixel = texels->pixels[texel];
    if (texels->shapes != NULL) {
        return alpi_page_map_from(&texels->shapes[texels->faces[texel]].map, pixel[0], pixel[1]);
    }
    alpi_page_triangle page;
    alpi_page_triangle_load(texels->atlas, texels->faces[texel], &page);
    return alpi_page_triangle_patch(&page, pixel[0], pixel[1]);
}

/// @param lows NULL, or out: the positions before any lift
static void place_in_texel(const alpi_texels *texels, uint32_t texel, uint32_t count,
                           const float (*square)[2], alpi_receiver_point *points, vec3 *lows)
{
    if (texels->piece_first[texel] != texels->piece_first[texel + 1]) {
        for (uint32_t i = 0; i < count; i += BATCH) {
            const uint32_t batch = count - i < BATCH ? count - i : BATCH;
            place_in_pieces(texels, texel, batch, square + i, points + i,
                            lows != NULL ? lows + i : NULL);
        }
        return;
    }
    alpi_facet own;
    const alpi_facet *facet =
        find_facet(texels, texels->faces[texel], may_lift(texels, texel), &own);
    const alpi_facet_patch map = find_map(texels, texel);
    alpi_facet_points(facet, &map, count, square, points, lows);
}

static void place(const void *user, uint32_t texel, uint32_t count, const float (*square)[2],
                  alpi_receiver_point *points)
{
    const alpi_texels *texels = user;
    const uint32_t valid = texels->valid == NULL ? 0 : texels->valid[texel];
    if (valid == 0 || valid == 0xffffu) {
        place_in_texel(texels, texel, count, square, points, NULL);
        return;
    }
    float moved[BATCH][2];
    for (uint32_t i = 0; i < count; i += BATCH) {
        const uint32_t batch = count - i < BATCH ? count - i : BATCH;
        keep_valid(valid, batch, square + i, moved);
        place_in_texel(texels, texel, batch, (const float(*)[2])moved, points + i, NULL);
    }
}

void alpi_texels_lifts(const alpi_texels *texels, uint32_t texel, uint32_t count,
                       const float (*square)[2], alpi_receiver_point *points, vec3 *lows)
{
    place_in_texel(texels, texel, count, square, points, lows);
}

void alpi_texels_spot(const alpi_texels *texels, uint32_t texel, const float square[2],
                      alpi_texel_spot *spot)
{
    double b[2], width;
    if (texels->piece_first[texel] != texels->piece_first[texel + 1]) {
        const uint32_t piece = find_piece(texels, texel, square[0]);
        const double begin = piece_begin(texels, texel, piece, &width);
        fan f;
        load_fan(texels, texel, piece, &f);
        find_in_fan(&f, width > 0.0 ? ((double)square[0] - begin) / width : 0.0, (double)square[1],
                    b);
        const uint32_t triangle =
            alpi_atlas_triangle(texels->atlas, texels->piece_triangles[piece]);
        *spot = (alpi_texel_spot){triangle, (float)b[0], (float)b[1]};
        return;
    }
    const alpi_facet_patch map = find_map(texels, texel);
    for (int k = 0; k < 2; k++) {
        b[k] = map.at[k] + (double)square[0] * map.by_x[k] + (double)square[1] * map.by_y[k];
    }
    *spot = (alpi_texel_spot){texels->triangles[texel], (float)b[0], (float)b[1]};
}

alpi_receivers alpi_texels_receivers(const alpi_texels *texels)
{
    return (alpi_receivers){
        .count = texels->count, .extended = true, .place = place, .user = texels};
}

float alpi_texels_side(const alpi_texels *texels, uint32_t texel)
{
    return sqrtf(texels->areas[texel] / fmaxf(texels->coverages[texel], 1e-6f));
}

bool alpi_texels_are_lifted(const alpi_texels *texels, uint32_t texel)
{
    const uint32_t last = texels->piece_first[texel + 1];
    alpi_facet own;
    bool lifted = find_facet(texels, texels->faces[texel], true, &own)->lifted;
    for (uint32_t i = texels->piece_first[texel]; i < last && !lifted; i++) {
        lifted = find_facet(texels, texels->piece_triangles[i], true, &own)->lifted;
    }
    return lifted;
}

void alpi_texels_point(const alpi_texels *texels, uint32_t texel, alpi_receiver_point *point)
{
    alpi_facet own;
    const alpi_facet *facet =
        find_facet(texels, texels->faces[texel], may_lift(texels, texel), &own);
    const double b[2] = {(double)texels->barycentrics[texel][0],
                         (double)texels->barycentrics[texel][1]};
    alpi_facet_point(facet, b, point, NULL);
}
