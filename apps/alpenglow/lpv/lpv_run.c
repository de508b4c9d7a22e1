// SPDX-License-Identifier: MIT
#include "lpv/lpv_run.h"

#include "lighting.h"

#include <math.h>
#include <stdio.h>
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
    return EXIT_DONE;
}

int lpv_run_check(const command_line *a)
{
    if (a->command == COMMAND_SAMPLE && a->values[OPTION_SKY].given) {
        return usage_error(a->command, "--sky: light propagation holds no sky; leave it out, or "
                                       "give --with probes");
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
    o.bounces = lighting_bounces(a);
    o.memory_limit = find_memory_limit();
    return o;
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

/// Who looks into the grids that follow.
typedef struct viewer {
    double eye[3];     // metres: the camera, or the nearest place in the bounds of the scene
    double forward[3]; // unit, or 0
} viewer;

static viewer find_viewer(const session *s, const alp_camera *camera)
{
    const alp_scene_info info = alp_scene_get_info(s->scene);
    double length = 0.0;
    viewer v;
    for (int k = 0; k < 3; k++) {
        const double at = (double)camera->position[k];
        v.forward[k] = (double)camera->target[k] - at;
        v.eye[k] = fmin(fmax(at, (double)info.bounds_min[k]), (double)info.bounds_max[k]);
        length += v.forward[k] * v.forward[k];
    }
    for (int k = 0; k < 3; k++) {
        v.forward[k] *= length > 0.0 ? 1.0 / sqrt(length) : 0.0;
    }
    return v;
}

/// Cell with which the coarsest grid holds the scene from where the viewer is; 1 m for a scene
/// without size.
static double fit_cell(const session *s, const viewer *v, uint32_t grid, uint32_t cascades)
{
    const double ahead = 0.5; // alp_lpv_follow: centre - eye, in halves of the grid's side
    const alp_scene_info info = alp_scene_get_info(s->scene);
    double half = 0.0;
    for (int k = 0; k < 3; k++) {
        const double above = (double)info.bounds_max[k] - v->eye[k];
        const double below = v->eye[k] - (double)info.bounds_min[k];
        half = fmax(half, above / (1.0 + ahead * v->forward[k]));
        half = fmax(half, below / (1.0 - ahead * v->forward[k]));
    }
    // Centres are rounded to cells: 3 cells make room on both sides.
    const double cells = grid > 3 ? (double)grid - 3.0 : 1.0;
    return half > 0.0 ? ldexp(2.0 * half / cells, 1 - (int)cascades) : 1.0;
}

int lpv_run_open(session *s, const command_line *a, const alp_lighting_options *lighting,
                 const alp_camera *camera, lpv_run *run)
{
    *run = (lpv_run){.session = s, .options = make_options(s, a), .frame = make_frame(a, lighting)};
    alp_lpv_options *o = &run->options;
    const bool follows = camera != NULL && o->cascades > 1;
    viewer v = {0};
    if (!has_light(s, lighting)) {
        return failure("nothing lights the scene; give --sun, --lamp or --spot (light propagation "
                       "holds no sky)");
    }
    if (camera != NULL) {
        run->camera = *camera;
        run->frame.camera = &run->camera;
        v = find_viewer(s, camera);
    }
    if (follows && a->values[OPTION_CELL].choice >= 0) {
        o->cell = fit_cell(s, &v, o->size[0], o->cascades);
    }
    state_memory(s, o);
    alp_result result = alp_lpv_create(s->context, o, &run->lpv);
    if (result == ALP_OK) { // warns of lamps in walls
        result = alp_scene_examine(s->scene, &run->frame.lighting, session_progress, s);
    }
    if (result == ALP_OK && follows) {
        result = alp_lpv_follow(run->lpv, v.eye, v.forward);
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
    const viewer v = find_viewer(run->session, camera);
    run->camera = *camera;
    run->frame.camera = &run->camera;
    return run->options.cascades > 1 ? alp_lpv_follow(run->lpv, v.eye, v.forward) : ALP_OK;
}

alp_result lpv_run_light(lpv_run *run, alp_lpv_report *report)
{
    return alp_lpv_light_scene(run->lpv, run->session->scene, &run->frame, report);
}
