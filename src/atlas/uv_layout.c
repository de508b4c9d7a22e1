// SPDX-License-Identifier: MIT
// The layout of a texture that the scene has already, as an atlas of one page: the triangles of the
// surfaces that read it, at the coordinates they read it at.
#include "atlas/stages.h"

#include "base/memory.h"

#include <math.h>

static const double TILE_MARGIN = 1e-4; // coordinates this far outside of their tile are clamped
static const double TILE_LIMIT = 65536; // beyond it floats are too coarse to address texels
// Triangles without area in the layout read one texel or line of it, which can not be right for
// all their points; up to this share of the area they are modelling debris.
static const double FLAT_SHARE = 1e-3;

static alp_result refuse(char **reason, char *text)
{
    *reason = text;
    return text == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_ERROR_INVALID_DATA;
}

// --- coordinates ---------------------------------------------------------------------------------

/// Moves the coordinates of a triangle along one axis from the tile they lie in to [0, 1], as the
/// wrap mode does; false where no single tile holds them.
static bool leave_tile(alpi_wrap wrap, float (*uv)[2], int axis)
{
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        double value = (double)uv[k][axis];
        if (!(fabs(value) <= TILE_LIMIT)) {
            return false;
        }
        low = fmin(low, value);
        high = fmax(high, value);
    }
    double tile = floor(0.5 * (low + high));
    if (low < tile - TILE_MARGIN || high > tile + 1.0 + TILE_MARGIN ||
        (wrap == ALPI_WRAP_CLAMP && tile != 0.0)) {
        return false;
    }
    bool turned = wrap == ALPI_WRAP_MIRROR && fmod(tile, 2.0) != 0.0;
    for (int k = 0; k < 3; k++) {
        double value = (double)uv[k][axis] - tile;
        value = turned ? 1.0 - value : value;
        uv[k][axis] = (float)fmin(fmax(value, 0.0), 1.0);
    }
    return true;
}

/// False where the triangle does not lie inside one tile.
static bool place_triangle(const alp_scene *scene, uint32_t triangle, const alpi_texture *texture,
                           float (*uv)[2])
{
    for (int k = 0; k < 3; k++) {
        const float *own = scene->uvs[texture->uv_set][scene->triangles[triangle][k]];
        vec2 read = alpi_texture_transform(texture, (vec2){own[0], own[1]});
        uv[k][0] = read.x;
        uv[k][1] = read.y;
    }
    return leave_tile(texture->wrap_u, uv, 0) && leave_tile(texture->wrap_v, uv, 1);
}

static bool is_flat(const float (*uv)[2])
{
    double ax = (double)uv[1][0] - (double)uv[0][0], ay = (double)uv[1][1] - (double)uv[0][1];
    double bx = (double)uv[2][0] - (double)uv[0][0], by = (double)uv[2][1] - (double)uv[0][1];
    return ax * by - ay * bx == 0.0;
}

static double world_area(const alp_scene *scene, uint32_t triangle)
{
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    return vec3_triangle_area(c[0], c[1], c[2]);
}

/// What stands in the way, counted over the surfaces.
typedef struct faults {
    uint32_t outside, first_outside; // triangles that reach across the border of a tile
    double area, flat_area;
} faults;

static alp_result place_surface(alp_atlas *layout, uint32_t index, const alpi_texture *texture,
                                faults *found, char **reason)
{
    const alp_scene *scene = layout->scene;
    const alpi_surface *surface = &scene->surfaces[index];
    const bool is_obj = scene->attachments[ALPI_ATTACHMENT_OBJ].data != NULL;
    if (texture->uv_set >= surface->uv_sets || texture->uv_set >= ALPI_UV_SET_LIMIT ||
        scene->uvs[texture->uv_set] == NULL) {
        return refuse(reason, is_obj ? alpi_format(scene->context, "%s has no vt", surface->name)
                                     : alpi_format(scene->context, "%s has no TEXCOORD_%u",
                                                   surface->name, texture->uv_set));
    }
    for (uint32_t i = 0; i < surface->triangle_count; i++) {
        uint32_t t = surface->first_triangle + i;
        if (!scene->triangle_usable[t]) {
            continue;
        }
        float(*uv)[2] = layout->corner_uvs[t];
        layout->triangle_pages[t] = layout->triangle_charts[t] = 0;
        double area = world_area(scene, t);
        found->area += area;
        if (!place_triangle(scene, t, texture, uv)) {
            found->first_outside = found->outside == 0 ? t : found->first_outside;
            found->outside++;
        } else if (is_flat((const float(*)[2])uv)) {
            found->flat_area += area;
        }
    }
    return ALP_OK;
}

static alp_result place_surfaces(alp_atlas *layout, const alpi_texture *const *textures,
                                 char **reason)
{
    const alp_scene *scene = layout->scene;
    ALPI_TRY_NEW(layout->context, layout->corner_uvs, scene->triangle_count);
    ALPI_TRY_NEW(layout->context, layout->triangle_pages, scene->triangle_count);
    ALPI_TRY_NEW(layout->context, layout->triangle_charts, scene->triangle_count);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        layout->triangle_pages[t] = layout->triangle_charts[t] = ALPI_NONE;
    }
    faults found = {0};
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        if (textures[s] != NULL && scene->surfaces[s].triangle_count > 0) {
            ALP_TRY(place_surface(layout, s, textures[s], &found, reason));
        }
    }
    if (found.outside > 0) {
        uint32_t s = scene->triangle_surface[found.first_outside];
        return refuse(reason,
                      alpi_format(scene->context,
                                  "it is tiled: %u triangle%s outside of one tile of it, such as "
                                  "%u of %s",
                                  found.outside, found.outside == 1 ? " reaches" : "s reach",
                                  found.first_outside - scene->surfaces[s].first_triangle,
                                  scene->surfaces[s].name));
    }
    if (!(found.flat_area <= FLAT_SHARE * found.area) || !(found.area > 0.0)) {
        return refuse(reason,
                      alpi_format(scene->context, "%.1f %% of the surface has no area in it",
                                  found.area > 0.0 ? 100.0 * found.flat_area / found.area : 100.0));
    }
    return ALP_OK;
}

alp_result alpi_uv_layout_create(const alp_scene *scene, const alpi_texture *const *textures,
                                 uint32_t width, uint32_t height, alp_atlas **layout, char **reason)
{
    *layout = NULL;
    *reason = NULL;
    alp_atlas *made = ALPI_NEW(scene->context, alp_atlas, 1);
    if (made == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    made->scene = scene;
    made->context = scene->context;
    made->options = alp_atlas_options_default();
    made->info =
        (alp_atlas_info){.mode = ALP_ATLAS_KEEP, .pages = 1, .width = width, .height = height};
    alp_result result = place_surfaces(made, textures, reason);
    if (result != ALP_OK) {
        alp_atlas_destroy(made);
        return result;
    }
    *layout = made;
    return ALP_OK;
}

// --- overlaps ------------------------------------------------------------------------------------

/// What a band of the layout's rows holds.
typedef struct band_overlaps {
    uint64_t texels;
    uint32_t one, other; // triangles of the first
} band_overlaps;

static alp_result collect_overlaps(void *user, const alpi_band *band)
{
    band_overlaps *found = (band_overlaps *)user + band->index;
    for (uint32_t row = 0; row < band->end_row - band->first_row; row++) {
        const alpi_cell *cells = band->cells + (size_t)row * band->width;
        for (uint32_t x = band->columns[row][0]; x < band->columns[row][1]; x++) {
            const alpi_cell *cell = &cells[x];
            if (cell->first_piece != ALPI_NONE && cell->other != ALPI_NONE &&
                found->texels++ == 0) {
                found->one = cell->triangle;
                found->other = cell->other;
            }
        }
    }
    return ALP_OK;
}

static alp_result tell_overlaps(const alp_scene *scene, const band_overlaps *found, char **reason)
{
    uint32_t a = scene->triangle_surface[found->one], b = scene->triangle_surface[found->other];
    const alpi_surface *one = &scene->surfaces[a], *other = &scene->surfaces[b];
    unsigned long long texels = (unsigned long long)found->texels;
    uint32_t i = found->one - one->first_triangle, j = found->other - other->first_triangle;
    return refuse(
        reason,
        a == b ? alpi_format(scene->context,
                             "triangles overlap in it at %llu texels, such as %u and %u "
                             "of %s",
                             texels, i, j, one->name)
               : alpi_format(scene->context,
                             "%s overlap in it at %llu texels, such as triangle %u of %s "
                             "and %u of %s",
                             one->mesh == other->mesh ? "nodes that share one mesh" : "surfaces",
                             texels, i, one->name, j, other->name));
}

alp_result alpi_uv_layout_check(const alp_atlas *layout, char **reason)
{
    *reason = NULL;
    uint32_t bands = alpi_raster_bands(layout);
    band_overlaps *found = ALPI_NEW(layout->context, band_overlaps, bands);
    if (found == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = alpi_raster(layout, 0, 1, collect_overlaps, found);
    for (uint32_t b = 1; b < bands; b++) { // the first of all, whichever worker found it
        found[0].one = found[0].texels == 0 ? found[b].one : found[0].one;
        found[0].other = found[0].texels == 0 ? found[b].other : found[0].other;
        found[0].texels += found[b].texels;
    }
    if (result == ALP_OK && found[0].texels > 0) {
        result = tell_overlaps(layout->scene, &found[0], reason);
    }
    alpi_release(layout->context, found);
    return result;
}

// --- cells ---------------------------------------------------------------------------------------

typedef struct visit {
    const alp_atlas *layout;
    alpi_uv_cell_fn *each;
    void *user;
} visit;

/// Barycentrics of corners 1 and 2 at a point in texels, held inside the triangle.
static void find_barycentrics(const alp_atlas *layout, const alpi_cell *at, float b[2])
{
    const float(*uv)[2] = (const float(*)[2])layout->corner_uvs[at->triangle];
    double width = layout->info.width, height = layout->info.height;
    double x = (double)uv[0][0] * width, y = (double)uv[0][1] * height;
    double e1x = (double)uv[1][0] * width - x, e1y = (double)uv[1][1] * height - y;
    double e2x = (double)uv[2][0] * width - x, e2y = (double)uv[2][1] * height - y;
    double area = e1x * e2y - e1y * e2x; // not 0: the triangle has a piece in a texel
    double dx = at->x - x, dy = at->y - y;
    double b1 = fmin(fmax((dx * e2y - dy * e2x) / area, 0.0), 1.0);
    double b2 = fmin(fmax((e1x * dy - e1y * dx) / area, 0.0), 1.0);
    double sum = fmax(b1 + b2, 1.0);
    b[0] = (float)(b1 / sum);
    b[1] = (float)(b2 / sum);
}

static alp_result visit_band(void *user, const alpi_band *band)
{
    const visit *v = user;
    for (uint32_t y = band->first_row; y < band->end_row; y++) {
        const uint32_t row = y - band->first_row;
        const alpi_cell *cells = band->cells + (size_t)row * band->width;
        for (uint32_t x = band->columns[row][0]; x < band->columns[row][1]; x++) {
            const alpi_cell *cell = &cells[x];
            if (cell->first_piece == ALPI_NONE) {
                continue;
            }
            alpi_uv_cell out = {.x = x,
                                .y = y,
                                .triangle = alpi_atlas_triangle(v->layout, cell->triangle),
                                .coverage = (float)fmin(cell->coverage, 1.0)};
            find_barycentrics(v->layout, cell, out.barycentrics);
            v->each(v->user, &out);
        }
    }
    return ALP_OK;
}

alp_result alpi_atlas_visit(const alp_atlas *atlas, uint32_t page, uint32_t parts,
                            alpi_uv_cell_fn *each, void *user)
{
    alp_atlas finer = *atlas; // the same triangles on smaller texels
    finer.info.width *= parts;
    finer.info.height *= parts;
    visit v = {.layout = &finer, .each = each, .user = user};
    return alpi_raster(&finer, page, page + 1, visit_band, &v);
}

alp_result alpi_uv_layout_visit(const alp_atlas *layout, uint32_t parts, alpi_uv_cell_fn *each,
                                void *user)
{
    return alpi_atlas_visit(layout, 0, parts, each, user);
}
