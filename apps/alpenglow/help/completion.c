// SPDX-License-Identifier: MIT
// Completions for each position of a command line, from the table of options.
#include "help/completion.h"

#include <stdio.h>
#include <string.h>

static const char small_letters[] = "abcdefghijklmnopqrstuvwxyz";
static const char capital_letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZ";

/// Appends a word to a list with blanks between. A word that does not fit is left out.
static void append(char *list, const char *word, size_t length)
{
    size_t used = strlen(list);
    if (used + length + 2 <= COMPLETION_TEXT_SIZE) {
        snprintf(list + used, COMPLETION_TEXT_SIZE - used, "%s%.*s", used > 0 ? " " : "",
                 (int)length, word);
    }
}

static bool is_word(const char *text, size_t length, const char *wanted)
{
    return strlen(wanted) == length && strncmp(text, wanted, length) == 0;
}

/// Reads one of the names of a value: DIR, FILE, PNG, OUT.glb, or a word to type such as "auto".
static void add_value(completion *c, const char *name, size_t length)
{
    size_t small = strspn(name, small_letters), capital = strspn(name, capital_letters);
    if (is_word(name, length, "DIR")) {
        c->folders = true;
    } else if (is_word(name, length, "FILE")) {
        c->any_file = true;
    } else if (is_word(name, length, "PNG")) {
        append(c->endings, "png", strlen("png"));
    } else if (small == length) {
        append(c->words, name, length);
    } else if (capital > 0 && name[capital] == '.' &&
               capital + 1 + strspn(name + capital + 1, small_letters) == length) {
        append(c->endings, name + capital + 1, length - capital - 1);
    }
}

completion completion_of_option(const option *o)
{
    completion c = {.list = o->kind == KIND_LIST};
    if (o->id == OPTION_JSON && o->kind == KIND_TEXT) {
        append(c.endings, "json", strlen("json"));
        return c;
    }
    // With choices, the value's name adds nothing.
    const char *names = o->choices != NULL ? o->choices : o->value;
    while (o->kind != KIND_FLAG && names != NULL) {
        size_t length = strcspn(names, "|");
        add_value(&c, names, length);
        names = names[length] == '|' ? names + length + 1 : NULL;
    }
    return c;
}

completion completion_of_operand(command_id command)
{
    completion c = {0};
    if (strncmp(command_table()[command].synopsis, "SCENE", strlen("SCENE")) == 0) {
        size_t count = 0;
        const char *const *scenes = builtin_scene_names(&count);
        for (size_t i = 0; i < count; i++) {
            append(c.words, scenes[i], strlen(scenes[i]));
        }
        append(c.endings, "glb gltf obj dae zae", strlen("glb gltf obj dae zae"));
    } else if (command == COMMAND_COMPARE) {
        static const char endings[] = "exr hdr png jpg jpeg glb gltf obj dae zae";
        append(c.endings, endings, strlen(endings));
    } else if (command == COMMAND_SH) {
        append(c.endings, "hdr exr", strlen("hdr exr"));
    } else if (command == COMMAND_WEB) {
        append(c.endings, "glb gltf", strlen("glb gltf"));
    }
    return c;
}

bool completion_offers(command_id command, const option *o)
{
    return o->id != OPTION_LATER && (o->commands & (1u << command)) != 0;
}

void completion_describe(const option *o, char *text, size_t size)
{
    // The first sentence. A full stop inside a name such as ao.exr has no blank behind it.
    size_t length = strcspn(o->help, "\n");
    const char *end = strstr(o->help, ". ");
    if (end != NULL && (size_t)(end - o->help) < length) {
        length = (size_t)(end - o->help);
    } else if (length > 0 && o->help[length - 1] == '.') {
        length--;
    }
    snprintf(text, size, "%.*s", (int)length, o->help);
}

void completion_put(const char *text, const char *special)
{
    for (; *text != '\0'; text++) {
        if (strchr(special, *text) != NULL) {
            putchar('\\');
        }
        putchar(*text);
    }
}

int completion_print(const char *shell)
{
    if (strcmp(shell, "bash") == 0) {
        completion_print_bash();
    } else if (strcmp(shell, "zsh") == 0) {
        completion_print_zsh();
    } else if (strcmp(shell, "fish") == 0) {
        completion_print_fish();
    } else if (*shell == '\0') {
        return usage_error(COMMAND_COUNT, "--completion needs a value: bash|zsh|fish");
    } else {
        return usage_error(COMMAND_COUNT, "--completion: '%s' is not one of bash|zsh|fish", shell);
    }
    return EXIT_DONE;
}
