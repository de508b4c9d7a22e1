// SPDX-License-Identifier: MIT
// Which primitives get a map: their coordinate set, their pages, and whether their mesh can be
// edited where it stands or must be copied for the node.
#include "formats/gltf/write/gltf_patch_plan.h"

#include "base/memory.h"
#include "formats/gltf/gltf_tree.h"
#include "formats/gltf/write/gltf_patch_instances.h"
#include "formats/gltf/write/gltf_patch_material.h"
#include "formats/gltf/write/gltf_patch_sets.h"
#include "formats/gltf/write/gltf_patch_users.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

json_t *alpi_gltf_primitive(const alpi_gltf_document *document, size_t mesh, size_t primitive)
{
    json_t *primitives = json_object_get(alpi_gltf_item(document, "meshes", mesh), "primitives");
    json_t *item = json_array_get(primitives, primitive);
    return json_is_object(item) ? item : NULL;
}

static bool keeps_uvs(const alpi_gltf_patcher *p)
{
    return p->patch->corner_uvs == NULL && p->patch->vertex_values == NULL;
}

// --- pages of triangles --------------------------------------------------------------------------

/// Whether a surface gets a map: one that does has pages on all its triangles.
static bool has_pages(const alpi_gltf_patcher *p, const alpi_surface *surface)
{
    return surface->triangle_count > 0 && (p->patch->triangle_pages == NULL ||
                                           p->triangle_pages[surface->first_triangle] != ALPI_NONE);
}

/// A triangle without area is seen by nobody: it goes where the one before it goes, so that no
/// primitive is split for its sake.
static alp_result fill_pages(alpi_gltf_patcher *p)
{
    const alp_scene *scene = p->scene;
    const uint32_t *given = p->patch->triangle_pages;
    ALPI_TRY_NEW(p->context, p->triangle_pages, scene->triangle_count);
    for (uint32_t s = 0; given != NULL && s < scene->surface_count; s++) {
        uint32_t first = scene->surfaces[s].first_triangle;
        uint32_t end = first + scene->surfaces[s].triangle_count;
        uint32_t page = first < end ? given[first] : 0;
        for (uint32_t t = first; t < end; t++) {
            if (scene->triangle_usable[t]) {
                page = given[t];
                break;
            }
        }
        const bool left_out = page == ALPI_NONE;
        for (uint32_t t = first; t < end; t++) {
            page = scene->triangle_usable[t] ? given[t] : page;
            p->triangle_pages[t] = page;
            if (left_out ? page != ALPI_NONE : page >= p->patch->page_count) {
                return alpi_fail(p->context, ALP_ERROR_INVALID_ARGUMENT,
                                 "%s: triangle %u lies on page %u of %u", scene->name, t, page,
                                 p->patch->page_count);
            }
        }
    }
    return ALP_OK;
}

// --- one plan a surface --------------------------------------------------------------------------

static bool has_texcoord(json_t *primitive, uint32_t set)
{
    char name[32];
    snprintf(name, sizeof name, "TEXCOORD_%u", set);
    return json_object_get(json_object_get(primitive, "attributes"), name) != NULL;
}

static alp_result find_mesh(const alpi_gltf_patcher *p, size_t node, size_t *mesh)
{
    char owner[ALPI_GLTF_OWNER_SIZE];
    node = alpi_patcher_file_node(p, node);
    snprintf(owner, sizeof owner, "node %zu", node);
    return alpi_gltf_needed_index(p->document, alpi_gltf_item(p->document, "nodes", node), "mesh",
                                  "meshes", owner, mesh);
}

/// Whose mesh the node of a surface shows: its own, or that of the surface whose coordinates it has
/// too, where both nodes have one mesh.
static alp_result find_user(const alpi_gltf_patcher *p, uint32_t index, alpi_gltf_plan *plan)
{
    const uint32_t *originals = p->patch->originals;
    plan->user = keeps_uvs(p) ? plan->mesh : alpi_patcher_node_of(p, index);
    if (!keeps_uvs(p) && originals != NULL && originals[index] != index) {
        size_t mesh, node = alpi_patcher_node_of(p, originals[index]);
        ALP_TRY(find_mesh(p, node, &mesh));
        plan->user = mesh == plan->mesh ? node : plan->user;
    }
    return ALP_OK;
}

/// Plans one surface; *wanted is false when it stays as it is.
static alp_result plan_surface(alpi_gltf_patcher *p, uint32_t index, alpi_gltf_plan *plan,
                               bool *wanted)
{
    const alpi_surface *surface = &p->scene->surfaces[index];
    char owner[ALPI_GLTF_OWNER_SIZE];
    *wanted = false;
    if (!has_pages(p, surface)) {
        return ALP_OK;
    }
    *plan = (alpi_gltf_plan){.surface = index, .primitive = p->exported ? 0 : surface->primitive};
    ALP_TRY(find_mesh(p, alpi_patcher_node_of(p, index), &plan->mesh));
    ALP_TRY(find_user(p, index, plan));
    json_t *primitive = alpi_gltf_primitive(p->document, plan->mesh, plan->primitive);
    snprintf(owner, sizeof owner, "mesh %zu primitive %zu", plan->mesh, plan->primitive);
    if (primitive == NULL) {
        return alpi_gltf_fail(p->document, owner, "is in the scene, but not in the file");
    }
    ALP_TRY(
        alpi_gltf_index(p->document, primitive, "material", "materials", owner, &plan->material));
    alpi_patcher_choose_maps(p, plan);
    *wanted = plan->packed || plan->occluded || plan->lit;
    if (!*wanted) {
        return ALP_OK;
    }
    if (!plan->packed && keeps_uvs(p) && !has_texcoord(primitive, p->patch->kept_uv_set)) {
        *wanted = false;
        alpi_warn(p->context, "no-uv-set", surface->name, "%s has no TEXCOORD_%u: it gets no map",
                  owner, p->patch->kept_uv_set);
        return ALP_OK;
    }
    return alpi_patcher_choose_sets(p, primitive, owner, plan);
}

static int compare_plans(const void *left, const void *right)
{
    const alpi_gltf_plan *a = left, *b = right;
    if (a->user != b->user) {
        return a->user < b->user ? -1 : 1;
    }
    if (a->primitive != b->primitive) {
        return a->primitive < b->primitive ? -1 : 1;
    }
    return a->surface < b->surface ? -1 : a->surface > b->surface;
}

/// Drops second plans for the same primitive of the same user: its other nodes see the map of the
/// first. That was asked for with `originals`; with kept coordinates it may surprise.
static void drop_repeated(alpi_gltf_patcher *p)
{
    size_t kept = 0, told = ALPI_GLTF_NONE;
    const bool expected = p->patch->originals != NULL;
    for (size_t i = 0; i < p->plan_count; i++) {
        const alpi_gltf_plan *plan = &p->plans[i];
        const alpi_gltf_plan *last = kept > 0 ? &p->plans[kept - 1] : NULL;
        if (last == NULL || plan->user != last->user || plan->primitive != last->primitive) {
            p->plans[kept++] = *plan;
        } else if (plan->mesh != told && !expected) {
            told = plan->mesh;
            char owner[ALPI_GLTF_OWNER_SIZE];
            snprintf(owner, sizeof owner, "mesh %zu", plan->mesh);
            alpi_note(p->context, "shared-mesh", owner,
                      "several nodes use this mesh with kept coordinates: all use the same map");
        }
    }
    p->plan_count = kept;
}

static int compare_showings(const void *left, const void *right)
{
    const alpi_gltf_showing *a = left, *b = right;
    if (a->user != b->user) {
        return a->user < b->user ? -1 : 1;
    }
    return a->node < b->node ? -1 : a->node > b->node;
}

/// The nodes of every user, each once, from the plans of all surfaces.
static alp_result list_showings(alpi_gltf_patcher *p)
{
    ALPI_TRY_NEW(p->context, p->showings, p->plan_count);
    for (size_t i = 0; i < p->plan_count; i++) {
        p->showings[i] =
            (alpi_gltf_showing){p->plans[i].user, alpi_patcher_node_of(p, p->plans[i].surface)};
    }
    if (p->plan_count > 0) {
        qsort(p->showings, p->plan_count, sizeof *p->showings, compare_showings);
    }
    for (size_t i = 0; i < p->plan_count; i++) {
        if (i == 0 || compare_showings(&p->showings[p->showing_count - 1], &p->showings[i]) != 0) {
            p->showings[p->showing_count++] = p->showings[i];
        }
    }
    return ALP_OK;
}

// --- in place or in a copy -----------------------------------------------------------------------

/// How often nodes of the document use each mesh, those outside the read scene included.
static alp_result count_mesh_users(const alpi_gltf_patcher *p, size_t *users)
{
    size_t count = p->lists[ALPI_GLTF_NODES].count;
    for (size_t i = 0; i < count; i++) {
        char owner[ALPI_GLTF_OWNER_SIZE];
        snprintf(owner, sizeof owner, "node %zu", i);
        size_t mesh;
        ALP_TRY(alpi_gltf_index(p->document, alpi_gltf_item(p->document, "nodes", i), "mesh",
                                "meshes", owner, &mesh));
        if (mesh != ALPI_GLTF_NONE) {
            users[mesh] += p->instance_counts[i] > 0 ? p->instance_counts[i] : 1;
        }
    }
    return ALP_OK;
}

/// The first user of a mesh may have the original, if every node that uses the mesh gets a map.
static void choose_copies(alpi_gltf_patcher *p, const size_t *users, size_t *ours, bool *taken)
{
    for (size_t i = 0, at = 0; i < p->plan_count; i++) {
        alpi_gltf_plan *plan = &p->plans[i];
        plan->showing_first = at;
        while (at < p->showing_count && p->showings[at].user == plan->user) {
            at++;
        }
        plan->showing_end = at;
        ours[plan->mesh] += at - plan->showing_first; // 0 for further plans of a user
    }
    for (size_t i = 0; i < p->plan_count; i++) {
        alpi_gltf_plan *plan = &p->plans[i];
        if (i > 0 && plan->user == plan[-1].user) {
            plan->in_a_copy = plan[-1].in_a_copy;
        } else {
            plan->in_a_copy = taken[plan->mesh] || users[plan->mesh] != ours[plan->mesh];
            taken[plan->mesh] = true;
        }
    }
}

static alp_result plan_copies(alpi_gltf_patcher *p)
{
    size_t count = p->lists[ALPI_GLTF_MESHES].count;
    size_t *users = ALPI_NEW(p->context, size_t, count);
    size_t *ours = ALPI_NEW(p->context, size_t, count);
    bool *taken = ALPI_NEW(p->context, bool, count);
    alp_result result = ALP_ERROR_OUT_OF_MEMORY;
    if (users != NULL && ours != NULL && taken != NULL) {
        result = count_mesh_users(p, users);
        if (result == ALP_OK) {
            choose_copies(p, users, ours, taken);
        }
    }
    alpi_release(p->context, users);
    alpi_release(p->context, ours);
    alpi_release(p->context, taken);
    return result;
}

// --- pieces --------------------------------------------------------------------------------------

static alp_result add_piece(alpi_gltf_patcher *p, uint32_t page)
{
    void *items = p->pieces;
    ALP_TRY(
        alpi_grow(p->context, &items, &p->piece_capacity, p->piece_count + 1, sizeof *p->pieces));
    p->pieces = items;
    p->pieces[p->piece_count++] = (alpi_gltf_piece){.page = page, .material = ALPI_GLTF_NONE};
    return ALP_OK;
}

/// Values at vertices: the primitive stays whole and keeps its material.
static alp_result plan_whole(alpi_gltf_patcher *p, alpi_gltf_plan *plan)
{
    plan->piece_first = p->piece_count;
    plan->piece_count = 1;
    ALP_TRY(add_piece(p, 0));
    p->pieces[plan->piece_first].material = plan->material;
    return ALP_OK;
}

/// One piece for each page that the plan's triangles lie on, in ascending order; where the map is
/// packed into an image, just one.
static alp_result plan_pieces(alpi_gltf_patcher *p, alpi_gltf_plan *plan, bool *used)
{
    const alpi_surface *surface = &p->scene->surfaces[plan->surface];
    plan->piece_first = p->piece_count;
    plan->piece_count = 1;
    if (plan->packed) {
        return add_piece(p, ALPI_NONE);
    }
    memset(used, 0, p->patch->page_count * sizeof *used);
    for (uint32_t i = 0; i < surface->triangle_count; i++) {
        used[p->triangle_pages[surface->first_triangle + i]] = true;
    }
    for (uint32_t page = 0; page < p->patch->page_count; page++) {
        if (used[page]) {
            ALP_TRY(add_piece(p, page));
        }
    }
    plan->piece_count = p->piece_count - plan->piece_first;
    return ALP_OK;
}

alp_result alpi_patcher_plan(alpi_gltf_patcher *p)
{
    bool at_vertices = p->patch->vertex_values != NULL;
    if (p->patch->page_count == 0 && !at_vertices) {
        return alpi_fail(p->context, ALP_ERROR_INVALID_ARGUMENT, "%s: a patch without pages",
                         p->scene->name);
    }
    ALP_TRY(fill_pages(p));
    ALPI_TRY_NEW(p->context, p->plans, p->scene->surface_count);
    for (uint32_t s = 0; s < p->scene->surface_count; s++) {
        bool wanted;
        ALP_TRY(plan_surface(p, s, &p->plans[p->plan_count], &wanted));
        p->plan_count += wanted;
    }
    if (p->plan_count > 0) {
        qsort(p->plans, p->plan_count, sizeof *p->plans, compare_plans);
    }
    ALP_TRY(list_showings(p));
    drop_repeated(p);
    alpi_patcher_warn_of_sets(p);
    ALP_TRY(plan_copies(p));
    bool *used = ALPI_NEW(p->context, bool, p->patch->page_count);
    alp_result result = used == NULL ? ALP_ERROR_OUT_OF_MEMORY : ALP_OK;
    for (size_t i = 0; result == ALP_OK && i < p->plan_count; i++) {
        result = at_vertices ? plan_whole(p, &p->plans[i]) : plan_pieces(p, &p->plans[i], used);
    }
    alpi_release(p->context, used);
    return result;
}
