// SPDX-License-Identifier: MIT
// References to elements that are not there. Each is taken out of the text with a warning, before
// anything is read: so what reads and what writes need not ask again, and elements that a writer
// appends cannot come to stand under such a number. References to accessors, views and buffers are
// faults of the data, and stay for their readers to refuse.
#include "formats/gltf/gltf_mend.h"

#include "base/memory.h"
#include "formats/gltf/gltf_tree.h"
#include "formats/text/text_edits.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char lights_extension[] = "KHR_lights_punctual";

/// A walk over the document, once to count what is missing, once to take it out.
typedef struct mending {
    const alpi_gltf_document *document;
    alpi_json_span root;
    alpi_edits *edits; // NULL: count only, and warn
    size_t index;      // of the element
    size_t missing;
    bool failed; // out of memory
} mending;

/// An object in the tree and in the text.
typedef struct place {
    json_t *object;
    alpi_json_span span; // empty without edits
    const char *owner;   // for messages
} place;

// --- a number ------------------------------------------------------------------------------------

static size_t count_elements(const mending *m, const char *kind)
{
    if (strcmp(kind, "lights") == 0) {
        return json_array_size(
            json_object_get(alpi_gltf_extension(m->document->root, lights_extension), "lights"));
    }
    return alpi_gltf_count(m->document, kind);
}

/// Whether a value is a number that names no element. Values of other types are left to readers.
static bool is_missing(const mending *m, json_t *value, const char *kind)
{
    const double number = json_number_value(value);
    return json_is_number(value) &&
           !(number >= 0.0 && number < (double)count_elements(m, kind) && number == floor(number));
}

static void tell(const mending *m, const place *at, const char *member, json_t *value,
                 const char *kind)
{
    if (m->edits == NULL) {
        char elements[ALPI_GLTF_OWNER_SIZE];
        alpi_warn(m->document->context, "missing", at->owner,
                  "%s is %.17g, but %s: it is read without", member, json_number_value(value),
                  alpi_gltf_state_count(count_elements(m, kind), kind, elements));
    }
}

/// The place of a member; false where it is not there.
static bool enter(const mending *m, const place *at, const char *member, place *inner)
{
    *inner = (place){json_object_get(at->object, member), {0, 0}, at->owner};
    return inner->object != NULL &&
           (m->edits == NULL || alpi_json_find(m->document->text, at->span, member, &inner->span));
}

// --- members -------------------------------------------------------------------------------------

/// Members of one object that go, taken out together.
typedef struct leaving {
    const char **names;
    size_t count, capacity;
} leaving;

static void leave(mending *m, leaving *l, const char *name)
{
    void *names = (void *)l->names;
    m->missing++;
    m->failed |= alpi_grow(m->document->context, &names, &l->capacity, l->count + 1,
                           sizeof *l->names) != ALP_OK;
    l->names = names;
    if (!m->failed) {
        l->names[l->count++] = name;
    }
}

static void take_out(mending *m, const place *at, leaving *l)
{
    if (m->edits != NULL && l->count > 0) {
        alpi_edits_remove_all(m->edits, at->span, l->names, l->count);
    }
    alpi_release(m->document->context, (void *)l->names);
    *l = (leaving){0};
}

static void mend_member(mending *m, const place *at, const char *member, const char *kind,
                        leaving *l)
{
    json_t *value = json_object_get(at->object, member);
    if (is_missing(m, value, kind)) {
        tell(m, at, member, value, kind);
        leave(m, l, member);
    }
}

/// A list, and which of its elements name something: themselves, or by a member.
typedef struct list_rule {
    const char *name, *member, *kind;
} list_rule;

/// Puts a text together again of the elements that stay. @return how many do
static size_t filter_list(mending *m, const place *list, const list_rule *rule, alpi_bytes *text)
{
    alpi_json_cursor cursor = alpi_json_open(m->document->text, list->span);
    size_t kept = 0;
    for (size_t i = 0; i < json_array_size(list->object); i++) {
        json_t *element = json_array_get(list->object, i);
        json_t *value = rule->member != NULL ? json_object_get(element, rule->member) : element;
        const bool found = m->edits != NULL && alpi_json_next(&cursor);
        if (is_missing(m, value, rule->kind)) {
            char name[64];
            snprintf(name, sizeof name, "one of its %s", rule->name);
            tell(m, list, name, value, rule->kind);
            continue;
        }
        alpi_bytes_print(text, "%s", kept++ > 0 ? "," : "");
        if (found) {
            alpi_bytes_add(text, m->document->text + cursor.value.begin,
                           cursor.value.end - cursor.value.begin);
        }
    }
    return kept;
}

/// A list keeps the elements whose numbers name something; one that none is left of goes.
static void mend_list(mending *m, const place *at, const list_rule *rule, leaving *l)
{
    place list;
    if (!enter(m, at, rule->name, &list) || !json_is_array(list.object)) {
        return;
    }
    const size_t count = json_array_size(list.object);
    alpi_bytes text = alpi_bytes_create(m->document->context);
    alpi_bytes_print(&text, "[");
    const size_t kept = filter_list(m, &list, rule, &text);
    alpi_bytes_print(&text, "]");
    m->failed |= text.failed;
    if (kept == 0 && count > 0) {
        leave(m, l, rule->name);
    } else if (kept < count) {
        m->missing++;
        if (m->edits != NULL && !text.failed) {
            alpi_edits_set(m->edits, at->span, rule->name, text.bytes, text.size);
        }
    }
    alpi_bytes_destroy(&text);
}

// --- nodes and scenes ----------------------------------------------------------------------------

static bool skin_has_all_joints(const mending *m, json_t *node)
{
    json_t *index = json_object_get(node, "skin");
    json_t *skin = json_is_number(index) && !is_missing(m, index, "skins")
                       ? alpi_gltf_item(m->document, "skins", (size_t)json_number_value(index))
                       : NULL;
    json_t *joints = json_object_get(skin, "joints");
    for (size_t i = 0; i < json_array_size(joints); i++) {
        if (is_missing(m, json_array_get(joints, i), "nodes")) {
            return false;
        }
    }
    return true;
}

static void mend_skin(mending *m, const place *node, leaving *l)
{
    mend_member(m, node, "skin", "skins", l);
    if (!skin_has_all_joints(m, node->object)) {
        if (m->edits == NULL) {
            alpi_warn(m->document->context, "missing", node->owner,
                      "a joint of its skin is not the index of a node: it is read without the "
                      "skin");
        }
        leave(m, l, "skin");
    }
}

static void mend_light(mending *m, const place *node, leaving *l)
{
    place extensions, light;
    leaving inner = {0};
    if (!enter(m, node, "extensions", &extensions) ||
        !enter(m, &extensions, lights_extension, &light)) {
        return;
    }
    json_t *value = json_object_get(light.object, "light");
    if (is_missing(m, value, "lights")) {
        tell(m, node, "light", value, "lights");
        if (json_object_size(extensions.object) == 1) {
            leave(m, l, "extensions");
        } else {
            leave(m, &inner, lights_extension);
            take_out(m, &extensions, &inner);
        }
    }
}

static void mend_node(mending *m, const place *node)
{
    static const list_rule children = {"children", NULL, "nodes"};
    leaving l = {0};
    mend_member(m, node, "mesh", "meshes", &l);
    mend_member(m, node, "camera", "cameras", &l);
    mend_skin(m, node, &l);
    mend_light(m, node, &l);
    mend_list(m, node, &children, &l);
    take_out(m, node, &l);
}

static void mend_scene(mending *m, const place *scene)
{
    static const list_rule nodes = {"nodes", NULL, "nodes"};
    leaving l = {0};
    mend_list(m, scene, &nodes, &l);
    take_out(m, scene, &l);
}

// --- meshes --------------------------------------------------------------------------------------

/// Mappings of variants are nothing without their material.
static void mend_variants(mending *m, const place *primitive)
{
    static const list_rule mappings = {"mappings", "material", "materials"};
    place extensions, variants;
    leaving l = {0};
    if (enter(m, primitive, "extensions", &extensions) &&
        enter(m, &extensions, "KHR_materials_variants", &variants)) {
        mend_list(m, &variants, &mappings, &l);
        take_out(m, &variants, &l);
    }
}

static void mend_mesh(mending *m, const place *mesh)
{
    place primitives;
    if (!enter(m, mesh, "primitives", &primitives)) {
        return;
    }
    alpi_json_cursor cursor = alpi_json_open(m->document->text, primitives.span);
    for (size_t i = 0; i < json_array_size(primitives.object); i++) {
        char owner[2 * ALPI_GLTF_OWNER_SIZE];
        snprintf(owner, sizeof owner, "%s, primitive %zu", mesh->owner, i);
        place primitive = {json_array_get(primitives.object, i), {0, 0}, owner};
        leaving l = {0};
        if (m->edits != NULL && alpi_json_next(&cursor)) {
            primitive.span = cursor.value;
        }
        mend_member(m, &primitive, "material", "materials", &l);
        take_out(m, &primitive, &l);
        mend_variants(m, &primitive);
    }
}

// --- materials and textures ----------------------------------------------------------------------

/// Members of an object that are textureInfos.
static void mend_infos(mending *m, const place *holder)
{
    const char *name;
    json_t *value;
    leaving l = {0};
    json_object_foreach(holder->object, name, value)
    {
        json_t *index = json_object_get(value, "index");
        if (is_missing(m, index, "textures")) {
            place info = {value, {0, 0}, holder->owner};
            tell(m, &info, name, index, "textures");
            leave(m, &l, name);
        }
    }
    take_out(m, holder, &l);
}

static void mend_material(mending *m, const place *material)
{
    place inner, extension;
    const char *name;
    json_t *value;
    mend_infos(m, material);
    if (enter(m, material, "pbrMetallicRoughness", &inner)) {
        mend_infos(m, &inner);
    }
    if (enter(m, material, "extensions", &inner)) {
        mend_infos(m, &inner);
        json_object_foreach(inner.object, name, value)
        {
            if (!is_missing(m, json_object_get(value, "index"), "textures") &&
                enter(m, &inner, name, &extension)) {
                mend_infos(m, &extension);
            }
        }
    }
}

static void mend_texture(mending *m, const place *texture)
{
    static const char *const forms[] = {"EXT_texture_webp", "EXT_texture_avif",
                                        "KHR_texture_basisu", "MSFT_texture_dds"};
    place extensions, form;
    leaving l = {0};
    mend_member(m, texture, "source", "images", &l);
    m->document->told_textures[m->index] |= l.count > 0;
    mend_member(m, texture, "sampler", "samplers", &l);
    take_out(m, texture, &l);
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        leaving source = {0};
        if (enter(m, texture, "extensions", &extensions) &&
            enter(m, &extensions, forms[i], &form)) {
            mend_member(m, &form, "source", "images", &source);
            m->document->told_textures[m->index] |= source.count > 0;
            take_out(m, &form, &source);
        }
    }
}

// --- the document --------------------------------------------------------------------------------

static const struct {
    const char *kind, *word;
    void (*mend)(mending *m, const place *at);
} kinds[] = {{"scenes", "scene", mend_scene},
             {"nodes", "node", mend_node},
             {"meshes", "mesh", mend_mesh},
             {"materials", "material", mend_material},
             {"textures", "texture", mend_texture}};

static void walk(mending *m)
{
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        json_t *items = json_object_get(m->document->root, kinds[k].kind);
        alpi_json_span array = {0, 0};
        if (m->edits != NULL) {
            alpi_json_find(m->document->text, m->root, kinds[k].kind, &array);
        }
        alpi_json_cursor cursor = alpi_json_open(m->document->text, array);
        for (size_t i = 0; i < json_array_size(items); i++) {
            char owner[ALPI_GLTF_OWNER_SIZE];
            snprintf(owner, sizeof owner, "%s %zu", kinds[k].word, i);
            place at = {json_array_get(items, i), {0, 0}, owner};
            if (m->edits != NULL && alpi_json_next(&cursor)) {
                at.span = cursor.value;
            }
            m->index = i;
            kinds[k].mend(m, &at);
        }
    }
}

alp_result alpi_gltf_mend(const alpi_gltf_document *document, alpi_bytes *text, bool *mended)
{
    mending m = {.document = document};
    *mended = false;
    walk(&m);
    if (m.failed) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    if (m.missing == 0 || !alpi_json_value(document->text, 0, document->text_size, &m.root)) {
        return ALP_OK;
    }
    alpi_edits edits = alpi_edits_create(document->context, document->text);
    m.edits = &edits;
    walk(&m);
    const alp_result result =
        m.failed ? ALP_ERROR_OUT_OF_MEMORY
                 : alpi_edits_apply(&edits, (alpi_json_span){0, document->text_size}, text);
    alpi_edits_destroy(&edits);
    *mended = result == ALP_OK;
    return result;
}
