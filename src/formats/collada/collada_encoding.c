// SPDX-License-Identifier: MIT
// The text of a document as the parser is to see it. UTF-16 becomes UTF-8. Files may hold bytes of
// another encoding than they state: these are mended, with a warning that names the first place.
// W3C. Extensible Markup Language (XML) 1.0, fifth edition, 2008: section 4.3.3, appendix F.
#include "formats/collada/collada_document.h"

#include "base/memory.h"
#include "formats/text/utf16.h"
#include "formats/text/utf8.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

// --- UTF-16 by its first bytes -------------------------------------------------------------------

/// UTF-16 is known by its mark, or by the zero beside the first "<".
alp_result alpi_collada_find_text(alpi_collada_document *d)
{
    const uint8_t *bytes = (const uint8_t *)d->text;
    const size_t size = d->text_size;
    if (size >= 3 && memcmp(bytes, "\xEF\xBB\xBF", 3) == 0) {
        d->has_mark = true;
        d->text += 3;
        d->text_size -= 3;
        return ALP_OK;
    }
    const bool little =
        size >= 4 && ((bytes[0] == 0xff && bytes[1] == 0xfe) || (bytes[0] == '<' && bytes[1] == 0));
    const bool big =
        size >= 4 && ((bytes[0] == 0xfe && bytes[1] == 0xff) || (bytes[0] == 0 && bytes[1] == '<'));
    if (!little && !big) {
        return ALP_OK;
    }
    d->encoding = little ? ALPI_XML_UTF16_LE : ALPI_XML_UTF16_BE;
    d->has_mark = bytes[0] >= 0xfe;
    const size_t skip = d->has_mark ? 2 : 0;
    uint8_t *text = NULL;
    alp_result result =
        alpi_utf16_decode(d->context, bytes + skip, size - skip, big, &text, &d->text_size);
    alpi_release(d->context, d->owned_text);
    d->owned_text = text;
    d->text = (const char *)text;
    return result;
}

// --- the stated encoding -------------------------------------------------------------------------

/// The value of encoding="" in the XML declaration; an empty one without it.
static alpi_xml_word find_stated(const alpi_collada_document *d)
{
    const char *end = memchr(d->text, '>', d->text_size < 200 ? d->text_size : 200);
    alpi_xml_word stated = {"", 0};
    if (end == NULL || d->text_size < 5 || memcmp(d->text, "<?xml", 5) != 0) {
        return stated;
    }
    for (const char *at = d->text; at + 8 < end && stated.size == 0; at++) {
        if (memcmp(at, "encoding", 8) == 0) {
            at += 8;
            while (at < end && *at != '"' && *at != '\'') {
                at++;
            }
            const char *close = at < end ? memchr(at + 1, *at, (size_t)(end - at - 1)) : NULL;
            stated = close != NULL ? (alpi_xml_word){at + 1, (size_t)(close - at - 1)} : stated;
            break;
        }
    }
    return stated;
}

static bool starts_with(alpi_xml_word name, const char *start)
{
    return name.size >= strlen(start) && strncasecmp(name.text, start, strlen(start)) == 0;
}

/// Encodings in which the bytes of "<", ">" and quotes stand for nothing else: only there do the
/// places of elements in the bytes mean what they mean to the parser.
static bool encoding_is_known(alpi_xml_word name)
{
    static const char *const known[] = {"iso-8859-", "latin",   "windows-12", "cp12",
                                        "shift_jis", "sjis",    "euc-",       "gb2312",
                                        "gbk",       "gb18030", "big5",       "koi8-"};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (starts_with(name, known[i])) {
            return true;
        }
    }
    return false;
}

/// UTF-8, stated or not, or ASCII, which is a part of it.
static bool encoding_is_utf8(alpi_xml_word name)
{
    return name.size == 0 || starts_with(name, "utf-8") || starts_with(name, "utf8") ||
           starts_with(name, "us-ascii") || starts_with(name, "ascii");
}

// --- Latin-1 in UTF-8 ----------------------------------------------------------------------------

/// Counts the bytes that are no UTF-8. @return the first of them, NULL without any
static const uint8_t *find_strays(const uint8_t *at, const uint8_t *end, size_t *count)
{
    const uint8_t *first = NULL;
    *count = 0;
    while (at < end) {
        const size_t length = alpi_utf8_length(at, end);
        if (length == 0) {
            first = first == NULL ? at : first;
            ++*count;
        }
        at += length > 0 ? length : 1;
    }
    return first;
}

static void warn_of_strays(const alpi_collada_document *d, const uint8_t *first, size_t count)
{
    const size_t place = (size_t)(first - (const uint8_t *)d->text);
    size_t column = 1;
    uint32_t line = 1;
    for (size_t i = 0; i < place; i++) {
        const bool ends = d->text[i] == '\n';
        line += ends;
        column = ends ? 1 : column + 1;
    }
    alpi_warn(d->context, "encoding", d->path,
              "line %u, column %zu: the byte 0x%02X is no UTF-8, which the file should hold; such "
              "bytes are read as Latin-1: %zu",
              line, column, *first, count);
}

/// Bytes that are no UTF-8 become the characters that they are in Latin-1.
static alp_result mend_strays(alpi_collada_document *d)
{
    const uint8_t *at = (const uint8_t *)d->text, *end = at + d->text_size;
    size_t count = 0;
    const uint8_t *first = find_strays(at, end, &count);
    if (first == NULL) {
        return ALP_OK;
    }
    warn_of_strays(d, first, count);
    uint8_t *mended = ALPI_NEW(d->context, uint8_t, d->text_size + count + 1);
    if (mended == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    size_t size = 0;
    while (at < end) {
        const size_t length = alpi_utf8_length(at, end);
        if (length == 0) {
            mended[size++] = (uint8_t)(0xc0 | *at >> 6);
            mended[size++] = (uint8_t)(0x80 | (*at & 0x3f));
        } else {
            memcpy(mended + size, at, length);
            size += length;
        }
        at += length > 0 ? length : 1;
    }
    alpi_release(d->context, d->owned_text);
    d->owned_text = mended;
    d->text = (const char *)mended;
    d->text_size = size;
    return ALP_OK;
}

alp_result alpi_collada_check_encoding(alpi_collada_document *d)
{
    const alpi_xml_word stated = find_stated(d);
    if (d->encoding != ALPI_XML_BYTES) {
        return ALP_OK;
    }
    if (starts_with(stated, "utf-16") || starts_with(stated, "utf16") ||
        starts_with(stated, "ucs-2")) { // as programs write that print a string of UTF-16 as UTF-8
        alpi_warn(d->context, "encoding", d->path,
                  "states the encoding \"%.*s\", but has one byte a character: read as UTF-8",
                  (int)stated.size, stated.text);
        d->is_utf8 = true;
    } else if (d->has_mark || encoding_is_utf8(stated)) {
        d->is_utf8 = true;
    } else if (!encoding_is_known(stated)) {
        return alpi_fail(d->context, ALP_ERROR_UNSUPPORTED,
                         "%s: the encoding \"%.*s\" is not read; save it as UTF-8", d->path,
                         (int)(stated.size < 60 ? stated.size : 60), stated.text);
    }
    return d->is_utf8 ? mend_strays(d) : ALP_OK;
}
