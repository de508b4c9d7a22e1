// SPDX-License-Identifier: MIT
// What will be seen of a bake in a set of texture coordinates: islands below a texel, space between
// islands, stretch.
// Stretch after: P. V. Sander, J. Snyder, S. J. Gortler, H. Hoppe. Texture Mapping Progressive
// Meshes. SIGGRAPH 2001.
#include "atlas/stretch.h"

#include "atlas/raster.h"
#include "base/memory.h"

#include <math.h>

static const double AREA_SHARE = 0.01; // of the scene: smaller surfaces do not count

static bool is_placed(const alp_atlas *layout, uint32_t triangle)
{
    return layout->triangle_pages[triangle] != ALPI_NONE;
}

static double world_area(const alp_scene *scene, uint32_t triangle, vec3 c[3])
{
    alpi_triangle_corners(scene, triangle, c);
    return vec3_triangle_area(c[0], c[1], c[2]);
}

/// Corners on the page, texels.
static void page_corners(const alp_atlas *layout, uint32_t triangle, double p[3][2])
{
    for (int k = 0; k < 3; k++) {
        p[k][0] = (double)layout->corner_uvs[triangle][k][0] * layout->info.width;
        p[k][1] = (double)layout->corner_uvs[triangle][k][1] * layout->info.height;
    }
}

static double page_area(const double p[3][2])
{
    return 0.5 * fabs((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) -
                      (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]));
}

// --- islands below a texel -----------------------------------------------------------------------

typedef struct island_areas {
    double *texels, *surface; // [islands] texels², m²
    uint32_t *first;          // [islands] triangle
} island_areas;

static void add_islands(const alp_atlas *layout, const island_areas *areas)
{
    for (uint32_t i = 0; i < layout->info.charts; i++) {
        areas->first[i] = ALPI_NONE;
    }
    for (uint32_t t = 0; t < layout->scene->triangle_count; t++) {
        if (!is_placed(layout, t)) {
            continue;
        }
        vec3 c[3];
        double p[3][2];
        const uint32_t island = layout->triangle_charts[t];
        page_corners(layout, t, p);
        areas->texels[island] += page_area((const double(*)[2])p);
        areas->surface[island] += world_area(layout->scene, t, c);
        areas->first[island] = areas->first[island] == ALPI_NONE ? t : areas->first[island];
    }
}

static void judge_islands(const alp_atlas *layout, const island_areas *areas, alpi_uv_quality *q)
{
    double tiny = 0.0, most = 0.0;
    for (uint32_t i = 0; i < layout->info.charts; i++) {
        if (areas->first[i] == ALPI_NONE || !(areas->texels[i] < 1.0)) {
            continue;
        }
        q->tiny++;
        tiny += areas->surface[i];
        if (areas->surface[i] > most) {
            most = areas->surface[i];
            q->tiny_worst = areas->first[i];
            q->tiny_texels = areas->texels[i];
        }
    }
    q->tiny_share = layout->scene->area > 0.0 ? tiny / layout->scene->area : 0.0;
}

static alp_result find_tiny(const alp_atlas *layout, alpi_uv_quality *q)
{
    const uint32_t count = layout->info.charts;
    island_areas areas = {.texels = ALPI_NEW(layout->context, double, count),
                          .surface = ALPI_NEW(layout->context, double, count),
                          .first = ALPI_NEW(layout->context, uint32_t, count)};
    const bool made = areas.texels != NULL && areas.surface != NULL && areas.first != NULL;
    if (made) {
        add_islands(layout, &areas);
        judge_islands(layout, &areas, q);
    }
    alpi_release(layout->context, areas.texels);
    alpi_release(layout->context, areas.surface);
    alpi_release(layout->context, areas.first);
    return made ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
}

// --- space between islands -----------------------------------------------------------------------

/// Texels with their nearest island, as one pass over the page finds it, in steps that count alike
/// in all eight directions. Half of the directions will do: of two islands the upper one comes down
/// to the row of the lower one, which comes the rest of the way along it.
/// Based on: A. Rosenfeld, J. L. Pfaltz. Distance Functions on Digital Pictures. Pattern
/// Recognition 1, 1968.
typedef struct nearest {
    uint32_t width, height;
    uint32_t *triangles; // [height][width] of the nearest island, ALPI_NONE = none yet
    uint16_t *steps;     // [height][width] to it
} nearest;

static alp_result note_texels(void *user, const alpi_band *band)
{
    const nearest *n = user;
    for (uint32_t y = band->first_row; y < band->end_row; y++) {
        const uint32_t row = y - band->first_row;
        for (uint32_t x = band->columns[row][0]; x < band->columns[row][1]; x++) {
            n->triangles[(size_t)y * n->width + x] =
                band->cells[(size_t)row * band->width + x].triangle;
        }
    }
    return ALP_OK;
}

static void spread_nearest(const nearest *n)
{
    const int64_t width = n->width, count = width * n->height;
    for (int64_t i = 0; i < count; i++) {
        const bool left = i % width > 0, right = i % width + 1 < width;
        const int64_t from[4] = {i - 1, i - width - 1, i - width, i - width + 1};
        const bool there[4] = {left, left, true, right};
        for (int k = 0; k < 4; k++) {
            if (there[k] && from[k] >= 0 && n->triangles[from[k]] != ALPI_NONE &&
                (n->triangles[i] == ALPI_NONE || n->steps[from[k]] + 1 < n->steps[i])) {
                n->triangles[i] = n->triangles[from[k]];
                n->steps[i] = (uint16_t)(n->steps[from[k]] + 1);
            }
        }
    }
}

/// Texels on the way between the nearest islands of two texels that touch.
static void look_between(const alp_atlas *layout, const nearest *n, size_t here, size_t there,
                         alpi_uv_quality *q)
{
    const uint32_t a = n->triangles[here], b = n->triangles[there];
    const uint32_t between = (uint32_t)n->steps[here] + n->steps[there];
    if (a != ALPI_NONE && b != ALPI_NONE &&
        layout->triangle_charts[a] != layout->triangle_charts[b] &&
        (q->near[0] == ALPI_NONE || between < q->free)) {
        q->free = between;
        q->near[0] = a;
        q->near[1] = b;
        const size_t x = here % n->width, y = here / n->width;
        q->gap[0] = ((float)x + 0.5f) / (float)n->width;
        q->gap[1] = ((float)y + 0.5f) / (float)n->height;
    }
}

static alp_result measure_gaps(const alp_atlas *layout, nearest *n, alpi_uv_quality *q)
{
    const size_t count = (size_t)n->width * n->height;
    ALPI_TRY_NEW(layout->context, n->triangles, count);
    ALPI_TRY_NEW(layout->context, n->steps, count);
    for (size_t i = 0; i < count; i++) {
        n->triangles[i] = ALPI_NONE;
    }
    ALP_TRY(alpi_raster(layout, 0, 1, note_texels, n));
    spread_nearest(n);
    for (size_t i = 0; i < count; i++) {
        const bool left = i % n->width > 0, right = i % n->width + 1 < n->width;
        const bool below = i + n->width < count;
        for (int k = 0; k < 4; k++) {
            static const int across[4] = {1, -1, 0, 1};
            const bool there =
                (k == 0 || below) && (across[k] <= 0 || right) && (across[k] >= 0 || left);
            if (there) {
                const size_t row = k == 0 ? i : i + n->width;
                look_between(layout, n, i, (size_t)((int64_t)row + across[k]), q);
            }
        }
    }
    return ALP_OK;
}

static alp_result find_gap(const alp_atlas *layout, alpi_uv_quality *q)
{
    nearest n = {.width = layout->info.width, .height = layout->info.height};
    q->free = n.width;
    q->near[0] = q->near[1] = ALPI_NONE;
    const alp_result result = layout->info.charts > 1 ? measure_gaps(layout, &n, q) : ALP_OK;
    alpi_release(layout->context, n.triangles);
    alpi_release(layout->context, n.steps);
    return result;
}

// --- stretch -------------------------------------------------------------------------------------

/// A surface against its own mean density: what is denser as a whole is another matter.
static void measure_surface(const alp_atlas *layout, uint32_t surface, alpi_uv_quality *q)
{
    const alp_scene *scene = layout->scene;
    const alpi_surface *s = &scene->surfaces[surface];
    double world = 0.0, page = 0.0, sum = 0.0, most = -1.0;
    uint32_t worst = ALPI_NONE;
    for (uint32_t t = s->first_triangle; t < s->first_triangle + s->triangle_count; t++) {
        vec3 c[3];
        double p[3][2];
        if (is_placed(layout, t)) {
            const double area = world_area(scene, t, c);
            page_corners(layout, t, p);
            const double stretch = alpi_stretch_of(c, (const double(*)[2])p);
            world += area;
            page += page_area((const double(*)[2])p);
            sum += stretch * stretch * area;
            if (stretch * stretch * area > most) { // the part of the sum that it has
                most = stretch * stretch * area;
                worst = t;
            }
        }
    }
    if (!(world > AREA_SHARE * scene->area) || !(page > 0.0)) {
        return;
    }
    const double mean = sqrt(sum / world * (page / world));
    if (mean > q->stretch) {
        vec3 c[3];
        double p[3][2];
        page_corners(layout, worst, p);
        alpi_triangle_corners(scene, worst, c);
        q->stretch = mean;
        q->stretched = surface;
        q->stretched_worst = worst;
        q->own_stretch = alpi_stretch_of(c, (const double(*)[2])p) * sqrt(page / world);
    }
}

alp_result alpi_uv_set_quality(const alp_atlas *layout, alpi_uv_quality *quality)
{
    *quality = (alpi_uv_quality){
        .tiny_worst = ALPI_NONE, .stretched = ALPI_NONE, .stretched_worst = ALPI_NONE};
    for (uint32_t s = 0; s < layout->scene->surface_count; s++) {
        measure_surface(layout, s, quality);
    }
    ALP_TRY(find_tiny(layout, quality));
    return find_gap(layout, quality);
}
