// SPDX-License-Identifier: MIT
#include "bake/objects.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>
#include <stdlib.h>

// --- objects -------------------------------------------------------------------------------------

/// Whether a surface has texels: it is chosen, and no instance of another.
static bool has_texels(const alpi_bake_job *job, uint32_t surface)
{
    return (job->only == NULL || job->only[surface]) &&
           (job->originals == NULL || job->originals[surface] == surface);
}

typedef struct node_surface {
    uint32_t node, instance, surface;
} node_surface;

static int compare_nodes(const void *left, const void *right)
{
    const node_surface *a = left, *b = right;
    if (a->node != b->node) {
        return a->node < b->node ? -1 : 1;
    }
    if (a->instance != b->instance) {
        return a->instance < b->instance ? -1 : 1;
    }
    return a->surface < b->surface ? -1 : a->surface > b->surface;
}

/// Diagonal of the bounding box of an object's usable triangles, metres.
static float diagonal(const alp_scene *scene, const uint32_t *surfaces, uint32_t count)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    bool found = false;
    for (uint32_t i = 0; i < count; i++) {
        const alpi_surface *surface = &scene->surfaces[surfaces[i]];
        for (uint32_t k = 0; k < 3 * surface->triangle_count; k++) {
            const uint32_t t = surface->first_triangle + k / 3;
            const float *p = scene->positions[scene->triangles[t][k % 3]];
            for (int axis = 0; scene->triangle_usable[t] && axis < 3; axis++) {
                low[axis] = fminf(low[axis], p[axis]);
                high[axis] = fmaxf(high[axis], p[axis]);
                found = true;
            }
        }
    }
    return found ? vec3_length(vec3_sub(vec3_load(high), vec3_load(low))) : 0.0f;
}

/// Lists one object for each node, or instance of its mesh, that has texels. `owner` gets the
/// object of each surface.
static alp_result list_objects(const alpi_bake_job *job, alpi_objects *objects, uint32_t *owner,
                               node_surface *list)
{
    const alp_scene *scene = job->scene;
    uint32_t count = 0;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        owner[s] = ALPI_NONE;
        if (has_texels(job, s)) {
            list[count++] = (node_surface){scene->surfaces[s].node, scene->surfaces[s].instance, s};
        }
    }
    qsort(list, count, sizeof *list, compare_nodes);
    ALPI_TRY_NEW(job->context, objects->items, count);
    ALPI_TRY_NEW(job->context, objects->surfaces, count);
    for (uint32_t i = 0; i < count; i++) {
        if (i == 0 || list[i].node != list[i - 1].node ||
            list[i].instance != list[i - 1].instance) {
            objects->items[objects->count++] = (alpi_object){.first_surface = i};
        }
        objects->items[objects->count - 1].surface_count++;
        objects->surfaces[i] = list[i].surface;
        owner[list[i].surface] = objects->count - 1;
    }
    for (uint32_t i = 0; i < objects->count; i++) {
        alpi_object *o = &objects->items[i];
        const float given = job->options.occlusion.distance;
        o->distance = given != 0.0f ? given
                                    : ALPI_OCCLUSION_AUTO_SHARE *
                                          diagonal(scene, objects->surfaces + o->first_surface,
                                                   o->surface_count);
    }
    return ALP_OK;
}

/// Asks the user now and then whether to go on.
static alp_result tick(const alpi_bake_job *job, uint32_t i)
{
    const uint32_t per_tick = 1u << 16;
    return i % per_tick == per_tick - 1 ? alpi_tick(job->context, "build", 0, 1) : ALP_OK;
}

/// Gives each texel to its object, in the order of the texels. Drops objects without any.
static alp_result deal_texels(const alpi_bake_job *job, const uint32_t *order,
                              const uint32_t *owner, alpi_objects *objects)
{
    const alpi_texels *texels = &job->lightmap->texels;
    ALPI_TRY_NEW(job->context, objects->texels, texels->count);
    for (uint32_t i = 0; i < texels->count; i++) {
        const uint32_t surface = job->scene->triangle_surface[texels->triangles[i]];
        objects->items[owner[surface]].texel_count++;
        ALP_TRY(tick(job, i));
    }
    uint32_t first = 0;
    for (uint32_t i = 0; i < objects->count; i++) {
        objects->items[i].texels = objects->texels + first;
        first += objects->items[i].texel_count;
        objects->items[i].texel_count = 0;
    }
    for (uint32_t i = 0; i < texels->count; i++) {
        const uint32_t surface = job->scene->triangle_surface[texels->triangles[order[i]]];
        alpi_object *o = &objects->items[owner[surface]];
        objects->texels[(size_t)(o->texels - objects->texels) + o->texel_count++] = order[i];
        ALP_TRY(tick(job, i));
    }
    uint32_t kept = 0;
    for (uint32_t i = 0; i < objects->count; i++) {
        if (objects->items[i].texel_count > 0) {
            objects->items[kept++] = objects->items[i];
        }
    }
    objects->count = kept;
    return ALP_OK;
}

static alp_result fill_alone(const alpi_bake_job *job, const uint32_t *order, alpi_objects *objects)
{
    uint32_t *owner = ALPI_NEW(job->context, uint32_t, job->scene->surface_count);
    node_surface *list = ALPI_NEW(job->context, node_surface, job->scene->surface_count);
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    if (owner != NULL && list != NULL) {
        result = list_objects(job, objects, owner, list);
    }
    if (result == ALP_OK) {
        result = deal_texels(job, order, owner, objects);
    }
    alpi_release(job->context, owner);
    alpi_release(job->context, list);
    return result;
}

static alp_result fill_together(const alpi_bake_job *job, const uint32_t *order,
                                alpi_objects *objects)
{
    ALPI_TRY_NEW(job->context, objects->items, 1);
    objects->count = 1;
    objects->items[0] = (alpi_object){
        .texels = order,
        .texel_count = job->lightmap->texels.count,
        .distance = alp_occlusion_distance(job->scene, &job->options.occlusion),
    };
    return ALP_OK;
}

alp_result alpi_objects_create(const alpi_bake_job *job, const uint32_t *order,
                               alpi_objects *objects)
{
    *objects = (alpi_objects){.context = job->context};
    objects->marks = ALPI_NEW(job->context, bool, job->scene->surface_count);
    alp_result result = objects->marks == NULL ? ALP_ERROR_OUT_OF_MEMORY
                        : job->options.ao_self ? fill_alone(job, order, objects)
                                               : fill_together(job, order, objects);
    if (result != ALP_OK) {
        alpi_objects_destroy(objects);
    }
    return result;
}

void alpi_objects_destroy(alpi_objects *objects)
{
    alpi_release(objects->context, objects->items);
    alpi_release(objects->context, objects->surfaces);
    alpi_release(objects->context, objects->texels);
    alpi_release(objects->context, objects->marks);
    *objects = (alpi_objects){.context = objects->context};
}

// --- what occludes -------------------------------------------------------------------------------

alp_result alpi_bake_tracer(const alpi_bake_job *job, alp_progress_fn *progress,
                            void *progress_user, alpi_tracer **tracer, alpi_tracer **owned)
{
    *tracer = *owned = NULL;
    if (job->occluders == NULL) {
        return alpi_tracer_for_scene(job->scene, progress, progress_user, tracer, NULL);
    }
    alp_result result =
        alpi_tracer_create(job->scene, job->occluders, progress, progress_user, owned);
    *tracer = *owned;
    return result;
}

alp_result alpi_object_tracer(const alpi_bake_job *job, alpi_objects *objects,
                              const alpi_object *object, alp_progress_fn *progress,
                              void *progress_user, alpi_tracer **tracer, alpi_tracer **owned)
{
    if (object->surface_count == 0) {
        return alpi_bake_tracer(job, progress, progress_user, tracer, owned);
    }
    const uint32_t *surfaces = objects->surfaces + object->first_surface;
    for (uint32_t i = 0; i < object->surface_count; i++) {
        objects->marks[surfaces[i]] = true;
    }
    alp_result result =
        alpi_tracer_create(job->scene, objects->marks, progress, progress_user, owned);
    for (uint32_t i = 0; i < object->surface_count; i++) {
        objects->marks[surfaces[i]] = false;
    }
    *tracer = *owned;
    return result;
}
