// SPDX-License-Identifier: MIT
// Figures of one atlas as a line of JSON, for tests/truth/atlas_table.py: of ours, or of texture
// coordinates that another program made, by the same definitions.
//   alpenglow-bench measure-atlas SCENE [--size N] [--padding N] [--density D] [--threads N]
//                                 [--set K] [--picture OUT.png] [--obj OUT.obj]
// --set K measures the scene's coordinate set K in the place of new charts; --obj writes the usable
// triangles with vertices joined by position, for other unwrappers, and makes no atlas.
#include "bench.h"

#include "atlas/stages.h"
#include "atlas/stretch.h"

#include "base/tasks.h"

#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

typedef struct wishes {
    const char *scene, *picture, *obj;
    uint32_t size, padding, threads;
    int set; // −1: new charts
    double density;
} wishes;

typedef struct figures {
    double seconds, cpu_seconds;
    uint32_t uncovered; // usable triangles without area in any texel
    uint32_t lines;     // of slivers, which are lines to 32-bit coordinates: not among these
    uint32_t flipped;
    uint64_t hash;
} figures;

// --- wishes --------------------------------------------------------------------------------------

static bool take_wish(const char *name, const char *value, wishes *w)
{
    if (strcmp(name, "--size") == 0) {
        w->size = (uint32_t)strtoul(value, NULL, 10);
    } else if (strcmp(name, "--padding") == 0) {
        w->padding = (uint32_t)strtoul(value, NULL, 10);
    } else if (strcmp(name, "--threads") == 0) {
        w->threads = (uint32_t)strtoul(value, NULL, 10);
    } else if (strcmp(name, "--density") == 0) {
        w->density = strtod(value, NULL);
    } else if (strcmp(name, "--set") == 0) {
        w->set = (int)strtol(value, NULL, 10);
    } else if (strcmp(name, "--picture") == 0) {
        w->picture = value;
    } else if (strcmp(name, "--obj") == 0) {
        w->obj = value;
    } else {
        return false;
    }
    return true;
}

static bool read_wishes(int count, char **words, wishes *w)
{
    *w = (wishes){.size = 1024, .padding = 2, .set = -1};
    for (int i = 0; i < count; i++) {
        if (words[i][0] != '-' && w->scene == NULL) {
            w->scene = words[i];
        } else if (i + 1 >= count || !take_wish(words[i], words[i + 1], w)) {
            fprintf(stderr, "alpenglow bench: measure-atlas: '%s'?\n", words[i]);
            return false;
        } else {
            i++;
        }
    }
    return w->scene != NULL;
}

// --- triangles for others ------------------------------------------------------------------------

typedef struct spot {
    float p[3];
    uint32_t vertex;
} spot;

static int compare_spots(const void *a, const void *b)
{
    const spot *s = a, *t = b;
    for (int i = 0; i < 3; i++) {
        if (s->p[i] != t->p[i]) {
            return s->p[i] < t->p[i] ? -1 : 1;
        }
    }
    return (s->vertex > t->vertex) - (s->vertex < t->vertex);
}

/// The number of each vertex among those of unlike position, from 1; writes these.
static uint32_t *write_vertices(const alp_scene *scene, FILE *file)
{
    spot *spots = bench_allocate(scene->vertex_count, sizeof *spots);
    uint32_t *numbers = bench_allocate(scene->vertex_count, sizeof *numbers), number = 0;
    for (uint32_t v = 0; v < scene->vertex_count; v++) {
        memcpy(spots[v].p, scene->positions[v], sizeof spots[v].p);
        spots[v].vertex = v;
    }
    qsort(spots, scene->vertex_count, sizeof *spots, compare_spots);
    for (uint32_t i = 0; i < scene->vertex_count; i++) {
        const float *p = spots[i].p;
        const float *before = spots[i > 0 ? i - 1 : 0].p;
        if (i == 0 || p[0] != before[0] || p[1] != before[1] || p[2] != before[2]) {
            fprintf(file, "v %.9g %.9g %.9g\n", (double)p[0], (double)p[1], (double)p[2]);
            number++;
        }
        numbers[spots[i].vertex] = number;
    }
    free(spots);
    return numbers;
}

static bool write_obj(const alp_scene *scene, const char *path)
{
    FILE *file = fopen(path, "w");
    if (file == NULL) {
        fprintf(stderr, "alpenglow bench: %s: cannot be written\n", path);
        return false;
    }
    uint32_t *numbers = write_vertices(scene, file);
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        const uint32_t *v = scene->triangles[t];
        if (scene->triangle_usable[t]) {
            fprintf(file, "f %u %u %u\n", numbers[v[0]], numbers[v[1]], numbers[v[2]]);
        }
    }
    free(numbers);
    return fclose(file) == 0;
}

// --- figures -------------------------------------------------------------------------------------

static alp_result mark_covered(void *user, const alpi_band *band)
{
    uint8_t *covered = user;
    for (uint32_t i = 0; i < band->piece_count; i++) { // bands may say the same at the same time
        __atomic_store_n(&covered[band->pieces[i].triangle], 1, __ATOMIC_RELAXED);
    }
    return ALP_OK;
}

static alp_result count_uncovered(const alp_atlas *atlas, figures *f)
{
    const alp_scene *scene = atlas->scene;
    uint8_t *covered = bench_allocate(scene->triangle_count, 1);
    memset(covered, 0, scene->triangle_count);
    for (uint32_t p = 0; p < atlas->info.pages; p++) {
        ALP_TRY(alpi_raster(atlas, p, p + 1, mark_covered, covered));
    }
    for (uint32_t t = 0; t < scene->triangle_count; t++) {
        if (scene->triangle_usable[t] && covered[t] == 0) {
            const bool line = alpi_stretch_is_sliver(atlas, t, atlas->info.texels_per_metre);
            f->lines += line;
            f->uncovered += !line;
        }
    }
    free(covered);
    return ALP_OK;
}

/// FNV-1a of coordinates and pages.
static uint64_t hash_atlas(const alp_atlas *atlas)
{
    uint64_t hash = 14695981039346656037u;
    const struct {
        const void *bytes;
        size_t size;
    } parts[2] = {
        {atlas->corner_uvs, atlas->scene->triangle_count * sizeof *atlas->corner_uvs},
        {atlas->triangle_pages, atlas->scene->triangle_count * sizeof *atlas->triangle_pages}};
    for (int k = 0; k < 2; k++) {
        for (size_t i = 0; i < parts[k].size; i++) {
            hash = (hash ^ ((const uint8_t *)parts[k].bytes)[i]) * 1099511628211u;
        }
    }
    return hash;
}

static alp_result make_atlas(const bench_scene *scene, const wishes *w, alp_atlas **atlas)
{
    alp_atlas_options o = alp_atlas_options_default();
    o.mode = ALP_ATLAS_CHARTS;
    o.size = w->size;
    o.padding = w->padding;
    o.texels_per_metre = w->density;
    return alp_atlas_create(scene->scene, &o, atlas);
}

/// Another program's coordinates, measured as if they were charts of ours. It may think of v as
/// going up: all of its triangles are turned over then, which does no harm.
static alp_result read_atlas(const bench_scene *scene, const wishes *w, alp_atlas **atlas)
{
    alpi_uv_set_facts facts;
    ALP_TRY(alpi_uv_set_survey(scene->scene, (uint32_t)w->set, w->size, NULL, &facts, atlas));
    (*atlas)->options.padding = w->padding;
    (*atlas)->info.mode = ALP_ATLAS_CHARTS;
    return alpi_measure(*atlas, NULL);
}

static alp_result measure(const bench_scene *scene, const wishes *w, alp_atlas **atlas, figures *f)
{
    const double started = alpi_seconds(), cpu = bench_process_seconds();
    ALP_TRY(w->set < 0 ? make_atlas(scene, w, atlas) : read_atlas(scene, w, atlas));
    f->seconds = alpi_seconds() - started;
    f->cpu_seconds = bench_process_seconds() - cpu;
    f->hash = hash_atlas(*atlas);
    f->flipped = (*atlas)->info.flipped_triangles;
    if (w->set >= 0 && f->flipped > scene->scene->usable_count / 2) {
        f->flipped = scene->scene->usable_count - f->flipped;
    }
    ALP_TRY(count_uncovered(*atlas, f));
    if (w->picture != NULL) {
        alp_image *image = NULL;
        ALP_TRY(alp_atlas_picture(*atlas, 0, &image));
        const alp_result result = alp_image_save(image, w->picture, true);
        alp_image_destroy(image);
        return result;
    }
    return ALP_OK;
}

static void print_figures(const bench_scene *scene, const alp_atlas *atlas, const figures *f,
                          double peak)
{
    const alp_atlas_info info = alp_atlas_get_info(atlas);
    printf("{\"triangles\": %u, \"usable\": %u, \"charts\": %u, \"pages\": %u, \"size\": %u, "
           "\"texels\": %llu, \"utilisation\": %.6f, \"texels_per_metre\": %.6g, "
           "\"uncovered\": %u, \"lines\": %u, \"flipped\": %u, \"overlapping\": %llu, ",
           scene->scene->triangle_count, scene->scene->usable_count, info.charts, info.pages,
           info.width, (unsigned long long)info.texels, info.utilisation, info.texels_per_metre,
           f->uncovered, f->lines, f->flipped, (unsigned long long)info.overlapping_texels);
    printf("\"stretch_mean\": %.6g, \"stretch_worst\": %.6g, \"density_spread\": %.6g, "
           "\"slivers\": %u, \"seconds\": %.4f, \"cpu_seconds\": %.4f, \"peak_bytes\": %.0f, "
           "\"hash\": \"%016llx\"}\n",
           info.stretch_mean < 1e300 ? info.stretch_mean : 1e300,
           info.stretch_worst < 1e300 ? info.stretch_worst : 1e300, info.density_spread,
           info.sliver_triangles, f->seconds, f->cpu_seconds, peak, (unsigned long long)f->hash);
}

int bench_measure_atlas(int count, char **words)
{
    enum { EXIT_USAGE = 2 };
    wishes w;
    bench_scene scene;
    if (!read_wishes(count, words, &w)) {
        return EXIT_USAGE;
    }
    if (!bench_scene_load(w.scene, w.threads, &scene)) {
        return EXIT_FAILURE;
    }
    bool good = true;
    if (w.obj != NULL) {
        good = write_obj(scene.scene, w.obj);
    } else {
        alp_atlas *atlas = NULL;
        figures f = {0};
        struct rusage usage;
        good = bench_good(&scene, measure(&scene, &w, &atlas, &f));
        getrusage(RUSAGE_SELF, &usage);
        if (good) {
            print_figures(&scene, atlas, &f, 1024.0 * (double)usage.ru_maxrss);
        }
        alp_atlas_destroy(atlas);
    }
    bench_scene_close(&scene);
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
