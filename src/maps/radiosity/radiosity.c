// SPDX-License-Identifier: MIT
#include "maps/radiosity/radiosity.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "maps/radiosity/solver.h"

double alpi_radiosity_tolerance(uint32_t bounces)
{
    return bounces > ALPI_RADIOSITY_PASS_LIMIT ? 5e-4 : 0.0;
}

alpi_radiosity_options alpi_radiosity_options_default(void)
{
    return (alpi_radiosity_options){.bounces = UINT32_MAX,
                                    .tolerance = alpi_radiosity_tolerance(UINT32_MAX),
                                    .direct_samples = 16,
                                    .kept_limit = 1ull << 30};
}

static alp_result allocate(alpi_radiosity *r)
{
    const alpi_patches *p = &r->patches;
    alp_context *context = r->options.context;
    const size_t patches = alpi_patches_sides(p) * p->patch_count;
    const size_t texels = alpi_patches_sides(p) * p->texels->count;
    ALPI_TRY_NEW(context, r->direct, texels);
    if (r->options.directional) {
        ALPI_TRY_NEW(context, r->directional, p->texels->count);
    }
    ALPI_TRY_NEW(context, r->bounced, patches);
    ALPI_TRY_NEW(context, r->before, patches);
    ALPI_TRY_NEW(context, r->skies, patches);
    ALPI_TRY_NEW(context, r->lost, patches);
    ALPI_TRY_NEW(context, r->receivers, patches);
    return r->options.layers == NULL
               ? ALP_OK
               : alpi_layer_arrays_reserve(r->options.layers, texels, patches, p->texels->count);
}

static alp_result light_fronts(const alpi_solver *s, const uint32_t *order, uint32_t count)
{
    const double began = alpi_seconds();
    ALP_TRY(alpi_solver_direct(s, order, count, s->r->directional));
    s->r->direct_seconds = alpi_seconds() - began;
    return ALP_OK;
}

/// Frees the direct light of backs, which their cells hold now. Layers need it again.
static alp_result drop_backs(alpi_radiosity *r)
{
    const alpi_patches *p = &r->patches;
    if (p->two_sided && r->options.layers == NULL) {
        void *fronts =
            alpi_reallocate(r->options.context, r->direct, p->texels->count, sizeof *r->direct);
        if (fronts == NULL) {
            return ALP_ERROR_OUT_OF_MEMORY;
        }
        r->direct = fronts;
        r->backs_dropped = true;
    }
    return ALP_OK;
}

static alp_result solve(alpi_solver *s, const uint32_t *order, uint32_t count)
{
    ALP_TRY(allocate(s->r));
    ALP_TRY(light_fronts(s, order, count));
    s->from = alpi_radiosity_scene(s->r);
    s->patches = alpi_patches_receivers(&s->r->patches);
    ALP_TRY(alpi_solver_trace_receivers(s));
    ALP_TRY(alpi_solver_bounce(s));
    ALP_TRY(alpi_radiosity_measure_energy(s->r, &s->progress));
    return alpi_solver_bounce_layers(s);
}

alp_result alpi_radiosity_solve(const alpi_radiosity_options *options, const alpi_lattice *lattice,
                                const alp_atlas *atlas, const uint32_t *order, uint32_t count,
                                const alpi_task_progress *progress, alpi_radiosity *radiosity)
{
    *radiosity = (alpi_radiosity){.options = *options};
    alpi_solver s = {.r = radiosity};
    s.progress = progress != NULL ? *progress : (alpi_task_progress){0};
    ALP_TRY(
        alpi_patches_create(lattice, atlas, order, count, options->proximity, &radiosity->patches));
    alp_result result = solve(&s, order, count);
    alpi_kept_rays_destroy(&s.kept);
    alpi_acceleration_destroy(options->context, &s.acceleration);
    result = result == ALP_OK ? drop_backs(radiosity) : result;
    if (result != ALP_OK) {
        alpi_radiosity_destroy(radiosity);
    }
    return result;
}

void alpi_radiosity_trim(alpi_radiosity *radiosity, bool relit)
{
    alp_context *context = radiosity->options.context;
    if (radiosity->options.layers != NULL) {
        return;
    }
    alpi_patches_trim(&radiosity->patches, relit);
    alpi_release(context, radiosity->bounced);
    alpi_release(context, radiosity->receivers);
    radiosity->bounced = NULL;
    radiosity->receivers = NULL;
    if (!relit) {
        alpi_release(context, radiosity->before);
        alpi_release(context, radiosity->skies);
        alpi_release(context, radiosity->lost);
        radiosity->before = radiosity->skies = NULL;
        radiosity->lost = NULL;
    }
}

void alpi_radiosity_destroy(alpi_radiosity *radiosity)
{
    alp_context *context = radiosity->options.context;
    if (context == NULL) {
        return;
    }
    alpi_patches_destroy(&radiosity->patches);
    alpi_release(context, radiosity->direct);
    alpi_release(context, radiosity->directional);
    alpi_release(context, radiosity->bounced);
    alpi_release(context, radiosity->before);
    alpi_release(context, radiosity->skies);
    alpi_release(context, radiosity->lost);
    alpi_release(context, radiosity->receivers);
    *radiosity = (alpi_radiosity){0};
}
