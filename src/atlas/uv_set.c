// SPDX-License-Identifier: MIT
// A set of texture coordinates of the scene, measured as a place for a bake: what the doctor tells.
#include "atlas/stages.h"

#include "base/memory.h"
#include "scene/adjacency.h"

#include <math.h>

static const float RANGE_MARGIN = 1e-4f;   // as ALP_ATLAS_KEEP has it
static const double COVERAGE_UNIT = 65536; // shares of a texel are added as whole numbers of these,
                                           // so that their order does not matter
static const double DENSITY_SHARE = 0.01;  // of the area: smaller surfaces do not count

typedef struct survey {
    alp_atlas *atlas;
    alpi_uv_set_facts *facts;
    uint32_t *islands; // [height][width] of the texel, ALPI_NONE = free
    uint8_t *overlaps; // [triangle_count] 1: shares a place with another
    uint64_t covered;  // in COVERAGE_UNIT
    uint64_t texels, overlapping, shared;
} survey;

// --- coordinates ---------------------------------------------------------------------------------

static bool surface_has_set(const alp_scene *scene, uint32_t surface, uint32_t set)
{
    return scene->uvs[set] != NULL && scene->surfaces[surface].uv_sets > set;
}

static void count_surfaces(const alp_scene *scene, uint32_t set, alpi_uv_set_facts *facts)
{
    facts->first_missing = ALPI_NONE;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const alpi_surface *surface = &scene->surfaces[s];
        bool usable = false;
        for (uint32_t i = 0; i < surface->triangle_count && !usable; i++) {
            usable = scene->triangle_usable[surface->first_triangle + i];
        }
        if (usable && surface_has_set(scene, s, set)) {
            facts->surfaces++;
        } else if (usable) {
            facts->first_missing = facts->missing_surfaces++ == 0 ? s : facts->first_missing;
        }
    }
}

/// Coordinates as they are, and the triangles that have some on page 0.
static void read_coordinates(alp_atlas *atlas, uint32_t set)
{
    const alp_scene *scene = atlas->scene;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        const bool has =
            scene->triangle_usable[t] && surface_has_set(scene, scene->triangle_surface[t], set);
        atlas->triangle_pages[t] = has ? 0 : ALPI_NONE;
        for (int k = 0; has && k < 6; k++) {
            atlas->corner_uvs[t][k / 2][k % 2] = scene->uvs[set][scene->triangles[t][k / 2]][k % 2];
        }
    }
}

static double area_in_set(const float (*uv)[2])
{
    const double ax = (double)uv[1][0] - (double)uv[0][0], ay = (double)uv[1][1] - (double)uv[0][1];
    const double bx = (double)uv[2][0] - (double)uv[0][0], by = (double)uv[2][1] - (double)uv[0][1];
    return 0.5 * fabs(ax * by - ay * bx);
}

/// Counts triangles that have no place on the page, and takes them off it.
static void judge_triangles(alp_atlas *atlas, alpi_uv_set_facts *facts)
{
    facts->first_outside = facts->first_flat = ALPI_NONE;
    for (uint32_t t = 0; t < atlas->scene->triangle_count; t++) {
        if (atlas->triangle_pages[t] == ALPI_NONE) {
            continue;
        }
        float(*uv)[2] = atlas->corner_uvs[t];
        bool inside = true;
        for (int k = 0; k < 6; k++) { // NaN is outside
            const float value = uv[k / 2][k % 2];
            inside = inside && value >= -RANGE_MARGIN && value <= 1.0f + RANGE_MARGIN;
            uv[k / 2][k % 2] = fminf(fmaxf(value, 0.0f), 1.0f);
        }
        facts->triangles++;
        if (!inside) {
            facts->first_outside = facts->outside++ == 0 ? t : facts->first_outside;
            atlas->triangle_pages[t] = ALPI_NONE;
        } else if (area_in_set((const float(*)[2])uv) == 0.0) {
            facts->first_flat = facts->flat++ == 0 ? t : facts->first_flat;
            atlas->triangle_pages[t] = ALPI_NONE;
        }
    }
}

// --- density -------------------------------------------------------------------------------------

/// Compares the surfaces' √(area in the set / area in the world).
static void compare_densities(const alp_atlas *atlas, alpi_uv_set_facts *facts)
{
    const alp_scene *scene = atlas->scene;
    double least = HUGE_VAL, most = 0.0;
    facts->finest = facts->coarsest = ALPI_NONE;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const alpi_surface *surface = &scene->surfaces[s];
        double world = 0.0, own = 0.0;
        for (uint32_t i = 0; i < surface->triangle_count; i++) {
            const uint32_t t = surface->first_triangle + i;
            if (atlas->triangle_pages[t] != ALPI_NONE) {
                vec3 c[3];
                alpi_triangle_corners(scene, t, c);
                world += vec3_triangle_area(c[0], c[1], c[2]);
                own += area_in_set((const float(*)[2])atlas->corner_uvs[t]);
            }
        }
        if (!(world > DENSITY_SHARE * scene->area) || !(own > 0.0)) {
            continue;
        }
        const double density = sqrt(own / world);
        facts->coarsest = density < least ? s : facts->coarsest;
        facts->finest = density > most ? s : facts->finest;
        least = fmin(least, density);
        most = fmax(most, density);
    }
    facts->density_ratio = most > 0.0 ? most / least : 1.0;
}

// --- texels --------------------------------------------------------------------------------------

static bool are_instances(const alp_scene *scene, uint32_t triangle, uint32_t other)
{
    const uint32_t a = scene->triangle_surface[triangle], b = scene->triangle_surface[other];
    return a != b && scene->surfaces[a].mesh == scene->surfaces[b].mesh &&
           scene->surfaces[a].primitive == scene->surfaces[b].primitive;
}

static alp_result look_at_band(void *user, const alpi_band *band)
{
    survey *s = user;
    uint64_t covered = 0, texels = 0, overlapping = 0, shared = 0;
    for (uint32_t y = band->first_row; y < band->end_row; y++) {
        const uint32_t row = y - band->first_row;
        for (uint32_t x = band->columns[row][0]; x < band->columns[row][1]; x++) {
            const alpi_cell *cell = &band->cells[(size_t)row * band->width + x];
            if (cell->triangle == ALPI_NONE) {
                continue;
            }
            s->islands[(size_t)y * band->width + x] = s->atlas->triangle_charts[cell->triangle];
            covered += (uint64_t)(fmin(cell->coverage, 1.0) * COVERAGE_UNIT);
            texels++;
            if (cell->other != ALPI_NONE) {
                overlapping++;
                shared += are_instances(s->atlas->scene, cell->triangle, cell->other);
                // Other bands may say the same at the same time.
                __atomic_store_n(&s->overlaps[cell->triangle], 1, __ATOMIC_RELAXED);
                __atomic_store_n(&s->overlaps[cell->other], 1, __ATOMIC_RELAXED);
            }
        }
    }
    __atomic_fetch_add(&s->covered, covered, __ATOMIC_RELAXED);
    __atomic_fetch_add(&s->texels, texels, __ATOMIC_RELAXED);
    __atomic_fetch_add(&s->overlapping, overlapping, __ATOMIC_RELAXED);
    __atomic_fetch_add(&s->shared, shared, __ATOMIC_RELAXED);
    return ALP_OK;
}

/// Marks islands that have a texel beside one of another island: a bilinear look-up mixes the two.
static void mark_touching(const survey *s, uint8_t *touching)
{
    static const int32_t steps[4][2] = {{1, 0}, {-1, 1}, {0, 1}, {1, 1}};
    const int32_t width = (int32_t)s->atlas->info.width, height = (int32_t)s->atlas->info.height;
    for (int32_t y = 0; y < height; y++) {
        for (int32_t x = 0; x < width; x++) {
            const uint32_t here = s->islands[(size_t)y * (size_t)width + (size_t)x];
            for (int k = 0; here != ALPI_NONE && k < 4; k++) {
                const int32_t u = x + steps[k][0], v = y + steps[k][1];
                if (u < 0 || u >= width || v >= height) {
                    continue;
                }
                const uint32_t there = s->islands[(size_t)v * (size_t)width + (size_t)u];
                if (there != ALPI_NONE && there != here) {
                    touching[here] = touching[there] = 1;
                }
            }
        }
    }
}

static alp_result look_at_texels(survey *s)
{
    alp_atlas *atlas = s->atlas;
    alpi_uv_set_facts *f = s->facts;
    const size_t texel_count = (size_t)atlas->info.width * atlas->info.height;
    ALPI_TRY_NEW(atlas->context, s->islands, texel_count);
    ALPI_TRY_NEW(atlas->context, s->overlaps, atlas->scene->triangle_count);
    for (size_t i = 0; i < texel_count; i++) {
        s->islands[i] = ALPI_NONE;
    }
    ALP_TRY(alpi_raster(atlas, 0, 1, look_at_band, s));
    uint8_t *touching = ALPI_NEW(atlas->context, uint8_t, atlas->info.charts);
    if (touching == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    mark_touching(s, touching);
    for (uint32_t i = 0; i < atlas->info.charts; i++) {
        f->touching += touching[i];
    }
    alpi_release(atlas->context, touching);
    f->first_overlap = ALPI_NONE;
    for (uint32_t t = 0; t < atlas->scene->triangle_count; t++) {
        if (s->overlaps[t] != 0) {
            f->first_overlap = f->overlapping++ == 0 ? t : f->first_overlap;
        }
    }
    f->islands = atlas->info.charts;
    f->coverage = (double)s->covered / (COVERAGE_UNIT * (double)texel_count);
    f->overlap = s->texels > 0 ? (double)s->overlapping / (double)s->texels : 0.0;
    f->shared = s->overlapping > 0 ? (double)s->shared / (double)s->overlapping : 0.0;
    return ALP_OK;
}

// --- all of it -----------------------------------------------------------------------------------

static alp_result survey_set(survey *s, uint32_t set, const uint32_t (*neighbours)[3])
{
    alp_atlas *atlas = s->atlas;
    const uint32_t count = atlas->scene->triangle_count;
    ALPI_TRY_NEW(atlas->context, atlas->corner_uvs, count);
    ALPI_TRY_NEW(atlas->context, atlas->triangle_pages, count);
    ALPI_TRY_NEW(atlas->context, atlas->triangle_charts, count);
    uint32_t(*own)[3] = NULL;
    count_surfaces(atlas->scene, set, s->facts);
    read_coordinates(atlas, set);
    if (neighbours == NULL) {
        ALP_TRY(alpi_adjacency_create(atlas->scene, &own));
        neighbours = (const uint32_t(*)[3])own;
    }
    alp_result result = alpi_uv_islands(atlas, neighbours);
    alpi_release(atlas->context, own);
    ALP_TRY(result);
    judge_triangles(atlas, s->facts);
    compare_densities(atlas, s->facts);
    return look_at_texels(s);
}

alp_result alpi_uv_set_survey(const alp_scene *scene, uint32_t set, uint32_t size,
                              const uint32_t (*neighbours)[3], alpi_uv_set_facts *facts,
                              alp_atlas **layout)
{
    *facts = (alpi_uv_set_facts){0};
    *layout = NULL;
    alp_atlas *atlas = ALPI_NEW(scene->context, alp_atlas, 1);
    if (atlas == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    atlas->scene = scene;
    atlas->context = scene->context;
    atlas->options = alp_atlas_options_default();
    atlas->info =
        (alp_atlas_info){.mode = ALP_ATLAS_KEEP, .pages = 1, .width = size, .height = size};
    survey s = {.atlas = atlas, .facts = facts};
    const alp_result result = survey_set(&s, set, neighbours);
    alpi_release(scene->context, s.islands);
    alpi_release(scene->context, s.overlaps);
    if (result != ALP_OK) {
        alp_atlas_destroy(atlas);
        return result;
    }
    *layout = atlas;
    return ALP_OK;
}
