// SPDX-License-Identifier: MIT
// Animations (glTF 2.0, section 3.11). A channel is checked as a whole before it moves anything.
#include "formats/gltf/gltf_animation.h"

#include "base/memory.h"
#include "formats/gltf/gltf_accessor.h"
#include "formats/gltf/gltf_keys.h"
#include "formats/gltf/gltf_tree.h"

#include <stdio.h>
#include <string.h>

/// Channels may share accessors, and so a short file may ask for very many numbers.
enum { NUMBER_LIMIT = 1 << 28, TARGET_LIMIT = 1 << 16 };
enum { COMPONENT_U32 = 5125, COMPONENT_FLOAT = 5126 };

/// One channel.
typedef struct channel {
    json_t *animation;
    char owner[ALPI_GLTF_OWNER_SIZE];
    size_t node; // ALPI_GLTF_NONE: it moves something else than a node
    alpi_gltf_member member;
    alpi_gltf_keys keys; // its values are released
} channel;

// --- a channel -----------------------------------------------------------------------------------

/// @return ALPI_GLTF_MEMBER_COUNT for others
static alpi_gltf_member find_member(const char *path)
{
    static const char *const names[ALPI_GLTF_MEMBER_COUNT] = {"translation", "rotation", "scale",
                                                              "weights"};
    int i = 0;
    while (i < ALPI_GLTF_MEMBER_COUNT && (path == NULL || strcmp(path, names[i]) != 0)) {
        i++;
    }
    return (alpi_gltf_member)i;
}

static alp_result find_target(const alpi_gltf_document *document, json_t *object, channel *c)
{
    json_t *target = json_object_get(object, "target");
    c->member = find_member(alpi_gltf_text(target, "path"));
    ALP_TRY(alpi_gltf_index(document, target, "node", "nodes", c->owner, &c->node));
    if (c->member == ALPI_GLTF_MEMBER_COUNT) {
        c->node = ALPI_GLTF_NONE;
    }
    json_t *node = c->node != ALPI_GLTF_NONE ? alpi_gltf_item(document, "nodes", c->node) : NULL;
    return c->member != ALPI_GLTF_WEIGHTS && json_object_get(node, "matrix") != NULL
               ? alpi_gltf_fail(document, c->owner, "node %zu has a matrix", c->node)
               : ALP_OK;
}

static alp_result find_interpolation(const alpi_gltf_document *document, json_t *sampler,
                                     const char *owner, alpi_gltf_interpolation *interpolation)
{
    static const char *const names[] = {"LINEAR", "STEP", "CUBICSPLINE"};
    json_t *member = json_object_get(sampler, "interpolation");
    const char *name = member != NULL ? json_string_value(member) : names[0];
    for (int i = 0; name != NULL && i < 3; i++) {
        if (strcmp(name, names[i]) == 0) {
            *interpolation = (alpi_gltf_interpolation)i;
            return ALP_OK;
        }
    }
    return alpi_gltf_fail(document, owner, "its interpolation is none of glTF");
}

/// Morph targets of a node's mesh.
static size_t count_targets(const alpi_gltf_document *document, size_t node)
{
    json_t *mesh = json_object_get(alpi_gltf_item(document, "nodes", node), "mesh");
    json_t *object = json_is_number(mesh)
                         ? alpi_gltf_item(document, "meshes", (size_t)json_number_value(mesh))
                         : NULL;
    json_t *first = json_array_get(json_object_get(object, "primitives"), 0);
    return json_array_size(json_object_get(first, "targets"));
}

/// Refuses accessors that do not fit the member. @param times, values without bytes
static alp_result check_shapes(const alpi_gltf_document *document, channel *c,
                               const alpi_gltf_values *times, const alpi_gltf_values *values)
{
    static const uint32_t components[ALPI_GLTF_MEMBER_COUNT] = {3, 4, 3, 1};
    const bool vector = c->member == ALPI_GLTF_TRANSLATION || c->member == ALPI_GLTF_SCALE;
    const size_t targets =
        c->member == ALPI_GLTF_WEIGHTS ? count_targets(document, c->node) : components[c->member];
    const uint64_t elements = (uint64_t)times->count *
                              (c->keys.interpolation == ALPI_GLTF_CUBIC ? 3 : 1) *
                              (c->member == ALPI_GLTF_WEIGHTS ? targets : 1);
    if (times->components != 1 || times->component_type != COMPONENT_FLOAT || times->count == 0) {
        return alpi_gltf_fail(document, c->owner, "its times are not scalars of floats");
    }
    if (values->components != components[c->member] ||
        (values->component_type != COMPONENT_FLOAT && (vector || !values->normalized))) {
        return alpi_gltf_fail(document, c->owner, "its values are not %s of floats%s",
                              vector ? "VEC3" : "numbers", vector ? "" : " or normalised integers");
    }
    if (targets == 0 || targets > TARGET_LIMIT || values->count != elements) {
        return alpi_gltf_fail(document, c->owner, "it has %u values for %u keys of %zu numbers",
                              values->count, times->count, targets);
    }
    c->keys.count = times->count;
    c->keys.width = (uint32_t)targets;
    c->keys.rotations = c->member == ALPI_GLTF_ROTATION;
    return ALP_OK;
}

static alp_result count_numbers(alpi_gltf_reader *reader, const channel *c, uint64_t numbers)
{
    reader->keys += numbers;
    return reader->keys <= NUMBER_LIMIT
               ? ALP_OK
               : alpi_gltf_fail(reader->document, c->owner,
                                "the animations have more than %d numbers", NUMBER_LIMIT);
}

static alp_result read_keys(alpi_gltf_reader *reader, json_t *object, channel *c)
{
    const alpi_gltf_document *document = reader->document;
    size_t index, input, output;
    alpi_gltf_values times, values;
    ALP_TRY(alpi_gltf_size(document, object, "sampler", c->owner, &index));
    json_t *sampler = json_array_get(json_object_get(c->animation, "samplers"), index);
    if (!json_is_object(sampler)) {
        return alpi_gltf_fail(document, c->owner, "there is no sampler %zu", index);
    }
    ALP_TRY(find_interpolation(document, sampler, c->owner, &c->keys.interpolation));
    ALP_TRY(alpi_gltf_needed_index(document, sampler, "input", "accessors", c->owner, &input));
    ALP_TRY(alpi_gltf_needed_index(document, sampler, "output", "accessors", c->owner, &output));
    ALP_TRY(alpi_gltf_accessor_check(document, input, &times));
    ALP_TRY(alpi_gltf_accessor_check(document, output, &values));
    ALP_TRY(check_shapes(document, c, &times, &values));
    ALP_TRY(count_numbers(reader, c, times.count + (uint64_t)values.count * values.components));
    ALP_TRY(alpi_gltf_accessor_read(document, input, &c->keys.times));
    ALP_TRY(alpi_gltf_accessor_read(document, output, &c->keys.values));
    uint32_t key = 0;
    const char *fault = alpi_gltf_keys_fault(&c->keys, &key);
    return fault != NULL ? alpi_gltf_fail(document, c->owner, "key %u: %s", key, fault) : ALP_OK;
}

static alp_result read_channel(alpi_gltf_reader *reader, json_t *object, channel *c)
{
    ALP_TRY(find_target(reader->document, object, c));
    return c->node != ALPI_GLTF_NONE ? read_keys(reader, object, c) : ALP_OK;
}

static void release_keys(alpi_gltf_reader *reader, channel *c)
{
    alpi_release(reader->context, c->keys.times.bytes);
    alpi_release(reader->context, c->keys.values.bytes);
}

// --- an animation --------------------------------------------------------------------------------

/// A walk over the channels of an animation.
typedef struct walk {
    uint32_t unread; // channels that move something else than a node
    double end;      // seconds of the last key
    uint32_t channels;
    uint32_t (*marks)[ALPI_GLTF_MEMBER_COUNT]; // [nodes] last animation that moves it, from 1
    /// Uses a channel. @return ALP_OK; INVALID_DATA: it has a fault; OUT_OF_MEMORY
    alp_result (*use)(alpi_gltf_reader *reader, const channel *c, double seconds);
    double seconds; // of `use`
} walk;

static alp_result try_channel(alpi_gltf_reader *reader, size_t index, json_t *object, channel *c,
                              walk *w)
{
    ALP_TRY(read_channel(reader, object, c));
    if (c->node == ALPI_GLTF_NONE) {
        w->unread++;
        return ALP_OK;
    }
    uint32_t *mark = &w->marks[c->node][c->member];
    if (*mark == index + 1) {
        return alpi_gltf_fail(reader->document, c->owner,
                              "a channel before it moves the same of node %zu", c->node);
    }
    *mark = (uint32_t)index + 1;
    if (w->use != NULL) {
        ALP_TRY(w->use(reader, c, w->seconds));
    }
    const double end = alpi_gltf_keys_end(&c->keys);
    w->end = end > w->end ? end : w->end;
    w->channels++;
    return ALP_OK;
}

static alp_result walk_channels(alpi_gltf_reader *reader, size_t index, walk *w)
{
    json_t *animation = alpi_gltf_item(reader->document, "animations", index);
    json_t *channels = json_object_get(animation, "channels");
    for (size_t i = 0; i < json_array_size(channels); i++) {
        channel c = {.animation = animation};
        snprintf(c.owner, sizeof c.owner, "animation %zu, channel %zu", index, i);
        const alp_result result = try_channel(reader, index, json_array_get(channels, i), &c, w);
        release_keys(reader, &c);
        if (result == ALP_ERROR_OUT_OF_MEMORY) {
            return result;
        }
        if (result != ALP_OK) {
            char reason[512];
            snprintf(reason, sizeof reason, "%s", alp_context_message(reader->context));
            alpi_gltf_clean(reason);
            alpi_warn(reader->context, "animation", c.owner, "%s; the channel is left out", reason);
        }
    }
    return ALP_OK;
}

static alp_result list_animation(alpi_gltf_reader *reader, size_t index, walk *w)
{
    alp_scene *scene = reader->scene;
    alpi_animation *a = &scene->animations[scene->animation_count++];
    json_t *object = alpi_gltf_item(reader->document, "animations", index);
    a->name = alpi_gltf_copy_name(reader->context, object);
    if (a->name == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    w->end = 0.0;
    w->channels = 0;
    ALP_TRY(walk_channels(reader, index, w));
    a->seconds = w->end;
    a->channels = w->channels;
    return ALP_OK;
}

static alp_result list_animations(alpi_gltf_reader *reader, size_t count, walk *w)
{
    ALPI_TRY_NEW(reader->context, reader->scene->animations, count);
    ALPI_TRY_NEW(reader->context, w->marks, reader->node_count);
    for (size_t i = 0; i < count; i++) {
        ALP_TRY(list_animation(reader, i, w));
    }
    return ALP_OK;
}

static alp_result copy_list(const alp_scene *from, alp_scene *to)
{
    ALPI_TRY_NEW(to->context, to->animations, from->animation_count);
    for (uint32_t i = 0; i < from->animation_count; i++) {
        alpi_animation *a = &to->animations[to->animation_count++];
        *a = from->animations[i];
        a->name = alpi_copy_string(to->context, a->name);
        if (a->name == NULL) {
            return ALP_ERROR_OUT_OF_MEMORY;
        }
    }
    return ALP_OK;
}

alp_result alpi_gltf_read_animations(alpi_gltf_reader *reader)
{
    if (reader->base != NULL) {
        return copy_list(reader->base, reader->scene);
    }
    const size_t count = alpi_gltf_count(reader->document, "animations");
    walk w = {0};
    if (count >= ALPI_NONE) {
        return alpi_fail(reader->context, ALP_ERROR_LIMIT, "%s: %zu animations are too many",
                         reader->document->path, count);
    }
    const alp_result result = list_animations(reader, count, &w);
    alpi_release(reader->context, w.marks);
    return result;
}

// --- a moment ------------------------------------------------------------------------------------

static alp_result set_moment(alpi_gltf_reader *reader, const channel *c, double seconds)
{
    alpi_gltf_moment *m = &reader->moments[c->node];
    double *const places[] = {m->translation, m->rotation, m->scale};
    if (c->member == ALPI_GLTF_WEIGHTS) {
        ALPI_TRY_NEW(reader->context, m->weights, c->keys.width);
        m->weight_count = c->keys.width;
    }
    m->set[c->member] = true;
    alpi_gltf_keys_at(&c->keys, seconds,
                      c->member == ALPI_GLTF_WEIGHTS ? m->weights : places[c->member]);
    return ALP_OK;
}

alp_result alpi_gltf_read_moments(alpi_gltf_reader *reader, size_t index, double seconds)
{
    walk w = {.use = set_moment, .seconds = seconds};
    const size_t count = alpi_gltf_count(reader->document, "nodes");
    ALPI_TRY_NEW(reader->context, reader->moments, count);
    reader->moment_count = count;
    ALPI_TRY_NEW(reader->context, w.marks, count);
    const alp_result result = walk_channels(reader, index, &w);
    reader->unread_channels = w.unread;
    alpi_release(reader->context, w.marks);
    return result;
}

void alpi_gltf_release_moments(alpi_gltf_reader *reader)
{
    for (size_t i = 0; reader->moments != NULL && i < reader->moment_count; i++) {
        alpi_release(reader->context, reader->moments[i].weights);
    }
    alpi_release(reader->context, reader->moments);
    reader->moments = NULL;
}
