// SPDX-License-Identifier: MIT
// Lighting of cells: a cell reflects direct light, the soft sky and the light of the last pass.
// Receivers gather from the cells.
#include "maps/radiosity/radiosity.h"

#include "base/tasks.h"

#include <math.h>

enum { TEXELS_PER_RANGE = 4096 };

// --- texels partly in a solid --------------------------------------------------------------------

/// Mean share of rays that do not end on a back, over those neighbours in the same chart that are
/// outside all solids. 1 if there are none.
static float neighbours_open_share(const alpi_radiosity *r, uint32_t texel)
{
    const alpi_patches *p = &r->patches;
    const alpi_texels *t = p->texels;
    uint32_t around[ALPI_AROUND_LIMIT], count = 0;
    const uint32_t all = alpi_lattice_around(p->lattice, texel, around);
    float sum = 0.0f;
    for (uint32_t i = 0; i < all; i++) {
        const uint32_t n = around[i];
        if (t->charts[n] == t->charts[texel] && p->patch_of[n] != ALPI_NONE && t->valid[n] == 0 &&
            (t->flags[n] & ALPI_TEXEL_HIDDEN) == 0) {
            sum += 1.0f - r->lost[p->patch_of[n]][1];
            count++;
        }
    }
    return count > 0 ? sum / (float)count : 1.0f;
}

float alpi_radiosity_visible_gain(const alpi_radiosity *r, uint32_t texel, uint32_t patch)
{
    const float most = 4.0f; // few rays must not turn a corner into a light
    const alpi_texels *texels = r->patches.texels;
    if (texels->valid == NULL || texels->valid[texel] == 0) {
        return 1.0f;
    }
    const float around = neighbours_open_share(r, texel), own = 1.0f - r->lost[patch][1];
    return fminf(fmaxf(around / fmaxf(own, 1.0f / most), 1.0f), most);
}

// --- cells ---------------------------------------------------------------------------------------

typedef struct relight_job {
    const alpi_radiosity *radiosity;
    uint32_t layer;                       // ALPI_NONE: all light
    const alpi_reference_value *gathered; // [texels] by fronts, or NULL: light of the patches
} relight_job;

static void relight_cell(const relight_job *job, uint32_t texel, alpi_side side)
{
    static const float none[3] = {0.0f, 0.0f, 0.0f};
    const alpi_radiosity *r = job->radiosity;
    const alpi_patches *p = &r->patches;
    const alpi_layer_arrays *layers = r->options.layers;
    const size_t back = side == ALPI_BACK ? 1 : 0;
    const size_t patch = back * p->patch_count + p->patch_of[texel];
    const size_t place = back * p->texels->count + texel;
    const bool all = job->layer == ALPI_NONE;
    const float *bounced = all ? r->before[patch] : layers->before[job->layer][patch];
    const float *sky = all || job->layer == layers->sky ? r->skies[patch] : none;
    const float *direct = all ? r->direct[place].mean : layers->direct[job->layer][place];
    const bool hidden = (p->texels->flags[texel] & ALPI_TEXEL_HIDDEN) != 0; // gathers nothing
    if (job->gathered != NULL && side == ALPI_FRONT && !hidden) {
        sky = none;
        bounced = job->gathered[texel].mean;
    }
    float *cell = p->cells[alpi_patches_cell(p, texel, side)];
    const float gain = back == 0 ? alpi_radiosity_visible_gain(r, texel, p->patch_of[texel]) : 1.0f;
    const float scale = (float)(1.0 / ALPI_PI) * gain;
    for (int k = 0; k < 3; k++) {
        cell[k] = p->reflectances[texel][k] * scale * (direct[k] + sky[k] + bounced[k]);
    }
}

/// Unseen backs stay black. Seen backs keep their light once their direct light is freed.
static alp_result relight_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const relight_job *job = user;
    const alpi_patches *p = &job->radiosity->patches;
    const bool backs = p->two_sided && !job->radiosity->backs_dropped;
    for (uint32_t t = begin; t < end; t++) {
        const uint32_t patch = p->patch_of[t];
        if (patch == ALPI_NONE) {
            continue;
        }
        relight_cell(job, t, ALPI_FRONT);
        if (backs && p->seen_backs[patch] == ALPI_BACK_LIT) {
            relight_cell(job, t, ALPI_BACK);
        }
    }
    return ALP_OK;
}

alp_result alpi_radiosity_relight(const alpi_radiosity *radiosity, uint32_t layer,
                                  const alpi_reference_value *gathered,
                                  const alpi_task_progress *progress)
{
    relight_job job = {radiosity, layer, gathered};
    return alpi_parallel_for(radiosity->options.context, radiosity->patches.texels->count,
                             TEXELS_PER_RANGE, relight_range, &job, progress);
}

alpi_gather_scene alpi_radiosity_scene(const alpi_radiosity *radiosity)
{
    const alpi_radiosity_options *o = &radiosity->options;
    return (alpi_gather_scene){.scene = o->scene,
                               .tracer = o->tracer,
                               .lighting = o->lighting,
                               .filter = o->filter,
                               .light = alpi_patches_light(&radiosity->patches),
                               .sky = o->direct != o->lighting};
}
