// SPDX-License-Identifier: MIT
#include "text_check.h"

#include "formats/text/json_spans.h"
#include "test_support.h"

#include <stdio.h>

typedef struct check {
    const char *old_text, *new_text;
    may_differ_fn *may_differ;
} check;

static bool same_bytes(const check *c, alpi_json_span a, alpi_json_span b)
{
    return a.end - a.begin == b.end - b.begin &&
           memcmp(c->old_text + a.begin, c->new_text + b.begin, a.end - a.begin) == 0;
}

static void require_same(const check *c, alpi_json_span a, alpi_json_span b, const char *what)
{
    if (!same_bytes(c, a, b)) {
        fail_msg("%s differs: \"%.*s\" became \"%.*s\"", what, (int)(a.end - a.begin),
                 c->old_text + a.begin, (int)(b.end - b.begin), c->new_text + b.begin);
    }
}

static void compare(const check *c, alpi_json_span a, alpi_json_span b, const char *name,
                    size_t depth) // recursion: our own small files
{
    char first = c->old_text[a.begin];
    if ((first != '{' && first != '[') || c->new_text[b.begin] != first) {
        if (!c->may_differ(name, depth)) {
            require_same(c, a, b, name);
        }
        return;
    }
    if (strcmp(name, "occlusionTexture") == 0 || strcmp(name, "alpenglow") == 0) {
        return;
    }
    alpi_json_cursor x = alpi_json_open(c->old_text, a), y = alpi_json_open(c->new_text, b);
    size_t old_at = a.begin + 1, new_at = b.begin + 1;
    while (alpi_json_next(&x)) {
        if (!alpi_json_next(&y)) {
            fail_msg("an item of %s is gone", name);
        }
        char key[64];
        snprintf(key, sizeof key, "%s", name);
        alpi_json_span old_start = x.is_object ? x.key : x.value;
        alpi_json_span new_start = y.is_object ? y.key : y.value;
        require_same(c, (alpi_json_span){old_at, old_start.begin},
                     (alpi_json_span){new_at, new_start.begin}, "a gap");
        if (x.is_object) {
            require_same(c, (alpi_json_span){x.key.begin, x.value.begin},
                         (alpi_json_span){y.key.begin, y.value.begin}, "a key");
            snprintf(key, sizeof key, "%.*s", (int)(x.key.end - x.key.begin) - 2,
                     c->old_text + x.key.begin + 1);
        }
        compare(c, x.value, y.value, key, depth + 1);
        old_at = x.value.end;
        new_at = y.value.end;
    }
    while (alpi_json_next(&y)) {
        new_at = y.value.end;
    }
    require_same(c, (alpi_json_span){old_at, a.end}, (alpi_json_span){new_at, b.end}, "an end");
}

void assert_text_kept(const char *old_text, size_t old_size, const char *new_text, size_t new_size,
                      may_differ_fn *may_differ)
{
    check c = {old_text, new_text, may_differ};
    alpi_json_span a, b;
    assert_true(alpi_json_value(old_text, 0, old_size, &a));
    assert_true(alpi_json_value(new_text, 0, new_size, &b));
    require_same(&c, (alpi_json_span){0, a.begin}, (alpi_json_span){0, b.begin}, "the beginning");
    compare(&c, a, b, "", 0);
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
    return (depth == 3 && strcmp(name, "byteLength") == 0) || // of the buffer (and of views)
           strcmp(name, "indices") == 0 || strcmp(name, "mode") == 0 ||
           strcmp(name, "material") == 0 || strcmp(name, "mesh") == 0 ||
           strcmp(name, "alpenglow") == 0;
}
