// SPDX-License-Identifier: MIT
#include "ambience/ambience_error.h"

#include <math.h>
#include <string.h>

enum { POINTS = 64 };
static const float RADIUS = 20.0f; // metres

typedef struct error_points {
    float positions[POINTS][3], normals[POINTS][3];
    double places[POINTS][3];
    float ours[POINTS][3], reference[POINTS][3];
} error_points;

static void read_volume(flight_run *run, error_points *p)
{
    for (int i = 0; i < POINTS; i++) {
        for (int k = 0; k < 3; k++) {
            p->places[i][k] = (double)p->positions[i][k];
        }
    }
    const alp_ambience_snapshot *now = alp_ambience_begin_read(run->ambience);
    alp_ambience_irradiance(now, POINTS, (const double(*)[3])p->places,
                            (const float(*)[3])p->normals, p->ours);
    alp_ambience_end_read(run->ambience, now);
}

static double compare(const error_points *p)
{
    double difference = 0.0, sum = 0.0;
    for (int i = 0; i < POINTS; i++) {
        for (int k = 0; k < 3; k++) {
            difference += fabs((double)p->ours[i][k] - (double)p->reference[i][k]);
            sum += (double)p->reference[i][k];
        }
    }
    return sum > 0.0 ? 100.0 * difference / sum : (double)NAN;
}

alp_result ambience_error_measure(const ambience_error *e, flight_run *run,
                                  const flight_frame *frame, uint32_t second, double *percent)
{
    error_points p = {0};
    const alp_scene *scene = run->session->scene;
    const float centre[3] = {(float)frame->camera.position[0], (float)frame->camera.position[1],
                             (float)frame->camera.position[2]};
    alp_reference_options o = alp_reference_options_default();
    o.lighting = run->lighting;
    o.samples = e->samples;
    o.direct = e->direct;
    o.seed = e->seed + second;
    o.progress = flight_run_progress;
    o.progress_user = run;
    *percent = (double)NAN;
    alp_result result =
        alp_scene_free_points_near(scene, centre, RADIUS, e->seed, POINTS, p.positions, p.normals);
    // Without a free point so near, there is no error: the camera may be far outside.
    if (result == ALP_ERROR_INVALID_ARGUMENT) {
        return ALP_OK;
    }
    if (result == ALP_OK) {
        read_volume(run, &p);
        result = alp_reference_irradiance(scene, &o, POINTS, (const float(*)[3])p.positions,
                                          (const float(*)[3])p.normals, p.reference, NULL);
    }
    if (result == ALP_OK) {
        *percent = compare(&p);
    }
    return result;
}
