// SPDX-License-Identifier: MIT
// Pieces of XML text for the COLLADA writer.
#include "formats/collada/write/collada_patch.h"

#include <stdio.h>
#include <string.h>

uint32_t alpi_xml_end_index(const alpi_collada_document *d, const xmlNode *node)
{
    uint32_t i = alpi_xml_index(node) + 1;
    const size_t end = d->spans[i - 1].end;
    while (i < d->element_count && d->spans[i].begin < end) {
        i++;
    }
    return i;
}

/// One code of UTF-8, which libxml2 has found good.
static uint32_t next_code(const char **at)
{
    const unsigned char lead = (unsigned char)*(*at)++;
    const int more = lead < 0xc0 ? 0 : lead < 0xe0 ? 1 : lead < 0xf0 ? 2 : 3;
    uint32_t code = more == 0 ? lead : lead & (0x3fu >> more);
    for (int k = 0; k < more && **at != '\0'; k++) {
        code = code << 6 | ((unsigned char)*(*at)++ & 0x3f);
    }
    return code;
}

void alpi_xml_print_text(alpi_bytes *text, const char *utf8)
{
    while (*utf8 != '\0') {
        const uint32_t code = next_code(&utf8);
        if (code >= ' ' && code < 0x7f && strchr("<>&\"'", (int)code) == NULL) {
            const char plain = (char)code;
            alpi_bytes_add(text, &plain, 1);
        } else {
            alpi_bytes_print(text, "&#%u;", code);
        }
    }
}

void alpi_xml_print_index(alpi_bytes *text, uint32_t value)
{
    char digits[12];
    size_t at = sizeof digits;
    do {
        digits[--at] = (char)('0' + value % 10);
        value /= 10;
    } while (value > 0);
    digits[--at] = ' ';
    alpi_bytes_add(text, digits + at, sizeof digits - at);
}

// --- start tags ----------------------------------------------------------------------------------

static bool is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/// The parser has accepted the tag, so that only the places are to be found.
bool alpi_xml_find_value(const alpi_collada_document *d, const xmlNode *node, const char *name,
                         alpi_json_span *value)
{
    const alpi_xml_span *span = alpi_xml_span_of(d, node);
    size_t at = span->begin;
    while (at < span->open_end && !is_space(d->text[at])) {
        at++;
    }
    while (at < span->open_end) {
        while (at < span->open_end && is_space(d->text[at])) {
            at++;
        }
        const size_t begin = at;
        while (at < span->open_end && d->text[at] != '=' && !is_space(d->text[at])) {
            at++;
        }
        const size_t length = at - begin;
        while (at < span->open_end && d->text[at] != '"' && d->text[at] != '\'') {
            at++;
        }
        if (at >= span->open_end) {
            return false;
        }
        const char quote = d->text[at++];
        const size_t first = at;
        while (at < span->open_end && d->text[at] != quote) {
            at++;
        }
        if (length == strlen(name) && memcmp(d->text + begin, name, length) == 0) {
            *value = (alpi_json_span){first, at};
            return true;
        }
        at++;
    }
    return false;
}

/// Where the start tag ends without ">" or "/>".
static size_t tag_end(const alpi_collada_document *d, const alpi_xml_span *span)
{
    size_t end = span->open_end - 1;
    return end > span->begin && d->text[end - 1] == '/' ? end - 1 : end;
}

void alpi_xml_print_start(const alpi_collada_document *d, const xmlNode *node, const char *name,
                          const char *value, alpi_bytes *text)
{
    const alpi_xml_span *span = alpi_xml_span_of(d, node);
    alpi_json_span old;
    size_t at = span->begin;
    const bool there = name != NULL && alpi_xml_find_value(d, node, name, &old);
    if (there) {
        alpi_bytes_add(text, d->text + at, old.begin - at);
        alpi_bytes_add(text, value, strlen(value));
        at = old.end;
    }
    alpi_bytes_add(text, d->text + at, tag_end(d, span) - at);
    if (name != NULL && !there) {
        alpi_bytes_print(text, " %s=\"%s\"", name, value);
    }
    alpi_bytes_add(text, ">", 1);
}

void alpi_xml_print_end(const alpi_collada_document *d, const xmlNode *node, alpi_bytes *text)
{
    const char *tag = d->text + alpi_xml_span_of(d, node)->begin + 1;
    alpi_bytes_add(text, "</", 2);
    alpi_bytes_add(text, tag, strcspn(tag, " \t\r\n/>"));
    alpi_bytes_add(text, ">", 1);
}

// --- edits ---------------------------------------------------------------------------------------

void alpi_xml_insert(alpi_edits *edits, size_t place, const char *text)
{
    alpi_edits_replace(edits, (alpi_json_span){place, place}, "%s", text);
}

void alpi_xml_replace(const alpi_collada_document *d, alpi_edits *edits, const xmlNode *node,
                      const char *text)
{
    const alpi_xml_span *span = alpi_xml_span_of(d, node);
    alpi_edits_replace(edits, (alpi_json_span){span->begin, span->end}, "%s", text);
}

void alpi_xml_append(const alpi_collada_document *d, alpi_edits *edits, const xmlNode *node,
                     const xmlNode *before, const char *text)
{
    const alpi_xml_span *span = alpi_xml_span_of(d, node);
    if (before != NULL) {
        alpi_xml_insert(edits, alpi_xml_span_of(d, before)->begin, text);
        return;
    }
    if (span->open_end < span->end) {
        alpi_xml_insert(edits, span->close_begin, text);
        return;
    }
    alpi_bytes whole = alpi_bytes_create(edits->context); // of <a/>
    alpi_xml_print_start(d, node, NULL, NULL, &whole);
    alpi_bytes_add(&whole, text, strlen(text));
    alpi_xml_print_end(d, node, &whole);
    edits->inserted.failed |= whole.failed;
    if (!whole.failed) {
        alpi_xml_replace(d, edits, node, (const char *)whole.bytes);
    }
    alpi_bytes_destroy(&whole);
}
