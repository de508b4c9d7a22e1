// SPDX-License-Identifier: MIT
// Completion for fish 3.
#include "help/completion.h"

#include <stdio.h>
#include <string.h>

enum { DESCRIPTION_SIZE = 512 };

static const char head[] =
    "# Completion of alpenglow in fish, made from the command's table of options.\n"
    "# `alpenglow --completion fish` prints it.\n\n"
    "function __alpenglow_first\n"
    "    set -l words (commandline -opc)\n"
    "    test (count $words) -eq 1; or test \"$words[2..]\" = --completion\n"
    "end\n\n"
    "# True behind the command $argv[1], or behind nothing but it where $argv[2] is \"next\".\n"
    "function __alpenglow_behind\n"
    "    set -l words (commandline -opc)\n"
    "    test \"$words[2]\" = \"$argv[1]\"; or return 1\n"
    "    test \"$argv[2]\" != next; or test (count $words) -eq 2\n"
    "end\n\n"
    "# What is typed of a value, as in \"--output=sce\" or \"sce\".\n"
    "function __alpenglow_typed\n"
    "    string replace -r -- '^--[^=]*=' '' (commandline -ct)\n"
    "end\n\n"
    "# Folders, and files with one of the endings $argv.\n"
    "function __alpenglow_files\n"
    "    set -l endings (string join '|' -- $argv)\n"
    "    string match -q -- 'builtin:*' (__alpenglow_typed); and return\n"
    "    for path in (complete -C \"'' \"(__alpenglow_typed) | string replace -r '\\t.*' '')\n"
    "        string match -r -i -- \"^.*(?:/|\\.(?:$endings))\\$\" $path\n"
    "    end\n"
    "end\n\n"
    "# Parts of a list with commas: the words $argv that are not in it yet.\n"
    "function __alpenglow_list\n"
    "    set -l before (__alpenglow_typed | string replace -r '[^,]*$' '')\n"
    "    for word in $argv\n"
    "        contains -- $word (string split , -- $before); or echo $before$word\n"
    "    end\n"
    "end\n\n"
    "complete -c alpenglow -f\n";

static void put_quoted(const char *text)
{
    putchar('\'');
    completion_put(text, "'\\");
    putchar('\'');
}

/// The words and files of a place, as one argument of -a.
static void put_offer(const completion *c)
{
    const char *separator = "";
    fputs(" -f -a '", stdout);
    if (c->list) {
        printf("(__alpenglow_list %s)", c->words);
        separator = " ";
    } else if (c->words[0] != '\0') {
        fputs(c->words, stdout);
        separator = " ";
    }
    if (c->endings[0] != '\0') {
        printf("%s(__alpenglow_files %s)", separator, c->endings);
    }
    if (c->folders) {
        printf("%s(__fish_complete_directories (__alpenglow_typed) folder)", separator);
    }
    putchar('\'');
}

static void print_option(const char *condition, const option *o)
{
    char description[DESCRIPTION_SIZE];
    const char *names[2] = {o->name, o->alias};
    completion c = completion_of_option(o);
    printf("complete -c alpenglow -n '%s'", condition);
    for (int i = 0; i < 2 && names[i] != NULL; i++) {
        bool is_long = strncmp(names[i], "--", 2) == 0;
        printf(is_long ? " -l %s" : " -s %s", names[i] + (is_long ? 2 : 1));
    }
    if (o->kind != KIND_FLAG) {
        fputs(" -r", stdout);
        if (c.any_file) {
            fputs(" -F", stdout);
        } else {
            put_offer(&c);
        }
    }
    completion_describe(o, description, sizeof description);
    fputs(" -d ", stdout);
    put_quoted(description);
    putchar('\n');
}

static void print_command(command_id command)
{
    char condition[64];
    const command_entry *entry = &command_table()[command];
    completion operand = completion_of_operand(command);
    snprintf(condition, sizeof condition, "__alpenglow_behind %s", entry->name);
    putchar('\n');
    if (operand.words[0] != '\0' || operand.endings[0] != '\0') {
        printf("complete -c alpenglow -n '%s'", condition);
        put_offer(&operand);
        putchar('\n');
    }
    for (const option *o = option_after(command, NULL); o != NULL; o = option_after(command, o)) {
        if (completion_offers(command, o)) {
            print_option(condition, o);
        }
    }
}

void completion_print_fish(void)
{
    size_t count = 0;
    const option *program = program_option_table(&count);
    fputs(head, stdout);
    for (int i = 0; i < COMMAND_COUNT; i++) {
        printf("complete -c alpenglow -n __alpenglow_first -a %s -d ", command_table()[i].name);
        put_quoted(command_table()[i].summary);
        printf("\ncomplete -c alpenglow -n '__alpenglow_behind help next' -a %s\n",
               command_table()[i].name);
    }
    puts("complete -c alpenglow -n __alpenglow_first -a help -d 'print the options of a command'");
    for (size_t i = 0; i < count; i++) {
        print_option("__alpenglow_first", &program[i]);
    }
    for (command_id i = 0; i < COMMAND_COUNT; i++) {
        print_command(i);
    }
}
