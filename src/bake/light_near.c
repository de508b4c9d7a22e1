// SPDX-License-Identifier: MIT
// What the rays of a round meet: the light that is known by then, and from near surfaces more.
#include "bake/light.h"

#include "maps/patch_reach.h"

#include <math.h>

/// Rays go on that meet something nearer than so many sides of its cells (patch_reach.h). Measured
/// on teapot-room for 1 %: 2 and 4 took longer and erred no less.
static const float NEAR_REACH = 1.0f;
/// Of such a path, the ray that arrived among them: in a corner it too meets what is near. What it
/// brings on windows: docs/radiosity.md, "What is near"; 8 brought no more.
enum { BOUNCES = 4 };

void alpi_light_near(const alpi_bake_job *job, const alpi_light_task *task,
                     const alpi_radiosity *solution, alpi_gather_scene *from, alpi_reference *near)
{
    const alpi_radiosity_options *o = &solution->options;
    if (o->layers != NULL || o->bounces <= ALPI_RADIOSITY_PASS_LIMIT || o->direct_scene != NULL) {
        return;
    }
    *near = (alpi_reference){.context = job->context,
                             .scene = job->scene,
                             .tracer = task->tracer,
                             .lighting =
                                 task->near_lighting != NULL ? task->near_lighting : task->lighting,
                             .filter = o->filter,
                             .bounces = BOUNCES,
                             .next_event = true,
                             .known = &from->light,
                             .known_reach = NEAR_REACH};
    from->near = near;
    from->near_reach = NEAR_REACH;
}

alp_result alpi_light_show(const alpi_bake_job *job, const alpi_light_task *task,
                           const alpi_radiosity *solution, uint32_t rays, double *noise)
{
    const alpi_radiosity_options *o = &solution->options;
    const double by_block = (double)o->gatherer->packet_count * ALPI_PACKET;
    const double by_texels = (double)rays * (double)job->report.light_traced /
                             fmax((double)solution->patches.block_count, 1.0);
    const bool finer = solution->texels == NULL && o->layers == NULL &&
                       o->bounces > ALPI_RADIOSITY_PASS_LIMIT && by_texels >= by_block;
    *noise = 1.0 / sqrt(finer ? by_texels : by_block);
    if (solution->texels != NULL) {
        return ALP_OK;
    }
    ALP_TRY(alpi_radiosity_show(solution, ALPI_NONE, finer ? task->values : NULL, &task->progress));
    return alpi_patches_set_reach(&solution->patches, &task->progress);
}
