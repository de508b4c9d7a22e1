// SPDX-License-Identifier: MIT
// A COLLADA 1.4 or 1.5 document: its XML text as read, the tree that libxml2 makes of it, and where
// in the text every element stands. The reader makes a scene of it; the writer splices the text.
#ifndef ALPI_FORMATS_COLLADA_DOCUMENT_H
#define ALPI_FORMATS_COLLADA_DOCUMENT_H

#include "base/context.h"
#include "formats/collada/collada_archive.h"

#include <libxml/tree.h>

/// What one document may hold.
#define ALPI_COLLADA_TEXT_LIMIT ((uint64_t)1 << 30) // bytes
enum {
    ALPI_COLLADA_DEPTH_LIMIT = 1000,
    ALPI_COLLADA_ELEMENT_LIMIT = 1 << 24,
    ALPI_COLLADA_ATTRIBUTE_LIMIT = 100, // of one element: libxml2 compares each with each
    ALPI_COLLADA_BLOCK = 4096           // bytes of text in which lines are counted for a message
};

/// Where an element stands in the text; of <a/> the last three are the same.
typedef struct alpi_xml_span {
    size_t begin;       // its "<"
    size_t open_end;    // behind its start tag
    size_t close_begin; // the "<" of its end tag
    size_t end;         // behind it
} alpi_xml_span;

/// Characters of a text, not ended by a zero.
typedef struct alpi_xml_word {
    const char *text;
    size_t size;
} alpi_xml_word;

typedef enum alpi_xml_encoding {
    ALPI_XML_BYTES, // UTF-8, or what agrees with ASCII on < and >
    ALPI_XML_UTF16_LE,
    ALPI_XML_UTF16_BE
} alpi_xml_encoding;

typedef struct alpi_collada_document {
    alp_context *context;
    char *path;   // as given, for messages
    char *folder; // "dir/" of the file, "" for the working folder
    uint8_t *file_bytes;
    size_t file_size;
    alpi_archive *archive; // of a .zae, else NULL
    char *archive_folder;  // of the document inside the archive
    uint8_t *owned_text;   // inflated, or made from UTF-16; else NULL
    const char *text;      // the XML, in UTF-8 where it was UTF-16; without a byte-order mark
    size_t text_size;
    alpi_xml_encoding encoding;
    bool has_mark;
    bool is_utf8; // the text is, whatever its declaration says
    xmlDoc *tree;
    xmlNode *root;
    uint32_t element_count;
    xmlNode **elements; // [element_count] in the order of the text
    alpi_xml_span *spans;
    uint32_t id_count;
    struct alpi_collada_id *ids; // sorted by name
    uint32_t bound_count;
    struct alpi_collada_bound *bounds; // see collada_bindings.c
    uint32_t *block_lines;             // line at which each block of the text begins
} alpi_collada_document;

/// Reads a .dae or .zae. No network, no other file, no entity is ever opened or expanded.
/// @return ALP_OK; IO; INVALID_DATA; UNSUPPORTED (a DTD inside, an encoding); LIMIT; OUT_OF_MEMORY
alp_result alpi_collada_document_read(alp_context *context, const char *path,
                                      alpi_collada_document **document);
/// The same from bytes in memory, which the document takes over (also on failure).
alp_result alpi_collada_document_parse(alp_context *context, const char *path, uint8_t *bytes,
                                       size_t size, alpi_collada_document **document);
void alpi_collada_document_destroy(alpi_collada_document *document); // NULL does nothing

/// Bytes of a file that the document names: beside it, found as formats/files/find_file.h does, or
/// in its archive. Released by the caller.
alp_result alpi_collada_file_read(const alpi_collada_document *document, const char *uri,
                                  uint8_t **bytes, size_t *size);

/// The path below the document's folder of a file that it names, without escapes; NULL in *name
/// where it lies elsewhere. Released by the caller.
alp_result alpi_collada_file_name(const alpi_collada_document *document, const char *uri,
                                  char **name);
/// Notes a file that was not found as named.
alp_result alpi_collada_note_file(const alpi_collada_document *document, const char *uri);

/// Makes room for one more item of an array. @param items points to a typed pointer
alp_result alpi_collada_grow(alp_context *context, void *items, size_t *capacity, size_t count,
                             size_t size);

// --- collada_scan.c ------------------------------------------------------------------------------

/// Finds the spans of all elements, before the parser sees the text: depth and count are limited, a
/// DTD inside is refused. What is not well-formed is left to the parser: *whole is false.
alp_result alpi_collada_scan(alpi_collada_document *document, bool *whole);

// --- collada_encoding.c --------------------------------------------------------------------------

/// Finds the XML text in the bytes of the file: without a mark, and in UTF-8 where it was UTF-16.
alp_result alpi_collada_find_text(alpi_collada_document *document);
/// Checks the encoding that the text states, and mends bytes of Latin-1 in UTF-8.
/// @return ALP_OK; UNSUPPORTED (an encoding that is not read); OUT_OF_MEMORY
alp_result alpi_collada_check_encoding(alpi_collada_document *document);

// --- collada_parse.c -----------------------------------------------------------------------------

/// Makes the tree of the text.
/// @return ALP_OK; INVALID_DATA (line, column and the first cause); OUT_OF_MEMORY
alp_result alpi_collada_parse_text(alpi_collada_document *document);

// --- collada_tree.c: asking the tree -------------------------------------------------------------

/// An element's place in `elements`.
static inline uint32_t alpi_xml_index(const xmlNode *node)
{
    return (uint32_t)(uintptr_t)node->_private;
}
bool alpi_xml_is(const xmlNode *node, const char *name);
/// First child element of that name; any name where NULL. NULL when there is none.
xmlNode *alpi_xml_child(const xmlNode *node, const char *name);
xmlNode *alpi_xml_next(const xmlNode *node, const char *name); ///< next sibling of that name
/// A child of a child … : names end with NULL.
xmlNode *alpi_xml_descend(const xmlNode *node, const char *const *names);
/// Value of an attribute, NULL without it. Belongs to the tree.
const char *alpi_xml_attribute(const xmlNode *node, const char *name);
/// First piece of text inside an element, "" when there is none. Belongs to the tree.
const char *alpi_xml_text(const xmlNode *node);
/// Text without the white space around it; released by the caller.
char *alpi_xml_copy_text(alp_context *context, const xmlNode *node);

/// A name for people: name="", else id="", else `fallback`. Released by the caller.
char *alpi_collada_copy_name(alp_context *context, const xmlNode *node, const char *fallback);

/// The element with that id, NULL when there is none (or no id).
xmlNode *alpi_collada_find(const alpi_collada_document *document, const char *id);
/// The first <instance_material> with a name at an instance, or <bind_vertex_input> with a name at
/// an <instance_material>; NULL if there is none.
xmlNode *alpi_collada_bound_to(const alpi_collada_document *document, const xmlNode *owner,
                               const char *name);
/// The element that an attribute such as url="#id" refers to, of any kind; NULL if it is missing.
xmlNode *alpi_collada_target(const alpi_collada_document *document, const xmlNode *node,
                             const char *attribute);
/// The same, of one kind. INVALID_DATA where the attribute is missing or
/// nothing has that id, or it is no `name`. NULL in *target with ALP_OK: it names another file.
alp_result alpi_collada_resolve(const alpi_collada_document *document, const xmlNode *node,
                                const char *attribute, const char *name, xmlNode **target);
/// INVALID_DATA with path, line, element and the fault.
alp_result alpi_collada_fail(const alpi_collada_document *document, const xmlNode *node,
                             const char *format, ...) ALP_PRINTF(3, 4);
uint32_t alpi_collada_line(const alpi_collada_document *document, const xmlNode *node);
uint32_t alpi_collada_line_at(const alpi_collada_document *document, size_t place);
/// "box.dae: line 12, <geometry> "box"" for warnings.
enum { ALPI_COLLADA_OWNER_SIZE = 512 };
void alpi_collada_owner(const alpi_collada_document *document, const xmlNode *node,
                        char owner[ALPI_COLLADA_OWNER_SIZE]);

#endif
