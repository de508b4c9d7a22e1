// SPDX-License-Identifier: MIT
// The faces of overlapping charts: which triangles lie in charts of which axes, and the stages run
// over a view of the scene in which each such place is a triangle of its own.
// Based on: I. R. Hafthorsson. Ambient Occlusion Using Ray-tracing and Texture Blending. DTU, 2007,
// chapters 5.4 and 7.5. There clusters end at an angle of their own; here where the weight of their
// axis has nearly gone.
#include "atlas/blend.h"

#include "atlas/factors.h"
#include "atlas/regions.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

// The steepest facet that is still projected: 87° from the axis. A smooth surface has the weight
// cos² 87° = 0.003 there, which is how much of a chart's difference to the next is seen at its end;
// on coarse meshes, whose corners turn away from their facets, up to .2 where less than that are
// taken. It costs next to nothing: as steep a facet has a twentieth of its area on the page, and is
// as coarse there, but the other charts bear the weight. Mean step over the ends of charts in
// builtin:teapot-room at 512²: at 80° .42 % of the map's mean, at 84° .30, at 87° .17, at 88° .19.
static const float LEAST_COSINE = 0.05233596f;
// Below this weight at all corners nobody sees the axis: a step of a whole 255 is one of 1.
static const float LEAST_WEIGHT = 1.0f / 255.0f;

static const uint8_t NO_AXIS = ALPI_BLEND_SETS;

// --- faces ---------------------------------------------------------------------------------------

typedef struct builder {
    alp_atlas *atlas;
    const alp_scene *scene;
    const uint32_t (*neighbours)[3]; // of triangles
    uint32_t (*of_axis)[3];          // [triangle_count] face of each axis, ALPI_NONE = none
    uint8_t *strongest;              // [triangle_count] axis of face t, NO_AXIS: unusable
    alpi_blend_faces faces;
    size_t face_capacity;
    alp_scene view; // owns triangles, triangle_surface and triangle_usable
} builder;

/// Cosines of a triangle's plane to the axes, and the largest weight that each has at its corners.
static void measure_triangle(const builder *b, uint32_t triangle, float cosines[3],
                             float weights[3])
{
    const alp_scene *scene = b->scene;
    const alpi_surface *surface = &scene->surfaces[scene->triangle_surface[triangle]];
    vec3 corners[3], axes[3];
    alpi_triangle_corners(scene, triangle, corners);
    alpi_surface_axes(surface, b->atlas->world_axes, axes);
    const vec3 n =
        vec3_triangle_normal(corners[0], corners[1], corners[2], (vec3){0.0f, 1.0f, 0.0f});
    for (int k = 0; k < 3; k++) {
        cosines[k] = vec3_dot(n, axes[k]);
        weights[k] = 0.0f;
    }
    for (int corner = 0; corner < 3; corner++) {
        float at[3];
        alpi_blend_weights(b->atlas, triangle, corner == 1, corner == 2, at);
        for (int k = 0; k < 3; k++) {
            weights[k] = fmaxf(weights[k], at[k]);
        }
    }
}

static alp_result add_face(builder *b, uint32_t triangle, uint8_t axis, float cosine)
{
    ALP_TRY(alpi_grow(b->scene->context, (void **)&b->faces.faces, &b->face_capacity,
                      (size_t)b->faces.count + 1, sizeof *b->faces.faces));
    b->of_axis[triangle][axis] = b->faces.count;
    b->faces.faces[b->faces.count++] =
        (alpi_blend_face){triangle, axis, cosine < 0.0f, fabsf(cosine)};
    return ALP_OK;
}

/// One face of each triangle, of its strongest axis, in their order; unusable ones have no axis.
static alp_result add_first_faces(builder *b)
{
    const alp_scene *scene = b->scene;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        b->of_axis[t][0] = b->of_axis[t][1] = b->of_axis[t][2] = ALPI_NONE;
        float cosines[3] = {0.0f, 0.0f, 0.0f}, weights[3];
        uint8_t axis = 0;
        if (scene->triangle_usable[t]) {
            measure_triangle(b, t, cosines, weights);
            axis = fabsf(cosines[1]) > fabsf(cosines[0]) ? 1 : 0;
            axis = fabsf(cosines[2]) > fabsf(cosines[axis]) ? 2 : axis;
        }
        b->strongest[t] = scene->triangle_usable[t] ? axis : NO_AXIS;
        ALP_TRY(add_face(b, t, axis, cosines[axis]));
    }
    return ALP_OK;
}

static alp_result add_further_faces(builder *b)
{
    const alp_scene *scene = b->scene;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        if (!scene->triangle_usable[t]) {
            continue;
        }
        float cosines[3], weights[3];
        measure_triangle(b, t, cosines, weights);
        for (uint8_t k = 0; k < 3; k++) {
            if (k != b->strongest[t] && fabsf(cosines[k]) >= LEAST_COSINE &&
                weights[k] >= LEAST_WEIGHT) {
                ALP_TRY(add_face(b, t, k, cosines[k]));
            }
        }
        if (b->faces.count > ALPI_NONE - 3) {
            return alpi_fail(scene->context, ALP_ERROR_LIMIT,
                             "%s: %u triangles are too many for --atlas blend; use --atlas charts",
                             scene->name, scene->triangle_count);
        }
    }
    return ALP_OK;
}

static alp_result find_face_neighbours(builder *b)
{
    const uint32_t count = b->faces.count;
    ALPI_TRY_NEW(b->scene->context, b->faces.neighbours, count);
    for (uint32_t f = 0; f < count; f++) {
        const alpi_blend_face *face = &b->faces.faces[f];
        for (int k = 0; k < 3; k++) {
            const uint32_t across = b->neighbours[face->triangle][k];
            uint32_t other = ALPI_NONE;
            if (across != ALPI_NONE && b->strongest[across] != NO_AXIS &&
                alpi_share_node(b->scene, face->triangle, across)) {
                other = b->of_axis[across][face->axis];
            }
            const bool joined =
                other != ALPI_NONE && b->faces.faces[other].negative == face->negative;
            b->faces.neighbours[f][k] = joined ? other : ALPI_NONE;
        }
    }
    return ALP_OK;
}

/// The scene in which every face is a triangle.
static alp_result make_view(builder *b)
{
    const alp_scene *scene = b->scene;
    alp_scene *view = &b->view;
    const uint32_t count = b->faces.count;
    *view = *scene;
    view->triangles = NULL;
    view->triangle_surface = NULL;
    view->triangle_usable = NULL;
    view->triangle_count = count;
    view->usable_count = 0;
    view->area = 0.0;
    ALPI_TRY_NEW(scene->context, view->triangles, count);
    ALPI_TRY_NEW(scene->context, view->triangle_surface, count);
    ALPI_TRY_NEW(scene->context, view->triangle_usable, count);
    for (uint32_t f = 0; f < count; f++) {
        const uint32_t t = b->faces.faces[f].triangle;
        memcpy(view->triangles[f], scene->triangles[t], sizeof view->triangles[f]);
        view->triangle_surface[f] = scene->triangle_surface[t];
        view->triangle_usable[f] = scene->triangle_usable[t];
        if (scene->triangle_usable[t]) {
            vec3 c[3];
            alpi_triangle_corners(scene, t, c);
            view->area += vec3_triangle_area(c[0], c[1], c[2]);
            view->usable_count++;
        }
    }
    return ALP_OK;
}

// --- stages --------------------------------------------------------------------------------------

/// Arrays of triangles become arrays of faces.
static alp_result make_room(builder *b)
{
    alp_atlas *atlas = b->atlas;
    alpi_release(atlas->context, atlas->corner_uvs);
    alpi_release(atlas->context, atlas->triangle_pages);
    alpi_release(atlas->context, atlas->triangle_charts);
    atlas->corner_uvs = NULL;
    atlas->triangle_pages = atlas->triangle_charts = NULL;
    ALPI_TRY_NEW(atlas->context, atlas->corner_uvs, b->faces.count);
    ALPI_TRY_NEW(atlas->context, atlas->triangle_pages, b->faces.count);
    ALPI_TRY_NEW(atlas->context, atlas->triangle_charts, b->faces.count);
    ALPI_TRY_NEW(atlas->context, atlas->set_uvs, b->scene->triangle_count);
    ALPI_TRY_NEW(atlas->context, atlas->set_members, b->scene->triangle_count);
    ALPI_TRY_NEW(atlas->context, atlas->face_triangles, b->faces.count);
    ALPI_TRY_NEW(atlas->context, atlas->face_axes, b->faces.count);
    return ALP_OK;
}

static alp_result lay_out(builder *b, alpi_atlas_clock *clock)
{
    alp_atlas *atlas = b->atlas;
    alpi_clusters clusters;
    ALP_TRY(alpi_blend_clusters(&b->view, &b->faces, atlas->world_axes, clock, &clusters));
    alpi_charts charts;
    const uint32_t(*neighbours)[3] = (const uint32_t(*)[3])b->faces.neighbours;
    alp_result result = alpi_charts_create(atlas, neighbours, &clusters, &charts);
    alpi_clusters_destroy(atlas->context, &clusters);
    if (result == ALP_OK) {
        charts.blend = &b->faces;
        alpi_factors_apply(atlas, &charts);
        result = alpi_layout(atlas, neighbours, &charts, clock);
    }
    atlas->info.mode = ALP_ATLAS_BLEND;
    atlas->info.charts = charts.count;
    alpi_charts_destroy(atlas->context, &charts);
    return result == ALP_OK ? alpi_measure(atlas, NULL) : result;
}

/// Notes which sets a triangle is in: those whose chart lies on the page of its strongest axis,
/// since a material has one map (see alpi_blend_groups).
static void name_members(builder *b)
{
    alp_atlas *atlas = b->atlas;
    for (uint32_t t = 0; t < b->scene->triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            const uint32_t face = b->of_axis[t][k];
            if (b->strongest[t] != NO_AXIS && face != ALPI_NONE &&
                atlas->triangle_pages[face] == atlas->triangle_pages[t]) {
                atlas->set_members[t] |= (uint8_t)(1u << k);
                memcpy(atlas->set_uvs[t][k], atlas->corner_uvs[face], sizeof atlas->set_uvs[t][k]);
            }
        }
    }
}

/// Triangles that no texel lies on, in none of their charts; of more texels than are kept at hand,
/// what was counted of faces stands.
static alp_result count_shared(builder *b)
{
    alp_atlas *atlas = b->atlas;
    const alpi_texels *texels = atlas->texels;
    if (texels == NULL) {
        return ALP_OK;
    }
    bool *owns = ALPI_NEW(atlas->context, bool, b->scene->triangle_count);
    if (owns == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < texels->count; i++) {
        owns[atlas->face_triangles[texels->triangles[i]]] = true; // faces as yet
    }
    atlas->info.shared_triangles = 0;
    for (uint32_t t = 0; t < b->scene->triangle_count; t++) {
        atlas->info.shared_triangles += b->scene->triangle_usable[t] && !owns[t];
    }
    alpi_release(atlas->context, owns);
    return ALP_OK;
}

static alp_result build(builder *b, alpi_atlas_clock *clock)
{
    alp_context *context = b->scene->context;
    ALPI_TRY_NEW(context, b->of_axis, b->scene->triangle_count);
    ALPI_TRY_NEW(context, b->strongest, b->scene->triangle_count);
    ALP_TRY(add_first_faces(b));
    ALP_TRY(add_further_faces(b));
    ALP_TRY(find_face_neighbours(b));
    ALP_TRY(make_view(b));
    ALP_TRY(make_room(b));
    uint32_t *triangles = b->atlas->face_triangles;
    b->atlas->face_triangles = NULL; // to the stages faces are triangles
    b->atlas->scene = &b->view;
    const alp_result result = lay_out(b, clock);
    b->atlas->scene = b->scene;
    b->atlas->face_triangles = triangles;
    b->atlas->face_count = b->faces.count;
    for (uint32_t f = 0; f < b->faces.count; f++) {
        triangles[f] = b->faces.faces[f].triangle;
        b->atlas->face_axes[f] = b->faces.faces[f].axis;
    }
    ALP_TRY(result);
    name_members(b);
    return count_shared(b);
}

alp_result alpi_blend_build(alp_atlas *atlas, const uint32_t (*neighbours)[3],
                            alpi_atlas_clock *clock)
{
    builder b = {.atlas = atlas, .scene = atlas->scene, .neighbours = neighbours};
    const alp_result result = build(&b, clock);
    alpi_release(atlas->context, b.of_axis);
    alpi_release(atlas->context, b.strongest);
    alpi_release(atlas->context, b.faces.faces);
    alpi_release(atlas->context, b.faces.neighbours);
    if (b.view.context != NULL) { // else it is not made: all is the scene's
        alpi_release(atlas->context, b.view.triangles);
        alpi_release(atlas->context, b.view.triangle_surface);
        alpi_release(atlas->context, b.view.triangle_usable);
    }
    return result;
}

void alpi_blend_fill_sets(alp_atlas *atlas)
{
    for (uint32_t t = 0; t < atlas->scene->triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            if ((atlas->set_members[t] >> k & 1u) == 0) {
                memcpy(atlas->set_uvs[t][k], atlas->corner_uvs[t], sizeof atlas->set_uvs[t][k]);
            }
        }
    }
}
