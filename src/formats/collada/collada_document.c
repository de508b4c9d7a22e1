// SPDX-License-Identifier: MIT
// Bytes → COLLADA document: archive, encoding, the limits of the scan, then libxml2. Spans of the
// scan and elements of the tree are matched here.
#include "formats/collada/collada_document.h"

#include "base/file.h"
#include "base/memory.h"
#include "formats/collada/collada_ids.h"
#include "formats/files/outside.h"
#include "formats/text/utf16.h"

#include <stdio.h>
#include <string.h>

// --- archive -------------------------------------------------------------------------------------

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

// --- elements ------------------------------------------------------------------------------------

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
    ALP_TRY(alpi_collada_find_text(d));
    if (d->text_size > ALPI_COLLADA_TEXT_LIMIT) {
        return alpi_fail(d->context, ALP_ERROR_LIMIT, "%s: %zu bytes of XML, the limit is %llu",
                         path, d->text_size, (unsigned long long)ALPI_COLLADA_TEXT_LIMIT);
    }
    if (d->text_size == 0) {
        return alpi_fail(d->context, ALP_ERROR_INVALID_DATA, "%s: the file is empty", path);
    }
    bool whole = false;
    ALP_TRY(alpi_collada_check_encoding(d));
    ALP_TRY(count_lines(d));
    ALP_TRY(alpi_collada_scan(d, &whole));
    ALP_TRY(alpi_collada_parse_text(d));
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
