// SPDX-License-Identifier: MIT
// The doctor's findings, as text and as JSON.
#include "printing/findings.h"

#include "output.h"
#include "printing/alike.h"

#include <stdlib.h>
#include <string.h>

/// Number of findings of a kind that text lists; JSON lists all.
enum { FINDINGS_TOLD = 8 };

int findings_look(session *s, const alp_bake_report *baked, alp_diagnosis **diagnosis)
{
    *diagnosis = NULL;
    const size_t count = s->messages.warnings.count;
    alp_report_finding *heard = allocate_or_exit(NULL, count * sizeof *heard);
    for (size_t i = 0; i < count; i++) {
        const message *m = &s->messages.warnings.items[i];
        heard[i] = (alp_report_finding){m->code, m->object, m->text};
    }
    alp_diagnosis_options options = alp_diagnosis_options_default();
    options.messages = heard;
    options.message_count = (uint32_t)count;
    options.light = baked != NULL && (baked->maps & ALP_MAP_LIGHT) != 0;
    if (baked != NULL && baked->atlas.mode == ALP_ATLAS_KEEP) {
        options.page_size = baked->atlas.width; // the size that the set was baked at
    }
    options.progress = baked == NULL ? session_progress : NULL;
    options.progress_user = s;
    const alp_result result = alp_scene_diagnose(s->scene, &options, diagnosis);
    free(heard);
    return session_end(s, result);
}

// --- text ----------------------------------------------------------------------------------------

void findings_print_uv_sets(const alp_diagnosis *diagnosis)
{
    const uint32_t count = alp_diagnosis_uv_set_count(diagnosis);
    if (count == 0) {
        return;
    }
    printf("\n%6s  %8s  %7s  %8s  %8s  %7s  %s\n", "uv set", "surfaces", "islands", "coverage",
           "overlaps", "outside", "can hold a bake");
    for (uint32_t i = 0; i < count; i++) {
        const alp_uv_set_info u = alp_diagnosis_get_uv_set(diagnosis, i);
        printf("%6u  %8u  %7u  %6.1f %%  %6.1f %%  %7u  ", u.set, u.surfaces, u.islands,
               100.0 * u.coverage, 100.0 * u.overlap, u.outside_triangles);
        if (!u.holds_bake) {
            printf("no: %s\n", u.reason);
        } else {
            puts(u.set == 1 ? "yes" : "yes, but --atlas keep uses set 1 only");
        }
    }
}

/// "2 errors, 1 note", without severities that have no finding.
static void print_tally(const alp_diagnosis *diagnosis)
{
    uint32_t tally[3] = {0};
    const uint32_t count = alp_diagnosis_finding_count(diagnosis);
    for (uint32_t i = 0; i < count; i++) {
        tally[alp_diagnosis_get_finding(diagnosis, i).severity]++;
    }
    printf("\nfindings   ");
    const char *comma = "";
    for (int s = 0; s < 3; s++) {
        if (tally[s] > 0) {
            printf("%s%u %s%s", comma, tally[s], alp_severity_name((alp_severity)s),
                   plural(tally[s]));
            comma = ", ";
        }
    }
    puts(count == 0 ? "none" : "");
}

/// Messages of the readers that are alike have one line; findings of the doctor have one each.
static bool is_like(const alp_finding *a, const alp_finding *b)
{
    return a->place == ALP_PLACE_MESSAGE && b->place == ALP_PLACE_MESSAGE &&
           texts_are_alike(a->what, b->what);
}

/// Prints finding `first` with those before `end` that are like it.
static void print_finding(const alp_diagnosis *diagnosis, uint32_t first, uint32_t end)
{
    const alp_finding f = alp_diagnosis_get_finding(diagnosis, first);
    alike_list list = {0};
    alike_add(&list, f.place != ALP_PLACE_SCENE ? f.name : "");
    for (uint32_t i = first + 1; i < end; i++) {
        const alp_finding other = alp_diagnosis_get_finding(diagnosis, i);
        if (is_like(&f, &other)) {
            alike_add(&list, other.name);
        }
    }
    printf("%-9s  ", alp_severity_name(f.severity));
    alike_print(stdout, &list);
    print_clean(stdout, f.what);
    printf(" [");
    print_clean(stdout, f.code);
    printf("]\n");
}

/// Prints the findings of a kind. @return how many are left out
static uint32_t print_kind(const alp_diagnosis *diagnosis, uint32_t first, uint32_t end)
{
    uint32_t told[FINDINGS_TOLD], count = 0, left_out = 0;
    for (uint32_t i = first; i < end; i++) {
        const alp_finding f = alp_diagnosis_get_finding(diagnosis, i);
        bool printed = false;
        for (uint32_t k = 0; k < count && !printed; k++) {
            const alp_finding other = alp_diagnosis_get_finding(diagnosis, told[k]);
            printed = is_like(&other, &f);
        }
        if (!printed && count < FINDINGS_TOLD) {
            told[count++] = i;
            print_finding(diagnosis, i, end);
        } else {
            left_out += !printed;
        }
    }
    return left_out;
}

/// Prints effect and remedy of a kind once, after its last finding.
static void print_advice(const alp_finding *f, uint32_t left_out)
{
    if (left_out > 0) {
        printf("%-9s  and %u more of this kind; --json lists all\n", "", left_out);
    }
    if (f->seen[0] != '\0') {
        printf("%-9s  seen: ", "");
        print_clean(stdout, f->seen);
        putchar('\n');
    }
    if (f->todo[0] != '\0') {
        printf("%-9s  do: ", "");
        print_clean(stdout, f->todo);
        putchar('\n');
    }
}

/// Whether two findings have the same effect and remedy.
static bool are_alike(const alp_finding *a, const alp_finding *b)
{
    return strcmp(a->code, b->code) == 0 && strcmp(a->seen, b->seen) == 0 &&
           strcmp(a->todo, b->todo) == 0;
}

void findings_print(const alp_diagnosis *diagnosis)
{
    const uint32_t count = alp_diagnosis_finding_count(diagnosis);
    print_tally(diagnosis);
    for (uint32_t first = 0, end; first < count; first = end) {
        const alp_finding f = alp_diagnosis_get_finding(diagnosis, first);
        for (end = first + 1; end < count; end++) {
            const alp_finding next = alp_diagnosis_get_finding(diagnosis, end);
            if (!are_alike(&f, &next)) {
                break;
            }
        }
        print_advice(&f, print_kind(diagnosis, first, end));
    }
}

// --- JSON ----------------------------------------------------------------------------------------

/// The worst place of a finding; null without one.
static json_t *make_spot(const alp_finding_spot *spot)
{
    return !spot->known
               ? json_null()
               : json_pack("{s:I, s:I, s:[o, o, o], s:[o, o]}", "surface",
                           (json_int_t)spot->surface, "triangle", (json_int_t)spot->triangle, "at",
                           json_number((double)spot->at[0]), json_number((double)spot->at[1]),
                           json_number((double)spot->at[2]), "uv", json_number((double)spot->uv[0]),
                           json_number((double)spot->uv[1]));
}

json_t *findings_json(const alp_diagnosis *diagnosis)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < alp_diagnosis_finding_count(diagnosis); i++) {
        const alp_finding f = alp_diagnosis_get_finding(diagnosis, i);
        json_array_append_new(
            list,
            json_pack("{s:o, s:s, s:s, s:I, s:o, s:I, s:o, s:o, s:o, s:o, s:o}", "code",
                      json_text(f.code), "severity", alp_severity_name(f.severity), "place",
                      alp_finding_place_name(f.place), "index", (json_int_t)f.index, "name",
                      json_text(f.name), "count", (json_int_t)f.count, "value",
                      json_number(f.value), "what", json_text(f.what), "seen", json_text(f.seen),
                      "todo", json_text(f.todo), "spot", make_spot(&f.spot)));
    }
    return list;
}

json_t *findings_uv_sets_json(const alp_diagnosis *diagnosis)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < alp_diagnosis_uv_set_count(diagnosis); i++) {
        const alp_uv_set_info u = alp_diagnosis_get_uv_set(diagnosis, i);
        json_array_append_new(
            list,
            json_pack("{s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:o, s:o, s:o, s:o, "
                      "s:o, s:b, s:o}",
                      "set", (json_int_t)u.set, "surfaces", (json_int_t)u.surfaces,
                      "missing_surfaces", (json_int_t)u.missing_surfaces, "triangles",
                      (json_int_t)u.triangles, "outside_triangles", (json_int_t)u.outside_triangles,
                      "flat_triangles", (json_int_t)u.flat_triangles, "overlapping_triangles",
                      (json_int_t)u.overlapping_triangles, "islands", (json_int_t)u.islands,
                      "touching_islands", (json_int_t)u.touching_islands, "tiny_islands",
                      (json_int_t)u.tiny_islands, "free_texels", (json_int_t)u.free_texels,
                      "stretch", json_number(u.stretch), "coverage", json_number(u.coverage),
                      "overlap", json_number(u.overlap), "shared", json_number(u.shared),
                      "density_ratio", json_number(u.density_ratio), "holds_bake",
                      (int)u.holds_bake, "reason", json_text(u.reason)));
    }
    return list;
}
