// SPDX-License-Identifier: MIT
// Between the files that write glTF: a document, what is changed in it, and what is added to it.
//
//   gltf_patch.c           the patcher: root arrays that grow, new binary data, the whole sequence
//   gltf_patch_plan.c      which primitives get what: coordinate set, pages, in place or in a copy
//   gltf_patch_sets.c      sets of coordinates: those of earlier bakes, free ones, their names
//   gltf_patch_material.c  one material per (old material, page, coordinate set)
//   gltf_patch_copies.c    copies of materials, which later bakes know as that
//   gltf_patch_light.c     materials that show baked light
//   gltf_patch_blend.c     what materials say of sets that are blended
//   gltf_patch_packed.c    materials whose occlusion goes into an image that they have already
//   gltf_split.c           vertices that chart borders part
//   gltf_patch_mesh.c      the edits of meshes, primitives and nodes
//   gltf_patch_attributes.c attributes of vertices that are split
//   gltf_patch_vertex.c    values at vertices as an attribute
//   gltf_patch_instances.c nodes that show their mesh in instances
//   gltf_patch_extensions.c what is used and required
//   gltf_tidy.c            what an earlier bake left and nothing reads any more
//   gltf_container.c       where binary data lives: BIN chunk, files, data URIs
//   gltf_write.c           file names, files
#ifndef ALPI_FORMATS_GLTF_PATCH_H
#define ALPI_FORMATS_GLTF_PATCH_H

#include "formats/formats.h"
#include "formats/gltf/gltf_document.h"
#include "formats/text/text_edits.h"

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
} alpi_gltf_piece;

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
    size_t *instance_counts, *instance_firsts; // [nodes of the document] count 0: a plain node
    alpi_gltf_shown *instances;
    size_t expanded_count; // nodes whose instances became nodes
    size_t plain_count;    // primitives that were compressed and are no more
    size_t undraco_count;  // primitives of the document that lost Draco's extension

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

/// Appends an element to a root array and gives its index in the written file.
size_t alpi_patcher_append(alpi_gltf_patcher *patcher, alpi_gltf_kind kind, const void *text,
                           size_t size);

/// New binary data as a bufferView. @param target 34962 vertices, 34963 indices, 0 none
/// @param stride 0 = packed
size_t alpi_patcher_add_view(alpi_gltf_patcher *patcher, const void *bytes, size_t size,
                             size_t stride, uint32_t target);

/// Values for a new accessor, packed as in alpi_gltf_values.
typedef struct alpi_gltf_array {
    const void *bytes;
    uint32_t count, components, component_type;
    size_t element_size;
    bool normalized, has_bounds, is_indices;
    const char *type; // NULL: SCALAR … VEC4 by components
    const char *mark; // NULL: ALPI_GLTF_COPY
} alpi_gltf_array;
/// A new accessor, or an equal one made before.
alp_result alpi_patcher_add_accessor(alpi_gltf_patcher *patcher, const alpi_gltf_array *array,
                                     size_t *accessor);

/// Fills plans, pieces and triangle_pages.
alp_result alpi_patcher_plan(alpi_gltf_patcher *patcher);
/// Decides the material of every piece and adds those that are needed.
alp_result alpi_patcher_materials(alpi_gltf_patcher *patcher);
/// The material that a plan's is a copy of, made by an earlier bake for another page, where the two
/// differ in nothing but maps that are replaced; else its own.
alp_result alpi_patcher_original(const alpi_gltf_patcher *patcher, const alpi_gltf_plan *plan,
                                 size_t *material);
/// Writes into a new copy what it is a copy of, where nothing is said there already.
alp_result alpi_patcher_mark_copy(alpi_gltf_patcher *patcher, size_t material, alpi_bytes *text);
/// The image of a PNG that the bake made, at its place `uri` of page_uris; its index.
size_t alpi_patcher_add_image(alpi_gltf_patcher *patcher, const char *name, uint32_t uri,
                              const uint8_t *png, size_t size);
/// A texture of an image that the bake made, read between texels and not repeated.
size_t alpi_patcher_add_texture(alpi_gltf_patcher *patcher, size_t image);

/// A material that shows baked light.
typedef struct alpi_gltf_light_use {
    size_t material; // of the document, ALPI_GLTF_NONE = the primitive had none
    uint32_t page, uv_set;
    float scale;       // what 1 in the image stands for
    const char *blend; // what the extras say of the sets that are blended, or NULL
} alpi_gltf_light_use;
/// Edits a material of the document so that it does.
void alpi_patcher_light_material(alpi_gltf_patcher *patcher, const alpi_gltf_light_use *use,
                                 alpi_edits *edits);
/// The members of a new material that does. @param mark a member of its extras, which says that
/// the primitive had no material; left out where the new one does not look like that any more
void alpi_patcher_print_light(alpi_gltf_patcher *patcher, const alpi_gltf_light_use *use,
                              const char *mark, alpi_bytes *text);
/// Adds the extension that materials use to extensionsUsed and takes out what nothing uses any
/// more; after all else.
void alpi_patcher_state_extensions(alpi_gltf_patcher *patcher);
/// Whether light goes to a surface's material: not to one that light shines through.
bool alpi_patcher_is_lit(const alpi_gltf_patcher *patcher, const alpi_surface *surface);

/// Which packed image a material of the document reads its occlusion from; ALPI_NONE = none.
uint32_t alpi_patcher_packed(const alpi_gltf_patcher *patcher, size_t material);
/// Edits a material of the document so that it reads the packed image.
alp_result alpi_patcher_pack_material(alpi_gltf_patcher *patcher, size_t material,
                                      alpi_edits *edits);
/// Edits the meshes of the plan and the nodes that use copies.
alp_result alpi_patcher_meshes(alpi_gltf_patcher *patcher);

/// Counts the instances of the scene's nodes; before the plan.
alp_result alpi_patcher_find_instances(alpi_gltf_patcher *patcher);
/// The node that shows a surface: of the document, or an instance.
size_t alpi_patcher_node_of(const alpi_gltf_patcher *patcher, uint32_t surface);
/// The node of the document that it is, or is an instance of.
size_t alpi_patcher_file_node(const alpi_gltf_patcher *patcher, size_t node);
/// Makes it show another mesh.
void alpi_patcher_show(alpi_gltf_patcher *patcher, size_t node, size_t mesh);
/// Makes nodes of instances that differ; after the meshes.
alp_result alpi_patcher_expand_instances(alpi_gltf_patcher *patcher);

// --- sets that are blended -----------------------------------------------------------------------

/// The attribute of a set: TEXCOORD_n of n < 32, _ALPENGLOW_UV_n of 32 + n.
void alpi_patcher_set_name(uint32_t set, char name[ALPI_GLTF_ATTRIBUTE_SIZE]);
/// A bit for each set that there is an attribute of, or that a description of a blend names.
uint64_t alpi_gltf_sets_of(json_t *attributes);
uint64_t alpi_gltf_sets_named(json_t *blend);
/// The sets that textures and maps of a material read, whatever it says of blends.
alp_result alpi_gltf_sets_read(alp_context *context, json_t *material, uint64_t *sets);
/// Chooses the sets of a plan, of which all else must be known: those of an earlier bake that only
/// maps read which are replaced are free, and go where they do not become new ones.
alp_result alpi_patcher_choose_sets(alpi_gltf_patcher *patcher, json_t *primitive,
                                    const char *owner, alpi_gltf_plan *plan);
/// A warning where maps are read with sets that viewers do not know.
void alpi_patcher_warn_of_sets(const alpi_gltf_patcher *patcher);
/// Whether an attribute is among the dropped sets; their removal.
bool alpi_patcher_is_dropped(const char *text, alpi_json_span key, uint64_t dropped);
void alpi_patcher_drop_sets(alpi_edits *edits, alpi_json_span attributes, uint64_t dropped);
/// Members of an object inside a material, which may not be there yet.
typedef struct alpi_gltf_inside {
    const char *outer;
    uint32_t count;
    const char *const *names, *const *values; // [count]
} alpi_gltf_inside;
/// Sets them; false where the outer one is there and no object.
bool alpi_patcher_set_inside(alpi_gltf_patcher *patcher, size_t material,
                             const alpi_gltf_inside *inside, alpi_edits *edits);
/// Maps that a bake gives a material.
typedef struct alpi_gltf_maps {
    bool occluded, lit;
} alpi_gltf_maps;
/// What the extras of a material say of them, a JSON object: their names in the order of the axes
/// of the mesh, and which of its maps are read with them; and the same of bakes before, whose maps
/// the material keeps.
/// @param material of the document, or ALPI_GLTF_NONE
void alpi_patcher_print_blend(const alpi_gltf_patcher *patcher, size_t material,
                              const uint32_t sets[ALPI_GLTF_BLEND_SETS], alpi_gltf_maps maps,
                              alpi_bytes *text);
/// What the maps of light are called in it, in the form of the patch's.
const char *alpi_patcher_light_name(const alpi_gltf_patcher *patcher);
/// Adds it to a material of the document.
void alpi_patcher_blend_material(alpi_gltf_patcher *patcher, size_t material, const char *blend,
                                 alpi_edits *edits);
/// Takes maps from those that earlier bakes said were blended. Their sets stay named: they hold
/// charts that overlap all the same.
void alpi_patcher_unblend_material(alpi_gltf_patcher *patcher, size_t material,
                                   alpi_gltf_maps replaced, alpi_edits *edits);

// --- values at vertices --------------------------------------------------------------------------

/// "COLOR_0" or "_OCCLUSION".
const char *alpi_patcher_vertex_name(const alpi_gltf_patcher *patcher);

/// A warning when values go to the colours of a file that holds those of an earlier bake there.
void alpi_patcher_warn_of_former(const alpi_gltf_patcher *patcher);

/// The value of a scene's vertex as it is stored, [0, 65535]; NaN is 0.
uint16_t alpi_patcher_vertex_value(const alpi_gltf_patcher *patcher, uint32_t vertex);

/// Values of the vertices that a primitive is written with.
typedef struct alpi_gltf_vertex_input {
    json_t *primitive;       // of the document
    const char *owner;       // for messages
    uint32_t source_count;   // its vertices
    uint32_t count;          // written vertices
    const uint32_t *sources; // [count] vertex of the document that each was, NULL = itself
    const uint16_t *values;  // [count] 65535 is 1
} alpi_gltf_vertex_input;
/// Adds the accessor: normalised 16-bit values, times the colours that the primitive has.
alp_result alpi_patcher_add_vertex_values(alpi_gltf_patcher *patcher,
                                          const alpi_gltf_vertex_input *input, size_t *accessor);

/// The JSON object of a primitive, NULL when there is none such.
json_t *alpi_gltf_primitive(const alpi_gltf_document *document, size_t mesh, size_t primitive);

// --- vertex splits -------------------------------------------------------------------------------

enum { ALPI_GLTF_SPLIT_WIDTH = 6 };

typedef struct alpi_gltf_split_input {
    uint32_t vertex_count, triangle_count;
    uint32_t (*indices)[3]; // of the primitive, in file order
    uint32_t width;         // values of a corner, at most ALPI_GLTF_SPLIT_WIDTH
    const float *values;    // [triangle_count][3][width]
    const bool *usable;     // [triangle_count] triangles without area part no vertices
} alpi_gltf_split_input;

/// Vertices such that each has one bake coordinate, or one of each set.
typedef struct alpi_gltf_split {
    bool changed; // false: the vertices are the old ones and so are the indices
    uint32_t vertex_count;
    uint32_t *sources;      // [vertex_count] old vertex of each
    float *values;          // [vertex_count][width]
    uint32_t (*indices)[3]; // [triangle_count]
} alpi_gltf_split;

alp_result alpi_gltf_split_create(alp_context *context, const alpi_gltf_split_input *input,
                                  alpi_gltf_split *split);
void alpi_gltf_split_destroy(alp_context *context, alpi_gltf_split *split);

// --- containers ----------------------------------------------------------------------------------

/// Files to be written.
typedef struct alpi_gltf_file {
    char *path;
    const uint8_t *bytes;
    size_t size;
    uint8_t *owned; // released with the list, or NULL
} alpi_gltf_file;
typedef struct alpi_gltf_files {
    alp_context *context;
    alpi_gltf_file *items;
    size_t count, capacity;
    bool silent; // what is odd is told when they are written, not when places are checked
} alpi_gltf_files;

/// Takes over path and owned, also on failure.
alp_result alpi_gltf_files_add(alpi_gltf_files *files, alpi_gltf_file file);
/// A file that the document refers to, copied with it. Nothing is added where the list has one of
/// that path, or the file is there already with these bytes. Takes over path and bytes.
alp_result alpi_gltf_files_add_copy(alpi_gltf_files *files, char *path, uint8_t *bytes,
                                    size_t size);
/// Makes the folders of all of them.
alp_result alpi_gltf_files_make_folders(const alpi_gltf_files *files);
/// Whether two folders ("" or "dir/") are the same one.
bool alpi_gltf_same_folder(const char *a, const char *b);
void alpi_gltf_files_destroy(alpi_gltf_files *files);
alp_result alpi_gltf_files_add_to(const alpi_gltf_files *files, alpi_file_set *set);

/// Names of the files beside a written .gltf, chosen so that none is one which the document uses.
typedef struct alpi_gltf_names {
    char *bin, *data; // paths: what was the BIN chunk, what the bake adds
    char **pages;     // paths of occlusion, then packed, then light
    char *bin_uri, *data_uri;
    char **page_uris; // the same as the asset refers to them
    alpi_gltf_images images;
} alpi_gltf_names;
/// Of a .gltf, or of the light beside a .glb.
alp_result alpi_gltf_names_create(alp_context *context, const alpi_gltf_document *document,
                                  const char *path, const alpi_gltf_images *images,
                                  alpi_gltf_names *names);
/// The images that a patch brings to a file of this kind.
alpi_gltf_images alpi_gltf_patch_images(const alpi_mesh_patch *patch, bool to_glb);
void alpi_gltf_names_destroy(alp_context *context, alpi_gltf_names *names);

/// Where what an earlier bake left is looked for, besides the written text.
typedef struct alpi_gltf_leftovers {
    bool first_stays; // the first buffer, whatever reads it
    alpi_bytes *bin;  // its bytes, which are cut too; NULL: they stay
    alpi_bytes *data; // new data, if it is a file that the last buffer names; or NULL
    const alpi_gltf_document *document; // as it was read
    bool *images_gone;                  // [image_count] of the document: those that go are noted
    bool *buffers_gone;                 // [buffer_count]
    size_t image_count, buffer_count;
} alpi_gltf_leftovers;
/// Whether a document bears marks of a bake.
bool alpi_gltf_was_baked(const alpi_gltf_document *document);
/// Takes what bakes left and nothing reads any more out of a written text.
alp_result alpi_gltf_tidy(alp_context *context, const alpi_gltf_leftovers *from, alpi_bytes *text);

/// Where the data of the written file lives.
typedef enum alpi_gltf_home {
    ALPI_HOME_BIN,      // the BIN chunk of a GLB, behind what is there
    ALPI_HOME_MERGED,   // .gltf → .glb: all buffers in one BIN chunk, ours last
    ALPI_HOME_FILE,     // a .gltf: a file of its own
    ALPI_HOME_DATA_URI, // a .glb whose buffer 0 is another file: a data: URI
} alpi_gltf_home;
alpi_gltf_home alpi_gltf_choose_home(const alpi_gltf_document *document, bool to_glb);

/// Sets data_buffer and data_base of a patcher.
alp_result alpi_gltf_prepare_home(alpi_gltf_patcher *patcher, alpi_gltf_home home);
/// After alpi_patcher_run: embeds external images (MERGED), edits buffers and bufferViews, and puts
/// the bytes of the BIN chunk into `bin` (empty for a .gltf).
alp_result alpi_gltf_settle_home(alpi_gltf_patcher *patcher, alpi_gltf_home home,
                                 const alpi_gltf_names *names, alpi_bytes *bin);

#endif
