// SPDX-License-Identifier: MIT
// Messages of earlier stages, such as the loader's warnings, as findings.
#include "doctor/doctor.h"
#include "doctor/doctor_words.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/// The advice of a message, which begins behind its last semicolon. NULL = it has none.
static const char *advice_of(const char *text)
{
    const char *advice = NULL;
    for (const char *at = strstr(text, "; "); at != NULL; at = strstr(at + 2, "; ")) {
        advice = at + 2;
    }
    return advice;
}

alp_result alpi_doctor_add_message(alp_diagnosis *d, const alp_report_finding *message, bool light)
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
        alpi_finding_release(d->context, &f);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    if (light && words->kind == ALP_FINDING_NO_LIGHT) {
        f.view.severity = ALP_SEVERITY_WARNING;
    }
    if (strcmp(words->code, code) != 0) { // a code without words keeps its own name
        f.view.code = f.code;
    }
    return alpi_diagnosis_append(d, &f);
}
