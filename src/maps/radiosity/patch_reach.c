// SPDX-License-Identifier: MIT
#include "maps/radiosity/patch_reach.h"

#include <math.h>

enum { TEXELS_PER_RANGE = 4096 };
/// A cell whose neighbours differ by SHARE of the mean light has a reach of one side; the longest
/// reach is LONGEST sides. docs/how/light.md, "Near rays". On strips of sun narrower than a
/// texel, a SHARE of 1 gained as much, .01 less.
static const float SHARE = 0.1f, LONGEST = 8.0f;

typedef struct reach_job {
    const alpi_patches *patches;
    float mean; // light of the fronts, channels summed
} reach_job;

static float light_of(const float cell[4])
{
    return cell[0] + cell[1] + cell[2];
}

/// The largest difference to a neighbour of the same chart.
static float find_contrast(const alpi_patches *p, uint32_t texel, alpi_side side)
{
    uint32_t around[ALPI_AROUND_LIMIT];
    const uint32_t count = alpi_lattice_around(p->lattice, texel, around);
    const float own = light_of(p->cells[alpi_patches_cell(p, texel, side)]);
    float most = 0.0f;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t t = around[i];
        if (p->texels->charts[t] == p->texels->charts[texel] && p->patch_of[t] != ALPI_NONE) {
            most = fmaxf(most, fabsf(light_of(p->cells[alpi_patches_cell(p, t, side)]) - own));
        }
    }
    return most;
}

static alp_result set_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const reach_job *job = user;
    const alpi_patches *p = job->patches;
    for (uint32_t t = begin; t < end; t++) {
        if (p->patch_of[t] == ALPI_NONE) {
            continue;
        }
        for (int of = ALPI_FRONT; of <= (p->two_sided ? ALPI_BACK : ALPI_FRONT); of++) {
            const float contrast = find_contrast(p, t, (alpi_side)of) / job->mean;
            const float reach = fminf(fmaxf(cbrtf(contrast / SHARE), 1.0f), LONGEST);
            p->cells[alpi_patches_cell(p, t, (alpi_side)of)][ALPI_CELL_SIDE] =
                reach * alpi_texels_side(p->texels, t);
        }
    }
    return ALP_OK;
}

static void sum_light(const void *user, uint32_t begin, uint32_t end, double sums[ALPI_SUM_LIMIT])
{
    const alpi_patches *p = user;
    for (uint32_t t = begin; t < end; t++) {
        if (p->patch_of[t] != ALPI_NONE) {
            sums[0] += (double)light_of(p->cells[alpi_patches_cell(p, t, ALPI_FRONT)]);
            sums[1] += 1.0;
        }
    }
}

alp_result alpi_patches_set_reach(const alpi_patches *patches, const alpi_task_progress *progress)
{
    double sums[ALPI_SUM_LIMIT] = {0.0};
    alpi_task_progress silent = *progress;
    silent.silent = true;
    ALP_TRY(alpi_parallel_sum(patches->context, patches->texels->count, sum_light, patches, &silent,
                              sums));
    if (!(sums[0] > 0.0)) {
        return ALP_OK; // all is dark
    }
    reach_job job = {patches, (float)(sums[0] / sums[1])};
    return alpi_parallel_for(patches->context, patches->texels->count, TEXELS_PER_RANGE, set_range,
                             &job, &silent);
}
