// SPDX-License-Identifier: MIT
// The doctor: runs each part on a scene, then sorts what they found.
#include "doctor/doctor.h"

#include "atlas/atlas.h"
#include "base/memory.h"
#include "base/tasks.h"
#include "scene/adjacency.h"

#include <stdio.h>

enum { LEAST_PAGE = 1, MOST_PAGE = 16384 };

/// Chooses the spots that get a picture: the first of each kind, which is the worst. The picture of
/// a UV set shows the spots of that set.
static void choose_spots(alp_diagnosis *d)
{
    for (uint32_t i = 0; i < d->count && d->spot_count < ALPI_DOCTOR_SPOTS; i++) {
        const alp_finding *f = &d->findings[i].view;
        const bool again = i > 0 && d->findings[i - 1].view.kind == f->kind;
        if (f->spot.known && f->place != ALP_PLACE_UV_SET && !again) {
            snprintf(d->spot_names[d->spot_count], sizeof d->spot_names[0], "spot-%s", f->code);
            d->spots[d->spot_count++] = i;
        }
    }
}

static alp_result run_parts(alp_diagnosis *d, const alp_diagnosis_options *options)
{
    for (uint32_t i = 0; i < options->message_count; i++) {
        ALP_TRY(alpi_doctor_add_message(d, &options->messages[i], options->light));
    }
    if (d->scene->usable_count > 0) {
        ALP_TRY(alpi_adjacency_create(d->scene, &d->neighbours));
    }
    ALP_TRY(alpi_doctor_look_at_mesh(d));
    ALP_TRY(alpi_doctor_look_at_uvs(d));
    ALP_TRY(alpi_doctor_look_at_materials(d));
    ALP_TRY(alpi_doctor_look_at_lights(d));
    ALP_TRY(alpi_doctor_look_at_backs(d));
    ALP_TRY(alpi_doctor_look_at_junctions(d));
    ALP_TRY(alpi_doctor_look_at_overlaps(d));
    ALP_TRY(alpi_doctor_look_at_sides(d));
    ALP_TRY(alpi_doctor_look_at_scale(d));
    ALP_TRY(alpi_diagnosis_sort(d));
    choose_spots(d);
    return ALP_OK;
}

alp_diagnosis_options alp_diagnosis_options_default(void)
{
    return (alp_diagnosis_options){.struct_size = sizeof(alp_diagnosis_options),
                                   .page_size = ALPI_DOCTOR_PAGE};
}

alp_result alp_scene_diagnose(const alp_scene *scene, const alp_diagnosis_options *options,
                              alp_diagnosis **diagnosis)
{
    if (scene == NULL || diagnosis == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *diagnosis = NULL;
    const alp_diagnosis_options o = options != NULL ? *options : alp_diagnosis_options_default();
    if (o.struct_size != sizeof o || (o.message_count > 0 && o.messages == NULL)) {
        return alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                         "diagnosis options are not from _default(), or messages are NULL");
    }
    if (o.page_size < LEAST_PAGE || o.page_size > MOST_PAGE) {
        return alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                         "diagnosis options: page_size %u; give one from %d to %d", o.page_size,
                         (int)LEAST_PAGE, (int)MOST_PAGE);
    }
    alp_diagnosis *d = ALPI_NEW(scene->context, alp_diagnosis, 1);
    if (d == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    d->context = scene->context;
    d->scene = scene;
    d->page_size = o.page_size;
    const alpi_watch former = alpi_set_watch(
        scene->context, (alpi_watch){.callback = o.progress, .user = o.progress_user});
    const alp_result result = run_parts(d, &o);
    alpi_release(d->context, d->neighbours);
    d->neighbours = NULL;
    alpi_set_watch(scene->context, former);
    if (result != ALP_OK) {
        alp_diagnosis_destroy(d);
        return result;
    }
    *diagnosis = d;
    return ALP_OK;
}
