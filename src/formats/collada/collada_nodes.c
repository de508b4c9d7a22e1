// SPDX-License-Identifier: MIT
// The walk over the nodes of the visual scene, those that <instance_node> brings in included. No
// recursion: a stack of elements that are being read; a node on the stack may not come again.
#include "formats/collada/collada_read.h"

#include "base/memory.h"
#include "formats/collada/collada_numbers.h"

#include <string.h>

/// Nodes may show nodes many times over and so may multiply a small file: what the walk may meet.
enum {
    VISIT_LIMIT = 1 << 24, // elements; a long one counts for as many as it has kilobytes
    PLACE_LIMIT = 1 << 22, // instances of geometries, controllers, lights and cameras
    CHAIN_LIMIT = 16       // a skin of a morph of a geometry
};

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
    const alpi_collada_document *document = reader->document;
    mat4 matrix = at->matrix;
    xmlNode *controller = NULL;
    ALP_TRY(alpi_collada_refer(reader, instance, "url", "controller", &controller));
    for (int i = 0; controller != NULL && i < CHAIN_LIMIT; i++) {
        const xmlNode *skin = alpi_xml_child(controller, "skin");
        const xmlNode *morph = alpi_xml_child(controller, "morph");
        const xmlNode *kind = skin != NULL ? skin : morph;
        const xmlNode *bind = alpi_xml_child(skin, "bind_shape_matrix");
        if (kind == NULL) {
            reader->not_meshes++;
            return ALP_OK;
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
        xmlNode *target = alpi_collada_target(document, kind, "source");
        if (alpi_xml_is(target, "geometry")) {
            return place(reader, instance, at, target, &matrix);
        }
        const bool chained = alpi_xml_is(target, "controller");
        ALP_TRY(alpi_collada_refer(reader, kind, "source", chained ? "controller" : "geometry",
                                   &controller));
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
    ALP_TRY(alpi_collada_refer(reader, instance, "url", kind, &target));
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
        ALP_TRY(alpi_collada_refer(reader, child, "url", "node", &target));
        xmlNode *outer = at->outer != NULL ? at->outer : child;
        return target != NULL ? enter(w, target, at->matrix, outer) : ALP_OK;
    }
    if (alpi_xml_is(child, "instance_geometry")) {
        ALP_TRY(alpi_collada_refer(reader, child, "url", "geometry", &target));
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

// --- how much that will be -----------------------------------------------------------------------

/// What a walk through a node meets. Found once for each node, so that thirty nodes that each show
/// the next twice take thirty steps to be refused.
typedef struct extent {
    uint64_t visits, places;
    bool known;
} extent;

typedef struct survey {
    const alpi_collada_document *document;
    extent *extents; // [elements]
    frame *stack;
    size_t depth, capacity;
    bool *open;
    uint64_t looked; // this pass itself
} survey;

static uint64_t weight_of(const alpi_collada_document *document, const xmlNode *element)
{
    const alpi_xml_span *span = &document->spans[alpi_xml_index(element)];
    return 1 + (span->end - span->begin) / 1024;
}

/// Elements inside an element, among which one is looked for.
static uint64_t elements_in(const alpi_collada_document *document, const xmlNode *element)
{
    const uint32_t index = alpi_xml_index(element);
    const size_t end = document->spans[index].end;
    uint32_t low = index + 1, high = document->element_count;
    while (low < high) { // the first that begins behind it
        const uint32_t middle = low + (high - low) / 2;
        if (document->spans[middle].begin < end) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low - index;
}

/// What one child that is no node adds; controllers are looked into each time.
static void add_leaf(survey *s, const xmlNode *child, extent *sum)
{
    uint64_t visits = weight_of(s->document, child);
    if (alpi_xml_is(child, "instance_controller")) {
        const xmlNode *controller = alpi_collada_target(s->document, child, "url");
        for (int i = 0; alpi_xml_is(controller, "controller") && i < CHAIN_LIMIT; i++) {
            visits += elements_in(s->document, controller);
            if (s->looked + visits > VISIT_LIMIT) {
                break;
            }
            const xmlNode *skin = alpi_xml_child(controller, "skin");
            const xmlNode *bind = alpi_xml_child(skin, "bind_shape_matrix");
            visits += bind != NULL ? weight_of(s->document, bind) : 0;
            controller = alpi_collada_target(
                s->document, skin != NULL ? skin : alpi_xml_child(controller, "morph"), "source");
        }
    }
    s->looked += visits;
    sum->visits += visits;
    sum->places += strncmp((const char *)child->name, "instance_", strlen("instance_")) == 0;
}

static alp_result open_node(survey *s, const alpi_collada_reader *reader, xmlNode *element)
{
    const uint32_t index = alpi_xml_index(element);
    if (s->open[index]) {
        return alpi_collada_fail(reader->document, element,
                                 "contains itself by way of <instance_node>; break the circle");
    }
    ALP_TRY(alpi_collada_grow(reader->context, &s->stack, &s->capacity, s->depth + 1,
                              sizeof *s->stack));
    s->stack[s->depth++] = (frame){.element = element, .next = alpi_xml_child(element, NULL)};
    s->open[index] = true;
    s->extents[index] = (extent){.visits = 1};
    return ALP_OK;
}

static alp_result check_extent(const alpi_collada_reader *reader, uint64_t visits, uint64_t places)
{
    return visits <= VISIT_LIMIT && places <= PLACE_LIMIT
               ? ALP_OK
               : alpi_fail(reader->context, ALP_ERROR_LIMIT,
                           "%s: its nodes have more than %d elements, or place more than %d "
                           "geometries and lights; split the scene",
                           reader->document->path, VISIT_LIMIT, PLACE_LIMIT);
}

static alp_result survey_from(survey *s, const alpi_collada_reader *reader, xmlNode *scene)
{
    ALP_TRY(open_node(s, reader, scene));
    while (s->depth > 0) {
        frame *at = &s->stack[s->depth - 1];
        extent *sum = &s->extents[alpi_xml_index(at->element)];
        xmlNode *child = at->next;
        ALP_TRY(check_extent(reader, sum->visits, sum->places));
        ALP_TRY(check_extent(reader, s->looked, 0));
        if (child == NULL) {
            s->open[alpi_xml_index(at->element)] = false;
            sum->known = true;
            s->depth--;
            continue;
        }
        xmlNode *node = alpi_xml_is(child, "instance_node")
                            ? alpi_collada_target(s->document, child, "url")
                            : child;
        const extent *below = alpi_xml_is(node, "node") ? &s->extents[alpi_xml_index(node)] : NULL;
        if (below != NULL && !below->known) { // comes again when it is
            ALP_TRY(open_node(s, reader, node));
            continue;
        }
        if (below != NULL) {
            sum->visits += below->visits;
            sum->places += below->places;
        } else {
            add_leaf(s, child, sum);
        }
        at->next = alpi_xml_next(child, NULL);
    }
    return ALP_OK;
}

/// Fails where the walk would not end in a reasonable time, or go round in circles.
static alp_result survey_scene(const alpi_collada_reader *reader, xmlNode *scene)
{
    survey s = {.document = reader->document};
    const uint32_t count = reader->document->element_count;
    s.extents = ALPI_NEW(reader->context, extent, count);
    s.open = ALPI_NEW(reader->context, bool, count);
    alp_result result = s.extents == NULL || s.open == NULL ? ALP_ERROR_OUT_OF_MEMORY
                                                            : survey_from(&s, reader, scene);
    alpi_release(reader->context, s.extents);
    alpi_release(reader->context, s.open);
    alpi_release(reader->context, s.stack);
    return result;
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
                  "has no visual scene: its geometries are placed without a transform: %u",
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
                      "does not name its visual scene: the first is read");
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
    ALP_TRY(survey_scene(reader, scene));
    walk w = {.reader = reader};
    ALPI_TRY_NEW(reader->context, w.open, reader->document->element_count);
    alp_result result = walk_from(&w, scene);
    alpi_release(reader->context, w.open);
    alpi_release(reader->context, w.stack);
    return result;
}
