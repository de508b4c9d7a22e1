// SPDX-License-Identifier: MIT
// Technique × scene: how far the irradiance that each technique gives is from a converged bake of
// the same texels by the reference.
//
// The truth is two bakes y₁ and y₂ with many paths, independent of each other and of the technique,
// so that E[(x − y₁)(x − y₂)] is the squared error of x without their own.
#include "techniques.h"

#include "base/memory.h"
#include "base/random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Its own error shall be 1 % of the mean; where that would take more paths than the most, it is
// what it is, and stands in the table.
static const double WANTED_ERROR = 0.01;
enum { PILOT_PATHS = 256, LEAST_PATHS = 1024, MOST_PATHS = 16384, QUICK_PATHS = 128 };
enum { TEXELS = 2000, QUICK_TEXELS = 64, QUICK_SIZE = 32, TECHNIQUE_LIMIT = 32, PATH_SIZE = 1024 };
enum {
    SEED_TECHNIQUES = 1, // and those after it
    SEED_PILOT = 1001,
    SEED_FIRST = 1002,
    SEED_SECOND = 1003,
    SEED_CHOICE = 1004
};
static const double GREATEST_Z = 6.0; // of the mean of a technique without bias: 2e-9 by chance

typedef struct truth_scene {
    const char *name, *title;
    const char *sky;         // a picture below $ALPENGLOW_SHARED, or NULL
    double texels_per_metre; // 0: `size` is that of the page
    uint32_t size;
    bool shared; // a file below $ALPENGLOW_SHARED
    bool clear;  // the sky of a clear day, without the sun's disk
} truth_scene;

// The scenes of the truth table: fixed, so that figures compare over the years. The atrium has no
// light of its own.
static const truth_scene scenes[] = {
    {.name = "builtin:cornell", .title = "cornell", .size = 256},
    {.name = "builtin:windows", .title = "windows", .size = 512},
    {.name = "builtin:teapot-room", .title = "teapot-room", .size = 512},
    {.name = "builtin:atrium", .title = "atrium", .size = 512, .clear = true},
    {.name = "scenes/architecture/living_room.glb",
     .title = "living_room",
     .shared = true,
     .texels_per_metre = 4.0,
     .sky = "scenes/hdr/spiaggia_di_mondello_1k.hdr"},
    {.name = "scenes/architecture/zdm2.glb",
     .title = "zdm2",
     .shared = true,
     .texels_per_metre = 4.0,
     .sky = "scenes/hdr/royal_esplanade_1k.hdr"},
};
enum { SCENE_COUNT = sizeof scenes / sizeof *scenes };

/// The error of one technique on one scene, over the mean of the truth.
typedef struct verdict {
    double rmse, bias;
    double doubt;  // standard error of the bias: the technique's and the truth's
    double stated; // error; 0: it states none
} verdict;

/// What is printed of a scene.
typedef struct truth_summary {
    const truth_scene *what;
    bool known;              // false: the scene is not to be had
    uint32_t texels, asked;  // of the map
    uint32_t paths;          // of both halves of the truth
    double mean, own, doubt; // of the truth: mean of E, its error and its mean's over that
    verdict verdicts[TECHNIQUE_LIMIT];
} truth_summary;

/// A scene with its light, the texels that are asked, and the truth of them.
typedef struct truth_case {
    const truth_scene *what;
    truth_summary *told;
    bench_scene scene;
    bench_map map;
    alp_image *sky;
    alp_lighting_options light;
    alpi_lighting *lighting;
    uint32_t *list;
    alpi_reference_value *halves[2], *whole; // [question.count]
    bench_question question;
} truth_case;

// --- scenes --------------------------------------------------------------------------------------

static alp_result light_case(truth_case *c, const char *sky)
{
    c->light = alp_lighting_options_default();
    if (sky != NULL) {
        ALP_TRY(alp_image_load(c->scene.context, sky, &c->sky));
        c->light.sky.kind = ALP_SKY_IMAGE;
        c->light.sky.image = c->sky;
    } else if (c->what->clear) {
        c->light.sky.kind = ALP_SKY_CLEAR;
        c->light.sun.azimuth = (float)(150.0 * ALPI_PI / 180.0);
        c->light.sun.elevation = (float)(40.0 * ALPI_PI / 180.0);
    }
    return alpi_lighting_create(c->scene.scene, &c->light, &c->lighting);
}

/// Texels by a keyed draw without replacement: the first `count` of a shuffled order. Those wholly
/// inside other geometry are not asked.
static void choose_texels(truth_case *c, uint32_t count)
{
    uint32_t all = 0;
    uint32_t *order = bench_allocate(c->map.texels.count, sizeof *order);
    for (uint32_t i = 0; i < c->map.texels.count; i++) {
        if (!c->map.validity.dropped[i]) {
            order[all++] = i;
        }
    }
    count = count < all ? count : all;
    for (uint32_t i = 0; i < count; i++) {
        const uint64_t drawn = alpi_hash64(alpi_hash64(SEED_CHOICE) ^ i);
        const uint32_t k = i + (uint32_t)(drawn % (all - i)), texel = order[k];
        order[k] = order[i];
        order[i] = texel;
    }
    c->list = order;
    c->question = (bench_question){.scene = &c->scene,
                                   .map = &c->map,
                                   .lighting = c->lighting,
                                   .light = &c->light,
                                   .count = count,
                                   .list = order};
}

static void close_case(truth_case *c)
{
    free(c->halves[0]);
    free(c->halves[1]);
    free(c->whole);
    free(c->list);
    alpi_lighting_destroy(c->scene.context, c->lighting);
    alp_image_destroy(c->sky);
    if (c->map.atlas != NULL) {
        bench_map_close(&c->scene, &c->map);
    }
    bench_scene_close(&c->scene);
}

static bool open_case(truth_case *c, const char *path, const char *sky, bool quick)
{
    if (!bench_scene_open(path, 0, &c->scene)) {
        return false;
    }
    alp_atlas_options options = alp_atlas_options_default();
    options.size = quick ? QUICK_SIZE : c->what->size > 0 ? c->what->size : options.size;
    options.texels_per_metre = quick ? 0.0 : c->what->texels_per_metre;
    if (!bench_good(&c->scene, light_case(c, sky)) ||
        !bench_map_open_with(&c->scene, &options, &c->map)) {
        return false;
    }
    choose_texels(c, quick ? QUICK_TEXELS : TEXELS);
    c->told->texels = c->map.texels.count;
    c->told->asked = c->question.count;
    for (int k = 0; k < 2; k++) {
        c->halves[k] = bench_allocate(c->question.count, sizeof *c->halves[k]);
    }
    c->whole = bench_allocate(c->question.count, sizeof *c->whole);
    return true;
}

// --- the truth -----------------------------------------------------------------------------------

/// Mean of E, √ mean variance, and the standard error of the mean. The channels of a texel come
/// from the same paths, so their errors add up, and do not cancel.
static void sum_up(const alpi_reference_value *values, uint32_t count, double *mean, double *error,
                   double *mean_error)
{
    double sum = 0.0, squares = 0.0, doubts = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        double spread = 0.0;
        for (int k = 0; k < 3; k++) {
            sum += (double)values[i].mean[k];
            squares += (double)values[i].variance[k];
            spread += sqrt((double)values[i].variance[k]) / 3.0;
        }
        doubts += spread * spread;
    }
    const double all = fmax(3.0 * (double)count, 1.0);
    *mean = sum / all;
    *error = sqrt(squares / all);
    *mean_error = sqrt(doubts) / fmax((double)count, 1.0);
}

/// As many paths as the pilot says that the wanted error needs, a power of two.
static bool choose_paths(truth_case *c)
{
    const bench_paths pilot = {PILOT_PATHS, ALPI_REFERENCE_BOUNCE_LIMIT, true, SEED_PILOT};
    double mean, error, doubt;
    if (!bench_reference(&c->question, pilot, c->whole)) {
        return false;
    }
    sum_up(c->whole, c->question.count, &mean, &error, &doubt);
    const double parts = error / (mean * WANTED_ERROR);
    c->told->paths = LEAST_PATHS;
    while (c->told->paths < MOST_PATHS && c->told->paths < PILOT_PATHS * parts * parts) {
        c->told->paths *= 2;
    }
    return true;
}

static bool find_truth(truth_case *c, bool quick)
{
    c->told->paths = QUICK_PATHS;
    if (!quick && !choose_paths(c)) {
        return false;
    }
    for (uint64_t k = 0; k < 2; k++) {
        const bench_paths how = {c->told->paths / 2, ALPI_REFERENCE_BOUNCE_LIMIT, true,
                                 k == 0 ? SEED_FIRST : SEED_SECOND};
        if (!bench_reference(&c->question, how, c->halves[k])) {
            return false;
        }
    }
    for (uint32_t i = 0; i < c->question.count; i++) {
        const alpi_reference_value *a = &c->halves[0][i], *b = &c->halves[1][i];
        for (int k = 0; k < 3; k++) {
            c->whole[i].mean[k] = 0.5f * (a->mean[k] + b->mean[k]);
            c->whole[i].variance[k] = 0.25f * (a->variance[k] + b->variance[k]);
        }
    }
    c->question.truth = c->whole;
    sum_up(c->whole, c->question.count, &c->told->mean, &c->told->own, &c->told->doubt);
    if (!(c->told->mean > 0.0)) {
        fprintf(stderr, "alpenglow bench: %s: no light reaches its texels\n", c->what->title);
        return false;
    }
    c->told->own /= c->told->mean;
    c->told->doubt /= c->told->mean;
    return true;
}

/// @param values of a technique, [question.count]
/// @return doubt: the technique's alone
static verdict judge(const truth_case *c, const alpi_reference_value *values)
{
    double squares = 0.0, sum = 0.0, mean, error, doubt;
    for (uint32_t i = 0; i < c->question.count; i++) {
        for (int k = 0; k < 3; k++) {
            const double x = (double)values[i].mean[k];
            const double a = x - (double)c->halves[0][i].mean[k];
            const double b = x - (double)c->halves[1][i].mean[k];
            squares += a * b;
            sum += 0.5 * (a + b);
        }
    }
    sum_up(values, c->question.count, &mean, &error, &doubt);
    const double all = 3.0 * (double)c->question.count;
    return (verdict){.rmse = sqrt(fmax(squares, 0.0) / all) / c->told->mean,
                     .bias = sum / all / c->told->mean,
                     .doubt = doubt / c->told->mean,
                     .stated = error / c->told->mean};
}

/// All seeds of a technique: means of squares, and of biases.
static bool ask(truth_case *c, const bench_technique *t, bool quick, verdict *all)
{
    alpi_reference_value *values = bench_allocate(c->question.count, sizeof *values);
    const int seeds = quick ? 1 : t->seeds;
    double squares = 0.0, stated = 0.0, doubts = 0.0;
    bool good = true;
    *all = (verdict){0};
    for (int i = 0; i < seeds && good; i++) {
        c->question.seed = SEED_TECHNIQUES + (uint64_t)i;
        good = t->run(&c->question, quick ? t->paths / 8 : t->paths, values);
        const verdict one = judge(c, values);
        squares += one.rmse * one.rmse / seeds;
        stated += one.stated * one.stated / seeds;
        doubts += one.doubt * one.doubt / (seeds * seeds);
        all->bias += one.bias / seeds;
    }
    all->rmse = sqrt(squares);
    all->stated = t->partial ? 0.0 : sqrt(stated);
    all->doubt = hypot(sqrt(doubts), c->told->doubt);
    free(values);
    return good;
}

static bool is_wanted(const bench_technique *t, const bench_options *options)
{
    return options->technique == NULL || strcmp(options->technique, t->name) == 0;
}

static bool ask_techniques(truth_case *c, const bench_options *options)
{
    const bool quick = options->quick;
    bool good = true;
    for (int i = 0; good && i < TECHNIQUE_LIMIT; i++) {
        const bench_technique *t = bench_technique_at(i);
        if (t == NULL) {
            break;
        }
        if (!is_wanted(t, options)) {
            continue;
        }
        good = ask(c, t, quick, &c->told->verdicts[i]);
        const double z = fabs(c->told->verdicts[i].bias) / c->told->verdicts[i].doubt;
        if (good && t->exact && !quick && !(z < GREATEST_Z)) {
            fprintf(stderr,
                    "alpenglow bench: %s: the mean of '%s' is %.1f standard errors from the "
                    "truth's; one of the two is wrong\n",
                    c->what->title, t->name, z);
            good = false;
        }
    }
    return good;
}

// --- tables --------------------------------------------------------------------------------------

static const char *name_light(const truth_scene *what)
{
    return what->sky != NULL ? strrchr(what->sky, '/') + 1 : what->clear ? "clear sky" : "its own";
}

static void print_scenes(const truth_summary *told, int count, const bench_options *options)
{
    bench_table table;
    bench_table_start(
        &table, "The truths",
        "Irradiance of texels chosen at random on all surfaces, the outsides of rooms too, by the "
        "reference: all bounces, as many paths as bring its own error to 1 % of the mean, 16,384 "
        "at most. Own error: root mean square of the texels' standard errors over the mean of E; "
        "of the mean: that of the mean of E. A texel partly inside other geometry is its part "
        "outside, for the truth as for all others; one wholly inside, at the rim of what is seen, "
        "is filled from beside and not asked, others there are and have no light. The clear sky "
        "is that of a sun at azimuth 150°, 40° high, without the sun.",
        "scene|light|map|asked|mean of E|paths|own error|of the mean");
    for (const truth_summary *t = told; t < told + count; t++) {
        if (t->known) {
            bench_table_add(&table, "%s|%s|%u|%u|%.4g|%u|%.2f %%|%.2f %%", t->what->title,
                            name_light(t->what), t->texels, t->asked, t->mean, t->paths,
                            100.0 * t->own, 100.0 * t->doubt);
        } else {
            bench_table_add(&table, "%s|skipped: not below ALPENGLOW_SHARED|–|–|–|–|–|–",
                            t->what->title);
        }
    }
    bench_table_print(&table, options);
}

typedef enum matrix_kind { MATRIX_ERROR, MATRIX_BIAS, MATRIX_STATED } matrix_kind;

/// Cell of a technique, or, −1, of the truth itself.
static void write_cell(const truth_summary *told, int technique, matrix_kind kind,
                       char cell[BENCH_CELL_SIZE])
{
    const verdict *v = technique < 0 ? NULL : &told->verdicts[technique];
    const bool states = v != NULL && v->stated > 0.0 && v->rmse > 0.0;
    if (!told->known || (kind == MATRIX_STATED && !states)) {
        snprintf(cell, BENCH_CELL_SIZE, "–");
    } else if (kind == MATRIX_STATED) {
        snprintf(cell, BENCH_CELL_SIZE, "%.2f", v->stated / v->rmse);
    } else if (kind == MATRIX_BIAS && v == NULL) {
        snprintf(cell, BENCH_CELL_SIZE, "± %.2f", 100.0 * told->doubt);
    } else if (kind == MATRIX_BIAS) {
        snprintf(cell, BENCH_CELL_SIZE, "%+.2f ± %.2f", 100.0 * v->bias, 100.0 * v->doubt);
    } else {
        snprintf(cell, BENCH_CELL_SIZE, "%.2f", 100.0 * (v == NULL ? told->own : v->rmse));
    }
}

enum { ROW_SIZE = BENCH_COLUMN_LIMIT * BENCH_CELL_SIZE };

static void print_matrix(const truth_summary *told, int count, matrix_kind kind, const char *title,
                         const char *note, const bench_options *options)
{
    bench_table table;
    char row[ROW_SIZE], cell[BENCH_CELL_SIZE];
    int length = snprintf(row, ROW_SIZE, "technique");
    for (int i = 0; i < count; i++) {
        length += snprintf(row + length, ROW_SIZE - (size_t)length, "|%s", told[i].what->title);
    }
    bench_table_start(&table, title, note, row);
    for (int k = -1; k < TECHNIQUE_LIMIT; k++) {
        const bench_technique *t = bench_technique_at(k);
        if (k >= 0 && t == NULL) {
            break;
        }
        if (k >= 0 && !is_wanted(t, options)) {
            continue;
        }
        length = snprintf(row, ROW_SIZE, "%s", t == NULL ? "the truth itself" : t->name);
        for (int i = 0; i < count; i++) {
            write_cell(&told[i], k, kind, cell);
            length += snprintf(row + length, ROW_SIZE - (size_t)length, "|%s", cell);
        }
        bench_table_add(&table, "%s", row);
    }
    bench_table_print(&table, options);
}

static void print_all(const truth_summary *told, int count, const bench_options *options)
{
    print_scenes(told, count, options);
    print_matrix(
        told, count, MATRIX_ERROR, "Error, in percent of the mean",
        "√ mean of squared error over texels and channels, over the mean of the truth, "
        "without the truth's own error, which stands in the first row. The colours of "
        "the ambient models are those of least squares: no other choice brings them "
        "nearer. Occlusion is baked with default options. What is for 1 % is asked with eight "
        "seeds: means of their squares here, of their biases below.",
        options);
    print_matrix(told, count, MATRIX_BIAS, "Bias of the mean, in percent",
                 "Mean of E less that of the truth, over the latter, ± the standard error of both "
                 "together: beyond three of them it is more than noise. Only without next-event "
                 "estimation, where few paths meet a small sun, and those by chance, it may be "
                 "more than is stated.",
                 options);
    print_matrix(
        told, count, MATRIX_STATED, "Stated error over the true one",
        "Of techniques that state one: √ mean variance of the texels asked, over the error "
        "above. 1 is the truth; where an error is below the truth's own, the latter's "
        "chance is in it. Radiosity states the noise of its rays, that of the solution "
        "they meet, and what interpolation misses.",
        options);
}

// --- all -----------------------------------------------------------------------------------------

/// The path of something below $ALPENGLOW_SHARED, in `path`. @return false: it is not there
static bool find_shared(const char *relative, char path[PATH_SIZE])
{
    const char *found = bench_shared(relative, NULL);
    return found != NULL && snprintf(path, PATH_SIZE, "%s", found) > 0;
}

static bool run_scene(const truth_scene *what, const bench_options *options, truth_summary *told)
{
    const bool quick = options->quick;
    char path[PATH_SIZE], sky[PATH_SIZE];
    *told = (truth_summary){.what = what};
    if ((what->shared && !find_shared(what->name, path)) ||
        (what->sky != NULL && !find_shared(what->sky, sky))) {
        return true;
    }
    truth_case c = {.what = what, .told = told};
    told->known =
        open_case(&c, what->shared ? path : what->name, what->sky != NULL ? sky : NULL, quick) &&
        find_truth(&c, quick) && ask_techniques(&c, options);
    close_case(&c);
    return told->known;
}

int bench_against_truth(const bench_options *options)
{
    truth_summary told[SCENE_COUNT];
    const truth_scene other = {.name = options->scene, .title = options->scene, .size = 256};
    const truth_scene *first = options->scene == NULL ? scenes : &other;
    const int count = options->scene != NULL ? 1 : SCENE_COUNT;
    bool good = true;
    for (int i = 0; i < SCENE_COUNT && options->scene != NULL; i++) {
        first = strcmp(options->scene, scenes[i].title) == 0 ? &scenes[i] : first;
    }
    for (int i = 0; i < count && good; i++) {
        good = run_scene(&first[i], options, &told[i]);
    }
    if (good) {
        print_all(told, count, options);
    }
    return good ? 0 : 1;
}
