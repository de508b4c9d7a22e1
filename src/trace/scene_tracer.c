// SPDX-License-Identifier: MIT
// The tracer that stays with its scene.
#include "trace/trace.h"

#include "base/tasks.h"

static void destroy_attachment(alp_context *context, void *data)
{
    (void)context; // the tracer knows it
    alpi_tracer_destroy(data);
}

alp_result alpi_tracer_for_scene(const alp_scene *scene, alp_progress_fn *progress,
                                 void *progress_user, alpi_tracer **tracer, double *seconds)
{
    alpi_attachment *attachment = &scene->attachments[ALPI_ATTACHMENT_TRACER];
    double started = alpi_seconds();
    if (attachment->data == NULL) {
        alpi_tracer *made = NULL;
        ALP_TRY(alpi_tracer_create(scene, NULL, progress, progress_user, &made));
        *attachment = (alpi_attachment){made, destroy_attachment};
    }
    *tracer = attachment->data;
    if (seconds != NULL) {
        *seconds = alpi_seconds() - started;
    }
    return ALP_OK;
}
