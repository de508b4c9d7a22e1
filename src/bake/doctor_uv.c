// SPDX-License-Identifier: MIT
// The doctor's look at texture coordinates: which sets can hold a bake, and what of the second one,
// which bakes keep, will be seen.
#include "bake/doctor.h"

#include "atlas/atlas.h"
#include "base/memory.h"

#include <math.h>

enum { KEPT_SET = 1 }; // what ALP_ATLAS_KEEP looks at
/// Ratio of densities from which shadows look sharp on one surface and blurred on another: two
/// steps of a mip-map, with some room.
static const double UNEVEN = 5.0;

static const double NO_VALUE = (double)NAN;

/// Index of a triangle in its surface, and the surface, for texts.
typedef struct spot {
    const char *surface;
    uint32_t triangle;
} spot;

static spot spot_of(const alp_scene *scene, uint32_t triangle)
{
    const alpi_surface *surface = &scene->surfaces[scene->triangle_surface[triangle]];
    return (spot){surface->name, triangle - surface->first_triangle};
}

/// Why a bake cannot go into the set, NULL-safe and short; "" = it can.
static char *make_reason(const alp_diagnosis *d, const alpi_uv_set_facts *f)
{
    alp_context *context = d->context;
    if (f->triangles == 0) {
        return alpi_copy_string(context, "no triangle has it");
    }
    if (f->missing_surfaces > 0) {
        return alpi_format(context, "%u of %u surfaces lack it", f->missing_surfaces,
                           f->missing_surfaces + f->surfaces);
    }
    if (f->outside > 0) {
        return alpi_format(context, "%u triangle%s outside of [0, 1]", f->outside,
                           f->outside == 1 ? " lies" : "s lie");
    }
    if (f->flat > 0) {
        return alpi_format(context, "%u triangle%s no area in it", f->flat,
                           f->flat == 1 ? " has" : "s have");
    }
    if (f->overlapping > 0) {
        return alpi_format(context, "triangles overlap%s",
                           f->shared >= 1.0 ? ", as nodes share a mesh" : "");
    }
    return alpi_copy_string(context, "");
}

static alp_result keep_facts(alp_diagnosis *d, uint32_t set, const alpi_uv_set_facts *f)
{
    const uint32_t i = d->uv_set_count;
    char *reason = make_reason(d, f);
    if (reason == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    d->reasons[i] = reason;
    d->uv_sets[i] = (alp_uv_set_info){.set = set,
                                      .surfaces = f->surfaces,
                                      .missing_surfaces = f->missing_surfaces,
                                      .triangles = f->triangles,
                                      .outside_triangles = f->outside,
                                      .flat_triangles = f->flat,
                                      .overlapping_triangles = f->overlapping,
                                      .islands = f->islands,
                                      .touching_islands = f->touching,
                                      .coverage = f->coverage,
                                      .overlap = f->overlap,
                                      .shared = f->shared,
                                      .density_ratio = f->density_ratio,
                                      .holds_bake = reason[0] == '\0',
                                      .reason = reason};
    d->uv_set_count++;
    return ALP_OK;
}

// --- what keeps a bake out -----------------------------------------------------------------------

static alp_result tell_missing(alp_diagnosis *d, const alpi_uv_set_facts *f)
{
    const alpi_finding_facts facts = {ALP_FINDING_UV_MISSING, ALP_PLACE_UV_SET, KEPT_SET,
                                      f->missing_surfaces, NO_VALUE};
    return f->missing_surfaces == 0 || f->surfaces == 0
               ? ALP_OK
               : alpi_diagnosis_add(d, facts, "%u of %u surfaces lack it, such as %.60s",
                                    f->missing_surfaces, f->missing_surfaces + f->surfaces,
                                    d->scene->surfaces[f->first_missing].name);
}

/// Findings of so many triangles, with one of them as an example.
static alp_result tell_triangles(alp_diagnosis *d, alpi_finding_facts facts,
                                 const alpi_uv_set_facts *f, uint32_t first, const char *fault)
{
    if (facts.count == 0) {
        return ALP_OK;
    }
    const spot at = spot_of(d->scene, first);
    facts.place = ALP_PLACE_UV_SET;
    facts.index = KEPT_SET;
    return alpi_diagnosis_add(d, facts, "%llu of %u triangle%s %s, such as %u of %.60s",
                              (unsigned long long)facts.count, f->triangles,
                              alpi_plural(f->triangles), fault, at.triangle, at.surface);
}

static alp_result tell_overlaps(alp_diagnosis *d, const alpi_uv_set_facts *f)
{
    if (f->overlapping == 0) {
        return ALP_OK;
    }
    const bool shared = f->shared >= 1.0;
    const spot at = spot_of(d->scene, f->first_overlap);
    const alpi_finding_facts facts = {shared ? ALP_FINDING_UV_SHARED : ALP_FINDING_UV_OVERLAP,
                                      ALP_PLACE_UV_SET, KEPT_SET, f->overlapping, f->overlap};
    return alpi_diagnosis_add(
        d, facts, "triangles %s on %.3g %% of its texels, such as %u of %.60s",
        shared ? "lie in the place of the same ones of another node" : "overlap",
        100.0 * f->overlap, at.triangle, at.surface);
}

static alp_result tell_faults(alp_diagnosis *d, const alpi_uv_set_facts *f)
{
    const double all = f->triangles;
    ALP_TRY(tell_missing(d, f));
    ALP_TRY(tell_triangles(d,
                           (alpi_finding_facts){.kind = ALP_FINDING_UV_OUTSIDE,
                                                .count = f->outside,
                                                .value = f->outside / all},
                           f, f->first_outside, "reach out of the unit square"));
    ALP_TRY(tell_triangles(
        d,
        (alpi_finding_facts){.kind = ALP_FINDING_UV_FLAT, .count = f->flat, .value = f->flat / all},
        f, f->first_flat, "have no area in it"));
    return tell_overlaps(d, f);
}

// --- what will be seen of a bake in it -----------------------------------------------------------

static alp_result tell_quality(alp_diagnosis *d, const alpi_uv_set_facts *f)
{
    const alp_scene *scene = d->scene;
    if (f->touching > 0) {
        const alpi_finding_facts facts = {ALP_FINDING_UV_PADDING, ALP_PLACE_UV_SET, KEPT_SET,
                                          f->touching, (double)f->touching / f->islands};
        ALP_TRY(alpi_diagnosis_add(d, facts,
                                   "%u of %u islands have no free texel to the next one on a page "
                                   "of %d",
                                   f->touching, f->islands, (int)ALPI_DOCTOR_PAGE));
    }
    if (f->density_ratio > UNEVEN) {
        const alpi_finding_facts facts = {ALP_FINDING_UV_DENSITY, ALP_PLACE_UV_SET, KEPT_SET, 0,
                                          f->density_ratio};
        ALP_TRY(alpi_diagnosis_add(
            d, facts, "%.60s has %.3g times as many texels per metre as %.60s",
            scene->surfaces[f->finest].name, f->density_ratio, scene->surfaces[f->coarsest].name));
    }
    return ALP_OK;
}

// --- all sets ------------------------------------------------------------------------------------

static alp_result look_at_set(alp_diagnosis *d, uint32_t set)
{
    alpi_uv_set_facts facts;
    alp_atlas *layout = NULL;
    ALP_TRY(alpi_uv_set_survey(d->scene, set, ALPI_DOCTOR_PAGE, &facts, &layout));
    alp_atlas_destroy(layout);
    ALP_TRY(keep_facts(d, set, &facts));
    if (set != KEPT_SET || facts.triangles == 0) {
        return ALP_OK;
    }
    ALP_TRY(tell_faults(d, &facts));
    return d->uv_sets[d->uv_set_count - 1].holds_bake ? tell_quality(d, &facts) : ALP_OK;
}

alp_result alpi_doctor_look_at_uvs(alp_diagnosis *diagnosis)
{
    const alp_scene *scene = diagnosis->scene;
    if (scene->usable_count == 0) {
        return ALP_OK;
    }
    uint32_t set_count = 0;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const uint32_t own = scene->surfaces[s].uv_sets;
        set_count = own > set_count ? own : set_count;
    }
    for (uint32_t set = 0; set < set_count && set < ALPI_UV_SET_LIMIT; set++) {
        ALP_TRY(look_at_set(diagnosis, set));
    }
    if (set_count == 0) {
        const alpi_finding_facts facts = {.kind = ALP_FINDING_NO_UVS, .value = NO_VALUE};
        return alpi_diagnosis_add(diagnosis, facts, "no surface has texture coordinates");
    }
    return ALP_OK;
}
