// SPDX-License-Identifier: MIT
// Instances of baked geometries: which geometry they show, which materials they bind, and the set
// that the maps are read with. A node that <instance_node> shows several times with different maps
// is written out where it is shown.
#include "formats/collada/write/collada_patch.h"

#include "base/memory.h"

#include <string.h>

// --- one instance --------------------------------------------------------------------------------

static void print_set(const alpi_collada_patcher *p, const alpi_collada_symbol *symbol,
                      alpi_bytes *text)
{
    const uint32_t count = p->patch->set_uvs != NULL ? ALPI_COLLADA_SETS : 1;
    for (uint32_t k = 0; k < count; k++) {
        alpi_bytes_print(text,
                         "<bind_vertex_input semantic=\"%s\" input_semantic=\"TEXCOORD\" "
                         "input_set=\"%u\"/>",
                         alpi_collada_semantic(k), symbol->input_set + k);
    }
}

/// What an <instance_material> holds, without a set that an earlier bake bound.
static void print_bindings(const alpi_collada_patcher *p, const xmlNode *binding, alpi_bytes *text)
{
    for (const xmlNode *e = alpi_xml_child(binding, NULL); e != NULL; e = alpi_xml_next(e, NULL)) {
        const char *semantic = alpi_xml_attribute(e, "semantic");
        if (!alpi_collada_is_our_semantic(semantic)) {
            const alpi_xml_span *span = alpi_xml_span_of(p->document, e);
            alpi_bytes_add(text, p->document->text + span->begin, span->end - span->begin);
        }
    }
}

/// An <instance_material> for a symbol, in place of `old` where it is the same symbol.
static void print_material(const alpi_collada_patcher *p, const xmlNode *old,
                           const alpi_collada_symbol *symbol, const char *target, alpi_bytes *text)
{
    alpi_bytes value = alpi_bytes_create(p->context);
    alpi_bytes_print(&value, "#");
    alpi_xml_print_text(&value, target);
    const bool same = old != NULL && symbol->old != NULL && strcmp(symbol->old, symbol->name) == 0;
    text->failed |= value.failed;
    if (value.failed) {
        alpi_bytes_destroy(&value);
        return;
    }
    if (same) {
        alpi_xml_print_start(p->document, old, "target", (const char *)value.bytes, text);
    } else {
        alpi_bytes_print(text, "<instance_material symbol=\"");
        alpi_xml_print_text(text, symbol->name);
        alpi_bytes_print(text, "\" target=\"%s\">", (const char *)value.bytes);
    }
    print_bindings(p, old, text);
    print_set(p, symbol, text);
    if (same) {
        alpi_xml_print_end(p->document, old, text);
    } else {
        alpi_bytes_print(text, "</instance_material>");
    }
    alpi_bytes_destroy(&value);
}

/// Materials of the placement: those that are there are edited, new ones go to `added`.
static alp_result bind_materials(alpi_collada_patcher *p, uint32_t placement, alpi_edits *edits,
                                 alpi_bytes *added)
{
    const uint32_t first = p->first_surfaces[placement];
    const xmlNode *instance = p->origin->surfaces[first].instance;
    const alpi_collada_class *c = &p->classes[p->placement_class[placement]];
    for (uint32_t i = 0; i < c->symbol_count; i++) {
        const alpi_collada_symbol *symbol = &c->symbols[i];
        if (symbol->page == ALPI_NONE) {
            continue;
        }
        const char *target = NULL;
        ALP_TRY(alpi_collada_get_material(p, first + symbol->surface, symbol->page, &target));
        const xmlNode *old = alpi_collada_bound_to(p->document, instance, symbol->old);
        if (old == NULL || strcmp(symbol->old, symbol->name) != 0) {
            print_material(p, old, symbol, target, added);
            continue;
        }
        alpi_bytes text = alpi_bytes_create(p->context);
        print_material(p, old, symbol, target, &text);
        edits->inserted.failed |= text.failed;
        if (!text.failed) {
            alpi_xml_replace(p->document, edits, old, (const char *)text.bytes);
        }
        alpi_bytes_destroy(&text);
    }
    return added->failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}

/// Puts new <instance_material>s where the schema wants them.
static void add_materials(const alpi_collada_patcher *p, const xmlNode *instance,
                          const char *materials, alpi_edits *edits, alpi_bytes *inside)
{
    const xmlNode *bind = alpi_xml_child(instance, "bind_material");
    const xmlNode *common = alpi_xml_child(bind, "technique_common");
    if (common != NULL) {
        alpi_xml_append(p->document, edits, common, NULL, materials);
        return;
    }
    alpi_bytes text = alpi_bytes_create(p->context);
    alpi_bytes_print(
        &text, "<bind_material><technique_common>%s</technique_common></bind_material>", materials);
    edits->inserted.failed |= text.failed;
    const xmlNode *extra = alpi_xml_child(instance, "extra");
    if (text.failed) {
        // said above
    } else if (bind != NULL) {
        alpi_xml_replace(p->document, edits, bind, (const char *)text.bytes);
    } else if (extra != NULL) {
        alpi_xml_insert(edits, alpi_xml_span_of(p->document, extra)->begin,
                        (const char *)text.bytes);
    } else { // at the end
        alpi_bytes_add(inside, text.bytes, text.size);
    }
    alpi_bytes_destroy(&text);
}

alp_result alpi_collada_print_instance(alpi_collada_patcher *p, uint32_t placement,
                                       alpi_bytes *text)
{
    const xmlNode *instance = p->origin->surfaces[p->first_surfaces[placement]].instance;
    const alpi_xml_span *span = alpi_xml_span_of(p->document, instance);
    alpi_edits edits = alpi_edits_create(p->context, p->document->text);
    alpi_bytes added = alpi_bytes_create(p->context), inside = alpi_bytes_create(p->context);
    alpi_bytes url = alpi_bytes_create(p->context);
    alp_result result = bind_materials(p, placement, &edits, &added);
    if (result == ALP_OK && added.size > 0) {
        add_materials(p, instance, (const char *)added.bytes, &edits, &inside);
    }
    alpi_bytes_print(&url, "#");
    alpi_collada_print_geometry_id(p, p->placement_class[placement], &url);
    if (result == ALP_OK && (url.failed || inside.failed)) {
        result = ALP_ERROR_OUT_OF_MEMORY;
    }
    if (result == ALP_OK) {
        const bool copied = p->classes[p->placement_class[placement]].copied;
        alpi_xml_print_start(p->document, instance, copied ? "url" : NULL, (const char *)url.bytes,
                             text);
        result =
            alpi_edits_apply(&edits, (alpi_json_span){span->open_end, span->close_begin}, text);
        alpi_bytes_add(text, inside.bytes, inside.size);
        alpi_xml_print_end(p->document, instance, text);
    }
    alpi_edits_destroy(&edits);
    alpi_bytes_destroy(&added);
    alpi_bytes_destroy(&inside);
    alpi_bytes_destroy(&url);
    return result;
}

// --- nodes written out ---------------------------------------------------------------------------

/// An element whose text is being written.
typedef struct copying {
    uint32_t element, end; // next element inside it, one past the last
    size_t at, text_end;   // of the text
} copying;

typedef struct expansion {
    alpi_collada_patcher *patcher;
    copying *stack;
    size_t depth, capacity;
    uint32_t placement; // that comes next
    alpi_bytes text;
} expansion;

static alp_result push_copy(expansion *x, const xmlNode *node)
{
    const alpi_collada_document *d = x->patcher->document;
    const alpi_xml_span *span = alpi_xml_span_of(d, node);
    if (x->text.size > ALPI_COLLADA_TEXT_LIMIT) {
        return alpi_fail(x->patcher->context, ALP_ERROR_LIMIT,
                         "%s: with its repeated nodes written out it would have more than %llu "
                         "bytes; write .glb",
                         d->path, (unsigned long long)ALPI_COLLADA_TEXT_LIMIT);
    }
    ALP_TRY(alpi_collada_grow(x->patcher->context, &x->stack, &x->capacity, x->depth + 1,
                              sizeof *x->stack));
    x->stack[x->depth++] =
        (copying){alpi_xml_index(node), alpi_xml_end_index(d, node), span->begin, span->end};
    return ALP_OK;
}

static void copy_until(expansion *x, copying *from, size_t place)
{
    alpi_bytes_add(&x->text, x->patcher->document->text + from->at, place - from->at);
    from->at = place;
}

/// Leaves out the id of an element: the original keeps it.
static void copy_without_id(expansion *x, copying *from, const xmlNode *element)
{
    const alpi_collada_document *d = x->patcher->document;
    alpi_json_span value;
    if (alpi_xml_find_value(d, element, "id", &value)) {
        size_t begin = value.begin;
        while (strchr(" \t\r\n", d->text[begin - 1]) == NULL) { // back over id="
            begin--;
        }
        copy_until(x, from, begin - 1);
        from->at = value.end + 1;
    }
}

/// Skips the element and all in it; others come instead.
static void skip_element(const expansion *x, copying *from, const xmlNode *element)
{
    const alpi_collada_document *d = x->patcher->document;
    from->at = alpi_xml_span_of(d, element)->end;
    from->element = alpi_xml_end_index(d, element);
}

static alp_result copy_element(expansion *x, copying *from)
{
    const alpi_collada_patcher *p = x->patcher;
    const alpi_collada_document *d = p->document;
    const xmlNode *element = d->elements[from->element];
    const alpi_xml_span *span = alpi_xml_span_of(d, element);
    const bool shown = x->placement < p->origin->placement_count &&
                       p->origin->placements[x->placement].instance == element;
    if (alpi_xml_is(element, "instance_node")) {
        xmlNode *target = alpi_collada_target(d, element, "url");
        if (alpi_xml_is(target, "node")) {
            copy_until(x, from, span->begin);
            skip_element(x, from, element);
            return push_copy(x, target);
        }
    }
    if (shown && p->placement_class[x->placement++] != ALPI_NONE) {
        copy_until(x, from, span->begin);
        skip_element(x, from, element);
        return alpi_collada_print_instance(x->patcher, x->placement - 1, &x->text);
    }
    copy_without_id(x, from, element);
    from->element++;
    return ALP_OK;
}

/// The text of the nodes that `outer` brings in, whose first placement is `placement`.
static alp_result expand(alpi_collada_patcher *p, const xmlNode *outer, uint32_t placement)
{
    expansion x = {.patcher = p, .placement = placement, .text = alpi_bytes_create(p->context)};
    xmlNode *target = NULL;
    alp_result result = alpi_collada_resolve(p->document, outer, "url", "node", &target);
    if (result == ALP_OK && target != NULL) {
        result = push_copy(&x, target);
    }
    while (result == ALP_OK && x.depth > 0) {
        copying *top = &x.stack[x.depth - 1];
        if (top->element < top->end) {
            result = copy_element(&x, top);
        } else {
            copy_until(&x, top, top->text_end);
            x.depth--;
        }
    }
    result = result == ALP_OK && x.text.failed ? ALP_ERROR_OUT_OF_MEMORY : result;
    if (result == ALP_OK && target != NULL) {
        alpi_xml_replace(p->document, &p->edits, outer, (const char *)x.text.bytes);
    }
    alpi_release(p->context, x.stack);
    alpi_bytes_destroy(&x.text);
    return result;
}

// --- all instances -------------------------------------------------------------------------------

/// The <instance_material>s of an instance that was edited name their old materials no more.
static void note_rebound(alpi_collada_patcher *p, uint32_t placement)
{
    const xmlNode *instance = p->origin->placements[placement].instance;
    const alpi_collada_class *c = &p->classes[p->placement_class[placement]];
    for (uint32_t i = 0; i < c->symbol_count; i++) {
        const alpi_collada_symbol *symbol = &c->symbols[i];
        const xmlNode *old = alpi_collada_bound_to(p->document, instance, symbol->old);
        if (old != NULL && symbol->page != ALPI_NONE && strcmp(symbol->old, symbol->name) == 0) {
            p->rebound[alpi_xml_index(old)] = true;
        }
    }
}

/// Shown by the document's own nodes with one map only: edited where it stands.
static alp_result replace_instance(alpi_collada_patcher *p, uint32_t placement)
{
    const xmlNode *instance = p->origin->placements[placement].instance;
    alpi_bytes text = alpi_bytes_create(p->context);
    alp_result result = alpi_collada_print_instance(p, placement, &text);
    if (result == ALP_OK) {
        result = text.failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
    }
    if (result == ALP_OK) {
        alpi_xml_replace(p->document, &p->edits, instance, (const char *)text.bytes);
        note_rebound(p, placement);
    }
    alpi_bytes_destroy(&text);
    return result;
}

#define MARK_EXPANDED (UINT32_MAX - 1)

/// marks[instance]: 1 + its class (0: none) + 1, SHARED = several; marks[outer]: MARK_EXPANDED.
static void mark_expansions(const alpi_collada_patcher *p, uint32_t *marks)
{
    const alpi_collada_placement *placements = p->origin->placements;
    for (uint32_t i = 0; i < p->origin->placement_count; i++) {
        uint32_t *mark = &marks[alpi_xml_index(placements[i].instance)];
        const uint32_t own = p->placement_class[i] == ALPI_NONE ? 1 : p->placement_class[i] + 2;
        *mark = *mark == 0 || *mark == own ? own : ALPI_COLLADA_SHARED;
    }
    for (uint32_t i = 0; i < p->origin->placement_count; i++) {
        if (placements[i].outer != NULL &&
            marks[alpi_xml_index(placements[i].instance)] == ALPI_COLLADA_SHARED) {
            marks[alpi_xml_index(placements[i].outer)] = MARK_EXPANDED;
        }
    }
}

static alp_result patch_placement(alpi_collada_patcher *p, uint32_t i, const uint32_t *marks,
                                  bool *done)
{
    const alpi_collada_placement *placement = &p->origin->placements[i];
    const xmlNode *outer = placement->outer;
    if (outer != NULL && marks[alpi_xml_index(outer)] == MARK_EXPANDED) {
        bool *expanded = &done[alpi_xml_index(outer)];
        const bool first = !*expanded;
        *expanded = true;
        return first ? expand(p, outer, i) : ALP_OK;
    }
    bool *replaced = &done[alpi_xml_index(placement->instance)];
    if (p->placement_class[i] == ALPI_NONE || *replaced) {
        return ALP_OK;
    }
    *replaced = true;
    if (alpi_xml_is(placement->instance, "geometry")) {
        alpi_warn(p->context, "no-scene", p->document->path,
                  "has no visual scene that could bind a map: geometry %u gets coordinates only",
                  placement->mesh);
        return ALP_OK;
    }
    return replace_instance(p, i);
}

alp_result alpi_collada_patch_instances(alpi_collada_patcher *p)
{
    uint32_t *marks = ALPI_NEW(p->context, uint32_t, p->document->element_count);
    bool *done = ALPI_NEW(p->context, bool, p->document->element_count);
    alp_result result = marks == NULL || done == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
    if (result == ALP_OK) {
        mark_expansions(p, marks);
    }
    for (uint32_t i = 0; i < p->origin->placement_count && result == ALP_OK; i++) {
        result = patch_placement(p, i, marks, done);
    }
    alpi_release(p->context, marks);
    alpi_release(p->context, done);
    return result;
}
