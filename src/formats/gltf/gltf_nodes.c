// SPDX-License-Identifier: MIT
// The node hierarchy: proves that it is a set of trees, then walks the default scene. No recursion:
// a file may nest nodes as deep as it is long.
#include "formats/gltf/gltf_read.h"

#include "base/memory.h"
#include "formats/gltf/gltf_animation.h"
#include "formats/gltf/gltf_tree.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void name_node(char owner[ALPI_GLTF_OWNER_SIZE], size_t node)
{
    snprintf(owner, ALPI_GLTF_OWNER_SIZE, "node %zu", node);
}

/// Element `i` of an array of node indices.
static alp_result read_node_index(const alpi_gltf_reader *reader, json_t *array, size_t i,
                                  const char *owner, uint32_t *node)
{
    json_t *value = json_array_get(array, i);
    double number = json_is_number(value) ? json_number_value(value) : -1.0;
    if (!(number >= 0.0 && number < (double)reader->node_count) || number != floor(number)) {
        return alpi_gltf_fail(reader->document, owner,
                              "its entry %zu is not the index of a node (there are %u)", i,
                              reader->node_count);
    }
    *node = (uint32_t)number;
    return ALP_OK;
}

static alp_result read_children(const alpi_gltf_reader *reader, uint32_t node, json_t **children)
{
    char owner[ALPI_GLTF_OWNER_SIZE];
    name_node(owner, node);
    *children = json_object_get(alpi_gltf_item(reader->document, "nodes", node), "children");
    if (*children != NULL && !json_is_array(*children)) {
        return alpi_gltf_fail(reader->document, owner, "children must be an array");
    }
    return ALP_OK;
}

// --- trees --------------------------------------------------------------------------------------

/// Fills parent[], ALPI_NONE for roots. A node with two parents is an error.
static alp_result find_parents(const alpi_gltf_reader *reader, uint32_t *parent)
{
    for (uint32_t i = 0; i < reader->node_count; i++) {
        parent[i] = ALPI_NONE;
    }
    for (uint32_t i = 0; i < reader->node_count; i++) {
        char owner[ALPI_GLTF_OWNER_SIZE];
        name_node(owner, i);
        json_t *children;
        ALP_TRY(read_children(reader, i, &children));
        for (size_t k = 0; k < json_array_size(children); k++) {
            uint32_t child = 0;
            ALP_TRY(read_node_index(reader, children, k, owner, &child));
            if (parent[child] != ALPI_NONE) {
                return alpi_gltf_fail(reader->document, owner,
                                      "its child %u is a child of node %u already", child,
                                      parent[child]);
            }
            parent[child] = i;
        }
    }
    return ALP_OK;
}

/// Walks up from every node, each edge once: meeting this walk's own mark closes a cycle.
static alp_result find_cycles(const alpi_gltf_reader *reader, const uint32_t *parent,
                              uint32_t *walk)
{
    for (uint32_t i = 0; i < reader->node_count; i++) {
        walk[i] = ALPI_NONE;
    }
    for (uint32_t i = 0; i < reader->node_count; i++) {
        uint32_t node = i;
        while (node != ALPI_NONE && walk[node] == ALPI_NONE) {
            walk[node] = i;
            node = parent[node];
        }
        if (node != ALPI_NONE && walk[node] == i) {
            char owner[ALPI_GLTF_OWNER_SIZE];
            name_node(owner, node);
            return alpi_gltf_fail(reader->document, owner,
                                  "is its own ancestor: the nodes form a cycle");
        }
    }
    return ALP_OK;
}

// --- transforms ---------------------------------------------------------------------------------

mat4 alpi_gltf_compose(const double t[3], const double q[4], const double s[3])
{
    double x = q[0], y = q[1], z = q[2], w = q[3];
    return (mat4){{s[0] * (1 - 2 * (y * y + z * z)), s[0] * 2 * (x * y + w * z),
                   s[0] * 2 * (x * z - w * y), 0,                                //
                   s[1] * 2 * (x * y - w * z), s[1] * (1 - 2 * (x * x + z * z)), //
                   s[1] * 2 * (y * z + w * x), 0,                                //
                   s[2] * 2 * (x * z + w * y), s[2] * 2 * (y * z - w * x),       //
                   s[2] * (1 - 2 * (x * x + y * y)), 0, t[0], t[1], t[2], 1}};
}

/// Replaces what an animation sets.
static void take_moment(const alpi_gltf_moment *m, double t[3], double q[4], double s[3])
{
    if (m->set[ALPI_GLTF_TRANSLATION]) {
        memcpy(t, m->translation, sizeof m->translation);
    }
    if (m->set[ALPI_GLTF_ROTATION]) {
        memcpy(q, m->rotation, sizeof m->rotation);
    }
    if (m->set[ALPI_GLTF_SCALE]) {
        memcpy(s, m->scale, sizeof m->scale);
    }
}

static alp_result read_transform(const alpi_gltf_reader *reader, uint32_t node, mat4 *local)
{
    const alpi_gltf_document *document = reader->document;
    json_t *object = alpi_gltf_item(document, "nodes", node);
    char owner[ALPI_GLTF_OWNER_SIZE];
    name_node(owner, node);
    *local = mat4_identity();
    if (json_object_get(object, "matrix") != NULL) {
        return alpi_gltf_numbers(document, object, "matrix", owner, 16, local->m);
    }
    double t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
    ALP_TRY(alpi_gltf_numbers(document, object, "translation", owner, 3, t));
    ALP_TRY(alpi_gltf_numbers(document, object, "rotation", owner, 4, q));
    ALP_TRY(alpi_gltf_numbers(document, object, "scale", owner, 3, s));
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(length > 0.0) || !isfinite(length)) {
        return alpi_gltf_fail(document, owner, "rotation is not a quaternion: its length is %g",
                              length);
    }
    if (fabs(length - 1.0) > 1e-3) {
        alpi_warn(reader->context, "rotation", owner,
                  "the rotation's length is %g: it is normalised", length);
    }
    for (int k = 0; k < 4; k++) {
        q[k] /= length;
    }
    if (reader->moments != NULL) {
        take_moment(&reader->moments[node], t, q, s);
    }
    *local = alpi_gltf_compose(t, q, s);
    return ALP_OK;
}

// --- the walk -----------------------------------------------------------------------------------

/// A stack of nodes to visit; there is room for all of them.
typedef struct node_stack {
    uint32_t *nodes;
    uint32_t count;
} node_stack;

/// Says which scenes there are to choose from.
static alp_result refuse_choice(const alpi_gltf_reader *reader, size_t count)
{
    enum { TOLD = 8 };
    const alpi_gltf_document *document = reader->document;
    char list[400] = "", choice[100], numbers[80] = "it has none";
    size_t used = 0;
    for (size_t i = 0; i < count && i < TOLD && used < sizeof list; i++) {
        const char *name = alpi_gltf_text(alpi_gltf_item(document, "scenes", i), "name");
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%zu%s%.30s%s",
                                 i > 0 ? ", " : "", i, name != NULL ? " \"" : "",
                                 name != NULL ? name : "", name != NULL ? "\"" : "");
    }
    if (count == 1) {
        snprintf(numbers, sizeof numbers, "its only one is ");
    } else if (count > 1) {
        snprintf(numbers, sizeof numbers, "its scenes are numbered 0 to %zu: ", count - 1);
    }
    snprintf(choice, sizeof choice, "%s", reader->choice);
    alpi_gltf_clean(choice);
    alpi_gltf_clean(list);
    return alpi_fail(reader->context, ALP_ERROR_INVALID_ARGUMENT, "%s: has no scene \"%s\"; %s%s%s",
                     document->path, choice, numbers, list, count > TOLD ? " and more" : "");
}

/// The scene that was asked for, else the default one, else the first.
static alp_result choose_scene(const alpi_gltf_reader *reader, size_t *scene)
{
    const alpi_gltf_document *document = reader->document;
    const size_t count = alpi_gltf_count(document, "scenes");
    ALP_TRY(alpi_gltf_index(document, document->root, "scene", "scenes", "scene", scene));
    *scene = *scene == ALPI_GLTF_NONE ? 0 : *scene;
    if (reader->choice == NULL) {
        if (count > 1) {
            const char *name = alpi_gltf_text(alpi_gltf_item(document, "scenes", *scene), "name");
            char shown[60];
            snprintf(shown, sizeof shown, "%s", name != NULL ? name : "");
            alpi_gltf_clean(shown);
            alpi_note(reader->context, "scenes", document->path,
                      "of its %zu scenes, number %zu%s%s%s is read, the default of the file", count,
                      *scene, name != NULL ? " (" : "", shown, name != NULL ? ")" : "");
        }
        return ALP_OK;
    }
    char *end;
    const unsigned long long number = strtoull(reader->choice, &end, 10);
    if (reader->choice[0] >= '0' && reader->choice[0] <= '9' && *end == '\0' && number < count) {
        *scene = (size_t)number;
        return ALP_OK;
    }
    for (size_t i = 0; i < count; i++) {
        const char *name = alpi_gltf_text(alpi_gltf_item(document, "scenes", i), "name");
        if (name != NULL && strcmp(name, reader->choice) == 0) {
            *scene = i;
            return ALP_OK;
        }
    }
    return refuse_choice(reader, count);
}

/// Pushes the roots of the chosen scene, the last one first. All roots where there is no scene.
static alp_result push_roots(const alpi_gltf_reader *reader, const uint32_t *parent, bool *seen,
                             node_stack *stack)
{
    const alpi_gltf_document *document = reader->document;
    size_t scene;
    ALP_TRY(choose_scene(reader, &scene));
    if (alpi_gltf_count(document, "scenes") == 0) {
        for (uint32_t i = reader->node_count; i-- > 0;) {
            if (parent[i] == ALPI_NONE) {
                stack->nodes[stack->count++] = i;
            }
        }
        return ALP_OK;
    }
    char owner[ALPI_GLTF_OWNER_SIZE];
    snprintf(owner, sizeof owner, "scene %zu", scene);
    json_t *nodes = json_object_get(alpi_gltf_item(document, "scenes", scene), "nodes");
    if (nodes != NULL && !json_is_array(nodes)) {
        return alpi_gltf_fail(document, owner, "nodes must be an array");
    }
    for (size_t i = json_array_size(nodes); i-- > 0;) {
        uint32_t node = 0;
        ALP_TRY(read_node_index(reader, nodes, i, owner, &node));
        if (seen[node]) {
            return alpi_gltf_fail(document, owner, "names node %u twice", node);
        }
        if (parent[node] != ALPI_NONE) {
            return alpi_gltf_fail(document, owner,
                                  "names node %u, which is not a root but a child of node %u", node,
                                  parent[node]);
        }
        seen[node] = true;
        stack->nodes[stack->count++] = node;
    }
    return ALP_OK;
}

/// Whether a node is hidden by KHR_node_visibility: its own, or that of one above it.
static bool is_hidden(const alpi_gltf_reader *reader, const uint32_t *parent, uint32_t node)
{
    json_t *visibility =
        alpi_gltf_extension(alpi_gltf_item(reader->document, "nodes", node), "KHR_node_visibility");
    return json_is_false(json_object_get(visibility, "visible")) ||
           (parent[node] != ALPI_NONE && reader->hidden[parent[node]]);
}

static alp_result walk(alpi_gltf_reader *reader, const uint32_t *parent, node_stack *stack)
{
    while (stack->count > 0) {
        uint32_t node = stack->nodes[--stack->count];
        reader->hidden[node] = is_hidden(reader, parent, node); // after its parent
        mat4 local;
        ALP_TRY(read_transform(reader, node, &local));
        reader->world[node] =
            parent[node] == ALPI_NONE ? local : mat4_multiply(&reader->world[parent[node]], &local);
        reader->order[reader->order_count++] = node;
        reader->placed[node] = true;
        json_t *children;
        ALP_TRY(read_children(reader, node, &children));
        for (size_t k = json_array_size(children); k-- > 0;) {
            // Checked by find_parents.
            stack->nodes[stack->count++] = (uint32_t)json_number_value(json_array_get(children, k));
        }
    }
    return ALP_OK;
}

/// Memory of alpi_gltf_read_nodes, to be released at one place.
typedef struct work {
    uint32_t *parent, *marks;
    bool *seen;
    node_stack stack;
} work;

static alp_result read_trees(alpi_gltf_reader *reader, work *w)
{
    uint32_t count = reader->node_count;
    ALPI_TRY_NEW(reader->context, w->parent, count);
    ALPI_TRY_NEW(reader->context, w->marks, count);
    ALPI_TRY_NEW(reader->context, w->seen, count);
    ALPI_TRY_NEW(reader->context, w->stack.nodes, count);
    ALPI_TRY_NEW(reader->context, reader->world, count);
    ALPI_TRY_NEW(reader->context, reader->order, count);
    ALPI_TRY_NEW(reader->context, reader->placed, count);
    ALPI_TRY_NEW(reader->context, reader->hidden, count);
    ALP_TRY(find_parents(reader, w->parent));
    ALP_TRY(find_cycles(reader, w->parent, w->marks));
    ALP_TRY(push_roots(reader, w->parent, w->seen, &w->stack));
    return walk(reader, w->parent, &w->stack);
}

alp_result alpi_gltf_read_nodes(alpi_gltf_reader *reader)
{
    size_t count = alpi_gltf_count(reader->document, "nodes");
    if (count >= ALPI_NONE) {
        return alpi_fail(reader->context, ALP_ERROR_LIMIT, "%s: %zu nodes are too many",
                         reader->document->path, count);
    }
    reader->node_count = (uint32_t)count;
    work w = {0};
    alp_result result = read_trees(reader, &w);
    alpi_release(reader->context, w.parent);
    alpi_release(reader->context, w.marks);
    alpi_release(reader->context, w.seen);
    alpi_release(reader->context, w.stack.nodes);
    return result;
}

// --- names ---------------------------------------------------------------------------------------

char *alpi_gltf_surface_name(const alpi_gltf_reader *reader, const alpi_surface *surface)
{
    json_t *node = alpi_gltf_item(reader->document, "nodes", surface->node);
    json_t *mesh = alpi_gltf_item(reader->document, "meshes", surface->mesh);
    const char *node_name = alpi_gltf_text(node, "name"), *mesh_name = alpi_gltf_text(mesh, "name");
    if (node_name != NULL && node_name[0] != '\0') {
        return alpi_gltf_copy_name(reader->context, node);
    }
    if (mesh_name != NULL && mesh_name[0] != '\0') {
        return alpi_gltf_copy_name(reader->context, mesh);
    }
    return alpi_format(reader->context, "node %u", surface->node);
}
