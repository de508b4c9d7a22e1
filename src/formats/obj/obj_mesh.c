// SPDX-License-Identifier: MIT
// Faces of an OBJ → surfaces, vertices and triangles of a scene. Corners that are alike are one
// vertex; where a face has no normals, its triangles have vertices of their own, as in glTF.
#include "formats/obj/obj.h"

#include "base/memory.h"
#include "base/random.h"
#include "formats/polygon/polygon.h"
#include "formats/text/utf8.h"
#include "scene/origin.h"

#include <string.h>

enum { EXPANSION_LIMIT = 1 << 28, SURFACE_LIMIT = 1 << 22 }; // as glTF's

typedef struct builder {
    alpi_obj *obj;
    alp_scene *scene;
    uint32_t *order;        // [face_count] faces, those of a surface together
    uint32_t *surface_ends; // [surface_count] in `order`
    size_t vertex_capacity;
    uint32_t *table; // open addressing: vertex of a triple, ALPI_NONE = free
    size_t table_size, table_capacity;
    uint32_t (*vertex_corners)[3]; // [vertices] what they were made of
    alpi_polygon_scratch scratch;
    float (*points)[3];   // [largest face]
    uint32_t *vertices;   // [largest face]
    uint32_t (*parts)[3]; // [largest face − 2]
    uint32_t crossed;     // faces of the surface that could not be cut well
    bool has_uvs;
} builder;

static uint32_t face_size(const alpi_obj *o, uint32_t face)
{
    return o->faces[face + 1].first_corner - o->faces[face].first_corner;
}

// --- checks and order ----------------------------------------------------------------------------

static alp_result fail_index(const alpi_obj *o, uint32_t face, int kind, uint32_t index)
{
    static const char *const names[3] = {"vertex", "texture coordinate", "normal"};
    const uint32_t counts[3] = {o->position_count, o->uv_count, o->normal_count};
    if (index == ALPI_OBJ_BEFORE_FIRST) {
        return alpi_fail(o->context, ALP_ERROR_INVALID_DATA,
                         "%s: line %u: f: a %s before the first", o->path, o->faces[face].line,
                         names[kind]);
    }
    return alpi_fail(o->context, ALP_ERROR_INVALID_DATA, "%s: line %u: f: %s %u of %u", o->path,
                     o->faces[face].line, names[kind], index + 1, counts[kind]);
}

/// Coordinates and normals of which the file has none are left out; any other index that is too
/// large is a fault.
static alp_result check_corners(alpi_obj *o)
{
    static const char *const kinds[3] = {"", "texture coordinates (vt)", "normals (vn)"};
    const uint32_t counts[3] = {o->position_count, o->uv_count, o->normal_count};
    uint32_t without[3] = {0, 0, 0}; // faces
    for (uint32_t f = 0; f < o->face_count; f++) {
        bool lacks[3] = {false, false, false};
        for (uint32_t c = o->faces[f].first_corner; c < o->faces[f + 1].first_corner; c++) {
            for (int k = 0; k < 3; k++) {
                uint32_t *index = &o->corners[c][k];
                if (*index == ALPI_NONE || *index < counts[k]) {
                    continue;
                }
                if (k == 0 || counts[k] > 0) {
                    return fail_index(o, f, k, *index);
                }
                *index = ALPI_NONE;
                lacks[k] = true;
            }
        }
        without[1] += lacks[1];
        without[2] += lacks[2];
    }
    for (int k = 1; k < 3; k++) {
        if (without[k] > 0) {
            alpi_warn(o->context, "missing-data", o->path,
                      "faces that name %s, of which the file has none: %u; read without", kinds[k],
                      without[k]);
        }
    }
    return ALP_OK;
}

/// Sorts the faces by surface, else in the order of the file.
static alp_result sort_faces(builder *b)
{
    const alpi_obj *o = b->obj;
    ALPI_TRY_NEW(o->context, b->order, o->face_count);
    ALPI_TRY_NEW(o->context, b->surface_ends, (size_t)o->surface_count + 1);
    for (uint32_t f = 0; f < o->face_count; f++) {
        b->surface_ends[o->faces[f].surface + 1]++;
    }
    for (uint32_t s = 0; s < o->surface_count; s++) {
        b->surface_ends[s + 1] += b->surface_ends[s];
    }
    for (uint32_t f = 0; f < o->face_count; f++) {
        b->order[b->surface_ends[o->faces[f].surface]++] = f;
    }
    return ALP_OK;
}

static alp_result allocate(builder *b)
{
    const alpi_obj *o = b->obj;
    alp_scene *scene = b->scene;
    uint64_t triangles = 0;
    uint32_t largest = 3;
    for (uint32_t f = 0; f < o->face_count; f++) {
        uint32_t size = face_size(o, f);
        triangles += size - 2;
        largest = size > largest ? size : largest;
    }
    if (triangles > EXPANSION_LIMIT || o->surface_count > SURFACE_LIMIT) {
        return alpi_fail(o->context, ALP_ERROR_LIMIT,
                         "%s: %llu triangles in %u surfaces, more than the limits of %d and %d",
                         o->path, (unsigned long long)triangles, o->surface_count, EXPANSION_LIMIT,
                         SURFACE_LIMIT);
    }
    for (uint32_t c = 0; c < o->corner_count && !b->has_uvs; c++) {
        b->has_uvs = o->corners[c][1] != ALPI_NONE;
    }
    ALPI_TRY_NEW(o->context, scene->triangles, triangles);
    ALPI_TRY_NEW(o->context, scene->triangle_surface, triangles);
    ALPI_TRY_NEW(o->context, scene->surfaces, o->surface_count);
    ALPI_TRY_NEW(o->context, b->obj->face_triangles, o->face_count);
    if (largest > 3) {
        ALPI_TRY_NEW(o->context, b->obj->triangle_corners, triangles);
    }
    ALPI_TRY_NEW(o->context, b->points, largest);
    ALPI_TRY_NEW(o->context, b->vertices, largest);
    ALPI_TRY_NEW(o->context, b->parts, largest - 2);
    return ALP_OK;
}

// --- vertices ------------------------------------------------------------------------------------

/// Gives all arrays of vertices this length; 0 never.
static alp_result resize(builder *b, size_t length)
{
    alp_context *context = b->obj->context;
    alp_scene *s = b->scene;
    const struct {
        void **items;
        size_t size;
    } arrays[] = {{(void **)&s->positions, sizeof *s->positions},
                  {(void **)&s->normals, sizeof *s->normals},
                  {(void **)&s->vertex_source, sizeof *s->vertex_source},
                  {(void **)&b->vertex_corners, sizeof *b->vertex_corners},
                  {(void **)&s->uvs[0], b->has_uvs ? sizeof *s->uvs[0] : 0},
                  {(void **)&s->uvs[1], b->has_uvs ? sizeof *s->uvs[1] : 0},
                  {(void **)&s->colors, b->obj->colors != NULL ? sizeof *s->colors : 0}};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) {
        if (arrays[i].size == 0) {
            continue;
        }
        void *moved = alpi_reallocate(context, *arrays[i].items, length, arrays[i].size);
        if (moved == NULL) {
            return ALP_ERROR_OUT_OF_MEMORY;
        }
        *arrays[i].items = moved;
    }
    b->vertex_capacity = length;
    return ALP_OK;
}

/// A position of the file in the scene.
static void place(const builder *b, uint32_t position, float placed[3])
{
    for (int k = 0; k < 3; k++) {
        placed[k] = (float)(b->obj->positions[position][k] - b->scene->origin[k]);
    }
}

/// Colours of files are for screens (Blender, MeshLab and three.js read them so), those of a scene
/// are linear.
static void color_vertex(const builder *b, uint32_t position, float color[4])
{
    for (int k = 0; k < 3; k++) {
        const float value = b->obj->colors[position][k];
        color[k] = alpi_srgb_to_linear(value < 0.0f ? 0.0f : value > 1.0f ? 1.0f : value);
    }
    color[3] = 1.0f;
}

/// A vertex of this corner; without a normal it gets that of its triangle at the end.
static alp_result add_vertex(builder *b, const uint32_t corner[3], uint32_t *vertex)
{
    const alpi_obj *o = b->obj;
    alp_scene *s = b->scene;
    if (b->vertex_corners == NULL || s->vertex_count == b->vertex_capacity) {
        ALP_TRY(resize(b, b->vertex_capacity < 64 ? 64 : 2 * b->vertex_capacity));
    }
    const uint32_t v = *vertex = s->vertex_count++;
    place(b, corner[0], s->positions[v]);
    if (o->colors != NULL) {
        color_vertex(b, corner[0], s->colors[v]);
    }
    memset(s->normals[v], 0, sizeof *s->normals);
    if (corner[2] != ALPI_NONE) {
        memcpy(s->normals[v], o->normals[corner[2]], sizeof *s->normals);
    }
    for (int set = 0; b->has_uvs && set < 2; set++) {
        memset(s->uvs[set][v], 0, sizeof *s->uvs[set]);
        if (corner[1] != ALPI_NONE) {
            memcpy(s->uvs[set][v], o->uvs[corner[1]], sizeof *s->uvs[set]);
        }
    }
    memcpy(b->vertex_corners[v], corner, sizeof *b->vertex_corners);
    s->vertex_source[v] = v - s->surfaces[s->surface_count - 1].first_vertex;
    return ALP_OK;
}

/// The vertex of a corner, a new one where the surface has none of the same indices.
static alp_result find_vertex(builder *b, const uint32_t corner[3], uint32_t *vertex)
{
    const size_t mask = b->table_size - 1;
    uint64_t key = alpi_hash64(((uint64_t)corner[1] << 32 | corner[2]) ^ alpi_hash64(corner[0]));
    size_t slot = (size_t)key & mask;
    for (; b->table[slot] != ALPI_NONE; slot = (slot + 1) & mask) {
        *vertex = b->table[slot];
        if (memcmp(b->vertex_corners[*vertex], corner, sizeof *b->vertex_corners) == 0) {
            return ALP_OK;
        }
    }
    ALP_TRY(add_vertex(b, corner, vertex));
    b->table[slot] = *vertex;
    return ALP_OK;
}

/// An empty table with room for all corners of a surface.
static alp_result clear_table(builder *b, uint64_t corners)
{
    b->table_size = 64;
    while (b->table_size < 2 * corners) {
        b->table_size *= 2;
    }
    if (b->table_size > b->table_capacity) {
        alpi_release(b->obj->context, b->table);
        b->table_capacity = 0;
        ALPI_TRY_NEW(b->obj->context, b->table, b->table_size);
        b->table_capacity = b->table_size;
    }
    memset(b->table, 0xff, b->table_size * sizeof *b->table); // ALPI_NONE
    return ALP_OK;
}

// --- faces ---------------------------------------------------------------------------------------

static alp_result cut_face(builder *b, const uint32_t (*corners)[3], uint32_t size)
{
    bool clean;
    if (size == 3) {
        memcpy(b->parts[0], (uint32_t[3]){0, 1, 2}, sizeof *b->parts);
        return ALP_OK;
    }
    for (uint32_t i = 0; i < size; i++) {
        place(b, corners[i][0], b->points[i]);
    }
    ALP_TRY(alpi_polygon_triangulate(&b->scratch, size, (const float(*)[3])b->points, b->parts,
                                     &clean));
    b->crossed += !clean;
    return ALP_OK;
}

static alp_result add_face(builder *b, uint32_t face)
{
    alp_scene *s = b->scene;
    alpi_surface *surface = &s->surfaces[s->surface_count - 1];
    const uint32_t size = face_size(b->obj, face);
    const uint32_t(*corners)[3] =
        (const uint32_t(*)[3])b->obj->corners + b->obj->faces[face].first_corner;
    bool flat = false;
    for (uint32_t i = 0; i < size; i++) {
        flat = flat || corners[i][2] == ALPI_NONE;
        surface->uv_sets = corners[i][1] != ALPI_NONE ? 2 : surface->uv_sets;
    }
    surface->normals_generated = surface->normals_generated || flat;
    ALP_TRY(cut_face(b, corners, size));
    b->obj->face_triangles[face] = s->triangle_count;
    if (b->obj->triangle_corners != NULL) {
        memcpy(b->obj->triangle_corners + s->triangle_count, b->parts,
               (size_t)(size - 2) * sizeof *b->parts);
    }
    for (uint32_t i = 0; !flat && i < size; i++) {
        ALP_TRY(find_vertex(b, corners[i], &b->vertices[i]));
    }
    for (uint32_t t = 0; t + 2 < size; t++) {
        uint32_t *triangle = s->triangles[s->triangle_count];
        for (int k = 0; k < 3; k++) {
            const uint32_t at = b->parts[t][k];
            if (flat) {
                const uint32_t bare[3] = {corners[at][0], corners[at][1], ALPI_NONE};
                ALP_TRY(add_vertex(b, bare, &triangle[k]));
            } else {
                triangle[k] = b->vertices[at];
            }
        }
        s->triangle_surface[s->triangle_count++] = s->surface_count - 1;
    }
    return ALP_OK;
}

// --- surfaces ------------------------------------------------------------------------------------

static alp_result add_surface(builder *b, uint32_t index, const uint32_t *scene_materials,
                              uint32_t primitive)
{
    const alpi_obj *o = b->obj;
    const alpi_obj_surface *from = &o->surfaces[index];
    const uint32_t first = index > 0 ? b->surface_ends[index - 1] : 0;
    const uint32_t end = b->surface_ends[index];
    uint64_t corners = 0;
    for (uint32_t i = first; i < end; i++) {
        corners += face_size(o, b->order[i]);
    }
    ALP_TRY(clear_table(b, corners));
    alp_scene *s = b->scene;
    alpi_surface *surface = &s->surfaces[s->surface_count++];
    *surface = (alpi_surface){
        .name = alpi_utf8_copy(o->context, alpi_obj_name(&o->objects, from->object),
                               o->objects.sizes[from->object]),
        .node = from->object,
        .mesh = from->object,
        .primitive = primitive,
        .material = from->material == ALPI_NONE ? ALPI_NONE : scene_materials[from->material],
        .first_vertex = s->vertex_count,
        .first_triangle = s->triangle_count};
    if (surface->name == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (char *c = surface->name; *c != '\0'; c++) {
        *c = (unsigned char)*c < 0x20 || *c == 0x7f ? '?' : *c;
    }
    b->crossed = 0;
    for (uint32_t i = first; i < end; i++) {
        ALP_TRY(add_face(b, b->order[i]));
    }
    if (b->crossed > 0) {
        alpi_warn(o->context, "crossed-faces", surface->name,
                  "%u faces cross themselves: they are cut into triangles that overlap",
                  b->crossed);
    }
    surface->vertex_count = s->vertex_count - surface->first_vertex;
    surface->triangle_count = s->triangle_count - surface->first_triangle;
    return ALP_OK;
}

/// By the vertices that faces use.
static void choose_origin(builder *b)
{
    const alpi_obj *o = b->obj;
    alpi_world_box box = alpi_world_box_empty();
    for (uint32_t c = 0; c < o->corner_count; c++) {
        alpi_world_box_add(&box, o->positions[o->corners[c][0]]);
    }
    alpi_origin_choose(&box, b->scene->origin);
}

static alp_result build(builder *b, const uint32_t *scene_materials)
{
    alpi_obj *o = b->obj;
    uint32_t *primitives = NULL; // of each object so far
    ALP_TRY(check_corners(o));
    choose_origin(b);
    ALP_TRY(allocate(b));
    ALP_TRY(sort_faces(b));
    ALPI_TRY_NEW(o->context, primitives, o->objects.count);
    alp_result result = ALP_OK;
    for (uint32_t s = 0; result == ALP_OK && s < o->surface_count; s++) {
        result = add_surface(b, s, scene_materials, primitives[o->surfaces[s].object]++);
    }
    alpi_release(o->context, primitives);
    return result == ALP_OK && b->scene->vertex_count > 0 ? resize(b, b->scene->vertex_count)
                                                          : result;
}

static void note_materials(const alpi_obj *o)
{
    uint32_t without = 0;
    for (uint32_t s = 0; s < o->surface_count; s++) {
        without += o->surfaces[s].material == ALPI_NONE;
    }
    if (without > 0) {
        alpi_note(o->context, "no-material", o->path,
                  "surfaces without a material, read as a grey of albedo 0.5: %u", without);
    }
}

alp_result alpi_obj_fill_meshes(alpi_obj *obj, const uint32_t *scene_materials, alp_scene *scene)
{
    builder b = {.obj = obj, .scene = scene, .scratch = {.context = obj->context}};
    alp_result result = build(&b, scene_materials);
    if (result == ALP_OK) {
        note_materials(obj);
    }
    if (result == ALP_OK && scene->triangle_count == 0) {
        alpi_warn(obj->context, "no-triangles", obj->path,
                  "%u vertices, but no faces: there is nothing to bake", obj->position_count);
    }
    void *const arrays[] = {b.order,  b.surface_ends, b.table, b.vertex_corners,
                            b.points, b.vertices,     b.parts};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) {
        alpi_release(obj->context, arrays[i]);
    }
    alpi_polygon_scratch_destroy(&b.scratch);
    return result;
}
