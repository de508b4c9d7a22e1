// SPDX-License-Identifier: MIT
// Animations of materials (KHR_animation_pointer): a channel that moves a material which was copied
// gets a second one for each copy.
#include "base/memory.h"
#include "base/plural.h"
#include "formats/gltf/gltf_tree.h"
#include "formats/gltf/write/gltf_patch_material.h"

#include <stdlib.h>
#include <string.h>

/// The pointer of a channel, NULL where it has none.
static const char *pointer_of(json_t *channel)
{
    json_t *target = json_object_get(channel, "target");
    return alpi_gltf_text(alpi_gltf_extension(target, "KHR_animation_pointer"), "pointer");
}

/// The material that a pointer goes into, ALPI_GLTF_NONE where it is none. @param rest from the
/// slash after its number
static size_t pointed_material(const alpi_gltf_patcher *p, const char *pointer, const char **rest)
{
    static const char root[] = "/materials/";
    if (pointer == NULL || strncmp(pointer, root, sizeof root - 1) != 0) {
        return ALPI_GLTF_NONE;
    }
    const char *digits = pointer + sizeof root - 1;
    char *end;
    const unsigned long long index = strtoull(digits, &end, 10);
    *rest = end;
    return *digits >= '0' && *digits <= '9' && *end == '/' &&
                   index < p->lists[ALPI_GLTF_MATERIALS].count
               ? (size_t)index
               : ALPI_GLTF_NONE;
}

static void add_channel(alpi_gltf_patcher *p, alpi_json_span channels, json_t *channel,
                        const char *pointer)
{
    alpi_bytes text = alpi_bytes_create(p->context);
    alpi_bytes_print(&text, "{\"sampler\":%.0f,\"target\":{\"path\":\"pointer\",",
                     json_number_value(json_object_get(channel, "sampler")));
    alpi_bytes_print(&text, "\"extensions\":{\"KHR_animation_pointer\":{\"pointer\":");
    alpi_bytes_quote(&text, pointer);
    alpi_bytes_print(&text, "}}}}");
    p->data.failed |= text.failed;
    alpi_edits_add(&p->edits, channels, NULL, text.bytes, text.size);
    alpi_bytes_destroy(&text);
}

/// @param channels of the text   @param channel one of them
static void follow(alpi_gltf_patcher *p, alpi_json_span channels, json_t *channel, size_t *moved)
{
    const char *rest = NULL;
    const size_t material = pointed_material(p, pointer_of(channel), &rest);
    *moved += material != ALPI_GLTF_NONE;
    for (size_t i = 0; material != ALPI_GLTF_NONE && i < p->copy_count; i++) {
        if (p->copies[i].old != material) {
            continue;
        }
        char *pointer = alpi_format(p->context, "/materials/%zu%s", p->copies[i].written, rest);
        p->data.failed |= pointer == NULL;
        if (pointer != NULL) {
            add_channel(p, channels, channel, pointer);
        }
        alpi_release(p->context, pointer);
    }
}

void alpi_patcher_follow_pointers(alpi_gltf_patcher *p)
{
    json_t *animations = json_object_get(p->document->root, "animations");
    alpi_json_span array = {0}, span;
    size_t moved = 0;
    alpi_json_find(p->document->text, p->root, "animations", &array);
    alpi_json_cursor cursor = alpi_json_open(p->document->text, array);
    for (size_t i = 0; i < json_array_size(animations) && alpi_json_next(&cursor); i++) {
        json_t *channels = json_object_get(json_array_get(animations, i), "channels");
        if (alpi_json_find(p->document->text, cursor.value, "channels", &span)) {
            for (size_t k = 0; k < json_array_size(channels); k++) {
                follow(p, span, json_array_get(channels, k), &moved);
            }
        }
    }
    if (moved > 0 && p->patch->light != NULL && p->patch->light->form == ALPI_LIGHT_FORM_EMISSIVE) {
        alpi_warn(p->context, "animation", p->document->path,
                  "%zu channel%s materials (KHR_animation_pointer), and light as emission is "
                  "baked with them at rest: their colours would show over it; leave the channels "
                  "out, or use --lightmap-as moz",
                  moved, alpi_one_or_many(moved, " moves", "s move"));
    }
}
