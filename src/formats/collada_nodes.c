// SPDX-License-Identifier: MIT
// The walk over the nodes of the visual scene, those that <instance_node> brings in included. No
// recursion: a stack of elements that are being read; a node on the stack may not come again.
#include "formats/collada_read.h"

#include "base/memory.h"
#include "formats/collada_numbers.h"

#include <string.h>

/// Nodes may show nodes many times over and so may multiply a small file.
enum { VISIT_LIMIT = 1 << 22 };

/// An element whose children are being read.
typedef struct frame {
    xmlNode *element; // visual_scene or node
    xmlNode *next;    // child that comes next
    xmlNode *outer;   // outermost <instance_node> on the way here
    mat4 matrix;
} frame;

typedef struct walk {
    alpi_collada_reader *reader;
    frame *stack;
    size_t depth, capacity;
    bool *open; // [elements] on the stack
    uint32_t visits;
} walk;

/// The matrix by value: it may lie in the stack, which moves as it grows.
static alp_result enter(walk *w, xmlNode *element, mat4 matrix, xmlNode *outer)
{
    alpi_collada_reader *reader = w->reader;
    const uint32_t index = alpi_xml_index(element);
    if (w->open[index]) {
        return alpi_collada_fail(reader->document, element,
                                 "contains itself by way of <instance_node>; break the circle");
    }
    if (++w->visits > VISIT_LIMIT) {
        return alpi_fail(reader->context, ALP_ERROR_LIMIT,
                         "%s: its nodes are shown more than %d times; split the scene",
                         reader->document->path, VISIT_LIMIT);
    }
    ALP_TRY(alpi_collada_grow(reader->context, &w->stack, &w->capacity, w->depth + 1,
                              sizeof *w->stack));
    w->stack[w->depth++] = (frame){element, alpi_xml_child(element, NULL), outer, matrix};
    w->open[index] = true;
    return ALP_OK;
}

// --- what nodes show -----------------------------------------------------------------------------

static alp_result place(alpi_collada_reader *reader, xmlNode *instance, const frame *at,
                        xmlNode *geometry, const mat4 *matrix)
{
    uint32_t mesh;
    ALP_TRY(alpi_collada_read_mesh(reader, geometry, &mesh));
    if (mesh == ALPI_NONE) {
        return ALP_OK;
    }
    ALP_TRY(alpi_collada_grow(reader->context, &reader->placements, &reader->placement_capacity,
                              reader->placement_count + 1, sizeof *reader->placements));
    reader->placements[reader->placement_count++] =
        (alpi_collada_placement){instance, at->element, at->outer, mesh, *matrix};
    return ALP_OK;
}

/// <instance_controller>: the mesh of a skin or morph as it stands before it is deformed.
static alp_result place_controlled(alpi_collada_reader *reader, xmlNode *instance, const frame *at)
{
    enum { CHAIN_LIMIT = 16 }; // a skin of a morph of a geometry
    const alpi_collada_document *document = reader->document;
    mat4 matrix = at->matrix;
    xmlNode *controller = NULL;
    ALP_TRY(alpi_collada_resolve(document, instance, "url", "controller", &controller));
    for (int i = 0; controller != NULL && i < CHAIN_LIMIT; i++) {
        const xmlNode *skin = alpi_xml_child(controller, "skin");
        const xmlNode *morph = alpi_xml_child(controller, "morph");
        const xmlNode *kind = skin != NULL ? skin : morph;
        const xmlNode *bind = alpi_xml_child(skin, "bind_shape_matrix");
        if (kind == NULL) {
            return alpi_collada_fail(document, controller, "has neither <skin> nor <morph>");
        }
        reader->skinned += skin != NULL;
        reader->morphed += skin == NULL;
        if (bind != NULL) {
            double rows[16];
            ALP_TRY(alpi_collada_doubles(document, bind, 16, rows));
            mat4 shape;
            for (int k = 0; k < 16; k++) {
                shape.m[4 * (k % 4) + k / 4] = rows[k];
            }
            matrix = mat4_multiply(&matrix, &shape);
        }
        const char *url = alpi_xml_attribute(kind, "source");
        xmlNode *target = alpi_collada_find(document, url != NULL && *url == '#' ? url + 1 : url);
        if (alpi_xml_is(target, "geometry")) {
            return place(reader, instance, at, target, &matrix);
        }
        ALP_TRY(alpi_collada_resolve(document, kind, "source", "controller", &controller));
    }
    return controller == NULL ? ALP_OK
                              : alpi_collada_fail(document, instance,
                                                  "its controllers follow one another in a "
                                                  "circle");
}

static alp_result add_fixture(alpi_collada_reader *reader, xmlNode *instance, const frame *at,
                              const char *kind)
{
    xmlNode *target = NULL;
    ALP_TRY(alpi_collada_resolve(reader->document, instance, "url", kind, &target));
    if (target == NULL) {
        return ALP_OK;
    }
    ALP_TRY(alpi_collada_grow(reader->context, &reader->fixtures, &reader->fixture_capacity,
                              reader->fixture_count + 1, sizeof *reader->fixtures));
    reader->fixtures[reader->fixture_count++] =
        (alpi_collada_fixture){instance, target, at->matrix};
    return ALP_OK;
}

/// One child of a node.
static alp_result visit(walk *w, xmlNode *child, frame *at)
{
    alpi_collada_reader *reader = w->reader;
    mat4 matrix;
    bool is_transform = false;
    xmlNode *target = NULL;
    ALP_TRY(alpi_collada_read_transform(reader->document, child, &matrix, &is_transform));
    if (is_transform) {
        at->matrix = mat4_multiply(&at->matrix, &matrix);
        return ALP_OK;
    }
    if (alpi_xml_is(child, "node")) {
        return enter(w, child, at->matrix, at->outer);
    }
    if (alpi_xml_is(child, "instance_node")) {
        ALP_TRY(alpi_collada_resolve(reader->document, child, "url", "node", &target));
        xmlNode *outer = at->outer != NULL ? at->outer : child;
        return target != NULL ? enter(w, target, at->matrix, outer) : ALP_OK;
    }
    if (alpi_xml_is(child, "instance_geometry")) {
        ALP_TRY(alpi_collada_resolve(reader->document, child, "url", "geometry", &target));
        return target != NULL ? place(reader, child, at, target, &at->matrix) : ALP_OK;
    }
    if (alpi_xml_is(child, "instance_controller")) {
        return place_controlled(reader, child, at);
    }
    if (alpi_xml_is(child, "instance_light") || alpi_xml_is(child, "instance_camera")) {
        return add_fixture(reader, child, at, (const char *)child->name + strlen("instance_"));
    }
    return ALP_OK;
}

static alp_result walk_from(walk *w, xmlNode *scene)
{
    ALP_TRY(enter(w, scene, w->reader->root, NULL));
    while (w->depth > 0) {
        frame *at = &w->stack[w->depth - 1];
        xmlNode *child = at->next;
        if (child == NULL) {
            w->open[alpi_xml_index(at->element)] = false;
            w->depth--;
            continue;
        }
        at->next = alpi_xml_next(child, NULL);
        ALP_TRY(visit(w, child, at));
    }
    return ALP_OK;
}

// --- which scene ---------------------------------------------------------------------------------

/// Geometries that no node shows: placed where they stand, so that the file is not empty.
static alp_result place_all(alpi_collada_reader *reader)
{
    const alpi_collada_document *document = reader->document;
    for (uint32_t i = 0; i < document->element_count; i++) {
        xmlNode *element = document->elements[i];
        if (alpi_xml_is(element, "geometry")) {
            const frame at = {.element = element, .matrix = reader->root};
            ALP_TRY(place(reader, element, &at, element, &at.matrix));
        }
    }
    if (reader->placement_count > 0) {
        alpi_warn(reader->context, "no-scene", document->path,
                  "has no visual scene: its %u geometries are placed as they stand",
                  reader->placement_count);
    }
    return ALP_OK;
}

static alp_result find_scene(const alpi_collada_reader *reader, xmlNode **scene)
{
    const alpi_collada_document *document = reader->document;
    static const char *const way[] = {"scene", "instance_visual_scene", NULL};
    static const char *const library[] = {"library_visual_scenes", "visual_scene", NULL};
    const xmlNode *instance = alpi_xml_descend(document->root, way);
    *scene = NULL;
    if (instance != NULL) {
        ALP_TRY(alpi_collada_resolve(document, instance, "url", "visual_scene", scene));
    }
    if (*scene == NULL) {
        *scene = alpi_xml_descend(document->root, library);
        if (*scene != NULL) {
            alpi_note(reader->context, "no-scene", document->path,
                      "does not say which visual scene to show: the first is taken");
        }
    }
    return ALP_OK;
}

alp_result alpi_collada_read_nodes(alpi_collada_reader *reader)
{
    xmlNode *scene = NULL;
    ALP_TRY(find_scene(reader, &scene));
    if (scene == NULL) {
        return place_all(reader);
    }
    walk w = {.reader = reader};
    ALPI_TRY_NEW(reader->context, w.open, reader->document->element_count);
    alp_result result = walk_from(&w, scene);
    alpi_release(reader->context, w.open);
    alpi_release(reader->context, w.stack);
    return result;
}
