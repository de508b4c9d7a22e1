// SPDX-License-Identifier: MIT
// What nothing reads any more in a written document: copies of materials, textures, images,
// samplers, accessors, views, buffers. An earlier bake left it, and it bears our mark, or this bake
// made it useless: something read it before. Neither goes where something that we do not know has a
// number that could be its own. What nobody read in the document stays. Numbers of elements change
// where others went before them.
#include "formats/gltf/write/gltf_tidy.h"

#include "base/memory.h"
#include "formats/gltf/write/gltf_patch_sets.h"

#include <string.h>

static const char *const names[ALPI_GLTF_KIND_COUNT] = {
    [ALPI_GLTF_ACCESSORS] = "accessors",      [ALPI_GLTF_BUFFERS] = "buffers",
    [ALPI_GLTF_BUFFER_VIEWS] = "bufferViews", [ALPI_GLTF_IMAGES] = "images",
    [ALPI_GLTF_MATERIALS] = "materials",      [ALPI_GLTF_SAMPLERS] = "samplers",
    [ALPI_GLTF_TEXTURES] = "textures"};

/// Each behind those that name it.
static const alpi_gltf_kind order[] = {
    ALPI_GLTF_MATERIALS, ALPI_GLTF_TEXTURES,     ALPI_GLTF_IMAGES, ALPI_GLTF_SAMPLERS,
    ALPI_GLTF_ACCESSORS, ALPI_GLTF_BUFFER_VIEWS, ALPI_GLTF_BUFFERS};
enum { KINDS = sizeof order / sizeof *order, MARKED = 5 }; // the first five may bear marks

// --- what is there -------------------------------------------------------------------------------

static bool has_mark(json_t *item)
{
    return json_is_string(json_object_get(json_object_get(item, "extras"), "alpenglow"));
}

static alp_result list_kind(alpi_gltf_tidying *t, alpi_gltf_kind kind)
{
    json_t *items = json_object_get(t->tree, names[kind]);
    const size_t count = json_array_size(items);
    alpi_json_span array = {0};
    t->counts[kind] = count;
    ALPI_TRY_NEW(t->context, t->spans[kind], count);
    ALPI_TRY_NEW(t->context, t->ours[kind], count);
    ALPI_TRY_NEW(t->context, t->read[kind], count);
    ALPI_TRY_NEW(t->context, t->gone[kind], count);
    ALPI_TRY_NEW(t->context, t->moved[kind], count);
    alpi_json_find(t->text, t->root, names[kind], &array);
    alpi_json_cursor cursor = alpi_json_open(t->text, array);
    for (size_t i = 0; i < count && alpi_json_next(&cursor); i++) {
        t->spans[kind][i] = cursor.value;
        t->ours[kind][i] = has_mark(json_array_get(items, i));
    }
    return ALP_OK;
}

static bool owner_has(const alpi_gltf_tidying *t, bool *const list[ALPI_GLTF_KIND_COUNT],
                      const alpi_gltf_reference *r)
{
    return r->owner_kind != ALPI_GLTF_KIND_COUNT && list[r->owner_kind] != NULL &&
           r->owner < t->counts[r->owner_kind] && list[r->owner_kind][r->owner];
}

/// A view or buffer bears no mark: it is ours where elements of ours read it and no others do.
static void find_ours(alpi_gltf_tidying *t, alpi_gltf_kind kind)
{
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < t->references.count; i++) {
            const alpi_gltf_reference *r = &t->references.items[i];
            if (r->kind == kind && r->index < t->counts[kind] &&
                owner_has(t, t->ours, r) == (pass == 0)) {
                t->ours[kind][r->index] = pass == 0;
            }
        }
    }
}

/// The first element that may go or come to have another number: none before what something
/// unknown may name.
static size_t find_tail(const alpi_gltf_tidying *t, alpi_gltf_kind kind)
{
    size_t first = 0;
    for (size_t i = 0; i < t->references.pin_count && kind != ALPI_GLTF_BUFFERS; i++) {
        const size_t pin = t->references.pins[i];
        first = pin < t->counts[kind] && pin >= first ? pin + 1 : first;
    }
    return kind == ALPI_GLTF_BUFFERS && t->references.buffers_are_named ? t->counts[kind] : first;
}

static void decide(alpi_gltf_tidying *t, alpi_gltf_kind kind, size_t first)
{
    bool *gone = t->gone[kind];
    for (size_t i = first; i < t->counts[kind]; i++) {
        gone[i] = t->ours[kind][i] || t->read[kind][i];
    }
    for (size_t i = 0; i < t->references.count; i++) {
        const alpi_gltf_reference *r = &t->references.items[i];
        if (r->kind == kind && r->index < t->counts[kind] && !owner_has(t, t->gone, r)) {
            gone[r->index] = false;
        }
    }
    for (size_t i = 0, at = 0; i < t->counts[kind]; i++) {
        t->moved[kind][i] = at;
        at += !gone[i];
    }
}

// --- sets that are blended no more ---------------------------------------------------------------

static bool has_maps(json_t *blend)
{
    json_t *earlier = json_object_get(blend, ALPI_GLTF_EARLIER);
    size_t count = json_array_size(json_object_get(blend, "maps"));
    for (size_t i = 0; i < json_array_size(earlier); i++) {
        count += json_array_size(json_object_get(json_array_get(earlier, i), "maps"));
    }
    return count > 0;
}

static uint64_t sets_of_blend(json_t *blend)
{
    json_t *earlier = json_object_get(blend, ALPI_GLTF_EARLIER);
    uint64_t sets = alpi_gltf_sets_named(blend);
    for (size_t i = 0; i < json_array_size(earlier); i++) {
        sets |= alpi_gltf_sets_named(json_array_get(earlier, i));
    }
    return sets;
}

/// The sets of all primitives of each material, also of those that show it as a variant.
static void find_sets(const alpi_gltf_tidying *t, uint64_t *sets)
{
    json_t *meshes = json_object_get(t->tree, "meshes");
    for (size_t m = 0; m < json_array_size(meshes); m++) {
        json_t *primitives = json_object_get(json_array_get(meshes, m), "primitives");
        for (size_t i = 0; i < json_array_size(primitives); i++) {
            json_t *primitive = json_array_get(primitives, i);
            const uint64_t own = alpi_gltf_sets_of(json_object_get(primitive, "attributes"));
            json_t *extensions = json_object_get(primitive, "extensions");
            json_t *variants = json_object_get(extensions, "KHR_materials_variants");
            json_t *mappings = json_object_get(variants, "mappings");
            for (size_t k = 0; k <= json_array_size(mappings); k++) {
                json_t *holder = k == 0 ? primitive : json_array_get(mappings, k - 1);
                json_t *index = json_object_get(holder, "material");
                const double value = json_number_value(index);
                if (json_is_number(index) && value >= 0.0 &&
                    value < (double)t->counts[ALPI_GLTF_MATERIALS]) {
                    sets[(size_t)value] |= own;
                }
            }
        }
    }
}

/// Takes the description of a blend out of a material, where no map of it is left, and no set but
/// those that maps of one set read now. @param sets of the material's primitives
static alp_result tidy_blend(alpi_gltf_tidying *t, size_t index, uint64_t sets)
{
    json_t *material = json_array_get(json_object_get(t->tree, "materials"), index);
    json_t *extras = json_object_get(material, "extras");
    json_t *blend = json_object_get(extras, ALPI_GLTF_BLEND);
    const alpi_json_span span = t->spans[ALPI_GLTF_MATERIALS][index];
    alpi_json_span inner;
    if (!json_is_object(blend) || has_maps(blend) || t->gone[ALPI_GLTF_MATERIALS][index] ||
        !alpi_json_find(t->text, span, "extras", &inner)) {
        return ALP_OK;
    }
    uint64_t reads = 0;
    ALP_TRY(alpi_gltf_sets_read(t->context, material, &reads));
    if ((sets_of_blend(blend) & sets & ~reads) != 0) {
        return ALP_OK;
    }
    if (json_object_size(extras) == 1) {
        alpi_edits_remove(&t->edits, span, "extras");
    } else {
        alpi_edits_remove(&t->edits, inner, ALPI_GLTF_BLEND);
    }
    return ALP_OK;
}

static alp_result tidy_blends(alpi_gltf_tidying *t)
{
    const size_t count = t->counts[ALPI_GLTF_MATERIALS];
    uint64_t *sets = ALPI_NEW(t->context, uint64_t, count);
    if (sets == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    find_sets(t, sets);
    alp_result result = ALP_OK;
    for (size_t i = 0; i < count && result == ALP_OK; i++) {
        result = tidy_blend(t, i, sets[i]);
    }
    alpi_release(t->context, sets);
    return result;
}

// --- the text ------------------------------------------------------------------------------------

/// Elements with their commas; an array of which all go is no member of the root any more.
static bool remove_elements(alpi_gltf_tidying *t, alpi_gltf_kind kind)
{
    const bool *gone = t->gone[kind];
    const alpi_json_span *spans = t->spans[kind];
    const size_t count = t->counts[kind];
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i; end < count && gone[end];) {
            end++;
        }
        if (i == 0 && end == count) {
            return true;
        }
        if (end > i) {
            alpi_json_span span = {i > 0 ? spans[i - 1].end : spans[0].begin,
                                   i > 0 ? spans[end - 1].end : spans[end].begin};
            alpi_edits_replace(&t->edits, span, "%s", "");
        }
        end += end == i;
    }
    return false;
}

static void edit_text(alpi_gltf_tidying *t)
{
    const char *emptied[KINDS];
    size_t emptied_count = 0;
    for (size_t i = 0; i < t->references.count; i++) {
        const alpi_gltf_reference *r = &t->references.items[i];
        if (t->moved[r->kind] != NULL && r->index < t->counts[r->kind] &&
            (r->changed || t->moved[r->kind][r->index] != r->index) && !owner_has(t, t->gone, r)) {
            alpi_edits_replace(&t->edits, r->span, "%zu", t->moved[r->kind][r->index]);
        }
    }
    for (int k = 0; k < KINDS; k++) {
        if (remove_elements(t, order[k])) {
            emptied[emptied_count++] = names[order[k]];
        }
    }
    alpi_edits_remove_all(&t->edits, t->root, emptied, emptied_count);
}

// --- the document before -------------------------------------------------------------------------

/// Marks what something read in the document. Its elements are the first of the written file.
static alp_result find_read(alpi_gltf_tidying *t, const alpi_gltf_document *document)
{
    alpi_gltf_references before = {.context = t->context};
    alpi_json_span root;
    alp_result result = alpi_json_value(document->text, 0, document->text_size, &root)
                            ? alpi_gltf_references_find(document->text, root, &before)
                            : ALP_OK;
    for (size_t i = 0; i < before.count; i++) {
        const alpi_gltf_reference *r = &before.items[i];
        const size_t count = t->read[r->kind] != NULL ? t->counts[r->kind] : 0;
        if (r->index < count && r->index < alpi_gltf_count(document, names[r->kind])) {
            t->read[r->kind][r->index] = true;
        }
    }
    alpi_gltf_references_destroy(&before);
    return result;
}

// --- all of it -----------------------------------------------------------------------------------

static alp_result tidy(alpi_gltf_tidying *t, const alpi_gltf_leftovers *from)
{
    for (int k = 0; k < KINDS; k++) {
        ALP_TRY(list_kind(t, order[k]));
    }
    ALP_TRY(alpi_gltf_references_find(t->text, t->root, &t->references));
    ALP_TRY(find_read(t, from->document));
    if (t->references.points_at_materials && from->copy_count > 0) {
        alpi_warn(t->context, "copies", from->document->path,
                  "an extension that is not known points at materials (\"/materials/0/...\"), and "
                  "does not reach the copies that this bake made of them: %zu",
                  from->copy_count);
    }
    for (int k = 0; k < KINDS && !t->references.has_pointers; k++) {
        const alpi_gltf_kind kind = order[k];
        if (k >= MARKED) {
            find_ours(t, kind);
        }
        const bool stays = kind == ALPI_GLTF_BUFFERS && from->first_stays && t->counts[kind] > 0;
        if (stays) {
            t->ours[kind][0] = t->read[kind][0] = false;
        }
        if (kind == ALPI_GLTF_BUFFERS) {
            ALP_TRY(alpi_gltf_tidy_gather(t, from));
        }
        decide(t, kind, find_tail(t, kind));
    }
    ALP_TRY(tidy_blends(t));
    if (t->references.has_pointers) {
        return ALP_OK; // something unknown may name anything
    }
    edit_text(t);
    return from->bin != NULL && !t->references.buffers_are_named
               ? alpi_gltf_tidy_bytes(t, from->bin)
               : ALP_OK;
}

static void tell_gone(const alpi_gltf_tidying *t, const alpi_gltf_leftovers *to)
{
    for (size_t i = 0; i < to->image_count && i < t->counts[ALPI_GLTF_IMAGES]; i++) {
        to->images_gone[i] |= t->gone[ALPI_GLTF_IMAGES][i];
    }
    for (size_t i = 0; i < to->buffer_count && i < t->counts[ALPI_GLTF_BUFFERS]; i++) {
        to->buffers_gone[i] |= t->gone[ALPI_GLTF_BUFFERS][i];
    }
}

alp_result alpi_gltf_tidy(alp_context *context, const alpi_gltf_leftovers *from, alpi_bytes *text)
{
    alpi_gltf_tidying t = {.context = context,
                           .text = (const char *)text->bytes,
                           .references = {.context = context},
                           .edits = alpi_edits_create(context, (const char *)text->bytes)};
    t.tree = json_loadb(t.text, text->size, JSON_ALLOW_NUL | JSON_DECODE_INT_AS_REAL, NULL);
    alp_result result = t.tree != NULL && alpi_json_value(t.text, 0, text->size, &t.root)
                            ? tidy(&t, from)
                            : ALP_ERROR_OUT_OF_MEMORY; // it was parsed before, and edited well
    alpi_bytes tidied = alpi_bytes_create(context);
    if (result == ALP_OK) {
        tell_gone(&t, from);
        result = alpi_edits_apply(&t.edits, (alpi_json_span){0, text->size}, &tidied);
    }
    if (result == ALP_OK) {
        alpi_bytes_destroy(text);
        *text = tidied;
    } else {
        alpi_bytes_destroy(&tidied);
    }
    for (int k = 0; k < KINDS; k++) {
        alpi_release(context, t.spans[order[k]]);
        alpi_release(context, t.ours[order[k]]);
        alpi_release(context, t.read[order[k]]);
        alpi_release(context, t.gone[order[k]]);
        alpi_release(context, t.moved[order[k]]);
    }
    alpi_gltf_references_destroy(&t.references);
    alpi_edits_destroy(&t.edits);
    json_decref(t.tree);
    return result;
}
