// SPDX-License-Identifier: MIT
// Receivers of the bounce passes: all fronts, and the backs that rays of other receivers meet. Each
// traces its first rays here.
#include "maps/radiosity/solver.h"

#include "base/memory.h"

#include <string.h>

alpi_gather_job alpi_solver_job(const alpi_solver *solver, const uint32_t *list, uint32_t count)
{
    const alpi_radiosity *r = solver->r;
    return (alpi_gather_job){.context = r->options.context,
                             .from = &solver->from,
                             .gatherer = r->options.gatherer,
                             .receivers = &solver->patches,
                             .list = list,
                             .count = count,
                             .values = r->bounced,
                             .skies = r->skies,
                             .lost = r->lost};
}

/// Allocates kept rays for all possible receivers, if memory allows and all hits are cells.
static alp_result reserve_rays(alpi_solver *s)
{
    alpi_radiosity *r = s->r;
    const alpi_radiosity_options *o = &r->options;
    const uint32_t room = r->patches.patch_count * (uint32_t)alpi_patches_sides(&r->patches);
    const uint64_t each = alpi_kept_rays_size(o->gatherer);
    bool fit;
    ALP_TRY(alpi_kept_rays_fit(o->context, each * room, o->kept_limit, &fit));
    r->kept = fit && alpi_gather_meets_cells(&s->from);
    return r->kept ? alpi_kept_rays_reserve(o->context, o->gatherer, room, &s->kept) : ALP_OK;
}

/// Whether a texel's back needs light before any ray meets it: that of an emitter, whose rays
/// measure the energy that leaves it, and every back if all gather.
static bool gathers_behind(const alpi_radiosity *r, uint32_t texel)
{
    const alpi_patches *p = &r->patches;
    return (r->options.backs || p->emissions[texel] > 0.0f) &&
           alpi_surface_is_double_sided(p->scene, p->texels->triangles[texel]);
}

static void start_receivers(const alpi_solver *s)
{
    alpi_radiosity *r = s->r;
    const alpi_patches *p = &r->patches;
    for (uint32_t b = 0; b < p->patch_count; b++) {
        r->receivers[b] = b;
        for (uint32_t k = p->patch_first[b]; k < p->patch_first[b + 1] && p->two_sided; k++) {
            if (gathers_behind(r, p->patch_texels[k])) {
                p->seen_backs[b] = ALPI_BACK_SEEN;
            }
        }
    }
    r->receiver_count = p->patch_count;
}

/// Traces the first rays of listed receivers, unless no step needs them.
static alp_result trace_first_rays(alpi_solver *s, const uint32_t *list, uint32_t count)
{
    alpi_gather_job job = alpi_solver_job(s, list, count);
    const alpi_patches *p = &s->r->patches;
    if (!s->r->kept && !p->two_sided && !s->from.sky && p->texels->valid == NULL) {
        return ALP_OK;
    }
    job.marks = p->two_sided ? p->seen_backs : NULL;
    job.mark_count = p->two_sided ? p->patch_count : 0;
    s->r->rays += (uint64_t)count * job.gatherer->packet_count * ALPI_PACKET;
    return s->r->kept ? alpi_kept_rays_trace(&job, &s->progress, &s->kept)
                      : alpi_gather_irradiance(&job, &s->progress);
}

/// Appends the backs that rays met since the last call to the receivers. @return their number
static uint32_t add_seen_backs(const alpi_solver *s)
{
    const alpi_patches *p = &s->r->patches;
    const uint32_t before = s->r->receiver_count;
    for (uint32_t b = 0; b < p->patch_count && p->two_sided; b++) {
        if (p->seen_backs[b] == ALPI_BACK_SEEN) {
            p->seen_backs[b] = ALPI_BACK_LIT;
            s->r->receivers[s->r->receiver_count++] = p->patch_count + b;
        }
    }
    return s->r->receiver_count - before;
}

/// Direct light of the backs of listed receivers.
static alp_result light_backs(const alpi_solver *s, const uint32_t *receivers, uint32_t count)
{
    const alpi_patches *p = &s->r->patches;
    uint32_t *list = ALPI_NEW(p->context, uint32_t, p->texels->count);
    uint32_t texels = 0;
    if (list == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t b = receivers[i] - p->patch_count;
        for (uint32_t k = p->patch_first[b]; k < p->patch_first[b + 1]; k++) {
            list[texels++] = p->texels->count + p->patch_texels[k];
        }
    }
    const alp_result result = alpi_solver_direct(s, list, texels, NULL);
    alpi_release(p->context, list);
    return result;
}

alp_result alpi_solver_trace_receivers(alpi_solver *solver)
{
    alpi_radiosity *r = solver->r;
    start_receivers(solver);
    ALP_TRY(reserve_rays(solver));
    ALP_TRY(trace_first_rays(solver, r->receivers, r->receiver_count));
    for (uint32_t count = add_seen_backs(solver); count > 0; count = add_seen_backs(solver)) {
        const uint32_t *backs = r->receivers + r->receiver_count - count;
        ALP_TRY(light_backs(solver, backs, count));
        ALP_TRY(trace_first_rays(solver, backs, count));
    }
    solver->from.sky = false; // r->skies hold its light now
    memset(r->bounced, 0, (size_t)solver->patches.count * sizeof *r->bounced);
    return ALP_OK;
}
