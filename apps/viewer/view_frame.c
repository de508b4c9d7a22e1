// SPDX-License-Identifier: MIT
// A frame of view: that of --with, and that of --beside.
#include "divider.h"
#include "view_job.h"

void view_draw(view_job *job, const alp_camera *camera)
{
    drawing_draw(&job->drawing, camera);
    if (job->beside.mode != NULL) {
        drawing_draw(&job->beside.drawing, camera);
    }
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
