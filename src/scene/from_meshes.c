// SPDX-License-Identifier: MIT
// A scene from arrays that a program hands over: one surface and one material per mesh.
#include "scene/scene.h"

#include "base/hash.h"
#include "base/memory.h"

#include <stdio.h>
#include <string.h>

/// Texture coordinates are stored as set 0 too: a file may not have set 1 without set 0.
enum { UV_SETS_OF_A_MESH = 2 };

static const char *name_of(const alp_mesh *mesh, uint32_t index, char buffer[32])
{
    if (mesh->name != NULL) {
        return mesh->name;
    }
    snprintf(buffer, 32, "mesh %u", index);
    return buffer;
}

static bool is_flat(const alp_mesh *mesh)
{
    return mesh->normals == NULL;
}

/// Vertices that the mesh takes in the scene: a flat one has three of its own per triangle.
static uint64_t scene_vertex_count(const alp_mesh *mesh)
{
    return is_flat(mesh) ? 3 * (uint64_t)mesh->triangle_count : mesh->vertex_count;
}

static alp_result check_mesh(alp_context *context, const alp_mesh *mesh, uint32_t index)
{
    char buffer[32];
    const char *name = name_of(mesh, index, buffer);
    if ((mesh->positions == NULL && mesh->vertex_count > 0) ||
        (mesh->indices == NULL && mesh->triangle_count > 0)) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT, "mesh %u (%s): %s is NULL", index,
                         name, mesh->positions == NULL ? "positions" : "indices");
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            uint32_t vertex = mesh->indices[3 * (size_t)t + (size_t)k];
            if (vertex >= mesh->vertex_count) {
                return alpi_fail(context, ALP_ERROR_INVALID_DATA,
                                 "mesh %u (%s): triangle %u uses vertex %u, there are %u", index,
                                 name, t, vertex, mesh->vertex_count);
            }
        }
    }
    return ALP_OK;
}

static alp_result allocate(alp_scene *scene, const alp_mesh *meshes, uint32_t mesh_count)
{
    uint64_t vertices = 0, triangles = 0;
    bool uvs = false;
    for (uint32_t i = 0; i < mesh_count; i++) {
        vertices += scene_vertex_count(&meshes[i]);
        triangles += meshes[i].triangle_count;
        uvs |= meshes[i].uvs != NULL;
    }
    if (vertices >= ALPI_NONE || triangles >= ALPI_NONE) {
        return alpi_fail(scene->context, ALP_ERROR_LIMIT,
                         "%s: %llu vertices and %llu triangles; the limit is 4294967294 of each",
                         scene->name, (unsigned long long)vertices, (unsigned long long)triangles);
    }
    ALPI_TRY_NEW(scene->context, scene->positions, vertices);
    ALPI_TRY_NEW(scene->context, scene->normals, vertices);
    ALPI_TRY_NEW(scene->context, scene->vertex_source, vertices);
    for (int set = 0; uvs && set < UV_SETS_OF_A_MESH; set++) {
        ALPI_TRY_NEW(scene->context, scene->uvs[set], vertices);
    }
    ALPI_TRY_NEW(scene->context, scene->triangles, triangles);
    ALPI_TRY_NEW(scene->context, scene->triangle_surface, triangles);
    ALPI_TRY_NEW(scene->context, scene->surfaces, mesh_count);
    ALPI_TRY_NEW(scene->context, scene->materials, mesh_count);
    return ALP_OK;
}

/// Copies vertex `source` of the mesh to the end of the scene's vertices.
static void append_vertex(alp_scene *scene, const alp_mesh *mesh, uint32_t source)
{
    uint32_t v = scene->vertex_count++;
    memcpy(scene->positions[v], mesh->positions + 3 * (size_t)source, sizeof scene->positions[v]);
    if (!is_flat(mesh)) { // a flat normal stays 0: alpi_scene_finish takes the triangle's
        memcpy(scene->normals[v], mesh->normals + 3 * (size_t)source, sizeof scene->normals[v]);
    }
    for (int set = 0; mesh->uvs != NULL && set < UV_SETS_OF_A_MESH; set++) {
        memcpy(scene->uvs[set][v], mesh->uvs + 2 * (size_t)source, sizeof scene->uvs[set][v]);
    }
    scene->vertex_source[v] = source;
}

static void append_triangles(alp_scene *scene, const alp_mesh *mesh, uint32_t surface)
{
    uint32_t first = scene->vertex_count;
    for (uint32_t v = 0; !is_flat(mesh) && v < mesh->vertex_count; v++) {
        append_vertex(scene, mesh, v);
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        uint32_t triangle = scene->triangle_count++;
        for (size_t k = 0; k < 3; k++) {
            uint32_t source = mesh->indices[3 * (size_t)t + k];
            scene->triangles[triangle][k] = is_flat(mesh) ? scene->vertex_count : first + source;
            if (is_flat(mesh)) {
                append_vertex(scene, mesh, source);
            }
        }
        scene->triangle_surface[triangle] = surface;
    }
}

static alp_result append_mesh(alp_scene *scene, const alp_mesh *mesh, uint32_t index)
{
    char buffer[32];
    const char *name = name_of(mesh, index, buffer);
    alpi_surface *surface = &scene->surfaces[scene->surface_count++];
    *surface = (alpi_surface){.name = alpi_copy_string(scene->context, name),
                              .node = index,
                              .mesh = index,
                              .material = index,
                              .first_vertex = scene->vertex_count,
                              .first_triangle = scene->triangle_count,
                              .triangle_count = mesh->triangle_count,
                              .uv_sets = mesh->uvs ? UV_SETS_OF_A_MESH : 0,
                              .normals_generated = is_flat(mesh)};
    alpi_material *material = &scene->materials[scene->material_count++];
    *material = alpi_material_default();
    material->name = alpi_copy_string(scene->context, name);
    memcpy(material->base_color, mesh->base_color, sizeof mesh->base_color);
    memcpy(material->emission, mesh->emission, sizeof mesh->emission);
    material->double_sided = mesh->double_sided;
    if (surface->name == NULL || material->name == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    append_triangles(scene, mesh, index);
    surface->vertex_count = scene->vertex_count - surface->first_vertex;
    return ALP_OK;
}

static uint64_t hash_floats(uint64_t hash, const float *values, size_t count)
{
    return values == NULL ? hash : alpi_hash_bytes(hash, values, count * sizeof *values);
}

static uint64_t hash_mesh(uint64_t hash, const alp_mesh *mesh)
{
    const uint32_t header[] = {mesh->vertex_count, mesh->triangle_count, mesh->normals != NULL,
                               mesh->uvs != NULL, mesh->double_sided};
    size_t vertices = mesh->vertex_count, triangles = mesh->triangle_count;
    hash = alpi_hash_bytes(hash, header, sizeof header);
    hash = hash_floats(hash, mesh->base_color, 3);
    hash = hash_floats(hash, mesh->emission, 3);
    hash = hash_floats(hash, mesh->positions, 3 * vertices);
    hash = hash_floats(hash, mesh->normals, 3 * vertices);
    hash = hash_floats(hash, mesh->uvs, 2 * vertices);
    return alpi_hash_bytes(hash, mesh->indices, 3 * triangles * sizeof *mesh->indices);
}

static alp_result fill(alp_scene *scene, const alp_mesh *meshes, uint32_t mesh_count)
{
    ALP_TRY(allocate(scene, meshes, mesh_count));
    scene->input_hash = ALPI_HASH_START;
    for (uint32_t i = 0; i < mesh_count; i++) {
        ALP_TRY(append_mesh(scene, &meshes[i], i));
        scene->input_hash = hash_mesh(scene->input_hash, &meshes[i]);
    }
    return alpi_scene_finish(scene);
}

alp_result alp_scene_create_from_meshes(alp_context *context, const alp_mesh *meshes,
                                        uint32_t mesh_count, alp_scene **scene)
{
    if (scene != NULL) {
        *scene = NULL;
    }
    if (context == NULL) {
        return ALP_ERROR_INVALID_ARGUMENT;
    }
    if (scene == NULL || (meshes == NULL && mesh_count > 0)) {
        return alpi_fail(context, ALP_ERROR_INVALID_ARGUMENT, "scene from meshes: %s is NULL",
                         scene == NULL ? "the output pointer" : "the array of meshes");
    }
    for (uint32_t i = 0; i < mesh_count; i++) {
        ALP_TRY(check_mesh(context, &meshes[i], i));
    }
    alp_scene *made = NULL;
    ALP_TRY(alpi_scene_create(context, "scene from meshes", &made));
    alp_result result = fill(made, meshes, mesh_count);
    if (result != ALP_OK) {
        alp_scene_destroy(made);
        return result;
    }
    *scene = made;
    return ALP_OK;
}
