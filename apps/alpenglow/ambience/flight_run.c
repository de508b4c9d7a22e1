// SPDX-License-Identifier: MIT
#include "ambience/flight_run.h"

#include "ambience/day.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WARM_BOUNCES = 5 };
enum { BUDGET_LIMIT = 65536, LIGHT_STEPS = 4, DEPTH_LIMIT = 10 }; // LIGHT_STEPS: a second

// --- options -------------------------------------------------------------------------------------

static bool is_terrain(const char *scene)
{
    static const char name[] = "builtin:terrain";
    const size_t length = sizeof name - 1;
    return strncmp(scene, name, length) == 0 && (scene[length] == '\0' || scene[length] == ',');
}

int flight_run_check(const command_line *a)
{
    const option_value *values = a->values;
    if (!values[OPTION_PATH].given && !is_terrain(a->operands[0])) {
        return usage_error(a->command, "no flight; give --path FLIGHT.csv, lines of "
                                       "t,px,py,pz,tx,ty,tz[,vfov]");
    }
    if (values[OPTION_BUDGET].given && values[OPTION_BUDGET_MS].given) {
        return usage_error(a->command, "--budget and --budget-ms: give one of them");
    }
    if (values[OPTION_DAY].given && !values[OPTION_SUN].given) {
        return usage_error(a->command, "--day: needs a sun at noon; give --sun AZ,EL,LUX");
    }
    double sun[3];
    if (values[OPTION_DAY].given && number_parse_list(values[OPTION_SUN].text, sun, 3) != NULL &&
        !(sun[1] > 0.0)) {
        return usage_error(a->command, "--day: the sun is below the horizon at noon; give --sun "
                                       "AZ,EL,LUX with EL above 0");
    }
    const bool read = a->command == COMMAND_AMBIENCE || a->command == COMMAND_VIEW; // or by a mode
    if (!read && values[OPTION_BOUNCES].given) {
        return usage_error(a->command, "--bounces: does not apply to --with ambience");
    }
    return EXIT_DONE;
}

int flight_run_refuse(const command_line *a)
{
    static const struct {
        const char *name;
        option_id id;
    } own[] = {{"--path", OPTION_PATH},
               {"--time", OPTION_TIME},
               {"--fps", OPTION_FPS},
               {"--budget", OPTION_BUDGET},
               {"--budget-ms", OPTION_BUDGET_MS},
               {"--depth", OPTION_DEPTH},
               {"--anchors", OPTION_ANCHORS},
               {"--lifetime", OPTION_LIFETIME},
               {"--fade", OPTION_FADE},
               {"--flat", OPTION_FLAT},
               {"--prediction", OPTION_PREDICTION},
               {"--day", OPTION_DAY},
               {"--visibility", OPTION_VISIBILITY},
               {"--warm", OPTION_WARM},
               {"--detail", OPTION_DETAIL}};
    for (size_t i = 0; i < sizeof own / sizeof *own; i++) {
        const bool shared = own[i].id == OPTION_PATH && a->command == COMMAND_VIEW; // of its camera
        if (a->values[own[i].id].given && !shared) {
            return usage_error(a->command, "%s: does not apply to --with %s", own[i].name,
                               a->values[OPTION_WITH].text);
        }
    }
    return EXIT_DONE;
}

/// Cells that let a third of the anchors fill the scene; 1 m where these would be larger than 1.5
/// m.
static double choose_cell(const alp_scene_info *info, double anchors)
{
    double volume = 1.0;
    for (int k = 0; k < 3; k++) {
        volume *= fmax((double)info->bounds_max[k] - (double)info->bounds_min[k], 1e-3);
    }
    const double cell = cbrt(volume / (0.35 * anchors));
    return cell < 1.5 ? cell : 1.0;
}

/// The root is as large as the scene.
static alp_ambience_options make_options(const flight_run *run, const command_line *a)
{
    const option_value *values = a->values;
    const alp_scene_info info = alp_scene_get_info(run->session->scene);
    const double x = (double)info.bounds_max[0] - (double)info.bounds_min[0];
    const double z = (double)info.bounds_max[2] - (double)info.bounds_min[2];
    const double extent = fmax(fmax(x, z), 1e-3);
    alp_ambience_options o = alp_ambience_options_default();
    const double cell = values[OPTION_CELL].choice < 0
                            ? values[OPTION_CELL].real
                            : choose_cell(&info, (double)values[OPTION_ANCHORS].whole);
    o.depth = 1;
    o.size = 3.0 * cell;
    const bool fitted = values[OPTION_DEPTH].choice >= 0;
    const uint32_t depth = fitted ? DEPTH_LIMIT : (uint32_t)values[OPTION_DEPTH].whole;
    while (o.depth < depth && (!fitted || o.size < extent)) {
        o.depth++;
        o.size *= 3.0;
    }
    memcpy(o.centre, run->path.points[0].position, sizeof o.centre);
    o.flat = values[OPTION_FLAT].choice == 1;
    o.lifetime = values[OPTION_LIFETIME].real;
    o.fade = values[OPTION_FADE].real;
    o.anchor_limit = (uint32_t)values[OPTION_ANCHORS].whole;
    o.visibility = values[OPTION_VISIBILITY].choice == 1;
    if (a->command == COMMAND_AMBIENCE) {
        o.lookup = (alp_ambience_lookup)values[OPTION_LOOKUP].choice;
    }
    return o;
}

// --- opening -------------------------------------------------------------------------------------

static int read_path(const command_line *a, flight_run *run)
{
    const alp_scene_info info = alp_scene_get_info(run->session->scene);
    if (!a->values[OPTION_PATH].given) {
        flight_terrain(&run->path);
        return EXIT_DONE;
    }
    return flight_read(a->values[OPTION_PATH].text, info.origin, &run->path);
}

static int set_times(const command_line *a, flight_run *run)
{
    const option_value *time = &a->values[OPTION_TIME];
    run->start = flight_start(&run->path);
    run->end = time->given ? time->real : flight_end(&run->path);
    run->fps = a->values[OPTION_FPS].real;
    if (run->end < run->start) {
        char text[160];
        snprintf(text, sizeof text, "--time %g: the flight begins at %g s; give a later time",
                 run->end, run->start);
        return failure(text);
    }
    const double before = ceil((run->end - run->start) * run->fps - 1e-6);
    run->frame_count = (uint64_t)fmax(before, 0.0);
    if (a->command != COMMAND_AMBIENCE || run->frame_count == 0) { // light is read at the end
        run->frame_count++;
    }
    return EXIT_DONE;
}

static void keep_known_path(flight_run *run)
{
    run->known = allocate_or_exit(NULL, run->path.count * sizeof *run->known);
    for (uint32_t i = 0; i < run->path.count; i++) {
        const flight_point *p = &run->path.points[i];
        run->known[i][0] = p->time;
        memcpy(&run->known[i][1], p->position, sizeof p->position);
    }
}

static alp_ambience_camera make_camera(const flight_run *run, const flight_camera *c)
{
    alp_ambience_camera camera = {.vfov = c->vfov};
    for (int k = 0; k < 3; k++) {
        camera.position[k] = c->position[k];
        camera.velocity[k] = c->velocity[k];
        camera.forward[k] = c->target[k] - c->position[k];
    }
    camera.path = (const double(*)[4])run->known;
    camera.path_count = run->known != NULL ? run->path.count : 0;
    return camera;
}

static alp_result make_volume(const command_line *a, flight_run *run)
{
    alp_ambience_sampler_options o = alp_ambience_sampler_options_default();
    o.lighting = run->lighting;
    o.direct = !command_is_picture(a->command) && a->values[OPTION_DIRECT].choice == 1;
    o.detail = (float)run->detail;
    o.seed = a->values[OPTION_SEED].whole;
    run->options = make_options(run, a);
    alp_result result = alp_ambience_create(run->session->context, &run->options, &run->ambience);
    if (result == ALP_OK) {
        result = alp_ambience_sampler_create(run->ambience, run->session->scene, &o, &run->sampler);
    }
    if (result == ALP_OK && a->values[OPTION_WARM].choice == 1) {
        const flight_camera first = flight_at(&run->path, run->start);
        const alp_ambience_camera camera = make_camera(run, &first);
        result = alp_ambience_sampler_warm(run->sampler, &camera, run->start, WARM_BOUNCES);
    }
    return result;
}

int flight_run_open(session *s, const command_line *a, const alp_lighting_options *lighting,
                    flight_run *run)
{
    *run = (flight_run){
        .session = s, .noon = *lighting, .lighting = *lighting, .opened = clock_seconds()};
    run->day = a->values[OPTION_DAY].given ? a->values[OPTION_DAY].real : 0.0;
    run->detail = a->values[OPTION_DETAIL].real;
    run->budget = (uint32_t)a->values[OPTION_BUDGET].whole;
    if (a->values[OPTION_BUDGET_MS].given) {
        run->budget = BUDGET_LIMIT;
        run->budget_ms = a->values[OPTION_BUDGET_MS].real;
    }
    int code = read_path(a, run);
    code = code == EXIT_DONE ? set_times(a, run) : code;
    if (code != EXIT_DONE) {
        return code;
    }
    if (a->values[OPTION_PREDICTION].choice == 1) {
        keep_known_path(run);
    }
    return session_end(s, make_volume(a, run));
}

void flight_run_close(flight_run *run)
{
    alp_ambience_sampler_destroy(run->sampler);
    alp_ambience_destroy(run->ambience);
    free(run->known);
    flight_clear(&run->path);
    *run = (flight_run){0};
}

// --- frames --------------------------------------------------------------------------------------

bool flight_run_progress(void *user, const alp_progress *unused)
{
    flight_run *run = user;
    (void)unused;
    const double done = (double)run->frame, left = (double)run->frame_count - done;
    const bool known = run->frame > 0;
    const alp_progress state = {
        .stage = "fly",
        .done = run->frame,
        .total = run->frame_count,
        .rays_per_second = run->seconds > 0.0 ? (double)run->rays / run->seconds : 0.0,
        .seconds_left = known ? (clock_seconds() - run->opened) * left / done : -1.0};
    return session_progress(run->session, &state);
}

static double time_of(const flight_run *run, uint64_t frame)
{
    return fmin(run->start + (double)frame / run->fps, run->end);
}

/// The light of a time; the sampler gets it LIGHT_STEPS times a second.
static alp_result move_sun(flight_run *run, double time)
{
    if (!(run->day > 0.0)) {
        return ALP_OK;
    }
    run->lighting = day_lighting(&run->noon, run->day, time - run->start);
    const uint64_t step = (uint64_t)((time - run->start) * LIGHT_STEPS + 1e-6);
    if (step == run->light_step) {
        return ALP_OK;
    }
    run->light_step = step;
    return alp_ambience_sampler_set_lighting(run->sampler, &run->lighting);
}

alp_result flight_run_next(flight_run *run, flight_frame *frame)
{
    if (!flight_run_progress(run, NULL)) {
        return ALP_ERROR_CANCELLED;
    }
    const double time = time_of(run, run->frame), begin = clock_seconds();
    *frame = (flight_frame){.time = time, .camera = flight_at(&run->path, time)};
    const alp_ambience_camera camera = make_camera(run, &frame->camera);
    alp_result result = move_sun(run, time);
    if (result == ALP_OK) {
        result = alp_ambience_update(run->ambience, time);
    }
    if (result == ALP_OK) {
        result =
            alp_ambience_sample(run->sampler, &camera, run->budget, run->budget_ms, &frame->work);
    }
    frame->seconds = clock_seconds() - begin;
    run->seconds += frame->seconds;
    run->rays += frame->work.rays;
    run->frame++;
    return result;
}

flight_camera flight_run_camera(const flight_run *run)
{
    return flight_at(&run->path, time_of(run, run->frame > 0 ? run->frame - 1 : 0));
}

alp_result flight_run_reach(flight_run *run, double time)
{
    alp_result result = ALP_OK;
    flight_frame frame;
    while (run->frame < run->frame_count && time_of(run, run->frame) <= time && result == ALP_OK) {
        result = flight_run_next(run, &frame);
    }
    return result;
}
