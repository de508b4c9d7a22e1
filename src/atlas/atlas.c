// SPDX-License-Identifier: MIT
// Making an atlas: the stages in a row, and the questions one can ask it.
#include "atlas/blend.h"
#include "atlas/choice.h"
#include "atlas/factors.h"
#include "atlas/repeats.h"
#include "atlas/stages.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "scene/adjacency.h"

#include <math.h>

alp_atlas_options alp_atlas_options_default(void)
{
    return (alp_atlas_options){.struct_size = sizeof(alp_atlas_options),
                               .mode = ALP_ATLAS_AUTO,
                               .size = 1024,
                               .padding = 2,
                               .block = 1,
                               .max_angle = (float)(ALPI_PI / 4.0)};
}

static alp_result check_gaps(alp_context *context, const alp_atlas_options *o)
{
    if (o->block < 1 || o->block > ALPI_ATLAS_BLOCK_LIMIT) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "blocks of %u texels: must be in [1, %d]", o->block,
                         ALPI_ATLAS_BLOCK_LIMIT);
    }
    if (o->mips > ALPI_ATLAS_MIPS_LIMIT) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT, "%u mip levels: must be in [0, %d]",
                         o->mips, ALPI_ATLAS_MIPS_LIMIT);
    }
    if (o->size % (1u << o->mips) != 0) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "%u mip levels of a page of %u texels: the size must be a multiple of %u",
                         o->mips, o->size, 1u << o->mips);
    }
    if (o->mode == ALP_ATLAS_KEEP && (o->block > 1 || o->mips > 0 || o->densities != NULL)) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "kept coordinates cannot have %s; make new charts",
                         o->densities != NULL ? "other densities"
                         : o->mips > 0        ? "gaps for mip levels"
                                              : "gaps for blocks");
    }
    return ALP_OK;
}

alp_result alpi_atlas_check(const alp_scene *scene, const alp_atlas_options *o)
{
    alp_context *context = scene->context;
    const bool known = o->mode == ALP_ATLAS_AUTO || o->mode == ALP_ATLAS_KEEP ||
                       o->mode == ALP_ATLAS_CHARTS || o->mode == ALP_ATLAS_BLEND;
    if (o->struct_size != sizeof *o || !known) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "atlas options must come from alp_atlas_options_default()");
    }
    if (o->size < 1 || o->size > ALPI_ATLAS_SIZE_LIMIT) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "a page of %u texels: the size must be in [1, %d]", o->size,
                         ALPI_ATLAS_SIZE_LIMIT);
    }
    if (!(o->texels_per_metre >= 0.0) || !isfinite(o->texels_per_metre)) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "%g texels per metre: must be positive, or 0 to fill one page",
                         o->texels_per_metre);
    }
    if (o->padding > ALPI_ATLAS_PADDING_LIMIT) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "padding of %u texels: must be in [0, %d]", o->padding,
                         ALPI_ATLAS_PADDING_LIMIT);
    }
    ALP_TRY(check_gaps(context, o));
    if (!(o->max_angle > 0.0f && o->max_angle <= 1.2f)) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "a chart angle of %g radians: must be in (0, 1.2]", (double)o->max_angle);
    }
    return ALP_OK;
}

/// The first usable triangle in [begin, end), or ALPI_NONE.
static uint32_t first_usable(const alp_scene *scene, uint32_t begin, uint32_t end)
{
    while (begin < end && !scene->triangle_usable[begin]) {
        begin++;
    }
    return begin < end ? begin : ALPI_NONE;
}

static void place_at_middle(alp_atlas *atlas, uint32_t triangle, uint32_t from)
{
    const float(*uv)[2] = (const float(*)[2])atlas->corner_uvs[from];
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 2; i++) {
            atlas->corner_uvs[triangle][k][i] = (uv[0][i] + uv[1][i] + uv[2][i]) / 3.0f;
        }
    }
    atlas->triangle_pages[triangle] = atlas->triangle_pages[from];
    atlas->triangle_charts[triangle] = ALPI_NONE;
}

/// Gives every unusable triangle a point of the page, so that no coordinate is left undefined: the
/// middle of the nearest usable triangle before it on its surface, else of the surface's first;
/// where the surface has none, of the nearest before it in the scene, else of the scene's first.
/// Linear in triangles.
static void place_unusable(alp_atlas *atlas)
{
    const alp_scene *scene = atlas->scene;
    uint32_t nearest = first_usable(scene, 0, scene->triangle_count); // there is one
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        uint32_t begin = scene->surfaces[s].first_triangle;
        uint32_t end = begin + scene->surfaces[s].triangle_count;
        uint32_t own = first_usable(scene, begin, end);
        nearest = own != ALPI_NONE ? own : nearest;
        for (uint32_t t = begin; t < end; t++) {
            if (scene->triangle_usable[t]) {
                nearest = t;
            } else {
                place_at_middle(atlas, t, nearest);
            }
        }
    }
}

/// Clusters and charts of what is usable in `view`.
static alp_result chart_view(alp_atlas *atlas, const alp_scene *view,
                             const uint32_t (*neighbours)[3], alpi_atlas_clock *clock,
                             alpi_charts *charts)
{
    alpi_clusters clusters;
    ALP_TRY(alpi_clusters_create(view, neighbours, atlas->options.max_angle, clock, &clusters));
    const alp_scene *scene = atlas->scene;
    atlas->scene = view;
    alp_result result = alpi_charts_create(atlas, neighbours, &clusters, charts);
    result = result == ALP_OK ? alpi_charts_merge(atlas, neighbours, charts) : result;
    atlas->scene = scene;
    alpi_clusters_destroy(atlas->context, &clusters);
    return result;
}

/// Charts of all: those of meshes that are repeated are made once and copied.
static alp_result chart_all(alp_atlas *atlas, const uint32_t (*neighbours)[3],
                            alpi_atlas_clock *clock, alpi_charts *charts)
{
    alpi_repeats repeats;
    ALP_TRY(alpi_repeats_create(atlas->scene, &repeats));
    alp_result result;
    if (repeats.count == 0) {
        result = chart_view(atlas, atlas->scene, neighbours, clock, charts);
    } else {
        alp_scene view;
        result = alpi_repeats_view(atlas->scene, &repeats, &view);
        result = result == ALP_OK ? chart_view(atlas, &view, neighbours, clock, charts) : result;
        alpi_release(atlas->context, view.triangle_usable);
        result = result == ALP_OK ? alpi_repeats_copy(atlas, &repeats, charts) : result;
    }
    alpi_repeats_destroy(atlas->context, &repeats);
    return result;
}

static alp_result make_charts(alp_atlas *atlas, const uint32_t (*neighbours)[3],
                              alpi_atlas_clock *clock)
{
    alpi_charts charts = {0};
    alp_result result = chart_all(atlas, neighbours, clock, &charts);
    if (result == ALP_OK) {
        alpi_factors_apply(atlas, &charts);
        result = alpi_layout(atlas, neighbours, &charts, clock);
    }
    if (result == ALP_OK) {
        alpi_widen_slivers(atlas);
    }
    atlas->info.mode = ALP_ATLAS_CHARTS;
    atlas->info.charts = charts.count;
    alpi_charts_destroy(atlas->context, &charts);
    return result;
}

static void drop_texels(alp_atlas *atlas)
{
    if (atlas->texels != NULL) {
        alpi_texels_destroy(atlas->context, atlas->texels);
        alpi_release(atlas->context, atlas->texels);
        atlas->texels = NULL;
    }
}

/// Keeps the second UV set where the mode asks for it and it can hold a bake, else makes charts;
/// and measures what came out.
static alp_result choose(alp_atlas *atlas, const uint32_t (*neighbours)[3], alpi_atlas_clock *clock)
{
    alp_atlas_mode mode = atlas->options.mode;
    if (mode == ALP_ATLAS_BLEND) {
        return alpi_blend_build(atlas, neighbours, clock);
    }
    if (alpi_atlas_may_keep(&atlas->options) &&
        (mode == ALP_ATLAS_KEEP ||
         (atlas->scene->uvs[1] != NULL && !alpi_scene_set_is_blended(atlas->scene, 1)))) {
        char *reason = NULL;
        alp_result result = alpi_keep(atlas, neighbours, &reason);
        if (result == ALP_ERROR_INVALID_DATA && mode == ALP_ATLAS_KEEP) {
            alpi_fail(atlas->context, result, "%s", reason);
        } else if (result == ALP_ERROR_INVALID_DATA) {
            alpi_note(atlas->context, "atlas-charts", NULL, "%s: charts are made", reason);
        }
        alpi_release(atlas->context, reason);
        if (result != ALP_ERROR_INVALID_DATA || mode == ALP_ATLAS_KEEP) {
            return result;
        }
        drop_texels(atlas);
    }
    ALP_TRY(make_charts(atlas, neighbours, clock));
    return alpi_measure(atlas, NULL);
}

static alp_result build(alp_atlas *atlas)
{
    const alp_scene *scene = atlas->scene;
    alpi_atlas_clock clock = {.context = atlas->context,
                              .callback = atlas->options.progress,
                              .user = atlas->options.progress_user};
    ALPI_TRY_NEW(atlas->context, atlas->corner_uvs, scene->triangle_count);
    ALPI_TRY_NEW(atlas->context, atlas->triangle_pages, scene->triangle_count);
    ALPI_TRY_NEW(atlas->context, atlas->triangle_charts, scene->triangle_count);
    ALP_TRY(alpi_factors_create(scene, atlas->options.densities, &atlas->factors));
    ALP_TRY(alpi_atlas_tick(&clock, "atlas", 0, scene->triangle_count));
    uint32_t(*neighbours)[3] = NULL;
    ALP_TRY(alpi_adjacency_create(scene, &neighbours));
    alpi_factors_part(scene, atlas->factors, neighbours);
    alp_result result = choose(atlas, (const uint32_t(*)[3])neighbours, &clock);
    alpi_release(atlas->context, neighbours);
    ALP_TRY(result);
    place_unusable(atlas);
    if (atlas->set_uvs != NULL) {
        alpi_blend_fill_sets(atlas);
    }
    if (atlas->info.shared_triangles > 0) {
        alpi_note(atlas->context, "tiny-triangles", scene->name,
                  "%u of %u triangles are smaller than a texel: they share the texels of their "
                  "neighbours",
                  atlas->info.shared_triangles, scene->usable_count);
    }
    return ALP_OK;
}

/// Builds an atlas of what is usable in `view`, and makes it one of `scene`.
static alp_result create_from_view(const alp_scene *scene, const alp_scene *view,
                                   const alp_atlas_options *options, bool world_axes,
                                   alp_atlas **atlas)
{
    if (view->usable_count == 0) {
        return alpi_fail(scene->context, ALP_ERROR_INVALID_DATA,
                         "%s: nothing to bake: no triangle%s has an area", scene->name,
                         scene->usable_count > 0 ? " of the chosen surfaces" : "");
    }
    alp_atlas *made = ALPI_NEW(scene->context, alp_atlas, 1);
    if (made == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    made->scene = view;
    made->context = scene->context;
    made->options = *options;
    made->world_axes = world_axes;
    made->info.width = made->info.height = options->size;
    alpi_watch former = alpi_set_watch(
        made->context, (alpi_watch){.callback = options->progress, .user = options->progress_user});
    alp_result result = build(made);
    alpi_set_watch(made->context, former);
    made->scene = scene;
    if (result != ALP_OK) {
        alp_atlas_destroy(made);
        return result;
    }
    *atlas = made;
    return ALP_OK;
}

alp_result alpi_atlas_create(const alp_scene *scene, const alp_atlas_options *options,
                             const alpi_atlas_choice *choice, alp_atlas **atlas)
{
    *atlas = NULL;
    alp_atlas_options chosen = options != NULL ? *options : alp_atlas_options_default();
    ALP_TRY(alpi_atlas_check(scene, &chosen));
    if (choice == NULL) {
        return create_from_view(scene, scene, &chosen, false, atlas);
    }
    alp_scene view;
    ALP_TRY(alpi_choice_view(scene, choice, &view));
    alp_result result = create_from_view(scene, &view, &chosen, choice->world_axes, atlas);
    alpi_choice_end(&view);
    if (result == ALP_OK) {
        alpi_choice_share(*atlas, choice);
    }
    return result;
}

alp_result alp_atlas_create(const alp_scene *scene, const alp_atlas_options *options,
                            alp_atlas **atlas)
{
    if (atlas == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *atlas = NULL;
    return scene == NULL ? ALP_ERROR_INVALID_ARGUMENT
                         : alpi_atlas_create(scene, options, NULL, atlas);
}

void alp_atlas_destroy(alp_atlas *atlas)
{
    if (atlas != NULL) {
        alp_context *context = atlas->context;
        drop_texels(atlas);
        alpi_release(context, atlas->corner_uvs);
        alpi_release(context, atlas->triangle_pages);
        alpi_release(context, atlas->triangle_charts);
        alpi_release(context, atlas->factors);
        alpi_release(context, atlas->face_triangles);
        alpi_release(context, atlas->face_axes);
        alpi_release(context, atlas->set_uvs);
        alpi_release(context, atlas->set_members);
        alpi_release(context, atlas);
    }
}

alp_atlas_info alp_atlas_get_info(const alp_atlas *atlas)
{
    return atlas ? atlas->info : (alp_atlas_info){0};
}

const float *alp_atlas_corner_uvs(const alp_atlas *atlas)
{
    return atlas == NULL ? NULL : &atlas->corner_uvs[0][0][0];
}

const uint32_t *alp_atlas_triangle_pages(const alp_atlas *atlas)
{
    return atlas == NULL ? NULL : atlas->triangle_pages;
}

const float *alp_atlas_blend_uvs(const alp_atlas *atlas)
{
    return atlas == NULL || atlas->set_uvs == NULL ? NULL : &atlas->set_uvs[0][0][0][0];
}
