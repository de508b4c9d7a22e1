// SPDX-License-Identifier: MIT
// Edits of meshes: a coordinate set or values for each primitive, vertices split where charts meet
// or values differ, one primitive a page, and copies of meshes that several nodes use.
#include "formats/gltf/write/gltf_patch_mesh.h"

#include "base/memory.h"
#include "base/plural.h"
#include "formats/gltf/gltf_accessor.h"
#include "formats/gltf/gltf_bytes.h"
#include "formats/gltf/gltf_compression.h"
#include "formats/gltf/gltf_tree.h"
#include "formats/gltf/write/gltf_appends.h"
#include "formats/gltf/write/gltf_patch_instances.h"
#include "formats/gltf/write/gltf_patch_plan.h"
#include "formats/gltf/write/gltf_patch_sets.h"
#include "formats/gltf/write/gltf_patch_users.h"
#include "formats/gltf/write/gltf_patch_vertex.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MODE_TRIANGLES = 4 };

static void destroy_rewrite(alpi_gltf_patcher *p, alpi_gltf_rewrite *r)
{
    alpi_gltf_split_destroy(p->context, &r->split);
    alpi_release(p->context, r->indices);
    alpi_release(p->context, r->corner_values);
    alpi_release(p->context, r->attribute_edits);
}

// --- corners -------------------------------------------------------------------------------------

static uint32_t source_vertex(const alpi_gltf_patcher *p, const alpi_gltf_rewrite *r,
                              uint32_t vertex)
{
    return p->exported ? vertex - r->surface->first_vertex : p->scene->vertex_source[vertex];
}

/// Which corner of the scene's triangle each corner of the file's is: a mirrored surface was turned
/// when it was read.
static bool match_corners(const alpi_gltf_patcher *p, const alpi_gltf_rewrite *r, uint32_t i,
                          int order[3])
{
    static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {2, 1, 0},
                                     {1, 0, 2}, {1, 2, 0}, {2, 0, 1}};
    const uint32_t *corners = p->scene->triangles[r->surface->first_triangle + i];
    for (int o = 0; o < 6; o++) {
        bool same = true;
        for (int k = 0; k < 3; k++) {
            same &= source_vertex(p, r, corners[orders[o][k]]) == r->indices[i][k];
        }
        if (same) {
            memcpy(order, orders[o], sizeof orders[o]);
            return true;
        }
    }
    return false;
}

/// What is written of a corner of the scene's triangle.
static void read_corner(const alpi_gltf_patcher *p, uint32_t triangle, int corner, float *out)
{
    const alpi_mesh_patch *patch = p->patch;
    if (patch->vertex_values != NULL) { // split as if it were a coordinate
        out[0] = alpi_patcher_vertex_value(p, p->scene->triangles[triangle][corner]);
        return;
    }
    const int sets = patch->set_uvs != NULL ? ALPI_GLTF_BLEND_SETS : 1;
    for (int i = 0; i < 2 * sets; i++) {
        const float value = patch->set_uvs != NULL ? patch->set_uvs[triangle][i / 2][corner][i % 2]
                                                   : patch->corner_uvs[triangle][corner][i];
        out[i] = isfinite(value) ? value + 0.0f : 0.0f; // −0 → 0
    }
}

static alp_result turn_corners(alpi_gltf_patcher *p, alpi_gltf_rewrite *r)
{
    r->width = 2 * r->added_count;
    ALPI_TRY_NEW(p->context, r->corner_values, 3 * (size_t)r->width * r->triangle_count);
    for (uint32_t i = 0; i < r->triangle_count; i++) {
        int order[3];
        if (!match_corners(p, r, i, order)) {
            return alpi_gltf_fail(p->document, r->owner, "triangle %u is not the one that was read",
                                  i);
        }
        for (int k = 0; k < 3; k++) {
            float *out = r->corner_values + (3 * (size_t)i + (size_t)k) * r->width;
            read_corner(p, r->surface->first_triangle + i, order[k], out);
        }
    }
    return ALP_OK;
}

// --- vertices and indices ------------------------------------------------------------------------

static alp_result add_coordinates(alpi_gltf_patcher *p, alpi_gltf_rewrite *r)
{
    const uint32_t count = r->split.vertex_count;
    float(*uvs)[2] = (float(*)[2])alpi_allocate(p->context, count, sizeof *uvs);
    alp_result result = uvs != NULL ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
    for (uint32_t k = 0; k < r->added_count && result == ALP_OK; k++) {
        for (uint32_t v = 0; v < count; v++) {
            memcpy(uvs[v], r->split.values + (size_t)v * r->width + (size_t)2 * k, sizeof uvs[v]);
        }
        alpi_gltf_array array = {.bytes = uvs,
                                 .count = count,
                                 .components = 2,
                                 .component_type = 5126,
                                 .element_size = sizeof *uvs,
                                 .mark = ALPI_GLTF_SET};
        result = alpi_patcher_add_accessor(p, &array, &r->added_accessors[k]);
    }
    alpi_release(p->context, uvs);
    return result;
}

/// The values of the corners as an attribute; vertices of no triangle are open.
static alp_result add_values(alpi_gltf_patcher *p, alpi_gltf_rewrite *r)
{
    uint32_t count = r->split.vertex_count;
    uint16_t *values = ALPI_NEW(p->context, uint16_t, count);
    if (values == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    memset(values, 0xff, count * sizeof *values);
    for (uint32_t i = 0; i < r->triangle_count; i++) {
        for (int k = 0; k < 3; k++) {
            uint32_t vertex = r->split.indices[i][k];
            values[vertex] = (uint16_t)r->split.values[(size_t)vertex * r->width];
        }
    }
    alpi_gltf_vertex_input input = {.primitive = r->primitive,
                                    .owner = r->owner,
                                    .source_count = r->vertex_count,
                                    .count = count,
                                    .sources = r->split.changed ? r->split.sources : NULL,
                                    .values = values};
    alp_result result = alpi_patcher_add_vertex_values(p, &input, &r->added_accessors[0]);
    alpi_release(p->context, values);
    return result;
}

static alp_result split_vertices(alpi_gltf_patcher *p, alpi_gltf_rewrite *r)
{
    bool at_vertices = p->patch->vertex_values != NULL;
    r->added_count = p->patch->set_uvs != NULL ? ALPI_GLTF_BLEND_SETS : 1;
    for (uint32_t k = 0; k < r->added_count; k++) {
        alpi_patcher_set_name(r->plan->sets[k], r->added_names[k]);
    }
    if (at_vertices) {
        snprintf(r->added_names[0], sizeof r->added_names[0], "%s", alpi_patcher_vertex_name(p));
    }
    ALP_TRY(turn_corners(p, r));
    alpi_gltf_split_input input = {.vertex_count = r->vertex_count,
                                   .triangle_count = r->triangle_count,
                                   .indices = r->indices,
                                   .width = r->width,
                                   .values = r->corner_values,
                                   .usable =
                                       p->scene->triangle_usable + r->surface->first_triangle};
    ALP_TRY(alpi_gltf_split_create(p->context, &input, &r->split));
    r->parted = r->split.changed;
    r->split.changed |= r->compressed;
    if (r->split.changed) {
        ALP_TRY(alpi_patcher_split_attributes(p, r, r->attributes));
        ALP_TRY(alpi_patcher_split_targets(p, r));
    }
    return at_vertices ? add_values(p, r) : add_coordinates(p, r);
}

/// Kept coordinates: the vertices stay what they are, and are written uncompressed.
static alp_result write_plain(alpi_gltf_patcher *p, alpi_gltf_rewrite *r)
{
    ALPI_TRY_NEW(p->context, r->split.sources, r->vertex_count);
    for (uint32_t v = 0; v < r->vertex_count; v++) {
        r->split.sources[v] = v;
    }
    r->split.vertex_count = r->vertex_count;
    r->split.changed = true;
    ALP_TRY(alpi_patcher_split_attributes(p, r, r->attributes));
    return alpi_patcher_split_targets(p, r);
}

/// The triangles of one page, as a new index accessor. The largest index of a type is no vertex:
/// it restarts primitives.
static alp_result write_indices(alpi_gltf_patcher *p, const alpi_gltf_rewrite *r, uint32_t page,
                                size_t *accessor)
{
    uint32_t(*indices)[3] = r->split.indices != NULL ? r->split.indices : r->indices;
    uint32_t vertex_count = r->split.changed ? r->split.vertex_count : r->vertex_count;
    bool is_short = vertex_count <= 65535;
    alpi_bytes bytes = alpi_bytes_create(p->context);
    uint32_t count = 0;
    for (uint32_t i = 0; i < r->triangle_count; i++) {
        for (int k = 0; k < 3 && p->triangle_pages[r->surface->first_triangle + i] == page; k++) {
            uint16_t small = (uint16_t)indices[i][k];
            alpi_bytes_add(&bytes, is_short ? (const void *)&small : (const void *)&indices[i][k],
                           is_short ? 2 : 4);
            count++;
        }
    }
    alpi_gltf_array array = {.bytes = bytes.bytes,
                             .count = count,
                             .components = 1,
                             .component_type = is_short ? 5123 : 5125,
                             .element_size = is_short ? 2 : 4,
                             .is_indices = true};
    alp_result result =
        bytes.failed ? ALP_ERROR_OUT_OF_MEMORY : alpi_patcher_add_accessor(p, &array, accessor);
    alpi_bytes_destroy(&bytes);
    return result;
}

// --- the text of a primitive ---------------------------------------------------------------------

/// Draco's version of a primitive that changes is taken out: its order of vertices is another.
static void drop_draco(alpi_gltf_patcher *p, alpi_edits *edits, const alpi_gltf_rewrite *r)
{
    alpi_json_span span;
    if (!r->has_draco || !alpi_json_find(p->document->text, r->span, "extensions", &span)) {
        return;
    }
    if (json_object_size(json_object_get(r->primitive, "extensions")) == 1) {
        alpi_edits_remove(edits, r->span, "extensions");
    } else {
        alpi_edits_remove(edits, span, ALPI_GLTF_DRACO);
    }
}

/// Whether a primitive is written without compression: it gains an attribute, or is split into
/// pieces that Draco's one stream cannot stand for.
static bool becomes_plain(const alpi_gltf_patcher *p, const alpi_gltf_rewrite *r)
{
    return p->patch->corner_uvs != NULL || p->patch->vertex_values != NULL ||
           (r->has_draco && r->plan->piece_count > 1);
}

/// Whether any accessor of a primitive is compressed.
static bool any_compressed(const alpi_gltf_patcher *p, const alpi_gltf_rewrite *r)
{
    const char *text = p->document->text;
    alpi_json_span span;
    bool any = alpi_json_find(text, r->span, "indices", &span) &&
               alpi_gltf_accessor_is_compressed(p->document, alpi_patcher_read_index(p, span));
    alpi_json_cursor cursor = alpi_json_open(text, r->attributes);
    while (alpi_json_next(&cursor)) {
        any |=
            alpi_gltf_accessor_is_compressed(p->document, alpi_patcher_read_index(p, cursor.value));
    }
    if (alpi_json_find(text, r->span, "targets", &span)) {
        alpi_json_cursor targets = alpi_json_open(text, span);
        while (alpi_json_next(&targets)) {
            cursor = alpi_json_open(text, targets.value);
            while (alpi_json_next(&cursor)) {
                any |= alpi_gltf_accessor_is_compressed(p->document,
                                                        alpi_patcher_read_index(p, cursor.value));
            }
        }
    }
    return any;
}

/// The materials that variants switch to.
static void edit_variants(const alpi_gltf_patcher *p, alpi_edits *edits, const alpi_gltf_rewrite *r,
                          const alpi_gltf_piece *piece)
{
    const char *text = p->document->text;
    alpi_json_span mappings, material;
    if (p->mapped == NULL ||
        !alpi_json_at(text, r->span, "extensions/KHR_materials_variants/mappings", &mappings)) {
        return;
    }
    const size_t count = json_array_size(alpi_gltf_mappings(r->primitive));
    alpi_json_cursor cursor = alpi_json_open(text, mappings);
    for (size_t i = 0; i < count && alpi_json_next(&cursor); i++) {
        const size_t written = p->mapped[piece->mapped + i];
        if (written != ALPI_GLTF_NONE &&
            alpi_json_find(text, cursor.value, "material", &material)) {
            alpi_edits_replace(edits, material, "%zu", written);
        }
    }
}

static alp_result edit_primitive(alpi_gltf_patcher *p, alpi_edits *edits,
                                 const alpi_gltf_rewrite *r, const alpi_gltf_piece *piece)
{
    for (size_t i = 0; i < r->attribute_count; i++) {
        alpi_edits_replace(edits, r->attribute_edits[i].span, "%zu",
                           r->attribute_edits[i].accessor);
    }
    alpi_patcher_drop_sets(edits, r->attributes, r->plan->dropped);
    for (uint32_t k = 0; k < r->added_count; k++) {
        alpi_edits_set_index(edits, r->attributes, r->added_names[k], r->added_accessors[k]);
    }
    if (becomes_plain(p, r)) {
        drop_draco(p, edits, r);
    }
    if (r->split.changed || r->plan->piece_count > 1) {
        size_t accessor, mode;
        ALP_TRY(write_indices(p, r, piece->page, &accessor));
        alpi_edits_set_index(edits, r->span, "indices", accessor);
        ALP_TRY(
            alpi_gltf_size_or(p->document, r->primitive, "mode", r->owner, MODE_TRIANGLES, &mode));
        if (mode != MODE_TRIANGLES) { // a strip or fan
            alpi_edits_set_index(edits, r->span, "mode", MODE_TRIANGLES);
        }
    }
    if (piece->material != r->plan->material) {
        alpi_edits_set_index(edits, r->span, "material", piece->material);
    }
    edit_variants(p, edits, r, piece);
    return ALP_OK;
}

/// The first piece is the primitive itself; the others are copies behind the last primitive.
static alp_result write_pieces(alpi_gltf_patcher *p, alpi_edits *edits, const alpi_gltf_rewrite *r,
                               alpi_json_span primitives)
{
    const alpi_gltf_piece *pieces = &p->pieces[r->plan->piece_first];
    ALP_TRY(edit_primitive(p, edits, r, &pieces[0]));
    for (size_t k = 1; k < r->plan->piece_count; k++) {
        alpi_edits copy = alpi_edits_create(p->context, p->document->text);
        alpi_bytes text = alpi_bytes_create(p->context);
        alp_result result = edit_primitive(p, &copy, r, &pieces[k]);
        if (result == ALP_OK) {
            result = alpi_edits_apply(&copy, r->span, &text);
        }
        alpi_edits_add(edits, primitives, NULL, text.bytes, text.size);
        alpi_bytes_destroy(&text);
        alpi_edits_destroy(&copy);
        ALP_TRY(result);
    }
    return ALP_OK;
}

static alp_result read_triangles(alpi_gltf_patcher *p, alpi_gltf_rewrite *r)
{
    const char *text = p->document->text;
    alpi_json_span position;
    alpi_gltf_values values;
    if (!alpi_json_find(text, r->attributes, "POSITION", &position) ||
        alpi_patcher_read_index(p, position) == ALPI_GLTF_NONE) {
        return alpi_gltf_fail(p->document, r->owner, "has no POSITION");
    }
    ALP_TRY(alpi_gltf_accessor_check(p->document, alpi_patcher_read_index(p, position), &values));
    r->vertex_count = values.count;
    uint32_t leftover;
    ALP_TRY(alpi_gltf_primitive_triangles(p->document, r->primitive, r->owner, r->vertex_count,
                                          &r->indices, &r->triangle_count, &leftover));
    if (r->triangle_count != r->surface->triangle_count) {
        return alpi_gltf_fail(p->document, r->owner, "has %u triangle%s, but %u were read",
                              r->triangle_count, alpi_plural(r->triangle_count),
                              r->surface->triangle_count);
    }
    return ALP_OK;
}

/// New coordinates or values, and no compression where it cannot stay.
static alp_result change_vertices(alpi_gltf_patcher *p, alpi_gltf_rewrite *r, bool in_place)
{
    r->has_draco = alpi_gltf_extension(r->primitive, ALPI_GLTF_DRACO) != NULL;
    const bool plain = becomes_plain(p, r);
    r->compressed = plain && any_compressed(p, r);
    p->plain_count += r->compressed;
    p->undraco_count += plain && r->has_draco && in_place;
    if (p->patch->corner_uvs != NULL || p->patch->vertex_values != NULL) {
        return split_vertices(p, r);
    }
    return r->compressed ? write_plain(p, r) : ALP_OK;
}

static alp_result rewrite_primitive(alpi_gltf_patcher *p, alpi_edits *edits,
                                    const alpi_gltf_plan *plan, alpi_json_span span,
                                    alpi_json_span primitives)
{
    alpi_gltf_rewrite r = {.plan = plan,
                           .surface = &p->scene->surfaces[plan->surface],
                           .primitive =
                               alpi_gltf_primitive(p->document, plan->mesh, plan->primitive),
                           .span = span};
    snprintf(r.owner, sizeof r.owner, "mesh %zu primitive %zu", plan->mesh, plan->primitive);
    alpi_json_find(p->document->text, span, "attributes", &r.attributes);
    alp_result result = plan->packed ? ALP_OK : read_triangles(p, &r);
    if (result == ALP_OK && !plan->packed) {
        result = change_vertices(p, &r, edits == &p->edits);
    }
    if (result == ALP_OK) {
        result = write_pieces(p, edits, &r, primitives);
    }
    destroy_rewrite(p, &r);
    return result;
}

// --- meshes --------------------------------------------------------------------------------------

/// Edits the primitives of plans [first, end), which belong to one mesh.
static alp_result rewrite_mesh(alpi_gltf_patcher *p, alpi_edits *edits, size_t first, size_t end)
{
    alpi_json_span mesh = p->lists[ALPI_GLTF_MESHES].spans[p->plans[first].mesh], primitives;
    if (!alpi_json_find(p->document->text, mesh, "primitives", &primitives)) {
        return alpi_fail(p->context, ALP_ERROR_INVALID_DATA, "%s: mesh %zu has no primitives",
                         p->document->path, p->plans[first].mesh);
    }
    alpi_json_cursor cursor = alpi_json_open(p->document->text, primitives);
    for (size_t i = first; i < end && alpi_json_next(&cursor);) {
        if (cursor.index == p->plans[i].primitive) {
            ALP_TRY(rewrite_primitive(p, edits, &p->plans[i], cursor.value, primitives));
            i++;
        }
    }
    return ALP_OK;
}

/// The user's nodes get a copy of their mesh; what it does not change it shares with the original.
static alp_result copy_mesh(alpi_gltf_patcher *p, size_t first, size_t end)
{
    const alpi_gltf_plan *plan = &p->plans[first];
    alpi_edits edits = alpi_edits_create(p->context, p->document->text);
    alpi_bytes text = alpi_bytes_create(p->context);
    alp_result result = rewrite_mesh(p, &edits, first, end);
    if (result == ALP_OK) {
        result = alpi_edits_apply(&edits, p->lists[ALPI_GLTF_MESHES].spans[plan->mesh], &text);
    }
    if (result == ALP_OK) {
        size_t mesh = alpi_patcher_append(p, ALPI_GLTF_MESHES, text.bytes, text.size);
        for (size_t i = plan->showing_first; i < plan->showing_end; i++) {
            alpi_patcher_show(p, p->showings[i].node, mesh);
        }
    }
    alpi_bytes_destroy(&text);
    alpi_edits_destroy(&edits);
    return result;
}

alp_result alpi_patcher_meshes(alpi_gltf_patcher *p)
{
    for (size_t first = 0, end; first < p->plan_count; first = end) {
        for (end = first + 1; end < p->plan_count && p->plans[end].user == p->plans[first].user;) {
            end++;
        }
        ALP_TRY(p->plans[first].in_a_copy ? copy_mesh(p, first, end)
                                          : rewrite_mesh(p, &p->edits, first, end));
    }
    if (p->plain_count > 0) {
        alpi_warn(p->context, "compression", p->document->path,
                  "compressed primitives, written uncompressed because they gain an attribute or "
                  "are split: %zu",
                  p->plain_count);
    }
    return ALP_OK;
}
