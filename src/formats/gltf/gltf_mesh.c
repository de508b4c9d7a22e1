// SPDX-License-Identifier: MIT
// Meshes → surfaces. First every size is found and checked, then the scene's arrays are made once,
// then each node × primitive is filled in, in world space.
#include "formats/gltf/gltf_read.h"

#include "base/memory.h"
#include "formats/gltf/gltf_accessor.h"
#include "formats/gltf/gltf_pose.h"
#include "formats/gltf/gltf_tree.h"
#include "scene/origin.h"

#include <stdio.h>
#include <string.h>

/// What nodes that share meshes may add up to, with ALPI_GLTF_SURFACE_LIMIT.
enum { EXPANSION_LIMIT = 1 << 28 };

/// What a surface is made from. Accessor ALPI_GLTF_NONE = absent.
typedef struct part {
    json_t *primitive;
    uint32_t node, source_count; // vertices of the primitive
    size_t placement;            // of an instance, ALPI_GLTF_NONE = the node's
    size_t position, normal, uvs[ALPI_UV_SLOT_COUNT], color;
} part;

typedef struct plan {
    alpi_gltf_reader *reader;
    part *parts; // one per surface
    size_t part_capacity, surface_capacity;
    mat4 *placements; // of instances, in the world
    size_t placement_count, placement_capacity;
    uint64_t vertices, triangles, sources, visits;
    bool has_uvs[ALPI_UV_SLOT_COUNT], has_colors;
    // for one note a file each
    uint32_t not_triangles, without_material, without_position, morphed, skinned, instanced, hidden;
} plan;

// --- sizes --------------------------------------------------------------------------------------

/// Finds an attribute, which must have `source_count` elements of `least` to `most` components.
static alp_result find_attribute(const plan *p, const part *from, const char *name,
                                 const char *owner, const uint32_t components[2], size_t *accessor)
{
    const alpi_gltf_document *document = p->reader->document;
    json_t *attributes = json_object_get(from->primitive, "attributes");
    ALP_TRY(alpi_gltf_index(document, attributes, name, "accessors", owner, accessor));
    if (*accessor == ALPI_GLTF_NONE) {
        return ALP_OK;
    }
    alpi_gltf_values values;
    ALP_TRY(alpi_gltf_accessor_check(document, *accessor, &values));
    if (values.components < components[0] || values.components > components[1]) {
        return alpi_gltf_fail(document, owner, "%s (accessor %zu) has %u components", name,
                              *accessor, values.components);
    }
    if (values.count != from->source_count) {
        return alpi_gltf_fail(document, owner, "%s (accessor %zu) has %u elements, POSITION has %u",
                              name, *accessor, values.count, from->source_count);
    }
    return ALP_OK;
}

void alpi_gltf_slot_name(uint32_t slot, char *name, size_t size)
{
    const bool own = slot >= ALPI_UV_SET_LIMIT;
    snprintf(name, size, own ? "_ALPENGLOW_UV_%u" : "TEXCOORD_%u",
             own ? slot - ALPI_UV_SET_LIMIT + 1 : slot);
}

/// Coordinates: the sets, and what the material says of the slots behind them.
static alp_result find_slots(plan *p, part *from, const char *owner, alpi_surface *surface)
{
    static const uint32_t two[2] = {2, 2};
    const unsigned named = surface->material == ALPI_NONE
                               ? 0
                               : p->reader->scene->materials[surface->material].blend_sets;
    surface->uv_sets = 0;
    surface->uv_slots = 0;
    for (uint32_t k = 0; k < ALPI_UV_SLOT_COUNT; k++) {
        char name[ALPI_GLTF_OWNER_SIZE];
        alpi_gltf_slot_name(k, name, sizeof name);
        from->uvs[k] = ALPI_GLTF_NONE;
        if (k < ALPI_UV_SET_LIMIT || (named >> k & 1u) != 0) {
            ALP_TRY(find_attribute(p, from, name, owner, two, &from->uvs[k]));
        }
        const bool present = from->uvs[k] != ALPI_GLTF_NONE;
        p->has_uvs[k] |= present;
        surface->uv_slots |= (uint8_t)((present ? 1u : 0u) << k);
        surface->uv_sets += present && surface->uv_sets == k && k < ALPI_UV_SET_LIMIT;
    }
    return ALP_OK;
}

static alp_result find_attributes(plan *p, part *from, const char *owner, alpi_surface *surface)
{
    static const uint32_t three[2] = {3, 3}, three_or_four[2] = {3, 4};
    ALP_TRY(find_attribute(p, from, "POSITION", owner, three, &from->position));
    ALP_TRY(find_attribute(p, from, "NORMAL", owner, three, &from->normal));
    ALP_TRY(find_attribute(p, from, "COLOR_0", owner, three_or_four, &from->color));
    p->has_colors |= from->color != ALPI_GLTF_NONE;
    return find_slots(p, from, owner, surface);
}

/// The number of vertices, 0 without POSITION.
static alp_result count_sources(const plan *p, part *from, const char *owner)
{
    const alpi_gltf_document *document = p->reader->document;
    json_t *attributes = json_object_get(from->primitive, "attributes");
    if (!json_is_object(attributes)) {
        return alpi_gltf_fail(document, owner, "attributes is missing");
    }
    ALP_TRY(alpi_gltf_index(document, attributes, "POSITION", "accessors", owner, &from->position));
    alpi_gltf_values values = {0};
    if (from->position != ALPI_GLTF_NONE) {
        ALP_TRY(alpi_gltf_accessor_check(document, from->position, &values));
    }
    from->source_count = values.count;
    return ALP_OK;
}

static alp_result check_limits(const plan *p)
{
    uint64_t largest = p->vertices > p->triangles ? p->vertices : p->triangles;
    largest = largest > p->sources ? largest : p->sources;
    if (largest > EXPANSION_LIMIT || p->visits > ALPI_GLTF_SURFACE_LIMIT) {
        return alpi_fail(p->reader->context, ALP_ERROR_LIMIT,
                         "%s: the nodes place more than %d vertices or triangles, or more than %d "
                         "primitives; split the scene",
                         p->reader->document->path, EXPANSION_LIMIT, ALPI_GLTF_SURFACE_LIMIT);
    }
    return ALP_OK;
}

static alp_result find_material(plan *p, const part *from, const char *owner, alpi_surface *surface)
{
    size_t material;
    ALP_TRY(alpi_gltf_index(p->reader->document, from->primitive, "material", "materials", owner,
                            &material));
    surface->material = ALPI_NONE;
    if (material != ALPI_GLTF_NONE) {
        surface->material = (uint32_t)material;
        p->reader->material_used[material] = true;
    }
    p->without_material += material == ALPI_GLTF_NONE;
    return ALP_OK;
}

static alp_result add_surface(plan *p, const part *from, alpi_surface *surface)
{
    alp_scene *scene = p->reader->scene;
    alp_context *context = p->reader->context;
    void *parts = p->parts, *surfaces = scene->surfaces;
    size_t count = scene->surface_count;
    alp_result result = alpi_grow(context, &parts, &p->part_capacity, count + 1, sizeof(part));
    p->parts = parts;
    ALP_TRY(result);
    result = alpi_grow(context, &surfaces, &p->surface_capacity, count + 1, sizeof(alpi_surface));
    scene->surfaces = surfaces;
    ALP_TRY(result);
    surface->name = alpi_gltf_surface_name(p->reader, surface);
    if (surface->name == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    p->parts[count] = *from;
    scene->surfaces[count] = *surface;
    scene->surface_count++;
    return ALP_OK;
}

static alp_result plan_primitive(plan *p, json_t *primitive, alpi_surface surface, size_t placement)
{
    char owner[ALPI_GLTF_OWNER_SIZE];
    snprintf(owner, sizeof owner, "mesh %u, primitive %u", surface.mesh, surface.primitive);
    part from = {.primitive = primitive, .node = surface.node, .placement = placement};
    if (!json_is_object(primitive)) {
        return alpi_gltf_fail(p->reader->document, owner, "must be an object");
    }
    p->visits++;
    ALP_TRY(check_limits(p));
    ALP_TRY(count_sources(p, &from, owner));
    bool drawable;
    ALP_TRY(alpi_gltf_primitive_count(p->reader->document, primitive, owner, from.source_count,
                                      &surface.triangle_count, &drawable));
    ALP_TRY(find_material(p, &from, owner, &surface));
    ALP_TRY(find_attributes(p, &from, owner, &surface));
    p->not_triangles += !drawable;
    p->without_position += drawable && from.position == ALPI_GLTF_NONE;
    if (!drawable || from.position == ALPI_GLTF_NONE) {
        return ALP_OK;
    }
    p->morphed += json_array_size(json_object_get(primitive, "targets")) > 0;
    surface.normals_generated = from.normal == ALPI_GLTF_NONE;
    uint64_t vertices =
        surface.normals_generated ? 3 * (uint64_t)surface.triangle_count : from.source_count;
    p->sources += from.source_count;
    surface.first_vertex = (uint32_t)p->vertices;
    surface.first_triangle = (uint32_t)p->triangles;
    p->vertices += vertices;
    p->triangles += surface.triangle_count;
    ALP_TRY(check_limits(p));
    surface.vertex_count = (uint32_t)vertices;
    return add_surface(p, &from, &surface);
}

/// The primitives of one placement of a node's mesh.
static alp_result plan_mesh(plan *p, json_t *primitives, alpi_surface surface, size_t placement)
{
    for (size_t i = 0; i < json_array_size(primitives); i++) {
        surface.primitive = (uint32_t)i;
        ALP_TRY(plan_primitive(p, json_array_get(primitives, i), surface, placement));
    }
    return ALP_OK;
}

static alp_result plan_instances(plan *p, json_t *primitives, alpi_surface surface,
                                 const alpi_gltf_instance *instances, uint32_t count)
{
    p->instanced++;
    for (uint32_t i = 0; i < count; i++) {
        void *items = p->placements;
        alp_result result = alpi_grow(p->reader->context, &items, &p->placement_capacity,
                                      p->placement_count + 1, sizeof(mat4));
        p->placements = items;
        ALP_TRY(result);
        mat4 local =
            alpi_gltf_compose(instances[i].translation, instances[i].rotation, instances[i].scale);
        mat4 *world = &p->placements[p->placement_count++];
        *world = mat4_multiply(&p->reader->world[surface.node], &local);
        surface.instance = i;
        surface.mirrored = mat4_determinant3(world) < 0.0;
        mat4_axes(world, surface.axes);
        ALP_TRY(plan_mesh(p, primitives, surface, p->placement_count - 1));
    }
    return ALP_OK;
}

/// Whether a skin mirrors, by its first joint: the parts of a figure do not differ in that.
static alp_result find_mirrored(plan *p, alpi_surface *surface)
{
    alpi_gltf_pose pose;
    ALP_TRY(alpi_gltf_pose_create(p->reader, surface->node, true, &pose));
    if (pose.joints != NULL) {
        surface->mirrored = mat4_determinant3(&pose.joints[0]) < 0.0;
    }
    alpi_gltf_pose_destroy(p->reader, &pose);
    return ALP_OK;
}

static alp_result plan_node(plan *p, uint32_t node)
{
    const alpi_gltf_document *document = p->reader->document;
    json_t *object = alpi_gltf_item(document, "nodes", node);
    char owner[ALPI_GLTF_OWNER_SIZE];
    snprintf(owner, sizeof owner, "node %u", node);
    size_t mesh;
    ALP_TRY(alpi_gltf_index(document, object, "mesh", "meshes", owner, &mesh));
    if (mesh == ALPI_GLTF_NONE || p->reader->hidden[node]) {
        p->hidden += mesh != ALPI_GLTF_NONE;
        return ALP_OK;
    }
    json_t *primitives = json_object_get(alpi_gltf_item(document, "meshes", mesh), "primitives");
    if (!json_is_array(primitives)) {
        snprintf(owner, sizeof owner, "mesh %zu", mesh);
        return alpi_gltf_fail(document, owner, "primitives must be an array");
    }
    alpi_surface surface = {.node = node, .mesh = (uint32_t)mesh};
    surface.mirrored = mat4_determinant3(&p->reader->world[node]) < 0.0;
    mat4_axes(&p->reader->world[node], surface.axes);
    if (json_object_get(object, "skin") != NULL) {
        p->skinned++;
        memset(surface.axes, 0, sizeof surface.axes); // joints place it, not its node
        ALP_TRY(find_mirrored(p, &surface));
    }
    alpi_gltf_instance *instances = NULL;
    uint32_t count = 0;
    ALP_TRY(alpi_gltf_read_instances(document, node, &instances, &count));
    alp_result result = instances == NULL
                            ? plan_mesh(p, primitives, surface, ALPI_GLTF_NONE)
                            : plan_instances(p, primitives, surface, instances, count);
    alpi_release(p->reader->context, instances);
    return result;
}

// --- filling ------------------------------------------------------------------------------------

static alp_result allocate_arrays(const plan *p)
{
    alp_scene *scene = p->reader->scene;
    alp_context *context = p->reader->context;
    scene->vertex_count = (uint32_t)p->vertices;
    scene->triangle_count = (uint32_t)p->triangles;
    ALPI_TRY_NEW(context, scene->positions, scene->vertex_count);
    ALPI_TRY_NEW(context, scene->normals, scene->vertex_count);
    ALPI_TRY_NEW(context, scene->vertex_source, scene->vertex_count);
    ALPI_TRY_NEW(context, scene->triangles, scene->triangle_count);
    ALPI_TRY_NEW(context, scene->triangle_surface, scene->triangle_count);
    for (int k = 0; k < ALPI_UV_SLOT_COUNT; k++) {
        if (p->has_uvs[k]) {
            ALPI_TRY_NEW(context, scene->uvs[k], scene->vertex_count);
        }
    }
    if (p->has_colors) {
        ALPI_TRY_NEW(context, scene->colors, scene->vertex_count);
    }
    return ALP_OK;
}

/// Triangles and vertex sources. Without normals every triangle gets three vertices of its own, so
/// that it can be flat. A mirroring transform turns the winding, so it is turned back.
static alp_result fill_triangles(const plan *p, const part *from, const alpi_surface *surface)
{
    alp_scene *scene = p->reader->scene;
    char owner[ALPI_GLTF_OWNER_SIZE];
    snprintf(owner, sizeof owner, "mesh %u, primitive %u", surface->mesh, surface->primitive);
    uint32_t(*corners)[3] = NULL, count, leftover;
    ALP_TRY(alpi_gltf_primitive_triangles(p->reader->document, from->primitive, owner,
                                          from->source_count, &corners, &count, &leftover));
    uint32_t *sources = scene->vertex_source + surface->first_vertex;
    bool own = surface->normals_generated;
    for (uint32_t i = 0; !own && i < surface->vertex_count; i++) {
        sources[i] = i;
    }
    for (uint32_t t = 0; t < count; t++) {
        uint32_t *triangle = scene->triangles[surface->first_triangle + t];
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t place = surface->mirrored ? (3 - k) % 3 : k;
            if (own) {
                sources[3 * t + k] = corners[t][k];
            }
            triangle[place] = surface->first_vertex + (own ? 3 * t + k : corners[t][k]);
        }
        scene->triangle_surface[surface->first_triangle + t] =
            (uint32_t)(surface - scene->surfaces);
    }
    alpi_release(p->reader->context, corners);
    if (leftover > 0) {
        alpi_warn(p->reader->context, "leftover-indices", owner,
                  "%u indices at the end make no triangle and are ignored", leftover);
    }
    return ALP_OK;
}

static vec3 value_vec3(const alpi_gltf_values *values, uint32_t element)
{
    return (vec3){alpi_gltf_values_float(values, element, 0),
                  alpi_gltf_values_float(values, element, 1),
                  alpi_gltf_values_float(values, element, 2)};
}

static const mat4 *world_of(const plan *p, const part *from)
{
    return from->placement == ALPI_GLTF_NONE ? &p->reader->world[from->node]
                                             : &p->placements[from->placement];
}

/// Positions or normals that a skin or morph targets move. *done is false where nothing does.
static alp_result fill_posed(const plan *p, const part *from, const alpi_surface *surface,
                             bool normals, bool *done)
{
    alp_scene *scene = p->reader->scene;
    alpi_gltf_pose pose;
    ALP_TRY(alpi_gltf_pose_create(p->reader, from->node, false, &pose));
    *done = pose.joints != NULL || pose.weights != NULL;
    if (!*done) {
        return ALP_OK;
    }
    char owner[ALPI_GLTF_OWNER_SIZE];
    snprintf(owner, sizeof owner, "mesh %u, primitive %u", surface->mesh, surface->primitive);
    float(*vertices)[3] = NULL, (*places)[3] = normals ? scene->normals : scene->positions;
    const alpi_gltf_posed posed = {
        from->primitive,   owner,   from->source_count,
        world_of(p, from), normals, normals ? from->normal : from->position};
    alp_result result = alpi_gltf_pose_vertices(p->reader, &pose, &posed, &vertices);
    for (uint32_t i = 0; result == ALP_OK && i < surface->vertex_count; i++) {
        uint32_t v = surface->first_vertex + i;
        memcpy(places[v], vertices[scene->vertex_source[v]], sizeof places[v]);
    }
    alpi_release(p->reader->context, vertices);
    alpi_gltf_pose_destroy(p->reader, &pose);
    return result;
}

static alp_result fill_positions(const plan *p, const part *from, const alpi_surface *surface)
{
    alp_scene *scene = p->reader->scene;
    const mat4 *world = world_of(p, from);
    alpi_gltf_values values;
    bool done;
    ALP_TRY(fill_posed(p, from, surface, false, &done));
    if (done) {
        return ALP_OK;
    }
    ALP_TRY(alpi_gltf_accessor_read(p->reader->document, from->position, &values));
    for (uint32_t i = 0; i < surface->vertex_count; i++) {
        uint32_t v = surface->first_vertex + i;
        vec3 position = value_vec3(&values, scene->vertex_source[v]);
        vec3_store(scene->positions[v], mat4_transform_point(world, position));
    }
    alpi_release(p->reader->context, values.bytes);
    return ALP_OK;
}

static void fill_flat_normals(const plan *p, const alpi_surface *surface)
{
    alp_scene *scene = p->reader->scene;
    for (uint32_t i = 0; i < surface->triangle_count; i++) {
        uint32_t t = surface->first_triangle + i;
        vec3 corner[3];
        alpi_triangle_corners(scene, t, corner);
        vec3 normal =
            vec3_triangle_normal(corner[0], corner[1], corner[2], (vec3){0.0f, 0.0f, 0.0f});
        for (int k = 0; k < 3; k++) {
            vec3_store(scene->normals[scene->triangles[t][k]], normal);
        }
    }
}

static alp_result fill_normals(const plan *p, const part *from, const alpi_surface *surface)
{
    if (surface->normals_generated) {
        fill_flat_normals(p, surface);
        return ALP_OK;
    }
    alp_scene *scene = p->reader->scene;
    const mat4 *world = world_of(p, from);
    alpi_gltf_values values;
    bool done;
    ALP_TRY(fill_posed(p, from, surface, true, &done));
    if (done) {
        return ALP_OK;
    }
    ALP_TRY(alpi_gltf_accessor_read(p->reader->document, from->normal, &values));
    for (uint32_t i = 0; i < surface->vertex_count; i++) {
        uint32_t v = surface->first_vertex + i;
        vec3 normal = value_vec3(&values, scene->vertex_source[v]);
        vec3_store(scene->normals[v], mat4_transform_normal(world, normal));
    }
    alpi_release(p->reader->context, values.bytes);
    return ALP_OK;
}

static alp_result fill_uvs(const plan *p, const part *from, const alpi_surface *surface,
                           uint32_t set)
{
    alp_scene *scene = p->reader->scene;
    if (from->uvs[set] == ALPI_GLTF_NONE) {
        return ALP_OK; // zeros
    }
    alpi_gltf_values values;
    ALP_TRY(alpi_gltf_accessor_read(p->reader->document, from->uvs[set], &values));
    uint32_t bad = 0;
    for (uint32_t i = 0; i < surface->vertex_count; i++) {
        uint32_t v = surface->first_vertex + i;
        for (uint32_t k = 0; k < 2; k++) {
            float value = alpi_gltf_values_float(&values, scene->vertex_source[v], k);
            bad += isfinite(value) ? 0 : 1;
            scene->uvs[set][v][k] = isfinite(value) ? value : 0.0f;
        }
    }
    alpi_release(p->reader->context, values.bytes);
    if (bad > 0) {
        char name[ALPI_GLTF_OWNER_SIZE];
        alpi_gltf_slot_name(set, name, sizeof name);
        alpi_warn(p->reader->context, "bad-uvs", surface->name,
                  "%u values of %s are not finite: 0 is used", bad, name);
    }
    return ALP_OK;
}

static alp_result fill_colors(const plan *p, const part *from, const alpi_surface *surface)
{
    alp_scene *scene = p->reader->scene;
    alpi_gltf_values values = {0};
    if (from->color != ALPI_GLTF_NONE) {
        ALP_TRY(alpi_gltf_accessor_read(p->reader->document, from->color, &values));
    }
    for (uint32_t i = 0; i < surface->vertex_count; i++) {
        uint32_t v = surface->first_vertex + i;
        for (uint32_t k = 0; k < 4; k++) {
            float value = k < values.components
                              ? alpi_gltf_values_float(&values, scene->vertex_source[v], k)
                              : 1.0f;
            scene->colors[v][k] = value > 0.0f ? fminf(value, 1.0f) : 0.0f; // NaN → 0
        }
    }
    alpi_release(p->reader->context, values.bytes);
    return ALP_OK;
}

static alp_result fill_surface(const plan *p, const part *from, const alpi_surface *surface)
{
    ALP_TRY(fill_triangles(p, from, surface));
    ALP_TRY(fill_positions(p, from, surface));
    ALP_TRY(fill_normals(p, from, surface));
    for (uint32_t set = 0; set < ALPI_UV_SLOT_COUNT; set++) {
        ALP_TRY(fill_uvs(p, from, surface, set));
    }
    return p->has_colors ? fill_colors(p, from, surface) : ALP_OK;
}

// --- far from the origin ------------------------------------------------------------------------

/// Takes the scene's origin off the transforms where vertices are far, and fills in what they
/// moved.
static alp_result move_to_origin(plan *p)
{
    alpi_gltf_reader *reader = p->reader;
    alp_scene *scene = reader->scene;
    double step[3];
    for (int round = 0; round < ALPI_ORIGIN_ROUNDS && alpi_origin_step(scene, reader->base, step);
         round++) {
        for (uint32_t i = 0; i < reader->order_count; i++) {
            alpi_origin_move(&reader->world[reader->order[i]], step);
        }
        for (size_t i = 0; i < p->placement_count; i++) {
            alpi_origin_move(&p->placements[i], step);
        }
        reader->posing = 0; // once more, within the same limit
        scene->rounded_at = 0.0f;
        for (uint32_t i = 0; p->parts != NULL && i < scene->surface_count; i++) {
            alpi_origin_note_rounding(scene, world_of(p, &p->parts[i]));
            ALP_TRY(fill_positions(p, &p->parts[i], &scene->surfaces[i]));
            ALP_TRY(fill_normals(p, &p->parts[i], &scene->surfaces[i]));
        }
    }
    return ALP_OK;
}

// --- all together -------------------------------------------------------------------------------

static void tell_oddities(const plan *p)
{
    alp_context *context = p->reader->context;
    const char *path = p->reader->document->path;
    if (p->not_triangles > 0) {
        alpi_note(context, "not-triangles", path, "primitives of points or lines left out: %u",
                  p->not_triangles);
    }
    if (p->without_position > 0) {
        alpi_note(context, "no-positions", path, "primitives without POSITION left out: %u",
                  p->without_position);
    }
    if (p->without_material > 0) {
        alpi_note(context, "no-material", path,
                  "primitives without a material, read as a grey of albedo 0.5: %u",
                  p->without_material);
    }
    if (p->hidden > 0) {
        alpi_note(
            context, "hidden", path,
            "%u nodes with meshes are hidden (KHR_node_visibility): they neither cast shadows "
            "nor get a map; they stay in an output of glTF",
            p->hidden);
    }
    if (p->skinned > 0) {
        alpi_note(context, "skin", path, "%u skinned nodes are read in the pose of their joints",
                  p->skinned);
    }
    if (p->morphed > 0) {
        alpi_note(context, "morph", path,
                  "primitives with morph targets, read with their default weights: %u", p->morphed);
    }
    if (p->instanced > 0) {
        alpi_note(context, "instancing", path,
                  "%u nodes have instances of their mesh (EXT_mesh_gpu_instancing), %zu in all",
                  p->instanced, p->placement_count);
    }
}

static alp_result read_surfaces(plan *p)
{
    alp_scene *scene = p->reader->scene;
    for (uint32_t i = 0; i < p->reader->order_count; i++) {
        ALP_TRY(plan_node(p, p->reader->order[i]));
    }
    ALP_TRY(allocate_arrays(p));
    for (uint32_t s = 0; p->parts != NULL && s < scene->surface_count; s++) {
        ALP_TRY(fill_surface(p, &p->parts[s], &scene->surfaces[s]));
        alpi_gltf_check_sets(p->reader, &scene->surfaces[s], p->parts[s].uvs);
    }
    ALP_TRY(move_to_origin(p));
    tell_oddities(p);
    return ALP_OK;
}

alp_result alpi_gltf_read_meshes(alpi_gltf_reader *reader)
{
    plan p = {.reader = reader};
    alp_result result = read_surfaces(&p);
    alpi_release(reader->context, p.parts);
    alpi_release(reader->context, p.placements);
    return result;
}
