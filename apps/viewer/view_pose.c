// SPDX-License-Identifier: MIT
// Nodes that an animation moves along a flight.
#include "animation.h"
#include "view_job.h"

int view_pose_find(view_job *job)
{
    const command_line *a = job->arguments;
    job->animation = ALP_NONE;
    if (!a->values[OPTION_PICTURES].given || animation_is_none(a)) {
        return EXIT_DONE;
    }
    const bool animated = alp_scene_get_info(job->session.scene).animations > 0;
    return animated || a->values[OPTION_ANIMATION].given
               ? animation_find(&job->session, a, &job->animation)
               : EXIT_DONE;
}

int view_pose_move(view_job *job, double time, const alp_lighting_options *lighting)
{
    session *s = &job->session;
    alp_scene *posed = NULL, *before = s->scene;
    if (job->animation == ALP_NONE) {
        return EXIT_DONE;
    }
    const alp_scene *rest = job->rest != NULL ? job->rest : before;
    const alp_result result = alp_scene_pose(rest, job->animation, time, &posed);
    if (result != ALP_OK) {
        return session_end(s, result);
    }
    int code = drawing_set_pose(&job->drawing, s->context, posed, lighting);
    if (code == EXIT_DONE && job->beside.mode != NULL) {
        code = drawing_set_pose(&job->beside.drawing, s->context, posed, lighting);
    }
    if (job->rest == NULL) {
        job->rest = before; // fields keep it
    } else {
        alp_scene_destroy(before);
    }
    s->scene = posed;
    return code;
}

void view_pose_end(view_job *job)
{
    if (job->rest != NULL) {
        alp_scene_destroy(job->session.scene);
        job->session.scene = job->rest;
        job->rest = NULL;
    }
}
