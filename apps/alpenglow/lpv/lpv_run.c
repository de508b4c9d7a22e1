// SPDX-License-Identifier: MIT
#include "lpv/lpv_run.h"

#include "setup/lighting.h"
#include "views.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { BLOCKERS_POINTS, BLOCKERS_VIEWS, BLOCKERS_OFF }; // the choices of --blockers
static const double MEMORY_SHARE = 0.75;                // of the machine's memory
static const uint64_t MEMORY_STATED = 1000000000;       // bytes from which memory is stated first

// --- options -------------------------------------------------------------------------------------

static int check_bounces(const command_line *a)
{
    const option_value *bounces = &a->values[OPTION_BOUNCES];
    if (bounces->choice < 0 && bounces->whole != 1) {
        return usage_error(a->command,
                           "--bounces %s: light propagation has the first reflection or all; give "
                           "1 or converge",
                           bounces->text);
    }
    if (bounces->given && bounces->choice >= 0 &&
        a->values[OPTION_BLOCKERS].choice == BLOCKERS_OFF) {
        return usage_error(a->command, "--bounces converge: only blockers reflect light again; "
                                       "leave it out with --blockers off");
    }
    return EXIT_DONE;
}

int lpv_run_check(const command_line *a)
{
    if (!command_is_picture(a->command) && a->values[OPTION_SKY].given) { // or it is background
        return usage_error(a->command, "--sky: light propagation holds no sky; leave it out");
    }
    if (a->command == COMMAND_SAMPLE && a->values[OPTION_DIRECT].choice == 1) {
        return usage_error(a->command,
                           "--direct on: light propagation holds no light straight from lamps and "
                           "suns; leave it out, or give --with probes");
    }
    return check_bounces(a);
}

int lpv_run_refuse(const command_line *a)
{
    static const struct {
        const char *name;
        option_id id;
    } own[] = {{"--grid", OPTION_GRID},
               {"--cascades", OPTION_CASCADES},
               {"--iterations", OPTION_ITERATIONS},
               {"--mode", OPTION_MODE},
               {"--blockers", OPTION_BLOCKERS},
               {"--map-size", OPTION_MAP_SIZE},
               {"--gloss", OPTION_GLOSS},
               {"--media", OPTION_MEDIA}};
    for (size_t i = 0; i < sizeof own / sizeof *own; i++) {
        if (a->values[own[i].id].given) {
            return usage_error(a->command, "%s: does not apply to --with %s", own[i].name,
                               a->values[OPTION_WITH].text);
        }
    }
    return EXIT_DONE;
}

/// Bytes that a volume may hold; 0: the machine's memory is not known.
static uint64_t find_memory_limit(void)
{
    const long pages = sysconf(_SC_PHYS_PAGES), page_size = sysconf(_SC_PAGESIZE);
    return pages > 0 && page_size > 0 ? (uint64_t)(MEMORY_SHARE * (double)pages * (double)page_size)
                                      : 0;
}

static alp_lpv_options make_options(const session *s, const command_line *a)
{
    const option_value *values = a->values;
    alp_lpv_options o = alp_lpv_options_for_scene(s->scene, (uint32_t)values[OPTION_GRID].whole,
                                                  (uint32_t)values[OPTION_CASCADES].whole);
    o.cell = values[OPTION_CELL].choice < 0 ? values[OPTION_CELL].real : o.cell;
    o.iterations = (uint32_t)values[OPTION_ITERATIONS].whole; // auto: 0
    o.mode = values[OPTION_MODE].choice == 0 ? ALP_LPV_ACCURATE : ALP_LPV_CONFORMANCE;
    o.blockers = values[OPTION_BLOCKERS].choice != BLOCKERS_OFF;
    o.bounces = o.blockers ? lighting_bounces(a) : 1; // they are what reflects light again
    o.memory_limit = find_memory_limit();
    return o;
}

/// Width over height of the picture.
static float find_aspect(const command_line *a)
{
    uint32_t width = 1, height = 1;
    (void)resolution_read(a, &width, &height); // the command has read it before
    return (float)width / (float)height;
}

static alp_lpv_scene_options make_frame(const command_line *a, const alp_lighting_options *lighting)
{
    alp_lpv_scene_options o = alp_lpv_scene_options_default();
    o.lighting = *lighting;
    o.lighting.sky.kind = ALP_SKY_NONE;
    o.points = a->values[OPTION_BLOCKERS].choice == BLOCKERS_POINTS ? o.points : 0;
    o.map_size = (uint32_t)a->values[OPTION_MAP_SIZE].whole;
    o.seed = a->values[OPTION_SEED].whole;
    return o;
}

// --- the volume ----------------------------------------------------------------------------------

/// Whether the file or the options have a light. The sky of the options does not count.
static bool has_light(const session *s, const alp_lighting_options *lighting)
{
    const alp_scene_info info = alp_scene_get_info(s->scene);
    bool lit = info.lights > 0 || lighting->lamp_count > 0 || lighting->sun.illuminance > 0.0f;
    for (uint32_t i = 0; i < info.surfaces && !lit; i++) {
        const alp_surface_info surface = alp_scene_get_surface(s->scene, i);
        lit = surface.emission[0] + surface.emission[1] + surface.emission[2] > 0.0f;
    }
    return lit;
}

/// States the memory of a large volume before it is made.
static void state_memory(const session *s, const alp_lpv_options *o)
{
    const uint64_t bytes = alp_lpv_memory(o);
    if (bytes > MEMORY_STATED && !s->messages.quiet) {
        fprintf(stderr, "alpenglow: the volume needs %.1f GB of memory\n", 1e-9 * (double)bytes);
    }
}

/// Options of grids that follow a camera. @param forward out: the camera's way
static alp_lpv_options fit_view(const session *s, const alp_lpv_options *o,
                                const alp_camera *camera, double forward[3])
{
    double eye[3];
    for (int k = 0; k < 3; k++) {
        eye[k] = (double)camera->position[k];
        forward[k] = (double)camera->target[k] - eye[k];
    }
    return alp_lpv_options_for_view(s->scene, o->size[0], o->cascades, eye, forward);
}

// --- warnings ------------------------------------------------------------------------------------

static void warn_of_cell(session *s, const alp_lpv_options *o)
{
    const alp_scene_info info = alp_scene_get_info(s->scene);
    double longest = 0.0;
    char text[160];
    for (int k = 0; k < 3; k++) {
        longest = fmax(longest, (double)info.bounds_max[k] - (double)info.bounds_min[k]);
    }
    if (o->cell > longest / 3.0) {
        snprintf(text, sizeof text,
                 "cells of %.3g m in a scene of %.3g m hold next to no shape of its light; give "
                 "more cells or smaller ones (--grid, --cell)",
                 o->cell, longest);
        session_warn(s, "coarse-grid", "--grid", text);
    }
}

/// Lamps and suns, in the file and in the options, have maps that are views.
static void warn_of_views(session *s, const command_line *a, const lpv_run *run)
{
    const alp_lighting_options *l = &run->frame.lighting;
    const bool lamps =
        alp_scene_get_info(s->scene).lights > 0 || l->lamp_count > 0 || l->sun.illuminance > 0.0f;
    if (a->values[OPTION_BLOCKERS].choice == BLOCKERS_VIEWS && !lamps &&
        run->frame.camera == NULL) {
        session_warn(s, "no-views", "--blockers",
                     "nothing blocks light: there is no view, neither of a lamp nor of a camera; "
                     "give --blockers points");
    }
}

static void warn_of_darkness(session *s, const alp_lpv_report *r)
{
    if (r->lit == 0) {
        session_warn(s, "no-light", "",
                     "no light was injected: what lamps and suns meet is black, faces away or is "
                     "not there");
    } else if (r->lights == 0) {
        session_warn(s, "no-light", "",
                     "no light was injected: all lit surfaces lie outside of the grid; give more "
                     "cells or larger ones (--grid, --cell)");
    }
}

// --- the volume's life ---------------------------------------------------------------------------

int lpv_run_open(session *s, const command_line *a, const alp_lighting_options *lighting,
                 const alp_camera *camera, lpv_run *run)
{
    *run = (lpv_run){.session = s, .options = make_options(s, a), .frame = make_frame(a, lighting)};
    alp_lpv_options *o = &run->options;
    const bool follows = camera != NULL && o->cascades > 1;
    double forward[3];
    if (!has_light(s, lighting)) {
        return failure("nothing lights the scene; give --sun, --lamp or --spot (light propagation "
                       "holds no sky)");
    }
    if (camera != NULL) {
        run->camera = *camera;
        run->frame.camera = &run->camera;
        run->frame.camera_aspect = find_aspect(a);
    }
    if (follows) {
        const alp_lpv_options fit = fit_view(s, o, camera, forward);
        o->cell = a->values[OPTION_CELL].choice >= 0 ? fit.cell : o->cell;
        memcpy(o->centre, fit.centre, sizeof o->centre);
    }
    state_memory(s, o);
    warn_of_cell(s, o);
    warn_of_views(s, a, run);
    alp_result result = alp_lpv_create(s->context, o, &run->lpv);
    if (result == ALP_OK) { // warns of lamps in walls
        result = alp_scene_examine(s->scene, &run->frame.lighting, session_progress, s);
    }
    if (result == ALP_OK && follows) {
        result = alp_lpv_follow(run->lpv, o->centre, forward);
    }
    return session_end(s, result);
}

void lpv_run_close(lpv_run *run)
{
    alp_lpv_destroy(run->lpv);
    *run = (lpv_run){0};
}

alp_result lpv_run_follow(lpv_run *run, const alp_camera *camera)
{
    double forward[3];
    const alp_lpv_options fit = fit_view(run->session, &run->options, camera, forward);
    run->camera = *camera;
    run->frame.camera = &run->camera;
    return run->options.cascades > 1 ? alp_lpv_follow(run->lpv, fit.centre, forward) : ALP_OK;
}

alp_result lpv_run_light(lpv_run *run, alp_lpv_report *report)
{
    alp_lpv_report own;
    const alp_result result = alp_lpv_light_scene(run->lpv, run->session->scene, &run->frame, &own);
    if (result == ALP_OK && !run->judged) {
        warn_of_darkness(run->session, &own);
        run->judged = true;
    }
    if (result == ALP_OK && report != NULL) {
        *report = own;
    }
    return result;
}
