// SPDX-License-Identifier: MIT
// Parsing a command line by the table: strict numbers, ranges, suggestions for misspelt words.
#include "options/options.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { TEXT_SIZE = 160 };

static const char *command_name(command_id command)
{
    return command < COMMAND_COUNT ? command_table()[command].name : NULL;
}

int usage_error(command_id command, const char *format, ...)
{
    const char *name = command_name(command);
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "alpenglow%s%s: ", name ? " " : "", name ? name : "");
    vfprintf(stderr, format, arguments);
    fprintf(stderr, "\nTry 'alpenglow %s%s--help'.\n", name ? name : "", name ? " " : "");
    va_end(arguments);
    return EXIT_USAGE;
}

// --- values --------------------------------------------------------------------------------------

/// Index of `word` among "a|b|c" in any case of letters, or −1.
static int find_choice(const char *choices, const char *word, size_t length)
{
    int index = 0;
    for (const char *at = choices; at != NULL; index++) {
        size_t choice_length = strcspn(at, "|");
        if (choice_length == length && strncasecmp(at, word, length) == 0) {
            return index;
        }
        at = at[choice_length] == '|' ? at + choice_length + 1 : NULL;
    }
    return -1;
}

/// Index of the choice that a synonym stands for, or −1. @param synonyms "word=choice|...", or NULL
static int find_synonym(const option *o, const char *word, size_t length)
{
    for (const char *at = o->synonyms; at != NULL;) {
        const size_t end = strcspn(at, "|"), name = strcspn(at, "=");
        if (name == length && strncasecmp(at, word, length) == 0) {
            return find_choice(o->choices, at + name + 1, end - name - 1);
        }
        at = at[end] == '|' ? at + end + 1 : NULL;
    }
    return -1;
}

static int parse_choice(command_id command, const option *o, const char *text, size_t length,
                        option_value *value)
{
    value->choice = find_choice(o->choices, text, length);
    if (value->choice < 0) {
        value->choice = find_synonym(o, text, length);
    }
    if (value->choice >= 0) {
        return EXIT_DONE;
    }
    if (find_choice(o->later_choices, text, length) >= 0) {
        return usage_error(command, "%s %.*s: not built yet; give %s", o->name, (int)length, text,
                           o->choices);
    }
    char nearest[TEXT_SIZE];
    choice_nearest(o->choices, text, length, nearest, sizeof nearest);
    const char *proposed = nearest[0] != '\0' ? nearest : o->example;
    return usage_error(command, "%s: '%.*s' is not one of %s%s%s%s%s%s", o->name, (int)length, text,
                       o->choices,
                       nearest[0] != '\0' ? "; did you mean "
                       : proposed != NULL ? "; give one, such as "
                                          : "",
                       proposed != NULL ? o->name : "", proposed != NULL ? " " : "",
                       proposed != NULL ? proposed : "", nearest[0] != '\0' ? "?" : "");
}

static int parse_list(command_id command, const option *o, const char *text, option_value *value)
{
    value->whole = 0;
    for (const char *at = text; at != NULL;) {
        size_t length = strcspn(at, ",");
        int code = parse_choice(command, o, at, length, value);
        if (code != EXIT_DONE) {
            return code;
        }
        value->whole |= value->choice >= 0 ? UINT64_C(1) << value->choice : 0;
        at = at[length] == ',' ? at + length + 1 : NULL;
    }
    return EXIT_DONE;
}

/// Reads the number alone. @param outside out: whether it is out of the option's range
static number_result read_number(const option *o, const char *text, option_value *value,
                                 bool *outside)
{
    number_result result;
    if (o->kind == KIND_REAL) {
        result = number_parse_real(text, &value->real);
        *outside = value->real < o->minimum || value->real > o->maximum;
        return result;
    }
    const bool negative = o->kind == KIND_WHOLE && text[0] == '-' &&
                          number_parse_whole(text + 1, &value->whole) != NUMBER_NONE;
    result = negative               ? NUMBER_TOO_LARGE
             : o->kind == KIND_SIZE ? number_parse_size(text, &value->whole)
             : o->sides             ? number_parse_side(text, &value->whole)
                                    : number_parse_whole(text, &value->whole);
    // as whole numbers: a double cannot hold all of them
    *outside = value->whole < (uint64_t)o->minimum || value->whole > (uint64_t)o->maximum;
    return result;
}

static int parse_number(command_id command, const option *o, const char *text, option_value *value)
{
    char range[TEXT_SIZE];
    bool outside = false;
    option_range(o, range, sizeof range);
    value->choice = find_choice(o->choices, text, strlen(text));
    if (value->choice >= 0) {
        return EXIT_DONE;
    }
    const number_result result = read_number(o, text, value, &outside);
    if (result == NUMBER_NONE) {
        const char *form = o->example != NULL ? o->example : o->value; // "N" of "N|auto"
        return usage_error(command, "%s: '%s' is not a %s; give %s %.*s (%s)", o->name, text,
                           o->sides                ? "side of a square"
                           : o->kind == KIND_WHOLE ? "whole number"
                           : o->kind == KIND_SIZE  ? "size"
                                                   : "number",
                           o->name, (int)strcspn(form, "|"), form, range);
    }
    if (result == NUMBER_TOO_LARGE || outside) {
        return usage_error(command, "%s: %s is out of range; give %s", o->name, text, range);
    }
    return EXIT_DONE;
}

/// Refuses an option whose value is missing or empty.
static int refuse_no_value(command_id command, const option *o)
{
    return usage_error(command, "%s needs a value: %s%s%s%s%s", o->name, o->value,
                       o->example != NULL ? ", such as " : "", o->example != NULL ? o->name : "",
                       o->example != NULL ? " " : "", o->example != NULL ? o->example : "");
}

static int parse_value(command_id command, const option *o, const char *text, option_value *value)
{
    value->text = text;
    if (*text == '\0') {
        return refuse_no_value(command, o);
    }
    switch (o->kind) {
    case KIND_CHOICE:
        return parse_choice(command, o, text, strlen(text), value);
    case KIND_LIST:
        return parse_list(command, o, text, value);
    case KIND_WHOLE:
    case KIND_SIZE:
    case KIND_REAL:
        return parse_number(command, o, text, value);
    case KIND_TEXT:
    case KIND_FLAG:
        break;
    }
    return EXIT_DONE;
}

// --- the line ------------------------------------------------------------------------------------

static bool same_word(const char *known, const char *word, size_t length)
{
    return known != NULL && strlen(known) == length && strncmp(known, word, length) == 0;
}

const option *option_find(command_id command, const char *name, size_t length)
{
    for (const option *o = option_after(command, NULL); o != NULL; o = option_after(command, o)) {
        if (same_word(o->name, name, length) || same_word(o->alias, name, length)) {
            return o;
        }
    }
    return NULL;
}

static const option *find_by_id(command_id command, option_id id)
{
    const option *o = option_after(command, NULL);
    while (o != NULL && o->id != id) {
        o = option_after(command, o);
    }
    return o;
}

const char *option_name(command_id command, option_id id)
{
    const option *o = find_by_id(command, id);
    return o != NULL ? o->name : "";
}

const char *option_find_given(const command_line *a, const option_id *ids, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (a->values[ids[i]].given) {
            return option_name(a->command, ids[i]);
        }
    }
    return NULL;
}

void option_give(command_line *a, option_id id, const char *text)
{
    a->values[id].given = true;
    (void)parse_value(a->command, find_by_id(a->command, id), text, &a->values[id]);
}

/// The first command that has this option, or COMMAND_COUNT.
static command_id command_with(const char *name, size_t length)
{
    for (command_id i = 0; i < COMMAND_COUNT; i++) {
        if (option_find(i, name, length) != NULL) {
            return i;
        }
    }
    return COMMAND_COUNT;
}

static int refuse_unknown(command_id command, const char *word, size_t length)
{
    char name[TEXT_SIZE];
    snprintf(name, sizeof name, "%.*s", (int)(length < TEXT_SIZE ? length : TEXT_SIZE - 1), word);
    const char *nearest = option_nearest(command, name);
    command_id other = command_with(word, length);
    if (other != COMMAND_COUNT) {
        return usage_error(command, "%s is an option of %s, not of %s", name, command_name(other),
                           command_name(command));
    }
    if (nearest != NULL) {
        return usage_error(command, "unknown option %s; did you mean %s?", name, nearest);
    }
    return usage_error(command, "unknown option %s", name);
}

/// Keeps one value of an option that may be repeated.
static int keep_repeated(command_id command, const option *o, const char *text,
                         command_line *parsed)
{
    if (parsed->repeated_count == REPEAT_LIMIT) {
        return usage_error(command,
                           "%s %s: is one more than %d lamps and spots, the limit; put further "
                           "ones into the scene",
                           o->name, text, (int)REPEAT_LIMIT);
    }
    parsed->repeated[parsed->repeated_count].id = o->id;
    parsed->repeated[parsed->repeated_count].text = text;
    parsed->repeated_count += 1;
    return EXIT_DONE;
}

/// Whether a word is the value of a flag that may have one: "-", or the name of a .json.
static bool is_optional_value(const char *word)
{
    static const char ending[] = ".json", probes[] = ".probes.json";
    const size_t length = strlen(word), size = sizeof ending - 1, longer = sizeof probes - 1;
    return strcmp(word, "-") == 0 ||
           (length > size && word[0] != '-' && strcmp(word + length - size, ending) == 0 &&
            !(length > longer && strcmp(word + length - longer, probes) == 0));
}

/// A flag, and its value if it may have one.
static int parse_flag(command_id command, int count, char **words, int *at, const option *o,
                      const char *equals, option_value *value)
{
    if (o->value == NULL) {
        return equals ? usage_error(command, "%s takes no value", o->name) : EXIT_DONE;
    }
    if (equals != NULL) {
        return parse_value(command, o, equals + 1, value);
    }
    if (*at + 1 < count && is_optional_value(words[*at + 1])) {
        *at += 1;
        value->text = words[*at];
    }
    return EXIT_DONE;
}

/// Reads the option at words[*at] and its value, if it has one. *at ends on its last word.
static int parse_option(command_id command, int count, char **words, int *at, command_line *parsed)
{
    const char *word = words[*at];
    const char *equals = strncmp(word, "--", 2) == 0 ? strchr(word, '=') : NULL;
    size_t length = equals ? (size_t)(equals - word) : strlen(word);
    const option *o = option_find(command, word, length);
    if (o == NULL) {
        return refuse_unknown(command, word, length);
    }
    if (o->id == OPTION_LATER) {
        return usage_error(command, "%s: not built yet; %s", o->name, o->help);
    }
    option_value *value = &parsed->values[o->id];
    value->given = true;
    if (o->kind == KIND_FLAG) {
        return parse_flag(command, count, words, at, o, equals, value);
    }
    const char *text = equals ? equals + 1 : NULL;
    if (text == NULL) {
        const char *next = *at + 1 < count ? words[*at + 1] : NULL;
        if (next == NULL || option_find(command, next, strlen(next)) != NULL) {
            return refuse_no_value(command, o);
        }
        text = next;
        *at += 1;
    }
    const int code = parse_value(command, o, text, value);
    return code == EXIT_DONE && o->repeats ? keep_repeated(command, o, text, parsed) : code;
}

static void set_defaults(command_id command, command_line *parsed)
{
    for (const option *o = option_after(command, NULL); o != NULL; o = option_after(command, o)) {
        if (o->initial != NULL) {
            (void)parse_value(command, o, o->initial, &parsed->values[o->id]);
        }
    }
}

/// Whether an operand after the last may name the output, as -o does.
static bool has_output(command_id command)
{
    return option_find(command, "-o", 2) != NULL;
}

static const char *operand_names(command_id command)
{
    return command == COMMAND_COMPARE                              ? "two operands, A and B"
           : command == COMMAND_SH                                 ? "one image, ENV"
           : command == COMMAND_BENCH                              ? "one ROOM at most"
           : command == COMMAND_WEB                                ? "one scene, BAKED"
           : command == COMMAND_STATUS || command == COMMAND_MERGE ? "one folder, DIR"
                                                                   : "one SCENE";
}

static int refuse_operand(command_id command, const char *word)
{
    return usage_error(command, "takes %s%s; '%s' is one too many", operand_names(command),
                       has_output(command) ? " and one output" : "", word);
}

help_request arguments_ask_for_help(int count, char **words)
{
    for (int i = 0; i < count && strcmp(words[i], "--") != 0; i++) {
        if (strcmp(words[i], "--help") == 0 || strcmp(words[i], "-h") == 0) {
            return i + 1 < count && strcmp(words[i + 1], "all") == 0 ? HELP_ALL : HELP_COMMON;
        }
    }
    return HELP_NONE;
}

int arguments_parse(command_id command, int count, char **words, command_line *parsed)
{
    *parsed = (command_line){.command = command, .words = words, .word_count = count};
    set_defaults(command, parsed);
    int operands = 0, wanted = command_operand_limit(command);
    const char *output = NULL; // an operand
    bool options_ended = false;
    for (int i = 0; i < count; i++) {
        if (!options_ended && strcmp(words[i], "--") == 0) {
            options_ended = true;
        } else if (!options_ended && words[i][0] == '-' && words[i][1] != '\0') {
            int code = parse_option(command, count, words, &i, parsed);
            if (code != EXIT_DONE) {
                return code;
            }
        } else if (operands < wanted && words[i][0] == '\0' && command != COMMAND_BENCH) {
            return usage_error(command, "needs %s; a name is empty", operand_names(command));
        } else if (operands < wanted) {
            parsed->operands[operands++] = words[i];
        } else if (output == NULL && has_output(command) && words[i][0] != '\0') {
            output = words[i];
        } else {
            return refuse_operand(command, words[i]);
        }
    }
    if (operands < command_table()[command].operand_count) {
        return usage_error(command, "needs %s", operand_names(command));
    }
    option_value *named = &parsed->values[OPTION_OUTPUT];
    if (output != NULL && named->given) {
        return refuse_operand(command, output);
    }
    if (output != NULL) {
        *named = (option_value){.given = true, .text = output};
    }
    return EXIT_DONE;
}
