// SPDX-License-Identifier: MIT
// The --report page of a bake: collects its contents for the library.
#include "printing/report_page.h"

#include "output.h"
#include "web/report_link.h"

#include <stdlib.h>
#include <string.h>

int report_page_check(const command_line *a)
{
    const char *path = a->values[OPTION_REPORT].text;
    if (path == NULL) {
        return EXIT_DONE;
    }
    if (!path_ends(path, ".html") && !path_ends(path, ".htm")) {
        return usage_error(COMMAND_BAKE, "--report %s: the name must end in .html", path);
    }
    const char *json = a->values[OPTION_JSON].text;
    const bool is_json = json != NULL && output_is_same(path, json);
    if (is_json || output_is_same(path, a->operands[0])) {
        return usage_error(COMMAND_BAKE, "--report %s: %s has the same name; give another", path,
                           is_json ? "--json" : "SCENE");
    }
    return output_check(path, a->values[OPTION_FORCE].given);
}

/// Quotes one word for a shell. `text` has room for four times its length and two more.
static size_t quote(const char *word, char *text)
{
    static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789"
                                "_@%+=:,./-";
    const size_t length = strlen(word);
    const bool needs = length == 0 || strspn(word, plain) < length;
    size_t used = 0;
    if (needs) {
        text[used++] = '\'';
    }
    for (size_t i = 0; i < length; i++) {
        if (word[i] == '\'') { // out of the quotes, the sign itself, and in again
            text[used++] = '\'';
            text[used++] = '\\';
            text[used++] = '\'';
        }
        text[used++] = word[i];
    }
    if (needs) {
        text[used++] = '\'';
    }
    return used;
}

/// The command line as it was given; malloc'ed.
static char *make_command(const command_line *a)
{
    static const char start[] = "alpenglow bake";
    size_t size = sizeof start;
    for (int i = 0; i < a->word_count; i++) {
        size += 4 * strlen(a->words[i]) + 3;
    }
    char *text = allocate_or_exit(NULL, size);
    memcpy(text, start, sizeof start);
    size_t used = sizeof start - 1;
    for (int i = 0; i < a->word_count; i++) {
        text[used++] = ' ';
        used += quote(a->words[i], text + used);
    }
    text[used] = '\0';
    return text;
}

int report_page_write(session *s, const alp_lightmap *lightmap, const alp_bake_report *report,
                      const alp_diagnosis *diagnosis, const command_line *a)
{
    const size_t count = s->messages.warnings.count;
    alp_report_finding *findings = allocate_or_exit(NULL, count * sizeof *findings);
    for (size_t i = 0; i < count; i++) {
        const message *m = &s->messages.warnings.items[i];
        findings[i] = (alp_report_finding){m->code, m->object, m->text};
    }
    char *command = make_command(a);
    alp_report_options options = alp_report_options_default();
    options.command = command;
    options.findings = findings;
    options.finding_count = (uint32_t)count;
    options.diagnosis = diagnosis;
    options.overwrite = a->values[OPTION_FORCE].given;
    alp_bake_report whole = *report;
    whole.seconds_load = s->load_seconds;
    const char *path = a->values[OPTION_REPORT].text;
    char *linked = report_link_find(path, a->values[OPTION_OUTPUT].text);
    int code = session_end(s, alp_bake_write_report(s->scene, lightmap, &whole, &options, path));
    if (code == EXIT_DONE && linked != NULL) {
        code = report_link_write(path, linked);
    }
    free(linked);
    free(command);
    free(findings);
    return code;
}
