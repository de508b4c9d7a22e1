// SPDX-License-Identifier: MIT
// A frame of view: that of --with, and that of --beside.
#include "divider.h"
#include "view_job.h"

static alp_result draw(drawing *d, const view_mode *mode, const alp_camera *camera)
{
    if ((mode->uses & USES_PATHS) != 0) {
        return path_picture_draw(&d->light.paths, d->scene, camera, &d->targets);
    }
    drawing_draw(d, camera);
    return ALP_OK;
}

alp_result view_draw(view_job *job, const alp_camera *camera)
{
    const alp_result result = draw(&job->drawing, job->settings.mode, camera);
    return result == ALP_OK && job->beside.mode != NULL
               ? draw(&job->beside.drawing, job->beside.mode, camera)
               : result;
}

alp_result view_develop(view_job *job, alp_film_options *film, alp_image **developed,
                        alp_image **light)
{
    alp_context *context = job->session.context;
    const double share = job->arguments->values[OPTION_DIVIDER].real;
    return job->beside.mode == NULL
               ? drawing_develop(&job->drawing, context, film, developed, light)
               : divider_develop(&job->drawing, &job->beside.drawing,
                                 divider_column(share, job->drawing.targets.width), context, film,
                                 developed, light);
}
