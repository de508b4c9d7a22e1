// SPDX-License-Identifier: MIT
// --help, written from the table.
#include "options/options.h"

#include <stdio.h>
#include <string.h>

enum { LINE_WIDTH = 80, RANGE_SIZE = 160 };

/// Prints words from `column` on, broken at '\n' and before the line is full. Later lines start at
/// `indent`.
static void print_wrapped(const char *text, int indent, int *column)
{
    while (*text != '\0') {
        const bool line_ended = *text == '\n';
        text += line_ended;
        const int length = (int)strcspn(text, " \n");
        if (line_ended || (*column > indent && *column + 1 + length > LINE_WIDTH)) {
            printf("\n%*s", indent, "");
            *column = indent;
        } else if (*column > indent) {
            putchar(' ');
            *column += 1;
        }
        printf("%.*s", length, text);
        *column += length;
        text += length;
        text += strspn(text, " ");
    }
}

static void print_paragraph(const char *text, int indent)
{
    int column = indent;
    printf("%*s", indent, "");
    print_wrapped(text, indent, &column);
    putchar('\n');
}

void option_facts(const option *o, char *text, size_t size)
{
    char range[RANGE_SIZE];
    int length = 0;
    text[0] = '\0';
    if (o->kind == KIND_WHOLE || o->kind == KIND_REAL || o->kind == KIND_SIZE) {
        option_range(o, range, sizeof range);
        length = snprintf(text, size, "Range %s.", range);
    }
    if (o->initial != NULL && length >= 0 && (size_t)length < size) {
        snprintf(text + length, size - (size_t)length, "%sDefault %s.", length > 0 ? " " : "",
                 o->initial);
    }
}

/// @param whole else the first paragraph of its help
static void print_option(const option *o, bool whole)
{
    enum { INDENT = 8, TEXT_SIZE = 1024 };
    char facts[OPTION_FACTS_SIZE], text[TEXT_SIZE];
    printf("  %s%s%s%s%s\n", o->name, o->alias ? ", " : "", o->alias ? o->alias : "",
           o->value ? " " : "", o->value ? o->value : "");
    snprintf(text, sizeof text, "%.*s", (int)strcspn(o->help, "\n"), o->help);
    print_paragraph(whole ? o->help : text, INDENT);
    option_facts(o, facts, sizeof facts);
    if (facts[0] != '\0') {
        print_paragraph(facts, INDENT);
    }
}

/// Options that are not built yet, in as few lines as possible; choices, one option a line.
static void print_later(command_id command)
{
    enum { INDENT = 2 };
    int column = INDENT;
    const option *o = option_next(command, GROUP_LATER, NULL);
    bool any = o != NULL;
    if (any) {
        printf("\n%s:\n  ", option_group_title(GROUP_LATER));
    }
    for (; o != NULL; o = option_next(command, GROUP_LATER, o)) {
        print_wrapped(o->name, INDENT, &column);
    }
    for (o = option_after(command, NULL); o != NULL; o = option_after(command, o)) {
        if (o->later_choices != NULL) {
            if (!any) {
                printf("\n%s:", option_group_title(GROUP_LATER));
            }
            printf("\n  %s %s", o->name, o->later_choices);
            any = true;
        }
    }
    if (any) {
        putchar('\n');
    }
}

static void print_group(command_id command, option_group group)
{
    const option *o = option_next(command, group, NULL);
    if (o != NULL) {
        printf("\n%s:\n", option_group_title(group));
    }
    for (; o != NULL; o = option_next(command, group, o)) {
        print_option(o, true);
    }
}

/// The options that people use. @return false: the command marks none
static bool print_common(command_id command)
{
    unsigned count = 0, all = 0;
    for (const option *o = option_after(command, NULL); o != NULL; o = option_after(command, o)) {
        all += o->id != OPTION_LATER;
        if ((o->common & (1u << command)) != 0) {
            fputs(count++ == 0 ? "\nOptions:\n" : "", stdout);
            print_option(o, false);
        }
    }
    if (count > 0) {
        printf("\n'alpenglow %s --help all' has all %u options, in full.\n",
               command_table()[command].name, all);
    }
    return count > 0;
}

static void print_scenes(void)
{
    enum { INDENT = 2 };
    size_t count = 0;
    const char *const *names = builtin_scene_names(&count);
    int column = INDENT;
    printf("\nSCENE is a .gltf, .glb, .dae, .zae or .obj file, or one of\n%*s", INDENT, "");
    for (size_t i = 0; i < count; i++) {
        print_wrapped(names[i], INDENT, &column);
    }
    printf("\n%s\n", builtin_scene_settings());
}

static void print_footer(command_id command)
{
    if (command_has_scene(command)) {
        print_scenes();
    }
    printf("\nExit status: 0 done, 1 failed, 2 wrong usage%s.\n",
           command == COMMAND_BAKE          ? ", 75 stopped with a checkpoint, 130 interrupted"
           : command_interruptible(command) ? ", 130 interrupted"
                                            : "");
}

int help_print_command(command_id command, help_request request)
{
    const command_entry *c = &command_table()[command];
    printf("Usage: alpenglow %s %s\n\n", c->name, c->synopsis);
    print_paragraph(c->help, 0);
    const bool common = request == HELP_COMMON && print_common(command);
    for (option_group group = 0; group < GROUP_LATER && !common; group++) {
        print_group(command, group);
    }
    if (!common) {
        print_later(command);
    }
    print_footer(command);
    return EXIT_DONE;
}

int help_print(void)
{
    printf("Usage: alpenglow COMMAND ...\n\n"
           "Bakes occlusion and indirect light into scenes for real-time 3D.\n\nCommands:\n");
    for (int i = 0; i < COMMAND_COUNT; i++) {
        printf("  %-8s  %s\n", command_table()[i].name, command_table()[i].summary);
    }
    printf("\n  alpenglow COMMAND --help   options of a command\n"
           "  alpenglow --version        version\n"
           "  alpenglow --completion bash|zsh|fish\n"
           "                             completion script for that shell\n"
           "\nExample:\n"
           "  alpenglow bake builtin:teapot-room -o room.glb --maps-dir maps\n");
    return EXIT_DONE;
}
