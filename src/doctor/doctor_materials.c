// SPDX-License-Identifier: MIT
// The doctor's look at materials.
#include "doctor/doctor.h"

#include "base/memory.h"
#include "scene/area_points.h"

#include <math.h>

enum { POINTS = 1024 }; // spread over the area, as in the check for metal
/// The albedo that light is computed with ends at .95 (alpi_surface_albedo); here with rounding.
static const float WHITE = 0.9499f;
/// A material counts as white from this share of the scene's area on: less changes no light.
static const double WHITE_SHARE = 0.02;

static const double NO_VALUE = (double)NAN;

// --- materials -----------------------------------------------------------------------------------

static float largest(vec3 v)
{
    return fmaxf(fmaxf(v.x, v.y), v.z);
}

/// Whether its texture could not be read: white in its place is a guess of the reader's, which the
/// finding `image` tells of.
static bool lost_its_texture(const alp_scene *scene, uint32_t material)
{
    const alpi_texture *texture = &scene->materials[material].base_color_texture;
    return texture->lost ||
           (texture->image != ALPI_NONE &&
            (texture->image >= scene->image_count || scene->images[texture->image] == NULL));
}

/// Materials whose albedo is clamped, by the share of the area they cover so.
static alp_result look_for_white(alp_diagnosis *d)
{
    const alp_scene *scene = d->scene;
    alpi_area_point points[POINTS];
    if (!alpi_area_points(scene, POINTS, points)) {
        return ALP_OK;
    }
    uint32_t *counts = ALPI_NEW(d->context, uint32_t, scene->material_count);
    if (counts == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < POINTS; i++) {
        const alpi_area_point *p = &points[i];
        const uint32_t m = scene->surfaces[scene->triangle_surface[p->triangle]].material;
        if (m != ALPI_NONE) {
            counts[m] += largest(alpi_surface_albedo(scene, p->triangle, p->b1, p->b2)) >= WHITE;
        }
    }
    alp_result result = ALP_OK;
    for (uint32_t m = 0; m < scene->material_count && result == ALP_OK; m++) {
        const double share = (double)counts[m] / POINTS;
        const alpi_finding_facts facts = {ALP_FINDING_WHITE, ALP_PLACE_MATERIAL, m, 0, share};
        if (share >= WHITE_SHARE && !lost_its_texture(scene, m)) {
            result = alpi_diagnosis_add(d, facts,
                                        "a diffuse colour of 0.95 or more, on %.3g %% of the "
                                        "scene's area",
                                        100.0 * share);
        }
    }
    alpi_release(d->context, counts);
    return result;
}

static const alp_image *image_of(const alp_scene *scene, const alpi_texture *texture)
{
    return texture->image == ALPI_NONE || texture->image >= scene->image_count
               ? NULL
               : scene->images[texture->image];
}

static bool image_is_black(const alp_image *image)
{
    float rgba[4];
    for (uint32_t y = 0; y < image->info.height; y++) {
        for (uint32_t x = 0; x < image->info.width; x++) {
            alpi_image_pixel(image, x, y, rgba);
            if (rgba[0] > 0.0f || rgba[1] > 0.0f || rgba[2] > 0.0f) {
                return false;
            }
        }
    }
    return true;
}

static alp_result look_at_emission(alp_diagnosis *d, uint32_t index)
{
    const alpi_material *m = &d->scene->materials[index];
    const bool has_factor = m->emission[0] > 0.0f || m->emission[1] > 0.0f || m->emission[2] > 0.0f;
    const alp_image *image = image_of(d->scene, &m->emission_texture);
    alpi_finding_facts facts = {.place = ALP_PLACE_MATERIAL, .index = index, .value = NO_VALUE};
    if (m->emission_texture.image != ALPI_NONE && !has_factor) {
        facts.kind = ALP_FINDING_EMISSION_OFF;
        return alpi_diagnosis_add(d, facts, "an emissive texture, and an emissive factor of 0");
    }
    if (has_factor && image != NULL && image_is_black(image)) {
        facts.kind = ALP_FINDING_EMISSION_BLACK;
        return alpi_diagnosis_add(d, facts, "an emissive factor, and a texture that is all black");
    }
    return ALP_OK;
}

static alp_result look_for_invisible(alp_diagnosis *d, uint32_t index)
{
    const alpi_material *m = &d->scene->materials[index];
    const bool blended = m->alpha_mode == ALPI_ALPHA_BLEND && !(m->base_color[3] > 0.0f);
    const bool masked = m->alpha_mode == ALPI_ALPHA_MASK && m->base_color[3] < m->alpha_cutoff;
    const alpi_finding_facts facts = {ALP_FINDING_INVISIBLE, ALP_PLACE_MATERIAL, index, 0,
                                      (double)m->base_color[3]};
    return blended || masked
               ? alpi_diagnosis_add(d, facts, "%s with an alpha of %.3g: it is cut away everywhere",
                                    blended ? "blended" : "masked", (double)m->base_color[3])
               : ALP_OK;
}

/// Whether a bake has warned of all unlit materials.
static bool is_unlit_known(const alp_diagnosis *d)
{
    for (size_t i = 0; i < d->count; i++) {
        const alp_finding *f = &d->findings[i].view;
        if (f->kind == ALP_FINDING_UNLIT && f->place != ALP_PLACE_MATERIAL) {
            return true;
        }
    }
    return false;
}

static alp_result look_for_unlit(alp_diagnosis *d, uint32_t index)
{
    const alpi_finding_facts facts = {ALP_FINDING_UNLIT, ALP_PLACE_MATERIAL, index, 0, NO_VALUE};
    return d->scene->materials[index].unlit && !is_unlit_known(d)
               ? alpi_diagnosis_add(d, facts, "unlit (KHR_materials_unlit)")
               : ALP_OK;
}

alp_result alpi_doctor_look_at_materials(alp_diagnosis *diagnosis)
{
    const alp_scene *scene = diagnosis->scene;
    bool *used = ALPI_NEW(diagnosis->context, bool, scene->material_count);
    if (used == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        const alpi_surface *surface = &scene->surfaces[s];
        if (surface->material != ALPI_NONE && surface->triangle_count > 0) {
            used[surface->material] = true;
        }
    }
    alp_result result = look_for_white(diagnosis);
    for (uint32_t m = 0; m < scene->material_count && result == ALP_OK; m++) {
        result = used[m] ? look_at_emission(diagnosis, m) : ALP_OK;
        if (result == ALP_OK && used[m]) {
            result = look_for_invisible(diagnosis, m);
        }
        if (result == ALP_OK && used[m]) {
            result = look_for_unlit(diagnosis, m);
        }
    }
    alpi_release(diagnosis->context, used);
    return result;
}
