// SPDX-License-Identifier: MIT
// One picture of view, and its comparison with a reference.
#include "output.h"
#include "view_job.h"

#include <stdio.h>

/// Compares the picture with that of --reference.
static int compare(view_job *job, const alp_image *developed, const alp_image *light)
{
    const option_value *threshold = &job->arguments->values[OPTION_REFERENCE_THRESHOLD];
    alp_image_difference d = {0};
    if (job->reference == NULL) {
        return EXIT_DONE;
    }
    const bool linear = alp_image_get_info(job->reference).component == ALP_COMPONENT_FLOAT;
    const alp_result result =
        alp_image_compare(linear ? light : developed, job->reference, 1.0, &d, NULL);
    if (result != ALP_OK) {
        return session_end(&job->session, result);
    }
    printf("reference  rmse %.4g, bias %.4g, 99 %% below %.4g, most %.4g at %u, %u\n", d.rmse,
           d.bias, d.p99, d.maximum, d.maximum_x, d.maximum_y);
    if (threshold->given && !(d.pixels > 0 && d.rmse <= threshold->real)) {
        return failure("the picture differs from the reference by more than the threshold");
    }
    return EXIT_DONE;
}

/// Writes and compares what was drawn.
static int finish(view_job *job, const alp_camera *camera, alp_image *developed, alp_image *light,
                  double start)
{
    const char *output = job->arguments->values[OPTION_OUTPUT].text;
    const bool png = path_ends(output, ".png");
    const alp_film_options *film = &job->settings.film;
    const int code = view_save(job, camera, film->exposure, png ? developed : light, output);
    if (code != EXIT_DONE) {
        return code;
    }
    view_print_done(job, output, clock_seconds() - start);
    if (film->auto_exposure && png && !job->arguments->values[OPTION_QUIET].given) {
        printf("exposure   %.2f EV\n", film->exposure);
    }
    return compare(job, developed, light);
}

int view_picture(view_job *job)
{
    alp_camera camera;
    alp_image *developed = NULL, *light = NULL;
    session *s = &job->session;
    alp_result result = alp_render_find_camera(s->scene, &job->settings.render, &camera);
    const double start = clock_seconds();
    if (result == ALP_OK) {
        result = view_draw(job, &camera);
    }
    if (result == ALP_OK) {
        result = view_develop(job, &job->settings.film, &developed, &light);
    }
    const int code =
        result == ALP_OK ? finish(job, &camera, developed, light, start) : session_end(s, result);
    alp_image_destroy(developed);
    alp_image_destroy(light);
    return code;
}
