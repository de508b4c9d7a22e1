// SPDX-License-Identifier: MIT
// Models of light in space against the truth: irradiance at random free points with random normals.
//
// The truth is two references y₁ and y₂ that are independent of each other and of the model, so
// that E[(x − y₁)(x − y₂)] is the squared error of the model's x without theirs.
#include "bench.h"

#include "base/memory.h"
#include "fields/probes/probes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 2000, QUICK_POINTS = 64, PATHS = 512, QUICK_PATHS = 32 };
enum { STEPS = 3, PATH_SIZE = 1024 };
enum { SEED_POINTS = 77, SEED_FIRST = 101, SEED_SECOND = 102 };

typedef struct field_scene {
    const char *name, *title;
    const char *sky;       // a picture below $ALPENGLOW_SHARED, or NULL
    float spacings[STEPS]; // metres
    bool shared;           // a file below $ALPENGLOW_SHARED
    bool even;             // under a sky of radiance 1
} field_scene;

static const field_scene scenes[] = {
    {.name = "builtin:cornell", .title = "cornell", .spacings = {0.07f, 0.035f, 0.0175f}},
    {.name = "builtin:teapot-room", .title = "teapot-room", .spacings = {1.0f, 0.5f, 0.25f}},
    {.name = "builtin:atrium", .title = "atrium", .spacings = {2.0f, 1.0f, 0.5f}, .even = true},
    {.name = "scenes/architecture/living_room.glb",
     .title = "living_room",
     .shared = true,
     .spacings = {1.0f, 0.5f, 0.25f},
     .sky = "scenes/hdr/spiaggia_di_mondello_1k.hdr"},
    {.name = "scenes/architecture/zdm2.glb",
     .title = "zdm2",
     .shared = true,
     .spacings = {8.0f, 4.0f, 2.0f},
     .sky = "scenes/hdr/royal_esplanade_1k.hdr"},
};
enum { SCENE_COUNT = sizeof scenes / sizeof *scenes };

/// A scene with its light, the points, and the truth of them.
typedef struct field_case {
    const field_scene *what;
    const bench_options *options;
    bench_scene scene;
    alp_image *sky;
    alp_lighting_options light;
    uint32_t count;
    float (*positions)[3], (*normals)[3], (*halves[2])[3], (*values)[3];
    double *squares;  // [count] squared error of each
    double mean, own; // of the truth: mean of E, and its error over that
    bench_table table;
} field_case;

// --- scenes --------------------------------------------------------------------------------------

/// The path of something below $ALPENGLOW_SHARED, in `path`. @return false: it is not there
static bool find_shared(const char *relative, char path[PATH_SIZE])
{
    const char *found = bench_shared(relative, NULL);
    return found != NULL && snprintf(path, PATH_SIZE, "%s", found) > 0;
}

static alp_result light_case(field_case *c, const char *sky)
{
    c->light = alp_lighting_options_default();
    if (sky != NULL) {
        ALP_TRY(alp_image_load(c->scene.context, sky, &c->sky));
        c->light.sky.kind = ALP_SKY_IMAGE;
        c->light.sky.image = c->sky;
    } else if (c->what->even) {
        c->light.sky.kind = ALP_SKY_CONSTANT;
    }
    return ALP_OK;
}

static alp_result trace_half(field_case *c, int half)
{
    alp_reference_options o = alp_reference_options_default();
    o.lighting = c->light;
    o.samples = c->options->quick ? QUICK_PATHS : PATHS;
    o.seed = half == 0 ? SEED_FIRST : SEED_SECOND;
    return alp_reference_irradiance(c->scene.scene, &o, c->count, (const float(*)[3])c->positions,
                                    (const float(*)[3])c->normals, c->halves[half], NULL);
}

static alp_result find_truth(field_case *c)
{
    double sum = 0.0, apart = 0.0;
    ALP_TRY(alp_scene_free_points(c->scene.scene, SEED_POINTS, c->count, c->positions, c->normals));
    ALP_TRY(trace_half(c, 0));
    ALP_TRY(trace_half(c, 1));
    for (uint32_t i = 0; i < c->count; i++) {
        for (int k = 0; k < 3; k++) {
            const double a = (double)c->halves[0][i][k], b = (double)c->halves[1][i][k];
            sum += 0.5 * (a + b);
            apart += 0.25 * (a - b) * (a - b);
        }
    }
    c->mean = sum / (3.0 * c->count);
    c->own = sqrt(apart / (3.0 * c->count)) / c->mean;
    return ALP_OK;
}

// --- models --------------------------------------------------------------------------------------

/// The error of a model, over the mean of the truth.
typedef struct field_verdict {
    double rmse, bias, stated; // stated: over the true error, 0: none
    double most;               // the error without the hundredth of the points that err the most
} field_verdict;

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// The error that a field states, root mean square over the points.
static double state_error(const field_case *c, const alp_field *field)
{
    double squares = 0.0;
    for (uint32_t i = 0; i < c->count; i++) {
        float error = 0.0f;
        alp_field_errors(field, 1, (const float(*)[3]) & c->positions[i],
                         (const float(*)[3]) & c->normals[i], &error);
        squares += (double)error * (double)error;
    }
    return sqrt(squares / c->count);
}

static field_verdict judge(field_case *c, const alp_field *field)
{
    double squares = 0.0, sum = 0.0, most = 0.0;
    const uint32_t kept = c->count - c->count / 100;
    alp_field_irradiance(field, c->count, (const float(*)[3])c->positions,
                         (const float(*)[3])c->normals, c->values);
    for (uint32_t i = 0; i < c->count; i++) {
        c->squares[i] = 0.0;
        for (int k = 0; k < 3; k++) {
            const double x = (double)c->values[i][k];
            const double a = x - (double)c->halves[0][i][k], b = x - (double)c->halves[1][i][k];
            c->squares[i] += a * b;
            sum += 0.5 * (a + b);
        }
        squares += c->squares[i];
    }
    qsort(c->squares, c->count, sizeof *c->squares, compare);
    for (uint32_t i = 0; i < kept; i++) {
        most += c->squares[i];
    }
    const double all = 3.0 * c->count, rmse = sqrt(fmax(squares, 0.0) / all);
    return (field_verdict){.rmse = rmse / c->mean,
                           .bias = sum / all / c->mean,
                           .most = sqrt(fmax(most, 0.0) / (3.0 * kept)) / c->mean,
                           .stated = state_error(c, field) / fmax(rmse, 1e-30)};
}

static void add_row(field_case *c, const char *model, const alp_probes *probes,
                    const alp_field *field, bool states, double seconds)
{
    char places[2][BENCH_CELL_SIZE] = {"–", "–"}, stated[BENCH_CELL_SIZE] = "–";
    char time[BENCH_CELL_SIZE] = "–";
    const field_verdict v = judge(c, field);
    if (probes != NULL) {
        snprintf(places[0], BENCH_CELL_SIZE, "%.4g",
                 (double)alp_probes_get_info(probes).spacing[0]);
        snprintf(places[1], BENCH_CELL_SIZE, "%u", alp_probes_get_info(probes).count);
    }
    if (states && v.stated > 0.0) {
        snprintf(stated, BENCH_CELL_SIZE, "%.2f", v.stated);
    }
    if (seconds > 0.0) {
        snprintf(time, BENCH_CELL_SIZE, "%.1f", seconds);
    }
    bench_table_add(&c->table, "%s|%s|%s|%.2f|%.2f|%+.2f|%s|%s", model, places[0], places[1],
                    100.0 * v.rmse, 100.0 * v.most, 100.0 * v.bias, stated, time);
}

static alp_result measure_classics(field_case *c)
{
    static const char *const names[ALP_AMBIENT_COUNT] = {"constant", "hemisphere", "ground map",
                                                         "ambient cube", "environment"};
    for (int m = 0; m < ALP_AMBIENT_COUNT; m++) {
        alp_ambient_options o = alp_ambient_options_default();
        alp_field *field = NULL;
        o.model = (alp_ambient_model)m;
        o.lighting = c->light;
        o.points = c->options->quick ? QUICK_POINTS : o.points;
        o.samples = c->options->quick ? QUICK_PATHS : o.samples;
        const double started = bench_process_seconds();
        ALP_TRY(alp_field_create_ambient(c->scene.scene, &o, &field));
        add_row(c, names[m], NULL, field, false, bench_process_seconds() - started);
        alp_field_destroy(field);
    }
    return ALP_OK;
}

/// The same probes as a field of a basis, with or without visibility.
static alp_result measure_variant(field_case *c, const alp_probes *probes, const char *model,
                                  alpi_probe_basis basis, bool visibility)
{
    alpi_probe_volume v = probes->volume;
    const uint32_t floats = 3 * alpi_probe_basis_count(basis);
    float *coefficients = bench_allocate((size_t)v.count * floats, sizeof *coefficients);
    alp_field *field = NULL;
    for (uint32_t i = 0; i < v.count; i++) {
        alpi_sh9 radiance;
        memcpy(radiance.c, v.coefficients + (size_t)i * 27, sizeof radiance.c);
        alpi_probe_project(&radiance, basis, (float(*)[3])(coefficients + (size_t)i * floats));
    }
    v.basis = basis;
    v.coefficient_count = floats / 3;
    v.coefficients = coefficients;
    v.moments = visibility ? v.moments : NULL;
    const alp_result result =
        alpi_probe_field_create(&v, ALP_LOOKUP_OURS, c->scene.scene->origin, NULL, &field);
    if (result == ALP_OK) {
        add_row(c, model, probes, field, false, 0.0);
    }
    alp_field_destroy(field);
    free(coefficients);
    return result;
}

static alp_result measure_lookup(field_case *c, const alp_probes *probes, const char *model,
                                 alp_probe_lookup lookup, double seconds)
{
    alp_field *field = NULL;
    ALP_TRY(alp_field_create_probes(probes, lookup, c->scene.scene->origin, NULL, &field));
    add_row(c, model, probes, field, lookup == ALP_LOOKUP_OURS, seconds);
    alp_field_destroy(field);
    return ALP_OK;
}

static alp_result bake(field_case *c, float spacing, bool gradients, alp_probes **probes,
                       double *seconds)
{
    alp_probe_options o = alp_probe_options_default();
    const double started = bench_process_seconds();
    o.lighting = c->light;
    o.spacing = spacing;
    o.gradients = gradients;
    o.rays = c->options->quick ? 384 : o.rays;
    o.atlas_size = c->options->quick ? 128 : o.atlas_size;
    ALP_TRY(alp_probes_bake(c->scene.scene, &o, probes));
    *seconds = bench_process_seconds() - started;
    return ALP_OK;
}

static alp_result measure_bases(field_case *c, const alp_probes *probes)
{
    ALP_TRY(measure_variant(c, probes, "probes, SH4", ALPI_PROBE_SH4, true));
    return measure_variant(c, probes, "probes, ambient cube", ALPI_PROBE_AMBIENT_CUBE, true);
}

/// All rows of one spacing. The middle one has the other bases and gradients too.
static alp_result measure_probes(field_case *c, int step)
{
    const float spacing = c->what->spacings[step];
    const bool more = step == STEPS / 2;
    alp_probes *probes = NULL;
    double seconds = 0.0;
    ALP_TRY(bake(c, spacing, false, &probes, &seconds));
    alp_result result = measure_lookup(c, probes, "probes", ALP_LOOKUP_OURS, seconds);
    if (result == ALP_OK) {
        result = measure_variant(c, probes, "probes, no visibility", ALPI_PROBE_SH9, false);
    }
    if (result == ALP_OK) {
        result = measure_lookup(c, probes, "probes, three.js look-up", ALP_LOOKUP_THREE, 0.0);
    }
    if (result == ALP_OK && more) {
        result = measure_bases(c, probes);
    }
    alp_probes_destroy(probes);
    probes = NULL;
    if (result == ALP_OK && more) {
        result = bake(c, spacing, true, &probes, &seconds);
    }
    if (result == ALP_OK && more) {
        result = measure_lookup(c, probes, "probes, gradients", ALP_LOOKUP_OURS, seconds);
    }
    alp_probes_destroy(probes);
    return result;
}

// --- all -----------------------------------------------------------------------------------------

static void start_table(field_case *c)
{
    static char title[PATH_SIZE], note[PATH_SIZE];
    snprintf(title, sizeof title, "%s", c->what->title);
    snprintf(note, sizeof note,
             "%u points, mean E %.4g; error of the truth itself %.2f %%. Light: %s.", c->count,
             c->mean, 100.0 * c->own,
             c->what->sky != NULL ? strrchr(c->what->sky, '/') + 1
             : c->what->even      ? "an even sky of radiance 1"
                                  : "its own");
    bench_table_start(&c->table, title, note,
                      "model|spacing, m|probes|error, %|of 99 %|bias, %|stated / true|processor s");
}

static alp_result run_case(field_case *c, const char *sky)
{
    ALP_TRY(light_case(c, sky));
    ALP_TRY(find_truth(c));
    start_table(c);
    ALP_TRY(measure_classics(c));
    for (int i = 0; i < (c->options->quick ? 1 : STEPS); i++) {
        ALP_TRY(measure_probes(c, i));
    }
    bench_table_print(&c->table, c->options);
    fflush(stdout);
    return ALP_OK;
}

static bool run_scene(const field_scene *what, const bench_options *options)
{
    char path[PATH_SIZE], sky[PATH_SIZE];
    if ((what->shared && !find_shared(what->name, path)) ||
        (what->sky != NULL && !find_shared(what->sky, sky))) {
        bench_table skipped;
        bench_table_start(&skipped, what->title, "Skipped: not below ALPENGLOW_SHARED.", "model");
        bench_table_print(&skipped, options);
        return true;
    }
    field_case c = {.what = what, .options = options};
    if (!bench_scene_open(what->shared ? path : what->name, 0, &c.scene)) {
        return false;
    }
    c.count = options->quick ? QUICK_POINTS : POINTS;
    c.positions = bench_allocate(c.count, sizeof *c.positions);
    c.normals = bench_allocate(c.count, sizeof *c.normals);
    c.halves[0] = bench_allocate(c.count, sizeof *c.halves[0]);
    c.halves[1] = bench_allocate(c.count, sizeof *c.halves[1]);
    c.values = bench_allocate(c.count, sizeof *c.values);
    c.squares = bench_allocate(c.count, sizeof *c.squares);
    const bool good = bench_good(&c.scene, run_case(&c, what->sky != NULL ? sky : NULL));
    free(c.positions);
    free(c.normals);
    free(c.halves[0]);
    free(c.halves[1]);
    free(c.values);
    free(c.squares);
    alp_image_destroy(c.sky);
    bench_scene_close(&c.scene);
    return good;
}

int bench_fields(const bench_options *options)
{
    const field_scene other = {
        .name = options->scene, .title = options->scene, .spacings = {2.0f, 1.0f, 0.5f}};
    bool good = true, found = false;
    const int count = options->quick && options->scene == NULL ? 1 : SCENE_COUNT;
    for (int i = 0; i < count && good; i++) {
        if (options->scene == NULL || strcmp(options->scene, scenes[i].title) == 0) {
            good = run_scene(&scenes[i], options);
            found = true;
        }
    }
    return (found ? good : run_scene(&other, options)) ? 0 : 1;
}
