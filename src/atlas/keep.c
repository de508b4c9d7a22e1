// SPDX-License-Identifier: MIT
// The scene's own second UV set as an atlas: checked before it is trusted.
#include "atlas/stages.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { NAMED_LIMIT = 4 };                // triangles that a message names
static const float RANGE_MARGIN = 1e-4f; // coordinates this far outside [0, 1] are clamped
static const float SAME_UV = 1e-6f;      // corners this near are one point of an island

/// The first triangles with a fault, and how many there are.
typedef struct fault_list {
    const alp_scene *scene;
    uint8_t *seen;    // [triangles] 1 = counted already; NULL = each comes once anyway
    uint32_t surface; // of the first one
    uint32_t count;   // on that surface
    uint32_t total;
    size_t used;
    char text[160];
} fault_list;

/// Whether two surfaces are one primitive placed by two nodes: then they share coordinates too.
static bool shares_mesh(const alp_scene *scene, uint32_t a, uint32_t b)
{
    return scene->surfaces[a].mesh == scene->surfaces[b].mesh &&
           scene->surfaces[a].primitive == scene->surfaces[b].primitive;
}

static void add_fault(fault_list *list, uint32_t triangle, uint32_t other)
{
    uint32_t surface = list->scene->triangle_surface[triangle];
    if (list->seen != NULL && list->seen[triangle]++ != 0) {
        list->seen[triangle] = 1;
        return;
    }
    if (list->total++ == 0) {
        list->surface = surface;
    }
    if (surface != list->surface || ++list->count > NAMED_LIMIT) {
        return;
    }
    char *at = list->text + list->used;
    size_t room = sizeof list->text - list->used;
    const char *comma = list->count > 1 ? ", " : "";
    uint32_t index = triangle - list->scene->surfaces[surface].first_triangle;
    int length;
    if (other == ALPI_NONE) {
        length = snprintf(at, room, "%s%u", comma, index);
    } else {
        uint32_t with = list->scene->triangle_surface[other];
        length = snprintf(at, room, "%s%u with %u%s", comma, index,
                          other - list->scene->surfaces[with].first_triangle,
                          with == surface                           ? ""
                          : shares_mesh(list->scene, with, surface) ? " of another node of its mesh"
                                                                    : " of another surface");
    }
    list->used += length > 0 && (size_t)length < room ? (size_t)length : 0;
}

static alp_result tell(const fault_list *list, const char *fault, char **reason)
{
    const alp_scene *scene = list->scene;
    *reason =
        alpi_format(scene->context,
                    "%s: %s: %s cannot hold a bake: %s: %u triangle%s, such as %s%s; "
                    "use --atlas charts",
                    scene->name, scene->surfaces[list->surface].name, alpi_scene_second_set(scene),
                    fault, list->total, list->total == 1 ? "" : "s", list->text,
                    list->count > NAMED_LIMIT ? ", …" : "");
    return *reason == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_ERROR_INVALID_DATA;
}

/// Every surface with something to bake has the set.
static alp_result check_presence(const alp_scene *scene, char **reason)
{
    fault_list list = {.scene = scene};
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        if (scene->triangle_usable[t] &&
            (scene->uvs[1] == NULL || scene->surfaces[scene->triangle_surface[t]].uv_sets < 2)) {
            add_fault(&list, t, ALPI_NONE);
        }
    }
    return list.total == 0 ? ALP_OK : tell(&list, "the set is missing", reason);
}

/// Copies the coordinates, finite and in [0, 1].
static alp_result copy_coordinates(alp_atlas *atlas, char **reason)
{
    const alp_scene *scene = atlas->scene;
    fault_list outside = {.scene = scene}, flat = {.scene = scene};
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        if (!scene->triangle_usable[t]) {
            continue;
        }
        float(*uv)[2] = atlas->corner_uvs[t];
        bool in_range = true;
        for (int k = 0; k < 6; k++) {
            float value = scene->uvs[1][scene->triangles[t][k / 2]][k % 2];
            in_range = in_range && value >= -RANGE_MARGIN && value <= 1.0f + RANGE_MARGIN;
            uv[k / 2][k % 2] = fminf(fmaxf(value, 0.0f), 1.0f); // NaN → 0
        }
        double ax = (double)uv[1][0] - (double)uv[0][0], ay = (double)uv[1][1] - (double)uv[0][1];
        double bx = (double)uv[2][0] - (double)uv[0][0], by = (double)uv[2][1] - (double)uv[0][1];
        if (!in_range) {
            add_fault(&outside, t, ALPI_NONE);
        } else if (ax * by - ay * bx == 0.0) {
            add_fault(&flat, t, ALPI_NONE);
        }
    }
    if (outside.total > 0) {
        return tell(&outside, "coordinates outside [0, 1]", reason);
    }
    return flat.total > 0 ? tell(&flat, "no area in the set", reason) : ALP_OK;
}

// --- islands -------------------------------------------------------------------------------------

static bool same_uv(const float a[2], const float b[2])
{
    return fabsf(a[0] - b[0]) <= SAME_UV && fabsf(a[1] - b[1]) <= SAME_UV;
}

/// Whether the edge after corner k of a triangle has the same coordinates in its neighbour.
static bool joined_in_uv(const alp_atlas *atlas, const uint32_t (*neighbours)[3], uint32_t triangle,
                         int k)
{
    uint32_t across = neighbours[triangle][k];
    const float(*a)[2] = (const float(*)[2])atlas->corner_uvs[triangle];
    const float(*b)[2] = (const float(*)[2])atlas->corner_uvs[across];
    for (int j = 0; j < 3; j++) {
        if (same_uv(a[k], b[(j + 1) % 3]) && same_uv(a[(k + 1) % 3], b[j])) {
            return true;
        }
    }
    return false;
}

static void flood_island(alp_atlas *atlas, const uint32_t (*neighbours)[3], uint32_t from,
                         uint32_t *queue)
{
    uint32_t island = atlas->info.charts++, count = 0;
    atlas->triangle_charts[from] = island;
    queue[count++] = from;
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            uint32_t across = neighbours[queue[i]][k];
            if (across != ALPI_NONE && atlas->triangle_pages[across] != ALPI_NONE &&
                atlas->triangle_charts[across] == ALPI_NONE &&
                joined_in_uv(atlas, neighbours, queue[i], k)) {
                atlas->triangle_charts[across] = island;
                queue[count++] = across;
            }
        }
    }
}

alp_result alpi_uv_islands(alp_atlas *atlas, const uint32_t (*neighbours)[3])
{
    const alp_scene *scene = atlas->scene;
    uint32_t *queue = ALPI_NEW(atlas->context, uint32_t, scene->usable_count);
    if (queue == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    atlas->info.charts = 0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        atlas->triangle_charts[t] = ALPI_NONE;
    }
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        if (scene->triangle_usable[t] && atlas->triangle_pages[t] != ALPI_NONE &&
            atlas->triangle_charts[t] == ALPI_NONE) {
            flood_island(atlas, neighbours, t, queue);
        }
    }
    alpi_release(atlas->context, queue);
    return ALP_OK;
}

/// Share of the covered texels up to which a bake with KEEP goes on.
static const double MOST_SHARED = 0.01;

/// Percentage of the covered texels that triangles share.
static double shared_percent(const alp_atlas *atlas)
{
    return 100.0 * (double)atlas->info.overlapping_texels / (double)atlas->info.texels;
}

static bool are_few(const alp_atlas *atlas)
{
    return atlas->options.mode == ALP_ATLAS_KEEP &&
           (double)atlas->info.overlapping_texels <= MOST_SHARED * (double)atlas->info.texels;
}

static alp_result tell_overlaps(const alp_atlas *atlas, const fault_list *list, char **reason)
{
    char fault[128];
    int length = snprintf(fault, sizeof fault, "triangles overlap in it, on %.3g %% of its texels",
                          shared_percent(atlas));
    if (atlas->options.mode == ALP_ATLAS_KEEP && length > 0 && (size_t)length < sizeof fault) {
        snprintf(fault + length, sizeof fault - (size_t)length, ", above the limit of %g %%",
                 100.0 * MOST_SHARED);
    }
    return tell(list, fault, reason);
}

static void warn_of_few(const alp_atlas *atlas, const fault_list *list)
{
    const alp_scene *scene = atlas->scene;
    alpi_warn(scene->context, "kept-overlap", scene->surfaces[list->surface].name,
              "%u triangle%s with others in %s, on %.2g %% of its texels, such as %s%s: they have "
              "each other's values there; use --atlas charts for "
              "maps without overlaps",
              list->total, list->total == 1 ? " overlaps" : "s overlap",
              alpi_scene_second_set(scene), shared_percent(atlas), list->text,
              list->count > NAMED_LIMIT ? ", …" : "");
}

/// Measures the atlas and looks for triangles that share a place.
static alp_result check_overlaps(alp_atlas *atlas, char **reason)
{
    fault_list list = {.scene = atlas->scene};
    alpi_overlaps overlaps = {0};
    ALPI_TRY_NEW(atlas->context, list.seen, atlas->scene->triangle_count);
    alp_result result = alpi_measure(atlas, &overlaps);
    for (uint32_t i = 0; result == ALP_OK && i < overlaps.count; i++) {
        add_fault(&list, overlaps.pairs[i].triangle, overlaps.pairs[i].other);
    }
    alpi_release(atlas->context, overlaps.pairs);
    alpi_release(atlas->context, list.seen);
    ALP_TRY(result);
    if (list.total > 0 && are_few(atlas)) {
        warn_of_few(atlas, &list);
        return ALP_OK;
    }
    return list.total == 0 ? ALP_OK : tell_overlaps(atlas, &list, reason);
}

alp_result alpi_keep(alp_atlas *atlas, const uint32_t (*neighbours)[3], char **reason)
{
    *reason = NULL;
    ALP_TRY(check_presence(atlas->scene, reason));
    ALP_TRY(copy_coordinates(atlas, reason));
    memset(atlas->triangle_pages, 0, atlas->scene->triangle_count * sizeof *atlas->triangle_pages);
    ALP_TRY(alpi_uv_islands(atlas, neighbours));
    atlas->info.mode = ALP_ATLAS_KEEP;
    atlas->info.pages = 1;
    return check_overlaps(atlas, reason);
}
