// SPDX-License-Identifier: MIT
#include "lpv/lpv_pictures.h"

#include "lpv/lpv_volume.h"
#include "output.h"
#include "views.h"

#include <stdlib.h>

enum { AXES = 3, CHANNELS = 4, SLICE_SIDE = 512, NAME_SIZE = 32 };

// --- files ---------------------------------------------------------------------------------------

static char *slice_path(const command_line *a, uint32_t cascade, uint32_t axis)
{
    char name[NAME_SIZE];
    if (cascade == 0) {
        snprintf(name, sizeof name, "slice_%c", "xyz"[axis]);
    } else {
        snprintf(name, sizeof name, "slice_%c_%u", "xyz"[axis], cascade);
    }
    return pictures_path(a->values[OPTION_PICTURES].text, name);
}

static char *view_path(const command_line *a)
{
    return pictures_path(a->values[OPTION_PICTURES].text, "view");
}

static int check_path(const command_line *a, char *path)
{
    const int code = output_check(path, a->values[OPTION_FORCE].given);
    free(path);
    return code;
}

int lpv_pictures_check(const command_line *a)
{
    if (!a->values[OPTION_PICTURES].given) {
        return EXIT_DONE;
    }
    int code = pictures_folder(a->values[OPTION_PICTURES].text);
    for (uint32_t c = 0; c < a->values[OPTION_CASCADES].whole; c++) {
        for (uint32_t axis = 0; axis < AXES && code == EXIT_DONE; axis++) {
            code = check_path(a, slice_path(a, c, axis));
        }
    }
    return code == EXIT_DONE ? check_path(a, view_path(a)) : code;
}

/// Develops and saves. @param exposure NULL: it fits this picture alone
static alp_result save(const command_line *a, const alp_image *linear, const double *exposure,
                       char *path)
{
    alp_film_options film = alp_render_film_options(ALP_RENDER_FIELD);
    alp_image *display = NULL;
    if (exposure != NULL) {
        film.auto_exposure = false;
        film.exposure = *exposure;
    }
    alp_result result = alp_film_develop(linear, &film, &display, NULL);
    if (result == ALP_OK) {
        result = alp_image_save(display, path, a->values[OPTION_FORCE].given);
    }
    alp_image_destroy(display);
    free(path);
    return result;
}

// --- slices --------------------------------------------------------------------------------------

/// Draws the middle layer along an axis, each cell as a square.
static alp_result draw_slice(alp_context *context, const alp_lpv_grid *g, uint32_t axis,
                             alp_image **image)
{
    const uint32_t across = axis == 0 ? 2 : 0, down = axis == 1 ? 2 : 1;
    const uint32_t wide = g->size[across], high = g->size[down];
    const uint32_t scale = wide < SLICE_SIDE ? SLICE_SIDE / wide : 1;
    const alp_image_info info = {wide * scale, high * scale, CHANNELS, ALP_COMPONENT_FLOAT};
    const alp_result result = alp_image_create(context, info, image);
    if (result != ALP_OK) {
        return result;
    }
    float *pixel = alp_image_floats(*image);
    uint32_t cell[3];
    cell[axis] = g->size[axis] / 2;
    for (uint32_t y = 0; y < info.height; y++) {
        const uint32_t row = y / scale;
        cell[down] = down == 1 ? high - 1 - row : row;
        for (uint32_t x = 0; x < info.width; x++, pixel += CHANNELS) {
            cell[across] = x / scale;
            lpv_cell_fluence(g, cell, pixel);
            pixel[CHANNELS - 1] = 1.0f;
        }
    }
    return ALP_OK;
}

/// The exposure of slices side by side.
static alp_result find_exposure(alp_context *context, alp_image *const *slices, double *exposure)
{
    const alp_film_options film = alp_render_film_options(ALP_RENDER_FIELD);
    alp_image *joined = NULL, *display = NULL;
    alp_result result = images_join(context, slices, AXES, &joined);
    if (result == ALP_OK) {
        result = alp_film_develop(joined, &film, &display, exposure);
    }
    alp_image_destroy(display);
    alp_image_destroy(joined);
    return result;
}

/// Writes the slices of a grid, under one exposure.
static alp_result write_slices(const lpv_run *run, const command_line *a, uint32_t cascade)
{
    alp_context *context = run->session->context;
    alp_image *slices[AXES] = {NULL, NULL, NULL};
    alp_result result = ALP_OK;
    alp_lpv_grid grid;
    double exposure = 0.0;
    alp_lpv_get_grid(run->lpv, cascade, &grid);
    for (uint32_t axis = 0; axis < AXES && result == ALP_OK; axis++) {
        result = draw_slice(context, &grid, axis, &slices[axis]);
    }
    if (result == ALP_OK) {
        result = find_exposure(context, slices, &exposure);
    }
    for (uint32_t axis = 0; axis < AXES && result == ALP_OK; axis++) {
        result = save(a, slices[axis], &exposure, slice_path(a, cascade, axis));
    }
    for (uint32_t axis = 0; axis < AXES; axis++) {
        alp_image_destroy(slices[axis]);
    }
    return result;
}

// --- the view ------------------------------------------------------------------------------------

static alp_result render_volume(const lpv_run *run, alp_render_options *o, alp_image **image)
{
    alp_field *field = NULL;
    alp_result result = alp_field_create_lpv(run->lpv, &field);
    o->method = ALP_RENDER_FIELD;
    o->field = field;
    if (result == ALP_OK) {
        result = alp_render(run->session->scene, o, image);
    }
    alp_field_destroy(field);
    return result;
}

static alp_result render_reference(const lpv_run *run, const command_line *a, alp_render_options *o,
                                   alp_image **image)
{
    o->method = ALP_RENDER_REFERENCE;
    o->field = NULL;
    o->bounces = run->options.bounces;
    o->samples = (uint32_t)a->values[OPTION_REFERENCE_SAMPLES].whole;
    return alp_render(run->session->scene, o, image);
}

static alp_result write_view(const lpv_run *run, const command_line *a,
                             const alp_render_options *view)
{
    alp_render_options o = *view;
    alp_image *halves[2] = {NULL, NULL}, *joined = NULL;
    o.lighting = run->frame.lighting;
    o.occlusion.seed = a->values[OPTION_SEED].whole;
    alp_result result = render_volume(run, &o, &halves[0]);
    if (result == ALP_OK) {
        result = render_reference(run, a, &o, &halves[1]);
    }
    if (result == ALP_OK) {
        result = images_join(run->session->context, halves, 2, &joined);
    }
    if (result == ALP_OK) {
        result = save(a, joined, NULL, view_path(a));
    }
    alp_image_destroy(halves[0]);
    alp_image_destroy(halves[1]);
    alp_image_destroy(joined);
    return result;
}

int lpv_pictures_write(lpv_run *run, const command_line *a, const alp_render_options *view)
{
    if (!a->values[OPTION_PICTURES].given) {
        return EXIT_DONE;
    }
    alp_result result = ALP_OK;
    for (uint32_t c = 0; c < run->options.cascades && result == ALP_OK; c++) {
        result = write_slices(run, a, c);
        run->session->has_written |= result == ALP_OK;
    }
    if (result == ALP_OK) {
        result = write_view(run, a, view);
    }
    return session_end(run->session, result);
}
