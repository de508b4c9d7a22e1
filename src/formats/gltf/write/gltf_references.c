// SPDX-License-Identifier: MIT
// Walks over all of a glTF document by a table: what a member of each kind of object is, and which
// of its numbers name elements (glTF 2.0, section 5, and the extensions that are named below).
#include "formats/gltf/write/gltf_references.h"

#include "base/memory.h"

#include <jansson.h>
#include <string.h>

/// What a value is. In an array of one kind all elements are that.
typedef enum state {
    PLAIN, // names nothing
    OPEN,  // may name anything
    ROOT,
    EXTENSIONS,
    EXTRAS,
    ACCESSOR,
    VIEW,
    IMAGE, // whatever else has a bufferView
    TEXTURE,
    MATERIAL, // and extensions of materials: textureInfos wherever they are
    MESH,
    PRIMITIVE,
    ATTRIBUTES, // every member names an accessor
    SKIN,
    ANIMATION,
    SAMPLER_OF_ANIMATION,
    INSTANCING,
    VARIANTS,
    FEATURES,        // EXT_mesh_features
    TEXTURE_INFO,    // of an extension whose other members name nothing
    METADATA,        // EXT_structural_metadata
    TABLE,           // one of its propertyTables
    TABLE_COLUMNS,   // every member is a column
    COLUMN,          // names views
    PICTURE,         // one of its propertyTextures
    PICTURE_COLUMNS, // every member is a textureInfo
    POINTING,        // KHR_animation_pointer
    POINTER,         // a string that names an element
    NAME,            // NAME + kind: a number that names an element
    NAME_END = (int)NAME + (int)ALPI_GLTF_KIND_COUNT
} state;

static const struct step {
    const char *key;
    state from, to;
} steps[] = {
    {"accessors", ROOT, ACCESSOR},
    {"bufferViews", ROOT, VIEW},
    {"images", ROOT, IMAGE},
    {"textures", ROOT, TEXTURE},
    {"materials", ROOT, MATERIAL},
    {"meshes", ROOT, MESH},
    {"skins", ROOT, SKIN},
    {"animations", ROOT, ANIMATION},
    {"nodes", ROOT, PLAIN},
    {"scenes", ROOT, PLAIN},
    {"scene", ROOT, PLAIN},
    {"asset", ROOT, PLAIN},
    {"buffers", ROOT, PLAIN},
    {"samplers", ROOT, PLAIN},
    {"cameras", ROOT, PLAIN},
    {"extensionsUsed", ROOT, PLAIN},
    {"extensionsRequired", ROOT, PLAIN},
    {"bufferView", ACCESSOR, NAME + (int)ALPI_GLTF_BUFFER_VIEWS},
    {"sparse", ACCESSOR, ACCESSOR},
    {"indices", ACCESSOR, ACCESSOR},
    {"values", ACCESSOR, ACCESSOR},
    {"buffer", VIEW, NAME + (int)ALPI_GLTF_BUFFERS},
    {"bufferView", IMAGE, NAME + (int)ALPI_GLTF_BUFFER_VIEWS},
    {"sampler", TEXTURE, NAME + (int)ALPI_GLTF_SAMPLERS},
    {"source", TEXTURE, NAME + (int)ALPI_GLTF_IMAGES},
    {"index", MATERIAL, NAME + (int)ALPI_GLTF_TEXTURES},
    {"primitives", MESH, PRIMITIVE},
    {"attributes", PRIMITIVE, ATTRIBUTES},
    {"targets", PRIMITIVE, ATTRIBUTES},
    {"indices", PRIMITIVE, NAME + (int)ALPI_GLTF_ACCESSORS},
    {"material", PRIMITIVE, NAME + (int)ALPI_GLTF_MATERIALS},
    {"inverseBindMatrices", SKIN, NAME + (int)ALPI_GLTF_ACCESSORS},
    {"samplers", ANIMATION, SAMPLER_OF_ANIMATION},
    {"input", SAMPLER_OF_ANIMATION, NAME + (int)ALPI_GLTF_ACCESSORS},
    {"output", SAMPLER_OF_ANIMATION, NAME + (int)ALPI_GLTF_ACCESSORS},
    {"KHR_draco_mesh_compression", EXTENSIONS, IMAGE},
    {"EXT_mesh_gpu_instancing", EXTENSIONS, INSTANCING},
    {"attributes", INSTANCING, ATTRIBUTES},
    {"EXT_meshopt_compression", EXTENSIONS, VIEW},
    {"KHR_meshopt_compression", EXTENSIONS, VIEW},
    {"EXT_texture_webp", EXTENSIONS, TEXTURE},
    {"EXT_texture_avif", EXTENSIONS, TEXTURE},
    {"KHR_texture_basisu", EXTENSIONS, TEXTURE},
    {"MSFT_texture_dds", EXTENSIONS, TEXTURE},
    {"KHR_materials_variants", EXTENSIONS, VARIANTS},
    {"mappings", VARIANTS, VARIANTS},
    {"material", VARIANTS, NAME + (int)ALPI_GLTF_MATERIALS},
    {"MOZ_lightmap", EXTENSIONS, MATERIAL},
    {"KHR_lights_punctual", EXTENSIONS, PLAIN},
    {"KHR_texture_transform", EXTENSIONS, PLAIN},
    {"KHR_mesh_quantization", EXTENSIONS, PLAIN},
    {"KHR_node_visibility", EXTENSIONS, PLAIN},
    {"KHR_xmp", EXTENSIONS, PLAIN},
    {"KHR_xmp_json_ld", EXTENSIONS, PLAIN},
    {"EXT_instance_features", EXTENSIONS, PLAIN},
    {"EXT_mesh_features", EXTENSIONS, FEATURES},
    {"featureIds", FEATURES, FEATURES},
    {"texture", FEATURES, TEXTURE_INFO},
    {"index", TEXTURE_INFO, NAME + (int)ALPI_GLTF_TEXTURES},
    {"EXT_structural_metadata", EXTENSIONS, METADATA},
    {"propertyTables", METADATA, TABLE},
    {"properties", TABLE, TABLE_COLUMNS},
    {"values", COLUMN, NAME + (int)ALPI_GLTF_BUFFER_VIEWS},
    {"arrayOffsets", COLUMN, NAME + (int)ALPI_GLTF_BUFFER_VIEWS},
    {"stringOffsets", COLUMN, NAME + (int)ALPI_GLTF_BUFFER_VIEWS},
    {"propertyTextures", METADATA, PICTURE},
    {"properties", PICTURE, PICTURE_COLUMNS},
    {"KHR_animation_pointer", EXTENSIONS, POINTING},
    {"pointer", POINTING, POINTER},
    {"alpenglow", EXTRAS, PLAIN}, // ours name nothing by numbers that matter
    {ALPI_GLTF_BLEND, EXTRAS, PLAIN},
    {"lightmap", EXTRAS, PLAIN},
};

static const struct {
    state list;
    alpi_gltf_kind kind;
} owners[] = {{ACCESSOR, ALPI_GLTF_ACCESSORS},
              {VIEW, ALPI_GLTF_BUFFER_VIEWS},
              {IMAGE, ALPI_GLTF_IMAGES},
              {TEXTURE, ALPI_GLTF_TEXTURES},
              {MATERIAL, ALPI_GLTF_MATERIALS}};

static bool begins_with(const char *text, alpi_json_span key, const char *word)
{
    const size_t length = strlen(word);
    return key.end - key.begin > length + 2 && memcmp(text + key.begin + 1, word, length) == 0;
}

/// What the member of an object is; `from` is what an element of an array is.
static state find_state(const char *text, state from, const alpi_json_cursor *at)
{
    if (!at->is_object || from == OPEN) {
        return from;
    }
    const bool any_name = from == ATTRIBUTES || from == EXTENSIONS || from == EXTRAS ||
                          from == TABLE_COLUMNS || from == PICTURE_COLUMNS;
    if (!any_name) {
        if (alpi_json_key_is(text, at->key, "extras")) {
            return EXTRAS;
        }
        if (alpi_json_key_is(text, at->key, "extensions")) {
            return EXTENSIONS;
        }
    }
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        if (steps[i].from == from && alpi_json_key_is(text, at->key, steps[i].key)) {
            return steps[i].to;
        }
    }
    switch (from) {
    case MATERIAL:
        return MATERIAL;
    case ATTRIBUTES:
        return (state)(NAME + (int)ALPI_GLTF_ACCESSORS);
    case TABLE_COLUMNS:
        return COLUMN;
    case PICTURE_COLUMNS:
        return TEXTURE_INFO;
    case EXTENSIONS:
        return begins_with(text, at->key, "KHR_materials_") ? MATERIAL : OPEN;
    case ROOT:
    case EXTRAS:
        return OPEN;
    default:
        return PLAIN;
    }
}

/// A container that is being walked over.
typedef struct frame {
    alpi_json_cursor cursor;
    state is;
    alpi_gltf_kind owner_kind;
    size_t owner;
} frame;

typedef struct walk {
    const char *text;
    alpi_gltf_references *found;
    frame *frames;
    size_t count, capacity;
} walk;

/// A number as the parser reads it; false where it is none that counts elements.
static bool read_number(const char *text, alpi_json_span span, size_t *index)
{
    json_t *number = json_loadb(text + span.begin, span.end - span.begin, JSON_DECODE_ANY, NULL);
    const double value = json_number_value(number);
    const bool fits = json_is_number(number) && value >= 0.0 && value < 4294967296.0;
    json_decref(number);
    *index = fits ? (size_t)value : 0;
    return fits && (double)*index == value;
}

static alp_result note_name(walk *w, const frame *at, alpi_gltf_kind kind, alpi_json_span span)
{
    alpi_gltf_references *found = w->found;
    alpi_gltf_reference item = {
        .kind = kind, .span = span, .owner_kind = at->owner_kind, .owner = at->owner};
    if (!read_number(w->text, span, &item.index)) {
        return ALP_OK;
    }
    void *items = found->items;
    ALP_TRY(alpi_grow(found->context, &items, &found->capacity, found->count + 1, sizeof item));
    found->items = items;
    found->items[found->count++] = item;
    return ALP_OK;
}

// --- JSON pointers -------------------------------------------------------------------------------

static const char *const roots[ALPI_GLTF_KIND_COUNT] = {[ALPI_GLTF_ACCESSORS] = "accessors",
                                                        [ALPI_GLTF_BUFFERS] = "buffers",
                                                        [ALPI_GLTF_BUFFER_VIEWS] = "bufferViews",
                                                        [ALPI_GLTF_IMAGES] = "images",
                                                        [ALPI_GLTF_MATERIALS] = "materials",
                                                        [ALPI_GLTF_MESHES] = "meshes",
                                                        [ALPI_GLTF_NODES] = "nodes",
                                                        [ALPI_GLTF_SAMPLERS] = "samplers",
                                                        [ALPI_GLTF_TEXTURES] = "textures"};

/// Whether a string ("/materials/3/…") begins with the name of a root array and a number.
/// @param number its digits
static bool find_pointed(const char *text, alpi_json_span string, alpi_gltf_kind *kind,
                         alpi_json_span *number)
{
    const char *begin = text + string.begin + 1, *end = text + string.end - 1;
    for (int k = 0; k < ALPI_GLTF_KIND_COUNT; k++) {
        const size_t length = strlen(roots[k]);
        if ((size_t)(end - begin) <= length + 2 || begin[0] != '/' ||
            memcmp(begin + 1, roots[k], length) != 0 || begin[length + 1] != '/') {
            continue;
        }
        const char *digits = begin + length + 2, *after = digits;
        while (after < end && *after >= '0' && *after <= '9') {
            after++;
        }
        *kind = (alpi_gltf_kind)k;
        *number = (alpi_json_span){(size_t)(digits - text), (size_t)(after - text)};
        return after > digits && (after == end || *after == '/');
    }
    return false;
}

/// A string that is a pointer, or may be one. One with escapes is not taken apart.
static bool may_point(const char *text, alpi_json_span string)
{
    alpi_gltf_kind kind;
    alpi_json_span number;
    return find_pointed(text, string, &kind, &number) ||
           (string.end - string.begin > 2 &&
            memchr(text + string.begin, '\\', string.end - string.begin) != NULL &&
            (text[string.begin + 1] == '/' || text[string.begin + 1] == '\\'));
}

/// A pointer of KHR_animation_pointer.
static alp_result note_pointer(walk *w, const frame *at, alpi_json_span string)
{
    alpi_gltf_kind kind;
    alpi_json_span number;
    if (w->text[string.begin] != '"') {
        return ALP_OK;
    }
    if (find_pointed(w->text, string, &kind, &number)) {
        return note_name(w, at, kind, number);
    }
    w->found->has_pointers |= may_point(w->text, string);
    return ALP_OK;
}

/// Something unknown: its numbers may name anything.
static alp_result note_open(walk *w, const alpi_json_cursor *at)
{
    alpi_gltf_references *found = w->found;
    const char *value = w->text + at->value.begin;
    size_t index;
    if (value[0] == '"') {
        alpi_gltf_kind kind;
        alpi_json_span number;
        found->has_pointers |= may_point(w->text, at->value);
        found->points_at_materials |=
            find_pointed(w->text, at->value, &kind, &number) && kind == ALPI_GLTF_MATERIALS;
        return ALP_OK;
    }
    if (at->is_object && alpi_json_key_is(w->text, at->key, "texCoord")) {
        return ALP_OK; // a set, whoever reads it
    }
    if (strchr("0123456789", value[0]) == NULL || !read_number(w->text, at->value, &index)) {
        return ALP_OK;
    }
    found->buffers_are_named |= at->is_object && alpi_json_key_is(w->text, at->key, "buffer");
    void *items = found->pins;
    ALP_TRY(alpi_grow(found->context, &items, &found->pin_capacity, found->pin_count + 1,
                      sizeof *found->pins));
    found->pins = items;
    found->pins[found->pin_count++] = index;
    return ALP_OK;
}

static alp_result enter(walk *w, alpi_json_span value, state is, const frame *parent)
{
    void *items = w->frames;
    frame inner = {.cursor = alpi_json_open(w->text, value),
                   .is = is,
                   .owner_kind = parent != NULL ? parent->owner_kind : ALPI_GLTF_KIND_COUNT,
                   .owner = parent != NULL ? parent->owner : 0};
    ALP_TRY(alpi_grow(w->found->context, &items, &w->capacity, w->count + 1, sizeof *w->frames));
    w->frames = items;
    w->frames[w->count++] = inner;
    return ALP_OK;
}

/// Which element of a root array everything below belongs to.
static void find_owner(const walk *w, frame *parent)
{
    if (w->count != 2 || parent->cursor.is_object) {
        return; // not in an array of the root
    }
    for (size_t i = 0; i < sizeof owners / sizeof *owners; i++) {
        if (owners[i].list == parent->is) {
            parent->owner_kind = owners[i].kind;
            parent->owner = parent->cursor.index;
        }
    }
}

static alp_result visit(walk *w)
{
    frame *at = &w->frames[w->count - 1];
    find_owner(w, at);
    const frame parent = *at;
    const alpi_json_cursor *cursor = &parent.cursor;
    const state is = find_state(w->text, parent.is, cursor);
    const char first = w->text[cursor->value.begin];
    if (first == '{' || first == '[') {
        const bool is_name = (int)is >= (int)NAME; // morph targets are a list of attributes
        return enter(w, cursor->value, is_name ? PLAIN : is, &parent);
    }
    if ((int)is >= (int)NAME) {
        return note_name(w, &parent, (alpi_gltf_kind)((int)is - (int)NAME), cursor->value);
    }
    return is == POINTER ? note_pointer(w, &parent, cursor->value)
           : is == OPEN  ? note_open(w, cursor)
                         : ALP_OK;
}

alp_result alpi_gltf_references_find(const char *text, alpi_json_span root,
                                     alpi_gltf_references *found)
{
    walk w = {.text = text, .found = found};
    alp_result result = enter(&w, root, ROOT, NULL);
    while (result == ALP_OK && w.count > 0) {
        if (alpi_json_next(&w.frames[w.count - 1].cursor)) {
            result = visit(&w);
        } else {
            w.count--;
        }
    }
    alpi_release(found->context, w.frames);
    return result;
}

void alpi_gltf_references_destroy(alpi_gltf_references *references)
{
    alpi_release(references->context, references->items);
    alpi_release(references->context, references->pins);
    *references = (alpi_gltf_references){.context = references->context};
}
