// SPDX-License-Identifier: MIT
// The doctor's look at backs: single-sided surfaces that other surfaces see from behind, found by
// rays from points spread over the scene.
#include "doctor/doctor_rays.h"

#include "base/memory.h"

/// 16 rays each: of 16384 a share of 10 % has a standard error of .2 %.
enum { POINTS = 1024, RAYS = ALPI_DOCTOR_RAYS, POINTS_PER_RANGE = 32, STREAM_BACKS = 201 };
/// Share of what surfaces see from which backs are worth a word. In a good scene solids reach into
/// each other, and see out through their faces there: 5 % in builtin:atrium, 9 % in measured
/// models.
static const double BACKS_SHARE = 0.1;
/// Of all rays: where hardly any meet anything, shares say nothing.
static const double SEEN_SHARE = 0.01;
/// A point that sees so much of backs lies inside something: nobody sees it. In sixteenths.
enum { INSIDE = RAYS * 3 / 4 };

/// What a point sees.
typedef struct view {
    uint32_t hits[RAYS]; // triangle met from behind, or one of these
} view;
static const uint32_t NOTHING = ALPI_NONE, FRONT = ALPI_NONE - 1;

static void look_from(const alpi_doctor_points *points, uint32_t point, void *kept)
{
    view *seen = kept;
    for (uint32_t first = 0; first < RAYS; first += ALPI_PACKET) {
        alpi_doctor_hit hits[ALPI_PACKET];
        alpi_doctor_look_from(points, point, 1.0f, STREAM_BACKS, first, hits);
        for (uint32_t i = 0; i < ALPI_PACKET; i++) {
            seen->hits[first + i] =
                hits[i].back || hits[i].triangle == NOTHING ? hits[i].triangle : FRONT;
        }
    }
}

/// Adds up what was seen; of backs, `counts` has each surface's, `first` a triangle of it.
static void add_up(const alp_scene *scene, const view *views, uint32_t *counts, uint32_t *first,
                   uint32_t *seen, uint32_t *backs)
{
    for (uint32_t p = 0; p < POINTS; p++) {
        uint32_t own = 0;
        for (uint32_t i = 0; i < RAYS; i++) {
            own += views[p].hits[i] < FRONT;
        }
        for (uint32_t i = 0; own < INSIDE && i < RAYS; i++) {
            const uint32_t hit = views[p].hits[i];
            *seen += hit != NOTHING;
            if (hit < FRONT) {
                const uint32_t surface = scene->triangle_surface[hit];
                first[surface] = counts[surface]++ == 0 ? hit : first[surface];
                *backs += 1;
            }
        }
    }
}

static alp_result tell(alp_diagnosis *d, const alpi_doctor_points *points, const void *kept)
{
    const alp_scene *scene = points->scene;
    uint32_t *counts = ALPI_NEW(d->context, uint32_t, scene->surface_count);
    uint32_t *first = ALPI_NEW(d->context, uint32_t, scene->surface_count);
    if (counts == NULL || first == NULL) {
        alpi_release(d->context, counts);
        alpi_release(d->context, first);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    uint32_t seen = 0, backs = 0, most = 0;
    alp_result result = ALP_OK;
    add_up(scene, kept, counts, first, &seen, &backs);
    for (uint32_t i = 0; i < scene->surface_count; i++) {
        most = counts[i] > counts[most] ? i : most;
    }
    const double share = seen > 0 ? (double)backs / seen : 0.0;
    if (share >= BACKS_SHARE && seen >= SEEN_SHARE * POINTS * RAYS) {
        const alpi_finding_facts facts = {ALP_FINDING_BACKS_SEEN, ALP_PLACE_SURFACE, most, 0,
                                          share};
        result = alpi_diagnosis_add(d, facts,
                                    "%.3g %% of the surface in view of other surfaces is the "
                                    "back of a single-sided one, most often of this one",
                                    100.0 * share);
        if (result == ALP_OK) {
            alpi_diagnosis_mark_triangle(d, first[most]);
        }
    }
    alpi_release(d->context, counts);
    alpi_release(d->context, first);
    return result;
}

alp_result alpi_doctor_look_at_backs(alp_diagnosis *diagnosis)
{
    const alpi_doctor_survey survey = {POINTS, POINTS_PER_RANGE, sizeof(view), look_from, tell};
    return alpi_doctor_take_survey(diagnosis, &survey);
}
