// SPDX-License-Identifier: MIT
// Texel densities of surfaces and materials relative to the atlas's. Charts grow by their factor
// before anything is packed; no stage after that need know.
#include "atlas/factors.h"

#include "scene/select.h"

#include "base/decimal.h"
#include "base/glob.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

static const char MATERIAL[] = "material:";
enum { MATERIAL_SIZE = sizeof MATERIAL - 1, NAMED_SIZE = 200 };

// What a factor may be, and what all of a surface multiply to: coordinates of what is least dense
// keep their digits beside what is densest.
static const double LEAST_FACTOR = 1e-3, LARGEST_FACTOR = 1e3;

/// PATTERN=FACTOR, [text, text + size).
typedef struct entry {
    const char *text;
    size_t size, pattern_size;
    double factor;
} entry;

static int shown(const entry *e)
{
    return e->size < NAMED_SIZE ? (int)e->size : NAMED_SIZE;
}

static alp_result read_entry(alp_context *context, entry *e)
{
    const char *end = e->text + e->size, *sign = end;
    while (sign > e->text && *sign != '=') {
        sign--;
    }
    if (sign == e->text || *sign != '=' || alpi_decimal_double(sign + 1, end, &e->factor) != end) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "density \"%.*s\": give PATTERN=FACTOR, such as floor*=2", shown(e),
                         e->text);
    }
    if (!(e->factor >= LEAST_FACTOR && e->factor <= LARGEST_FACTOR)) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT,
                         "density \"%.*s\": the factor must be in [%g, %g]", shown(e), e->text,
                         LEAST_FACTOR, LARGEST_FACTOR);
    }
    e->pattern_size = (size_t)(sign - e->text);
    return ALP_OK;
}

static alp_result apply_to_surfaces(const alp_scene *scene, const entry *e, float *factors)
{
    char *pattern = alpi_format(scene->context, "%.*s", (int)e->pattern_size, e->text);
    bool *matched = NULL;
    alp_result result =
        pattern == NULL ? ALP_ERROR_OUT_OF_MEMORY : alpi_scene_select(scene, pattern, &matched);
    for (uint32_t s = 0; matched != NULL && s < scene->surface_count; s++) {
        factors[s] *= matched[s] ? (float)e->factor : 1.0f;
    }
    alpi_release(scene->context, matched);
    alpi_release(scene->context, pattern);
    return result;
}

static alp_result apply_to_materials(const alp_scene *scene, const entry *e, float *factors)
{
    const char *pattern = e->text + MATERIAL_SIZE;
    const size_t size = e->pattern_size - MATERIAL_SIZE;
    bool found = false;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const uint32_t m = scene->surfaces[s].material;
        if (m != ALPI_NONE && alpi_glob_match(pattern, size, scene->materials[m].name)) {
            factors[s] *= (float)e->factor;
            found = true;
        }
    }
    return found ? ALP_OK
                 : alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                             "%s: density \"%.*s\": no surface has a material with a name like "
                             "this; info lists them",
                             scene->name, shown(e), e->text);
}

/// Entries that match one surface are multiplied.
static alp_result check_products(const alp_scene *scene, const char *densities,
                                 const float *factors)
{
    const double rounding = 1e-5; // of 32-bit products of up to a hundred factors
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const double factor = (double)factors[s];
        if (!(factor >= LEAST_FACTOR * (1.0 - rounding) &&
              factor <= LARGEST_FACTOR * (1.0 + rounding))) {
            return alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                             "%s: density \"%.*s\": the factors of \"%s\" multiply to %g, which "
                             "must be in [%g, %g]",
                             scene->name, NAMED_SIZE, densities, scene->surfaces[s].name, factor,
                             LEAST_FACTOR, LARGEST_FACTOR);
        }
    }
    return ALP_OK;
}

static alp_result read_densities(const alp_scene *scene, const char *densities, float *factors)
{
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        factors[s] = 1.0f;
    }
    for (const char *at = densities;; at++) {
        entry e = {.text = at, .size = alpi_glob_length(at)};
        ALP_TRY(read_entry(scene->context, &e));
        const bool material =
            e.pattern_size > MATERIAL_SIZE && strncmp(at, MATERIAL, MATERIAL_SIZE) == 0;
        ALP_TRY(material ? apply_to_materials(scene, &e, factors)
                         : apply_to_surfaces(scene, &e, factors));
        at += e.size;
        if (*at == '\0') {
            return check_products(scene, densities, factors);
        }
    }
}

alp_result alpi_factors_create(const alp_scene *scene, const char *densities, float **factors)
{
    *factors = NULL;
    if (densities == NULL) {
        return ALP_OK;
    }
    float *made = ALPI_NEW(scene->context, float, scene->surface_count);
    alp_result result =
        made == NULL ? ALP_ERROR_OUT_OF_MEMORY : read_densities(scene, densities, made);
    if (result != ALP_OK) {
        alpi_release(scene->context, made);
        return result;
    }
    *factors = made;
    return ALP_OK;
}

void alpi_factors_part(const alp_scene *scene, const float *factors, uint32_t (*neighbours)[3])
{
    for (uint32_t t = 0; factors != NULL && t < scene->triangle_count; t++) {
        const float own = factors[scene->triangle_surface[t]];
        for (int k = 0; k < 3; k++) {
            const uint32_t across = neighbours[t][k];
            if (across != ALPI_NONE && factors[scene->triangle_surface[across]] != own) {
                neighbours[t][k] = ALPI_NONE;
            }
        }
    }
}

double alpi_factor_of(const alp_atlas *atlas, uint32_t triangle)
{
    return atlas->factors == NULL
               ? 1.0
               : (double)atlas->factors[atlas->scene->triangle_surface[triangle]];
}

void alpi_factors_apply(alp_atlas *atlas, alpi_charts *charts)
{
    for (uint32_t c = 0; atlas->factors != NULL && c < charts->count; c++) {
        alpi_chart *chart = &charts->charts[c];
        const double factor = alpi_factor_of(atlas, charts->triangles[chart->first]);
        chart->width *= factor;
        chart->height *= factor;
        for (uint32_t i = chart->first; i < chart->first + chart->count; i++) {
            float(*uv)[2] = atlas->corner_uvs[charts->triangles[i]];
            for (int k = 0; k < 3; k++) {
                uv[k][0] = (float)(factor * (double)uv[k][0]);
                uv[k][1] = (float)(factor * (double)uv[k][1]);
            }
        }
    }
}
