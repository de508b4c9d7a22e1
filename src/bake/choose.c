// SPDX-License-Identifier: MIT
// The stage that chooses: surfaces and their occluders, maps, images to pack into, layers.
#include "bake/bake_stages.h"

#include "bake/files/pack_orm.h"
#include "bake/layer_plan.h"
#include "bake/settings.h"
#include "scene/select.h"

#include <math.h>

static const double SAME_SIZE = 1e-3; // sizes that differ by less are equal within rounding

/// Mean length of a surface over that of another with the same triangles; 1 where it is unknown.
static double relative_size(const alp_scene *scene, uint32_t surface, uint32_t other)
{
    double areas[2] = {0.0, 0.0};
    const uint32_t both[2] = {surface, other};
    for (int i = 0; i < 2; i++) {
        const alpi_surface *s = &scene->surfaces[both[i]];
        for (uint32_t t = s->first_triangle; t < s->first_triangle + s->triangle_count; t++) {
            vec3 c[3];
            alpi_triangle_corners(scene, t, c);
            areas[i] += scene->triangle_usable[t] ? vec3_triangle_area(c[0], c[1], c[2]) : 0.0;
        }
    }
    return areas[0] > 0.0 && areas[1] > 0.0 ? sqrt(areas[0] / areas[1]) : 1.0;
}

/// Notes instances of other sizes, which share one map: a distance limit is in metres of the world.
static void note_sizes(const alpi_bake_job *job)
{
    const alp_scene *scene = job->scene;
    uint32_t count = 0, first = 0;
    double factor = 1.0;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const uint32_t original = job->originals[s];
        const double size = original != s ? relative_size(scene, s, original) : 1.0;
        if (fabs(size - 1.0) > SAME_SIZE && count++ == 0) {
            first = s;
            factor = size;
        }
    }
    if (count > 0 && !isinf(job->options.occlusion.distance)) {
        alpi_note(job->context, "instance-size", scene->surfaces[first].name,
                  "%.3g times as large as the baked instance of its mesh (%s), whose map and "
                  "distance limit it uses; %u surface%s of this kind",
                  factor, scene->surfaces[job->originals[first]].name, count,
                  count == 1 ? "" : "s");
    }
}

alp_result alpi_bake_choose_surfaces(alpi_bake_job *job)
{
    const alp_bake_options *o = &job->options;
    ALP_TRY(alpi_scene_select(job->scene, o->only, &job->only));
    ALP_TRY(alpi_scene_select(job->scene, o->occluders, &job->occluders));
    if (o->ao_self) {
        ALP_TRY(alpi_scene_instances(job->scene, job->only, &job->originals));
        note_sizes(job);
    }
    for (uint32_t s = 0; s < job->scene->surface_count; s++) {
        job->report.surfaces_baked += job->only == NULL || job->only[s];
    }
    return ALP_OK;
}

alp_result alpi_bake_choose(alpi_bake_job *job)
{
    ALP_TRY(alpi_bake_choose_surfaces(job));
    if (alpi_bake_lights_apart(&job->options)) {
        job->options.maps |= ALP_MAP_DIRECT | ALP_MAP_BOUNCED;
    }
    ALP_TRY(alpi_bake_plan_packing(job));
    return alpi_bake_plan_layers(job);
}
