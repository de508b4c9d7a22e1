// SPDX-License-Identifier: MIT
// The steps of reading a COLLADA document into a scene, and what the writer wants to know of them.
//
//   collada_mesh.c       inputs, primitives → vertices and triangles of a geometry
//   collada_sources.c    sources of numbers
//   collada_faces.c      triangles, polylists, polygons, strips and fans → triangles of corners
//   collada_nodes.c      the walk over the nodes: what is placed where
//   collada_transform.c  matrix, translate, rotate, scale, skew, lookat; axis and unit
//   collada_effects.c    effects, over collada_extras.c
//   collada_materials.c  materials, images
//   collada_lights.c     lights and cameras
//   collada_faults.c     faults that cost one element; what is odd, told once a kind
//   collada_read.c       all of them, and filling the scene
#ifndef ALPI_FORMATS_COLLADA_READ_H
#define ALPI_FORMATS_COLLADA_READ_H

#include "base/vec.h"
#include "formats/collada/collada_document.h"
#include "formats/polygon/polygon.h"
#include "scene/scene.h"

// --- geometry ------------------------------------------------------------------------------------

/// A <float_array>; sources may share it.
typedef struct alpi_collada_array {
    const xmlNode *element;
    float *values;
    double *exact; // the same in double, of a scene far from the origin; else NULL
    size_t count;
} alpi_collada_array;

/// A <source> of floats: component k of element i is values[first + i * stride + place[k]].
typedef struct alpi_collada_source {
    uint32_t array;
    const float *values; // of its array
    uint32_t count, stride, first;
    uint32_t components, place[4];
} alpi_collada_source;

/// Component k of element i, 0 where the source has none.
static inline float alpi_collada_value(const alpi_collada_source *source, uint32_t i, uint32_t k)
{
    return k < source->components
               ? source
                     ->values[(size_t)source->first + (size_t)i * source->stride + source->place[k]]
               : 0.0f;
}

/// What a corner of a primitive has an index of.
typedef enum alpi_collada_key {
    ALPI_COLLADA_POSITION,
    ALPI_COLLADA_NORMAL,
    ALPI_COLLADA_COLOR,
    ALPI_COLLADA_UV, // … and the sets after it
    ALPI_COLLADA_KEY_COUNT = ALPI_COLLADA_UV + ALPI_UV_SET_LIMIT
} alpi_collada_key;

/// The inputs of a primitive element, those of <vertices> included.
typedef struct alpi_collada_inputs {
    uint32_t stride;                         // indices that a corner has in <p>
    uint32_t source[ALPI_COLLADA_KEY_COUNT]; // index into reader.sources, ALPI_NONE = absent
    uint32_t offset[ALPI_COLLADA_KEY_COUNT]; // of its index within a corner
    uint32_t uv_numbers[ALPI_UV_SET_LIMIT];  // the file's set="" of each of our sets, rising
    uint32_t uv_count, uv_left_out;
    const xmlNode *bad;      // an <input> that was left out, NULL = none
    uint32_t most_uv_number; // largest set="" of a TEXCOORD, ALPI_NONE = there is none
} alpi_collada_inputs;

/// A polygon of a <polylist> or <polygons>; its triangles follow one another.
typedef struct alpi_collada_polygon {
    uint32_t first_corner, corner_count; // 0 corners: it has holes
    uint32_t triangle_count;
} alpi_collada_polygon;

/// Triangles of a primitive element as corners; corner c has indices[c * stride] …
typedef struct alpi_collada_faces {
    uint32_t corner_count, triangle_count;
    uint32_t *indices;
    uint32_t (*triangles)[3];
    alpi_collada_polygon *polygons; // all of them; none of other kinds
    uint32_t polygon_count;
    uint32_t untidy;  // polygons that cross themselves
    uint32_t dropped; // faces of fewer than three corners, and numbers left over
} alpi_collada_faces;

/// A primitive element of a geometry. Vertices are the different corners.
typedef struct alpi_collada_part {
    xmlNode *element;
    uint32_t primitive; // its place among those of the geometry, lines and points not counted
    const char *symbol; // its material, NULL without
    alpi_collada_inputs inputs;
    uint32_t vertex_count, triangle_count;
    uint32_t (*vertices)[ALPI_COLLADA_KEY_COUNT]; // index into each source
    uint32_t (*triangles)[3];
} alpi_collada_part;

typedef struct alpi_collada_mesh {
    xmlNode *geometry;
    bool double_sided; // by an extra of the geometry or its <mesh>
    uint32_t index;    // order in which they are met
    alpi_collada_part *parts;
    uint32_t part_count;
    uint64_t vertex_count, triangle_count; // of all parts, when the scene is filled
} alpi_collada_mesh;

// --- placing -------------------------------------------------------------------------------------

/// An <instance_geometry> or <instance_controller> where the walk met it.
typedef struct alpi_collada_placement {
    xmlNode *instance, *node;
    xmlNode *outer; // the outermost <instance_node> that led there, NULL = none
    uint32_t mesh;
    mat4 world;
} alpi_collada_placement;

/// An <instance_light> or <instance_camera>.
typedef struct alpi_collada_fixture {
    xmlNode *instance, *target;
    mat4 world;
} alpi_collada_fixture;

// --- materials -----------------------------------------------------------------------------------

/// A colour or texture of an effect.
typedef struct alpi_collada_slot {
    bool present;
    double color[4];
    uint32_t image;       // index into reader.images, ALPI_NONE = a colour
    const char *texcoord; // the name that <bind_vertex_input> binds to a set
    alpi_wrap wrap_u, wrap_v;
    float repeat[2], offset[2]; // coordinates × repeat + offset, v from the bottom
} alpi_collada_slot;

enum { ALPI_COLLADA_SLOT_COUNT = 5 }; // diffuse, emission, transparent, ambient, normal

typedef enum alpi_collada_opaque {
    ALPI_OPAQUE_A_ONE,
    ALPI_OPAQUE_A_ZERO,
    ALPI_OPAQUE_RGB_ONE,
    ALPI_OPAQUE_RGB_ZERO
} alpi_collada_opaque;

typedef struct alpi_collada_effect {
    alpi_collada_slot diffuse, emission, transparent, ambient, normal;
    alpi_collada_opaque opaque;
    bool opaque_given;
    double transparency;
    bool double_sided;
    float specular[3], shininess; // below 0 where it is not stated
    bool has_heights;             // a <bump> of heights, which is not read
    bool has_gloss_map;           // a texture of specular colour or shininess
    bool has_mirror;              // reflects an environment
    bool baked;                   // its ambient texture is an occlusion map of ours
} alpi_collada_effect;

/// A material of the scene: a <material> with the coordinate sets that an instance binds.
typedef struct alpi_collada_material {
    xmlNode *element; // NULL: stands for none
    uint32_t sets[ALPI_COLLADA_SLOT_COUNT];
    bool double_sided;
    uint32_t next; // another one of the same element, ALPI_NONE = last
} alpi_collada_material;

typedef struct alpi_collada_image {
    xmlNode *element;
    bool wanted;
} alpi_collada_image;

// --- faults --------------------------------------------------------------------------------------

enum {
    ALPI_COLLADA_MISSING_LIMIT = 16, // things that are missing, and
    ALPI_COLLADA_TOLD_LIMIT = 16,    // elements that are left out, which are told one by one
    ALPI_COLLADA_REASON_SIZE = 700
};

/// Something that elements refer to and that is not in the document.
typedef struct alpi_collada_missing {
    const xmlNode *node; // the first that refers to it
    const char *name;    // of the element that should be there
    const char *url;     // belongs to the tree
    uint32_t count;      // references
} alpi_collada_missing;

// --- the reader ----------------------------------------------------------------------------------

typedef struct alpi_collada_reader {
    alp_context *context;
    alpi_collada_document *document;
    alp_scene *scene; // being filled
    uint32_t *slots;  // [elements] 1 + the index of what was made of an element, 0 = nothing yet
    alpi_polygon_scratch polygons;

    alpi_collada_array *arrays;
    alpi_collada_source *sources;
    alpi_collada_mesh *meshes;
    alpi_collada_placement *placements;
    alpi_collada_fixture *fixtures;
    alpi_collada_effect *effects;
    alpi_collada_material *materials; // [scene.material_count]
    alpi_collada_image *images;       // [scene.image_count]
    uint32_t array_count, source_count, mesh_count, placement_count, fixture_count, effect_count;
    uint32_t material_count, image_count;
    size_t array_capacity, source_capacity, mesh_capacity, placement_capacity, fixture_capacity,
        effect_capacity;
    size_t material_capacity, scene_material_capacity, image_capacity;

    mat4 root; // file → metres, +Y up
    double metres_per_unit;
    // for one note a file each
    uint32_t skinned, morphed, not_triangles, not_meshes, without_material, odd_alpha, outside,
        lost_sets;
    const xmlNode *lost_set; // the first <bind_vertex_input> of a set that is not there
    alpi_collada_missing missing[ALPI_COLLADA_MISSING_LIMIT];
    uint32_t missing_count, missing_more; // references past the limit
    uint32_t empty;                       // geometries without a triangle
    const xmlNode *first_empty;
    uint32_t bad_parts, bad_fixtures; // that cannot be read
} alpi_collada_reader;

/// Resolves a reference. A broken one gives NULL in *target, and one warning at the end of reading.
alp_result alpi_collada_refer(alpi_collada_reader *reader, const xmlNode *node,
                              const char *attribute, const char *name, xmlNode **target);
/// Tells what was met while the file was read: a warning or note for each kind.
void alpi_collada_tell_oddities(const alpi_collada_reader *reader);
/// The message of the last fault without the document's path, for warnings that have it.
const char *alpi_collada_reason(const alpi_collada_document *document);
/// Whether a result is INVALID_DATA, which then becomes ALP_OK. The caller leaves the element out
/// and warns with the reason.
bool alpi_collada_survives(const alpi_collada_document *document, alp_result *result,
                           char reason[ALPI_COLLADA_REASON_SIZE]);

/// The mesh of a <geometry>, read at its first use. ALPI_NONE: it is no mesh.
alp_result alpi_collada_read_mesh(alpi_collada_reader *reader, xmlNode *geometry, uint32_t *mesh);
/// A <source>, read at its first use: its place in the reader's list.
alp_result alpi_collada_read_source(alpi_collada_reader *reader, xmlNode *element,
                                    uint32_t *source);
/// The numbers of a source's array in double, read at their first use and owned by the reader.
alp_result alpi_collada_exact_values(alpi_collada_reader *reader, const alpi_collada_source *source,
                                     const double **values);
/// The inputs of a primitive element, with their sources.
alp_result alpi_collada_read_inputs(alpi_collada_reader *reader, xmlNode *element,
                                    alpi_collada_inputs *inputs);
/// Whether an element is a primitive of triangles or polygons.
bool alpi_collada_is_primitive(const xmlNode *element);
/// Its faces; every index is within its source. Normals and colours whose indices are not are taken
/// out of the inputs. Destroyed by the caller.
alp_result alpi_collada_read_faces(alpi_collada_reader *reader, xmlNode *element,
                                   alpi_collada_inputs *inputs, alpi_collada_faces *faces);
void alpi_collada_faces_destroy(alp_context *context, alpi_collada_faces *faces);

/// Fills placements and fixtures.
alp_result alpi_collada_read_nodes(alpi_collada_reader *reader);
/// root and metres_per_unit of <asset>.
alp_result alpi_collada_read_asset(alpi_collada_reader *reader);
/// One transform element of a node; *known is false for other elements.
alp_result alpi_collada_read_transform(const alpi_collada_document *document,
                                       const xmlNode *element, mat4 *matrix, bool *known);

/// The scene material of a part at a placement, ALPI_NONE = none is bound.
alp_result alpi_collada_read_material(alpi_collada_reader *reader,
                                      const alpi_collada_placement *placement,
                                      const alpi_collada_part *part, uint32_t *material);
/// An effect, read at its first use.
alp_result alpi_collada_read_effect(alpi_collada_reader *reader, const xmlNode *element,
                                    const alpi_collada_effect **effect);
/// An element of that name in a technique of an <extra> of an element; NULL without.
const xmlNode *alpi_collada_find_extra(const xmlNode *element, const char *name);
/// Whether an <extra> of the element says double_sided.
bool alpi_collada_is_double_sided(const xmlNode *element);
/// How an <extra> of a <texture> repeats, moves and wraps it.
void alpi_collada_read_placing(const xmlNode *texture, alpi_collada_slot *slot);
/// The technique element of an effect that holds its shader, and the shader; NULL without.
xmlNode *alpi_collada_shader(const xmlNode *effect);
/// Decodes the images that materials use; not those that are normal maps alone.
alp_result alpi_collada_read_images(alpi_collada_reader *reader);
/// scene.lights and scene.cameras; after the geometry, by whose size attenuation is judged.
alp_result alpi_collada_read_fixtures(alpi_collada_reader *reader);

/// What the writer needs: kept with the scene (ALPI_ATTACHMENT_COLLADA).
typedef struct alpi_collada_surface {
    xmlNode *primitive, *geometry, *instance;
    uint32_t placement;
} alpi_collada_surface;
/// Counts of contents that are read but have no place in another format.
typedef struct alpi_collada_losses {
    uint32_t heights, gloss_maps, mirrors, animations;
} alpi_collada_losses;
typedef struct alpi_collada_origin {
    alpi_collada_document *document;
    alpi_collada_surface *surfaces;     // [surface_count]
    xmlNode **materials;                // [material_count]
    xmlNode **images;                   // [image_count] of the scene
    alpi_collada_placement *placements; // [placement_count]
    uint32_t placement_count;
    alpi_collada_losses losses;
} alpi_collada_origin;

/// The scene takes the document over (also on failure).
alp_result alpi_collada_scene_from_document(alpi_collada_document *document, alp_scene **scene);
/// A reader of its own for a document; destroyed with alpi_collada_reader_destroy.
alp_result alpi_collada_reader_create(alpi_collada_document *document, alpi_collada_reader *reader);
void alpi_collada_reader_destroy(alpi_collada_reader *reader);

#endif
