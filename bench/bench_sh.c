// SPDX-License-Identifier: MIT
// Projection of cube maps to nine coefficients: time and error by the size of a face.
// Compare: C. Nilsson, A. Jansson. Ljussättning i realtid med dynamisk ambiansvolym. Chalmers 2006,
//          diagrams 1 and 2.
#include "bench.h"
#include "cube_loops.h"

#include "sh/cube_map.h"
#include "sh/sh_project.h"

#include <math.h>
#include <stdlib.h>

enum { ROUNDS = 9, LARGEST = 256, SIZES = 7, ENVIRONMENTS = 3 };

// --- environments --------------------------------------------------------------------------------

/// A gradient without edges.
static vec3 smooth(vec3 d)
{
    return (vec3){expf(1.3f * d.x - 0.4f * d.y), 1.5f + sinf(2.0f * d.x + d.y) * cosf(1.5f * d.z),
                  2.0f + d.y + 0.7f * d.x * d.z};
}

/// Two colours with a sharp edge that no texel follows.
static vec3 horizon(vec3 d)
{
    return 0.28f * d.x + 0.95f * d.y + 0.13f * d.z > 0.0f ? (vec3){0.5f, 0.7f, 1.0f}
                                                          : (vec3){0.2f, 0.15f, 0.1f};
}

/// A lamp a hundred times as bright as the room, 12° across.
static vec3 lamp(vec3 d)
{
    const bool inside = 0.48f * d.x + 0.6f * d.y - 0.64f * d.z > 0.99452f;
    return inside ? (vec3){100.0f, 90.0f, 70.0f} : (vec3){1.0f, 0.8f, 0.6f};
}

static vec3 (*const environments[ENVIRONMENTS])(vec3) = {smooth, horizon, lamp};

static float *make_cube(uint32_t size, int environment)
{
    float *pixels = bench_allocate((size_t)18 * size * size, sizeof *pixels), *at = pixels;
    for (uint32_t i = 0; i < 6 * size * size; i++, at += 3) {
        const alp_cube_face face = (alp_cube_face)(i / size / size);
        vec3_store(at, environments[environment](
                           alpi_cube_texel_direction(face, size, i % size, i / size % size)));
    }
    return pixels;
}

// --- time ----------------------------------------------------------------------------------------

typedef struct cube_bench {
    alp_sh_projection *projection;
    const float *faces[ALPI_CUBE_FACES];
    uint32_t size;
    float sink; // keeps results from being optimised away
} cube_bench;

static bool open_cube(alp_context *context, uint32_t size, const float *pixels, cube_bench *b)
{
    *b = (cube_bench){.size = size};
    for (size_t f = 0; f < ALPI_CUBE_FACES; f++) {
        b->faces[f] = pixels + f * 3 * size * size;
    }
    return alp_sh_projection_create(context, size, &b->projection) == ALP_OK;
}

enum { OURS, NAIVE, HOISTED, FLOOR, KINDS };

static void run_once(cube_bench *b, int kind)
{
    alp_sh9 radiance = {{{0.0f}}};
    if (kind == FLOOR) {
        b->sink += bench_cube_read(b->faces[0], b->size);
    } else if (kind == NAIVE) {
        radiance = bench_cube_naive(b->faces[0], b->size);
    } else if (kind == HOISTED) {
        radiance = bench_cube_hoisted(b->faces[0], b->size);
    } else {
        (void)!alp_sh_project_cube(b->projection, b->faces, &radiance);
    }
    b->sink += radiance.c[6][1];
}

/// Nanoseconds a texel of the loops, medians of rounds in turns.
static void measure(cube_bench *b, bool quick, double nanoseconds[KINDS])
{
    const double texels = 6.0 * b->size * b->size;
    const int rounds = quick ? 1 : ROUNDS;
    double values[KINDS][ROUNDS] = {{0.0}};
    for (int round = 0; round < rounds; round++) {
        for (int kind = 0; kind < KINDS; kind++) {
            const int times =
                quick ? 1 : (int)((kind == NAIVE || kind == HOISTED ? 4e5 : 4e6) / texels) + 1;
            const double started = bench_thread_seconds();
            for (int i = 0; i < times; i++) {
                run_once(b, kind);
            }
            values[kind][round] = 1e9 * (bench_thread_seconds() - started) / (texels * times);
        }
    }
    for (int kind = 0; kind < KINDS; kind++) {
        nanoseconds[kind] = bench_median(values[kind], rounds);
    }
}

// --- error ---------------------------------------------------------------------------------------

static bool project(alp_context *context, uint32_t size, int environment, alp_sh9 *radiance)
{
    float *pixels = make_cube(size, environment);
    cube_bench b;
    const bool good = open_cube(context, size, pixels, &b) &&
                      alp_sh_project_cube(b.projection, b.faces, radiance) == ALP_OK;
    alp_sh_projection_destroy(b.projection);
    free(pixels);
    return good;
}

/// Root mean square of the coefficients' differences over that of the coefficients.
static double relative_rms(const alp_sh9 *a, const alp_sh9 *b)
{
    double difference = 0.0, sum = 0.0;
    for (int i = 0; i < 27; i++) {
        const double x = (double)a->c[i / 3][i % 3], y = (double)b->c[i / 3][i % 3];
        difference += (x - y) * (x - y);
        sum += y * y;
    }
    return sqrt(difference / sum);
}

// --- tables --------------------------------------------------------------------------------------

static bool add_size(alp_context *context, uint32_t size, const alp_sh9 truth[ENVIRONMENTS],
                     const bench_options *options, bench_table *times, bench_table *errors)
{
    double ns[KINDS], rms[ENVIRONMENTS];
    float *pixels = make_cube(size, 0);
    cube_bench b;
    bool good = open_cube(context, size, pixels, &b);
    if (good) {
        measure(&b, options->quick, ns);
        bench_table_add(times, "%u|%u|%.2f|%.3f|%.3f|%.2f|%.1f|%.1f|%.1f|%.1f", size,
                        6 * size * size, ns[OURS] * 6.0 * size * size * 1e-3, ns[OURS], ns[FLOOR],
                        ns[FLOOR] / ns[OURS], ns[NAIVE], ns[NAIVE] / ns[OURS], ns[HOISTED],
                        ns[HOISTED] / ns[OURS]);
    }
    alp_sh_projection_destroy(b.projection);
    free(pixels);
    for (int e = 0; e < ENVIRONMENTS && good; e++) {
        alp_sh9 radiance;
        good = project(context, size, e, &radiance);
        rms[e] = good ? 100.0 * relative_rms(&radiance, &truth[e]) : 0.0;
    }
    if (good) {
        bench_table_add(errors, "%u|%.4f %%|%.4f %%|%.4f %%", size, rms[0], rms[1], rms[2]);
    }
    return good;
}

int bench_sh(const bench_options *options)
{
    static bench_table times, errors;
    static const uint32_t sizes[SIZES] = {4, 8, 16, 32, 64, 128, LARGEST};
    alp_sh9 truth[ENVIRONMENTS];
    alp_context *context = NULL;
    bool good = alp_context_create(NULL, &context) == ALP_OK;
    bench_table_start(&times, "Cube maps to nine coefficients, one worker",
                      "Nanoseconds a texel by the edge of a face. Floor: a loop that reads every "
                      "value and adds it. Naive: direction, solid angle and basis of each texel, "
                      "27 sums. Hoisted: the same with the axes of a face outside of its loop, "
                      "compiled for the instruction set of ours.",
                      "face|texels|ours us|ours ns|floor ns|floor / ours|naive ns|naive / ours|"
                      "hoisted ns|hoisted / ours");
    bench_table_start(&errors, "Error of coefficients by the edge of a face",
                      "Root mean square of the difference to faces of 256, over that of the "
                      "coefficients. Texels are sampled at their centres. Smooth: a gradient. "
                      "Horizon: two colours with a sharp, tilted edge. Lamp: 12° across, a hundred "
                      "times as bright as the room.",
                      "face|smooth|horizon|lamp");
    for (int e = 0; e < ENVIRONMENTS && good; e++) {
        good = project(context, LARGEST, e, &truth[e]);
    }
    const int count = options->quick ? 2 : SIZES;
    for (int i = 0; i < count && good; i++) {
        good = add_size(context, sizes[i], truth, options, &times, &errors);
    }
    if (!good) {
        fprintf(stderr, "alpenglow bench: %s\n",
                context != NULL ? alp_context_message(context) : "out of memory");
    } else {
        bench_table_print(&times, options);
        bench_table_print(&errors, options);
    }
    alp_context_destroy(context);
    return good ? 0 : 1;
}
