// SPDX-License-Identifier: MIT
// A step of light propagation against the memory that it streams and against a plain scatter.
#include "lpv_parts.h"

#include "base/memory.h"
#include "base/random.h"
#include "fields/propagation/lpv.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 9, STEPS = 8, LIGHTS = 4096 };

// --- volumes with light in them ------------------------------------------------------------------

/// Lights and blockers at random places of a grid.
static alp_result fill(alp_lpv *lpv, uint32_t count)
{
    const double reach = (double)lpv->options.size[0] * lpv->options.cell;
    float(*positions)[3] = bench_allocate(count, sizeof *positions);
    float(*normals)[3] = bench_allocate(count, sizeof *normals);
    float(*flux)[3] = bench_allocate(count, sizeof *flux);
    float *areas = bench_allocate(count, sizeof *areas);
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = 0; k < 3; k++) {
            const float u = alpi_unit_float(alpi_hash32(3 * i + k));
            positions[i][k] = (float)(reach * ((double)u - 0.5));
            flux[i][k] = 1.0f;
        }
        normals[i][i % 3] = i % 2 == 0 ? 1.0f : -1.0f;
        areas[i] = 0.1f;
    }
    const alp_lpv_surfels s = {.count = count,
                               .positions = (const float(*)[3])positions,
                               .normals = (const float(*)[3])normals,
                               .flux = (const float(*)[3])flux,
                               .areas = areas};
    alp_lpv_begin(lpv);
    alp_result result = alp_lpv_add_light(lpv, ALP_LPV_ALL_CASCADES, &s);
    if (result == ALP_OK && lpv->options.blockers) {
        result = alp_lpv_add_blockers(lpv, ALP_LPV_ALL_CASCADES, &s);
    }
    free(positions);
    free(normals);
    free(flux);
    free(areas);
    return result;
}

/// Seconds of `STEPS` steps alone: those of a long run less those of a short one.
static double time_steps(alp_lpv *lpv)
{
    double seconds[2];
    for (int i = 0; i < 2; i++) {
        lpv->iterations = i == 0 ? 1 : STEPS + 1;
        const double started = bench_thread_seconds();
        if (alp_lpv_propagate(lpv) != ALP_OK) {
            return 0.0;
        }
        seconds[i] = bench_thread_seconds() - started;
    }
    return seconds[1] - seconds[0];
}

// --- what a step is held to ----------------------------------------------------------------------

/// Memory alone: a volume is read, one written, and a third added to.
static double time_floor(size_t values, const float *light, float *next, float *sum)
{
    const double started = bench_thread_seconds();
    for (int s = 0; s < STEPS; s++) {
        for (size_t i = 0; i < values; i++) {
            next[i] = 0.5f * light[i];
            sum[i] += next[i];
        }
        __asm__ volatile("" : : "r"(next), "r"(sum) : "memory"); // each pass is run
    }
    return bench_thread_seconds() - started;
}

/// A first draft: cells scatter to their neighbours, a face at a time.
static void scatter_cell(const uint32_t n, size_t cell, const uint32_t at[3], const float *light,
                         float *next)
{
    const float pi = (float)ALPI_PI;
    for (int d = 0; d < 6; d++) {
        const int axis = d / 2, sign = d % 2 == 0 ? 1 : -1;
        const int64_t to = (int64_t)at[axis] + sign;
        if (to < 0 || to >= (int64_t)n) {
            continue;
        }
        const size_t steps[3] = {1, n, (size_t)n * n};
        const size_t target = sign > 0 ? cell + steps[axis] : cell - steps[axis];
        for (int face = 0; face < 5; face++) {
            float w[3] = {0.0f, 0.0f, 0.0f};
            w[axis] = (float)sign * (face == 0 ? 1.0f : (float)ALP_LPV_ALONG);
            if (face > 0) {
                const int way = face % 2 == 1 ? 1 : -1;
                w[(axis + 1 + (face - 1) / 2) % 3] = (float)way * (float)ALP_LPV_ASIDE;
            }
            const float angle = (float)(face == 0 ? ALP_LPV_FAR : ALP_LPV_SIDE);
            for (int c = 0; c < 3; c++) {
                const float *p = light + cell * ALPI_LPV_ROWS + 4 * c;
                float *q = next + target * ALPI_LPV_ROWS + 4 * c;
                const float flux = angle * fmaxf(p[0] + p[1] * w[0] + p[2] * w[1] + p[3] * w[2], 0);
                q[0] += flux / (4.0f * pi);
                for (int k = 0; k < 3; k++) {
                    q[1 + k] += flux / (2.0f * pi) * w[k];
                }
            }
        }
    }
}

static double time_scatter(uint32_t n, float *light, float *next, float *sum)
{
    const size_t cells = (size_t)n * n * n, values = cells * ALPI_LPV_ROWS;
    const double started = bench_thread_seconds();
    for (int s = 0; s < STEPS; s++) {
        memset(next, 0, values * sizeof *next);
        for (size_t cell = 0; cell < cells; cell++) {
            const uint32_t at[3] = {(uint32_t)(cell % n), (uint32_t)(cell / n % n),
                                    (uint32_t)(cell / n / n)};
            scatter_cell(n, cell, at, light, next);
        }
        for (size_t i = 0; i < values; i++) {
            sum[i] += next[i];
        }
        float *swap = light;
        light = next;
        next = swap;
    }
    return bench_thread_seconds() - started;
}

// --- a step --------------------------------------------------------------------------------------

enum { KIND_FREE, KIND_BLOCKED, KIND_REFLECTS, KIND_COUNT };

static alp_result make(alp_context *context, uint32_t n, int kind, alp_lpv **lpv)
{
    alp_lpv_options o = alp_lpv_options_default();
    for (int k = 0; k < 3; k++) {
        o.size[k] = n;
    }
    o.blockers = kind != KIND_FREE;
    o.bounces = kind == KIND_REFLECTS ? ALP_BOUNCES_CONVERGE : 1;
    ALP_TRY(alp_lpv_create(context, &o, lpv));
    return fill(*lpv, LIGHTS);
}

/// Rounds take all kinds, the floor and the scatter in turns.
static alp_result measure_size(alp_context *context, uint32_t n, int rounds, bench_table *table,
                               lpv_figures *figures)
{
    const size_t values = (size_t)n * n * n * ALPI_LPV_ROWS;
    alp_lpv *volumes[KIND_COUNT] = {NULL};
    double steps[KIND_COUNT][ROUNDS], floors[ROUNDS], scatters[ROUNDS];
    alp_result result = ALP_OK;
    float *work[3];
    for (int i = 0; i < 3; i++) {
        work[i] = bench_allocate(values, sizeof *work[i]);
    }
    for (int k = 0; k < KIND_COUNT && result == ALP_OK; k++) {
        result = make(context, n, k, &volumes[k]);
    }
    for (int r = 0; r < rounds && result == ALP_OK; r++) {
        for (size_t i = 0; i < values; i++) {
            work[0][i] = i % 4 == 0 ? 1.0f : 0.0f;
        }
        floors[r] = time_floor(values, work[0], work[1], work[2]);
        for (int k = 0; k < KIND_COUNT; k++) {
            steps[k][r] = time_steps(volumes[k]);
        }
        scatters[r] = time_scatter(n, work[0], work[1], work[2]);
    }
    if (result == ALP_OK) {
        const double floor = bench_median(floors, rounds), free = bench_median(steps[0], rounds);
        const double blocked = bench_median(steps[1], rounds);
        const double scatter = bench_median(scatters, rounds);
        bench_table_add(table, "%u³|%.3f|%.3f|%.1f|%.1f|%.1f|%.0f", n, 1e3 * floor / STEPS,
                        1e3 * free / STEPS, free / floor, blocked / floor,
                        bench_median(steps[2], rounds) / floor, scatter / free);
        if (n == 32) {
            figures->step = free / floor;
            figures->blocked = blocked / floor;
            figures->scatter = scatter / free;
        }
    }
    for (int k = 0; k < KIND_COUNT; k++) {
        alp_lpv_destroy(volumes[k]);
    }
    for (int i = 0; i < 3; i++) {
        free(work[i]);
    }
    return result;
}

alp_result lpv_measure_steps(const bench_options *options, lpv_figures *figures)
{
    static const uint32_t sizes[3] = {16, 32, 64};
    bench_scene none = {.name = "step"};
    bench_table table;
    bench_table_start(
        &table, "One step on one core",
        "Floor: a volume read, one written, one added to. Times in the same rounds.",
        "grid|floor, ms|step, ms|step / floor|with blockers|and bounces|scatter / step");
    alp_context_options o = alp_context_options_default();
    o.worker_count = 1;
    ALP_TRY(alp_context_create(&o, &none.context));
    alp_result result = ALP_OK;
    for (int i = 0; i < (options->quick ? 1 : 3) && result == ALP_OK; i++) {
        result = measure_size(none.context, sizes[i], options->quick ? 1 : ROUNDS, &table, figures);
    }
    (void)bench_good(&none, result);
    alp_context_destroy(none.context);
    bench_table_print(&table, options);
    return result;
}
