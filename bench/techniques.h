// SPDX-License-Identifier: MIT
// Every technique that answers with the irradiance of texels, behind one door, so that each can be
// held to the truth on each scene. A new technique is one function and one row of the table.
#ifndef BENCH_TECHNIQUES_H
#define BENCH_TECHNIQUES_H

#include "bench.h"

#include "transport/paths/reference.h"

/// What is asked of all techniques: the irradiance at some texels of a lit scene.
typedef struct bench_question {
    const bench_scene *scene;
    const bench_map *map;
    const alpi_lighting *lighting;
    const alp_lighting_options *light; // that it was made with
    uint32_t count;
    const uint32_t *list;              // [count] texels
    const alpi_reference_value *truth; // [count], for what a user would set by hand: models with
                                       // free colours get those that fit it best
    uint64_t seed;
} bench_question;

/// @param paths  as the table says, less in a quick run; of no meaning to most
/// @param values [count] out; variance: of what would be another number with another seed, else 0
/// @return false after a message
typedef bool bench_technique_fn(const bench_question *question, uint32_t paths,
                                alpi_reference_value *values);

typedef struct bench_technique {
    const char *name;
    bench_technique_fn *run;
    uint32_t paths;
    bool exact; // its mean over seeds is the truth and its stated error true: a bias beyond it is a
                // fault in one of the two
    bool partial; // it leaves out light on purpose, and its stated error is not about that
    int seeds;    // that it is asked with, 1 or more
} bench_technique;
/// Those that there are, from 0. @return NULL past the last
const bench_technique *bench_technique_at(int index);

/// How a reference is to be gathered.
typedef struct bench_paths {
    uint32_t count, bounces;
    bool next_event;
    uint64_t seed;
} bench_paths;
/// @param values [question->count] out
bool bench_reference(const bench_question *question, bench_paths paths,
                     alpi_reference_value *values);

#endif
