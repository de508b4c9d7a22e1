// SPDX-License-Identifier: MIT
// Where the light of a solution goes, and what of it other geometry keeps from being met.
#include "maps/radiosity/radiosity.h"

#include "base/tasks.h"

#include <math.h>

/// Share of the rays of the texels beside one, of its chart and not covered, that do not end on the
/// back of a surface; the rest is what single-sided surfaces hide. 1 where there is no such texel.
static float open_share_beside(const alpi_radiosity *r, uint32_t texel)
{
    const alpi_patches *p = &r->patches;
    const alpi_texels *t = p->texels;
    const uint16_t *pixel = t->pixels[texel];
    float sum = 0.0f;
    uint32_t count = 0;
    for (int k = 0; k < 9; k++) {
        const uint32_t n = alpi_lattice_texel(p->lattice, t->pages[texel], pixel[0] + k % 3 - 1,
                                              pixel[1] + k / 3 - 1);
        if (n != ALPI_NONE && t->charts[n] == t->charts[texel] && p->blocks[n] != ALPI_NONE &&
            t->valid[n] == 0 && (t->flags[n] & ALPI_TEXEL_HIDDEN) == 0) {
            sum += 1.0f - r->lost[p->blocks[n]][1];
            count++;
        }
    }
    return count > 0 ? sum / (float)count : 1.0f;
}

float alpi_radiosity_brighter(const alpi_radiosity *r, uint32_t texel, uint32_t block)
{
    const float most = 4.0f; // so that few rays do not make a light of a corner
    const alpi_texels *texels = r->patches.texels;
    if (texels->valid == NULL || texels->valid[texel] == 0) {
        return 1.0f;
    }
    const float beside = open_share_beside(r, texel), own = 1.0f - r->lost[block][1];
    return fminf(fmaxf(beside / fmaxf(own, 1.0f / most), 1.0f), most);
}

/// What is summed over texels: of alpi_energy, and what surfaces emit, all of it and what of it
/// reaches others.
enum { RECEIVED, ABSORBED, ESCAPED, LOST_BEHIND, UNSHOT, EMITTED, EMITTED_AT_OTHERS };
_Static_assert((int)EMITTED_AT_OTHERS < (int)ALPI_SUM_LIMIT, "all are summed at once");

static void add_texel_energy(const alpi_radiosity *r, uint32_t receiver, size_t back, uint32_t t,
                             double sums[ALPI_SUM_LIMIT])
{
    const bool gives = back == 0 || alpi_surface_is_double_sided(r->patches.scene,
                                                                 r->patches.texels->triangles[t]);
    const alpi_patches *p = &r->patches;
    const double area = (double)alpi_texels_area(p->texels, t);
    const float *direct = r->direct[back * p->texels->count + t].mean;
    const float *now = r->bounced[receiver].mean, *before = r->before[receiver];
    const double brighter = back == 0 ? (double)alpi_radiosity_brighter(r, t, receiver) : 1.0;
    // Of what is emitted, and of what is reflected, which leaves the open part alone.
    const double lost[2] = {(double)r->lost[receiver][0], (double)r->lost[receiver][1]};
    const double escaped = brighter * lost[0], behind = 1.0 - brighter * (1.0 - lost[1]);
    const double emitted = gives ? ALPI_PI * (double)p->emissions[t] : 0.0;
    double own[ALPI_SUM_LIMIT] = {0.0}; // of this texel: `sums` would be written and read by turns
    for (int k = 0; k < 3; k++) {
        const double share = area / 3.0, albedo = (double)p->reflectances[t][k];
        const double first = (double)direct[k] + (double)r->skies[receiver][k];
        const double reflected = albedo * (first + (double)before[k]);
        own[RECEIVED] += share * first;
        own[ABSORBED] += share * (1.0 - albedo) * (first + (double)now[k]);
        own[ESCAPED] += share * (escaped * reflected + lost[0] * emitted);
        own[LOST_BEHIND] += share * (behind * reflected + lost[1] * emitted);
        own[UNSHOT] += share * albedo * ((double)now[k] - (double)before[k]);
        own[EMITTED] += share * emitted;
        own[EMITTED_AT_OTHERS] += share * emitted * (1.0 - lost[0] - lost[1]);
    }
    for (int i = 0; i < ALPI_SUM_LIMIT; i++) {
        sums[i] += own[i];
    }
}

static void sum_energy(const void *user, uint32_t begin, uint32_t end, double sums[ALPI_SUM_LIMIT])
{
    const alpi_radiosity *r = user;
    const alpi_patches *p = &r->patches;
    for (uint32_t i = begin; i < end; i++) {
        const size_t back = r->receivers[i] >= p->block_count ? 1 : 0;
        const uint32_t b = back != 0 ? r->receivers[i] - p->block_count : r->receivers[i];
        for (uint32_t k = p->block_first[b]; k < p->block_first[b + 1]; k++) {
            add_texel_energy(r, r->receivers[i], back, p->block_texels[k], sums);
        }
    }
}

alp_result alpi_radiosity_find_energy(alpi_radiosity *r, const alpi_task_progress *progress)
{
    double sums[ALPI_SUM_LIMIT] = {0.0};
    ALP_TRY(
        alpi_parallel_sum(r->options.context, r->receiver_count, sum_energy, r, progress, sums));
    const alpi_lighting *l = r->options.lighting;
    const bool others = alpi_lighting_light_count(l) > 0 || alpi_lighting_sky(l) != NULL;
    r->energy = (alpi_energy){.emitted = sums[EMITTED] +
                                         (others ? sums[RECEIVED] - sums[EMITTED_AT_OTHERS] : 0.0),
                              .received = sums[RECEIVED],
                              .absorbed = sums[ABSORBED],
                              .escaped = sums[ESCAPED],
                              .lost_behind = sums[LOST_BEHIND],
                              .unshot = sums[UNSHOT],
                              .known = !alpi_tracer_has_panes(r->options.tracer)};
    return ALP_OK;
}
