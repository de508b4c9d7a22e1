// SPDX-License-Identifier: MIT
// A glTF 2.0 asset as bytes: the JSON text exactly as read, its parsed tree, and its buffers.
// The reader makes a scene from it; the writer splices spans into the text, so it must stay whole.
#ifndef ALPI_FORMATS_GLTF_DOCUMENT_H
#define ALPI_FORMATS_GLTF_DOCUMENT_H

#include "base/context.h"

#include <jansson.h>

typedef struct alpi_gltf_buffer {
    const uint8_t *bytes; // NULL: a fallback for readers that do not decompress, never read
    size_t size;          // ≥ the buffer's byteLength; 0 of a fallback
    uint8_t *owned;       // released with the document, or NULL (inside file_bytes)
} alpi_gltf_buffer;

typedef struct alpi_gltf_document {
    alp_context *context;
    char *path;   // as given, for messages
    char *folder; // "dir/" of the file, "" for the working folder
    bool is_glb;
    uint8_t *file_bytes; // the whole file
    size_t file_size;
    const char *text;   // the JSON inside file_bytes: not terminated; a byte-order mark is outside
    char *mended_text;  // the same without references to what is not there, or NULL: then `text`
    size_t text_begin;  // of the JSON in the file
    size_t text_size;   // a GLB's chunk padding (spaces) included
    const uint8_t *bin; // a GLB's BIN chunk, or NULL
    size_t bin_size;    // chunk length, padding included
    const uint8_t *more_chunks; // a GLB's chunks after BIN, headers included, or NULL
    size_t more_chunks_size;
    json_t *root;         // an object
    char *choice;         // of its scenes, by number or name; NULL = the default one
    uint32_t more_owners; // scenes that share it, beside the first
    alpi_gltf_buffer *buffers;
    size_t buffer_count;
    uint8_t **decoded_views;           // [bufferViews] what compressed ones hold, NULL = plain
    struct alpi_gltf_decoded *decoded; // [accessors] of compressed primitives; NULL = none
    size_t decoded_view_count, decoded_count; // as many as there are, once anything is decoded
    uint64_t decoded_size;                    // bytes of all of them
    // A warning was given of these textures and images: one is enough.
    bool *told_textures, *told_images;
} alpi_gltf_document;

/// Reads and checks the container and the JSON, then every buffer. Sizes are checked before memory
/// is asked for. External files must lie below the asset's folder ("..", absolute paths and schemes
/// other than data: are refused).
alp_result alpi_gltf_document_read(alp_context *context, const char *path,
                                   alpi_gltf_document **document);
/// The same from bytes in memory, which the document takes over (also on failure).
alp_result alpi_gltf_document_parse(alp_context *context, const char *path, uint8_t *bytes,
                                    size_t size, alpi_gltf_document **document);
/// For one of its owners. NULL does nothing.
void alpi_gltf_document_destroy(alpi_gltf_document *document);

/// extras.alpenglow of a material that a bake gave to a primitive without one.
#define ALPI_GLTF_NO_MATERIAL "no material"
/// The same of what else a bake adds, by which a later one knows what it may take away: elements
/// of maps, coordinates, values at vertices, vertices that were split, materials of further pages
/// ("copy of 3"). Without a mark nothing ever goes.
#define ALPI_GLTF_MAP "map"
#define ALPI_GLTF_SET "set"
#define ALPI_GLTF_VALUES "values"
#define ALPI_GLTF_COPY "copy"
#define ALPI_GLTF_MAP_EXTRAS "\"extras\":{\"alpenglow\":\"" ALPI_GLTF_MAP "\"}"
/// extras.alpenglow of an element, NULL where it is no word.
const char *alpi_gltf_mark(const alpi_gltf_document *document, const char *kind, size_t index);
/// In the extras of a material: the three sets that its maps are read with.
#define ALPI_GLTF_BLEND "alpenglow_blend"
#define ALPI_GLTF_EARLIER "earlier" // in it: sets and maps of bakes before

// --- typed access to the tree; all check, none trusts -------------------------------------------

/// Object `index` of the root array `kind` ("nodes", "meshes" …), or NULL when there is none such.
json_t *alpi_gltf_item(const alpi_gltf_document *document, const char *kind, size_t index);
size_t alpi_gltf_count(const alpi_gltf_document *document, const char *kind);

/// Reads an index member: ALPI_GLTF_NONE when absent. INVALID_DATA when present and not an integer
/// in [0, count of `kind`). `owner` names the object for the message, such as "mesh 3".
#define ALPI_GLTF_NONE SIZE_MAX
alp_result alpi_gltf_index(const alpi_gltf_document *document, json_t *object, const char *member,
                           const char *kind, const char *owner, size_t *index);

// --- accessors ----------------------------------------------------------------------------------

/// An accessor with its sparse values put in and its strides taken out: count × components values,
/// tightly packed in the file's component type, little-endian as stored.
typedef struct alpi_gltf_values {
    uint32_t count;
    uint32_t components;     // 1 (SCALAR) to 4 (VEC4); matrices are refused
    uint32_t component_type; // 5120 … 5126
    uint32_t component_size; // bytes
    bool normalized;
    uint8_t *bytes; // released by the caller (alpi_release)
} alpi_gltf_values;

/// An accessor whose values came out of a compressed primitive.
typedef struct alpi_gltf_decoded {
    alpi_gltf_values values; // bytes NULL: it did not
    size_t view;             // where they were
    size_t attribute;        // Draco's number of it, ALPI_GLTF_NONE = indices
} alpi_gltf_decoded;

/// @return ALP_OK; INVALID_DATA (index, view, buffer, offsets, counts: named); OUT_OF_MEMORY
alp_result alpi_gltf_accessor_read(const alpi_gltf_document *document, size_t accessor,
                                   alpi_gltf_values *values);
/// Component k of element i as float: normalised integers → [0,1] or [−1,1] as glTF says.
float alpi_gltf_values_float(const alpi_gltf_values *values, uint32_t element, uint32_t component);
/// Component 0 of element i as index.
uint32_t alpi_gltf_values_index(const alpi_gltf_values *values, uint32_t element);

/// The triangles of a primitive in file order, as indices into its vertices: TRIANGLES, strips and
/// fans (every second strip triangle is turned so that the winding holds), indexed or not.
/// *indices is NULL and *triangle_count 0 for points and lines. Every index is < vertex_count.
/// Leftover indices (a count that is no multiple of 3) are ignored and counted in *leftover.
alp_result alpi_gltf_primitive_triangles(const alpi_gltf_document *document, json_t *primitive,
                                         const char *owner, uint32_t vertex_count,
                                         uint32_t (**indices)[3], uint32_t *triangle_count,
                                         uint32_t *leftover);

#endif
