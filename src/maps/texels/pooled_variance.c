// SPDX-License-Identifier: MIT
// Pooled variances, a band of rows at a time.
#include "maps/texels/pooled_variance.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <string.h>

enum { TEXELS_PER_BAND = 1 << 16, TEXELS_PER_RANGE = 1 << 10 };

/// Texels lie row by row, and a texel is pooled with those of its row and the two beside it. So the
/// last row of a band waits until the one after it is pooled too.
typedef struct pool_job {
    const alpi_lattice *lattice;
    alpi_reference_value *values;
    float (*pooled)[3]; // [waiting row and band]
    uint32_t waiting;   // first texel whose variance is pooled and not yet put in its place
    uint32_t begin;     // of the band
} pool_job;

static void pool(const pool_job *job, uint32_t texel)
{
    uint32_t around[ALPI_NEIGHBOUR_LIMIT + 1];
    uint32_t count = alpi_lattice_traced_around(job->lattice, texel, around);
    around[count++] = texel;
    for (int k = 0; k < 3; k++) {
        float sum = 0.0f;
        for (uint32_t n = 0; n < count; n++) {
            sum += job->values[around[n]].variance[k];
        }
        job->pooled[texel - job->waiting][k] = sum / (float)count;
    }
}

static alp_result pool_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const pool_job *job = user;
    for (uint32_t i = begin; i < end; i++) {
        if (job->lattice->states[job->begin + i] == ALPI_TEXEL_TRACED) {
            pool(job, job->begin + i);
        }
    }
    return ALP_OK;
}

static bool same_row(const alpi_texels *texels, uint32_t a, uint32_t b)
{
    return texels->pixels[a][1] == texels->pixels[b][1] && texels->pages[a] == texels->pages[b];
}

/// First texel of a row.
static uint32_t row_begin(const alpi_texels *texels, uint32_t texel)
{
    while (texel > 0 && same_row(texels, texel - 1, texel)) {
        texel--;
    }
    return texel;
}

/// First texel after some, and after the row of the last of them.
static uint32_t band_end(const alpi_texels *texels, uint32_t begin)
{
    const uint32_t left = texels->count - begin;
    uint32_t end = begin + (left < TEXELS_PER_BAND ? left : TEXELS_PER_BAND);
    while (end < texels->count && same_row(texels, end - 1, end)) {
        end++;
    }
    return end;
}

/// Puts those before `end` in their places, and moves the others to the front.
static void put(pool_job *job, uint32_t end, uint32_t pooled_end)
{
    for (uint32_t t = job->waiting; t < end; t++) {
        if (job->lattice->states[t] == ALPI_TEXEL_TRACED) {
            memcpy(job->values[t].variance, job->pooled[t - job->waiting], sizeof *job->pooled);
        }
    }
    memmove(job->pooled, job->pooled + (end - job->waiting),
            (size_t)(pooled_end - end) * sizeof *job->pooled);
    job->waiting = end;
}

static alp_result run(pool_job *job)
{
    const alpi_texels *texels = job->lattice->texels;
    while (job->begin < texels->count) {
        const uint32_t end = band_end(texels, job->begin);
        ALP_TRY(alpi_parallel_for(job->lattice->context, end - job->begin, TEXELS_PER_RANGE,
                                  pool_range, job, NULL));
        put(job, end < texels->count ? row_begin(texels, end - 1) : end, end);
        job->begin = end;
    }
    return ALP_OK;
}

alp_result alpi_pool_variances(const alpi_lattice *lattice, alpi_reference_value *values)
{
    const uint32_t room = TEXELS_PER_BAND + 2 * lattice->width; // a row waits, another is begun
    const uint32_t texels = lattice->texels->count;
    pool_job job = {.lattice = lattice, .values = values};
    ALPI_TRY_NEW(lattice->context, job.pooled, room < texels ? room : texels);
    const alp_result result = run(&job);
    alpi_release(lattice->context, job.pooled);
    return result;
}
