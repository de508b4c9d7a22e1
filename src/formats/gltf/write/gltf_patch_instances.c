// SPDX-License-Identifier: MIT
// Nodes that show their mesh in instances (EXT_mesh_gpu_instancing). To the plan each instance is a
// node. Where they come to show different meshes, because each has a map of its own, they become
// nodes: children of the one that held them.
#include "formats/gltf/write/gltf_patch_instances.h"

#include "base/memory.h"
#include "formats/gltf/gltf_read.h"
#include "formats/gltf/gltf_tree.h"
#include "formats/gltf/write/gltf_appends.h"

#include <stdio.h>

alp_result alpi_patcher_find_instances(alpi_gltf_patcher *p)
{
    const size_t nodes = p->lists[ALPI_GLTF_NODES].count;
    ALPI_TRY_NEW(p->context, p->instance_counts, nodes);
    ALPI_TRY_NEW(p->context, p->instance_firsts, nodes);
    for (uint32_t s = 0; s < p->scene->surface_count && !p->exported; s++) {
        const alpi_surface *surface = &p->scene->surfaces[s];
        json_t *node = alpi_gltf_item(p->document, "nodes", surface->node);
        if (alpi_gltf_instancing(node) != NULL &&
            p->instance_counts[surface->node] <= surface->instance) {
            p->instance_counts[surface->node] = surface->instance + 1;
        }
    }
    size_t total = 0;
    for (size_t i = 0; i < nodes; i++) {
        p->instance_firsts[i] = total;
        total += p->instance_counts[i];
    }
    ALPI_TRY_NEW(p->context, p->instances, total);
    for (size_t i = 0; i < nodes; i++) {
        size_t mesh = ALPI_GLTF_NONE;
        ALP_TRY(alpi_gltf_index(p->document, alpi_gltf_item(p->document, "nodes", i), "mesh",
                                "meshes", "nodes", &mesh));
        for (size_t k = 0; k < p->instance_counts[i]; k++) {
            p->instances[p->instance_firsts[i] + k] = (alpi_gltf_shown){i, mesh};
        }
    }
    return ALP_OK;
}

size_t alpi_patcher_node_of(const alpi_gltf_patcher *p, uint32_t surface)
{
    if (p->exported) {
        return surface;
    }
    const alpi_surface *shown = &p->scene->surfaces[surface];
    return p->instance_counts[shown->node] == 0
               ? shown->node
               : p->lists[ALPI_GLTF_NODES].count + p->instance_firsts[shown->node] +
                     shown->instance;
}

size_t alpi_patcher_file_node(const alpi_gltf_patcher *p, size_t node)
{
    const size_t nodes = p->lists[ALPI_GLTF_NODES].count;
    return node < nodes ? node : p->instances[node - nodes].node;
}

void alpi_patcher_show(alpi_gltf_patcher *p, size_t node, size_t mesh)
{
    const size_t nodes = p->lists[ALPI_GLTF_NODES].count;
    if (node < nodes) {
        alpi_edits_set_index(&p->edits, p->lists[ALPI_GLTF_NODES].spans[node], "mesh", mesh);
    } else {
        p->instances[node - nodes].mesh = mesh;
    }
}

// --- instances that become nodes -----------------------------------------------------------------

static void print_numbers(alpi_bytes *text, const char *name, const double *values, int count)
{
    alpi_bytes_print(text, ",\"%s\":[", name);
    for (int k = 0; k < count; k++) {
        alpi_bytes_print(text, "%s", k > 0 ? "," : "");
        alpi_bytes_number(text, values[k], 17); // as they were read, so that nothing moves
    }
    alpi_bytes_print(text, "]");
}

/// One instance as a node; default weights of morph targets go with the mesh.
static size_t add_node(alpi_gltf_patcher *p, size_t node, size_t mesh,
                       const alpi_gltf_instance *instance)
{
    alpi_bytes text = alpi_bytes_create(p->context);
    alpi_json_span weights;
    alpi_bytes_print(&text, "{\"mesh\":%zu", mesh);
    print_numbers(&text, "translation", instance->translation, 3);
    print_numbers(&text, "rotation", instance->rotation, 4);
    print_numbers(&text, "scale", instance->scale, 3);
    if (alpi_json_find(p->document->text, p->lists[ALPI_GLTF_NODES].spans[node], "weights",
                       &weights)) {
        alpi_bytes_print(&text, ",\"weights\":");
        alpi_bytes_add(&text, p->document->text + weights.begin, weights.end - weights.begin);
    }
    alpi_bytes_print(&text, "}");
    p->data.failed |= text.failed;
    size_t index = alpi_patcher_append(p, ALPI_GLTF_NODES, text.bytes, text.size);
    alpi_bytes_destroy(&text);
    return index;
}

/// The node keeps its place, name and children, and shows nothing itself any more.
static void empty_node(alpi_gltf_patcher *p, size_t node, const alpi_bytes *children)
{
    static const char name[] = "EXT_mesh_gpu_instancing";
    const char *text = p->document->text, *gone[3] = {"weights"};
    const alpi_json_span span = p->lists[ALPI_GLTF_NODES].spans[node];
    size_t count = 1;
    alpi_json_span array, extensions;
    json_t *object = alpi_gltf_item(p->document, "nodes", node);
    if (json_object_size(json_object_get(object, "extensions")) == 1) {
        gone[count++] = "extensions";
    } else if (alpi_json_find(text, span, "extensions", &extensions)) {
        alpi_edits_remove(&p->edits, extensions, name);
    }
    const bool is_parent = alpi_json_find(text, span, "children", &array);
    if (is_parent) {
        alpi_edits_add(&p->edits, array, NULL, children->bytes, children->size);
        gone[count++] = "mesh";
    }
    alpi_json_cursor cursor = alpi_json_open(text, span);
    while (!is_parent && alpi_json_next(&cursor)) {
        if (alpi_json_key_is(text, cursor.key, "mesh")) {
            alpi_edits_replace(&p->edits, (alpi_json_span){cursor.key.begin, cursor.value.end},
                               "\"children\":[%.*s]", (int)children->size,
                               (const char *)children->bytes);
        }
    }
    alpi_edits_remove_all(&p->edits, span, gone, count);
}

static alp_result expand(alpi_gltf_patcher *p, size_t node)
{
    alpi_gltf_instance *list = NULL;
    uint32_t count;
    char owner[ALPI_GLTF_OWNER_SIZE];
    snprintf(owner, sizeof owner, "node %zu", node);
    ALP_TRY(alpi_gltf_read_instances(p->document, node, &list, &count));
    alpi_bytes children = alpi_bytes_create(p->context);
    for (uint32_t i = 0; i < count && i < p->instance_counts[node]; i++) {
        size_t mesh = p->instances[p->instance_firsts[node] + i].mesh;
        alpi_bytes_print(&children, "%s%zu", i > 0 ? "," : "", add_node(p, node, mesh, &list[i]));
    }
    if (!children.failed) {
        empty_node(p, node, &children);
    }
    p->data.failed |= children.failed;
    p->expanded_count++;
    alpi_note(p->context, "instancing", owner,
              "its instances become nodes, because each has its own map: %u", count);
    alpi_bytes_destroy(&children);
    alpi_release(p->context, list);
    return ALP_OK;
}

alp_result alpi_patcher_expand_instances(alpi_gltf_patcher *p)
{
    for (size_t i = 0; i < p->lists[ALPI_GLTF_NODES].count; i++) {
        const alpi_gltf_shown *shown = p->instances + p->instance_firsts[i];
        bool differ = false;
        for (size_t k = 1; k < p->instance_counts[i]; k++) {
            differ |= shown[k].mesh != shown[0].mesh;
        }
        size_t mesh;
        ALP_TRY(alpi_gltf_index(p->document, alpi_gltf_item(p->document, "nodes", i), "mesh",
                                "meshes", "nodes", &mesh));
        if (differ) {
            ALP_TRY(expand(p, i));
        } else if (p->instance_counts[i] > 0 && shown[0].mesh != mesh) {
            alpi_edits_set_index(&p->edits, p->lists[ALPI_GLTF_NODES].spans[i], "mesh",
                                 shown[0].mesh);
        }
    }
    return ALP_OK;
}
