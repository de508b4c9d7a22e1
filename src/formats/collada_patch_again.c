// SPDX-License-Identifier: MIT
// Where the input of bake coordinates stands. In a document that was baked before its set is taken
// anew, where it is surely ours and nobody else reads it, so that sets do not pile up.
#include "formats/collada_patch.h"

#include "formats/collada_numbers.h"

#include <string.h>

enum { SET_LIMIT = 64 };

const xmlNode *alpi_collada_next_input(const alpi_collada_patcher *p, const xmlNode *primitive,
                                       const xmlNode *own)
{
    const xmlNode *input = p->patch->light != NULL ? alpi_xml_child(primitive, "input") : NULL;
    for (; input != NULL; input = alpi_xml_next(input, "input")) {
        const char *semantic = alpi_xml_attribute(input, "semantic");
        if (semantic != NULL && strcmp(semantic, "TEXCOORD") == 0) {
            return input != own ? input : NULL;
        }
    }
    return NULL;
}

void alpi_collada_place_input(const alpi_collada_patcher *p, alpi_edits *edits,
                              const xmlNode *primitive, const xmlNode *own, const char *text)
{
    const xmlNode *next = alpi_collada_next_input(p, primitive, own), *last = NULL;
    for (const xmlNode *input = alpi_xml_child(primitive, "input"); input != NULL;
         input = alpi_xml_next(input, "input")) {
        last = input;
    }
    if (next != NULL) {
        alpi_xml_insert(edits, alpi_xml_span_of(p->document, next)->begin, text);
    }
    if (own != NULL) {
        alpi_xml_replace(p->document, edits, own, next != NULL ? "" : text);
    } else if (next == NULL && last != NULL) {
        alpi_xml_insert(edits, alpi_xml_span_of(p->document, last)->end, text);
    }
}

/// Whether an id is "alpenglow-uv-3", "alpenglow2-uv-3" or one of these with the ending of a copy.
static bool is_our_source(const char *id)
{
    static const char word[] = "alpenglow", part[] = "-uv-";
    if (id == NULL || strncmp(id, word, sizeof word - 1) != 0) {
        return false;
    }
    id += sizeof word - 1;
    id += strspn(id, "0123456789");
    return strncmp(id, part, sizeof part - 1) == 0 &&
           strchr("0123456789", id[sizeof part - 1]) != NULL && id[sizeof part - 1] != '\0';
}

static bool read_number(const alpi_collada_document *document, const xmlNode *node,
                        const char *attribute, uint32_t *number)
{
    return alpi_collada_count(document, node, attribute, 0, 1 << 20, number) == ALP_OK;
}

/// Which sets something else than our maps reads; looked up once for all geometries.
static void find_foreign_sets(alpi_collada_patcher *p)
{
    const alpi_collada_document *d = p->document;
    for (uint32_t i = 0; !p->foreign_sets_known && i < d->element_count; i++) {
        const char *semantic = alpi_xml_attribute(d->elements[i], "semantic");
        uint32_t set = 0;
        if (alpi_xml_is(d->elements[i], "bind_vertex_input") && semantic != NULL &&
            strcmp(semantic, ALPI_COLLADA_BAKED_UV) != 0 &&
            read_number(d, d->elements[i], "input_set", &set)) {
            p->foreign_sets |= set < SET_LIMIT ? (uint64_t)1 << set : 0;
            p->foreign_set_end = set >= p->foreign_set_end ? set + 1 : p->foreign_set_end;
        }
    }
    p->foreign_sets_known = true;
}

static bool others_read(alpi_collada_patcher *p, uint32_t number)
{
    find_foreign_sets(p);
    return number >= SET_LIMIT || (p->foreign_sets >> number & 1) != 0;
}

uint32_t alpi_collada_free_set(alpi_collada_patcher *p, uint32_t number, uint32_t count)
{
    find_foreign_sets(p);
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t set = number + k;
        if (set < SET_LIMIT && (p->foreign_sets >> set & 1) != 0) {
            number = set + 1; // all of them behind it
            k = UINT32_MAX;
        }
    }
    return number >= SET_LIMIT && number < p->foreign_set_end ? p->foreign_set_end : number;
}

const xmlNode *alpi_collada_own_input(const alpi_collada_patcher *p, const xmlNode *primitive,
                                      uint32_t *number, uint32_t *offset)
{
    const xmlNode *found = NULL;
    const xmlNode *input = alpi_xml_child(primitive, "input");
    for (; input != NULL; input = alpi_xml_next(input, "input")) { // the highest set
        const char *semantic = alpi_xml_attribute(input, "semantic");
        uint32_t set;
        if (semantic == NULL || strcmp(semantic, "TEXCOORD") != 0) {
            continue;
        }
        if (!read_number(p->document, input, "set", &set)) {
            return NULL;
        }
        if (found == NULL || set > *number) {
            found = input;
            *number = set;
        }
    }
    const char *source = alpi_xml_attribute(found, "source");
    if (source == NULL || source[0] != '#' || !is_our_source(source + 1) ||
        !read_number(p->document, found, "offset", offset)) {
        return NULL;
    }
    input = alpi_xml_child(primitive, "input");
    for (; input != NULL; input = alpi_xml_next(input, "input")) { // its indices are its alone
        uint32_t other;
        if (input != found &&
            (!read_number(p->document, input, "offset", &other) || other == *offset)) {
            return NULL;
        }
    }
    return found;
}

bool alpi_collada_was_baked(const alpi_collada_document *d)
{
    const xmlNode *extra = alpi_xml_child(d->root, "extra");
    for (; extra != NULL; extra = alpi_xml_next(extra, "extra")) {
        const char *type = alpi_xml_attribute(extra, "type");
        if (type != NULL && strcmp(type, "alpenglow") == 0) {
            return true;
        }
    }
    return false;
}

/// Whether inputs of an element other than `own` name the same source.
static bool others_name_it(const xmlNode *element, const xmlNode *own, const char *url)
{
    const xmlNode *input = alpi_xml_child(element, "input");
    for (; input != NULL; input = alpi_xml_next(input, "input")) {
        const char *source = alpi_xml_attribute(input, "source");
        if (input != own && source != NULL && strcmp(source, url) == 0) {
            return true;
        }
    }
    return false;
}

/// The <source> of the geometry that only our inputs name: NULL where there are several.
static const xmlNode *find_source(const alpi_collada_patcher *p, const xmlNode *mesh)
{
    const char *url = NULL;
    for (const xmlNode *e = alpi_xml_child(mesh, NULL); e != NULL; e = alpi_xml_next(e, NULL)) {
        uint32_t set, offset;
        if (!alpi_collada_is_primitive(e)) {
            continue;
        }
        const xmlNode *own = alpi_collada_own_input(p, e, &set, &offset);
        const char *source = alpi_xml_attribute(own, "source");
        if (source == NULL || (url != NULL && strcmp(source, url) != 0)) {
            return NULL;
        }
        url = source;
        if (others_name_it(e, own, url)) {
            return NULL;
        }
    }
    const xmlNode *found = url != NULL ? alpi_collada_find(p->document, url + 1) : NULL;
    const bool removable = found != NULL && alpi_xml_is(found, "source") && found->parent == mesh &&
                           !others_name_it(alpi_xml_child(mesh, "vertices"), NULL, url);
    return removable ? found : NULL;
}

bool alpi_collada_find_own_set(alpi_collada_patcher *p, const alpi_collada_class *class_of,
                               uint32_t *number, const xmlNode **source)
{
    const xmlNode *mesh = alpi_xml_child(class_of->geometry, "mesh");
    *source = NULL;
    if (p->patch->corner_uvs == NULL || !alpi_collada_was_baked(p->document)) {
        return false;
    }
    uint32_t count = 0;
    for (const xmlNode *e = alpi_xml_child(mesh, NULL); e != NULL; e = alpi_xml_next(e, NULL)) {
        uint32_t set = 0, offset;
        if (!alpi_collada_is_primitive(e)) {
            continue;
        }
        if (alpi_collada_own_input(p, e, &set, &offset) == NULL || (count > 0 && set != *number)) {
            return false;
        }
        *number = set;
        count++;
    }
    for (uint32_t s = class_of->first_surface; s < class_of->surface_end; s++) {
        if (!p->baked[s]) {
            return false;
        }
    }
    if (count == 0 || count != class_of->surface_end - class_of->first_surface ||
        others_read(p, *number)) { // fewer surfaces: a primitive without triangles
        return false;
    }
    *source = find_source(p, mesh);
    return true;
}
