// SPDX-License-Identifier: MIT
// The ambience volume against the truth: along flights through builtin:terrain, and at fixed places
// that are hard to light.
#include "ambience_world.h"
#include "corner_octree.h"

#include <alpenglow/field.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PATHS = 2048, QUICK_PATHS = 16, MOMENTS_MOST = 12, CLASSICS = 2 };
enum { CLASSIC_POINTS = 1024, QUICK_CLASSIC_POINTS = 16, CLASSIC_PATHS = 256 };
enum { OCTREE_DEPTH = 8, OBJECT_FRAMES = 6 };

/// The models that are judged.
typedef enum quality_model {
    OURS, // the volume: views of it
    BLIND,
    CONFORMANCE,
    FLAT,
    FLAT_BLIND,
    OCTREE,
    OBJECT,
    CONSTANT,
    HEMISPHERE,
    MODELS
} quality_model;
static const char *const names[MODELS] = {
    "ours",          "no visibility",     "conformance", "flat",      "flat, no visibility",
    "corner octree", "a probe an object", "constant",    "hemisphere"};

typedef struct quality_bench {
    const bench_options *options;
    ambience_world world;
    alp_field *classics[CLASSICS];
    ambience_run volume, flat;
    corner_octree *octree;
    ambience_points points[MOMENTS_MOST]; // of the moments of a flight
    ambience_verdict found[WORLD_FLIGHTS][MODELS][MOMENTS_MOST];
    alp_ambience_info landed; // of the volume, when a flight ends
    double own;
    uint32_t paths;
} quality_bench;

// --- models --------------------------------------------------------------------------------------

static alp_result fit_classics(quality_bench *b)
{
    for (int i = 0; i < CLASSICS; i++) {
        alp_ambient_options o = alp_ambient_options_default();
        o.model = i == 0 ? ALP_AMBIENT_CONSTANT : ALP_AMBIENT_HEMISPHERE;
        o.lighting = b->world.light;
        o.points = b->options->quick ? QUICK_CLASSIC_POINTS : CLASSIC_POINTS;
        o.samples = b->options->quick ? QUICK_PATHS : CLASSIC_PATHS;
        ALP_TRY(alp_field_create_ambient(b->world.scene.scene, &o, &b->classics[i]));
    }
    return ALP_OK;
}

static void read_classic(const quality_bench *b, int classic, const ambience_points *p)
{
    for (uint32_t i = 0; i < p->count; i++) {
        const float place[3] = {(float)p->positions[i][0], (float)p->positions[i][1],
                                (float)p->positions[i][2]};
        alp_field_irradiance(b->classics[classic], 1, &place, (const float(*)[3]) & p->normals[i],
                             &p->values[i]);
    }
}

/// Objects that fly with the camera. Each has a probe at its middle, one of which is sampled every
/// OBJECT_FRAMES frames: that of object i is so many frames times i old.
static bool read_objects(const quality_bench *b, const alp_ambience_snapshot *bounced, int flight,
                         double time, const ambience_points *p)
{
    double(*places)[3] = bench_allocate(p->count, sizeof *places);
    alpi_sh9 *lights = bench_allocate(p->count, sizeof *lights);
    alp_ambience_camera now = {0}, then = {0};
    for (uint32_t i = 0; i < p->count; i++) {
        if (flight >= 0) {
            ambience_world_fly(&b->world, flight, time, &now);
            ambience_world_fly(&b->world, flight, time - OBJECT_FRAMES * i / WORLD_FRAMES, &then);
        }
        for (int k = 0; k < 3; k++) {
            places[i][k] = p->positions[i][k] - (now.position[k] - then.position[k]);
        }
    }
    const bool good = ambience_world_sample(&b->world, bounced, p->count,
                                            (const double(*)[3])places, lights, NULL);
    for (uint32_t i = 0; i < p->count && good; i++) {
        const vec3 e = alpi_sh9_irradiance(&lights[i], vec3_load(p->normals[i]));
        vec3_store(p->values[i], (vec3){fmaxf(e.x, 0.0f), fmaxf(e.y, 0.0f), fmaxf(e.z, 0.0f)});
    }
    free(places);
    free(lights);
    return good;
}

/// Judges all models. @param flight −1: none, the camera stands
static bool judge_all(const quality_bench *b, int flight, double time, const ambience_points *p,
                      ambience_verdict found[MODELS])
{
    const double(*positions)[3] = (const double(*)[3])p->positions;
    const float(*normals)[3] = (const float(*)[3])p->normals;
    const alp_ambience_snapshot *volume = alp_ambience_begin_read(b->volume.ambience);
    const alp_ambience_snapshot *flat = alp_ambience_begin_read(b->flat.ambience);
    bool good = true;
    for (int m = 0; m < MODELS && good; m++) {
        if (m <= CONFORMANCE) {
            const ambience_view view = (ambience_view)(m - OURS);
            ambience_view_read(volume, view, p->count, positions, normals, p->values);
        } else if (m <= FLAT_BLIND) {
            const ambience_view view = m == FLAT ? VIEW_OURS : VIEW_BLIND;
            ambience_view_read(flat, view, p->count, positions, normals, p->values);
        } else if (m == OCTREE && b->octree == NULL) {
            continue;
        } else if (m == OCTREE) {
            corner_octree_read(b->octree, p->count, positions, normals, p->values);
        } else if (m == OBJECT) {
            good = read_objects(b, volume, flight, time, p);
        } else {
            read_classic(b, m - CONSTANT, p);
        }
        found[m] = ambience_points_judge(p);
    }
    alp_ambience_end_read(b->volume.ambience, volume);
    alp_ambience_end_read(b->flat.ambience, flat);
    return good;
}

// --- runs ----------------------------------------------------------------------------------------

static double read_height(void *user, double x, double z)
{
    const ambience_world *w = user;
    return fmax((double)alpi_terrain_height(w->ground, (float)x, (float)z), 0.0);
}

static bool open_runs(quality_bench *b)
{
    alp_ambience_options o = alp_ambience_options_default();
    alp_ambience_options flat = o;
    flat.flat = true;
    flat.height = read_height;
    flat.height_user = &b->world;
    return ambience_run_open(&b->world, &o, &b->volume) &&
           ambience_run_open(&b->world, &flat, &b->flat);
}

static void close_runs(quality_bench *b)
{
    ambience_run_close(&b->volume);
    ambience_run_close(&b->flat);
    corner_octree_destroy(b->octree);
    b->octree = NULL;
}

/// One frame of all. The octree gets the samples that the volume took.
static bool step_runs(quality_bench *b, double time, const alp_ambience_camera *camera)
{
    const uint32_t samples = b->options->quick ? 8 : WORLD_SAMPLES;
    const uint64_t before = b->volume.samples;
    bool good = ambience_run_step(&b->world, &b->volume, time, camera, samples) &&
                ambience_run_step(&b->world, &b->flat, time, camera, samples);
    if (good && b->octree != NULL) {
        const alp_ambience_snapshot *bounced = alp_ambience_begin_read(b->volume.ambience);
        good = corner_octree_step(b->octree, &b->world, bounced, camera->position,
                                  (uint32_t)(b->volume.samples - before));
        alp_ambience_end_read(b->volume.ambience, bounced);
    }
    return good;
}

// --- flights -------------------------------------------------------------------------------------

/// Seconds of a moment: the start, each second in flight, then the end of the rest.
static double moment_time(int moment)
{
    return moment <= (int)WORLD_FLIES ? WORLD_STANDS + moment
                                      : WORLD_STANDS + WORLD_FLIES + (moment - WORLD_FLIES);
}
static int moment_count(void)
{
    return 1 + (int)(WORLD_FLIES + WORLD_RESTS);
}

static bool find_points(quality_bench *b, int flight)
{
    bool good = true;
    for (int i = 0; i < moment_count() && good; i++) {
        alp_ambience_camera camera;
        ambience_world_fly(&b->world, flight, moment_time(i), &camera);
        good = ambience_points_open(&b->world, camera.position, WORLD_REACH,
                                    100 * (uint32_t)flight + (uint32_t)i, b->paths, &b->points[i]);
        b->own = good && b->points[i].own > b->own ? b->points[i].own : b->own;
    }
    return good;
}

/// Frames of a flight; small runs take two a second.
static bool fly(quality_bench *b, int flight)
{
    const double rate = b->options->quick ? 2.0 : WORLD_FRAMES;
    const int frames = (int)(rate * moment_time(moment_count() - 1));
    bool good = find_points(b, flight) && open_runs(b);
    alp_ambience_camera camera = {0};
    ambience_world_fly(&b->world, flight, 0.0, &camera);
    const double size = alp_ambience_options_default().size;
    b->octree = corner_octree_create((const double[3]){0.0, 0.0, 0.0}, size, OCTREE_DEPTH);
    for (int frame = 0, moment = 0; frame <= frames && good; frame++) {
        const double time = frame / rate;
        ambience_world_fly(&b->world, flight, time, &camera);
        good = step_runs(b, time, &camera);
        if (good && time >= moment_time(moment) - 1e-9) {
            ambience_verdict found[MODELS] = {{0.0, 0.0}};
            good = judge_all(b, flight, time, &b->points[moment], found);
            for (int m = 0; m < MODELS; m++) {
                b->found[flight][m][moment] = found[m];
            }
            if (moment == (int)WORLD_FLIES) {
                b->landed = alp_ambience_get_info(b->volume.ambience);
            }
            moment++;
        }
    }
    for (int i = 0; i < moment_count(); i++) {
        ambience_points_close(&b->points[i]);
    }
    return good;
}

static void print_seconds(const quality_bench *b)
{
    static bench_table table;
    bench_table_start(&table, "Error by second of a flight, %",
                      "The volume with default options, 100 samples a frame, 60 frames a second: "
                      "two seconds at the start of a flight, six in flight at 30 m/s, five at its "
                      "end. Error: 100 Σ|E − truth| / Σ truth over 64 free points within 20 m of "
                      "the camera. Second 0 is the start.",
                      "second|camera|flight 1|2|3");
    for (int i = 0; i < moment_count(); i++) {
        const char *state = i == 0 ? "starts" : i <= (int)WORLD_FLIES ? "flies" : "stands";
        bench_table_add(&table, "%d|%s|%.1f|%.1f|%.1f", i, state, b->found[0][OURS][i].error,
                        b->found[1][OURS][i].error, b->found[2][OURS][i].error);
    }
    bench_table_print(&table, b->options);
}

/// Mean error over the seconds in flight, or that at the end.
static double flight_error(const quality_bench *b, int flight, int model, bool end)
{
    double sum = 0.0;
    for (int i = 1; i <= (int)WORLD_FLIES; i++) {
        sum += b->found[flight][model][i].error / WORLD_FLIES;
    }
    return end ? b->found[flight][model][moment_count() - 1].error : sum;
}

static void print_models(const quality_bench *b, int flights)
{
    static bench_table table;
    static char note[1000];
    snprintf(note, sizeof note,
             "Flying: mean error of the seconds in flight. After: five seconds after its end. "
             "Worst: the worst second of all flights. The truth's own error is at most %.2f %%.",
             100.0 * b->own);
    bench_table_start(&table, "Models along three flights, error in %", note,
                      "model|flying 1|flying 2|flying 3|after 1|after 2|after 3|worst|bias after");
    for (int m = 0; m < MODELS; m++) {
        double worst = 0.0, bias = 0.0, all[2][WORLD_FLIGHTS] = {{0.0}};
        for (int f = 0; f < flights; f++) {
            for (int i = 1; i < moment_count(); i++) {
                worst = fmax(worst, b->found[f][m][i].error);
            }
            bias += b->found[f][m][moment_count() - 1].bias / flights;
            all[0][f] = flight_error(b, f, m, false);
            all[1][f] = flight_error(b, f, m, true);
        }
        bench_table_add(&table, "%s|%.1f|%.1f|%.1f|%.1f|%.1f|%.1f|%.1f|%+.1f", names[m], all[0][0],
                        all[0][1], all[0][2], all[1][0], all[1][1], all[1][2], worst, bias);
    }
    bench_table_print(&table, b->options);
}

// --- what a flight leaves ------------------------------------------------------------------------

static void start_memory(bench_table *table)
{
    bench_table_start(
        table, "Bytes an anchor after a flight",
        "Anchors that hold light, and all bytes of the volume over them: graph, "
        "anchors and snapshots; distances for visibility; kept hits. Samples: new, "
        "renewed and relit. Processor ms a frame: updates and samples. Landed: when "
        "the flight ends; the others, after five seconds of rest.",
        "flight|landed|bytes then|anchors|solids|nodes|samples|bytes|visibility|hits|ms a "
        "frame");
}

static uint64_t own_bytes(const alp_ambience_info *info)
{
    return info->bytes - info->bytes_visibility - info->bytes_hits;
}

static void add_memory(const quality_bench *b, int flight, bench_table *table)
{
    const alp_ambience_info info = alp_ambience_get_info(b->volume.ambience);
    const double anchors = fmax(info.anchors, 1.0);
    bench_table_add(table, "%d|%u|%.0f|%u|%u|%u|%llu|%.0f|%.0f|%.0f|%.2f", flight + 1,
                    b->landed.anchors, (double)own_bytes(&b->landed) / fmax(b->landed.anchors, 1.0),
                    info.anchors, info.solids, info.nodes, (unsigned long long)b->volume.samples,
                    (double)own_bytes(&info) / anchors, (double)info.bytes_visibility / anchors,
                    (double)info.bytes_hits / anchors,
                    1e3 * b->volume.seconds / (WORLD_FRAMES * moment_time(moment_count() - 1)));
}

static void start_structures(bench_table *table)
{
    bench_table_start(table, "Octree with data in corners",
                      "The first structure of 2006, its leaves 0.95 m, and as many samples a frame "
                      "as the volume takes in the same flight. Its data is never renewed, as light "
                      "stands still. New sets: of coefficients for one branching, without and with "
                      "those that neighbours share. Error: mean of the seconds in flight, and five "
                      "seconds after.",
                      "flight|structure|sets|branchings|new sets|measured|flying|after");
}

static uint32_t count_branchings(const alp_ambience *a)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < a->graph.node_end; i++) {
        const alpi_graph_node *n = &a->graph.nodes[i];
        const bool live = i == ALPI_GRAPH_ROOT || n->parent != ALPI_NO_NODE;
        count += live && n->child != ALPI_NO_NODE && n->level <= a->graph.depth ? 1 : 0;
    }
    return count;
}

static void add_structures(const quality_bench *b, int flight, bench_table *table)
{
    const corner_octree_counts c = corner_octree_count(b->octree);
    const alp_ambience *a = b->volume.ambience;
    const uint32_t nodes = count_branchings(a);
    bench_table_add(table, "%d|corners of an octree|%u|%u|19|%.1f|%.1f|%.1f", flight + 1, c.corners,
                    c.cells, (double)c.corners / fmax(c.cells, 1.0),
                    flight_error(b, flight, OCTREE, false), flight_error(b, flight, OCTREE, true));
    bench_table_add(table, "%d|middles of 27 children|%u|%u|26|%.1f|%.1f|%.1f", flight + 1,
                    a->anchor_count, nodes, a->anchor_count / fmax(nodes, 1.0),
                    flight_error(b, flight, OURS, false), flight_error(b, flight, OURS, true));
}

// --- places --------------------------------------------------------------------------------------

typedef struct place_result {
    const char *name;
    ambience_verdict found[MODELS];
    double mean, own; // of the truth
} place_result;

static bool stand(quality_bench *b, int place, place_result *result)
{
    const ambience_place at = ambience_world_place(&b->world, place);
    const double rate = b->options->quick ? 1.0 : WORLD_FRAMES;
    alp_ambience_camera camera = {.vfov = 1.0};
    ambience_points *p = &b->points[0];
    memcpy(camera.position, at.position, sizeof camera.position);
    if (!ambience_points_open(&b->world, at.position, 3.0, 1000 + (uint32_t)place, b->paths, p)) {
        return false;
    }
    bool good = open_runs(b);
    for (int frame = 0; frame <= (int)(rate * WORLD_RESTS) && good; frame++) {
        good = step_runs(b, frame / rate, &camera);
    }
    good = good && judge_all(b, -1, 0.0, p, result->found);
    result->name = at.name;
    result->mean = p->mean;
    result->own = 100.0 * p->own;
    ambience_points_close(p);
    close_runs(b);
    return good;
}

static void print_places(const place_result r[WORLD_PLACES], const bench_options *options)
{
    static bench_table table;
    bench_table_start(&table, "Hard places",
                      "Fixed places of the terrain after five seconds of standing there, 64 free "
                      "points within 3 m: the middle between the nearest two houses (alley), 1.2 m "
                      "from the wall of one (wall), where trees stand closest (wood), and the "
                      "shore of the lake. A probe an object is sampled at the very point. Truth: "
                      "its standard error.",
                      "model, %|alley|bias|wall|bias|wood|bias|shore|bias");
    for (int m = 0; m < MODELS; m++) {
        if (m != OCTREE) {
            bench_table_add(&table, "%s|%.1f|%+.1f|%.1f|%+.1f|%.1f|%+.1f|%.1f|%+.1f", names[m],
                            r[0].found[m].error, r[0].found[m].bias, r[1].found[m].error,
                            r[1].found[m].bias, r[2].found[m].error, r[2].found[m].bias,
                            r[3].found[m].error, r[3].found[m].bias);
        }
    }
    bench_table_add(&table, "truth|%.1f|–|%.1f|–|%.1f|–|%.1f|–", r[0].own, r[1].own, r[2].own,
                    r[3].own);
    bench_table_print(&table, options);
}

static bool run_places(quality_bench *b)
{
    place_result results[WORLD_PLACES] = {{0}};
    bool good = true;
    for (int i = 0; i < (b->options->quick ? 1 : WORLD_PLACES) && good; i++) {
        good = stand(b, i, &results[i]);
    }
    if (good) {
        print_places(results, b->options);
    }
    return good;
}

// --- all -----------------------------------------------------------------------------------------

static bool run_flights(quality_bench *b)
{
    static bench_table memory, structures;
    const int flights = b->options->quick ? 1 : WORLD_FLIGHTS;
    bool good = true;
    start_memory(&memory);
    start_structures(&structures);
    for (int i = 0; i < flights && good; i++) {
        good = fly(b, i);
        if (good) {
            add_memory(b, i, &memory);
            add_structures(b, i, &structures);
        }
        close_runs(b);
    }
    if (good) {
        print_seconds(b);
        print_models(b, flights);
        bench_table_print(&memory, b->options);
        bench_table_print(&structures, b->options);
    }
    return good;
}

int bench_ambience_quality(const bench_options *options)
{
    static quality_bench b;
    b = (quality_bench){.options = options, .paths = options->quick ? QUICK_PATHS : PATHS};
    if (!ambience_world_open(options->quick ? "builtin:terrain,triangles=5000,trees=20"
                                            : "builtin:terrain",
                             0, options->quick, &b.world)) {
        return 1;
    }
    const bool good =
        bench_good(&b.world.scene, fit_classics(&b)) && run_flights(&b) && run_places(&b);
    for (int i = 0; i < CLASSICS; i++) {
        alp_field_destroy(b.classics[i]);
    }
    ambience_world_close(&b.world);
    return good ? 0 : 1;
}
