// SPDX-License-Identifier: MIT
#include "text_check.h"

#include "formats/text/json_spans.h"
#include "test_support.h"

#include <stdio.h>

typedef struct check {
    const char *old_text, *new_text;
    may_differ_fn *may_differ;
    size_t gone;     // elements of root arrays
    char fault[256]; // the last
} check;

/// Root arrays whose elements go where nothing reads them any more.
static bool may_lose(const char *name, size_t depth)
{
    static const char *const names[] = {"accessors", "buffers",  "bufferViews",
                                        "images",    "textures", "samplers"};
    bool found = false;
    for (size_t i = 0; depth == 1 && i < sizeof names / sizeof *names; i++) {
        found |= strcmp(name, names[i]) == 0;
    }
    return found;
}

static bool same(check *c, alpi_json_span a, alpi_json_span b, const char *what)
{
    if (a.end - a.begin == b.end - b.begin &&
        memcmp(c->old_text + a.begin, c->new_text + b.begin, a.end - a.begin) == 0) {
        return true;
    }
    snprintf(c->fault, sizeof c->fault, "%s differs: \"%.*s\" became \"%.*s\"", what,
             (int)(a.end - a.begin), c->old_text + a.begin, (int)(b.end - b.begin),
             c->new_text + b.begin);
    return false;
}

static bool compare(check *c, alpi_json_span a, alpi_json_span b, const char *name, size_t depth);

/// The elements that are left, in their order, then new ones.
static bool compare_rest(check *c, alpi_json_span a, alpi_json_span b, const char *name)
{
    alpi_json_cursor x = alpi_json_open(c->old_text, a), y = alpi_json_open(c->new_text, b);
    bool there = alpi_json_next(&y);
    while (alpi_json_next(&x)) {
        const bool found = there && compare(c, x.value, y.value, name, 2);
        c->gone += !found;
        there = found ? alpi_json_next(&y) : there;
    }
    return true;
}

/// A value and what lies in it. Recursion: our own small files.
static bool compare(check *c, alpi_json_span a, alpi_json_span b, const char *name, size_t depth)
{
    char first = c->old_text[a.begin];
    if ((first != '{' && first != '[') || c->new_text[b.begin] != first) {
        return c->may_differ(name, depth) || same(c, a, b, name);
    }
    if (strcmp(name, "occlusionTexture") == 0 || strcmp(name, "alpenglow") == 0) {
        return true;
    }
    if (may_lose(name, depth)) {
        return compare_rest(c, a, b, name);
    }
    alpi_json_cursor x = alpi_json_open(c->old_text, a), y = alpi_json_open(c->new_text, b);
    size_t old_at = a.begin + 1, new_at = b.begin + 1;
    while (alpi_json_next(&x)) {
        if (!alpi_json_next(&y)) {
            snprintf(c->fault, sizeof c->fault, "an item of %s is gone", name);
            return false;
        }
        char key[64];
        snprintf(key, sizeof key, "%s", name);
        alpi_json_span old_start = x.is_object ? x.key : x.value;
        alpi_json_span new_start = y.is_object ? y.key : y.value;
        if (!same(c, (alpi_json_span){old_at, old_start.begin},
                  (alpi_json_span){new_at, new_start.begin}, "a gap")) {
            return false;
        }
        if (x.is_object) {
            if (!same(c, (alpi_json_span){x.key.begin, x.value.begin},
                      (alpi_json_span){y.key.begin, y.value.begin}, "a key")) {
                return false;
            }
            snprintf(key, sizeof key, "%.*s", (int)(x.key.end - x.key.begin) - 2,
                     c->old_text + x.key.begin + 1);
        }
        if (!compare(c, x.value, y.value, key, depth + 1)) {
            return false;
        }
        old_at = x.value.end;
        new_at = y.value.end;
    }
    while (alpi_json_next(&y)) {
        new_at = y.value.end;
    }
    return same(c, (alpi_json_span){old_at, a.end}, (alpi_json_span){new_at, b.end}, "an end");
}

size_t assert_text_kept(const char *old_text, size_t old_size, const char *new_text,
                        size_t new_size, may_differ_fn *may_differ)
{
    check c = {.old_text = old_text, .new_text = new_text, .may_differ = may_differ};
    alpi_json_span a, b;
    assert_true(alpi_json_value(old_text, 0, old_size, &a));
    assert_true(alpi_json_value(new_text, 0, new_size, &b));
    if (!same(&c, (alpi_json_span){0, a.begin}, (alpi_json_span){0, b.begin}, "the beginning") ||
        !compare(&c, a, b, "", 0)) {
        fail_msg("%s", c.fault);
    }
    return c.gone;
}

bool patch_may_change(const char *name, size_t depth)
{
    static const char *const attributes[] = {"POSITION", "NORMAL",  "TANGENT",  "TEXCOORD_",
                                             "COLOR_",   "JOINTS_", "WEIGHTS_", "_"};
    for (size_t i = 0; i < sizeof attributes / sizeof *attributes; i++) {
        if (strncmp(name, attributes[i], strlen(attributes[i])) == 0) {
            return true;
        }
    }
    static const char *const numbers[] = {"byteOffset", "buffer", "bufferView", "source", "sampler",
                                          "index",      "input",  "output",     "values"};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        if (strcmp(name, numbers[i]) == 0) {
            return true; // others went before it
        }
    }
    return (depth == 3 && strcmp(name, "byteLength") == 0) || // of the buffer (and of views)
           strcmp(name, "indices") == 0 || strcmp(name, "mode") == 0 ||
           strcmp(name, "material") == 0 || strcmp(name, "mesh") == 0 ||
           strcmp(name, "alpenglow") == 0;
}
