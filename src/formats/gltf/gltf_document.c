// SPDX-License-Identifier: MIT
// The container of a glTF 2.0 asset: GLB chunks or bare JSON, the parsed tree, and the buffers.
#include "formats/gltf/gltf_document.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/plural.h"
#include "formats/gltf/gltf_bytes.h"
#include "formats/gltf/gltf_compression.h"
#include "formats/gltf/gltf_mend.h"
#include "formats/gltf/gltf_tree.h"
#include "formats/text/json_spans.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Buffers of one asset together; a tiny asset could name one large file a thousand times.
#define BUFFERS_LIMIT ((uint64_t)16 << 30)

/// Of one JSON text.
enum { JSON_DEPTH_LIMIT = 1000, JSON_CONTAINER_LIMIT = 1 << 24, JSON_VALUE_LIMIT = 1 << 26 };

enum {
    GLB_HEADER_SIZE = 12,
    GLB_CHUNK_HEADER_SIZE = 8,
    GLB_CHUNK_JSON = 0x4E4F534A,
    GLB_CHUNK_BIN = 0x004E4942
};

static alp_result fail_file(const alpi_gltf_document *document, const char *fault)
{
    return alpi_fail(document->context, ALP_ERROR_INVALID_DATA, "%s: %s", document->path, fault);
}

// --- GLB chunks ---------------------------------------------------------------------------------

static uint32_t read_u32(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
           (uint32_t)bytes[3] << 24;
}

/// A chunk header at `offset` of the container's `end` bytes, and the chunk inside them.
static alp_result read_chunk(const alpi_gltf_document *document, size_t offset, size_t end,
                             uint32_t *type, size_t *size)
{
    if (end - offset < GLB_CHUNK_HEADER_SIZE) {
        return alpi_fail(document->context, ALP_ERROR_INVALID_DATA,
                         "%s: the GLB ends inside a chunk header at byte %zu", document->path,
                         offset);
    }
    *size = read_u32(document->file_bytes + offset);
    *type = read_u32(document->file_bytes + offset + 4);
    if (*size > end - offset - GLB_CHUNK_HEADER_SIZE) {
        return alpi_fail(document->context, ALP_ERROR_INVALID_DATA,
                         "%s: the GLB chunk at byte %zu says %zu bytes, but only %zu follow",
                         document->path, offset, *size, end - offset - GLB_CHUNK_HEADER_SIZE);
    }
    return ALP_OK;
}

static alp_result check_glb_header(const alpi_gltf_document *document, size_t *end)
{
    if (document->file_size < GLB_HEADER_SIZE) {
        return fail_file(document, "the GLB ends inside its header");
    }
    uint32_t version = read_u32(document->file_bytes + 4);
    *end = read_u32(document->file_bytes + 8);
    if (version != 2) {
        return alpi_fail(document->context, ALP_ERROR_UNSUPPORTED,
                         "%s: GLB container version %u; only version 2 is read", document->path,
                         version);
    }
    if (*end > document->file_size || *end < GLB_HEADER_SIZE) {
        return alpi_fail(document->context, ALP_ERROR_INVALID_DATA,
                         "%s: the GLB header says %zu bytes, the file has %zu; it may be truncated",
                         document->path, *end, document->file_size);
    }
    if (*end < document->file_size) {
        alpi_warn(document->context, "trailing-bytes", document->path,
                  "bytes after the end of the GLB, which are ignored: %zu",
                  document->file_size - *end);
    }
    return ALP_OK;
}

static alp_result read_glb(alpi_gltf_document *document)
{
    document->is_glb = true;
    size_t end = 0, size = 0, offset = GLB_HEADER_SIZE;
    uint32_t type = 0;
    ALP_TRY(check_glb_header(document, &end));
    ALP_TRY(read_chunk(document, offset, end, &type, &size));
    if (type != GLB_CHUNK_JSON) {
        return fail_file(document, "the first GLB chunk is not JSON");
    }
    document->text = (const char *)document->file_bytes + offset + GLB_CHUNK_HEADER_SIZE;
    document->text_size = size;
    while (document->text_size > 0 && document->text[document->text_size - 1] == '\0') {
        document->text_size--; // some exporters pad with zeros instead of spaces
    }
    offset += GLB_CHUNK_HEADER_SIZE + size;
    for (size_t chunk = 1; offset < end; chunk++) {
        ALP_TRY(read_chunk(document, offset, end, &type, &size));
        if (chunk == 1 && type == GLB_CHUNK_BIN) {
            document->bin = document->file_bytes + offset + GLB_CHUNK_HEADER_SIZE;
            document->bin_size = size;
        } else if (document->more_chunks == NULL) {
            document->more_chunks = document->file_bytes + offset;
            document->more_chunks_size = end - offset;
        }
        offset += GLB_CHUNK_HEADER_SIZE + size;
    }
    return ALP_OK;
}

static bool starts_json(uint8_t byte)
{
    return byte != 0 && strchr(" \t\r\n{", byte) != NULL;
}

/// The encoding of a JSON text of two or four bytes a character, by its mark or its first
/// character; NULL for others.
static const char *find_wide_encoding(const uint8_t *bytes, size_t size)
{
    if (size < 8) {
        return NULL;
    }
    if (memcmp(bytes, "\xff\xfe\0\0", 4) == 0 || memcmp(bytes, "\0\0\xfe\xff", 4) == 0) {
        return "UTF-32";
    }
    if (memcmp(bytes, "\xff\xfe", 2) == 0 || memcmp(bytes, "\xfe\xff", 2) == 0) {
        return "UTF-16";
    }
    if (starts_json(bytes[0]) && bytes[1] == 0) {
        return bytes[2] != 0 ? "UTF-16LE" : "UTF-32LE";
    }
    if (bytes[0] == 0 && starts_json(bytes[1])) {
        return "UTF-16BE";
    }
    const bool big = memcmp(bytes, "\0\0\0", 3) == 0 && memcmp(bytes + 4, "\0\0\0", 3) == 0;
    return big && starts_json(bytes[3]) ? "UTF-32BE" : NULL;
}

/// Finds the JSON text: in a GLB's first chunk, or the whole file without a byte-order mark.
static alp_result read_container(alpi_gltf_document *document)
{
    const uint8_t *bytes = document->file_bytes;
    size_t size = document->file_size;
    if (size >= 4 && memcmp(bytes, "glTF", 4) == 0) {
        return read_glb(document);
    }
    const char *encoding = find_wide_encoding(bytes, size);
    if (encoding != NULL) {
        return alpi_fail(document->context, ALP_ERROR_INVALID_DATA,
                         "%s: is in %s, and glTF is UTF-8; save it as UTF-8, or run "
                         "iconv -f %s -t UTF-8",
                         document->path, encoding, encoding);
    }
    size_t first = size >= 3 && memcmp(bytes, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
    document->text = (const char *)bytes + first;
    document->text_size = size - first;
    size_t blank = 0;
    while (blank < document->text_size && strchr(" \t\r\n", document->text[blank]) != NULL &&
           document->text[blank] != '\0') {
        blank++;
    }
    if (blank == document->text_size) {
        return fail_file(document, "the file is empty");
    }
    if (document->text[blank] != '{') {
        return fail_file(document, "is not glTF: it starts with neither \"glTF\" nor \"{\"");
    }
    return ALP_OK;
}

// --- JSON ---------------------------------------------------------------------------------------

/// The tree takes up to a hundred times the bytes of the text, and its parser calls itself.
static alp_result check_json_size(const alpi_gltf_document *document)
{
    const alpi_json_size found = alpi_json_measure(document->text, document->text_size);
    if (found.depth > JSON_DEPTH_LIMIT) {
        return alpi_fail(document->context, ALP_ERROR_LIMIT,
                         "%s: JSON: %zu levels deep, the limit is %d", document->path, found.depth,
                         JSON_DEPTH_LIMIT);
    }
    if (found.containers > JSON_CONTAINER_LIMIT || found.values > JSON_VALUE_LIMIT) {
        return alpi_fail(document->context, ALP_ERROR_LIMIT,
                         "%s: JSON: %zu objects and arrays, %zu values; the limits are %d and %d: "
                         "split the asset",
                         document->path, found.containers, found.values, JSON_CONTAINER_LIMIT,
                         JSON_VALUE_LIMIT);
    }
    return ALP_OK;
}

static alp_result parse_json(alpi_gltf_document *document)
{
    ALP_TRY(check_json_size(document));
    json_error_t error;
    size_t flags = JSON_REJECT_DUPLICATES | JSON_ALLOW_NUL;
    document->root = json_loadb(document->text, document->text_size, flags, &error);
    if (document->root == NULL && json_error_code(&error) == json_error_numeric_overflow) {
        // Extras may hold integers beyond 64 bits, hashes for example; as reals they can be read.
        document->root = json_loadb(document->text, document->text_size,
                                    flags | JSON_DECODE_INT_AS_REAL, &error);
    }
    if (document->root == NULL) {
        alp_result code = json_error_code(&error) == json_error_out_of_memory
                              ? ALP_ERROR_OUT_OF_MEMORY
                              : ALP_ERROR_INVALID_DATA;
        return alpi_fail(document->context, code, "%s: JSON, line %d column %d: %s", document->path,
                         error.line, error.column, error.text);
    }
    return json_is_object(document->root) ? ALP_OK
                                          : fail_file(document, "the JSON is not an object");
}

/// Root members that we read must be arrays of objects, so that nobody has to ask again.
static alp_result check_arrays(const alpi_gltf_document *document)
{
    static const char *const kinds[] = {"accessors", "bufferViews", "buffers", "cameras",
                                        "images",    "materials",   "meshes",  "nodes",
                                        "samplers",  "scenes",      "skins",   "textures"};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        json_t *array = json_object_get(document->root, kinds[k]);
        if (array != NULL && !json_is_array(array)) {
            return alpi_gltf_fail(document, kinds[k], "must be an array");
        }
        size_t count = json_array_size(array);
        for (size_t i = 0; i < count; i++) {
            if (!json_is_object(json_array_get(array, i))) {
                return alpi_gltf_fail(document, kinds[k], "element %zu must be an object", i);
            }
        }
    }
    return ALP_OK;
}

static alp_result check_version(const alpi_gltf_document *document)
{
    json_t *asset = json_object_get(document->root, "asset");
    const char *version = alpi_gltf_text(asset, "version");
    if (version == NULL) {
        return fail_file(document, "asset.version is missing: is this a glTF file?");
    }
    const char *least = alpi_gltf_text(asset, "minVersion");
    if (strncmp(version, "2.", 2) != 0 || (least != NULL && strcmp(least, "2.0") != 0)) {
        return alpi_fail(document->context, ALP_ERROR_UNSUPPORTED,
                         "%s: glTF version %.20s; only 2.0 is read", document->path,
                         least != NULL ? least : version);
    }
    return ALP_OK;
}

/// Whether a bake is right although an asset requires `name`: what we read, and what changes
/// neither the shape nor the diffuse colour of what is first shown.
static bool extension_is_known(const char *name)
{
    static const char *const known[] = {
        "AGI_articulations",
        "AGI_stk_metadata",
        "CESIUM_primitive_outline",
        "EXT_instance_features",
        "EXT_mesh_features",
        "EXT_mesh_gpu_instancing",
        "EXT_mesh_manifold",
        "EXT_meshopt_compression",
        "EXT_structural_metadata",
        "EXT_texture_webp",
        "KHR_animation_pointer",
        "KHR_audio_emitter",
        "KHR_implicit_shapes",
        "KHR_interactivity",
        "KHR_lights_punctual",
        "KHR_materials_anisotropy",
        "KHR_materials_clearcoat",
        "KHR_materials_dispersion",
        "KHR_materials_emissive_strength",
        "KHR_materials_ior",
        "KHR_materials_iridescence",
        "KHR_materials_pbrSpecularGlossiness",
        "KHR_materials_sheen",
        "KHR_materials_specular",
        "KHR_materials_transmission",
        "KHR_materials_unlit",
        "KHR_materials_variants",
        "KHR_materials_volume",
        "KHR_mesh_quantization",
        "KHR_node_hoverability",
        "KHR_node_selectability",
        "KHR_node_visibility",
        "KHR_physics_rigid_bodies",
        "KHR_texture_transform",
        "KHR_xmp",
        "KHR_xmp_json_ld",
        "MSFT_lod",
        "VRMC_springBone",
        "VRMC_vrm",
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (strcmp(name, known[i]) == 0) {
            return true;
        }
    }
    return strcmp(name, "KHR_draco_mesh_compression") == 0 && alpi_draco_is_built();
}

/// What to do about an extension that is not read.
static const char *way_out(const char *name)
{
    static const char *const ways[][2] = {
        {"KHR_draco_mesh_compression", "build with libdraco, or export without compression"},
        {"KHR_meshopt_compression", "compress by EXT_meshopt_compression, or not at all"},
        {"KHR_texture_basisu", "convert its textures to PNG, JPEG or WebP"},
    };
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        if (strcmp(name, ways[i][0]) == 0) {
            return ways[i][1];
        }
    }
    return "export without it";
}

static alp_result check_extensions(const alpi_gltf_document *document)
{
    json_t *required = json_object_get(document->root, "extensionsRequired");
    if (required != NULL && !json_is_array(required)) {
        return alpi_gltf_fail(document, "extensionsRequired", "must be an array");
    }
    for (size_t i = 0; i < json_array_size(required); i++) {
        const char *name = json_string_value(json_array_get(required, i));
        if (name == NULL) {
            return alpi_gltf_fail(document, "extensionsRequired", "element %zu must be a string",
                                  i);
        }
        if (!extension_is_known(name)) {
            char shown[100];
            snprintf(shown, sizeof shown, "%s", name);
            alpi_gltf_clean(shown);
            return alpi_fail(document->context, ALP_ERROR_UNSUPPORTED,
                             "%s: requires the extension %s, which this build does not read; %s",
                             document->path, shown, way_out(name));
        }
    }
    return ALP_OK;
}

// --- what is not there --------------------------------------------------------------------------

/// Takes references to missing elements out of the text, and reads it again.
static alp_result mend_references(alpi_gltf_document *document)
{
    alpi_bytes text = alpi_bytes_create(document->context);
    bool mended;
    alp_result result = alpi_gltf_mend(document, &text, &mended);
    if (result != ALP_OK || !mended) {
        alpi_bytes_destroy(&text);
        return result;
    }
    document->mended_text = (char *)text.bytes;
    document->text = document->mended_text;
    document->text_size = text.size;
    json_decref(document->root);
    document->root = NULL;
    ALP_TRY(parse_json(document));
    return check_arrays(document);
}

// --- buffers ------------------------------------------------------------------------------------

/// Whether a buffer stands for what readers without a decoder need: we have one.
static bool is_fallback(json_t *buffer)
{
    return json_is_true(
        json_object_get(alpi_gltf_extension(buffer, "EXT_meshopt_compression"), "fallback"));
}

static alp_result read_buffer(alpi_gltf_document *document, size_t index)
{
    char owner[ALPI_GLTF_OWNER_SIZE];
    snprintf(owner, sizeof owner, "buffer %zu", index);
    json_t *object = alpi_gltf_item(document, "buffers", index);
    alpi_gltf_buffer *buffer = &document->buffers[index];
    size_t length;
    ALP_TRY(alpi_gltf_size(document, object, "byteLength", owner, &length));
    json_t *uri = json_object_get(object, "uri");
    if (uri != NULL && !json_is_string(uri)) {
        return alpi_gltf_fail(document, owner, "uri must be a string");
    }
    if (is_fallback(object)) {
        return ALP_OK;
    }
    if (uri != NULL) {
        ALP_TRY(alpi_gltf_uri_read(document, json_string_value(uri), owner, &buffer->owned,
                                   &buffer->size));
        buffer->bytes = buffer->owned;
    } else if (index == 0 && document->bin != NULL) {
        buffer->bytes = document->bin;
        buffer->size = document->bin_size;
    } else {
        return alpi_gltf_fail(document, owner, "has no uri%s",
                              index == 0 ? " and the file has no BIN chunk" : "");
    }
    if (buffer->size < length) {
        return alpi_gltf_fail(document, owner, "byteLength is %zu, but there are only %zu byte%s",
                              length, buffer->size, alpi_plural(buffer->size));
    }
    return ALP_OK;
}

static alp_result read_buffers(alpi_gltf_document *document)
{
    size_t count = alpi_gltf_count(document, "buffers");
    ALPI_TRY_NEW(document->context, document->buffers, count);
    document->buffer_count = count;
    uint64_t total = 0;
    for (size_t i = 0; i < count; i++) {
        ALP_TRY(read_buffer(document, i));
        total += document->buffers[i].size;
        if (total > BUFFERS_LIMIT) {
            return alpi_fail(document->context, ALP_ERROR_LIMIT,
                             "%s: buffers 0 to %zu hold %" PRIu64
                             " bytes, more than the limit of %" PRIu64,
                             document->path, i, total, BUFFERS_LIMIT);
        }
    }
    return ALP_OK;
}

// --- the document -------------------------------------------------------------------------------

static alp_result fill_document(alpi_gltf_document *document, const char *path)
{
    document->path = alpi_copy_string(document->context, path);
    document->folder = alpi_path_folder(document->context, path);
    if (document->path == NULL || document->folder == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    if (document->file_size > ALPI_GLTF_FILE_LIMIT) {
        return alpi_fail(document->context, ALP_ERROR_LIMIT,
                         "%s: %zu bytes, more than the limit of %" PRIu64, path,
                         document->file_size, ALPI_GLTF_FILE_LIMIT);
    }
    ALP_TRY(read_container(document));
    document->text_begin = (size_t)(document->text - (const char *)document->file_bytes);
    ALP_TRY(parse_json(document));
    ALP_TRY(check_version(document));
    ALP_TRY(check_extensions(document));
    ALP_TRY(check_arrays(document));
    ALPI_TRY_NEW(document->context, document->told_textures, alpi_gltf_count(document, "textures"));
    ALPI_TRY_NEW(document->context, document->told_images, alpi_gltf_count(document, "images"));
    ALP_TRY(mend_references(document));
    ALP_TRY(read_buffers(document));
    ALP_TRY(alpi_gltf_decode_views(document));
    return alpi_gltf_decode_primitives(document);
}

alp_result alpi_gltf_document_parse(alp_context *context, const char *path, uint8_t *bytes,
                                    size_t size, alpi_gltf_document **document)
{
    *document = NULL;
    alpi_gltf_document *d = ALPI_NEW(context, alpi_gltf_document, 1);
    if (d == NULL) {
        alpi_release(context, bytes);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    d->context = context;
    d->file_bytes = bytes;
    d->file_size = size;
    alp_result result = fill_document(d, path);
    if (result != ALP_OK) {
        alpi_gltf_document_destroy(d);
        return result;
    }
    *document = d;
    return ALP_OK;
}

alp_result alpi_gltf_document_read(alp_context *context, const char *path,
                                   alpi_gltf_document **document)
{
    uint8_t *bytes = NULL;
    size_t size = 0;
    *document = NULL;
    ALP_TRY(alpi_file_read(context, path, ALPI_GLTF_FILE_LIMIT, &bytes, &size));
    return alpi_gltf_document_parse(context, path, bytes, size, document);
}

void alpi_gltf_document_destroy(alpi_gltf_document *document)
{
    if (document == NULL) {
        return;
    }
    if (document->more_owners > 0) {
        document->more_owners--;
        return;
    }
    alp_context *context = document->context;
    for (size_t i = 0; i < document->buffer_count; i++) {
        alpi_release(context, document->buffers[i].owned);
    }
    for (size_t i = 0; i < document->decoded_view_count; i++) {
        alpi_release(context, document->decoded_views[i]);
    }
    for (size_t i = 0; i < document->decoded_count; i++) {
        alpi_release(context, document->decoded[i].values.bytes);
    }
    json_decref(document->root);
    alpi_release(context, document->told_textures);
    alpi_release(context, document->told_images);
    alpi_release(context, document->decoded_views);
    alpi_release(context, document->decoded);
    alpi_release(context, document->buffers);
    alpi_release(context, document->mended_text);
    alpi_release(context, document->file_bytes);
    alpi_release(context, document->choice);
    alpi_release(context, document->folder);
    alpi_release(context, document->path);
    alpi_release(context, document);
}
