// SPDX-License-Identifier: MIT
// Skins and morph targets: joints where their nodes stand, targets with the weights of an
// animation, else with their default ones (glTF 2.0, sections 3.7.2.2 and 3.7.3.3). The node of a
// skinned mesh places nothing.
#include "formats/gltf/gltf_pose.h"

#include "base/memory.h"
#include "formats/gltf/gltf_accessor.h"
#include "formats/gltf/gltf_animation.h"
#include "formats/gltf/gltf_tree.h"

#include <math.h>
#include <stdio.h>

enum { INFLUENCE_SET_LIMIT = 4, TARGET_LIMIT = 1 << 16 };

/// A short file may name one skin or one target for very many primitives, and each is posed anew. A
/// step is a vertex moved by a target, or a weight; a joint takes as long as sixteen.
enum { STEP_LIMIT = 1 << 28, STEPS_PER_JOINT = 16 };

static alp_result count_steps(alpi_gltf_reader *reader, const char *owner, uint64_t steps)
{
    reader->posing += steps;
    return reader->posing <= STEP_LIMIT
               ? ALP_OK
               : alpi_fail(reader->context, ALP_ERROR_LIMIT,
                           "%s: %s: skins and morph targets take more than %d steps (vertices × "
                           "targets, 16 × joints); split the scene, or apply them",
                           reader->document->path, owner, STEP_LIMIT);
}

// --- the pose of a node --------------------------------------------------------------------------

/// Weights, unless all are 0. @param list NULL: numbers of the array
static alp_result copy_weights(alpi_gltf_reader *reader, const double *list, json_t *array,
                               size_t count, alpi_gltf_pose *pose)
{
    bool any = false;
    for (size_t i = 0; i < count; i++) {
        any |= (list != NULL ? list[i] : json_number_value(json_array_get(array, i))) != 0.0;
    }
    if (!any || count > TARGET_LIMIT) {
        return ALP_OK;
    }
    ALPI_TRY_NEW(reader->context, pose->weights, count);
    pose->weight_count = (uint32_t)count;
    for (size_t i = 0; i < count; i++) {
        pose->weights[i] = list != NULL ? list[i] : json_number_value(json_array_get(array, i));
    }
    return ALP_OK;
}

/// Weights of the animation, else default ones of the node, else of its mesh.
static alp_result read_weights(alpi_gltf_reader *reader, uint32_t node, const char *owner,
                               alpi_gltf_pose *pose)
{
    json_t *object = alpi_gltf_item(reader->document, "nodes", node);
    json_t *mesh = json_object_get(object, "mesh");
    json_t *weights = json_object_get(object, "weights");
    const alpi_gltf_moment *moment = reader->moments != NULL ? &reader->moments[node] : NULL;
    if (moment != NULL && moment->set[ALPI_GLTF_WEIGHTS]) {
        ALP_TRY(count_steps(reader, owner, moment->weight_count));
        return copy_weights(reader, moment->weights, NULL, moment->weight_count, pose);
    }
    if (!json_is_array(weights)) {
        json_t *shown = alpi_gltf_item(reader->document, "meshes", (size_t)json_number_value(mesh));
        weights = json_object_get(shown, "weights");
    }
    const size_t count = json_array_size(weights);
    ALP_TRY(count_steps(reader, owner, count));
    return copy_weights(reader, NULL, weights, count, pose);
}

/// The node of joint `i`, ALPI_NONE when it is none: what is written has more nodes, and must not
/// give one to a number that had none.
static uint32_t find_joint(const alpi_gltf_reader *reader, json_t *joints, size_t i)
{
    json_t *value = json_array_get(joints, i);
    double number = json_is_number(value) ? json_number_value(value) : -1.0;
    return number >= 0.0 && number < (double)reader->node_count ? (uint32_t)number : ALPI_NONE;
}

static alp_result read_joints(alpi_gltf_reader *reader, json_t *skin, const char *owner, bool tell,
                              alpi_gltf_pose *pose)
{
    json_t *joints = json_object_get(skin, "joints");
    size_t count = json_array_size(joints), inverse;
    ALP_TRY(alpi_gltf_index(reader->document, skin, "inverseBindMatrices", "accessors", owner,
                            &inverse));
    ALP_TRY(count_steps(reader, owner, (uint64_t)STEPS_PER_JOINT * count));
    bool placed = count > 0;
    size_t missing = 0;
    for (size_t i = 0; i < count; i++) {
        const uint32_t node = find_joint(reader, joints, i);
        if (node == ALPI_NONE) {
            return alpi_gltf_fail(reader->document, owner,
                                  "joint %zu is not the index of a node (there are %u)", i,
                                  reader->node_count);
        }
        missing = placed ? i : missing;
        placed = placed && reader->placed[node];
    }
    if (!placed) {
        if (tell) {
            alpi_warn(reader->context, "skin", owner,
                      "joint %zu is not a node of the scene: the skin is applied without it",
                      missing);
        }
        return ALP_OK;
    }
    ALPI_TRY_NEW(reader->context, pose->joints, count);
    pose->joint_count = (uint32_t)count;
    for (size_t i = 0; i < count; i++) {
        pose->joints[i] = mat4_identity();
    }
    if (inverse != ALPI_GLTF_NONE) {
        ALP_TRY(alpi_gltf_accessor_matrices(reader->document, inverse, pose->joint_count,
                                            &pose->joints->m));
    }
    for (size_t i = 0; i < count; i++) {
        const uint32_t node = find_joint(reader, joints, i);
        pose->joints[i] = mat4_multiply(&reader->world[node], &pose->joints[i]);
    }
    return ALP_OK;
}

alp_result alpi_gltf_pose_create(alpi_gltf_reader *reader, uint32_t node, bool tell,
                                 alpi_gltf_pose *pose)
{
    json_t *object = alpi_gltf_item(reader->document, "nodes", node);
    char owner[ALPI_GLTF_OWNER_SIZE];
    size_t skin;
    *pose = (alpi_gltf_pose){0};
    snprintf(owner, sizeof owner, "node %u", node);
    ALP_TRY(alpi_gltf_index(reader->document, object, "skin", "skins", owner, &skin));
    alp_result result = read_weights(reader, node, owner, pose);
    if (result == ALP_OK && skin != ALPI_GLTF_NONE) {
        snprintf(owner, sizeof owner, "skin %zu", skin);
        result =
            read_joints(reader, alpi_gltf_item(reader->document, "skins", skin), owner, tell, pose);
    }
    if (result != ALP_OK) {
        alpi_gltf_pose_destroy(reader, pose);
    }
    return result;
}

void alpi_gltf_pose_destroy(alpi_gltf_reader *reader, alpi_gltf_pose *pose)
{
    alpi_release(reader->context, pose->joints);
    alpi_release(reader->context, pose->weights);
    *pose = (alpi_gltf_pose){0};
}

// --- vertices ------------------------------------------------------------------------------------

/// Adds weight × the accessor's vectors.
static alp_result add_vectors(alpi_gltf_reader *reader, const alpi_gltf_posed *posed,
                              size_t accessor, float weight, float (*vertices)[3])
{
    alpi_gltf_values values;
    ALP_TRY(alpi_gltf_accessor_read(reader->document, accessor, &values));
    alp_result result = ALP_OK;
    if (values.components != 3 || values.count != posed->vertex_count) {
        result = alpi_gltf_fail(reader->document, posed->owner,
                                "accessor %zu has %u elements of %u components for %u vertices",
                                accessor, values.count, values.components, posed->vertex_count);
    }
    for (uint32_t i = 0; i < values.count && result == ALP_OK; i++) {
        for (uint32_t k = 0; k < 3; k++) {
            vertices[i][k] += weight * alpi_gltf_values_float(&values, i, k);
        }
    }
    alpi_release(reader->context, values.bytes);
    return result;
}

static alp_result morph(alpi_gltf_reader *reader, const alpi_gltf_pose *pose,
                        const alpi_gltf_posed *posed, float (*vertices)[3])
{
    json_t *targets = json_object_get(posed->primitive, "targets");
    for (size_t i = 0; i < json_array_size(targets) && i < pose->weight_count; i++) {
        size_t accessor;
        ALP_TRY(alpi_gltf_index(reader->document, json_array_get(targets, i),
                                posed->normals ? "NORMAL" : "POSITION", "accessors", posed->owner,
                                &accessor));
        if (accessor != ALPI_GLTF_NONE && pose->weights[i] != 0.0) {
            ALP_TRY(count_steps(reader, posed->owner, posed->vertex_count));
            ALP_TRY(
                add_vectors(reader, posed, accessor, alpi_gltf_float(pose->weights[i]), vertices));
        }
    }
    return ALP_OK;
}

/// Joints and weights of a primitive: up to 4 sets of 4.
typedef struct influences {
    alpi_gltf_values joints[INFLUENCE_SET_LIMIT], weights[INFLUENCE_SET_LIMIT];
    uint32_t set_count;
} influences;

static alp_result read_influence(alpi_gltf_reader *reader, const alpi_gltf_posed *posed,
                                 const char *name, uint32_t set, alpi_gltf_values *values)
{
    char member[32];
    size_t accessor;
    snprintf(member, sizeof member, "%s_%u", name, set);
    ALP_TRY(alpi_gltf_index(reader->document, json_object_get(posed->primitive, "attributes"),
                            member, "accessors", posed->owner, &accessor));
    if (accessor == ALPI_GLTF_NONE) {
        return ALP_OK;
    }
    ALP_TRY(alpi_gltf_accessor_read(reader->document, accessor, values));
    if (values->components != 4 || values->count != posed->vertex_count) {
        return alpi_gltf_fail(reader->document, posed->owner,
                              "%s (accessor %zu) has %u elements of %u components for %u vertices",
                              member, accessor, values->count, values->components,
                              posed->vertex_count);
    }
    return ALP_OK;
}

static alp_result read_influences(alpi_gltf_reader *reader, const alpi_gltf_posed *posed,
                                  influences *all)
{
    for (uint32_t set = 0; set < INFLUENCE_SET_LIMIT; set++) {
        ALP_TRY(read_influence(reader, posed, "JOINTS", set, &all->joints[set]));
        ALP_TRY(read_influence(reader, posed, "WEIGHTS", set, &all->weights[set]));
        if (all->joints[set].bytes == NULL || all->weights[set].bytes == NULL) {
            break;
        }
        all->set_count = set + 1;
    }
    return ALP_OK;
}

static uint32_t joint_of(const alpi_gltf_values *joints, uint32_t vertex, uint32_t k)
{
    float value = alpi_gltf_values_float(joints, vertex, k); // exact: 16 bits at most are allowed
    return value >= 0.0f && value < 65536.0f ? (uint32_t)value : UINT32_MAX;
}

/// The blended matrix of a vertex; the node's where nothing moves it.
static alp_result blend(alpi_gltf_reader *reader, const alpi_gltf_pose *pose,
                        const alpi_gltf_posed *posed, const influences *all, uint32_t vertex,
                        mat4 *matrix)
{
    double sum = 0.0;
    *matrix = (mat4){{0}};
    for (uint32_t i = 0; i < 4 * all->set_count; i++) {
        const float weight = alpi_gltf_values_float(&all->weights[i / 4], vertex, i % 4);
        if (!(weight > 0.0f) || !isfinite(weight)) {
            continue;
        }
        const uint32_t joint = joint_of(&all->joints[i / 4], vertex, i % 4);
        if (joint >= pose->joint_count) {
            return alpi_gltf_fail(reader->document, posed->owner,
                                  "vertex %u names a joint that its skin does not have (there are "
                                  "%u)",
                                  vertex, pose->joint_count);
        }
        for (int k = 0; k < 16; k++) {
            matrix->m[k] += (double)weight * pose->joints[joint].m[k];
        }
        sum += (double)weight;
    }
    for (int k = 0; k < 16; k++) {
        matrix->m[k] = sum > 0.0 ? matrix->m[k] / sum : posed->world->m[k];
    }
    return ALP_OK;
}

static alp_result place(alpi_gltf_reader *reader, const alpi_gltf_pose *pose,
                        const alpi_gltf_posed *posed, const influences *all, float (*vertices)[3])
{
    for (uint32_t i = 0; i < posed->vertex_count; i++) {
        mat4 matrix = *posed->world;
        if (all->set_count > 0) {
            ALP_TRY(blend(reader, pose, posed, all, i, &matrix));
        }
        vec3 v = vec3_load(vertices[i]);
        vec3_store(vertices[i], posed->normals ? mat4_transform_normal(&matrix, v)
                                               : mat4_transform_point(&matrix, v));
    }
    return ALP_OK;
}

static alp_result pose_vertices(alpi_gltf_reader *reader, const alpi_gltf_pose *pose,
                                const alpi_gltf_posed *posed, influences *all, float (*vertices)[3])
{
    ALP_TRY(add_vectors(reader, posed, posed->accessor, 1.0f, vertices));
    ALP_TRY(morph(reader, pose, posed, vertices));
    if (pose->joints != NULL) {
        ALP_TRY(read_influences(reader, posed, all));
    }
    return place(reader, pose, posed, all, vertices);
}

alp_result alpi_gltf_pose_vertices(alpi_gltf_reader *reader, const alpi_gltf_pose *pose,
                                   const alpi_gltf_posed *posed, float (**vertices)[3])
{
    influences all = {0};
    *vertices = alpi_allocate(reader->context, posed->vertex_count, sizeof **vertices);
    if (*vertices == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    alp_result result = pose_vertices(reader, pose, posed, &all, *vertices);
    for (uint32_t set = 0; set < INFLUENCE_SET_LIMIT; set++) {
        alpi_release(reader->context, all.joints[set].bytes);
        alpi_release(reader->context, all.weights[set].bytes);
    }
    if (result != ALP_OK) {
        alpi_release(reader->context, *vertices);
        *vertices = NULL;
    }
    return result;
}
