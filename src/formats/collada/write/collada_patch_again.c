// SPDX-License-Identifier: MIT
// Where the input of bake coordinates stands. In a document that was baked before its set, or
// the three that are blended, are taken anew, where they are surely ours and nobody else reads
// them, so that sets do not pile up.
#include "formats/collada/write/collada_patch.h"

#include "formats/collada/collada_numbers.h"

#include <string.h>

enum { SET_LIMIT = 64 };

static bool is_own(const alpi_collada_own *own, const xmlNode *input)
{
    bool found = false;
    for (uint32_t k = 0; own != NULL && k < own->count; k++) {
        found |= own->inputs[k] == input;
    }
    return found;
}

static bool is_texcoord(const xmlNode *input)
{
    const char *semantic = alpi_xml_attribute(input, "semantic");
    return semantic != NULL && strcmp(semantic, "TEXCOORD") == 0;
}

const xmlNode *alpi_collada_next_input(const alpi_collada_patcher *p, const xmlNode *primitive,
                                       const alpi_collada_own *own)
{
    const xmlNode *input = p->patch->light != NULL ? alpi_xml_child(primitive, "input") : NULL;
    for (; input != NULL; input = alpi_xml_next(input, "input")) {
        if (is_texcoord(input)) {
            return !is_own(own, input) ? input : NULL;
        }
    }
    return NULL;
}

void alpi_collada_place_input(const alpi_collada_patcher *p, alpi_edits *edits,
                              const xmlNode *primitive, const alpi_collada_own *own,
                              const char *text)
{
    const xmlNode *next = alpi_collada_next_input(p, primitive, own), *last = NULL;
    for (const xmlNode *input = alpi_xml_child(primitive, "input"); input != NULL;
         input = alpi_xml_next(input, "input")) {
        last = input;
    }
    if (next != NULL) {
        alpi_xml_insert(edits, alpi_xml_span_of(p->document, next)->begin, text);
    }
    for (uint32_t k = 0; k < own->count; k++) {
        alpi_xml_replace(p->document, edits, own->inputs[k], next == NULL && k == 0 ? text : "");
    }
    if (own->count == 0 && next == NULL && last != NULL) {
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

static bool is_our_input(const xmlNode *input)
{
    const char *source = alpi_xml_attribute(input, "source");
    return source != NULL && source[0] == '#' && is_our_source(source + 1);
}

static bool read_number(const alpi_collada_document *document, const xmlNode *node,
                        const char *attribute, uint32_t *number)
{
    return alpi_collada_count(document, node, attribute, 0, 1 << 20, number) == ALP_OK;
}

const char *alpi_collada_semantic(uint32_t k)
{
    static const char *const semantics[ALPI_COLLADA_SETS] = {
        ALPI_COLLADA_BAKED_UV, ALPI_COLLADA_BAKED_UV "_1", ALPI_COLLADA_BAKED_UV "_2"};
    return semantics[k];
}

bool alpi_collada_is_our_semantic(const char *semantic)
{
    bool ours = false;
    for (uint32_t k = 0; k < ALPI_COLLADA_SETS; k++) {
        ours |= semantic != NULL && strcmp(semantic, alpi_collada_semantic(k)) == 0;
    }
    return ours;
}

/// Which sets something else than our maps reads; looked up once for all geometries.
static void find_foreign_sets(alpi_collada_patcher *p)
{
    const alpi_collada_document *d = p->document;
    for (uint32_t i = 0; !p->foreign_sets_known && i < d->element_count; i++) {
        const char *semantic = alpi_xml_attribute(d->elements[i], "semantic");
        uint32_t set = 0;
        if (alpi_xml_is(d->elements[i], "bind_vertex_input") && semantic != NULL &&
            !alpi_collada_is_our_semantic(semantic) &&
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

/// The <input> of the highest set, where we wrote it; NULL else.
static const xmlNode *find_highest(const alpi_collada_patcher *p, const xmlNode *primitive)
{
    const xmlNode *found = NULL;
    uint32_t most = 0;
    const xmlNode *input = alpi_xml_child(primitive, "input");
    for (; input != NULL; input = alpi_xml_next(input, "input")) {
        uint32_t set;
        if (is_texcoord(input)) {
            if (!read_number(p->document, input, "set", &set)) {
                return NULL;
            }
            found = found == NULL || set > most ? input : found;
            most = set > most ? set : most;
        }
    }
    return is_our_input(found) ? found : NULL;
}

void alpi_collada_own_inputs(const alpi_collada_patcher *p, const xmlNode *primitive,
                             alpi_collada_own *own)
{
    const xmlNode *highest = find_highest(p, primitive);
    *own = (alpi_collada_own){.count = 0};
    if (highest == NULL || !read_number(p->document, highest, "offset", &own->offset)) {
        return;
    }
    const xmlNode *input = alpi_xml_child(primitive, "input");
    for (; input != NULL; input = alpi_xml_next(input, "input")) {
        uint32_t offset, set = 0;
        const bool known = read_number(p->document, input, "offset", &offset) &&
                           read_number(p->document, input, "set", &set);
        if (known && offset != own->offset) {
            continue;
        }
        if (!known || !is_texcoord(input) || !is_our_input(input) ||
            own->count == ALPI_COLLADA_SETS) { // others read the same indices
            own->count = 0;
            return;
        }
        own->numbers[own->count] = set;
        own->inputs[own->count++] = input;
    }
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
static bool others_name_it(const xmlNode *element, const alpi_collada_own *own, const char *url)
{
    const xmlNode *input = alpi_xml_child(element, "input");
    for (; input != NULL; input = alpi_xml_next(input, "input")) {
        const char *source = alpi_xml_attribute(input, "source");
        if (!is_own(own, input) && source != NULL && strcmp(source, url) == 0) {
            return true;
        }
    }
    return false;
}

/// The <source> of a geometry where only our inputs name it; NULL else.
static const xmlNode *find_source(const alpi_collada_patcher *p, const xmlNode *mesh,
                                  const char *url)
{
    const xmlNode *found = alpi_collada_find(p->document, url + 1);
    if (!alpi_xml_is(found, "source") || found->parent != mesh) {
        return NULL;
    }
    for (const xmlNode *e = alpi_xml_child(mesh, NULL); e != NULL; e = alpi_xml_next(e, NULL)) {
        alpi_collada_own own = {.count = 0};
        if (alpi_collada_is_primitive(e)) {
            alpi_collada_own_inputs(p, e, &own);
        }
        if (others_name_it(e, &own, url)) { // <vertices>, or a set of another number
            return NULL;
        }
    }
    return found;
}

void alpi_collada_own_sources(const alpi_collada_patcher *p, const xmlNode *mesh,
                              const xmlNode *sources[ALPI_COLLADA_SETS])
{
    const xmlNode *first = alpi_xml_child(mesh, NULL);
    alpi_collada_own own = {.count = 0};
    for (; first != NULL && own.count == 0; first = alpi_xml_next(first, NULL)) {
        if (alpi_collada_is_primitive(first)) {
            alpi_collada_own_inputs(p, first, &own);
        }
    }
    for (uint32_t k = 0; k < ALPI_COLLADA_SETS; k++) {
        sources[k] = NULL;
        if (k < own.count) {
            sources[k] = find_source(p, mesh, alpi_xml_attribute(own.inputs[k], "source"));
        }
        for (uint32_t i = 0; i < k; i++) {
            sources[k] = sources[i] == sources[k] ? NULL : sources[k];
        }
    }
}

/// Whether a primitive is baked now. @param next of the surfaces, which stand in the order of the
/// primitives; of those without triangles there is none
static bool is_baked(const alpi_collada_patcher *p, const alpi_collada_class *class_of,
                     const xmlNode *primitive, uint32_t *next)
{
    const bool found =
        *next < class_of->surface_end && p->origin->surfaces[*next].primitive == primitive;
    *next += found;
    return found && p->baked[*next - 1];
}

bool alpi_collada_takes_anew(alpi_collada_patcher *p, const alpi_collada_class *class_of)
{
    const xmlNode *e = alpi_xml_child(alpi_xml_child(class_of->geometry, "mesh"), NULL);
    uint32_t count = 0, next = class_of->first_surface;
    if (p->patch->corner_uvs == NULL || !alpi_collada_was_baked(p->document)) {
        return false;
    }
    for (; e != NULL; e = alpi_xml_next(e, NULL)) {
        alpi_collada_own own;
        if (!alpi_collada_is_primitive(e)) {
            continue;
        }
        alpi_collada_own_inputs(p, e, &own);
        if (is_baked(p, class_of, e, &next) != (own.count > 0)) {
            return false; // one that gets no map now needs its old one
        }
        for (uint32_t k = 0; k < own.count; k++, count++) {
            if (others_read(p, own.numbers[k])) {
                return false;
            }
        }
    }
    return count > 0;
}

uint32_t alpi_collada_sets_end(const alpi_collada_patcher *p, const xmlNode *element,
                               const alpi_collada_own *own)
{
    uint32_t end = 0, set;
    const xmlNode *input = alpi_xml_child(element, "input");
    for (; input != NULL; input = alpi_xml_next(input, "input")) {
        if (is_texcoord(input) && !is_own(own, input) &&
            read_number(p->document, input, "set", &set) && set >= end) {
            end = set + 1;
        }
    }
    return end;
}
