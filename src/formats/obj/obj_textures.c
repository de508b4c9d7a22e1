// SPDX-License-Identifier: MIT
// Texture statements of MTL files: options before and behind the name of the file.
#include "formats/obj/obj_materials.h"

#include "base/decimal.h"
#include "base/memory.h"

#include <string.h>

/// Options that do not count, and the words behind each.
static const struct {
    const char *name;
    int words;
} others[] = {{"-blendu", 1}, {"-blendv", 1},  {"-cc", 1},   {"-mm", 2},        {"-boost", 1},
              {"-texres", 1}, {"-imfchan", 1}, {"-type", 1}, {"-colorspace", 1}};

/// Those that count.
typedef struct options {
    float scale[3], offset[3], bump;
    bool clamped;
} options;

bool alpi_mtl_is_number(alpi_obj_word word)
{
    return word.size > 0 &&
           (word.text[0] == '-' || word.text[0] == '+' || word.text[0] == '.' ||
            (unsigned)(word.text[0] - '0') < 10) &&
           !(word.text[0] == '-' && (word.size == 1 || (word.text[1] | 0x20) >= 'a'));
}

/// Takes one to `count` numbers of an option; those that are not there stay. The last word of a
/// line is a name even where it begins as a number does.
static alp_result take_numbers(alpi_obj_text *t, const char *what, int count, float *values)
{
    for (int k = 0; k < count && alpi_obj_more(t); k++) {
        alpi_obj_text ahead = *t;
        const alpi_obj_word word = alpi_obj_take_word(&ahead);
        float value;
        const bool whole =
            alpi_decimal_float(word.text, word.text + word.size, &value) == word.text + word.size;
        if (!alpi_mtl_is_number(word) || (!whole && !alpi_obj_more(&ahead))) {
            break;
        }
        ALP_TRY(alpi_obj_take_float(t, what, &values[k]));
    }
    return ALP_OK;
}

/// Takes a known option. *taken: whether there was one.
static alp_result take_option(alpi_obj_text *t, options *o, bool *taken)
{
    const alpi_obj_text start = *t;
    const alpi_obj_word option = alpi_obj_take_word(t);
    float turbulence[3];
    *taken = true;
    if (alpi_obj_word_is(option, "-s")) {
        return take_numbers(t, "-s", 3, o->scale);
    }
    if (alpi_obj_word_is(option, "-o")) {
        return take_numbers(t, "-o", 3, o->offset);
    }
    if (alpi_obj_word_is(option, "-t")) {
        return take_numbers(t, "-t", 3, turbulence);
    }
    if (alpi_obj_word_is(option, "-bm")) {
        return take_numbers(t, "-bm", 1, &o->bump);
    }
    if (alpi_obj_word_is(option, "-clamp")) {
        o->clamped = alpi_obj_word_is(alpi_obj_take_word(t), "on");
        return ALP_OK;
    }
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        if (alpi_obj_word_is(option, others[i].name)) {
            for (int k = 0; k < others[i].words; k++) {
                (void)alpi_obj_take_word(t);
            }
            return ALP_OK;
        }
    }
    *taken = false;
    *t = start;
    return ALP_OK;
}

static alp_result take_options(alpi_obj_text *t, options *o)
{
    bool taken = true;
    while (taken && alpi_obj_more(t) && *t->at == '-') {
        ALP_TRY(take_option(t, o, &taken));
    }
    return ALP_OK;
}

// --- the name ------------------------------------------------------------------------------------

/// A reading of the rest of a statement.
typedef struct reading {
    alpi_obj_word name, place; // without and with quotes
    options options;
} reading;

static alpi_obj_word trim(alpi_obj_word word)
{
    while (word.size > 0 && (*word.text == ' ' || *word.text == '\t')) {
        word.text++;
        word.size--;
    }
    while (word.size > 0 && (word.text[word.size - 1] == ' ' || word.text[word.size - 1] == '\t')) {
        word.size--;
    }
    return word;
}

/// A name without the quotes around it.
static reading read_whole(alpi_obj_word rest, const options *o)
{
    reading r = {.name = trim(rest), .place = trim(rest), .options = *o};
    const size_t size = r.name.size;
    if (size > 2 && (*r.name.text == '"' || *r.name.text == '\'') &&
        r.name.text[size - 1] == *r.name.text) {
        r.name.text++;
        r.name.size -= 2;
    }
    return r;
}

/// A name with options behind it: those begin with the first known one after which there are only
/// options.
static bool read_trailing(const alpi_obj_text *t, alpi_obj_word rest, const options *o, reading *r)
{
    for (size_t i = 1; i + 1 < rest.size; i++) {
        const char *at = rest.text + i;
        if (*at != '-' || (at[-1] != ' ' && at[-1] != '\t')) {
            continue;
        }
        alpi_obj_text ahead = *t;
        options more = *o;
        ahead.at = at;
        ahead.end = rest.text + rest.size;
        if (take_options(&ahead, &more) == ALP_OK && !alpi_obj_more(&ahead)) {
            *r = read_whole((alpi_obj_word){rest.text, i}, &more);
            return r->name.size > 0;
        }
    }
    return false;
}

/// A name behind an option that nobody knows: with a word of its own if another follows.
static bool read_unknown(alpi_obj_word rest, const options *o, reading *r)
{
    const char *end = rest.text + rest.size, *at = rest.text;
    if (*at != '-') {
        return false;
    }
    for (int words = 0; words < 2; words++) {
        const char *next = at;
        while (next < end && *next != ' ' && *next != '\t') {
            next++;
        }
        if (next == end) {
            break;
        }
        at = next + 1;
    }
    *r = read_whole((alpi_obj_word){at, (size_t)(end - at)}, o);
    return at > rest.text && r->name.size > 0;
}

/// A name with a comment behind it.
static bool read_commented(alpi_obj_word rest, const options *o, reading *r)
{
    for (size_t i = 1; i < rest.size; i++) {
        if (rest.text[i] == '#' && (rest.text[i - 1] == ' ' || rest.text[i - 1] == '\t')) {
            *r = read_whole((alpi_obj_word){rest.text, i}, o);
            return r->name.size > 0;
        }
    }
    return false;
}

/// Finds the file of a reading.
static alp_result find_picture(alp_context *context, const char *folder, const char *from,
                               const reading *r, alpi_mtl_picture *picture)
{
    alpi_release(context, picture->path);
    picture->path = NULL;
    picture->found = ALPI_FOUND_NOTHING;
    picture->name = r->name;
    picture->place = r->place;
    picture->bump = r->options.bump;
    alpi_texture *texture = &picture->texture;
    texture->wrap_u = texture->wrap_v = r->options.clamped ? ALPI_WRAP_CLAMP : ALPI_WRAP_REPEAT;
    // The file reads w = o + s·w of w = 1 − v; ours is v' = 1 − o − s + s·v.
    texture->scale[0] = r->options.scale[0];
    texture->offset[0] = r->options.offset[0];
    texture->scale[1] = r->options.scale[1];
    texture->offset[1] = 1.0f - r->options.offset[1] - r->options.scale[1];
    if (r->name.size == 0 || r->name.text == NULL ||
        memchr(r->name.text, '\0', r->name.size) != NULL) {
        return ALP_OK;
    }
    char *name = alpi_format(context, "%.*s", (int)r->name.size, r->name.text);
    if (name == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    const alp_result result =
        alpi_find_file(context, folder, from, name, &picture->path, &picture->found);
    alpi_release(context, name);
    return result;
}

alp_result alpi_mtl_take_picture(alpi_obj_text *t, const char *folder, const char *from,
                                 alpi_mtl_picture *picture)
{
    enum { NAME_LIMIT = 1 << 16 };
    options o = {.scale = {1.0f, 1.0f, 1.0f}, .bump = 1.0f};
    *picture = (alpi_mtl_picture){.texture = alpi_texture_none(), .bump = 1.0f};
    ALP_TRY(take_options(t, &o));
    const alpi_obj_word rest = alpi_obj_take_rest(t);
    if (rest.size == 0 || rest.size > NAME_LIMIT) {
        return ALP_OK;
    }
    reading readings[4] = {read_whole(rest, &o)};
    size_t count = 1;
    count += read_trailing(t, rest, &o, &readings[count]);
    count += read_commented(rest, &o, &readings[count]);
    count += read_unknown(rest, &o, &readings[count]);
    for (size_t i = 0; i < count; i++) {
        ALP_TRY(find_picture(t->context, folder, from, &readings[i], picture));
        if (picture->found != ALPI_FOUND_NOTHING) {
            return ALP_OK;
        }
    }
    return count == 1 ? ALP_OK : find_picture(t->context, folder, from, &readings[1], picture);
}
