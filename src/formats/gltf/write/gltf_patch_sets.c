// SPDX-License-Identifier: MIT
// Sets of coordinates: which a primitive has, which of them an earlier bake made and nothing reads
// any more but maps that are replaced now, and which the new ones become. Ours bear a mark, so that
// nobody else's is ever taken: neither those of the artist nor those of versions without marks.
#include "formats/gltf/write/gltf_patch_sets.h"

#include "base/memory.h"
#include "formats/gltf/gltf_compression.h"
#include "formats/gltf/gltf_tree.h"
#include "formats/gltf/write/gltf_patch_users.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    LAST_TEXCOORD = 3, // that viewers know; glTF 2.0 asks for two
    SET_LIMIT = 32     // of each kind: a number of _ALPENGLOW_UV_n is SET_LIMIT + n
};

static const char texcoord[] = "TEXCOORD_", own_name[] = "_ALPENGLOW_UV_";

const char *alpi_gltf_mark(const alpi_gltf_document *document, const char *kind, size_t index)
{
    json_t *extras = json_object_get(alpi_gltf_item(document, kind, index), "extras");
    return json_string_value(json_object_get(extras, "alpenglow"));
}

void alpi_patcher_set_name(uint32_t set, char name[ALPI_GLTF_ATTRIBUTE_SIZE])
{
    snprintf(name, ALPI_GLTF_ATTRIBUTE_SIZE, "%s%u", set < SET_LIMIT ? texcoord : own_name,
             set % SET_LIMIT);
}

const char *alpi_patcher_light_name(const alpi_gltf_patcher *p)
{
    static const char *const names[] = {[ALPI_LIGHT_FORM_EMISSIVE] = "emissiveTexture",
                                        [ALPI_LIGHT_FORM_MOZ] = "MOZ_lightmap",
                                        [ALPI_LIGHT_FORM_EXTRAS] = "lightmap"};
    return names[p->patch->light->form];
}

/// The bit of an attribute's name; 0 where it is no set, or beyond the limit.
static uint64_t bit_of(const char *name)
{
    const bool plain = name != NULL && strncmp(name, texcoord, sizeof texcoord - 1) == 0;
    const bool own = name != NULL && strncmp(name, own_name, sizeof own_name - 1) == 0;
    if (!plain && !own) {
        return 0;
    }
    const char *digits = name + (plain ? sizeof texcoord : sizeof own_name) - 1;
    const size_t length = strlen(digits);
    if (length == 0 || length > 2 || strspn(digits, "0123456789") != length) {
        return 0;
    }
    const unsigned long number = strtoul(digits, NULL, 10);
    return number < SET_LIMIT ? (uint64_t)1 << (number + (plain ? 0 : SET_LIMIT)) : 0;
}

uint64_t alpi_gltf_sets_of(json_t *attributes)
{
    uint64_t sets = 0;
    const char *name;
    json_t *value;
    json_object_foreach(attributes, name, value)
    {
        sets |= bit_of(name);
    }
    return sets;
}

uint64_t alpi_gltf_sets_named(json_t *blend)
{
    json_t *names = json_object_get(blend, "sets");
    uint64_t sets = 0;
    for (size_t i = 0; i < json_array_size(names); i++) {
        sets |= bit_of(json_string_value(json_array_get(names, i)));
    }
    return sets;
}

// --- what reads a set ----------------------------------------------------------------------------

/// Values of JSON that are still to be looked at, and what was found in the others.
typedef struct search {
    alp_context *context;
    json_t **values;
    size_t count, capacity;
    json_t *passed[3]; // over: what is replaced, and what is looked at otherwise
    uint64_t reads;
} search;

static alp_result push(search *s, json_t *value)
{
    for (size_t i = 0; i < sizeof s->passed / sizeof *s->passed; i++) {
        if (value == s->passed[i]) {
            return ALP_OK;
        }
    }
    if (!json_is_object(value) && !json_is_array(value)) {
        return ALP_OK;
    }
    void *items = s->values;
    ALP_TRY(alpi_grow(s->context, &items, &s->capacity, s->count + 1, sizeof(json_t *)));
    s->values = items;
    s->values[s->count++] = value;
    return ALP_OK;
}

/// A textureInfo without texCoord reads set 0; whatever names a texCoord, in whatever extension,
/// reads that.
static uint64_t reads_of(json_t *object)
{
    json_t *set = json_object_get(object, "texCoord");
    const double value = json_number_value(set);
    if (json_is_number(set)) {
        return value >= 0.0 && value < SET_LIMIT ? (uint64_t)1 << (uint32_t)value : 0;
    }
    return json_object_get(object, "index") != NULL ? 1 : 0;
}

/// Looks at all that a value holds.
static alp_result look(search *s, json_t *value)
{
    ALP_TRY(push(s, value));
    while (s->count > 0) {
        json_t *at = s->values[--s->count], *member;
        const char *name;
        size_t index;
        if (json_is_array(at)) {
            json_array_foreach(at, index, member)
            {
                ALP_TRY(push(s, member));
            }
            continue;
        }
        s->reads |= reads_of(at);
        json_object_foreach(at, name, member)
        {
            ALP_TRY(push(s, member));
        }
    }
    return ALP_OK;
}

alp_result alpi_gltf_sets_read(alp_context *context, json_t *material, uint64_t *sets)
{
    search s = {.context = context};
    s.passed[0] = json_object_get(json_object_get(material, "extras"), ALPI_GLTF_BLEND);
    const alp_result result = look(&s, material);
    alpi_release(context, s.values);
    *sets = s.reads;
    return result;
}

/// Sets of a bake that blends, where maps that stay are read with them.
static uint64_t blended(const alpi_gltf_patcher *p, json_t *blend, alpi_gltf_maps replaced)
{
    json_t *maps = json_object_get(blend, "maps");
    bool stays = false;
    for (size_t i = 0; i < json_array_size(maps); i++) {
        const char *name = json_string_value(json_array_get(maps, i));
        const bool occlusion = name != NULL && strcmp(name, "occlusionTexture") == 0;
        const bool light = name != NULL && p->patch->light != NULL &&
                           strcmp(name, alpi_patcher_light_name(p)) == 0;
        stays |=
            !(occlusion && (replaced.occluded || replaced.cleared)) && !(light && replaced.lit);
    }
    return stays ? alpi_gltf_sets_named(blend) : 0;
}

/// The sets that a material reads, but for maps that are replaced.
static alp_result search_material(const alpi_gltf_patcher *p, search *s, json_t *material,
                                  alpi_gltf_maps replaced)
{
    json_t *extras = json_object_get(material, "extras");
    json_t *blend = json_object_get(extras, ALPI_GLTF_BLEND);
    json_t *earlier = json_object_get(blend, ALPI_GLTF_EARLIER);
    s->passed[0] = blend;
    s->passed[1] = replaced.occluded || replaced.cleared
                       ? json_object_get(material, "occlusionTexture")
                       : NULL;
    s->passed[2] = NULL;
    if (replaced.lit) {
        const char *name = alpi_patcher_light_name(p);
        s->passed[2] =
            p->patch->light->form == ALPI_LIGHT_FORM_EMISSIVE ? json_object_get(material, name)
            : p->patch->light->form == ALPI_LIGHT_FORM_MOZ    ? alpi_gltf_extension(material, name)
                                                              : json_object_get(extras, name);
    }
    s->reads |= blended(p, blend, replaced);
    for (size_t i = 0; i < json_array_size(earlier); i++) {
        s->reads |= blended(p, json_array_get(earlier, i), replaced);
    }
    return look(s, material);
}

/// What reads sets of a primitive when the bake is done, its new maps left out: its material, those
/// of its variants, and its own extensions.
static alp_result search_primitive(const alpi_gltf_patcher *p, search *s, json_t *primitive,
                                   const alpi_gltf_plan *plan)
{
    const bool maps = p->patch->vertex_values == NULL; // else materials stay as they are
    const alpi_gltf_maps replaced = {maps && (plan->packed || plan->occluded),
                                     maps && !plan->packed && plan->lit, maps && plan->cleared};
    json_t *mappings = alpi_gltf_mappings(primitive);
    for (size_t i = 0; i < json_array_size(mappings); i++) {
        const size_t index = alpi_patcher_mapping(p, mappings, i);
        alpi_gltf_plan variant;
        alpi_gltf_maps gone = {0};
        if (alpi_patcher_variant(p, plan, index, &variant)) {
            gone = (alpi_gltf_maps){variant.occluded, variant.lit, variant.cleared};
        }
        if (index != ALPI_GLTF_NONE && index != plan->material) {
            json_t *material = alpi_gltf_item(p->document, "materials", index);
            ALP_TRY(search_material(p, s, material, gone));
        }
    }
    if (plan->material != ALPI_GLTF_NONE) {
        json_t *material = alpi_gltf_item(p->document, "materials", plan->material);
        ALP_TRY(search_material(p, s, material, replaced));
    }
    memset(s->passed, 0, sizeof s->passed);
    ALP_TRY(look(s, json_object_get(primitive, "extensions")));
    return look(s, json_object_get(primitive, "extras"));
}

/// The sets of a primitive that an earlier bake made.
static uint64_t own_sets(const alpi_gltf_patcher *p, json_t *attributes)
{
    uint64_t sets = 0;
    const char *name;
    json_t *value;
    json_object_foreach(attributes, name, value)
    {
        const double index = json_number_value(value);
        if (bit_of(name) != 0 && json_is_number(value) && index >= 0.0 &&
            index < (double)p->lists[ALPI_GLTF_ACCESSORS].count) {
            const char *mark = alpi_gltf_mark(p->document, "accessors", (size_t)index);
            sets |= mark != NULL && strcmp(mark, ALPI_GLTF_SET) == 0 ? bit_of(name) : 0;
        }
    }
    return sets;
}

// --- which the new ones become -------------------------------------------------------------------

/// The first one of [begin, end) that is free; `end` where none is.
static uint32_t find_free(uint64_t taken, uint32_t begin, uint32_t end)
{
    while (begin < end && (taken >> begin & 1) != 0) {
        begin++;
    }
    return begin;
}

/// The first is a TEXCOORD, since materials name no others; the further ones of a blend are those
/// that viewers know, then attributes of our own.
static bool choose(const alpi_gltf_patcher *p, uint64_t taken, alpi_gltf_plan *plan)
{
    const uint32_t count = p->patch->set_uvs != NULL ? ALPI_GLTF_BLEND_SETS : 1;
    plan->sets[0] = find_free(taken, 0, SET_LIMIT);
    for (uint32_t k = 1; k < count; k++) {
        uint32_t set = find_free(taken, plan->sets[k - 1] % SET_LIMIT + 1, LAST_TEXCOORD + 1);
        if (plan->sets[k - 1] >= LAST_TEXCOORD || set > LAST_TEXCOORD) {
            const bool first = plan->sets[k - 1] < SET_LIMIT;
            set = find_free(taken, first ? SET_LIMIT + k : plan->sets[k - 1] + 1, 2 * SET_LIMIT);
        }
        plan->sets[k] = set;
    }
    return plan->sets[0] < SET_LIMIT && plan->sets[count - 1] < 2 * SET_LIMIT;
}

/// Sets that go. Numbers of TEXCOORD may have no gap (glTF 2.0, section 3.7.2.1): one of ours that
/// lies below one that stays waits for the next bake, which takes its place.
static uint64_t find_dropped(const alpi_gltf_patcher *p, uint64_t present, uint64_t dead,
                             const alpi_gltf_plan *plan)
{
    uint64_t stays = present & ~dead;
    const uint32_t count = p->patch->vertex_values != NULL || plan->packed ? 0
                           : p->patch->set_uvs != NULL                     ? ALPI_GLTF_BLEND_SETS
                                                                           : 1;
    for (uint32_t k = 0; k < count; k++) {
        stays |= (uint64_t)1 << plan->sets[k];
    }
    uint64_t below = stays & (((uint64_t)1 << SET_LIMIT) - 1);
    for (uint32_t shift = 1; shift < SET_LIMIT; shift *= 2) {
        below |= below >> shift;
    }
    return dead & ~stays & ~below;
}

alp_result alpi_patcher_choose_sets(alpi_gltf_patcher *p, json_t *primitive, const char *owner,
                                    alpi_gltf_plan *plan)
{
    const bool keeps = p->patch->corner_uvs == NULL && p->patch->vertex_values == NULL;
    json_t *attributes = json_object_get(primitive, "attributes");
    const uint64_t present = alpi_gltf_sets_of(attributes), own = own_sets(p, attributes);
    search s = {.context = p->context};
    alp_result result = own != 0 ? search_primitive(p, &s, primitive, plan) : ALP_OK;
    alpi_release(p->context, s.values);
    ALP_TRY(result);
    uint64_t dead = own & ~s.reads;
    if (keeps && !plan->packed) {
        plan->sets[0] = p->patch->kept_uv_set;
        dead &= ~((uint64_t)1 << plan->sets[0]);
    } else if (!choose(p, present & ~dead, plan)) {
        return alpi_gltf_fail(p->document, owner,
                              "has %d coordinate sets: none is free for a map; remove unused "
                              "ones",
                              SET_LIMIT);
    }
    const bool packed_away = keeps && alpi_gltf_extension(primitive, ALPI_GLTF_DRACO) != NULL;
    plan->dropped = packed_away ? 0 : find_dropped(p, present, dead, plan);
    return ALP_OK;
}

void alpi_patcher_warn_of_sets(const alpi_gltf_patcher *p)
{
    size_t count = 0;
    if (p->patch->corner_uvs == NULL) {
        return; // kept ones are as they were
    }
    for (size_t i = 0; i < p->plan_count; i++) {
        count += !p->plans[i].packed && p->plans[i].sets[0] > LAST_TEXCOORD;
    }
    if (count > 0) {
        alpi_warn(
            p->context, "uv-sets", p->document->path,
            "primitives whose map uses a coordinate set beyond TEXCOORD_3, because they have four "
            "already: %zu; few viewers and not this program read it; remove unused sets, or bake "
            "the original file",
            count);
    }
}

bool alpi_patcher_is_dropped(const char *text, alpi_json_span key, uint64_t dropped)
{
    for (uint32_t set = 0; dropped != 0; set++, dropped >>= 1) {
        char name[ALPI_GLTF_ATTRIBUTE_SIZE];
        if ((dropped & 1) != 0) {
            alpi_patcher_set_name(set, name);
            if (alpi_json_key_is(text, key, name)) {
                return true;
            }
        }
    }
    return false;
}

void alpi_patcher_drop_sets(alpi_edits *edits, alpi_json_span attributes, uint64_t dropped)
{
    char names[2 * SET_LIMIT][ALPI_GLTF_ATTRIBUTE_SIZE];
    const char *list[2 * SET_LIMIT];
    size_t count = 0;
    for (uint32_t set = 0; dropped != 0; set++, dropped >>= 1) {
        if ((dropped & 1) != 0) {
            alpi_patcher_set_name(set, names[count]);
            list[count] = names[count];
            count++;
        }
    }
    if (count > 0) {
        alpi_edits_remove_all(edits, attributes, list, count);
    }
}
