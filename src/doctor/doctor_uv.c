// SPDX-License-Identifier: MIT
// The doctor's look at texture coordinates: which sets can hold a bake, and what of the second one,
// which bakes keep, will be seen.
#include "doctor/doctor.h"

#include "atlas/atlas.h"
#include "base/memory.h"

#include <math.h>

/// Ratio of densities from which shadows look sharp on one surface and blurred on another: two
/// steps of a mip-map, with some room.
static const double UNEVEN = 5.0;
/// L2 stretch of a surface from which its texels are told of: the mean texel is as long as eight
/// times its width (√((8 + 1/8) / 2) = 2.02). It is also the most that charts may have.
static const double STRETCHED = 2.0;
/// Of the scene's area, in islands smaller than a texel: less is screws and hinges.
static const double TINY_SHARE = 1e-3;
/// Free texels from which a set holds a second mip level: level k halves them k times, and a
/// bilinear look-up takes one to each side of an island.
enum { TWO_LEVELS = 2 };

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

/// Marks the finding that was added last, at a point of the set; NULL = the triangle's middle.
static void mark_in_set(alp_diagnosis *d, uint32_t triangle, const float *uv)
{
    const alp_scene *scene = d->scene;
    float middle[2] = {0.0f, 0.0f};
    vec3 c[3];
    alpi_triangle_corners(scene, triangle, c);
    for (int k = 0; k < 6; k++) {
        middle[k % 2] += scene->uvs[ALPI_KEPT_SET][scene->triangles[triangle][k / 2]][k % 2] / 3.0f;
    }
    alpi_diagnosis_mark(d, triangle, vec3_scale(vec3_add(vec3_add(c[0], c[1]), c[2]), 1.0f / 3.0f),
                        uv != NULL ? uv : middle);
}

/// Why a bake cannot go into the set, NULL-safe and short; "" = it can.
static char *make_reason(const alp_diagnosis *d, uint32_t set, const alpi_uv_set_facts *f)
{
    alp_context *context = d->context;
    if (f->triangles == 0) {
        return alpi_copy_string(context, "no triangle has it");
    }
    if (alpi_scene_set_is_blended(d->scene, set)) {
        return alpi_copy_string(context, "a shader blends it with two others");
    }
    if (f->missing_surfaces > 0) {
        return alpi_format(context, "%u of %u surfaces %s it", f->missing_surfaces,
                           f->missing_surfaces + f->surfaces,
                           alpi_one_or_many(f->missing_surfaces, "lacks", "lack"));
    }
    if (f->outside > 0) {
        return alpi_format(context, "%u triangle%s outside of [0, 1]", f->outside,
                           alpi_one_or_many(f->outside, " lies", "s lie"));
    }
    if (f->flat > 0) {
        return alpi_format(context, "%u triangle%s no area in it", f->flat,
                           alpi_one_or_many(f->flat, " has", "s have"));
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
    char *reason = make_reason(d, set, f);
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
    const alpi_finding_facts facts = {ALP_FINDING_UV_MISSING, ALP_PLACE_UV_SET, ALPI_KEPT_SET,
                                      f->missing_surfaces, NO_VALUE};
    return f->missing_surfaces == 0 || f->surfaces == 0
               ? ALP_OK
               : alpi_diagnosis_add(d, facts, "%u of %u surfaces %s it, such as %.60s",
                                    f->missing_surfaces, f->missing_surfaces + f->surfaces,
                                    alpi_one_or_many(f->missing_surfaces, "lacks", "lack"),
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
    facts.index = ALPI_KEPT_SET;
    ALP_TRY(alpi_diagnosis_add(d, facts, "%llu of %u triangle%s %s, such as %u of %.60s",
                               (unsigned long long)facts.count, f->triangles,
                               alpi_plural(f->triangles), fault, at.triangle, at.surface));
    mark_in_set(d, first, NULL);
    return ALP_OK;
}

static alp_result tell_overlaps(alp_diagnosis *d, const alpi_uv_set_facts *f)
{
    if (f->overlapping == 0) {
        return ALP_OK;
    }
    const bool shared = f->shared >= 1.0;
    const spot at = spot_of(d->scene, f->first_overlap);
    const alpi_finding_facts facts = {shared ? ALP_FINDING_UV_SHARED : ALP_FINDING_UV_OVERLAP,
                                      ALP_PLACE_UV_SET, ALPI_KEPT_SET, f->overlapping, f->overlap};
    ALP_TRY(alpi_diagnosis_add(d, facts,
                               "triangles %s on %.3g %% of its texels, such as %u of %.60s",
                               shared ? "coincide with the same ones of another node" : "overlap",
                               100.0 * f->overlap, at.triangle, at.surface));
    mark_in_set(d, f->first_overlap, NULL);
    return ALP_OK;
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

static alp_result tell_space(alp_diagnosis *d, const alpi_uv_set_facts *f, const alpi_uv_quality *q)
{
    if (f->touching > 0) {
        const alpi_finding_facts facts = {ALP_FINDING_UV_PADDING, ALP_PLACE_UV_SET, ALPI_KEPT_SET,
                                          f->touching, (double)f->touching / f->islands};
        ALP_TRY(alpi_diagnosis_add(d, facts,
                                   "%u of %u islands %s no free texel to the next one on a page "
                                   "of %u",
                                   f->touching, f->islands,
                                   alpi_one_or_many(f->touching, "has", "have"), d->page_size));
        mark_in_set(d, q->near[0], q->gap);
    }
    if (f->touching == 0 && q->near[0] != ALPI_NONE && q->free < TWO_LEVELS) {
        const spot one = spot_of(d->scene, q->near[0]), other = spot_of(d->scene, q->near[1]);
        const alpi_finding_facts facts = {ALP_FINDING_UV_MIPS, ALP_PLACE_UV_SET, ALPI_KEPT_SET, 0,
                                          q->free};
        ALP_TRY(alpi_diagnosis_add(
            d, facts,
            "%u free texel%s between triangle %u of %.60s and %u of %.60s, nearest of all islands "
            "on a page of %u: enough for the full size, not for smaller mip levels",
            q->free, alpi_plural(q->free), one.triangle, one.surface, other.triangle, other.surface,
            d->page_size));
        mark_in_set(d, q->near[0], q->gap);
    }
    return ALP_OK;
}

/// The power of two from which a page gives an island a texel.
static uint64_t helping_size(const alp_diagnosis *d, double texels)
{
    uint64_t size = d->page_size;
    for (double area = texels; area > 0.0 && area < 1.0; area *= 4.0) {
        size *= 2;
    }
    return size;
}

static alp_result tell_tiny(alp_diagnosis *d, const alpi_uv_set_facts *f, const alpi_uv_quality *q)
{
    if (q->tiny == 0 || !(q->tiny_share >= TINY_SHARE)) {
        return ALP_OK;
    }
    const spot at = spot_of(d->scene, q->tiny_worst);
    const alpi_finding_facts facts = {ALP_FINDING_UV_TINY, ALP_PLACE_UV_SET, ALPI_KEPT_SET, q->tiny,
                                      q->tiny_share};
    ALP_TRY(alpi_diagnosis_add(
        d, facts,
        "%u of %u island%s, %.3g %% of the surface, %s less than a texel on a page of %u, such as "
        "that of triangle %u of %.60s, which would need a page of %llu",
        q->tiny, f->islands, alpi_plural(f->islands), 100.0 * q->tiny_share,
        alpi_one_or_many(q->tiny, "has", "have"), d->page_size, at.triangle, at.surface,
        (unsigned long long)helping_size(d, q->tiny_texels)));
    mark_in_set(d, q->tiny_worst, NULL);
    return ALP_OK;
}

static alp_result tell_stretch(alp_diagnosis *d, const alpi_uv_quality *q)
{
    if (!(q->stretch > STRETCHED)) {
        return ALP_OK;
    }
    const spot at = spot_of(d->scene, q->stretched_worst);
    const alpi_finding_facts facts = {ALP_FINDING_UV_STRETCH, ALP_PLACE_UV_SET, ALPI_KEPT_SET, 0,
                                      q->stretch};
    ALP_TRY(alpi_diagnosis_add(d, facts,
                               "%.60s is stretched %.3g times (L2; 1 = even), its triangle %u "
                               "%.3g times",
                               at.surface, q->stretch, at.triangle, q->own_stretch));
    mark_in_set(d, q->stretched_worst, NULL);
    return ALP_OK;
}

static alp_result tell_quality(alp_diagnosis *d, const alpi_uv_set_facts *f,
                               const alpi_uv_quality *q)
{
    const alp_scene *scene = d->scene;
    ALP_TRY(tell_space(d, f, q));
    ALP_TRY(tell_tiny(d, f, q));
    ALP_TRY(tell_stretch(d, q));
    if (f->density_ratio > UNEVEN) {
        const alpi_finding_facts facts = {ALP_FINDING_UV_DENSITY, ALP_PLACE_UV_SET, ALPI_KEPT_SET,
                                          0, f->density_ratio};
        ALP_TRY(alpi_diagnosis_add(
            d, facts, "%.60s has %.3g times as many texels per metre as %.60s",
            scene->surfaces[f->finest].name, f->density_ratio, scene->surfaces[f->coarsest].name));
    }
    return ALP_OK;
}

// --- all sets ------------------------------------------------------------------------------------

static alp_result judge_kept(alp_diagnosis *d, const alpi_uv_set_facts *f, const alp_atlas *layout)
{
    alp_uv_set_info *info = &d->uv_sets[d->uv_set_count - 1];
    alpi_uv_quality q;
    ALP_TRY(tell_faults(d, f));
    if (!info->holds_bake) {
        return ALP_OK;
    }
    ALP_TRY(alpi_uv_set_quality(layout, &q));
    info->tiny_islands = q.tiny;
    info->free_texels = q.free;
    info->stretch = q.stretch;
    return tell_quality(d, f, &q);
}

static alp_result look_at_set(alp_diagnosis *d, uint32_t set)
{
    alpi_uv_set_facts facts;
    alp_atlas *layout = NULL;
    ALP_TRY(alpi_uv_set_survey(d->scene, set, d->page_size, (const uint32_t(*)[3])d->neighbours,
                               &facts, &layout));
    alp_result result = keep_facts(d, set, &facts);
    // What a bake of ours laid out to be blended is no place for another, and no fault.
    if (result == ALP_OK && set == ALPI_KEPT_SET && facts.triangles > 0 &&
        !alpi_scene_set_is_blended(d->scene, set)) {
        result = judge_kept(d, &facts, layout);
    }
    alp_atlas_destroy(layout);
    return result;
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
