// SPDX-License-Identifier: MIT
// Places of probes: a lattice by bounds and spacing.
#include "fields/probes/probes.h"
#include "scene/origin.h"

#include <math.h>

enum { PROBE_LIMIT = (1 << 24) - 1, PROBES_WANTED = 4096 };

void alpi_probe_place(const alpi_probe_volume *v, uint32_t index, double place[3])
{
    const uint32_t at[3] = {index % v->size[0], index / v->size[0] % v->size[1],
                            index / v->size[0] / v->size[1]};
    for (int k = 0; k < 3; k++) {
        place[k] =
            v->is_list ? (double)v->places[index][k] : v->origin[k] + (double)v->spacing[k] * at[k];
    }
}

/// The bounds that were asked for, or those of the scene.
static alp_result find_bounds(const alp_scene *scene, const alp_probe_options *o, vec3 *low,
                              vec3 *high)
{
    *low = vec3_load(o->bounds_min);
    *high = vec3_load(o->bounds_max);
    const vec3 size = vec3_sub(*high, *low);
    if (vec3_length(*low) == 0.0f && vec3_length(*high) == 0.0f) {
        *low = scene->bounds_min;
        *high = scene->bounds_max;
        return ALP_OK;
    }
    if (!vec3_is_finite(size) || size.x < 0.0f || size.y < 0.0f || size.z < 0.0f) {
        return alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                         "probes: bounds %g %g %g to %g %g %g: need finite numbers, the smaller "
                         "corner first",
                         (double)low->x, (double)low->y, (double)low->z, (double)high->x,
                         (double)high->y, (double)high->z);
    }
    return ALP_OK;
}

/// Edge of cells of which PROBES_WANTED fill the bounds, in two digits.
static double automatic_spacing(const double extent[3])
{
    const double longest = fmax(extent[0], fmax(extent[1], extent[2]));
    const double least = longest > 0.0 ? longest / PROBES_WANTED : 1.0;
    double volume = 1.0;
    for (int k = 0; k < 3; k++) {
        volume *= fmax(extent[k], least);
    }
    const double spacing = cbrt(volume / PROBES_WANTED);
    const double digit = pow(10.0, floor(log10(spacing)) - 1.0);
    return ceil(spacing / digit) * digit;
}

alp_result alpi_probe_lattice(const alp_scene *scene, const alp_probe_options *o,
                              alpi_probe_volume *v)
{
    vec3 low, high;
    ALP_TRY(find_bounds(scene, o, &low, &high));
    const double from[3] = {(double)low.x, (double)low.y, (double)low.z};
    const double to[3] = {(double)high.x, (double)high.y, (double)high.z};
    const double extent[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    const double spacing = o->spacing > 0.0f ? (double)o->spacing : automatic_spacing(extent);
    double count = 1.0, sides[3];
    for (int k = 0; k < 3; k++) {
        sides[k] = fmax(ceil(extent[k] / spacing - 1e-4), 1.0);
        count *= sides[k];
    }
    if (count > PROBE_LIMIT) {
        const double bytes = count * (9 * 3 * 4 + (o->visibility ? 64 * 8 : 0));
        return alpi_fail(scene->context, ALP_ERROR_LIMIT,
                         "probes: %.0f x %.0f x %.0f = %.3g probes would take %.3g GB; at most %d "
                         "fit: give a larger spacing than %g m, or smaller bounds",
                         sides[0], sides[1], sides[2], count, bytes * 1e-9, PROBE_LIMIT, spacing);
    }
    v->count = 1;
    for (int k = 0; k < 3; k++) {
        const double middle = 0.5 * (from[k] + to[k]);
        v->size[k] = (uint32_t)sides[k];
        v->count *= v->size[k];
        v->spacing[k] = (float)spacing;
        v->origin[k] = scene->origin[k] + middle - 0.5 * (sides[k] - 1.0) * (double)v->spacing[k];
    }
    return ALP_OK;
}
