// SPDX-License-Identifier: MIT
// Charts of a mesh are made once; what repeats it gets copies. That saves time, and where a mesh
// stands twice, it is cut at the same places.
#include "atlas/repeats.h"
#include "scene/select.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

// Edges may differ by this share of their length, and by some roundings of their coordinates.
static const double SAME_LENGTH = 1e-4, SAME_PLACE = 4.0 * 0x1p-23;

/// A surface that repeats another; those of one node in one instance come after each other.
typedef struct repeat {
    uint32_t node, instance, surface;
} repeat;

static int compare_repeats(const void *left, const void *right)
{
    const repeat *a = left, *b = right;
    if (a->node != b->node) {
        return a->node < b->node ? -1 : 1;
    }
    if (a->instance != b->instance) {
        return a->instance < b->instance ? -1 : 1;
    }
    return a->surface < b->surface ? -1 : 1;
}

/// The repeats, sorted; `list` has room for all surfaces.
static uint32_t list_repeats(const alp_scene *scene, const uint32_t *sources, repeat *list)
{
    uint32_t count = 0;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        if (sources[s] != s) {
            list[count++] = (repeat){scene->surfaces[s].node, scene->surfaces[s].instance, s};
        }
    }
    qsort(list, count, sizeof *list, compare_repeats);
    return count;
}

static uint32_t node_end(const repeat *list, uint32_t count, uint32_t first)
{
    uint32_t end = first + 1;
    while (end < count && list[end].node == list[first].node &&
           list[end].instance == list[first].instance) {
        end++;
    }
    return end;
}

// --- what repeats what ---------------------------------------------------------------------------

static double area_of(const alp_scene *scene, const alpi_surface *surface)
{
    double area = 0.0;
    for (uint32_t t = surface->first_triangle;
         t < surface->first_triangle + surface->triangle_count; t++) {
        if (scene->triangle_usable[t]) {
            vec3 c[3];
            alpi_triangle_corners(scene, t, c);
            area += vec3_triangle_area(c[0], c[1], c[2]);
        }
    }
    return area;
}

static double largest_coordinate(const vec3 c[3])
{
    double largest = 0.0;
    for (int k = 0; k < 3; k++) {
        largest = fmax(
            largest, fmax(fabs((double)c[k].x), fmax(fabs((double)c[k].y), fabs((double)c[k].z))));
    }
    return largest;
}

static bool same_shape(const alp_scene *scene, uint32_t t, uint32_t of, double scale)
{
    vec3 a[3], b[3];
    alpi_triangle_corners(scene, t, a);
    alpi_triangle_corners(scene, of, b);
    const double slack = SAME_PLACE * (largest_coordinate(a) + scale * largest_coordinate(b));
    for (int k = 0; k < 3; k++) {
        const double have = (double)vec3_length(vec3_sub(a[(k + 1) % 3], a[k]));
        const double want = scale * (double)vec3_length(vec3_sub(b[(k + 1) % 3], b[k]));
        if (!(fabs(have - want) <= SAME_LENGTH * want + slack)) {
            return false;
        }
    }
    return true;
}

static bool is_repeat(const alp_scene *scene, uint32_t s, uint32_t source, double scale)
{
    const alpi_surface *to = &scene->surfaces[s], *from = &scene->surfaces[source];
    if (to->mirrored != from->mirrored || to->triangle_count != from->triangle_count) {
        return false;
    }
    for (uint32_t i = 0; i < to->triangle_count; i++) {
        const uint32_t t = to->first_triangle + i, of = from->first_triangle + i;
        if (scene->triangle_usable[t] != scene->triangle_usable[of] ||
            (scene->triangle_usable[t] && !same_shape(scene, t, of, scale))) {
            return false;
        }
    }
    return true;
}

/// Keeps the surfaces of one node as repeats if all of them are, at one size.
static void judge_node(const alp_scene *scene, const repeat *list, uint32_t count,
                       alpi_repeats *repeats)
{
    double area = 0.0, source_area = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        area += area_of(scene, &scene->surfaces[list[i].surface]);
        source_area += area_of(scene, &scene->surfaces[repeats->sources[list[i].surface]]);
    }
    const double scale = source_area > 0.0 ? sqrt(area / source_area) : 0.0;
    bool good = scale > 0.0;
    for (uint32_t i = 0; good && i < count; i++) {
        good = is_repeat(scene, list[i].surface, repeats->sources[list[i].surface], scale);
    }
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t s = list[i].surface;
        repeats->sources[s] = good ? repeats->sources[s] : s;
        repeats->scales[s] = good ? scale : 1.0;
        repeats->count += good;
    }
}

alp_result alpi_repeats_create(const alp_scene *scene, alpi_repeats *repeats)
{
    alp_context *context = scene->context;
    *repeats = (alpi_repeats){0};
    ALP_TRY(alpi_scene_instances(scene, NULL, &repeats->sources));
    repeats->scales = ALPI_NEW(context, double, scene->surface_count);
    repeat *list = ALPI_NEW(context, repeat, scene->surface_count);
    if (repeats->scales == NULL || list == NULL) {
        alpi_release(context, list);
        alpi_repeats_destroy(context, repeats);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const uint32_t count = list_repeats(scene, repeats->sources, list);
    for (uint32_t first = 0, end; first < count; first = end) {
        end = node_end(list, count, first);
        judge_node(scene, list + first, end - first, repeats);
    }
    alpi_release(context, list);
    return ALP_OK;
}

void alpi_repeats_destroy(alp_context *context, alpi_repeats *repeats)
{
    alpi_release(context, repeats->sources);
    alpi_release(context, repeats->scales);
    *repeats = (alpi_repeats){0};
}

alp_result alpi_repeats_view(const alp_scene *scene, const alpi_repeats *repeats, alp_scene *view)
{
    *view = *scene;
    ALPI_TRY_NEW(scene->context, view->triangle_usable, scene->triangle_count);
    view->usable_count = 0;
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        const uint32_t s = scene->triangle_surface[t];
        view->triangle_usable[t] = scene->triangle_usable[t] && repeats->sources[s] == s;
        view->usable_count += view->triangle_usable[t];
    }
    return ALP_OK;
}

// --- copies --------------------------------------------------------------------------------------

typedef struct copier {
    alp_atlas *atlas;
    const alpi_repeats *repeats;
    alpi_charts *charts;
    uint32_t *copies; // [charts of sources] in the node at hand; ALPI_NONE: not met there
    uint32_t filled;  // of charts->triangles
} copier;

static void copy_triangle(const copier *c, uint32_t t, uint32_t from, double scale)
{
    alp_atlas *atlas = c->atlas;
    alpi_chart *chart = &c->charts->charts[c->copies[atlas->triangle_charts[from]]];
    c->charts->triangles[chart->first + chart->count++] = t;
    atlas->triangle_charts[t] = c->copies[atlas->triangle_charts[from]];
    for (int k = 0; k < 6; k++) {
        const double value = scale * (double)atlas->corner_uvs[from][k / 2][k % 2];
        atlas->corner_uvs[t][k / 2][k % 2] = (float)value;
    }
}

/// A copy of the chart of a source's triangle, unless this node has it already.
static alp_result open_copy(copier *c, uint32_t from, double scale)
{
    const uint32_t chart = c->atlas->triangle_charts[from];
    if (c->copies[chart] != ALPI_NONE) {
        return ALP_OK;
    }
    alpi_charts *charts = c->charts;
    ALP_TRY(alpi_grow(c->atlas->context, (void **)&charts->charts, &charts->capacity,
                      (size_t)charts->count + 1, sizeof *charts->charts));
    const alpi_chart *source = &charts->charts[chart];
    charts->charts[charts->count] = (alpi_chart){
        .first = c->filled, .width = scale * source->width, .height = scale * source->height};
    c->filled += source->count;
    c->copies[chart] = charts->count++;
    return ALP_OK;
}

/// Pass 0 opens the charts of a node's surface, pass 1 fills them, pass 2 forgets them.
static alp_result copy_surface(copier *c, uint32_t s, int pass)
{
    const alp_scene *scene = c->atlas->scene;
    const alpi_surface *to = &scene->surfaces[s];
    const alpi_surface *from = &scene->surfaces[c->repeats->sources[s]];
    for (uint32_t i = 0; i < to->triangle_count; i++) {
        const uint32_t t = to->first_triangle + i, of = from->first_triangle + i;
        if (!scene->triangle_usable[t]) {
            continue;
        }
        if (pass == 0) {
            ALP_TRY(open_copy(c, of, c->repeats->scales[s]));
        } else if (pass == 1) {
            copy_triangle(c, t, of, c->repeats->scales[s]);
        } else {
            c->copies[c->atlas->triangle_charts[of]] = ALPI_NONE;
        }
    }
    return ALP_OK;
}

static alp_result copy_nodes(copier *c, const repeat *list, uint32_t count)
{
    for (uint32_t first = 0, end; first < count; first = end) {
        end = node_end(list, count, first);
        for (int pass = 0; pass < 3; pass++) {
            for (uint32_t i = first; i < end; i++) {
                ALP_TRY(copy_surface(c, list[i].surface, pass));
            }
        }
    }
    return ALP_OK;
}

alp_result alpi_repeats_copy(alp_atlas *atlas, const alpi_repeats *repeats, alpi_charts *charts)
{
    alp_context *context = atlas->context;
    const uint32_t usable = atlas->scene->usable_count;
    uint32_t *triangles = alpi_reallocate(context, charts->triangles, usable, sizeof *triangles);
    if (triangles == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    charts->triangles = triangles;
    copier c = {.atlas = atlas, .repeats = repeats, .charts = charts};
    for (uint32_t i = 0; i < charts->count; i++) {
        c.filled += charts->charts[i].count;
    }
    repeat *list = ALPI_NEW(context, repeat, atlas->scene->surface_count);
    c.copies = ALPI_NEW(context, uint32_t, charts->count);
    alp_result result = list == NULL || c.copies == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
    for (uint32_t i = 0; result == ALP_OK && i < charts->count; i++) {
        c.copies[i] = ALPI_NONE;
    }
    if (result == ALP_OK) {
        result = copy_nodes(&c, list, list_repeats(atlas->scene, repeats->sources, list));
    }
    alpi_release(context, list);
    alpi_release(context, c.copies);
    return result;
}
