// SPDX-License-Identifier: MIT
// Where the elements of an XML text stand. Runs before the parser, so it believes nothing: what it
// cannot follow it leaves to the parser, whose message says more. Also UTF-16, both ways.
// W3C. Extensible Markup Language (XML) 1.0, fifth edition, 2008.
#include "formats/collada/collada_document.h"

#include "base/memory.h"

#include <string.h>

typedef struct scan {
    alpi_collada_document *document;
    size_t at;
    size_t span_capacity;
    uint32_t depth;
    uint32_t open[ALPI_COLLADA_DEPTH_LIMIT]; // elements that are open
} scan;

/// Moves behind the next `what`; false when it does not come.
static bool skip_past(scan *s, const char *what)
{
    const alpi_collada_document *d = s->document;
    const size_t length = strlen(what);
    while (s->at < d->text_size) {
        const char *found = memchr(d->text + s->at, what[0], d->text_size - s->at);
        if (found == NULL) {
            return false;
        }
        s->at = (size_t)(found - d->text);
        if (d->text_size - s->at >= length && memcmp(found, what, length) == 0) {
            s->at += length;
            return true;
        }
        s->at++;
    }
    return false;
}

/// Moves behind the ">" of a tag; signs between quotes do not count. *quoted of them.
static bool skip_tag(scan *s, uint32_t *quoted)
{
    const alpi_collada_document *d = s->document;
    *quoted = 0;
    while (s->at < d->text_size) {
        const char c = d->text[s->at++];
        if (c == '>') {
            return true;
        }
        if (c == '"' || c == '\'') {
            const char quote[2] = {c, '\0'};
            if (!skip_past(s, quote)) {
                return false;
            }
            ++*quoted;
        }
    }
    return false;
}

static alp_result open_element(scan *s, size_t begin, bool *more)
{
    alpi_collada_document *d = s->document;
    uint32_t attributes;
    *more = skip_tag(s, &attributes);
    if (!*more) {
        return ALP_OK;
    }
    if (attributes > ALPI_COLLADA_ATTRIBUTE_LIMIT) {
        return alpi_fail(d->context, ALP_ERROR_LIMIT,
                         "%s: line %u: an element of %u attributes, more than %d; take some out",
                         d->path, alpi_collada_line_at(d, begin), attributes,
                         ALPI_COLLADA_ATTRIBUTE_LIMIT);
    }
    if (d->element_count >= ALPI_COLLADA_ELEMENT_LIMIT) {
        return alpi_fail(d->context, ALP_ERROR_LIMIT,
                         "%s: line %u: more than %d elements; split the document", d->path,
                         alpi_collada_line_at(d, begin), ALPI_COLLADA_ELEMENT_LIMIT);
    }
    void *spans = d->spans;
    ALP_TRY(alpi_grow(d->context, &spans, &s->span_capacity, d->element_count + 1,
                      sizeof(alpi_xml_span)));
    d->spans = spans;
    d->spans[d->element_count] = (alpi_xml_span){begin, s->at, s->at, s->at};
    if (d->text[s->at - 2] != '/') {
        if (s->depth >= ALPI_COLLADA_DEPTH_LIMIT) {
            return alpi_fail(d->context, ALP_ERROR_LIMIT,
                             "%s: line %u: elements are nested more than %d deep; flatten them",
                             d->path, alpi_collada_line_at(d, begin), ALPI_COLLADA_DEPTH_LIMIT);
        }
        s->open[s->depth++] = d->element_count;
    }
    d->element_count++;
    return ALP_OK;
}

static bool close_element(scan *s, size_t begin)
{
    if (s->depth == 0 || !skip_past(s, ">")) {
        return false;
    }
    alpi_xml_span *span = &s->document->spans[s->open[--s->depth]];
    span->close_begin = begin;
    span->end = s->at;
    return true;
}

/// <!DOCTYPE …>: without declarations inside it says nothing that we need.
static alp_result skip_doctype(scan *s, bool *more)
{
    const alpi_collada_document *d = s->document;
    const size_t begin = s->at;
    uint32_t quoted;
    *more = skip_tag(s, &quoted);
    const size_t size = (*more ? s->at : d->text_size) - begin;
    if (memchr(d->text + begin, '[', size) != NULL) {
        return alpi_fail(d->context, ALP_ERROR_UNSUPPORTED,
                         "%s: line %u: declarations of its own (<!DOCTYPE … [ … ]>) are not read; "
                         "take them out",
                         d->path, alpi_collada_line_at(d, begin));
    }
    return ALP_OK;
}

/// At a "<".
static alp_result scan_markup(scan *s, bool *more)
{
    const alpi_collada_document *d = s->document;
    const char *here = d->text + s->at;
    const size_t left = d->text_size - s->at, begin = s->at;
    if (left >= 4 && memcmp(here, "<!--", 4) == 0) {
        s->at += 4;
        *more = skip_past(s, "-->");
    } else if (left >= 9 && memcmp(here, "<![CDATA[", 9) == 0) {
        *more = skip_past(s, "]]>");
    } else if (left >= 2 && here[1] == '?') {
        *more = skip_past(s, "?>");
    } else if (left >= 2 && here[1] == '!') {
        return skip_doctype(s, more);
    } else if (left >= 2 && here[1] == '/') {
        *more = close_element(s, begin);
    } else {
        return open_element(s, begin, more);
    }
    return ALP_OK;
}

alp_result alpi_collada_scan(alpi_collada_document *document, bool *whole)
{
    scan s = {.document = document};
    bool more = true;
    while (more) {
        const char *next =
            memchr(document->text + s.at, '<', document->text_size - s.at); // content is skipped
        if (next == NULL) {
            break;
        }
        s.at = (size_t)(next - document->text);
        ALP_TRY(scan_markup(&s, &more));
    }
    *whole = more && s.depth == 0 && document->element_count > 0;
    return ALP_OK;
}

// --- UTF-16 --------------------------------------------------------------------------------------

static uint32_t unit_at(const uint8_t *bytes, size_t i, bool big)
{
    return (uint32_t)bytes[2 * i + (big ? 0 : 1)] << 8 | bytes[2 * i + (big ? 1 : 0)];
}

static size_t put_utf8(uint8_t *out, uint32_t code)
{
    static const uint8_t first[5] = {0, 0, 0xc0, 0xe0, 0xf0};
    const size_t length = code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
    for (size_t k = length - 1; k > 0; k--) {
        out[k] = (uint8_t)(0x80 | (code & 0x3f));
        code >>= 6;
    }
    out[0] = (uint8_t)(first[length] | code);
    return length;
}

alp_result alpi_utf16_decode(alp_context *context, const uint8_t *bytes, size_t size, bool big,
                             uint8_t **out, size_t *out_size)
{
    const size_t count = size / 2;
    ALPI_TRY_NEW(context, *out, 3 * count + 1); // a pair of units takes four bytes
    size_t at = 0;
    for (size_t i = 0; i < count; i++) {
        uint32_t code = unit_at(bytes, i, big);
        if (code >= 0xd800 && code < 0xdc00 && i + 1 < count) {
            const uint32_t low = unit_at(bytes, i + 1, big);
            if (low >= 0xdc00 && low < 0xe000) {
                code = 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00);
                i++;
            }
        }
        at += put_utf8(*out + at, code); // half a pair becomes what the parser refuses
    }
    *out_size = at;
    return ALP_OK;
}

/// The code at text[*at], which libxml2 has found to be UTF-8.
static uint32_t take_utf8(const char *text, size_t size, size_t *at)
{
    const uint8_t lead = (uint8_t)text[(*at)++];
    const int more = lead < 0xc0 ? 0 : lead < 0xe0 ? 1 : lead < 0xf0 ? 2 : 3;
    uint32_t code = more == 0 ? lead : lead & (0x3fu >> more);
    for (int k = 0; k < more && *at < size; k++) {
        code = code << 6 | ((uint8_t)text[(*at)++] & 0x3f);
    }
    return code;
}

static void put_unit(uint8_t *out, size_t *at, uint32_t unit, bool big)
{
    out[(*at)++] = (uint8_t)(big ? unit >> 8 : unit);
    out[(*at)++] = (uint8_t)(big ? unit : unit >> 8);
}

alp_result alpi_utf16_encode(alp_context *context, const char *text, size_t size, bool big,
                             uint8_t **out, size_t *out_size)
{
    ALPI_TRY_NEW(context, *out, 2 * size + 2);
    size_t at = 0;
    put_unit(*out, &at, 0xfeff, big);
    for (size_t i = 0; i < size;) {
        const uint32_t code = take_utf8(text, size, &i);
        if (code >= 0x10000) {
            put_unit(*out, &at, 0xd800 + ((code - 0x10000) >> 10), big);
            put_unit(*out, &at, 0xdc00 + ((code - 0x10000) & 0x3ff), big);
        } else {
            put_unit(*out, &at, code, big);
        }
    }
    *out_size = at;
    return ALP_OK;
}
