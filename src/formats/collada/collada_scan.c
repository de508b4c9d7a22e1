// SPDX-License-Identifier: MIT
// Where the elements of an XML text stand. Runs before the parser, so it believes nothing: what it
// cannot follow it leaves to the parser, whose message says more.
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
