// SPDX-License-Identifier: MIT
// The steps of reading a glTF document into a scene, in the order they run.
#ifndef ALPI_FORMATS_GLTF_READ_H
#define ALPI_FORMATS_GLTF_READ_H

#include "base/vec.h"
#include "formats/gltf/gltf_document.h"
#include "scene/scene.h"

typedef struct alpi_gltf_reader {
    alp_context *context;
    const alpi_gltf_document *document;
    const char *choice; // number or name of the scene to read; NULL = the file's first
    alp_scene *scene;   // being filled
    uint32_t node_count;
    mat4 *world;     // [node_count] node → world, of the nodes in `order`
    uint32_t *order; // [order_count] nodes of the scene, parents first, in file order
    uint32_t order_count;
    bool *placed;        // [node_count] whether a node is in `order`
    bool *hidden;        // [node_count] whether it shows neither mesh nor light
    bool *material_used; // [scene.material_count]
    uint64_t posing;     // work of skins and morph targets so far
    uint64_t keys;       // numbers of animations so far
    // For a pose: the scene that it moves, and the transforms of the nodes. Else NULL.
    const alp_scene *base;
    struct alpi_gltf_moment *moments; // [moment_count] of all nodes
    size_t moment_count;
    uint32_t unread_channels; // of that animation, which move something else than a node
} alpi_gltf_reader;

/// gltf_nodes.c: checks that the nodes are trees and fills world and order.
alp_result alpi_gltf_read_nodes(alpi_gltf_reader *reader);
/// Its node's name, else its mesh's, else a number; the caller's.
char *alpi_gltf_surface_name(const alpi_gltf_reader *reader, const alpi_surface *surface);
/// gltf_materials.c: scene.materials, one for each of the file, at the same index.
alp_result alpi_gltf_read_materials(alpi_gltf_reader *reader);
/// gltf_materials.c: the texture that an object names as `member`; none where there is none or it
/// cannot be read (with a warning).
alp_result alpi_gltf_read_texture(const alpi_gltf_reader *reader, json_t *object,
                                  const char *member, const char *owner, alpi_texture *texture);
/// Makes the texture of a map ("occlusionTexture") blended where the extras of its material name
/// three slots for it.
void alpi_gltf_blend_texture(json_t *material, const char *map, alpi_texture *texture);
/// Warns ("no-uv") where the material of a surface reads a texture by a coordinate set that its
/// primitive lacks: it is one texel everywhere. @param accessors of the sets
void alpi_gltf_check_sets(const alpi_gltf_reader *reader, const alpi_surface *surface,
                          const size_t accessors[ALPI_UV_SLOT_COUNT]);
/// gltf_mesh.c: surfaces, vertices and triangles; marks the materials that they use.
alp_result alpi_gltf_read_meshes(alpi_gltf_reader *reader);
/// Counts of primitives and nodes.
typedef struct alpi_gltf_oddities {
    uint32_t empty, first_empty[2]; // the first one's mesh and primitive
    uint32_t not_triangles, without_material, without_position, morphed, skinned, instanced, hidden;
    size_t placement_count; // instances of all nodes
} alpi_gltf_oddities;
/// gltf_oddities.c: warns of empty primitives, and notes the other kinds.
void alpi_gltf_tell_oddities(const alpi_gltf_reader *reader, const alpi_gltf_oddities *odd);
/// The attribute whose coordinates are kept in a slot.
void alpi_gltf_slot_name(uint32_t slot, char *name, size_t size);
/// gltf_images.c: scene.images, one for each of the file; decodes those that used materials need.
alp_result alpi_gltf_read_images(alpi_gltf_reader *reader);
/// One image of the document, or why it cannot be read.
alp_result alpi_gltf_decode_image(const alpi_gltf_document *document, size_t index,
                                  alp_image **image);
/// The same; one that cannot be read stays NULL and costs a warning. @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_gltf_read_image(const alpi_gltf_document *document, size_t index,
                                alp_image **image);
/// gltf_cameras.c
alp_result alpi_gltf_read_cameras(alpi_gltf_reader *reader);
/// gltf_lights.c
alp_result alpi_gltf_read_lights(alpi_gltf_reader *reader);

/// gltf_read.c: all of them. The scene takes the document over (also on failure).
alp_result alpi_gltf_scene_from_document(alpi_gltf_document *document, alp_scene **scene);

/// Translation · rotation (unit quaternion x y z w) · scale.
mat4 alpi_gltf_compose(const double t[3], const double q[4], const double s[3]);

/// Nodes may share meshes and so may multiply a small file: primitives that they may place.
enum { ALPI_GLTF_SURFACE_LIMIT = 1 << 22 };

/// One instance of EXT_mesh_gpu_instancing, placed in its node's space.
typedef struct alpi_gltf_instance {
    double translation[3], rotation[4], scale[3]; // rotation: unit
} alpi_gltf_instance;
/// The attributes of a node whose mesh is shown in instances, NULL where it is not.
json_t *alpi_gltf_instancing(json_t *node);
/// They, released by the caller; NULL and 0 where the node does not show its mesh in instances.
alp_result alpi_gltf_read_instances(const alpi_gltf_document *document, size_t node,
                                    alpi_gltf_instance **instances, uint32_t *count);

#endif
