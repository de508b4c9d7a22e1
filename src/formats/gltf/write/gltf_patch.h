// SPDX-License-Identifier: MIT
// The patcher: a glTF document, edits of its text, and elements that it gains. README.md lists the
// files that share it.
#ifndef ALPI_FORMATS_GLTF_PATCH_H
#define ALPI_FORMATS_GLTF_PATCH_H

#include "formats/gltf/gltf_document.h"
#include "formats/text/text_edits.h"
#include "scene/mesh_patch.h"
#include "scene/scene.h"

// --- root arrays that grow -----------------------------------------------------------------------

typedef enum alpi_gltf_kind {
    ALPI_GLTF_ACCESSORS,
    ALPI_GLTF_BUFFERS,
    ALPI_GLTF_BUFFER_VIEWS,
    ALPI_GLTF_IMAGES,
    ALPI_GLTF_MATERIALS,
    ALPI_GLTF_MESHES,
    ALPI_GLTF_NODES,
    ALPI_GLTF_SAMPLERS,
    ALPI_GLTF_TEXTURES,
    ALPI_GLTF_KIND_COUNT
} alpi_gltf_kind;

typedef struct alpi_gltf_list {
    size_t count;          // elements in the document
    alpi_json_span *spans; // [count]
    size_t added;          // new elements
    alpi_bytes text;       // of the new ones, with commas between
} alpi_gltf_list;

// --- the plan ------------------------------------------------------------------------------------

enum { ALPI_GLTF_BLEND_SETS = 3, ALPI_GLTF_ATTRIBUTE_SIZE = 32 };

/// A part of a primitive whose triangles lie on one page; it becomes a primitive of its own.
typedef struct alpi_gltf_piece {
    uint32_t page;   // ALPI_NONE: its material's occlusion is packed into an image
    size_t material; // in the written file
    size_t mapped;   // first of its materials of variants, in alpi_gltf_patcher.mapped
} alpi_gltf_piece;

/// A material of the document, and a copy of it in the written file.
typedef struct alpi_gltf_material_copy {
    size_t old, written;
} alpi_gltf_material_copy;

/// One surface that gets a map. Plans with the same `user` are neighbours: the primitives of one
/// node, which further nodes may show too (with kept coordinates: of one mesh).
typedef struct alpi_gltf_plan {
    uint32_t surface;
    size_t user; // node, or mesh with kept coordinates
    size_t mesh, primitive;
    size_t material; // in the document, ALPI_GLTF_NONE = none
    // What its map is read with, as alpi_patcher_set_name names it: one, or three where a shader
    // blends. The first is n of a TEXCOORD_n.
    uint32_t sets[ALPI_GLTF_BLEND_SETS];
    uint64_t dropped; // bits of sets of an earlier bake that go
    bool packed;      // only its material changes
    bool occluded;    // gets the occlusion map
    bool lit;         // gets the light
    bool cleared;     // loses its own occlusion map, which would darken the light again
    bool in_a_copy;   // the mesh is copied for its nodes, because others use it too
    size_t piece_first, piece_count;
    size_t showing_first, showing_end; // of the first plan of a user: its nodes
} alpi_gltf_plan;

/// A node that shows the mesh of a user. Instances count as nodes, behind those of the document.
typedef struct alpi_gltf_showing {
    size_t user, node;
} alpi_gltf_showing;

/// An instance of a node's mesh.
typedef struct alpi_gltf_shown {
    size_t node; // of the document
    size_t mesh; // that it comes to show
} alpi_gltf_shown;

// --- the patcher ---------------------------------------------------------------------------------

typedef struct alpi_gltf_patcher {
    alp_context *context;
    const alp_scene *scene;
    const alpi_mesh_patch *patch;
    const alpi_gltf_document *document;
    bool exported; // the document was made from the scene: vertex i of a surface is its vertex i
    alpi_json_span root;
    alpi_gltf_list lists[ALPI_GLTF_KIND_COUNT];
    alpi_edits edits; // of the document's text

    // New binary data: it begins at byte `data_base` of buffer `data_buffer`.
    alpi_bytes data;
    size_t data_buffer, data_base;
    struct alpi_gltf_known *known; // accessors made so far, to find equal ones again
    size_t known_count, known_capacity;
    uint32_t *known_table;
    size_t known_table_size;

    // The plan.
    uint32_t *triangle_pages; // [scene triangles] page of each; zero-area ones follow a neighbour
    alpi_gltf_plan *plans;
    size_t plan_count;
    alpi_gltf_showing *showings; // sorted by user
    size_t showing_count;
    alpi_gltf_piece *pieces;
    size_t piece_count, piece_capacity;
    size_t *mapped; // of each mapping of variants of each piece; ALPI_GLTF_NONE: as it was
    size_t mapped_count, mapped_capacity;
    alpi_gltf_material_copy *copies;
    size_t copy_count, copy_capacity;
    size_t *instance_counts, *instance_firsts; // [nodes of the document] count 0: a plain node
    alpi_gltf_shown *instances;
    size_t expanded_count; // nodes whose instances became nodes
    size_t plain_count;    // primitives that were compressed and are no more
    size_t undraco_count;  // primitives of the document that lost Draco's extension
    size_t cleared_count;  // materials of the written file that lost their occlusion map

    // Maps: the texture of each page, ALPI_GLTF_NONE until it is used.
    size_t *page_textures;   // [page_count]
    size_t *light_textures;  // [page_count] the same of light; EXTRAS: 0 where it is used
    char *const *page_uris;  // of occlusion, then packed, then light; or NULL: embed
    char *const *light_uris; // [page_count] of EXTRAS, else NULL
    const char *extension;   // that materials have come to use, or NULL
    size_t *packed_images;   // [packed_count] in the written file, ALPI_GLTF_NONE until used
    size_t *texture_copies;  // [textures of the document] the same with the packed image, or NONE
    bool *image_embedded;    // [images of the document] moved into the new data
} alpi_gltf_patcher;

alp_result alpi_patcher_create(const alp_scene *scene, const alpi_mesh_patch *patch,
                               const alpi_gltf_document *document, alpi_gltf_patcher *patcher);
void alpi_patcher_destroy(alpi_gltf_patcher *patcher);

/// Makes the edits for the patch; data_buffer, data_base and page_uris must be set. Buffers are
/// left to the caller, and so is alpi_patcher_finish.
alp_result alpi_patcher_run(alpi_gltf_patcher *patcher);

/// Inserts what the lists gained and gives the new text.
alp_result alpi_patcher_finish(alpi_gltf_patcher *patcher, alpi_bytes *text);

#endif
