// SPDX-License-Identifier: MIT
#include "lpv/lpv_run.h"

#include "lighting.h"

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
               {"--blockers", OPTION_BLOCKERS}};
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
    o.points = a->values[OPTION_BLOCKERS].choice == BLOCKERS_POINTS ? o.points : 0;
    o.seed = a->values[OPTION_SEED].whole;
    return o;
}

// --- the volume ----------------------------------------------------------------------------------

/// States the memory of a large volume before it is made.
static void state_memory(const session *s, const alp_lpv_options *o)
{
    const uint64_t bytes = alp_lpv_memory(o);
    if (bytes > MEMORY_STATED && !s->messages.quiet) {
        fprintf(stderr, "alpenglow: the volume needs %.1f GB of memory\n", 1e-9 * (double)bytes);
    }
}

/// Moves the grids with the camera.
static alp_result follow(lpv_run *run)
{
    double eye[3], forward[3];
    for (int k = 0; k < 3; k++) {
        eye[k] = (double)run->camera.position[k];
        forward[k] = (double)run->camera.target[k] - eye[k];
    }
    return alp_lpv_follow(run->lpv, eye, forward);
}

int lpv_run_open(session *s, const command_line *a, const alp_lighting_options *lighting,
                 const alp_camera *camera, lpv_run *run)
{
    *run = (lpv_run){.session = s, .options = make_options(s, a), .frame = make_frame(a, lighting)};
    state_memory(s, &run->options);
    alp_result result = alp_lpv_create(s->context, &run->options, &run->lpv);
    if (camera != NULL) {
        run->camera = *camera;
        run->frame.camera = &run->camera;
    }
    if (result == ALP_OK && camera != NULL && run->options.cascades > 1) {
        result = follow(run);
    }
    return session_end(s, result);
}

void lpv_run_close(lpv_run *run)
{
    alp_lpv_destroy(run->lpv);
    *run = (lpv_run){0};
}

alp_result lpv_run_light(lpv_run *run, alp_lpv_report *report)
{
    return alp_lpv_light_scene(run->lpv, run->session->scene, &run->frame, report);
}
