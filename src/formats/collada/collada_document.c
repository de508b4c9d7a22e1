// SPDX-License-Identifier: MIT
// Bytes → COLLADA document: archive, encoding, the limits of the scan, then libxml2.
#include "formats/collada/collada_document.h"

#include "base/file.h"
#include "base/memory.h"
#include "formats/collada/collada_ids.h"
#include "formats/files/outside.h"
#include "formats/text/utf16.h"

#include <libxml/parser.h>
#include <libxml/parserInternals.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

// --- archive and encoding ------------------------------------------------------------------------

/// The document of an archive: what its manifest names, else its first .dae.
static alp_result find_archived(alpi_collada_document *d, char **name)
{
    static const char begin[] = "<dae_root", end[] = "</dae_root";
    *name = NULL;
    uint8_t *manifest = NULL;
    size_t size = 0;
    if (alpi_archive_find_ending(d->archive, "manifest.xml") != NULL) {
        ALP_TRY(alpi_archive_read(d->archive, alpi_archive_find_ending(d->archive, "manifest.xml"),
                                  &manifest, &size));
        char *from = strstr((char *)manifest, begin); // a zero byte follows the last
        from = from != NULL ? strchr(from, '>') : NULL;
        const char *to = from != NULL ? strstr(from, end) : NULL;
        if (to != NULL) {
            from++;
            from += strspn(from, " \t\r\n");
            from += strncmp(from, "./", 2) == 0 ? 2 : 0;
            size_t length = to > from ? (size_t)(to - from) : 0;
            const char *part = memchr(from, '#', length); // an element may be named: all is read
            length = part != NULL ? (size_t)(part - from) : length;
            while (length > 0 && strchr(" \t\r\n", from[length - 1]) != NULL) {
                length--;
            }
            *name = alpi_format(d->context, "%.*s", (int)length, from);
            (void)(*name != NULL && alpi_uri_decode(*name)); // else there is none of that name
        }
        alpi_release(d->context, manifest);
    }
    if (*name == NULL) {
        const char *first = alpi_archive_find_ending(d->archive, ".dae");
        if (first == NULL) {
            return alpi_fail(d->context, ALP_ERROR_INVALID_DATA,
                             "%s: the archive holds no .dae document", d->path);
        }
        *name = alpi_copy_string(d->context, first);
    }
    return *name == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

static alp_result read_archive(alpi_collada_document *d)
{
    ALP_TRY(alpi_archive_open(d->context, d->path, d->file_bytes, d->file_size, &d->archive));
    char *name = NULL;
    ALP_TRY(find_archived(d, &name));
    alp_result result = alpi_archive_read(d->archive, name, &d->owned_text, &d->text_size);
    d->text = (const char *)d->owned_text;
    d->archive_folder = result == ALP_OK ? alpi_path_folder(d->context, name) : NULL;
    alpi_release(d->context, name);
    if (result == ALP_OK && d->archive_folder == NULL) {
        result = ALP_ERROR_OUT_OF_MEMORY;
    }
    return result;
}

/// UTF-16 is known by its mark, or by the zero beside the first "<".
static alp_result find_encoding(alpi_collada_document *d)
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

/// Encodings in which the bytes of "<", ">" and quotes stand for nothing else: only there do the
/// places of elements in the bytes mean what they mean to the parser.
static bool encoding_is_known(const char *name, size_t length)
{
    static const char *const known[] = {
        "utf-8", "us-ascii", "ascii",  "iso-8859-", "latin",   "windows-12", "cp12",  "shift_jis",
        "sjis",  "euc-",     "gb2312", "gbk",       "gb18030", "big5",       "koi8-", "utf8"};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (length >= strlen(known[i]) && strncasecmp(name, known[i], strlen(known[i])) == 0) {
            return true;
        }
    }
    return false;
}

static alp_result check_encoding(const alpi_collada_document *d)
{
    size_t head = d->text_size < 200 ? d->text_size : 200;
    const char *end = memchr(d->text, '>', head);
    if (d->encoding != ALPI_XML_BYTES || end == NULL || strncmp(d->text, "<?xml", 5) != 0) {
        return ALP_OK;
    }
    char declaration[201];
    snprintf(declaration, sizeof declaration, "%.*s", (int)(end - d->text), d->text);
    const char *name = strstr(declaration, "encoding");
    name = name != NULL ? strpbrk(name, "\"'") : NULL;
    if (name == NULL) {
        return ALP_OK;
    }
    const size_t length = strcspn(name + 1, "\"'");
    return encoding_is_known(name + 1, length)
               ? ALP_OK
               : alpi_fail(d->context, ALP_ERROR_UNSUPPORTED,
                           "%s: the encoding \"%.*s\" is not read; save it as UTF-8", d->path,
                           (int)length, name + 1);
}

// --- the parser ----------------------------------------------------------------------------------

/// A declared entity could expand without end: the scan refuses them, and here is the second lock.
static void refuse_entity(void *parser, const xmlChar *name, int type, const xmlChar *public_id,
                          const xmlChar *system_id, xmlChar *content)
{
    (void)name, (void)type, (void)public_id, (void)system_id, (void)content;
    xmlStopParser(parser);
}

/// The first fault is the one to tell of. What follows it would be told of too, one by one, and an
/// unclosed comment of a megabyte has a fault in every "--" that takes as long as all before it.
static void stop_at_fault(void *parser, xmlError *error)
{
    if (error->level == XML_ERR_FATAL) {
        xmlStopParser(parser);
    }
}

static alp_result fail_parse(const alpi_collada_document *d, xmlParserCtxt *parser)
{
    const xmlError *error = xmlCtxtGetLastError(parser);
    if (error == NULL || error->message == NULL) {
        return alpi_fail(d->context, ALP_ERROR_INVALID_DATA, "%s: is no XML", d->path);
    }
    if (error->code == XML_ERR_NO_MEMORY) {
        return alpi_fail(d->context, ALP_ERROR_OUT_OF_MEMORY, "%s: no memory for its XML tree",
                         d->path);
    }
    char reason[200];
    snprintf(reason, sizeof reason, "%s", error->message);
    reason[strcspn(reason, "\r\n")] = '\0';
    return alpi_fail(d->context, ALP_ERROR_INVALID_DATA,
                     "%s: XML, line %d column %d: %s; it may be truncated or damaged", d->path,
                     error->line, error->int2, reason);
}

static alp_result parse_text(alpi_collada_document *d)
{
    xmlParserCtxt *parser = xmlNewParserCtxt();
    if (parser == NULL) {
        return alpi_fail(d->context, ALP_ERROR_OUT_OF_MEMORY, "%s: no memory for the XML parser",
                         d->path);
    }
    parser->sax->entityDecl = refuse_entity;
    parser->sax->serror = stop_at_fault;
    // Not XML_PARSE_NOENT, DTDLOAD or XINCLUDE: nothing is expanded, nothing else is opened. HUGE
    // lifts limits that real arrays pass; the scan has set ours.
    const int options = XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING | XML_PARSE_HUGE |
                        XML_PARSE_NOBLANKS | XML_PARSE_COMPACT;
    const char *encoding = d->encoding == ALPI_XML_BYTES && !d->has_mark ? NULL : "UTF-8";
    d->tree = xmlCtxtReadMemory(parser, d->text, (int)d->text_size, NULL, encoding, options);
    alp_result result = d->tree != NULL ? ALP_OK : fail_parse(d, parser);
    xmlFreeParserCtxt(parser);
    return result;
}

/// The element after `node` in the order of the text.
static xmlNode *element_after(xmlNode *node)
{
    if (xmlFirstElementChild(node) != NULL) {
        return xmlFirstElementChild(node);
    }
    for (; node != NULL && node->type == XML_ELEMENT_NODE; node = node->parent) {
        if (xmlNextElementSibling(node) != NULL) {
            return xmlNextElementSibling(node);
        }
    }
    return NULL;
}

/// Gives each span its element. The two were found on their own, so names are compared.
static alp_result match_elements(alpi_collada_document *d)
{
    ALPI_TRY_NEW(d->context, d->elements, d->element_count);
    xmlNode *node = xmlDocGetRootElement(d->tree);
    uint32_t i = 0;
    for (; node != NULL && i < d->element_count; node = element_after(node), i++) {
        const char *tag = d->text + d->spans[i].begin + 1;
        const char *local = tag;
        const size_t length = strcspn(tag, " \t\r\n/>");
        for (size_t k = 0; k < length; k++) {
            local = tag[k] == ':' ? tag + k + 1 : local;
        }
        const size_t local_size = length - (size_t)(local - tag);
        if (d->encoding == ALPI_XML_BYTES && // names of other letters look different in the tree
            (strlen((const char *)node->name) != local_size ||
             memcmp(node->name, local, local_size) != 0) &&
            (unsigned char)*local < 0x80) {
            break;
        }
        // An index, no address. NOLINTNEXTLINE(performance-no-int-to-ptr)
        node->_private = (void *)(uintptr_t)i;
        d->elements[i] = node;
    }
    return node == NULL && i == d->element_count
               ? ALP_OK
               : alpi_fail(d->context, ALP_ERROR_INVALID_DATA,
                           "%s: its elements cannot be told apart in the text; save it as UTF-8",
                           d->path);
}

/// Lines at which the blocks of the text begin: a file may give cause for a million messages.
static alp_result count_lines(alpi_collada_document *d)
{
    const size_t count = d->text_size / ALPI_COLLADA_BLOCK + 1;
    uint32_t line = 1;
    ALPI_TRY_NEW(d->context, d->block_lines, count);
    for (size_t b = 0; b < count; b++) {
        const size_t begin = b * ALPI_COLLADA_BLOCK, left = d->text_size - begin;
        const size_t size = left < ALPI_COLLADA_BLOCK ? left : ALPI_COLLADA_BLOCK;
        d->block_lines[b] = line;
        for (size_t i = 0; i < size; i++) {
            line += d->text[begin + i] == '\n';
        }
    }
    return ALP_OK;
}

static alp_result check_root(const alpi_collada_document *d)
{
    if (!alpi_xml_is(d->root, "COLLADA")) {
        return alpi_collada_fail(d, d->root, "is XML but no COLLADA: its root must be <COLLADA>");
    }
    const char *version = alpi_xml_attribute(d->root, "version");
    if (version != NULL && strncmp(version, "1.4", 3) != 0 && strncmp(version, "1.5", 3) != 0) {
        return alpi_fail(d->context, ALP_ERROR_UNSUPPORTED,
                         "%s: COLLADA version %.20s; 1.4 and 1.5 are read", d->path, version);
    }
    return ALP_OK;
}

static alp_result fill_document(alpi_collada_document *d, const char *path)
{
    d->path = alpi_copy_string(d->context, path);
    d->folder = alpi_path_folder(d->context, path);
    if (d->path == NULL || d->folder == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    d->text = (const char *)d->file_bytes;
    d->text_size = d->file_size;
    if (alpi_archive_is(d->file_bytes, d->file_size)) {
        ALP_TRY(read_archive(d));
    }
    ALP_TRY(find_encoding(d));
    if (d->text_size > ALPI_COLLADA_TEXT_LIMIT) {
        return alpi_fail(d->context, ALP_ERROR_LIMIT, "%s: %zu bytes of XML, the limit is %llu",
                         path, d->text_size, (unsigned long long)ALPI_COLLADA_TEXT_LIMIT);
    }
    if (d->text_size == 0) {
        return alpi_fail(d->context, ALP_ERROR_INVALID_DATA, "%s: the file is empty", path);
    }
    ALP_TRY(check_encoding(d));
    bool whole = false;
    ALP_TRY(count_lines(d));
    ALP_TRY(alpi_collada_scan(d, &whole));
    ALP_TRY(parse_text(d));
    if (!whole) {
        return alpi_fail(d->context, ALP_ERROR_INVALID_DATA,
                         "%s: its tags cannot be followed; save it as UTF-8", path);
    }
    d->root = xmlDocGetRootElement(d->tree);
    ALP_TRY(match_elements(d));
    ALP_TRY(check_root(d));
    ALP_TRY(alpi_collada_index_ids(d));
    return alpi_collada_index_bindings(d);
}

// --- the document --------------------------------------------------------------------------------

alp_result alpi_collada_document_parse(alp_context *context, const char *path, uint8_t *bytes,
                                       size_t size, alpi_collada_document **document)
{
    *document = NULL;
    alpi_collada_document *d = ALPI_NEW(context, alpi_collada_document, 1);
    if (d == NULL) {
        alpi_release(context, bytes);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    d->context = context;
    d->file_bytes = bytes;
    d->file_size = size;
    alp_result result = fill_document(d, path);
    if (result != ALP_OK) {
        alpi_collada_document_destroy(d);
        return result;
    }
    *document = d;
    return ALP_OK;
}

alp_result alpi_collada_document_read(alp_context *context, const char *path,
                                      alpi_collada_document **document)
{
    uint8_t *bytes = NULL;
    size_t size = 0;
    *document = NULL;
    ALP_TRY(alpi_file_read(context, path, ALPI_COLLADA_TEXT_LIMIT, &bytes, &size));
    return alpi_collada_document_parse(context, path, bytes, size, document);
}

void alpi_collada_document_destroy(alpi_collada_document *d)
{
    if (d == NULL) {
        return;
    }
    alp_context *context = d->context;
    xmlFreeDoc(d->tree);
    alpi_archive_destroy(d->archive);
    void *const owned[] = {d->elements,
                           d->spans,
                           d->ids,
                           d->bounds,
                           d->block_lines,
                           d->archive_folder,
                           d->owned_text,
                           d->file_bytes,
                           d->folder,
                           d->path,
                           d};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) {
        alpi_release(context, owned[i]);
    }
}

alp_result alpi_collada_grow(alp_context *context, void *items, size_t *capacity, size_t count,
                             size_t size)
{
    void *grown = NULL;
    memcpy(&grown, items, sizeof grown); // items points to a typed pointer
    alp_result result = alpi_grow(context, &grown, capacity, count, size);
    memcpy(items, &grown, sizeof grown);
    return result;
}
