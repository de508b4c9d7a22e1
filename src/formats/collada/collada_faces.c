// SPDX-License-Identifier: MIT
// Primitive elements → triangles of corners. <triangles>, <polylist>, <polygons> with holes,
// <tristrips>, <trifans>; corners stand in the order of the file.
// Barnes, Finch. COLLADA – Digital Asset Schema Release 1.4.1, 2nd edition. Khronos, 2008.
#include "formats/collada/collada_read.h"

#include "base/memory.h"
#include "formats/collada/collada_numbers.h"

#include <math.h>
#include <string.h>

typedef enum face_kind { TRIANGLES, POLYLIST, POLYGONS, TRISTRIPS, TRIFANS, NO_FACES } face_kind;

/// A closed ring of corners; a hole belongs to the outline before it.
typedef struct ring {
    uint32_t count;
    bool hole;
} ring;

typedef struct work {
    alpi_collada_reader *reader;
    xmlNode *element;
    alpi_collada_inputs *inputs;
    alpi_collada_faces *faces;
    size_t index_count, index_capacity, triangle_capacity, polygon_capacity;
    ring *rings;
    size_t ring_count, ring_capacity;
    float (*points)[3]; // of one polygon
    uint32_t *ring_ends;
    size_t point_capacity, end_capacity;
} work;

static face_kind kind_of(const xmlNode *element)
{
    static const char *const names[] = {"triangles", "polylist", "polygons", "tristrips",
                                        "trifans"};
    for (int k = 0; k < NO_FACES; k++) {
        if (alpi_xml_is(element, names[k])) {
            return (face_kind)k;
        }
    }
    return NO_FACES;
}

bool alpi_collada_is_primitive(const xmlNode *element)
{
    return kind_of(element) != NO_FACES;
}

void alpi_collada_faces_destroy(alp_context *context, alpi_collada_faces *faces)
{
    alpi_release(context, faces->indices);
    alpi_release(context, faces->triangles);
    alpi_release(context, faces->polygons);
    *faces = (alpi_collada_faces){0};
}

// --- indices -------------------------------------------------------------------------------------

static alp_result add_ring(work *w, uint32_t count, bool hole)
{
    ALP_TRY(alpi_collada_grow(w->reader->context, &w->rings, &w->ring_capacity, w->ring_count + 1,
                              sizeof *w->rings));
    w->rings[w->ring_count++] = (ring){count, hole};
    return ALP_OK;
}

/// The indices of one <p> or <h>, whole corners only; *count of corners.
static alp_result read_list(work *w, const xmlNode *list, uint32_t *count)
{
    const size_t before = w->index_count;
    ALP_TRY(alpi_collada_indices(w->reader->document, list, &w->faces->indices, &w->index_count,
                                 &w->index_capacity));
    const size_t whole = (w->index_count - before) / w->inputs->stride;
    w->faces->dropped += whole * w->inputs->stride < w->index_count - before;
    w->index_count = before + whole * w->inputs->stride;
    if (w->index_count / w->inputs->stride > ALPI_NONE / 2) {
        return alpi_fail(w->reader->context, ALP_ERROR_LIMIT,
                         "%s: more than %u corners in one mesh; split it",
                         w->reader->document->path, ALPI_NONE / 2);
    }
    *count = (uint32_t)whole;
    return ALP_OK;
}

/// <ph>: an outline <p> and holes <h>.
static alp_result read_polygon_with_holes(work *w, const xmlNode *element)
{
    bool outlined = false;
    for (const xmlNode *e = alpi_xml_child(element, NULL); e != NULL; e = alpi_xml_next(e, NULL)) {
        const bool hole = alpi_xml_is(e, "h");
        if (!hole && !alpi_xml_is(e, "p")) {
            continue;
        }
        if (hole != outlined) {
            return alpi_collada_fail(w->reader->document, element,
                                     "must hold one <p> and then its holes <h>");
        }
        uint32_t count;
        ALP_TRY(read_list(w, e, &count));
        ALP_TRY(add_ring(w, count, hole));
        outlined = true;
    }
    return ALP_OK;
}

static alp_result read_lists(work *w, face_kind kind)
{
    for (const xmlNode *e = alpi_xml_child(w->element, NULL); e != NULL;
         e = alpi_xml_next(e, NULL)) {
        if (alpi_xml_is(e, "p")) {
            uint32_t count;
            ALP_TRY(read_list(w, e, &count));
            if (kind != POLYLIST && kind != TRIANGLES) {
                ALP_TRY(add_ring(w, count, false));
            }
        } else if (alpi_xml_is(e, "ph")) {
            ALP_TRY(read_polygon_with_holes(w, e));
        }
    }
    w->faces->corner_count = (uint32_t)(w->index_count / w->inputs->stride);
    return ALP_OK;
}

/// <vcount> of a <polylist> → rings.
static alp_result read_counts(work *w)
{
    const alpi_collada_document *document = w->reader->document;
    uint32_t *counts = NULL;
    size_t count = 0, capacity = 0;
    uint64_t sum = 0;
    const xmlNode *element = alpi_xml_child(w->element, "vcount");
    alp_result result = element == NULL
                            ? ALP_OK
                            : alpi_collada_indices(document, element, &counts, &count, &capacity);
    for (size_t i = 0; result == ALP_OK && i < count; i++) {
        sum += counts[i];
        result = add_ring(w, counts[i], false);
    }
    alpi_release(w->reader->context, counts);
    ALP_TRY(result);
    if (sum > w->faces->corner_count) {
        return alpi_collada_fail(document, w->element,
                                 "<vcount> asks for %llu corners, <p> holds %u",
                                 (unsigned long long)sum, w->faces->corner_count);
    }
    w->faces->dropped += sum < w->faces->corner_count;
    return ALP_OK;
}

static alp_result check_indices(const work *w)
{
    static const char *const names[] = {"vertex", "normal", "colour", "texture coordinate"};
    for (uint32_t k = 0; k < ALPI_COLLADA_KEY_COUNT; k++) {
        if (w->inputs->source[k] == ALPI_NONE || w->faces->corner_count == 0) {
            continue;
        }
        const uint32_t count = w->reader->sources[w->inputs->source[k]].count;
        const uint32_t *index = w->faces->indices + w->inputs->offset[k];
        for (uint32_t c = 0; c < w->faces->corner_count; c++, index += w->inputs->stride) {
            if (*index >= count && (k == ALPI_COLLADA_NORMAL || k == ALPI_COLLADA_COLOR)) {
                w->inputs->source[k] = ALPI_NONE;
                w->inputs->bad = w->inputs->bad != NULL ? w->inputs->bad : w->element;
                break;
            }
            if (*index >= count) {
                return alpi_collada_fail(
                    w->reader->document, w->element, "corner %u uses %s %u, there are %u", c,
                    names[k < ALPI_COLLADA_UV ? k : ALPI_COLLADA_UV], *index, count);
            }
        }
    }
    return ALP_OK;
}

// --- triangles -----------------------------------------------------------------------------------

static alp_result add_triangles(work *w, uint32_t count, uint32_t (**triangles)[3])
{
    alpi_collada_faces *f = w->faces;
    ALP_TRY(alpi_collada_grow(w->reader->context, &f->triangles, &w->triangle_capacity,
                              (size_t)f->triangle_count + count, sizeof *f->triangles));
    *triangles = f->triangles + f->triangle_count;
    f->triangle_count += count;
    return ALP_OK;
}

/// Every three corners; what a strip or a fan makes of them.
static alp_result add_series(work *w, face_kind kind, uint32_t first, uint32_t count)
{
    uint32_t(*triangles)[3] = NULL;
    const uint32_t made = kind == TRIANGLES ? count / 3 : count - 2;
    if (made == 0) {
        return ALP_OK;
    }
    ALP_TRY(add_triangles(w, made, &triangles));
    for (uint32_t t = 0; t < made; t++) {
        const uint32_t at = first + (kind == TRIANGLES ? 3 * t : t);
        const bool turned = kind == TRISTRIPS && t % 2 == 1; // every second one lies the other way
        triangles[t][0] = kind == TRIFANS ? first : at;
        triangles[t][1] = at + (turned ? 2 : 1);
        triangles[t][2] = at + (turned ? 1 : 2);
    }
    return ALP_OK;
}

/// The rings [first_ring, end_ring) are one polygon, whose corners begin at `corner`.
static alp_result add_polygon(work *w, size_t first_ring, size_t end_ring, uint32_t corner)
{
    const uint32_t rings = (uint32_t)(end_ring - first_ring);
    uint32_t total = 0;
    alp_context *context = w->reader->context;
    ALP_TRY(
        alpi_collada_grow(context, &w->ring_ends, &w->end_capacity, rings, sizeof *w->ring_ends));
    for (uint32_t r = 0; r < rings; r++) {
        total += w->rings[first_ring + r].count;
        w->ring_ends[r] = total;
    }
    ALP_TRY(alpi_collada_grow(context, &w->points, &w->point_capacity, total, sizeof *w->points));
    const alpi_collada_source *positions =
        &w->reader->sources[w->inputs->source[ALPI_COLLADA_POSITION]];
    for (uint32_t c = 0; c < total; c++) {
        const uint32_t index = w->faces->indices[(size_t)(corner + c) * w->inputs->stride +
                                                 w->inputs->offset[ALPI_COLLADA_POSITION]];
        for (uint32_t k = 0; k < 3; k++) {
            w->points[c][k] = alpi_collada_value(positions, index, k);
        }
    }
    const alpi_polygon_rings polygon = {(const float(*)[3])w->points, w->ring_ends, rings};
    const uint32_t count = alpi_polygon_triangle_count(&polygon);
    uint32_t(*triangles)[3] = NULL;
    bool tidy = true;
    ALP_TRY(add_triangles(w, count, &triangles));
    ALP_TRY(alpi_polygon_triangulate_rings(&w->reader->polygons, &polygon, triangles, &tidy));
    w->faces->untidy += !tidy;
    ALP_TRY(alpi_collada_grow(context, &w->faces->polygons, &w->polygon_capacity,
                              (size_t)w->faces->polygon_count + 1, sizeof *w->faces->polygons));
    w->faces->polygons[w->faces->polygon_count++] =
        (alpi_collada_polygon){corner, rings == 1 ? total : 0, count};
    for (uint32_t t = 0; t < count; t++) {
        for (int k = 0; k < 3; k++) {
            triangles[t][k] += corner;
        }
    }
    return ALP_OK;
}

static alp_result add_polygons(work *w)
{
    uint32_t corner = 0;
    for (size_t r = 0; r < w->ring_count;) {
        size_t end = r + 1, kept = r; // holes of fewer than three corners hide nothing
        uint32_t next = corner + w->rings[r].count;
        bool whole = true;
        for (; end < w->ring_count && w->rings[end].hole; end++) {
            next += w->rings[end].count;
            whole &= w->rings[end].count >= 3;
            kept += whole;
        }
        w->faces->dropped += !whole;
        if (w->rings[r].count >= 3) { // holes behind a broken one are left out with it
            ALP_TRY(add_polygon(w, r, kept + 1, corner));
        } else {
            w->faces->dropped++;
        }
        corner = next;
        r = end;
    }
    return ALP_OK;
}

static alp_result make_triangles(work *w, face_kind kind)
{
    if (kind == TRIANGLES) {
        w->faces->dropped += w->faces->corner_count % 3 != 0;
        return add_series(w, kind, 0, w->faces->corner_count);
    }
    if (kind == POLYLIST || kind == POLYGONS) {
        return add_polygons(w);
    }
    uint32_t corner = 0;
    for (size_t r = 0; r < w->ring_count; r++) {
        if (w->rings[r].count >= 3) {
            ALP_TRY(add_series(w, kind, corner, w->rings[r].count));
        }
        corner += w->rings[r].count;
    }
    return ALP_OK;
}

alp_result alpi_collada_read_faces(alpi_collada_reader *reader, xmlNode *element,
                                   alpi_collada_inputs *inputs, alpi_collada_faces *faces)
{
    *faces = (alpi_collada_faces){0};
    work w = {.reader = reader, .element = element, .inputs = inputs, .faces = faces};
    const face_kind kind = kind_of(element);
    alp_result result = read_lists(&w, kind);
    if (result == ALP_OK && kind == POLYLIST) {
        result = read_counts(&w);
    }
    if (result == ALP_OK) {
        result = check_indices(&w);
    }
    if (result == ALP_OK) {
        result = make_triangles(&w, kind);
    }
    alpi_release(reader->context, w.rings);
    alpi_release(reader->context, w.points);
    alpi_release(reader->context, w.ring_ends);
    if (result != ALP_OK) {
        alpi_collada_faces_destroy(reader->context, faces);
    }
    return result;
}
