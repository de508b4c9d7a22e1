// SPDX-License-Identifier: MIT
#include "maps/texels/proximity.h"

#include "base/memory.h"

#include <math.h>

enum {
    TEXELS_PER_RANGE = 512,
    TEXELS_PER_TICK = 1 << 16,
    SAMPLES = 16,
    OCTAVE_LIMIT = 64, // sides of 2^−64 to 2^64 m
    OCTAVES = 2 * OCTAVE_LIMIT + 1
};

// Surfaces closer than this, in texels, cast shadows that a lattice of 4 may miss.
static const double NEAR_DISTANCE = 2.5;
// Share of the short rays that hit if a surface is within a texel.
static const float TOUCHING = 0.22f;
static const uint64_t SEED = 0x6e656172;

// --- texels that trace rays ----------------------------------------------------------------------

static bool is_coarse(const alpi_proximity_job *job, uint32_t texel)
{
    return alpi_lattice_is_coarse(job->lattice->texels->pixels[texel]);
}

/// The octave of a texel's side. Rays from texels of one octave are equally long.
static int find_octave(const alpi_proximity_job *job, uint32_t texel)
{
    const int octave = ilogbf(alpi_texels_side(job->lattice->texels, texel));
    return octave < -OCTAVE_LIMIT  ? 0
           : octave > OCTAVE_LIMIT ? 2 * OCTAVE_LIMIT
                                   : octave + OCTAVE_LIMIT;
}

/// Reports from a serial loop over the order, once in a while. @return ALP_OK; CANCELLED
static alp_result tick(const alpi_proximity_job *job, uint32_t i)
{
    return i % TEXELS_PER_TICK == TEXELS_PER_TICK - 1
               ? alpi_tick(job->setup->context, "validity", i, job->count)
               : ALP_OK;
}

/// Sorts the coarse texels by octave. @param ends out: the end of each octave in the list
static alp_result list_coarse(const alpi_proximity_job *job, uint32_t *list, uint32_t ends[OCTAVES])
{
    uint32_t sum = 0;
    for (uint32_t i = 0; i < job->count; i++) {
        if (is_coarse(job, job->order[i])) {
            ends[find_octave(job, job->order[i])]++;
        }
        ALP_TRY(tick(job, i));
    }
    for (int k = 0; k < OCTAVES; k++) {
        const uint32_t texels = ends[k];
        ends[k] = sum;
        sum += texels;
    }
    for (uint32_t i = 0; i < job->count; i++) {
        if (is_coarse(job, job->order[i])) {
            list[ends[find_octave(job, job->order[i])]++] = job->order[i];
        }
        ALP_TRY(tick(job, i));
    }
    return ALP_OK;
}

/// Occlusion over a short distance, in mean sides of the listed texels. It takes no options of the
/// bake: the limit to which a map converges must depend neither on the seed nor on other maps.
static alp_result make_short_setup(const alpi_proximity_job *job, const uint32_t *list,
                                   uint32_t count, alpi_occlusion_setup *setup)
{
    alp_occlusion_options o = alp_occlusion_options_default();
    double area = 0.0, coverage = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        area += (double)job->lattice->texels->areas[list[i]];
        coverage += (double)job->lattice->texels->coverages[list[i]];
    }
    o.distance = (float)(NEAR_DISTANCE * sqrt(area / fmax(coverage, 1e-30)));
    o.falloff = ALP_FALLOFF_NONE;
    o.samples = SAMPLES;
    o.seed = SEED;
    return alpi_occlusion_prepare(job->setup->scene, job->setup->tracer, &o, setup);
}

/// Measures the proximity of listed texels, by short rays.
static alp_result measure_listed(alpi_proximity_job *job, const uint32_t *list, uint32_t count,
                                 const alpi_task_progress *progress)
{
    alpi_occlusion_sums *sums = &job->scratch->sums;
    alpi_occlusion_setup setup;
    ALP_TRY(make_short_setup(job, list, count, &setup));
    alp_result result = alpi_occlusion_add(&setup, job->receivers, list, count, 0, SAMPLES, SAMPLES,
                                           progress, sums);
    for (uint32_t i = 0; i < count; i++) {
        const float closed = 1.0f - alpi_occlusion_value(sums, list[i]);
        job->scratch->marks[list[i]] = closed > TOUCHING ? 3 : closed > 0.0f ? 2 : 1;
    }
    job->rays += (uint64_t)count * SAMPLES;
    alpi_occlusion_release(&setup);
    return result;
}

static alp_result measure_octaves(alpi_proximity_job *job, uint32_t *list,
                                  const alpi_task_progress *progress)
{
    uint32_t ends[OCTAVES] = {0}, begin = 0;
    ALP_TRY(list_coarse(job, list, ends));
    for (int k = 0; k < OCTAVES; begin = ends[k++]) {
        if (ends[k] > begin) {
            ALP_TRY(measure_listed(job, list + begin, ends[k] - begin, progress));
        }
    }
    return ALP_OK;
}

// --- all texels ----------------------------------------------------------------------------------

/// A texel is as near as the nearest of the coarse texels around it in its chart; without any it
/// touches.
static alp_result spread_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const alpi_proximity_job *job = user;
    const alpi_texels *t = job->lattice->texels;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t texel = job->order[i];
        const uint32_t p[2] = {t->pixels[texel][0], t->pixels[texel][1]};
        uint8_t nearest = 0;
        for (uint32_t y = p[1] & ~1u; y <= p[1] + 1u; y += 2) {
            for (uint32_t x = p[0] & ~1u; x <= p[0] + 1u; x += 2) {
                const uint32_t n = alpi_lattice_texel(job->lattice, t->pages[texel], x, y);
                if (n != ALPI_NONE && t->charts[n] == t->charts[texel] &&
                    job->scratch->marks[n] > nearest) {
                    nearest = job->scratch->marks[n];
                }
            }
        }
        job->proximity[texel] = nearest > 0 ? nearest - 1 : ALPI_TOUCHING;
    }
    return ALP_OK;
}

alp_result alpi_find_proximity(alpi_proximity_job *job, const alpi_task_progress *progress)
{
    alp_context *context = job->setup->context;
    uint32_t *list = NULL;
    ALPI_TRY_NEW(context, list, job->count);
    const alp_result result = measure_octaves(job, list, progress);
    alpi_release(context, list);
    ALP_TRY(result);
    return alpi_parallel_for(context, job->count, TEXELS_PER_RANGE, spread_range, job, progress);
}
