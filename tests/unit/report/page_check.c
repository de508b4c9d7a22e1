// SPDX-License-Identifier: MIT
// What a page of HTML is held to: well-formed, self-contained; and the pictures in it.
#include "page_check.h"

#include "formats/formats.h"

#include <stdio.h>
#include <stdlib.h>

enum { DEPTH = 64, NAME = 32 };

/// Tags that are open, the outermost first.
typedef struct open_tags {
    char names[DEPTH][NAME];
    int depth;
} open_tags;

int page_count_of(const char *text, const char *wanted)
{
    int count = 0;
    for (const char *at = strstr(text, wanted); at != NULL; at = strstr(at + 1, wanted)) {
        count++;
    }
    return count;
}

/// Steps over one tag: name, attributes with quoted values, maybe a slash. @return what follows
static const char *read_tag(const char *at, open_tags *open)
{
    const bool closes = *at == '/';
    at += closes;
    const char *name = at;
    const size_t length = strcspn(at, " \n/>");
    assert_true(length > 0);
    at += length;
    while (*at == ' ' || *at == '\n') {
        at += strspn(at, " \n");
        at += strcspn(at, "=>/\"'<");
        assert_true(at[0] == '=' && at[1] == '"'); // every attribute has a quoted value
        at += 2;
        const size_t value = strcspn(at, "\"<");
        assert_int_equal(at[value], '"');
        at += value + 1;
    }
    if (closes) {
        assert_true(open->depth > 0 && open->depth <= DEPTH);
        open->depth -= 1;
        assert_int_equal(strlen(open->names[open->depth]), length);
        assert_memory_equal(open->names[open->depth], name, length);
    } else if (*at != '/') {
        assert_true(open->depth < DEPTH && length < NAME);
        snprintf(open->names[open->depth], NAME, "%.*s", (int)length, name);
        open->depth += 1;
    } else {
        at++;
    }
    assert_int_equal(*at, '>');
    return at + 1;
}

void page_check_form(const char *text)
{
    static const char doctype[] = "<!DOCTYPE html>\n";
    open_tags open = {.depth = 0};
    const char *at = text + sizeof doctype - 1;
    int roots = 0;
    assert_memory_equal(text, doctype, sizeof doctype - 1);
    while (*at != '\0') {
        if (*at == '<') {
            at = read_tag(at + 1, &open);
            roots += open.depth == 0;
        } else {
            assert_true(open.depth > 0 || *at == '\n');
            at++;
        }
    }
    assert_true(open.depth == 0 && roots == 1);
    static const char *const references[] = {"&lt;", "&gt;", "&amp;", "&quot;", "&#39;"};
    for (at = strchr(text, '&'); at != NULL; at = strchr(at + 1, '&')) {
        bool known = false;
        for (size_t i = 0; i < sizeof references / sizeof *references; i++) {
            known |= strncmp(at, references[i], strlen(references[i])) == 0;
        }
        assert_true(known);
    }
    for (const unsigned char *u = (const unsigned char *)text; *u != '\0'; u++) {
        assert_true(*u >= 0x20 || *u == '\n');
        const int follow = *u < 0x80 ? 0 : *u >= 0xF0 ? 3 : *u >= 0xE0 ? 2 : *u >= 0xC2 ? 1 : 9;
        assert_true(follow < 9);
        for (int i = 0; i < follow; i++) {
            assert_int_equal(*++u & 0xC0, 0x80);
        }
    }
}

void page_check_self_contained(const char *text)
{
    const int data = page_count_of(text, "=\"data:image/png;base64,");
    assert_int_equal(page_count_of(text, " src="), page_count_of(text, "<img "));
    assert_int_equal(page_count_of(text, " src=") + page_count_of(text, " href="), data);
    assert_int_equal(page_count_of(text, "url("), page_count_of(text, "url(#heat"));
    assert_int_equal(page_count_of(text, "<script") + page_count_of(text, "<link") +
                         page_count_of(text, "@import") + page_count_of(text, "<iframe") +
                         page_count_of(text, "<a "),
                     0);
    assert_int_equal(page_count_of(text, "http:") + page_count_of(text, "https:"),
                     1); // the name of XHTML
    ASSERT_HAS(text, "default-src 'none'");
}

static int digit_of(char c)
{
    return c >= 'A' && c <= 'Z'   ? c - 'A'
           : c >= 'a' && c <= 'z' ? c - 'a' + 26
           : c >= '0' && c <= '9' ? c - '0' + 52
           : c == '+'             ? 62
           : c == '/'             ? 63
                                  : -1;
}

alp_image *page_find_picture(alp_context *context, const char *text, const char *alt)
{
    char wanted[128];
    snprintf(wanted, sizeof wanted, "alt=\"%s\" src=\"data:image/png;base64,", alt);
    const char *at = strstr(text, wanted);
    assert_non_null(at);
    at += strlen(wanted);
    const size_t length = strcspn(at, "\"");
    assert_int_equal(length % 4, 0);
    uint8_t *bytes = malloc(length);
    size_t size = 0;
    for (size_t i = 0; i < length; i += 4) {
        uint32_t bits = 0;
        for (size_t k = 0; k < 4; k++) {
            bits = bits << 6 | (uint32_t)(at[i + k] == '=' ? 0 : digit_of(at[i + k]));
        }
        const size_t padding = (size_t)(at[i + 2] == '=') + (size_t)(at[i + 3] == '=');
        for (size_t k = 0; k < 3 - padding; k++) {
            bytes[size++] = (uint8_t)(bits >> (16 - 8 * k));
        }
    }
    alp_image *image = NULL;
    ASSERT_OK(context, alpi_png_decode(context, alt, bytes, size, &image));
    free(bytes);
    assert_in_range(image->info.channels, 3, 4);
    return image;
}
