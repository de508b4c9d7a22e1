// SPDX-License-Identifier: MIT
// Parsing a command line by the table: strict numbers, ranges, suggestions for misspelt words.
#include "options/options.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

// --- numbers -------------------------------------------------------------------------------------

number_result number_parse_whole(const char *text, uint64_t *number)
{
    if (*text == '\0' || text[strspn(text, "0123456789")] != '\0') {
        return NUMBER_NONE;
    }
    errno = 0;
    unsigned long long parsed = strtoull(text, NULL, 10);
    *number = parsed;
    return errno == ERANGE ? NUMBER_TOO_LARGE : NUMBER_OK;
}

number_result number_parse_size(const char *text, uint64_t *number)
{
    static const char units[] = "KMG";
    char digits[32];
    const size_t length = strspn(text, "0123456789");
    const char *unit = text[length] != '\0' ? strchr(units, text[length]) : NULL;
    if (length == 0 || length >= sizeof digits ||
        (text[length] != '\0' && (unit == NULL || text[length + 1] != '\0'))) {
        return NUMBER_NONE;
    }
    memcpy(digits, text, length);
    digits[length] = '\0';
    number_result result = number_parse_whole(digits, number);
    for (int i = 0; unit != NULL && i <= unit - units; i++) {
        result = *number > UINT64_MAX / 1024 ? NUMBER_TOO_LARGE : result;
        *number *= 1024;
    }
    return result;
}

number_result number_parse_real(const char *text, double *number)
{
    // strtod alone would accept leading blanks, hexadecimal, nan and inf.
    if (*text == '\0' || text[strspn(text, "0123456789+-.eE")] != '\0') {
        return NUMBER_NONE;
    }
    char *end = NULL;
    *number = strtod(text, &end);
    if (end == text || *end != '\0') {
        return NUMBER_NONE;
    }
    return isfinite(*number) ? NUMBER_OK : NUMBER_TOO_LARGE;
}

const char *number_parse_list(const char *text, double *numbers, int count)
{
    for (int i = 0; i < count; i++) {
        char word[64];
        const size_t length = strcspn(text, ",/");
        if (length == 0 || length >= sizeof word) {
            return NULL;
        }
        memcpy(word, text, length);
        word[length] = '\0';
        if (number_parse_real(word, &numbers[i]) != NUMBER_OK || fabs(numbers[i]) > 1e9) {
            return NULL;
        }
        text += length;
        if (i + 1 < count && *text++ != ',') {
            return NULL;
        }
    }
    return text;
}

void option_range(const option *o, char *text, size_t size)
{
    // %.16g prints whole numbers in full, and 1e-06 short.
    int length = o->minimum < o->maximum
                     ? snprintf(text, size, "%.16g to %.16g", o->minimum, o->maximum)
                     : snprintf(text, size, "%.16g", o->minimum);
    if (o->unit != NULL && length > 0 && (size_t)length < size) {
        length += snprintf(text + length, size - (size_t)length, " %s", o->unit);
    }
    if (o->choices != NULL && length > 0 && (size_t)length < size) {
        char words[TEXT_SIZE];
        snprintf(words, sizeof words, "%s", o->choices);
        for (char *bar = strchr(words, '|'); bar != NULL; bar = strchr(bar, '|')) {
            *bar = '/';
        }
        snprintf(text + length, size - (size_t)length, ", or %s", words);
    }
}

// --- near misses ---------------------------------------------------------------------------------

/// Edits between two words: insert, delete, replace, exchange two neighbours.
/// Based on: F. Damerau. A technique for computer detection and correction of spelling errors.
/// CACM 1964 (the restricted form: no part is edited twice).
static size_t edit_distance(const char *a, const char *b)
{
    enum { LONGEST = 40 };
    size_t rows[3][LONGEST + 1];
    size_t a_length = strlen(a), b_length = strlen(b);
    if (a_length > LONGEST || b_length > LONGEST) {
        return SIZE_MAX;
    }
    size_t *before = rows[0], *last = rows[1], *now = rows[2];
    for (size_t j = 0; j <= b_length; j++) {
        last[j] = j;
        before[j] = 0;
    }
    for (size_t i = 1; i <= a_length; i++) {
        now[0] = i;
        for (size_t j = 1; j <= b_length; j++) {
            size_t replaced = last[j - 1] + (a[i - 1] != b[j - 1]);
            size_t dropped = (last[j] < now[j - 1] ? last[j] : now[j - 1]) + 1;
            now[j] = replaced < dropped ? replaced : dropped;
            bool exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (exchanged && before[j - 2] + 1 < now[j]) {
                now[j] = before[j - 2] + 1;
            }
        }
        size_t *oldest = before;
        before = last;
        last = now;
        now = oldest;
    }
    return last[b_length];
}

/// Distance of a known word from the written one. It is 1 if the known one begins with the written
/// one, of 4 letters or more.
static size_t word_distance(const char *written, const char *known)
{
    size_t length = strlen(written);
    if (length >= 4 && strncmp(written, known, length) == 0) {
        return 1;
    }
    return edit_distance(written, known);
}

/// A third of the letters may be wrong.
static size_t distance_limit(const char *written)
{
    return strlen(written) / 3 + 1;
}

const char *option_nearest(command_id command, const char *name)
{
    size_t best = distance_limit(name);
    const char *nearest = NULL;
    for (const option *o = option_after(command, NULL); o != NULL; o = option_after(command, o)) {
        const char *names[2] = {o->name, o->alias};
        for (int k = 0; k < 2; k++) {
            if (names[k] == NULL || strlen(names[k]) < 3) {
                continue;
            }
            size_t distance = word_distance(name, names[k]);
            if (distance < best) {
                best = distance;
                nearest = names[k];
            }
        }
    }
    return nearest;
}

const char *command_nearest(const char *name)
{
    size_t best = distance_limit(name);
    const char *nearest = NULL;
    for (int i = 0; i < COMMAND_COUNT; i++) {
        size_t distance = word_distance(name, command_table()[i].name);
        if (distance < best) {
            best = distance;
            nearest = command_table()[i].name;
        }
    }
    return nearest;
}

// --- values --------------------------------------------------------------------------------------

/// Index of `word` among "a|b|c", or −1.
static int find_choice(const char *choices, const char *word, size_t length)
{
    int index = 0;
    for (const char *at = choices; at != NULL; index++) {
        size_t choice_length = strcspn(at, "|");
        if (choice_length == length && strncmp(at, word, length) == 0) {
            return index;
        }
        at = at[choice_length] == '|' ? at + choice_length + 1 : NULL;
    }
    return -1;
}

static int parse_choice(command_id command, const option *o, const char *text, size_t length,
                        option_value *value)
{
    value->choice = find_choice(o->choices, text, length);
    if (value->choice >= 0) {
        return EXIT_DONE;
    }
    if (find_choice(o->later_choices, text, length) >= 0) {
        return usage_error(command, "%s %.*s: not built yet; give %s", o->name, (int)length, text,
                           o->choices);
    }
    return usage_error(command, "%s: '%.*s' is not one of %s", o->name, (int)length, text,
                       o->choices);
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
        value->whole |= UINT64_C(1) << value->choice;
        at = at[length] == ',' ? at + length + 1 : NULL;
    }
    return EXIT_DONE;
}

static int parse_number(command_id command, const option *o, const char *text, option_value *value)
{
    char range[TEXT_SIZE];
    option_range(o, range, sizeof range);
    value->choice = find_choice(o->choices, text, strlen(text));
    if (value->choice >= 0) {
        return EXIT_DONE;
    }
    number_result result = NUMBER_OK;
    bool outside = false;
    if (o->kind == KIND_WHOLE) {
        bool negative =
            text[0] == '-' && number_parse_whole(text + 1, &value->whole) != NUMBER_NONE;
        result = negative ? NUMBER_TOO_LARGE : number_parse_whole(text, &value->whole);
        // as whole numbers: a double cannot hold all of them
        outside = value->whole < (uint64_t)o->minimum || value->whole > (uint64_t)o->maximum;
    } else if (o->kind == KIND_SIZE) {
        result = number_parse_size(text, &value->whole);
        outside = value->whole < (uint64_t)o->minimum || value->whole > (uint64_t)o->maximum;
    } else {
        result = number_parse_real(text, &value->real);
        outside = value->real < o->minimum || value->real > o->maximum;
    }
    if (result == NUMBER_NONE) {
        return usage_error(command, "%s: '%s' is not a %s; give %s", o->name, text,
                           o->kind == KIND_WHOLE  ? "whole number"
                           : o->kind == KIND_SIZE ? "size"
                                                  : "number",
                           range);
    }
    if (result == NUMBER_TOO_LARGE || outside) {
        return usage_error(command, "%s: %s is out of range; give %s", o->name, text, range);
    }
    return EXIT_DONE;
}

static int parse_value(command_id command, const option *o, const char *text, option_value *value)
{
    value->text = text;
    if (*text == '\0') {
        return usage_error(command, "%s needs a value: %s", o->name, o->value);
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
        return equals ? usage_error(command, "%s takes no value", o->name) : EXIT_DONE;
    }
    const char *text = equals ? equals + 1 : NULL;
    if (text == NULL) {
        const char *next = *at + 1 < count ? words[*at + 1] : NULL;
        if (next == NULL || option_find(command, next, strlen(next)) != NULL) {
            return usage_error(command, "%s needs a value: %s", o->name, o->value);
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

static const char *operand_names(command_id command)
{
    return command == COMMAND_COMPARE ? "two operands, A and B"
           : command == COMMAND_SH    ? "one image, ENV"
           : command == COMMAND_BENCH ? "one ROOM at most"
                                      : "one SCENE";
}

bool arguments_ask_for_help(int count, char **words)
{
    for (int i = 0; i < count && strcmp(words[i], "--") != 0; i++) {
        if (strcmp(words[i], "--help") == 0 || strcmp(words[i], "-h") == 0) {
            return true;
        }
    }
    return false;
}

int arguments_parse(command_id command, int count, char **words, command_line *parsed)
{
    *parsed = (command_line){.command = command, .words = words, .word_count = count};
    set_defaults(command, parsed);
    int operands = 0, wanted = command_operand_limit(command);
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
        } else {
            return usage_error(command, "takes %s; '%s' is one too many", operand_names(command),
                               words[i]);
        }
    }
    if (operands < command_table()[command].operand_count) {
        return usage_error(command, "needs %s", operand_names(command));
    }
    return EXIT_DONE;
}
