// SPDX-License-Identifier: MIT
// Energy balance of a solution.
#include "maps/radiosity/solver.h"

#include "base/tasks.h"

/// Sums over texels: direct light, parts of alpi_energy, emitted light, and its part that hits
/// other surfaces.
enum { RECEIVED, ABSORBED, ESCAPED, LOST_BEHIND, UNSHOT, EMITTED, EMITTED_AT_OTHERS };
_Static_assert((int)EMITTED_AT_OTHERS < (int)ALPI_SUM_LIMIT, "all are summed at once");

static void add_texel_energy(const alpi_radiosity *r, uint32_t receiver, size_t back, uint32_t t,
                             double sums[ALPI_SUM_LIMIT])
{
    const bool emits = back == 0 || alpi_surface_is_double_sided(r->patches.scene,
                                                                 r->patches.texels->triangles[t]);
    const alpi_patches *p = &r->patches;
    const double area = (double)alpi_texels_area(p->texels, t);
    const float *direct = r->direct[back * p->texels->count + t].mean;
    const float *now = r->bounced[receiver].mean, *before = r->before[receiver];
    const double gain = back == 0 ? (double)alpi_radiosity_visible_gain(r, t, receiver) : 1.0;
    // Lost shares of emitted light, then of reflected light, which only the visible part reflects.
    const double lost[2] = {(double)r->lost[receiver][0], (double)r->lost[receiver][1]};
    const double escaped = gain * lost[0], behind = 1.0 - gain * (1.0 - lost[1]);
    const double emitted = emits ? ALPI_PI * (double)p->emissions[t] : 0.0;
    double own[ALPI_SUM_LIMIT] = {0.0}; // local: in `sums`, each write would wait for a read
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
        size_t back;
        const uint32_t b = alpi_receiver_patch(p, r->receivers[i], &back);
        for (uint32_t k = p->patch_first[b]; k < p->patch_first[b + 1]; k++) {
            add_texel_energy(r, r->receivers[i], back, p->patch_texels[k], sums);
        }
    }
}

alp_result alpi_radiosity_measure_energy(alpi_radiosity *r, const alpi_task_progress *progress)
{
    double sums[ALPI_SUM_LIMIT] = {0.0};
    ALP_TRY(
        alpi_parallel_sum(r->options.context, r->receiver_count, sum_energy, r, progress, sums));
    const alpi_lighting *l = r->options.lighting;
    const bool others = alpi_lighting_light_count(l) > 0 || alpi_lighting_sky(l) != NULL;
    r->energy = (alpi_energy){.emitted = sums[EMITTED] +
                                         (others ? sums[RECEIVED] - sums[EMITTED_AT_OTHERS] : 0.0),
                              .absorbed = sums[ABSORBED],
                              .escaped = sums[ESCAPED],
                              .lost_behind = sums[LOST_BEHIND],
                              .unshot = sums[UNSHOT],
                              .known = !alpi_tracer_has_panes(r->options.tracer)};
    return ALP_OK;
}
