// SPDX-License-Identifier: MIT
// The word that new ids begin with: "alpenglow", or with a number behind it where a document holds
// that already.
#include "formats/collada/write/collada_patch.h"

#include <stdio.h>
#include <string.h>

static const char word[] = "alpenglow";
enum { NUMBERS = 64, MOST_DIGITS = 9 };

/// Numbers of our words in a text.
typedef struct numbers {
    bool used[NUMBERS]; // 0: the word alone
    uint32_t end;       // one past the highest
} numbers;

static const char *find_word(const char *text, const char *end)
{
    const size_t length = sizeof word - 1;
    while ((size_t)(end - text) >= length) {
        text = memchr(text, word[0], (size_t)(end - text) - length + 1);
        if (text == NULL || memcmp(text, word, length) == 0) {
            return text;
        }
        text++;
    }
    return NULL;
}

/// Moves behind the "-" of "alpenglow-" or "alpenglow2-". @return its number,
/// UINT32_MAX: it is none
static uint32_t read_word(const char **at, const char *end)
{
    uint32_t number = 0, digits = 0;
    *at += sizeof word - 1;
    for (; *at < end && **at >= '0' && **at <= '9' && digits < MOST_DIGITS; ++*at, digits++) {
        number = 10 * number + (uint32_t)(**at - '0');
    }
    const bool is_one = *at < end && **at == '-';
    *at += is_one;
    return is_one ? number : UINT32_MAX;
}

static void note_number(uint32_t number, numbers *known)
{
    known->end = number != UINT32_MAX && number >= known->end ? number + 1 : known->end;
    if (number < NUMBERS) {
        known->used[number] = true;
    }
}

/// Notes every such word of a text.
static void note_words(const char *text, size_t size, numbers *known)
{
    const char *end = text + size, *at = text;
    while ((at = find_word(at, end)) != NULL) {
        note_number(read_word(&at, end), known);
    }
}

/// The first one that is free: none, 2, 3 …
static void print_free(const numbers *known, char *prefix, size_t size)
{
    uint32_t number = known->used[0] ? 2 : 0;
    while (number > 0 && number < NUMBERS && known->used[number]) {
        number++;
    }
    number = number == NUMBERS && known->end > number ? known->end : number;
    snprintf(prefix, size, number == 0 ? "%s" : "%s%u", word, number);
}

static void note_name(const char *name, numbers *known)
{
    if (name != NULL) {
        note_words(name, strlen(name), known);
    }
}

void alpi_collada_choose_prefix(alpi_collada_patcher *p)
{
    static const char *const attributes[] = {"id", "sid", "symbol", "material", "name"};
    numbers known = {.end = 0};
    note_words(p->document->text, p->document->text_size, &known);
    for (uint32_t i = 0; i < p->document->element_count; i++) { // &#45; is a - too
        for (int k = 0; k < 5; k++) {
            note_name(alpi_xml_attribute(p->document->elements[i], attributes[k]), &known);
        }
    }
    note_name(p->patch->extras_json, &known);
    for (uint32_t i = 0; i < p->patch->page_count; i++) {
        note_name(p->patch->page_pngs != NULL ? p->image_names[i] : NULL, &known);
        note_name(p->patch->light != NULL ? p->light_names[i] : NULL, &known);
    }
    print_free(&known, p->prefix, sizeof p->prefix);
}

/// Notes the word that a name begins with, where what follows is what new names have too.
static void note_kind(const alpi_collada_patcher *p, const char *name, numbers *known)
{
    const struct {
        const char *name;
        bool made;
    } kinds[] = {{"uv-", p->patch->corner_uvs != NULL},
                 {"ao-", p->patch->page_pngs != NULL},
                 {"light-", p->patch->light != NULL},
                 {"effect-", p->made_count > 0},
                 {"material-", p->made_count > 0}};
    const char *end = name + strlen(name);
    if (find_word(name, end) != name) {
        return;
    }
    const uint32_t number = read_word(&name, end);
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        if (kinds[k].made && strncmp(name, kinds[k].name, strlen(kinds[k].name)) == 0) {
            note_number(number, known);
        }
    }
}

/// Notes the words that new names must not have. Names of the document that got endings may
/// come to be the same as others wherever the word stands in those, and so may symbols.
static void note_staying(const alpi_collada_patcher *p, numbers *known)
{
    static const char *const attributes[] = {"id", "sid", "symbol", "material"};
    for (uint32_t i = 0; i < p->document->element_count; i++) {
        for (int k = 0; k < 4 && !p->removed[i]; k++) {
            const char *name = alpi_xml_attribute(p->document->elements[i], attributes[k]);
            if (p->endings) {
                note_name(name, known);
            } else if (name != NULL && k < 2) {
                note_kind(p, name, known);
            }
        }
    }
}

void alpi_collada_settle_prefix(const alpi_collada_patcher *p, alpi_bytes *text)
{
    const size_t old = strlen(p->prefix);
    char prefix[sizeof p->prefix];
    numbers known = {.end = 0};
    note_staying(p, &known);
    print_free(&known, prefix, sizeof prefix);
    const size_t new = strlen(prefix);
    if (text->failed || text->size == 0 || new > old || strcmp(prefix, p->prefix) == 0) {
        return;
    }
    char *to = (char *)text->bytes, *from = to;
    const char *end = to + text->size, *at;
    while ((at = find_word(from, end)) != NULL) { // what it holds of the prefix is all ours
        const bool ours =
            (size_t)(end - at) > old && memcmp(at, p->prefix, old) == 0 && at[old] == '-';
        const size_t before = (size_t)(at - from), length = ours ? new : sizeof word - 1;
        memmove(to, from, before);
        memcpy(to + before, ours ? prefix : word, length);
        to += before + length;
        from += before + (ours ? old : sizeof word - 1);
    }
    memmove(to, from, (size_t)(end - from));
    to += end - from;
    *to = '\0';
    text->size = (size_t)(to - (char *)text->bytes);
}
