// SPDX-License-Identifier: MIT
// COLLADA document → scene: runs the steps of collada_read.h. The document stays with the scene, so
// that the writer can splice its text.
#include "formats/collada/collada_read.h"

#include "base/hash.h"
#include "base/memory.h"
#include "formats/collada/collada_scene.h"
#include "scene/origin.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// Nodes may share meshes and so may multiply a small file: what they may add up to.
enum { EXPANSION_LIMIT = 1 << 28, SURFACE_LIMIT = 1 << 22 };

// --- life ----------------------------------------------------------------------------------------

alp_result alpi_collada_reader_create(alpi_collada_document *document, alpi_collada_reader *reader)
{
    *reader = (alpi_collada_reader){.context = document->context,
                                    .document = document,
                                    .polygons = {.context = document->context}};
    ALPI_TRY_NEW(reader->context, reader->slots, document->element_count);
    return ALP_OK;
}

void alpi_collada_reader_destroy(alpi_collada_reader *r)
{
    for (uint32_t i = 0; i < r->array_count; i++) {
        alpi_release(r->context, r->arrays[i].values);
        alpi_release(r->context, r->arrays[i].exact);
    }
    for (uint32_t m = 0; m < r->mesh_count; m++) {
        for (uint32_t p = 0; p < r->meshes[m].part_count; p++) {
            alpi_release(r->context, r->meshes[m].parts[p].vertices);
            alpi_release(r->context, r->meshes[m].parts[p].triangles);
        }
        alpi_release(r->context, r->meshes[m].parts);
    }
    void *const owned[] = {r->arrays,  r->sources, r->meshes,    r->placements, r->fixtures,
                           r->effects, r->slots,   r->materials, r->images};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) {
        alpi_release(r->context, owned[i]);
    }
    alpi_polygon_scratch_destroy(&r->polygons);
}

static void destroy_origin(alp_context *context, void *data)
{
    alpi_collada_origin *origin = data;
    alpi_collada_document_destroy(origin->document);
    alpi_release(context, origin->surfaces);
    alpi_release(context, origin->placements);
    alpi_release(context, origin->materials);
    alpi_release(context, origin->images);
    alpi_release(context, origin);
}

// --- sizes ---------------------------------------------------------------------------------------

static uint32_t scene_vertex_count(const alpi_collada_part *part)
{
    return part->inputs.source[ALPI_COLLADA_NORMAL] == ALPI_NONE ? 3 * part->triangle_count
                                                                 : part->vertex_count;
}

static alp_result add_arrays(alpi_collada_reader *reader, uint64_t vertices, uint64_t triangles,
                             uint64_t surfaces)
{
    alp_scene *scene = reader->scene;
    if (vertices > EXPANSION_LIMIT || triangles > EXPANSION_LIMIT || surfaces > SURFACE_LIMIT) {
        return alpi_fail(reader->context, ALP_ERROR_LIMIT,
                         "%s: the nodes place more than %d vertices or triangles, or more than %d "
                         "primitives; split the scene",
                         reader->document->path, EXPANSION_LIMIT, SURFACE_LIMIT);
    }
    ALPI_TRY_NEW(reader->context, scene->positions, vertices);
    ALPI_TRY_NEW(reader->context, scene->normals, vertices);
    ALPI_TRY_NEW(reader->context, scene->vertex_source, vertices);
    ALPI_TRY_NEW(reader->context, scene->triangles, triangles);
    ALPI_TRY_NEW(reader->context, scene->triangle_surface, triangles);
    ALPI_TRY_NEW(reader->context, scene->surfaces, surfaces);
    return ALP_OK;
}

static alp_result allocate_scene(alpi_collada_reader *reader)
{
    uint64_t vertices = 0, triangles = 0, surfaces = 0;
    uint32_t uv_sets = 0;
    bool colors = false;
    for (uint32_t m = 0; m < reader->mesh_count; m++) { // once each, however often they are placed
        alpi_collada_mesh *mesh = &reader->meshes[m];
        for (uint32_t p = 0; p < mesh->part_count; p++) {
            const alpi_collada_part *part = &mesh->parts[p];
            mesh->vertex_count += scene_vertex_count(part);
            mesh->triangle_count += part->triangle_count;
            uv_sets = part->inputs.uv_count > uv_sets ? part->inputs.uv_count : uv_sets;
            colors |= part->inputs.source[ALPI_COLLADA_COLOR] != ALPI_NONE;
        }
    }
    for (uint32_t i = 0; i < reader->placement_count; i++) { // of less than 2^32 below 2^64
        const alpi_collada_mesh *mesh = &reader->meshes[reader->placements[i].mesh];
        vertices += mesh->vertex_count;
        triangles += mesh->triangle_count;
        surfaces += mesh->part_count;
    }
    ALP_TRY(add_arrays(reader, vertices, triangles, surfaces));
    for (uint32_t k = 0; k < uv_sets; k++) {
        ALPI_TRY_NEW(reader->context, reader->scene->uvs[k], vertices);
    }
    if (colors) {
        ALPI_TRY_NEW(reader->context, reader->scene->colors, vertices);
    }
    return ALP_OK;
}

// --- filling -------------------------------------------------------------------------------------

/// What one surface is made of.
typedef struct filling {
    alpi_collada_reader *reader;
    const alpi_collada_placement *placement;
    const alpi_collada_part *part;
    alpi_surface *surface;
} filling;

/// Source of a key, NULL where the part has none.
static const alpi_collada_source *source_of(const filling *f, uint32_t key)
{
    const uint32_t source = f->part->inputs.source[key];
    return source == ALPI_NONE ? NULL : &f->reader->sources[source];
}

/// Index into a key's source of vertex i of the surface.
static uint32_t index_of(const filling *f, uint32_t i, uint32_t key)
{
    const uint32_t vertex = f->reader->scene->vertex_source[f->surface->first_vertex + i];
    return f->part->vertices[vertex][key];
}

/// Without normals every triangle gets three vertices of its own, so that it can be flat. A
/// mirroring transform turns the winding, so it is turned back.
static void fill_triangles(const filling *f)
{
    alp_scene *scene = f->reader->scene;
    alpi_surface *s = f->surface;
    const bool own = s->normals_generated;
    uint32_t *sources = scene->vertex_source + s->first_vertex;
    for (uint32_t i = 0; !own && i < s->vertex_count; i++) {
        sources[i] = i;
    }
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        uint32_t *triangle = scene->triangles[s->first_triangle + t];
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t place = s->mirrored ? (3 - k) % 3 : k;
            const uint32_t vertex = f->part->triangles[t][k];
            if (own) {
                sources[3 * t + k] = vertex;
            }
            triangle[place] = s->first_vertex + (own ? 3 * t + k : vertex);
        }
        scene->triangle_surface[s->first_triangle + t] = (uint32_t)(s - scene->surfaces);
    }
}

static vec3 vector_of(const alpi_collada_source *source, uint32_t index)
{
    return (vec3){alpi_collada_value(source, index, 0), alpi_collada_value(source, index, 1),
                  alpi_collada_value(source, index, 2)};
}

static void fill_positions(const filling *f)
{
    alp_scene *scene = f->reader->scene;
    const alpi_collada_source *positions = source_of(f, ALPI_COLLADA_POSITION);
    const alpi_collada_source *normals = source_of(f, ALPI_COLLADA_NORMAL);
    for (uint32_t i = 0; i < f->surface->vertex_count; i++) {
        const uint32_t v = f->surface->first_vertex + i;
        const vec3 position = vector_of(positions, index_of(f, i, ALPI_COLLADA_POSITION));
        vec3_store(scene->positions[v], mat4_transform_point(&f->placement->world, position));
        if (normals != NULL) { // else they stay 0, and alpi_scene_finish takes the triangle's
            const vec3 normal = vector_of(normals, index_of(f, i, ALPI_COLLADA_NORMAL));
            vec3_store(scene->normals[v], mat4_transform_normal(&f->placement->world, normal));
        }
    }
}

static void fill_flat_normals(const filling *f)
{
    alp_scene *scene = f->reader->scene;
    for (uint32_t i = 0; i < f->surface->triangle_count; i++) {
        const uint32_t t = f->surface->first_triangle + i;
        vec3 corner[3];
        alpi_triangle_corners(scene, t, corner);
        const vec3 normal =
            vec3_triangle_normal(corner[0], corner[1], corner[2], (vec3){0.0f, 0.0f, 0.0f});
        for (int k = 0; k < 3; k++) {
            vec3_store(scene->normals[scene->triangles[t][k]], normal);
        }
    }
}

/// COLLADA counts t from the bottom of the image, the scene counts v from the top.
static void fill_uvs(const filling *f, uint32_t set)
{
    alp_scene *scene = f->reader->scene;
    const alpi_collada_source *source = source_of(f, ALPI_COLLADA_UV + set);
    uint32_t bad = 0;
    for (uint32_t i = 0; source != NULL && i < f->surface->vertex_count; i++) {
        const uint32_t v = f->surface->first_vertex + i, at = index_of(f, i, ALPI_COLLADA_UV + set);
        const float uv[2] = {alpi_collada_value(source, at, 0),
                             1.0f - alpi_collada_value(source, at, 1)};
        for (int k = 0; k < 2; k++) {
            bad += isfinite(uv[k]) ? 0u : 1u;
            scene->uvs[set][v][k] = isfinite(uv[k]) ? uv[k] : 0.0f;
        }
    }
    if (bad > 0) {
        alpi_warn(f->reader->context, "bad-uvs", f->surface->name,
                  "values of texture coordinate set %u that are not finite, and count as 0: %u",
                  f->part->inputs.uv_numbers[set], bad);
    }
}

static void fill_colors(const filling *f)
{
    alp_scene *scene = f->reader->scene;
    const alpi_collada_source *source = source_of(f, ALPI_COLLADA_COLOR);
    for (uint32_t i = 0; scene->colors != NULL && i < f->surface->vertex_count; i++) {
        const uint32_t v = f->surface->first_vertex + i;
        for (uint32_t k = 0; k < 4; k++) {
            const float value =
                source != NULL && k < source->components
                    ? alpi_collada_value(source, index_of(f, i, ALPI_COLLADA_COLOR), k)
                    : 1.0f;
            scene->colors[v][k] = value > 0.0f ? fminf(value, 1.0f) : 0.0f; // NaN → 0
        }
    }
}

/// Name of the node that shows it, else of the geometry.
static char *surface_name(const alpi_collada_reader *reader, const alpi_collada_placement *at)
{
    const alpi_collada_mesh *mesh = &reader->meshes[at->mesh];
    char number[32];
    snprintf(number, sizeof number, "geometry %u", mesh->index);
    const bool named =
        alpi_xml_attribute(at->node, "name") != NULL || alpi_xml_attribute(at->node, "id") != NULL;
    return alpi_collada_copy_name(reader->context, named ? at->node : mesh->geometry, number);
}

static alp_result fill_surface(filling *f, alpi_collada_surface *origin)
{
    alpi_collada_reader *reader = f->reader;
    alp_scene *scene = reader->scene;
    const alpi_collada_mesh *mesh = &reader->meshes[f->placement->mesh];
    const uint32_t placement = (uint32_t)(f->placement - reader->placements);
    alpi_surface *s = f->surface = &scene->surfaces[scene->surface_count];
    *s = (alpi_surface){.name = surface_name(reader, f->placement),
                        .node = placement,
                        .mesh = mesh->index,
                        .primitive = f->part->primitive,
                        .first_vertex = scene->vertex_count,
                        .vertex_count = scene_vertex_count(f->part),
                        .first_triangle = scene->triangle_count,
                        .triangle_count = f->part->triangle_count,
                        .uv_sets = f->part->inputs.uv_count,
                        .uv_slots = (uint8_t)((1u << f->part->inputs.uv_count) - 1u),
                        .mirrored = mat4_determinant3(&f->placement->world) < 0.0,
                        .normals_generated =
                            f->part->inputs.source[ALPI_COLLADA_NORMAL] == ALPI_NONE};
    mat4_axes(&f->placement->world, s->axes);
    scene->surface_count++;
    scene->vertex_count += s->vertex_count;
    scene->triangle_count += s->triangle_count;
    *origin =
        (alpi_collada_surface){f->part->element, mesh->geometry, f->placement->instance, placement};
    if (s->name == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    ALP_TRY(alpi_collada_read_material(reader, f->placement, f->part, &s->material));
    fill_triangles(f);
    fill_positions(f);
    if (s->normals_generated) {
        fill_flat_normals(f);
    }
    for (uint32_t k = 0; k < f->part->inputs.uv_count; k++) {
        fill_uvs(f, k);
    }
    fill_colors(f);
    return ALP_OK;
}

static alp_result fill_surfaces(alpi_collada_reader *reader, alpi_collada_origin *origin)
{
    ALP_TRY(allocate_scene(reader));
    uint32_t count = 0;
    for (uint32_t i = 0; i < reader->placement_count; i++) {
        count += reader->meshes[reader->placements[i].mesh].part_count;
    }
    ALPI_TRY_NEW(reader->context, origin->surfaces, count);
    for (uint32_t i = 0; i < reader->placement_count; i++) {
        const alpi_collada_mesh *mesh = &reader->meshes[reader->placements[i].mesh];
        for (uint32_t p = 0; p < mesh->part_count; p++) {
            if (mesh->parts[p].triangle_count == 0) {
                continue;
            }
            filling f = {reader, &reader->placements[i], &mesh->parts[p], NULL};
            ALP_TRY(fill_surface(&f, &origin->surfaces[reader->scene->surface_count]));
        }
    }
    origin->placement_count = reader->placement_count; // from here it has the placements
    origin->placements = reader->placements;
    return ALP_OK;
}

// --- far from the origin -------------------------------------------------------------------------

/// Positions of the surface from the digits of its document.
static alp_result refill_positions(const filling *f)
{
    const alpi_collada_source *source = source_of(f, ALPI_COLLADA_POSITION);
    alp_scene *scene = f->reader->scene;
    const mat4 *world = &f->placement->world;
    const double *values = NULL;
    ALP_TRY(alpi_collada_exact_values(f->reader, source, &values));
    for (uint32_t i = 0; i < f->surface->vertex_count; i++) {
        const double *at =
            values + source->first + (size_t)index_of(f, i, ALPI_COLLADA_POSITION) * source->stride;
        double p[3] = {0.0, 0.0, 0.0};
        for (uint32_t k = 0; k < 3 && k < source->components; k++) {
            p[k] = at[source->place[k]];
        }
        for (int k = 0; k < 3; k++) {
            scene->positions[f->surface->first_vertex + i][k] =
                (float)(world->m[k] * p[0] + world->m[4 + k] * p[1] + world->m[8 + k] * p[2] +
                        world->m[12 + k]);
        }
    }
    return ALP_OK;
}

static alp_result refill_surfaces(alpi_collada_reader *reader)
{
    uint32_t surface = 0;
    for (uint32_t i = 0; i < reader->placement_count; i++) {
        const alpi_collada_mesh *mesh = &reader->meshes[reader->placements[i].mesh];
        for (uint32_t p = 0; p < mesh->part_count; p++) {
            if (mesh->parts[p].triangle_count == 0) {
                continue;
            }
            const filling f = {reader, &reader->placements[i], &mesh->parts[p],
                               &reader->scene->surfaces[surface++]};
            ALP_TRY(refill_positions(&f));
            if (f.surface->normals_generated) {
                fill_flat_normals(&f);
            }
        }
    }
    return ALP_OK;
}

/// Takes the scene's origin off the transforms where vertices are far away, and fills in what they
/// moved.
static alp_result move_to_origin(alpi_collada_reader *reader)
{
    double step[3];
    for (int round = 0; round < ALPI_ORIGIN_ROUNDS && alpi_origin_step(reader->scene, NULL, step);
         round++) {
        for (uint32_t i = 0; i < reader->placement_count; i++) {
            alpi_origin_move(&reader->placements[i].world, step);
        }
        for (uint32_t i = 0; i < reader->fixture_count; i++) {
            alpi_origin_move(&reader->fixtures[i].world, step);
        }
        ALP_TRY(refill_surfaces(reader));
    }
    return ALP_OK;
}

// --- all together --------------------------------------------------------------------------------

static void count_losses(const alpi_collada_reader *reader, alpi_collada_losses *losses)
{
    const xmlNode *library = alpi_xml_child(reader->document->root, "library_animations");
    for (uint32_t i = 0; i < reader->effect_count; i++) {
        losses->heights += reader->effects[i].has_heights;
        losses->gloss_maps += reader->effects[i].has_gloss_map;
        losses->mirrors += reader->effects[i].has_mirror;
    }
    for (; library != NULL; library = alpi_xml_next(library, "library_animations")) {
        const xmlNode *animation = alpi_xml_child(library, "animation");
        for (; animation != NULL; animation = alpi_xml_next(animation, "animation")) {
            losses->animations++;
        }
    }
}

static alp_result fill_scene(alpi_collada_reader *reader, alpi_collada_origin *origin)
{
    ALP_TRY(alpi_collada_read_asset(reader));
    ALP_TRY(alpi_collada_read_nodes(reader));
    ALP_TRY(fill_surfaces(reader, origin));
    ALP_TRY(move_to_origin(reader));
    ALP_TRY(alpi_collada_read_images(reader));
    ALP_TRY(alpi_collada_read_fixtures(reader));
    alpi_collada_tell_oddities(reader);
    ALPI_TRY_NEW(reader->context, origin->materials, reader->material_count);
    ALPI_TRY_NEW(reader->context, origin->images, reader->image_count);
    for (uint32_t i = 0; i < reader->image_count; i++) {
        origin->images[i] = reader->images[i].element;
    }
    count_losses(reader, &origin->losses);
    for (uint32_t m = 0; m < reader->material_count; m++) {
        origin->materials[m] = reader->materials[m].element;
    }
    return alpi_scene_finish(reader->scene);
}

alp_result alpi_collada_scene_from_document(alpi_collada_document *document, alp_scene **scene)
{
    *scene = NULL;
    alp_context *context = document->context;
    alpi_collada_reader reader = {0};
    alp_scene *made = NULL;
    alpi_collada_origin *origin = ALPI_NEW(context, alpi_collada_origin, 1);
    alp_result result = origin == NULL ? ALP_ERROR_OUT_OF_MEMORY
                                       : alpi_scene_create(context, document->path, &made);
    if (result != ALP_OK) {
        alpi_collada_document_destroy(document);
        alpi_release(context, origin);
        return result;
    }
    origin->document = document;
    made->read_image = alpi_collada_read_image;
    made->attachments[ALPI_ATTACHMENT_COLLADA] = (alpi_attachment){origin, destroy_origin};
    made->input_hash = alpi_hash_bytes(ALPI_HASH_START, document->file_bytes, document->file_size);
    result = alpi_collada_reader_create(document, &reader);
    reader.scene = made;
    if (result == ALP_OK) {
        result = fill_scene(&reader, origin);
    }
    if (origin->placements != NULL) {
        reader.placements = NULL;
    }
    alpi_collada_reader_destroy(&reader);
    if (result != ALP_OK) {
        alp_scene_destroy(made);
        return result;
    }
    *scene = made;
    return ALP_OK;
}

alp_result alpi_collada_read_scene(alp_context *context, const char *path, alp_scene **scene)
{
    alpi_collada_document *document = NULL;
    *scene = NULL;
    ALP_TRY(alpi_collada_document_read(context, path, &document));
    return alpi_collada_scene_from_document(document, scene);
}
