// SPDX-License-Identifier: MIT
// The doctor: looks at a scene from all sides, and lists what it finds.
#include "doctor/doctor.h"

#include "atlas/atlas.h"
#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT_LIMIT = 600, LEAST_PAGE = 1, MOST_PAGE = 16384 };

// --- the list ------------------------------------------------------------------------------------

static bool has_same_name(const alp_scene *scene, uint32_t a, uint32_t b)
{
    return b < scene->surface_count &&
           strcmp(scene->surfaces[a].name, scene->surfaces[b].name) == 0;
}

/// Its material's name where the surface beside has the same name, "" elsewhere.
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

/// What the place is called where the file gives it no name; as in messages.
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

static void release_finding(alp_context *context, alpi_finding *f)
{
    alpi_release(context, f->name);
    alpi_release(context, f->what);
    alpi_release(context, f->code);
    alpi_release(context, f->todo);
}

/// Takes the finding over, whatever becomes of it.
static alp_result append(alp_diagnosis *d, alpi_finding *f)
{
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    if (f->name != NULL && f->what != NULL) {
        result = alpi_grow(d->context, (void **)&d->findings, &d->capacity, d->count + 1,
                           sizeof *d->findings);
    }
    if (result != ALP_OK) {
        release_finding(d->context, f);
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
    return append(diagnosis, &f);
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

bool alpi_diagnosis_has(const alp_diagnosis *diagnosis, alp_finding_kind kind)
{
    for (size_t i = 0; i < diagnosis->count; i++) {
        if (diagnosis->findings[i].view.kind == kind) {
            return true;
        }
    }
    return false;
}

// --- what was told before ------------------------------------------------------------------------

/// Where the advice of a message begins: behind its last semicolon. NULL = it has none.
static const char *advice_of(const char *text)
{
    const char *advice = NULL;
    for (const char *at = strstr(text, "; "); at != NULL; at = strstr(at + 2, "; ")) {
        advice = at + 2;
    }
    return advice;
}

static alp_result add_message(alp_diagnosis *d, const alp_report_finding *message, bool light)
{
    const char *code = message->code != NULL ? message->code : "";
    const char *text = message->text != NULL ? message->text : "";
    const char *object = message->object != NULL ? message->object : "";
    const alpi_finding_words *words = alpi_finding_words_by_code(code);
    const char *advice = advice_of(text);
    const size_t length = advice != NULL ? (size_t)(advice - text) - 2 : strlen(text);
    alpi_finding f = {
        .view = {.kind = words->kind,
                 .code = words->code,
                 .severity = words->severity,
                 .place = strcmp(object, d->scene->name) == 0 ? ALP_PLACE_SCENE : ALP_PLACE_MESSAGE,
                 .value = (double)NAN,
                 .seen = words->seen,
                 .todo = words->todo},
        .name = alpi_copy_string(d->context, object),
        .what = alpi_copy_string(d->context, text),
        .code = alpi_copy_string(d->context, code)};
    if (f.what != NULL) {
        f.what[length] = '\0';
    }
    if (advice != NULL && words->todo[0] == '\0') {
        f.todo = alpi_copy_string(d->context, advice);
        f.view.todo = f.todo;
    }
    if (f.code == NULL || f.view.todo == NULL) {
        release_finding(d->context, &f);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    if (light && words->kind == ALP_FINDING_NO_LIGHT) {
        f.view.severity = ALP_SEVERITY_WARNING;
    }
    if (strcmp(words->code, code) != 0) { // it has no words: its own name
        f.view.code = f.code;
    }
    return append(d, &f);
}

// --- order ---------------------------------------------------------------------------------------

/// Errors first, then by kind; messages of no kind last, by code.
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

/// Bottom-up merge sort: stable, and there may be one finding for each of many surfaces.
static alp_result sort_findings(alp_diagnosis *d)
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

// --- all of it -----------------------------------------------------------------------------------

/// The spots to be drawn: of each kind the first, which is the worst; those of UV sets are shown
/// with their set.
static void choose_spots(alp_diagnosis *d)
{
    for (uint32_t i = 0; i < d->count && d->spot_count < ALPI_DOCTOR_SPOTS; i++) {
        const alp_finding *f = &d->findings[i].view;
        const bool again = i > 0 && d->findings[i - 1].view.kind == f->kind;
        if (f->spot.known && f->place != ALP_PLACE_UV_SET && !again) {
            snprintf(d->spot_names[d->spot_count], sizeof d->spot_names[0], "spot-%s", f->code);
            d->spots[d->spot_count++] = i;
        }
    }
}

static alp_result look(alp_diagnosis *d, const alp_diagnosis_options *options)
{
    for (uint32_t i = 0; i < options->message_count; i++) {
        ALP_TRY(add_message(d, &options->messages[i], options->light));
    }
    if (d->scene->usable_count > 0) {
        ALP_TRY(alpi_adjacency_create(d->scene, &d->neighbours));
    }
    ALP_TRY(alpi_doctor_look_at_mesh(d));
    ALP_TRY(alpi_doctor_look_at_uvs(d));
    ALP_TRY(alpi_doctor_look_at_materials(d));
    ALP_TRY(alpi_doctor_look_at_lights(d));
    ALP_TRY(alpi_doctor_look_at_backs(d));
    ALP_TRY(alpi_doctor_look_at_junctions(d));
    ALP_TRY(alpi_doctor_look_at_overlaps(d));
    ALP_TRY(alpi_doctor_look_at_sides(d));
    ALP_TRY(alpi_doctor_look_at_scale(d));
    ALP_TRY(sort_findings(d));
    choose_spots(d);
    return ALP_OK;
}

alp_diagnosis_options alp_diagnosis_options_default(void)
{
    return (alp_diagnosis_options){.struct_size = sizeof(alp_diagnosis_options),
                                   .page_size = ALPI_DOCTOR_PAGE};
}

alp_result alp_scene_diagnose(const alp_scene *scene, const alp_diagnosis_options *options,
                              alp_diagnosis **diagnosis)
{
    if (scene == NULL || diagnosis == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    *diagnosis = NULL;
    const alp_diagnosis_options o = options != NULL ? *options : alp_diagnosis_options_default();
    if (o.struct_size != sizeof o || (o.message_count > 0 && o.messages == NULL)) {
        return alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                         "diagnosis options are not from _default(), or messages are NULL");
    }
    if (o.page_size < LEAST_PAGE || o.page_size > MOST_PAGE) {
        return alpi_fail(scene->context, ALP_ERROR_INVALID_ARGUMENT,
                         "diagnosis options: page_size %u; give one from %d to %d", o.page_size,
                         (int)LEAST_PAGE, (int)MOST_PAGE);
    }
    alp_diagnosis *d = ALPI_NEW(scene->context, alp_diagnosis, 1);
    if (d == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    d->context = scene->context;
    d->scene = scene;
    d->page_size = o.page_size;
    const alpi_watch former = alpi_set_watch(
        scene->context, (alpi_watch){.callback = o.progress, .user = o.progress_user});
    const alp_result result = look(d, &o);
    alpi_release(d->context, d->neighbours);
    d->neighbours = NULL;
    alpi_set_watch(scene->context, former);
    if (result != ALP_OK) {
        alp_diagnosis_destroy(d);
        return result;
    }
    *diagnosis = d;
    return ALP_OK;
}

void alp_diagnosis_destroy(alp_diagnosis *diagnosis)
{
    if (diagnosis == NULL) {
        return;
    }
    for (size_t i = 0; i < diagnosis->count; i++) {
        release_finding(diagnosis->context, &diagnosis->findings[i]);
    }
    for (int i = 0; i < ALPI_UV_SET_LIMIT; i++) {
        alpi_release(diagnosis->context, diagnosis->reasons[i]);
    }
    alpi_release(diagnosis->context, diagnosis->findings);
    alpi_release(diagnosis->context, diagnosis);
}

// --- questions -----------------------------------------------------------------------------------

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
