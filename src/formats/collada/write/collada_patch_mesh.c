// SPDX-License-Identifier: MIT
// The primitives of a geometry with an index more for each corner, into one new source for all of
// them, or three of sets that are blended. A primitive whose corners have two coordinates,
// or whose triangles lie on several pages, is written anew; polygons without either stay polygons.
#include "formats/collada/write/collada_patch_uvs.h"

#include "base/memory.h"

#include <stdio.h>
#include <string.h>

typedef struct work {
    alpi_collada_patcher *patcher;
    alpi_collada_class *class_of;
    uint32_t class_index;
    alpi_edits *edits;
    alpi_collada_uvs pool;
    uint32_t uv_number;   // set="" of the new input
    alpi_bytes source_id; // as it stands in an attribute
    char ending[64];      // of the ids inside a copy
    bool *rewritten;      // [elements of the geometry] whose text is gone; only of a copy
    bool again;           // sets of an earlier bake are taken anew
    const xmlNode *old_sources[ALPI_COLLADA_SETS]; // of them, which go; or NULL
} work;

/// One primitive while it is written.
typedef struct part {
    uint32_t surface; // of the scene
    xmlNode *element;
    alpi_collada_inputs inputs;
    alpi_collada_faces faces;
    alpi_collada_corners uvs;
    uint32_t page_count; // of different pages
    uint32_t new_offset;
    alpi_collada_own own; // of an earlier bake, whose place the new one takes
} part;

void alpi_collada_print_geometry_id(const alpi_collada_patcher *p, uint32_t class_index,
                                    alpi_bytes *text)
{
    const alpi_collada_class *c = &p->classes[class_index];
    const char *id = alpi_xml_attribute(c->geometry, "id");
    alpi_xml_print_text(text, id != NULL ? id : "");
    if (c->copied) {
        alpi_bytes_print(text, "-%s-%u", p->prefix, class_index);
    }
}

/// id of the source of set k: "ID", "ID-1", "ID-2".
static void print_source_id(const work *w, uint32_t k, alpi_bytes *text)
{
    alpi_bytes_print(text, "%s", (const char *)w->source_id.bytes);
    if (k > 0) {
        alpi_bytes_print(text, "-%u", k);
    }
}

static void print_source(const work *w, uint32_t k, alpi_bytes *text)
{
    alpi_bytes name = alpi_bytes_create(w->patcher->context);
    print_source_id(w, k, &name);
    text->failed |= name.failed;
    const char *id = name.failed ? "" : (const char *)name.bytes;
    alpi_bytes_print(text, "<source id=\"%s\"><float_array id=\"%s-array\" count=\"%u\">", id, id,
                     2 * w->pool.count);
    for (uint32_t i = 0; i < w->pool.count; i++) {
        alpi_bytes_add(text, " ", i > 0);
        alpi_bytes_float(text, w->pool.uvs[i][2 * k]);
        alpi_bytes_add(text, " ", 1);
        alpi_bytes_float(text, w->pool.uvs[i][2 * k + 1]);
    }
    alpi_bytes_print(text,
                     "</float_array><technique_common><accessor source=\"#%s-array\" count=\"%u\" "
                     "stride=\"2\"><param name=\"S\" type=\"float\"/><param name=\"T\" "
                     "type=\"float\"/></accessor></technique_common></source>",
                     id, w->pool.count);
    alpi_bytes_destroy(&name);
}

// --- primitives ----------------------------------------------------------------------------------

static void print_input(const work *w, const part *a, alpi_bytes *text)
{
    const uint32_t count =
        w->patcher->patch->corner_uvs != NULL ? alpi_collada_count_sets(w->patcher) : 0;
    for (uint32_t k = 0; k < count; k++) { // one index stands for all
        alpi_bytes_print(text, "<input semantic=\"TEXCOORD\" source=\"#");
        print_source_id(w, k, text);
        alpi_bytes_print(text, "\" offset=\"%u\" set=\"%u\"/>", a->new_offset, w->uv_number + k);
    }
}

static void print_corner(const work *w, const part *a, uint32_t corner, uint32_t uv,
                         alpi_bytes *text)
{
    const uint32_t *indices = a->faces.indices + (size_t)corner * a->inputs.stride;
    for (uint32_t k = 0; k < a->inputs.stride; k++) {
        alpi_xml_print_index(text, a->own.count > 0 && k == a->new_offset ? uv : indices[k]);
    }
    if (w->patcher->patch->corner_uvs != NULL && a->own.count == 0) {
        alpi_xml_print_index(text, uv);
    }
}

/// <p> or <h> with an index more for each of its corners.
static void rewrite_list(work *w, const part *a, const xmlNode *list, uint32_t *corner)
{
    const alpi_collada_document *d = w->patcher->document;
    const alpi_xml_span *span = alpi_xml_span_of(d, list);
    alpi_bytes text = alpi_bytes_create(w->patcher->context);
    uint64_t numbers = 0; // words of the text: the reader has counted the same
    for (const xmlNode *t = list->children; t != NULL; t = t->next) {
        const bool is_text = t->type == XML_TEXT_NODE || t->type == XML_CDATA_SECTION_NODE;
        const char *c = is_text && t->content != NULL ? (const char *)t->content : "";
        while (*(c += strspn(c, " \t\r\n")) != '\0') {
            c += strcspn(c, " \t\r\n");
            numbers++;
        }
    }
    const uint32_t count = (uint32_t)(numbers / a->inputs.stride);
    for (uint32_t i = 0; i < count; i++, ++*corner) {
        const uint32_t uv = a->uvs.of_corner[*corner];
        print_corner(w, a, *corner, uv == ALPI_NONE ? 0 : uv, &text);
    }
    w->edits->inserted.failed |= text.failed;
    if (!text.failed && text.size > 0) { // without the first space
        alpi_edits_replace(w->edits, (alpi_json_span){span->open_end, span->close_begin}, "%s",
                           (const char *)text.bytes + 1);
    }
    alpi_bytes_destroy(&text);
}

/// material="" of the element, where the symbol has become another.
static void name_symbol(work *w, const part *a, const alpi_collada_symbol *symbol)
{
    const alpi_collada_document *d = w->patcher->document;
    alpi_json_span value;
    if (symbol->old != NULL && strcmp(symbol->old, symbol->name) == 0) {
        return;
    }
    alpi_bytes text = alpi_bytes_create(w->patcher->context);
    const bool there = alpi_xml_find_value(d, a->element, "material", &value);
    if (!there) {
        const size_t begin = alpi_xml_span_of(d, a->element)->begin;
        value.begin = value.end = begin + strcspn(d->text + begin, " \t\r\n/>");
    }
    alpi_bytes_print(&text, "%s", there ? "" : " material=\"");
    alpi_xml_print_text(&text, symbol->name);
    alpi_bytes_print(&text, "%s", there ? "" : "\"");
    w->edits->inserted.failed |= text.failed;
    alpi_edits_replace(w->edits, value, "%s", text.failed ? "" : (const char *)text.bytes);
    alpi_bytes_destroy(&text);
}

/// Its text is gone: ids in it are not renamed.
static void mark_rewritten(work *w, const xmlNode *element)
{
    const uint32_t end = alpi_xml_end_index(w->patcher->document, element);
    const uint32_t base = alpi_xml_index(w->class_of->geometry);
    for (uint32_t i = alpi_xml_index(element); w->rewritten != NULL && i < end; i++) {
        w->rewritten[i - base] = true;
    }
    if (!w->class_of->copied) {
        alpi_collada_note_removed(w->patcher, element, w->patcher->removed);
    }
}

/// The element stays what it is.
static void extend_part(work *w, const part *a)
{
    uint32_t corner = 0;
    for (const xmlNode *e = alpi_xml_child(a->element, NULL); e != NULL;
         e = alpi_xml_next(e, NULL)) {
        if (alpi_xml_is(e, "p")) {
            rewrite_list(w, a, e, &corner);
        }
        const xmlNode *ring = alpi_xml_is(e, "ph") ? alpi_xml_child(e, NULL) : NULL;
        for (; ring != NULL; ring = alpi_xml_next(ring, NULL)) {
            if (alpi_xml_is(ring, "p") || alpi_xml_is(ring, "h")) {
                rewrite_list(w, a, ring, &corner);
            }
        }
    }
    alpi_bytes text = alpi_bytes_create(w->patcher->context);
    print_input(w, a, &text);
    w->edits->inserted.failed |= text.failed;
    if (!text.failed) {
        alpi_collada_place_input(w->patcher, w->edits, a->element, &a->own,
                                 (const char *)text.bytes);
    }
    for (uint32_t k = 0; k < a->own.count; k++) {
        mark_rewritten(w, a->own.inputs[k]);
    }
    alpi_bytes_destroy(&text);
}

/// An input of the element, with the ids of a copy.
static void print_old_input(const work *w, const xmlNode *input, alpi_bytes *text)
{
    const alpi_collada_document *d = w->patcher->document;
    const char *source = alpi_xml_attribute(input, "source");
    alpi_bytes value = alpi_bytes_create(w->patcher->context);
    alpi_xml_print_text(&value, source != NULL ? source : "");
    alpi_bytes_print(&value, "%s", w->class_of->copied ? w->ending : "");
    text->failed |= value.failed;
    if (!value.failed) {
        alpi_xml_print_start(d, input, "source", (const char *)value.bytes, text);
        alpi_xml_print_end(d, input, text);
    }
    alpi_bytes_destroy(&value);
}

/// Whether a polygon can stay one: no holes, all of it on the page, one coordinate at each corner.
static bool stays_whole(const work *w, const part *a, const alpi_collada_polygon *polygon,
                        uint32_t triangle, uint32_t page)
{
    const uint32_t first = w->patcher->scene->surfaces[a->surface].first_triangle;
    bool whole = polygon->corner_count > 0;
    for (uint32_t t = triangle; whole && t < triangle + polygon->triangle_count; t++) {
        whole = w->patcher->pages[first + t] == page;
        for (int k = 0; whole && k < 3 && a->uvs.of_triangle != NULL && a->uvs.of_corner != NULL;
             k++) {
            whole = a->uvs.of_triangle[t][k] == a->uvs.of_corner[a->faces.triangles[t][k]];
        }
    }
    return whole;
}

/// <vcount> and <p> of a page: polygons that stay whole, and triangles.
typedef struct piece_text {
    alpi_bytes counts, corners;
    uint32_t count;
} piece_text;

static void print_triangle(const work *w, const part *a, uint32_t t, piece_text *text)
{
    for (int k = 0; k < 3; k++) {
        print_corner(w, a, a->faces.triangles[t][k],
                     a->uvs.of_triangle != NULL ? a->uvs.of_triangle[t][k] : 0, &text->corners);
    }
    alpi_xml_print_index(&text->counts, 3);
    text->count++;
}

static void print_faces(const work *w, const part *a, uint32_t page, piece_text *text)
{
    const uint32_t first = w->patcher->scene->surfaces[a->surface].first_triangle;
    uint32_t t = 0;
    for (uint32_t i = 0; i < a->faces.polygon_count; i++) {
        const alpi_collada_polygon *polygon = &a->faces.polygons[i];
        if (stays_whole(w, a, polygon, t, page)) {
            for (uint32_t c = 0; c < polygon->corner_count; c++) {
                const uint32_t corner = polygon->first_corner + c;
                print_corner(w, a, corner, a->uvs.of_corner != NULL ? a->uvs.of_corner[corner] : 0,
                             &text->corners);
            }
            alpi_xml_print_index(&text->counts, polygon->corner_count);
            text->count++;
            t += polygon->triangle_count;
            continue;
        }
        for (const uint32_t end = t + polygon->triangle_count; t < end; t++) {
            if (w->patcher->pages[first + t] == page) {
                print_triangle(w, a, t, text);
            }
        }
    }
    for (; t < a->faces.triangle_count; t++) { // of other kinds
        if (w->patcher->pages[first + t] == page) {
            print_triangle(w, a, t, text);
        }
    }
}

/// Those of the element with the new one in its place.
static void print_inputs(const work *w, const part *a, alpi_bytes *text)
{
    const xmlNode *next = alpi_collada_next_input(w->patcher, a->element, &a->own);
    next = next == NULL && a->own.count > 0 ? a->own.inputs[0] : next;
    const xmlNode *input = alpi_xml_child(a->element, "input");
    for (; input != NULL; input = alpi_xml_next(input, "input")) {
        bool goes = false;
        for (uint32_t k = 0; k < a->own.count; k++) {
            goes |= a->own.inputs[k] == input;
        }
        if (input == next) {
            print_input(w, a, text);
        }
        if (!goes) {
            print_old_input(w, input, text);
        }
    }
    if (next == NULL) {
        print_input(w, a, text);
    }
}

/// Numbers without the space before the first.
static void add_numbers(alpi_bytes *text, const alpi_bytes *numbers)
{
    const size_t space = numbers->size > 0;
    alpi_bytes_add(text, space > 0 ? numbers->bytes + space : NULL, numbers->size - space);
}

/// What lies on one page, as <polylist> or <triangles>.
static void print_piece(const work *w, const part *a, uint32_t page, const char *symbol,
                        alpi_bytes *text)
{
    const char *name = a->faces.polygon_count > 0 ? "polylist" : "triangles";
    piece_text piece = {.counts = alpi_bytes_create(w->patcher->context),
                        .corners = alpi_bytes_create(w->patcher->context)};
    print_faces(w, a, page, &piece);
    alpi_bytes_print(text, "<%s count=\"%u\" material=\"", name, piece.count);
    alpi_xml_print_text(text, symbol);
    alpi_bytes_print(text, "\">");
    print_inputs(w, a, text);
    if (a->faces.polygon_count > 0) {
        alpi_bytes_print(text, "<vcount>");
        add_numbers(text, &piece.counts);
        alpi_bytes_print(text, "</vcount>");
    }
    alpi_bytes_print(text, "<p>");
    add_numbers(text, &piece.corners);
    alpi_bytes_print(text, "</p></%s>", name);
    text->failed |= piece.counts.failed || piece.corners.failed;
    alpi_bytes_destroy(&piece.counts);
    alpi_bytes_destroy(&piece.corners);
}

/// The element becomes one for each page.
static alp_result replace_part(work *w, const part *a)
{
    alpi_collada_patcher *p = w->patcher;
    alpi_bytes text = alpi_bytes_create(p->context);
    const uint32_t first = p->scene->surfaces[a->surface].first_triangle;
    const char *old = alpi_xml_attribute(a->element, "material");
    for (uint32_t page = 0; page < p->patch->page_count; page++) {
        bool used = false;
        for (uint32_t t = 0; t < a->faces.triangle_count && !used; t++) {
            used = p->pages[first + t] == page;
        }
        if (used) {
            alpi_collada_symbol *symbol = alpi_collada_get_symbol(
                p, w->class_of, old, page, a->surface - w->class_of->first_surface);
            if (symbol == NULL) {
                alpi_bytes_destroy(&text);
                return ALP_ERROR_OUT_OF_MEMORY;
            }
            symbol->input_set = w->uv_number;
            print_piece(w, a, page, symbol->name, &text);
        }
    }
    w->edits->inserted.failed |= text.failed;
    if (!text.failed) {
        alpi_xml_replace(p->document, w->edits, a->element, (const char *)text.bytes);
    }
    alpi_bytes_destroy(&text);
    mark_rewritten(w, a->element);
    return ALP_OK;
}

static bool lies_on_one_page(const alpi_collada_patcher *p, uint32_t surface)
{
    const alpi_surface *s = &p->scene->surfaces[surface];
    bool one = true;
    for (uint32_t i = 1; i < s->triangle_count; i++) {
        one &= p->pages[s->first_triangle + i] == p->pages[s->first_triangle];
    }
    return one;
}

static alp_result patch_part(work *w, part *a)
{
    alpi_collada_patcher *p = w->patcher;
    const uint32_t page =
        p->baked[a->surface] ? p->pages[p->scene->surfaces[a->surface].first_triangle] : ALPI_NONE;
    const char *old = alpi_xml_attribute(a->element, "material");
    const bool one_page = !p->baked[a->surface] || lies_on_one_page(p, a->surface);
    if (p->baked[a->surface] && p->patch->corner_uvs != NULL) {
        if (w->again) {
            alpi_collada_own_inputs(p, a->element, &a->own);
        }
        a->new_offset = a->own.count > 0 ? a->own.offset : a->inputs.stride;
        ALP_TRY(alpi_collada_read_faces(&p->reader, a->element, &a->inputs, &a->faces));
        ALP_TRY(alpi_collada_corners_create(p, &w->pool, a->surface, &a->faces, &a->uvs));
    } else if (!one_page) {
        ALP_TRY(alpi_collada_read_faces(&p->reader, a->element, &a->inputs, &a->faces));
        a->uvs.agreed = false;
    } else {
        a->uvs.agreed = true;
    }
    if (!one_page || !a->uvs.agreed) {
        return replace_part(w, a);
    }
    if (!p->baked[a->surface] && old == NULL) {
        return ALP_OK;
    }
    alpi_collada_symbol *symbol =
        alpi_collada_get_symbol(p, w->class_of, old, page, a->surface - w->class_of->first_surface);
    if (symbol == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    symbol->input_set = w->uv_number;
    if (p->patch->corner_uvs == NULL && a->inputs.uv_count > p->patch->kept_uv_set) {
        symbol->input_set = a->inputs.uv_numbers[p->patch->kept_uv_set];
    }
    if (p->baked[a->surface]) {
        name_symbol(w, a, symbol);
        if (p->patch->corner_uvs != NULL) {
            extend_part(w, a);
        }
    }
    return ALP_OK;
}

// --- geometries ----------------------------------------------------------------------------------

/// Ids inside a copy get an ending, and what refers to them.
static void rename_ids(work *w)
{
    const alpi_collada_patcher *p = w->patcher;
    const alpi_collada_document *d = p->document;
    const uint32_t first = alpi_xml_index(w->class_of->geometry);
    const uint32_t end = alpi_xml_end_index(d, w->class_of->geometry);
    for (uint32_t i = first; i < end; i++) {
        alpi_json_span value;
        if (w->rewritten[i - first]) {
            continue;
        }
        if (alpi_xml_find_value(d, d->elements[i], "id", &value)) {
            alpi_xml_insert(w->edits, value.end, w->ending);
        }
        const char *source = alpi_xml_attribute(d->elements[i], "source");
        if (source != NULL && source[0] == '#' &&
            alpi_xml_find_value(d, d->elements[i], "source", &value)) {
            const xmlNode *target = alpi_collada_find(d, source + 1);
            const uint32_t place = target != NULL ? alpi_xml_index(target) : ALPI_NONE;
            if (place >= first && place < end) {
                alpi_xml_insert(w->edits, value.end, w->ending);
            }
        }
    }
}

static void part_destroy(alp_context *context, part *a)
{
    alpi_collada_faces_destroy(context, &a->faces);
    alpi_collada_corners_destroy(context, &a->uvs);
}

/// Inputs of all primitives first: the new set is one past theirs, or a later one.
static alp_result find_number(work *w)
{
    alpi_collada_patcher *p = w->patcher;
    const xmlNode *mesh = alpi_xml_child(w->class_of->geometry, "mesh");
    uint64_t corners = 0;
    w->again = alpi_collada_takes_anew(p, w->class_of);
    w->uv_number = alpi_collada_sets_end(p, alpi_xml_child(mesh, "vertices"), NULL);
    for (const xmlNode *e = alpi_xml_child(mesh, NULL); e != NULL; e = alpi_xml_next(e, NULL)) {
        alpi_collada_own own = {.count = 0};
        if (!alpi_collada_is_primitive(e)) {
            continue;
        }
        if (w->again) {
            alpi_collada_own_inputs(p, e, &own);
        }
        const uint32_t end = alpi_collada_sets_end(p, e, &own);
        w->uv_number = end > w->uv_number ? end : w->uv_number;
    }
    for (uint32_t s = w->class_of->first_surface; s < w->class_of->surface_end; s++) {
        corners += 3 * (uint64_t)p->scene->surfaces[s].triangle_count;
    }
    if (w->again) {
        alpi_collada_own_sources(p, mesh, w->old_sources);
    }
    w->uv_number = alpi_collada_free_set(p, w->uv_number, alpi_collada_count_sets(p));
    return p->patch->corner_uvs != NULL ? alpi_collada_uvs_create(p->context, corners, &w->pool)
                                        : ALP_OK;
}

static alp_result patch_parts(work *w)
{
    alpi_collada_patcher *p = w->patcher;
    alp_result result = find_number(w);
    for (uint32_t s = w->class_of->first_surface; result == ALP_OK && s < w->class_of->surface_end;
         s++) {
        part a = {.surface = s, .element = p->origin->surfaces[s].primitive};
        result = alpi_collada_read_inputs(&p->reader, a.element, &a.inputs);
        if (result == ALP_OK) {
            result = patch_part(w, &a);
        }
        part_destroy(p->context, &a);
    }
    return result;
}

static alp_result patch_geometry(work *w)
{
    alpi_collada_patcher *p = w->patcher;
    alpi_bytes_print(&w->source_id, "%s-uv-%u", p->prefix, w->class_index);
    ALP_TRY(patch_parts(w));
    for (uint32_t k = 0; k < ALPI_COLLADA_SETS; k++) {
        if (w->old_sources[k] != NULL) {
            alpi_xml_replace(p->document, w->edits, w->old_sources[k], "");
            mark_rewritten(w, w->old_sources[k]);
        }
    }
    const xmlNode *vertices =
        alpi_xml_child(alpi_xml_child(w->class_of->geometry, "mesh"), "vertices");
    if (p->patch->corner_uvs != NULL && vertices != NULL) {
        alpi_bytes text = alpi_bytes_create(p->context);
        for (uint32_t k = 0; k < alpi_collada_count_sets(p); k++) {
            print_source(w, k, &text);
        }
        w->edits->inserted.failed |= text.failed;
        if (!text.failed) {
            alpi_xml_insert(w->edits, alpi_xml_span_of(p->document, vertices)->begin,
                            (const char *)text.bytes);
        }
        alpi_bytes_destroy(&text);
    }
    return w->edits->inserted.failed || w->source_id.failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

/// A copy goes right behind the geometry.
static alp_result add_copy(work *w)
{
    const alpi_collada_document *d = w->patcher->document;
    const alpi_xml_span *span = alpi_xml_span_of(d, w->class_of->geometry);
    alpi_bytes text = alpi_bytes_create(w->patcher->context);
    rename_ids(w);
    alp_result result = alpi_edits_apply(w->edits, (alpi_json_span){span->begin, span->end}, &text);
    if (result == ALP_OK) {
        alpi_xml_insert(&w->patcher->edits, span->end, (const char *)text.bytes);
    }
    alpi_bytes_destroy(&text);
    return result;
}

alp_result alpi_collada_patch_geometry(alpi_collada_patcher *p, uint32_t class_index)
{
    alpi_edits own = alpi_edits_create(p->context, p->document->text);
    work w = {.patcher = p,
              .class_of = &p->classes[class_index],
              .class_index = class_index,
              .edits = p->classes[class_index].copied ? &own : &p->edits,
              .source_id = alpi_bytes_create(p->context)};
    snprintf(w.ending, sizeof w.ending, "-%s-%u", p->prefix, class_index);
    alp_result result = ALP_OK;
    if (w.class_of->copied) {
        const uint32_t first = alpi_xml_index(w.class_of->geometry);
        p->endings = true;
        w.rewritten = ALPI_NEW(p->context, bool,
                               alpi_xml_end_index(p->document, w.class_of->geometry) - first);
        result = w.rewritten == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
    }
    if (result == ALP_OK) {
        result = patch_geometry(&w);
    }
    if (result == ALP_OK && w.class_of->copied) {
        result = add_copy(&w);
    }
    alpi_edits_destroy(&own);
    alpi_bytes_destroy(&w.source_id);
    alpi_release(p->context, w.rewritten);
    alpi_collada_uvs_destroy(p->context, &w.pool);
    return result;
}
