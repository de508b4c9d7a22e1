// SPDX-License-Identifier: MIT
// The doctor's look at sizes: objects of another order of size than all others of the scene, which
// came with another unit, or are skies and helpers.
#include "doctor/doctor.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

/// Of the median: a house has doors and door handles, which are a hundredth of it; what is a
/// thousandth differs by a unit.
static const double OUTLIER = 1000.0;
/// From one size to the next: sizes that come in all steps are those of one scene.
static const double STEP = 10.0;
enum { LEAST_SURFACES = 4 }; // of fewer no one is the odd one

typedef struct sized {
    double size; // longest side, metres
    uint32_t surface;
} sized;

static double longest_side(const alp_scene *scene, const alpi_surface *surface)
{
    vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < surface->triangle_count; i++) {
        vec3 c[3];
        const uint32_t t = surface->first_triangle + i;
        alpi_triangle_corners(scene, t, c);
        for (int k = 0; k < 3 && scene->triangle_usable[t]; k++) {
            low = vec3_min(low, c[k]);
            high = vec3_max(high, c[k]);
        }
    }
    const vec3 side = vec3_sub(high, low);
    return (double)fmaxf(fmaxf(side.x, side.y), side.z); // −∞: nothing is usable
}

static int compare_sizes(const void *a, const void *b)
{
    const sized *x = a, *y = b;
    if (x->size != y->size) {
        return x->size < y->size ? -1 : 1;
    }
    return x->surface < y->surface ? -1 : x->surface > y->surface;
}

static alp_result tell_one(alp_diagnosis *d, const sized *one, double median, bool large)
{
    const alpi_surface *surface = &d->scene->surfaces[one->surface];
    const double ratio = one->size / median;
    const alpi_finding_facts facts = {ALP_FINDING_SCALE, ALP_PLACE_SURFACE, one->surface, 0, ratio};
    ALP_TRY(alpi_diagnosis_add(
        d, facts, "%.3g m long, %.3g times as %s as the median of all objects, %.3g m", one->size,
        large ? ratio : 1.0 / ratio, large ? "large" : "small", median));
    for (uint32_t i = 0; i < surface->triangle_count; i++) {
        if (d->scene->triangle_usable[surface->first_triangle + i]) {
            alpi_diagnosis_mark_triangle(d, surface->first_triangle + i);
            break;
        }
    }
    return ALP_OK;
}

/// Where the large ones begin, and the small ones end: behind a step that leaves most on the side
/// of the median.
static alp_result tell_outliers(alp_diagnosis *d, const sized *sizes, uint32_t count)
{
    const double median = sizes[count / 2].size;
    uint32_t small = 0, large = count;
    for (uint32_t i = 0; i + 1 < count; i++) {
        const bool step = sizes[i + 1].size >= STEP * sizes[i].size;
        if (step && sizes[i].size * OUTLIER <= median) {
            small = i + 1;
        }
        if (step && sizes[i + 1].size >= OUTLIER * median && large == count) {
            large = i + 1;
        }
    }
    for (uint32_t k = 0; k < count - large && k < ALPI_DOCTOR_SURFACES; k++) {
        ALP_TRY(tell_one(d, &sizes[count - 1 - k], median, true));
    }
    for (uint32_t k = 0; k < small && k < ALPI_DOCTOR_SURFACES; k++) {
        ALP_TRY(tell_one(d, &sizes[k], median, false));
    }
    return ALP_OK;
}

alp_result alpi_doctor_look_at_scale(alp_diagnosis *diagnosis)
{
    const alp_scene *scene = diagnosis->scene;
    sized *sizes = ALPI_NEW(diagnosis->context, sized, scene->surface_count);
    if (sizes == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    uint32_t count = 0;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const double side = longest_side(scene, &scene->surfaces[s]);
        if (side > 0.0) {
            sizes[count++] = (sized){side, s};
        }
    }
    qsort(sizes, count, sizeof *sizes, compare_sizes);
    const alp_result result =
        count >= LEAST_SURFACES ? tell_outliers(diagnosis, sizes, count) : ALP_OK;
    alpi_release(diagnosis->context, sizes);
    return result;
}
