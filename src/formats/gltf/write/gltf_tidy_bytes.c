// SPDX-License-Identifier: MIT
// Bytes of views that go, cut out of the buffer that a .glb holds. Cuts are multiples of four
// bytes, so that everything behind them stays aligned; bytes that anything else reads are never
// cut.

#include "base/memory.h"
#include "formats/gltf/write/gltf_tidy.h"

#include <stdlib.h>

/// Bytes of buffer 0 that a view reads, or its compressed form.
typedef struct extent {
    size_t begin, end;
    size_t reach;        // the largest end up to here, where they are sorted
    alpi_json_span span; // of the object that states them
} extent;

typedef struct extents {
    extent *items;
    size_t count;
} extents;

static int compare_extents(const void *left, const void *right)
{
    const extent *a = left, *b = right;
    return a->begin < b->begin ? -1 : a->begin > b->begin;
}

static size_t read_size(json_t *object, const char *name)
{
    const double value = json_number_value(json_object_get(object, name));
    return value > 0.0 && value < 18446744073709549568.0 ? (size_t)value : 0;
}

static void add_extent(extents *list, json_t *object, alpi_json_span span)
{
    const size_t begin = read_size(object, "byteOffset"), size = read_size(object, "byteLength");
    if (json_is_object(object) && read_size(object, "buffer") == 0 && size <= SIZE_MAX - begin) {
        list->items[list->count++] = (extent){begin, begin + size, 0, span};
    }
}

/// Of views that stay with what their extensions say, or of those that go.
static void list_extents(const alpi_gltf_tidying *t, bool gone, extents *list)
{
    static const char *const packed[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};
    json_t *views = json_object_get(t->tree, "bufferViews");
    for (size_t i = 0; i < t->counts[ALPI_GLTF_BUFFER_VIEWS]; i++) {
        const alpi_json_span span = t->spans[ALPI_GLTF_BUFFER_VIEWS][i];
        json_t *view = json_array_get(views, i);
        if (t->gone[ALPI_GLTF_BUFFER_VIEWS][i] != gone) {
            continue;
        }
        add_extent(list, view, span);
        for (size_t k = 0; k < sizeof packed / sizeof *packed && !gone; k++) {
            alpi_json_span inner;
            if (alpi_json_find(t->text, span, "extensions", &inner) &&
                alpi_json_find(t->text, inner, packed[k], &inner)) {
                add_extent(list, json_object_get(json_object_get(view, "extensions"), packed[k]),
                           inner);
            }
        }
    }
    if (list->count > 0) {
        qsort(list->items, list->count, sizeof *list->items, compare_extents);
    }
    for (size_t i = 0; i < list->count; i++) {
        const size_t before = i > 0 ? list->items[i - 1].reach : 0;
        list->items[i].reach = list->items[i].end > before ? list->items[i].end : before;
    }
}

/// How many of sorted extents begin before a byte.
static size_t count_before(const extents *list, size_t byte)
{
    size_t low = 0, high = list->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (list->items[middle].begin < byte) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

/// Makes cuts of what goes; `reach` of each: bytes cut up to its end.
static size_t find_cuts(const extents *kept, size_t size, extents *cuts)
{
    size_t count = 0, last = 0, total = 0;
    for (size_t i = 0; i < cuts->count; i++) {
        extent cut = cuts->items[i];
        cut.begin = (cut.begin + 3) / 4 * 4;
        cut.begin = cut.begin > last ? cut.begin : last;
        cut.end = cut.end > size ? size : (cut.end + 3) / 4 * 4;
        cut.end = cut.end > size ? size : cut.end;
        const size_t before = count_before(kept, cut.end);
        const bool is_read = before > 0 && kept->items[before - 1].reach > cut.begin;
        if (cut.begin < cut.end && !is_read) {
            total += cut.end - cut.begin;
            cut.reach = total;
            last = cut.end;
            cuts->items[count++] = cut;
        }
    }
    cuts->count = count;
    return total;
}

static alp_result cut_bytes(alpi_gltf_tidying *t, const extents *cuts, alpi_bytes *bin)
{
    alpi_bytes shorter = alpi_bytes_create(t->context);
    size_t at = 0;
    for (size_t i = 0; i < cuts->count; i++) {
        alpi_bytes_add(&shorter, bin->bytes + at, cuts->items[i].begin - at);
        at = cuts->items[i].end;
    }
    alpi_bytes_add(&shorter, bin->bytes + at, bin->size - at);
    if (shorter.failed) {
        alpi_bytes_destroy(&shorter);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alpi_bytes_destroy(bin);
    *bin = shorter;
    return ALP_OK;
}

static alp_result cut(alpi_gltf_tidying *t, extents *kept, extents *cuts, alpi_bytes *bin)
{
    json_t *buffer = json_array_get(json_object_get(t->tree, "buffers"), 0);
    const size_t stated = read_size(buffer, "byteLength");
    list_extents(t, false, kept);
    list_extents(t, true, cuts);
    const size_t total = find_cuts(kept, stated < bin->size ? stated : bin->size, cuts);
    if (total == 0) {
        return ALP_OK;
    }
    for (size_t i = 0; i < kept->count; i++) {
        const size_t before = count_before(cuts, kept->items[i].begin);
        if (before > 0) {
            alpi_edits_set_index(&t->edits, kept->items[i].span, "byteOffset",
                                 kept->items[i].begin - cuts->items[before - 1].reach);
        }
    }
    alpi_edits_set_index(&t->edits, t->spans[ALPI_GLTF_BUFFERS][0], "byteLength", stated - total);
    return cut_bytes(t, cuts, bin);
}

alp_result alpi_gltf_tidy_bytes(alpi_gltf_tidying *t, alpi_bytes *bin)
{
    if (t->counts[ALPI_GLTF_BUFFERS] == 0 || t->gone[ALPI_GLTF_BUFFERS][0]) {
        return ALP_OK; // without bytes, or the whole buffer goes, and its text with it
    }
    const size_t views = t->counts[ALPI_GLTF_BUFFER_VIEWS];
    extents kept = {.items = ALPI_NEW(t->context, extent, 3 * views)};
    extents cuts = {.items = ALPI_NEW(t->context, extent, views)};
    const alp_result result = kept.items == NULL || cuts.items == NULL ? ALP_ERROR_OUT_OF_MEMORY
                                                                       : cut(t, &kept, &cuts, bin);
    alpi_release(t->context, kept.items);
    alpi_release(t->context, cuts.items);
    return result;
}

// --- files beside a .gltf ------------------------------------------------------------------------

/// Appends the bytes of a view to the new data; false where they do not lie in its buffer.
static bool move_view(alpi_gltf_tidying *t, const alpi_gltf_leftovers *from,
                      const alpi_gltf_reference *buffer)
{
    json_t *view = json_array_get(json_object_get(t->tree, "bufferViews"), buffer->owner);
    const alpi_gltf_buffer *old = &from->document->buffers[buffer->index];
    const size_t begin = read_size(view, "byteOffset"), size = read_size(view, "byteLength");
    if (old->bytes == NULL || begin > old->size || size > old->size - begin) {
        return false;
    }
    alpi_bytes_align(from->data, '\0');
    alpi_edits_set_index(&t->edits, t->spans[ALPI_GLTF_BUFFER_VIEWS][buffer->owner], "byteOffset",
                         from->data->size);
    alpi_bytes_add(from->data, old->bytes + begin, size);
    return true;
}

alp_result alpi_gltf_tidy_gather(alpi_gltf_tidying *t, const alpi_gltf_leftovers *from)
{
    const size_t count = t->counts[ALPI_GLTF_BUFFERS];
    if (from->data == NULL || count == 0 || t->references.buffers_are_named) {
        return ALP_OK;
    }
    const size_t last = count - 1, size = from->data->size;
    for (size_t i = 0; i < t->references.count; i++) {
        alpi_gltf_reference *r = &t->references.items[i];
        const bool is_view = r->kind == ALPI_GLTF_BUFFERS && r->index < last &&
                             r->index < from->document->buffer_count &&
                             r->owner_kind == ALPI_GLTF_BUFFER_VIEWS;
        if (is_view && t->ours[ALPI_GLTF_BUFFERS][r->index] &&
            !t->gone[ALPI_GLTF_BUFFER_VIEWS][r->owner] && move_view(t, from, r)) {
            r->index = last;
            r->changed = true;
        }
    }
    if (from->data->size > size) {
        alpi_edits_set_index(&t->edits, t->spans[ALPI_GLTF_BUFFERS][last], "byteLength",
                             from->data->size);
    }
    return from->data->failed ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
}
