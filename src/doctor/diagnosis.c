// SPDX-License-Identifier: MIT
// The list of findings: how one is added, marked and sorted, and what callers read of it.
#include "doctor/diagnosis.h"

#include "base/memory.h"
#include "doctor/doctor_words.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { TEXT_LIMIT = 600 };

// --- the list ------------------------------------------------------------------------------------

static bool has_same_name(const alp_scene *scene, uint32_t a, uint32_t b)
{
    return b < scene->surface_count &&
           strcmp(scene->surfaces[a].name, scene->surfaces[b].name) == 0;
}

/// The name of a surface's material where the surface beside it has the same name, else "".
static const char *find_distinction(const alp_scene *scene, uint32_t surface)
{
    const uint32_t material = scene->surfaces[surface].material;
    const bool same = has_same_name(scene, surface, surface + 1) ||
                      (surface > 0 && has_same_name(scene, surface, surface - 1));
    return same && material != ALPI_NONE ? scene->materials[material].name : "";
}

alpi_surface_label alpi_doctor_label(const alp_scene *scene, uint32_t surface)
{
    const char *name = scene->surfaces[surface].name, *other = find_distinction(scene, surface);
    alpi_surface_label label;
    if (other[0] != '\0') {
        snprintf(label.text, sizeof label.text, "%.60s (%.60s)", name, other);
    } else {
        snprintf(label.text, sizeof label.text, "%.60s", name);
    }
    return label;
}

static const char *name_of(const alp_scene *scene, const alpi_finding_facts *facts)
{
    switch (facts->place) {
    case ALP_PLACE_SURFACE:
        return scene->surfaces[facts->index].name;
    case ALP_PLACE_MATERIAL:
        return scene->materials[facts->index].name;
    case ALP_PLACE_LIGHT:
        return scene->lights[facts->index].name;
    default:
        return scene->name;
    }
}

/// The name of a place; its kind and number where the file gives it no name.
static char *make_name(const alp_diagnosis *d, const alpi_finding_facts *facts)
{
    const char *name = name_of(d->scene, facts);
    if (facts->place == ALP_PLACE_UV_SET) {
        return alpi_format(d->context, "UV set %u", facts->index);
    }
    const char *other =
        facts->place == ALP_PLACE_SURFACE ? find_distinction(d->scene, facts->index) : "";
    if (other[0] != '\0') {
        return alpi_format(d->context, "%s (%s)", name, other);
    }
    return name != NULL && name[0] != '\0'
               ? alpi_copy_string(d->context, name)
               : alpi_format(d->context, "%s %u", alp_finding_place_name(facts->place),
                             facts->index);
}

void alpi_finding_release(alp_context *context, alpi_finding *f)
{
    alpi_release(context, f->name);
    alpi_release(context, f->what);
    alpi_release(context, f->code);
    alpi_release(context, f->todo);
}

alp_result alpi_diagnosis_append(alp_diagnosis *d, alpi_finding *f)
{
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    if (f->name != NULL && f->what != NULL) {
        result = alpi_grow(d->context, (void **)&d->findings, &d->capacity, d->count + 1,
                           sizeof *d->findings);
    }
    if (result != ALP_OK) {
        alpi_finding_release(d->context, f);
        return result;
    }
    f->view.name = f->name;
    f->view.what = f->what;
    d->findings[d->count++] = *f;
    return ALP_OK;
}

alp_result alpi_diagnosis_add(alp_diagnosis *diagnosis, alpi_finding_facts facts,
                              const char *format, ...)
{
    char text[TEXT_LIMIT];
    va_list values;
    va_start(values, format);
    vsnprintf(text, sizeof text, format, values);
    va_end(values);
    const alpi_finding_words *words = alpi_finding_words_of(facts.kind);
    alpi_finding f = {.view = {.kind = facts.kind,
                               .code = words->code,
                               .severity = words->severity,
                               .place = facts.place,
                               .index = facts.index,
                               .count = facts.count,
                               .value = facts.value,
                               .seen = words->seen,
                               .todo = words->todo},
                      .name = make_name(diagnosis, &facts),
                      .what = alpi_copy_string(diagnosis->context, text)};
    return alpi_diagnosis_append(diagnosis, &f);
}

void alpi_diagnosis_mark(alp_diagnosis *diagnosis, uint32_t triangle, vec3 at, const float uv[2])
{
    const alp_scene *scene = diagnosis->scene;
    alp_finding_spot *spot = &diagnosis->findings[diagnosis->count - 1].view.spot;
    const uint32_t surface = scene->triangle_surface[triangle];
    *spot = (alp_finding_spot){.known = true,
                               .surface = surface,
                               .triangle = triangle - scene->surfaces[surface].first_triangle,
                               .uv = {uv != NULL ? uv[0] : NAN, uv != NULL ? uv[1] : NAN}};
    vec3_store(spot->at, at);
}

void alpi_diagnosis_mark_triangle(alp_diagnosis *diagnosis, uint32_t triangle)
{
    vec3 c[3];
    alpi_triangle_corners(diagnosis->scene, triangle, c);
    const vec3 sum = vec3_add(vec3_add(c[0], c[1]), c[2]);
    alpi_diagnosis_mark(diagnosis, triangle, vec3_scale(sum, 1.0f / 3.0f), NULL);
}

uint32_t alpi_doctor_choose_worst(const alp_scene *scene, const double *measure,
                                  uint32_t worst[ALPI_DOCTOR_SURFACES], uint32_t *all)
{
    uint32_t count = 0;
    *all = 0;
    for (uint32_t s = 0; s < scene->surface_count; s++) {
        if (!(measure[s] > 0.0)) {
            continue;
        }
        *all += 1;
        uint32_t at = count < ALPI_DOCTOR_SURFACES ? count : ALPI_DOCTOR_SURFACES - 1;
        if (count == ALPI_DOCTOR_SURFACES && !(measure[s] > measure[worst[at]])) {
            continue;
        }
        for (; at > 0 && measure[s] > measure[worst[at - 1]]; at--) {
            worst[at] = worst[at - 1];
        }
        worst[at] = s;
        count += count < ALPI_DOCTOR_SURFACES;
    }
    return count;
}

// --- order ---------------------------------------------------------------------------------------

/// Orders errors first, then by kind. Messages without a kind come last, by code.
static int compare_findings(const alp_finding *a, const alp_finding *b)
{
    if (a->severity != b->severity) {
        return a->severity < b->severity ? -1 : 1;
    }
    const bool a_last = a->kind == ALP_FINDING_MESSAGE, b_last = b->kind == ALP_FINDING_MESSAGE;
    if (a_last != b_last) {
        return a_last ? 1 : -1;
    }
    return a->kind != b->kind ? (a->kind < b->kind ? -1 : 1) : strcmp(a->code, b->code);
}

/// Bottom-up merge sort: it is stable, and fast for a finding on each of many surfaces.
alp_result alpi_diagnosis_sort(alp_diagnosis *d)
{
    alpi_finding *spare = ALPI_NEW(d->context, alpi_finding, d->count);
    if (spare == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alpi_finding *from = d->findings, *to = spare;
    for (size_t width = 1; width < d->count; width *= 2) {
        for (size_t begin = 0; begin < d->count; begin += 2 * width) {
            const size_t middle = begin + width < d->count ? begin + width : d->count;
            const size_t end = middle + width < d->count ? middle + width : d->count;
            size_t left = begin, right = middle;
            for (size_t i = begin; i < end; i++) {
                const bool take_left =
                    left < middle &&
                    (right >= end || compare_findings(&from[left].view, &from[right].view) <= 0);
                to[i] = take_left ? from[left++] : from[right++];
            }
        }
        alpi_finding *swap = from;
        from = to;
        to = swap;
    }
    if (from != d->findings && d->count > 0) {
        memcpy(d->findings, from, d->count * sizeof *from);
    }
    alpi_release(d->context, spare);
    return ALP_OK;
}

void alp_diagnosis_destroy(alp_diagnosis *diagnosis)
{
    if (diagnosis == NULL) {
        return;
    }
    for (size_t i = 0; i < diagnosis->count; i++) {
        alpi_finding_release(diagnosis->context, &diagnosis->findings[i]);
    }
    for (int i = 0; i < ALPI_UV_SET_LIMIT; i++) {
        alpi_release(diagnosis->context, diagnosis->reasons[i]);
    }
    alpi_release(diagnosis->context, diagnosis->findings);
    alpi_release(diagnosis->context, diagnosis);
}

// --- reading -------------------------------------------------------------------------------------

uint32_t alp_diagnosis_finding_count(const alp_diagnosis *diagnosis)
{
    return diagnosis != NULL ? (uint32_t)diagnosis->count : 0;
}

alp_finding alp_diagnosis_get_finding(const alp_diagnosis *diagnosis, uint32_t index)
{
    if (diagnosis == NULL || index >= diagnosis->count) {
        return (alp_finding){
            .code = "", .name = "", .what = "", .seen = "", .todo = "", .value = (double)NAN};
    }
    return diagnosis->findings[index].view;
}

uint32_t alp_diagnosis_uv_set_count(const alp_diagnosis *diagnosis)
{
    return diagnosis != NULL ? diagnosis->uv_set_count : 0;
}

alp_uv_set_info alp_diagnosis_get_uv_set(const alp_diagnosis *diagnosis, uint32_t index)
{
    return diagnosis != NULL && index < diagnosis->uv_set_count ? diagnosis->uv_sets[index]
                                                                : (alp_uv_set_info){.reason = ""};
}

const char *alp_severity_name(alp_severity severity)
{
    static const char *const names[] = {"error", "warning", "note"};
    return (unsigned)severity < 3 ? names[severity] : "";
}

const char *alp_finding_place_name(alp_finding_place place)
{
    static const char *const names[] = {"scene", "surface", "material",
                                        "light", "uv-set",  "message"};
    return (unsigned)place < 6 ? names[place] : "";
}
