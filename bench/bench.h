// SPDX-License-Identifier: MIT
// What the benches share: options, tables, clocks, scenes. Every figure is a ratio of two things
// measured in turns in one process, as machines drift; the median of some rounds is given.
#ifndef BENCH_H
#define BENCH_H

#include "bake/occlusion/occlusion_rounds.h"
#include "maps/texels/validity.h"

#include <stdio.h>

typedef struct bench_options {
    bool quick;            // small sizes, one round: shows that it runs, the figures mean nothing
    bool markdown;         // tables for docs/
    const char *scene;     // this one in the place of the bench's own, or NULL
    const char *pictures;  // folder of plots, or NULL
    const char *technique; // truth runs this one alone, or NULL
} bench_options;

/// One bench: prints its tables. @return 0, or 1 after a message
typedef int bench_fn(const bench_options *options);
bench_fn bench_trace, bench_transport, bench_atlas, bench_maps, bench_accuracy, bench_against_truth,
    bench_denoise, bench_bounced, bench_light, bench_sh, bench_probes, bench_fields, bench_ambience,
    bench_lpv, bench_formats;
bench_fn bench_direct, bench_path_tracer;              // further tables of transport
bench_fn bench_light_bakes;                            // of light
bench_fn bench_kept_hits;                              // of probes
bench_fn bench_ambience_quality, bench_ambience_jumps; // of ambience
bench_fn bench_lpv_truth;                              // of lpv

/// Figures of one atlas for scripts; the words after its name. @return exit status
int bench_measure_atlas(int count, char **words);
/// Records the seconds of each tile of a bake; the words after its name. @return exit status
int bench_record_tiles(int count, char **words);

// --- tables --------------------------------------------------------------------------------------

enum { BENCH_COLUMN_LIMIT = 12, BENCH_ROW_LIMIT = 64, BENCH_CELL_SIZE = 64 };
typedef struct bench_table {
    const char *title, *note; // note: a paragraph below the title, or NULL
    int columns, rows;        // row 0 is the header
    char cells[BENCH_ROW_LIMIT][BENCH_COLUMN_LIMIT][BENCH_CELL_SIZE];
} bench_table;
/// @param header names of the columns with | between
void bench_table_start(bench_table *table, const char *title, const char *note, const char *header);
/// A row; its cells have | between. Rows beyond the limit are dropped.
void bench_table_add(bench_table *table, const char *format, ...) ALP_PRINTF(2, 3);
void bench_table_print(const bench_table *table, const bench_options *options);

// --- measuring -----------------------------------------------------------------------------------

enum { BENCH_ROUND_LIMIT = 32 };
double bench_median(const double *values, int count);
double bench_thread_seconds(void);  // CPU time of the calling thread
double bench_process_seconds(void); // CPU time of all threads
/// CPU time for one worker, which others on the machine do not slow; wall time for more.
double bench_seconds(uint32_t workers);

// --- scenes --------------------------------------------------------------------------------------

/// A scene on a context of its own. Names: those of alp_scene_load, or "hills:N", a field of hills
/// with overhangs of about N triangles, or "pieces:N", N meshes of one triangle each.
typedef struct bench_scene {
    const char *name;
    alp_context *context;
    alp_scene *scene;
    alpi_tracer *tracer;
    double build_seconds;
} bench_scene;
/// @return false after a message; nothing is left to close then
bool bench_scene_open(const char *name, uint32_t workers, bench_scene *scene);
/// The same without the tracer.
bool bench_scene_load(const char *name, uint32_t workers, bench_scene *scene);
void bench_scene_close(bench_scene *scene);
/// Whether a scene of this name can be loaded; says nothing.
bool bench_scene_exists(const char *name);
/// Path of a file below $ALPENGLOW_SHARED in a static buffer, or `otherwise` where that is absent.
const char *bench_shared(const char *relative, const char *otherwise);

/// An atlas with its texels, neighbours together.
typedef struct bench_map {
    alp_atlas *atlas;
    alpi_texels texels;
    alpi_lattice lattice;
    alpi_validity validity;
    double atlas_seconds, texel_seconds, validity_seconds;
} bench_map;
bool bench_map_open(const bench_scene *scene, uint32_t size, bench_map *map);
bool bench_map_open_with(const bench_scene *scene, const alp_atlas_options *options,
                         bench_map *map);
void bench_map_close(const bench_scene *scene, bench_map *map);
/// Runs of so many neighbours, spread evenly over an order of texels, `wanted` in all, or as many
/// as there are; whole packets.
/// @param list out: for the caller to free   @return how many
uint32_t bench_pick_texels(const uint32_t *order, uint32_t count, uint32_t wanted, uint32_t run,
                           uint32_t **list);

/// Prints the context's message. @return whether the result is ALP_OK
bool bench_good(const bench_scene *scene, alp_result result);
/// Memory or the end of the program, with a message.
void *bench_allocate(size_t count, size_t size);

#endif
