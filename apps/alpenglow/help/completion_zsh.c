// SPDX-License-Identifier: MIT
// Completion for zsh, on its own _arguments.
#include "help/completion.h"

#include <stdio.h>
#include <string.h>

enum { DESCRIPTION_SIZE = 512 };

static const char head[] =
    "#compdef alpenglow\n"
    "# Completion of alpenglow in zsh, made from the command's table of options.\n"
    "# `alpenglow --completion zsh` prints it.\n\n"
    "# Offers the words $1, and files that match the pattern $2.\n"
    "_alpenglow_either() {\n"
    "    local expl ret=1\n"
    "    _wanted words expl word compadd -- ${=1} && ret=0\n"
    "    _files -g $2 && ret=0\n"
    "    return ret\n"
    "}\n\n";

static const char before_commands[] =
    "    if ((CURRENT == 2)) && [[ $PREFIX == -* ]]; then\n"
    "        compadd -- $program\n"
    "    elif ((CURRENT == 2)); then\n"
    "        _describe -t commands command commands\n"
    "    elif ((CURRENT == 3)) && [[ $words[2] == help ]]; then\n"
    "        _describe -t commands command commands\n"
    "    elif ((CURRENT == 3)) && [[ $words[2] == --completion ]]; then\n"
    "        compadd bash zsh fish\n"
    "    else\n"
    "        local command=$words[2]\n"
    "        shift words\n"
    "        ((CURRENT--))\n"
    "        case $command in\n";

static const char tail[] = "        esac\n"
                           "    fi\n"
                           "}\n\n"
                           "if [[ $funcstack[1] == _alpenglow ]]; then\n"
                           "    _alpenglow \"$@\"\n"
                           "else\n"
                           "    compdef _alpenglow alpenglow\n"
                           "fi\n";

/// Prints text inside '...', with a backslash before the characters `special`.
static void put_quoted(const char *text, const char *special)
{
    for (; *text != '\0'; text++) {
        if (*text == '\'') {
            fputs("'\\''", stdout);
        } else {
            completion_put((const char[]){*text, '\0'}, special);
        }
    }
}

/// "*.(glb|gltf)", or "*.glb" (zsh takes "(glb)" at the end for something else), or "*".
static void put_pattern(const completion *c)
{
    bool several = strchr(c->endings, ' ') != NULL;
    fputs(c->any_file ? "*" : several ? "*.(" : "*.", stdout);
    for (const char *at = c->any_file ? "" : c->endings; *at != '\0'; at++) {
        putchar(*at == ' ' ? '|' : *at);
    }
    fputs(several && !c->any_file ? ")" : "", stdout);
}

/// The action of an argument: how _arguments completes it.
static void put_action(const completion *c)
{
    bool files = c->any_file || c->endings[0] != '\0';
    if (c->list) {
        printf("_values -s , word %s", c->words);
    } else if (c->words[0] != '\0' && files) {
        // without the blank in front _arguments adds its own words
        fputs(" _alpenglow_either \"", stdout);
        put_quoted(c->words, ":");
        fputs("\" \"", stdout);
        put_pattern(c);
        putchar('"');
    } else if (c->words[0] != '\0') {
        printf("(%s)", c->words);
    } else if (files) {
        fputs("_files -g \"", stdout);
        put_pattern(c);
        putchar('"');
    } else {
        fputs(c->folders ? "_files -/" : " ", stdout);
    }
}

/// An option as _arguments wants it: '(-o --output)'{-o,--output=}'[description]:OUT.glb:_files'
static void print_option(const option *o)
{
    char description[DESCRIPTION_SIZE];
    completion c = completion_of_option(o);
    const char *equals = o->kind == KIND_FLAG ? "" : "=";
    fputs("            ", stdout);
    if (o->alias != NULL) {
        printf("'(%s %s)'{%s,%s%s}'", o->name, o->alias, o->name, o->alias, equals);
    } else {
        printf("'%s%s%s", o->repeats ? "*" : "", o->name, equals);
    }
    completion_describe(o, description, sizeof description);
    putchar('[');
    put_quoted(description, "[]\\");
    putchar(']');
    if (o->kind != KIND_FLAG) {
        putchar(':');
        put_quoted(o->value, ":\\");
        putchar(':');
        put_action(&c);
    }
    puts("' \\");
}

static void print_command(command_id command)
{
    const command_entry *entry = &command_table()[command];
    completion operand = completion_of_operand(command);
    printf("        %s)\n            _arguments -S \\\n", entry->name);
    for (const option *o = option_after(command, NULL); o != NULL; o = option_after(command, o)) {
        if (completion_offers(command, o)) {
            print_option(o);
        }
    }
    for (int i = 0; i < command_operand_limit(command); i++) {
        printf("            ':%s:",
               command == COMMAND_COMPARE || command == COMMAND_SH ? "image" : "scene");
        put_action(&operand);
        puts("' \\");
    }
    // An empty line ends what the last backslash goes on.
    puts("\n            ;;");
}

void completion_print_zsh(void)
{
    size_t count = 0;
    const option *program = program_option_table(&count);
    fputs(head, stdout);
    puts("_alpenglow() {\n    local -a commands=(");
    for (int i = 0; i < COMMAND_COUNT; i++) {
        printf("        '%s:", command_table()[i].name);
        put_quoted(command_table()[i].summary, "\\");
        puts("'");
    }
    fputs("        'help:print the options of a command'\n    )\n    local -a program=(", stdout);
    for (size_t i = 0; i < count; i++) {
        printf("%s%s%s%s", i > 0 ? " " : "", program[i].name, program[i].alias ? " " : "",
               program[i].alias ? program[i].alias : "");
    }
    puts(")");
    fputs(before_commands, stdout);
    for (command_id i = 0; i < COMMAND_COUNT; i++) {
        print_command(i);
    }
    fputs(tail, stdout);
}
