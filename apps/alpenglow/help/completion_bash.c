// SPDX-License-Identifier: MIT
// Completion for bash 4.3 and later, with or without the bash-completion package.
#include "help/completion.h"

#include <stdio.h>

static const char head[] =
    "# Completion of alpenglow in bash, made from the command's table of options.\n"
    "# `alpenglow --completion bash` prints it.\n\n";

static const char offers[] =
    "# Offers each of the words $2 that continues $1.\n"
    "_alpenglow_offer() {\n"
    "    local word\n"
    "    for word in $2; do\n"
    "        [[ $word != \"$1\"* ]] || COMPREPLY+=(\"$word\")\n"
    "    done\n"
    "}\n\n"
    "# Offers the words $2 as parts of a list with commas that $1 has begun.\n"
    "_alpenglow_offer_list() {\n"
    "    local word before=${1%\"${1##*,}\"}\n"
    "    for word in $2; do\n"
    "        [[ ,$before == *,$word,* || $before$word != \"$1\"* ]] || "
    "COMPREPLY+=(\"$before$word\")\n"
    "    done\n"
    "}\n\n"
    "# Offers the folders that continue $1, and the files with one of the endings $2 (\"any\").\n"
    "_alpenglow_offer_files() {\n"
    "    local path ending start=${1#[\\\"\\']} before=${#COMPREPLY[@]}\n"
    "    start=${start//\\\\/}\n"
    "    while IFS= read -r path; do\n"
    "        COMPREPLY+=(\"$path\")\n"
    "    done < <(compgen -d -- \"$start\")\n"
    "    while IFS= read -r path; do\n"
    "        for ending in $2; do\n"
    "            [[ $ending != any && ${path,,} != *.\"$ending\" ]] || COMPREPLY+=(\"$path\")\n"
    "        done\n"
    "    done < <(compgen -f -- \"$start\")\n"
    "    ((${#COMPREPLY[@]} == before)) || compopt -o filenames 2>/dev/null || :\n"
    "}\n\n"
    "# Offers what the variables of _alpenglow_place say.\n"
    "_alpenglow_offer_place() {\n"
    "    if [[ $list ]]; then\n"
    "        _alpenglow_offer_list \"$1\" \"$words\"\n"
    "    else\n"
    "        _alpenglow_offer \"$1\" \"$words\"\n"
    "    fi\n"
    "    [[ ! $endings && ! $folders ]] || _alpenglow_offer_files \"$1\" \"$endings\"\n"
    "}\n\n";

static const char reading[] =
    "# Reads the line up to the cursor into `line`: bash cuts words at \":\" and \"=\", here they\n"
    "# are whole again.\n"
    "_alpenglow_read() {\n"
    "    local rest=$COMP_LINE word glued= i\n"
    "    line=()\n"
    "    for ((i = 0; i <= COMP_CWORD; i++)); do\n"
    "        word=${COMP_WORDS[i]}\n"
    "        if [[ $glued ]]; then line[-1]+=$word; else line+=(\"$word\"); fi\n"
    "        rest=${rest#*\"$word\"}\n"
    "        if [[ $rest == [![:blank:]]* ]]; then glued=yes; else glued=; fi\n"
    "    done\n"
    "}\n\n"
    "# Walks over the words between command and cursor: `wanted` is the option whose value comes\n"
    "# next, `ended` says that \"--\" was there, `given` counts operands.\n"
    "_alpenglow_walk() {\n"
    "    local i word last=$((${#line[@]} - 1))\n"
    "    for ((i = 2; i < last; i++)); do\n"
    "        word=${line[i]}\n"
    "        if [[ $ended || $word != -?* ]]; then\n"
    "            given=$((given + 1))\n"
    "        elif [[ $word == -- ]]; then\n"
    "            ended=yes\n"
    "        elif [[ $word != --*=* ]] && _alpenglow_place \"${line[1]} $word\"; then\n"
    "            i=$((i + 1))\n"
    "            ((i < last)) || wanted=$word\n"
    "        fi\n"
    "    done\n"
    "}\n\n";

static const char main_part[] =
    "# Completes within a command.\n"
    "_alpenglow_command() {\n"
    "    local wanted= ended= given=0 options= operands=0 words= endings= folders= list=\n"
    "    _alpenglow_walk\n"
    "    if [[ ! $wanted && ! $ended && $1 == --*=* ]]; then\n"
    "        wanted=${1%%=*}\n"
    "        _alpenglow_place \"${line[1]} $wanted\" || return 0\n"
    "        _alpenglow_offer_place \"${1#*=}\"\n"
    "        [[ $COMP_WORDBREAKS == *=* ]] || COMPREPLY=(\"${COMPREPLY[@]/#/$wanted=}\")\n"
    "    elif [[ $wanted ]]; then\n"
    "        _alpenglow_place \"${line[1]} $wanted\"\n"
    "        _alpenglow_offer_place \"$1\"\n"
    "    else\n"
    "        _alpenglow_options \"${line[1]}\"\n"
    "        if [[ ! $ended && $1 == -* ]] || ((given >= operands)); then\n"
    "            [[ $ended ]] || _alpenglow_offer \"$1\" \"$options\"\n"
    "        else\n"
    "            _alpenglow_place \"${line[1]}\" && _alpenglow_offer_place \"$1\"\n"
    "        fi\n"
    "    fi\n"
    "}\n\n"
    "_alpenglow() {\n"
    "    local IFS=$' \\t\\n' line current breaks lead\n"
    "    COMPREPLY=()\n"
    "    _alpenglow_read\n"
    "    current=${line[-1]}\n"
    "    case \"${#line[@]} ${line[1]}\" in\n"
    "    2\\ -*) _alpenglow_offer \"$current\" \"$_alpenglow_program\" ;;\n"
    "    2\\ *) _alpenglow_offer \"$current\" \"$_alpenglow_commands\" ;;\n"
    "    3\\ help) _alpenglow_offer \"$current\" \"$_alpenglow_commands\" ;;\n"
    "    3\\ --completion) _alpenglow_offer \"$current\" 'bash zsh fish' ;;\n"
    "    *) _alpenglow_command \"$current\" ;;\n"
    "    esac\n"
    "    # Only what stands behind the last break is replaced, so only that is offered.\n"
    "    breaks=${COMP_WORDBREAKS//[!:=]/}\n"
    "    [[ $current != --*=* ]] || current=${current#*=}\n"
    "    if [[ $breaks && ${#COMPREPLY[@]} -gt 0 ]]; then\n"
    "        lead=${current%\"${current##*[$breaks]}\"}\n"
    "        COMPREPLY=(\"${COMPREPLY[@]#\"$lead\"}\")\n"
    "    fi\n"
    "}\n\n"
    "complete -F _alpenglow alpenglow\n";

/// The lines of one place in the function _alpenglow_place.
static void print_place(const completion *c)
{
    if (c->words[0] != '\0') {
        printf(" words='%s'", c->words);
    }
    if (c->any_file || c->endings[0] != '\0') {
        printf(" endings='%s'", c->any_file ? "any" : c->endings);
    }
    printf("%s%s ;;\n", c->folders ? " folders=yes" : "", c->list ? " list=yes" : "");
}

static void print_places_of(command_id command)
{
    const char *name = command_table()[command].name;
    completion c = completion_of_operand(command);
    printf("    %s)", name);
    print_place(&c);
    for (const option *o = option_after(command, NULL); o != NULL; o = option_after(command, o)) {
        if (!completion_offers(command, o) || o->kind == KIND_FLAG) {
            continue;
        }
        printf("    '%s %s'", name, o->name);
        if (o->alias != NULL) {
            printf(" | '%s %s'", name, o->alias);
        }
        putchar(')');
        c = completion_of_option(o);
        print_place(&c);
    }
}

static void print_places(void)
{
    puts("# What may stand in a place, \"COMMAND OPTION\" for a value or \"COMMAND\" for an "
         "operand:\n"
         "# words, endings of files, folders, a list with commas. Status 1: an option without "
         "value.\n"
         "_alpenglow_place() {\n"
         "    words= endings= folders= list=\n"
         "    case $1 in");
    for (command_id i = 0; i < COMMAND_COUNT; i++) {
        print_places_of(i);
    }
    puts("    *) return 1 ;;\n    esac\n}\n");
}

static void print_names(const option *o, const char *separator)
{
    printf("%s%s%s%s", separator, o->name, o->alias ? " " : "", o->alias ? o->alias : "");
}

static void print_options(void)
{
    puts("# The options of a command, and how many operands it takes.\n"
         "_alpenglow_options() {\n"
         "    case $1 in");
    for (command_id command = 0; command < COMMAND_COUNT; command++) {
        const char *name = command_table()[command].name;
        printf("    %s) operands=%d options='", name, command_operand_limit(command));
        const char *separator = "";
        for (const option *o = option_after(command, NULL); o != NULL;
             o = option_after(command, o)) {
            if (completion_offers(command, o)) {
                print_names(o, separator);
                separator = " ";
            }
        }
        puts("' ;;");
    }
    puts("    esac\n}\n");
}

void completion_print_bash(void)
{
    size_t count = 0;
    const option *program = program_option_table(&count);
    fputs(head, stdout);
    fputs("_alpenglow_commands='help", stdout);
    for (int i = 0; i < COMMAND_COUNT; i++) {
        printf(" %s", command_table()[i].name);
    }
    fputs("'\n_alpenglow_program='", stdout);
    for (size_t i = 0; i < count; i++) {
        print_names(&program[i], i > 0 ? " " : "");
    }
    puts("'\n");
    print_places();
    print_options();
    fputs(offers, stdout);
    fputs(reading, stdout);
    fputs(main_part, stdout);
}
