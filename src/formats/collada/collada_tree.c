// SPDX-License-Identifier: MIT
// Asking a COLLADA tree: children, attributes, text, ids, files that it names.
#include "base/file.h"
#include "base/memory.h"
#include "formats/collada/collada_ids.h"
#include "formats/files/find_file.h"
#include "formats/files/outside.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

bool alpi_xml_is(const xmlNode *node, const char *name)
{
    return node != NULL && node->type == XML_ELEMENT_NODE &&
           strcmp((const char *)node->name, name) == 0;
}

static xmlNode *first_of(xmlNode *node, const char *name)
{
    while (node != NULL &&
           !(name == NULL ? node->type == XML_ELEMENT_NODE : alpi_xml_is(node, name))) {
        node = node->next;
    }
    return node;
}

xmlNode *alpi_xml_child(const xmlNode *node, const char *name)
{
    return node == NULL ? NULL : first_of(node->children, name);
}

xmlNode *alpi_xml_next(const xmlNode *node, const char *name)
{
    return node == NULL ? NULL : first_of(node->next, name);
}

xmlNode *alpi_xml_descend(const xmlNode *node, const char *const *names)
{
    xmlNode *at = alpi_xml_child(node, names[0]);
    for (size_t i = 1; names[i] != NULL; i++) {
        at = alpi_xml_child(at, names[i]);
    }
    return at;
}

const char *alpi_xml_attribute(const xmlNode *node, const char *name)
{
    if (node == NULL || node->type != XML_ELEMENT_NODE) {
        return NULL;
    }
    for (const xmlAttr *a = node->properties; a != NULL; a = a->next) {
        if (a->ns == NULL && strcmp((const char *)a->name, name) == 0) {
            return a->children != NULL && a->children->content != NULL
                       ? (const char *)a->children->content
                       : "";
        }
    }
    return NULL;
}

const char *alpi_xml_text(const xmlNode *node)
{
    for (const xmlNode *at = node != NULL ? node->children : NULL; at != NULL; at = at->next) {
        if ((at->type == XML_TEXT_NODE || at->type == XML_CDATA_SECTION_NODE) &&
            at->content != NULL) {
            return (const char *)at->content;
        }
    }
    return "";
}

char *alpi_xml_copy_text(alp_context *context, const xmlNode *node)
{
    const char *text = alpi_xml_text(node);
    text += strspn(text, " \t\r\n");
    size_t length = strlen(text);
    while (length > 0 && strchr(" \t\r\n", text[length - 1]) != NULL) {
        length--;
    }
    return alpi_format(context, "%.*s", (int)length, text);
}

// --- ids -----------------------------------------------------------------------------------------

static int compare_ids(const void *left, const void *right)
{
    const alpi_collada_id *a = left, *b = right;
    const int order = strcmp(a->name, b->name);
    return order != 0 ? order : (a->element > b->element) - (a->element < b->element);
}

alp_result alpi_collada_index_ids(alpi_collada_document *d)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < d->element_count; i++) {
        count += alpi_xml_attribute(d->elements[i], "id") != NULL;
    }
    ALPI_TRY_NEW(d->context, d->ids, count);
    for (uint32_t i = 0; i < d->element_count; i++) {
        const char *id = alpi_xml_attribute(d->elements[i], "id");
        if (id != NULL) {
            d->ids[d->id_count++] = (alpi_collada_id){id, i};
        }
    }
    if (d->id_count > 0) {
        qsort(d->ids, d->id_count, sizeof *d->ids, compare_ids);
    }
    return ALP_OK;
}

xmlNode *alpi_collada_find(const alpi_collada_document *d, const char *id)
{
    uint32_t low = 0, high = d->id_count;
    while (id != NULL && low < high) { // the first that is not before id
        const uint32_t middle = low + (high - low) / 2;
        if (strcmp(d->ids[middle].name, id) < 0) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return id != NULL && low < d->id_count && strcmp(d->ids[low].name, id) == 0
               ? d->elements[d->ids[low].element]
               : NULL;
}

xmlNode *alpi_collada_target(const alpi_collada_document *d, const xmlNode *node,
                             const char *attribute)
{
    const char *url = alpi_xml_attribute(node, attribute);
    url = url != NULL ? url + strspn(url, " \t\r\n") : "";
    return alpi_collada_find(d, url[0] == '#' ? url + 1 : url);
}

alp_result alpi_collada_resolve(const alpi_collada_document *d, const xmlNode *node,
                                const char *attribute, const char *name, xmlNode **target)
{
    *target = NULL;
    const char *url = alpi_xml_attribute(node, attribute);
    if (url == NULL) {
        return alpi_collada_fail(d, node, "its %s is missing", attribute);
    }
    url += strspn(url, " \t\r\n");
    if (url[0] != '#' && strchr(url, '#') != NULL) {
        char owner[ALPI_COLLADA_OWNER_SIZE];
        alpi_collada_owner(d, node, owner);
        alpi_warn(d->context, "external", owner,
                  "\"%.100s\" lies in another document, which is not opened: it is left out", url);
        return ALP_OK;
    }
    const char *id = url[0] == '#' ? url + 1 : url; // some exporters leave the sign out
    xmlNode *found = alpi_collada_find(d, id);
    if (found == NULL) {
        return alpi_collada_fail(d, node, "its %s=\"%.100s\" names nothing in the document",
                                 attribute, url);
    }
    if (!alpi_xml_is(found, name)) {
        return alpi_collada_fail(d, node, "its %s=\"%.100s\" names a <%.40s> where a <%s> must be",
                                 attribute, url, (const char *)found->name, name);
    }
    *target = found;
    return ALP_OK;
}

// --- messages ------------------------------------------------------------------------------------

uint32_t alpi_collada_line_at(const alpi_collada_document *d, size_t place)
{
    const size_t block = place / ALPI_COLLADA_BLOCK;
    uint32_t line = d->block_lines[block];
    for (size_t i = block * ALPI_COLLADA_BLOCK; i < place; i++) {
        line += d->text[i] == '\n';
    }
    return line;
}

uint32_t alpi_collada_line(const alpi_collada_document *d, const xmlNode *node)
{
    return d->spans != NULL && alpi_xml_index(node) < d->element_count
               ? alpi_collada_line_at(d, d->spans[alpi_xml_index(node)].begin)
               : 1;
}

static void clean(char *text)
{
    for (char *c = text; *c != '\0'; c++) {
        *c = (unsigned char)*c < ' ' || *c == 0x7f ? ' ' : *c;
    }
}

/// Bytes of a text that fit into `most`, none of its characters cut.
static int fitting(const char *text, size_t most)
{
    size_t length = strnlen(text, most);
    while (length == most && length > 0 && ((unsigned char)text[length] & 0xc0) == 0x80) {
        length--;
        most--;
    }
    return (int)length;
}

void alpi_collada_owner(const alpi_collada_document *d, const xmlNode *node,
                        char owner[ALPI_COLLADA_OWNER_SIZE])
{
    const char *id = alpi_xml_attribute(node, "id");
    const char *name = (const char *)node->name, *shown = id != NULL ? id : "";
    const char *quote = id != NULL ? "\"" : "";
    snprintf(owner, ALPI_COLLADA_OWNER_SIZE, "%.*s: line %u, <%.*s>%s%s%.*s%s",
             fitting(d->path, 360), d->path, alpi_collada_line(d, node), fitting(name, 40), name,
             id != NULL ? " " : "", quote, fitting(shown, 60), shown, quote);
    clean(owner);
}

alp_result alpi_collada_fail(const alpi_collada_document *d, const xmlNode *node,
                             const char *format, ...)
{
    char owner[ALPI_COLLADA_OWNER_SIZE], reason[400];
    alpi_collada_owner(d, node, owner);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(reason, sizeof reason, format, arguments);
    va_end(arguments);
    clean(reason);
    return alpi_fail(d->context, ALP_ERROR_INVALID_DATA, "%s: %s", owner, reason);
}

// --- files ---------------------------------------------------------------------------------------

/// Escapes and the other slash, in place; a leading "./" goes. False for an escaped zero byte.
static bool decode_path(char *text)
{
    if (strncmp(text, "./", 2) == 0) {
        memmove(text, text + 2, strlen(text + 2) + 1);
    }
    for (char *c = text; (c = strchr(c, '\\')) != NULL;) {
        *c = '/';
    }
    return alpi_uri_decode(text);
}

/// The entry of the archive that a name stands for; NULL in *path where it names none.
static alp_result find_entry(const alpi_collada_document *d, const char *name, char **path)
{
    *path = NULL;
    if (!alpi_path_stays_below(name) || name[strcspn(name, ":/")] == ':') {
        return ALP_OK;
    }
    *path = alpi_format(d->context, "%s%s", d->archive_folder, name);
    return *path == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

/// The file that a uri stands for; NULL in *path where that is outside.
static alp_result find_file(const alpi_collada_document *d, const char *uri, char **path,
                            alpi_found *found)
{
    *path = NULL;
    *found = ALPI_FOUND_NOTHING;
    char *name = alpi_copy_string(d->context, uri);
    if (name == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = ALP_OK;
    if (decode_path(name)) {
        result = d->archive != NULL ? find_entry(d, name, path)
                                    : alpi_find_uri(d->context, d->folder, name, path, found);
    }
    alpi_release(d->context, name);
    return result;
}

/// The part of a path below the document's folder, or the archive's; NULL where it lies elsewhere.
static const char *path_below(const alpi_collada_document *d, const char *path)
{
    const char *folder = d->archive != NULL ? d->archive_folder : d->folder;
    const size_t length = strlen(folder);
    const bool below =
        path != NULL && strncmp(path, folder, length) == 0 && alpi_path_stays_below(path + length);
    return below ? path + length : NULL;
}

alp_result alpi_collada_file_name(const alpi_collada_document *d, const char *uri, char **name)
{
    char *path = NULL;
    alpi_found found;
    *name = NULL;
    ALP_TRY(find_file(d, uri, &path, &found));
    const char *below = path_below(d, path);
    if (below != NULL) {
        *name = alpi_copy_string(d->context, below);
    }
    alpi_release(d->context, path);
    return below != NULL && *name == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

alp_result alpi_collada_note_file(const alpi_collada_document *d, const char *uri)
{
    char *path = NULL, shown[256];
    alpi_found found;
    ALP_TRY(find_file(d, uri, &path, &found));
    const char *below = path_below(d, path);
    if (path != NULL) {
        snprintf(shown, sizeof shown, "%s", uri);
        clean(shown);
        alpi_note_found(d->context, shown, below != NULL ? below : path, found);
    }
    alpi_release(d->context, path);
    return ALP_OK;
}

alp_result alpi_collada_file_read(const alpi_collada_document *d, const char *uri, uint8_t **bytes,
                                  size_t *size)
{
    char *path = NULL;
    alpi_found found;
    *bytes = NULL;
    ALP_TRY(find_file(d, uri, &path, &found));
    if (path == NULL) {
        return alpi_fail(
            d->context, ALP_ERROR_UNSUPPORTED,
            alpi_path_is_foreign(uri)
                ? "%s: \"%.200s\" is a path of another machine: put the file beside "
                  "the document"
                : "%s: \"%.200s\" lies outside the document's folder; " ALPI_OUTSIDE_HINT
                  ": put it there and name it so",
            d->path, uri);
    }
    const alp_result result =
        d->archive != NULL ? alpi_archive_read(d->archive, path, bytes, size)
                           : alpi_file_read(d->context, path, ALPI_COLLADA_TEXT_LIMIT, bytes, size);
    alpi_release(d->context, path);
    return result;
}

char *alpi_collada_copy_name(alp_context *context, const xmlNode *node, const char *fallback)
{
    const char *name = alpi_xml_attribute(node, "name"), *id = alpi_xml_attribute(node, "id");
    name = name != NULL && name[0] != '\0' ? name : id != NULL && id[0] != '\0' ? id : fallback;
    char *copy = alpi_copy_string(context, name);
    for (char *c = copy; copy != NULL && *c != '\0'; c++) {
        *c = (unsigned char)*c < ' ' || *c == 0x7f ? ' ' : *c;
    }
    return copy;
}
