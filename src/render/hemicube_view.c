// SPDX-License-Identifier: MIT
#include "render/hemicube_view.h"

#include "maps/radiosity/solution.h"
#include "transport/examine.h"
#include "transport/gather/hemicube_picture.h"

bool alpi_hemicube_view_is_map(const alp_render_options *options)
{
    return options->hemicube_show >= ALP_HEMICUBE_WEIGHT;
}

alp_result alpi_hemicube_view_check(alp_context *context, const alp_render_options *options)
{
    const uint32_t n = options->hemicube;
    if (n < ALPI_HEMICUBE_LEAST || n > ALPI_HEMICUBE_MOST || n % 2 != 0) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "render: a hemicube of %u pixels, need an even number from %d to %d", n,
                         ALPI_HEMICUBE_LEAST, ALPI_HEMICUBE_MOST);
    }
    if ((int)options->hemicube_show < ALP_HEMICUBE_SEEN ||
        options->hemicube_show > ALP_HEMICUBE_LAMBERT) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "render: unknown picture %d of a hemicube", (int)options->hemicube_show);
    }
    return ALP_OK;
}

static alp_result draw_map(const alpi_hemicube *cube, alp_hemicube_show show, alp_image **image)
{
    const alpi_hemicube_map map = show == ALP_HEMICUBE_PERSPECTIVE ? ALPI_HEMICUBE_MAP_PERSPECTIVE
                                  : show == ALP_HEMICUBE_LAMBERT   ? ALPI_HEMICUBE_MAP_LAMBERT
                                                                   : ALPI_HEMICUBE_MAP_WEIGHT;
    return alpi_hemicube_draw_map(cube, map, image);
}

/// What the surfaces that are seen reflect: a radiosity keeps what goes into its last bounce, which
/// is that of one bounce less.
static alp_result solve(const alpi_hemicube_view *view, const alpi_lighting *lighting,
                        alpi_solution **solution)
{
    const alp_render_options *o = view->options;
    const uint32_t bounces = o->bounces == ALP_BOUNCES_CONVERGE ? o->bounces : o->bounces + 1;
    const alpi_solution_options options = {.scene = view->scene,
                                           .tracer = view->tracer,
                                           .lighting = lighting,
                                           .atlas = o->atlas,
                                           .one_sided = o->occlusion.one_sided,
                                           .bounces = bounces,
                                           .tolerance = alpi_radiosity_tolerance(bounces),
                                           .seed = o->occlusion.seed};
    return alpi_solution_create(&options, o->progress, o->progress_user, solution);
}

static alp_result look_around(const alpi_hemicube_view *view, const alpi_hemicube *cube,
                              const alpi_lighting *lighting, alp_image **image)
{
    const alp_scene *scene = view->scene;
    const alp_render_options *o = view->options;
    const alpi_trace_filter filter = {.one_sided = o->occlusion.one_sided};
    alpi_solution *solution = NULL;
    ALP_TRY(
        alpi_examine_light(view->tracer, filter, scene, lighting, o->progress, o->progress_user));
    ALP_TRY(solve(view, lighting, &solution));
    const alpi_hemicube_options options = {.context = scene->context,
                                           .from = {.scene = scene,
                                                    .tracer = view->tracer,
                                                    .lighting = lighting,
                                                    .filter = filter,
                                                    .light = alpi_solution_light(solution),
                                                    .emitters = true,
                                                    .sky = true},
                                           .cube = cube};
    const alpi_receiver_point point = {view->position, view->forward, view->forward, 0.0f};
    const alpi_hemicube_frame frame = alpi_hemicube_frame_upright(view->forward);
    const bool weighted = o->hemicube_show == ALP_HEMICUBE_PRODUCT;
    const alp_result result = alpi_hemicube_draw_view(&options, &point, &frame, weighted, image);
    alpi_solution_destroy(solution);
    return result;
}

static alp_result draw_light(const alpi_hemicube_view *view, const alpi_hemicube *cube,
                             alp_image **image)
{
    alpi_lighting *lighting = NULL;
    ALP_TRY(alpi_lighting_create(view->scene, &view->options->lighting, &lighting));
    const alp_result result = look_around(view, cube, lighting, image);
    alpi_lighting_destroy(view->scene->context, lighting);
    return result;
}

/// Corners are black, and not a hole that shows what lies behind the picture.
static void close_corners(alp_image *image)
{
    float *pixels = alp_image_floats(image);
    for (size_t i = 0; i < (size_t)image->info.width * image->info.height; i++) {
        pixels[4 * i + 3] = 1.0f;
    }
}

alp_result alpi_hemicube_view_draw(const alpi_hemicube_view *view, alp_image **image)
{
    alpi_hemicube *cube = NULL;
    ALP_TRY(alpi_hemicube_create(view->scene->context, view->options->hemicube, &cube));
    const alp_result result = alpi_hemicube_view_is_map(view->options)
                                  ? draw_map(cube, view->options->hemicube_show, image)
                                  : draw_light(view, cube, image);
    alpi_hemicube_destroy(cube);
    if (result == ALP_OK) {
        close_corners(*image);
    }
    return result;
}
