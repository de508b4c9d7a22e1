// SPDX-License-Identifier: MIT
// Manual pages, written from the table of options as roff for the man macros of groff and mandoc.
#include "help/manual_text.h"

#include <alpenglow/alpenglow.h>

#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { LINE_WIDTH = 76 };

// --- roff ----------------------------------------------------------------------------------------

/// Escapes text for roff: hyphens can be copied, and no line starts with a request.
static void put_escaped(const char *text, size_t length, bool line_begins)
{
    if (line_begins && length > 0 && text[0] == '.') {
        fputs("\\&", stdout);
    }
    for (size_t i = 0; i < length; i++) {
        switch (text[i]) {
        case '\\':
            fputs("\\e", stdout);
            break;
        case '-':
            fputs("\\-", stdout);
            break;
        case '\'':
            fputs("\\(aq", stdout);
            break;
        case '`':
            fputs("\\(ga", stdout);
            break;
        case '^':
            fputs("\\(ha", stdout);
            break;
        case '~':
            fputs("\\(ti", stdout);
            break;
        case '"':
            fputs("\\(dq", stdout);
            break;
        default:
            putchar(text[i]);
        }
    }
}

static void put_font(char font, const char *text, size_t length)
{
    printf("\\f%c", font);
    put_escaped(text, length, false);
    fputs("\\fR", stdout);
}

static bool is_name(char c)
{
    return isalnum((unsigned char)c) || c == '-';
}

/// Prints a usage such as "-o OUT.glb [--size N]": literal words bold, names of values slanted, the
/// rest upright.
static void put_usage(const char *text)
{
    while (*text != '\0') {
        size_t length = 0;
        while (is_name(text[length])) {
            length++;
        }
        if (length == 0) {
            put_escaped(text, 1, false);
            text += 1;
        } else {
            put_font(isupper((unsigned char)*text) ? 'I' : 'B', text, length);
            text += length;
        }
    }
}

/// Length of the option ("--size", "-o") in a word, from `*start` on; 0 without one.
static size_t option_within(const char *word, size_t length, size_t *start)
{
    *start = strspn(word, "(");
    size_t end = *start;
    while (end < length && (is_name(word[end]) || word[end] == '_')) {
        end++;
    }
    size_t letters = end - *start;
    const char *name = word + *start;
    bool is_short = letters == 2 && name[0] == '-' && islower((unsigned char)name[1]);
    bool is_long = letters > 3 && name[0] == '-' && name[1] == '-';
    return is_short || is_long ? letters : 0;
}

static void put_word(const char *word, size_t length, bool line_begins)
{
    size_t start = 0;
    size_t letters = option_within(word, length, &start);
    if (letters == 0) {
        put_escaped(word, length, line_begins);
        return;
    }
    put_escaped(word, start, line_begins);
    put_font('B', word + start, letters);
    put_escaped(word + start + letters, length - start - letters, false);
}

/// Prints prose with bold options. A sentence begins on its own line, as roff wants it. '\n' breaks
/// the line on the page.
static void put_prose(const char *text)
{
    size_t column = 0;
    bool sentence_ended = false;
    while (*text != '\0') {
        const bool line_ended = *text == '\n';
        text += line_ended;
        const size_t length = strcspn(text, " \n");
        const bool full = sentence_ended || column + 1 + length > LINE_WIDTH;
        const bool breaks = column > 0 && (line_ended || full);
        if (column > 0) {
            fputs(line_ended ? "\n.br\n" : breaks ? "\n" : " ", stdout);
        }
        put_word(text, length, column == 0 || breaks);
        column = breaks || column == 0 ? length : column + 1 + length;
        sentence_ended = length > 1 && text[length - 1] == '.';
        text += length;
        text += strspn(text, " ");
    }
    putchar('\n');
}

static void put_section(const char *title)
{
    printf(".SH %s\n", title);
}

static void put_entry_prose(const char *name, const char *text)
{
    fputs(".TP\n", stdout);
    put_usage(name);
    putchar('\n');
    put_prose(text);
}

// --- sections ------------------------------------------------------------------------------------

static void put_title(const char *command)
{
    fputs(".\\\" Made from the command's table of options; change that, not this page.\n", stdout);
    fputs(".TH ALPENGLOW", stdout);
    if (command != NULL) {
        fputs("\\-", stdout);
        for (const char *c = command; *c != '\0'; c++) {
            putchar(toupper((unsigned char)*c));
        }
    }
    // No date: the same source gives the same page on any day.
    printf(" 1 \"\" \"alpenglow %s\" \"User Commands\"\n", alp_version());
    fputs(".SH NAME\nalpenglow", stdout);
    printf("%s%s \\- ", command ? "\\-" : "", command ? command : "");
}

static void put_option(const option *o)
{
    char facts[OPTION_FACTS_SIZE];
    fputs(".TP\n", stdout);
    put_font('B', o->name, strlen(o->name));
    if (o->alias != NULL) {
        fputs(", ", stdout);
        put_font('B', o->alias, strlen(o->alias));
    }
    if (o->value != NULL) {
        putchar(' ');
        put_usage(o->value);
    }
    putchar('\n');
    put_prose(o->help);
    option_facts(o, facts, sizeof facts);
    if (facts[0] != '\0') {
        fputs(".br\n", stdout);
        put_prose(facts);
    }
}

static void put_group(command_id command, option_group group)
{
    const option *o = option_next(command, group, NULL);
    if (o != NULL) {
        printf(".SS %s\n", option_group_title(group));
    }
    for (; o != NULL; o = option_next(command, group, o)) {
        put_option(o);
    }
}

/// Prints options and choices that are not built yet.
static void put_later(command_id command)
{
    bool any = false;
    for (const option *o = option_after(command, NULL); o != NULL; o = option_after(command, o)) {
        bool later = o->group == GROUP_LATER;
        if (!later && o->later_choices == NULL) {
            continue;
        }
        if (!any) {
            printf(".SS %s\n", option_group_title(GROUP_LATER));
        }
        if (any) {
            fputs(".br\n", stdout);
        }
        any = true;
        put_font('B', o->name, strlen(o->name));
        const char *value = later ? o->value : o->later_choices;
        if (value != NULL) {
            putchar(' ');
            put_usage(value);
        }
        putchar('\n');
    }
}

static void put_scenes(void)
{
    size_t count = 0;
    const char *const *names = builtin_scene_names(&count);
    fputs(".PP\n", stdout);
    put_usage("SCENE");
    fputs("\nis a .gltf, .glb, .dae, .zae or .obj file, or a built-in scene:\n", stdout);
    for (size_t i = 0; i < count; i++) {
        put_font('B', names[i], strlen(names[i]));
        fputs(i + 1 < count ? ",\n" : ".\n", stdout);
    }
}

static void put_status(int status, const char *text)
{
    printf(".TP\n\\fB%d\\fR\n", status);
    put_prose(text);
}

static void put_exit_statuses(const manual_text *text, bool keeps_work, bool interruptible)
{
    put_section("EXIT STATUS");
    put_status(EXIT_DONE, "Done.");
    put_status(EXIT_FAILED, text->failed ? text->failed : "Failed. A message gives the reason.");
    put_status(EXIT_USAGE, "Wrong usage. Nothing was started.");
    if (keeps_work) {
        put_status(EXIT_STOPPED, "Stopped by SIGTERM or SIGUSR1; the checkpoint keeps the work.");
    }
    if (interruptible) {
        put_status(EXIT_INTERRUPTED, "Interrupted, for example by Ctrl-C.");
    }
}

static void put_files(const manual_text *text)
{
    put_section("FILES");
    for (int i = 0; i < MANUAL_PAIRS && text->files[i].name != NULL; i++) {
        put_entry_prose(text->files[i].name, text->files[i].text);
    }
    if (text->files[0].name != NULL) {
        fputs(".PP\n", stdout);
    }
    put_prose("Every file is written under a temporary name and renamed when it is complete.");
}

static void put_environment(const manual_text *text)
{
    put_section("ENVIRONMENT");
    put_prose(text->environment ? text->environment : "No environment variable has an effect.");
}

static void put_examples(const manual_text *text)
{
    for (int i = 0; i < MANUAL_PAIRS && text->examples[i].name != NULL; i++) {
        fputs(i == 0 ? ".SH EXAMPLES\n" : ".PP\n", stdout);
        put_prose(text->examples[i].name);
        fputs(".PP\n.RS 4\n.nf\n", stdout);
        put_escaped(text->examples[i].text, strlen(text->examples[i].text), true);
        fputs("\n.fi\n.RE\n", stdout);
    }
}

/// Names the other pages. `own` is this page.
static void put_see_also(command_id own)
{
    put_section("SEE ALSO");
    const char *separator = "";
    if (own != COMMAND_COUNT) {
        fputs("\\fBalpenglow\\fR(1)", stdout);
        separator = ",\n";
    }
    for (command_id i = 0; i < COMMAND_COUNT; i++) {
        if (i != own) {
            printf("%s\\fBalpenglow\\-%s\\fR(1)", separator, command_table()[i].name);
            separator = ",\n";
        }
    }
    putchar('\n');
}

// --- pages ---------------------------------------------------------------------------------------

int manual_print_command(command_id command)
{
    const command_entry *c = &command_table()[command];
    const manual_text *text = manual_text_of(command);
    put_title(c->name);
    put_prose(c->summary);
    put_section("SYNOPSIS");
    printf("\\fBalpenglow %s\\fR ", c->name);
    put_usage(c->synopsis);
    putchar('\n');
    put_section("DESCRIPTION");
    put_prose(c->help);
    if (strncmp(c->synopsis, "SCENE", strlen("SCENE")) == 0) {
        put_scenes();
    }
    put_section("OPTIONS");
    for (option_group group = 0; group < GROUP_LATER; group++) {
        put_group(command, group);
    }
    put_later(command);
    put_exit_statuses(text, command == COMMAND_BAKE, command_interruptible(command));
    put_files(text);
    put_environment(text);
    put_examples(text);
    put_see_also(command);
    return EXIT_DONE;
}

static void put_commands(void)
{
    put_section("COMMANDS");
    for (int i = 0; i < COMMAND_COUNT; i++) {
        const command_entry *c = &command_table()[i];
        fputs(".TP\n", stdout);
        put_font('B', c->name, strlen(c->name));
        putchar(' ');
        put_usage(c->synopsis);
        putchar('\n');
        put_prose(c->summary);
    }
}

int manual_print(void)
{
    const manual_text *text = manual_text_of(COMMAND_COUNT);
    size_t count = 0;
    const option *table = program_option_table(&count);
    put_title(NULL);
    put_prose("bake occlusion and indirect light into scenes for real-time 3D");
    put_section("SYNOPSIS");
    fputs("\\fBalpenglow\\fR \\fICOMMAND\\fR ...\n.br\n", stdout);
    fputs("\\fBalpenglow\\fR \\fICOMMAND\\fR \\fB\\-\\-help\\fR\n", stdout);
    put_section("DESCRIPTION");
    put_prose(
        "Computes occlusion and indirect light once, and writes them into assets that viewers "
        "and engines display at no cost. Results go to standard output, messages to standard "
        "error. Existing files are kept unless -f is given.");
    put_commands();
    put_section("OPTIONS");
    for (size_t i = 0; i < count; i++) {
        put_option(&table[i]);
    }
    put_exit_statuses(text, true, true);
    put_files(text);
    put_environment(text);
    put_examples(text);
    put_see_also(COMMAND_COUNT);
    return EXIT_DONE;
}
