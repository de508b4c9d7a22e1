// SPDX-License-Identifier: MIT
// EXT_mesh_gpu_instancing: a node that shows its mesh many times, each with a transform of its own.
#include "formats/gltf/gltf_read.h"

#include "base/memory.h"
#include "formats/gltf/gltf_accessor.h"
#include "formats/gltf/gltf_tree.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

json_t *alpi_gltf_instancing(json_t *node)
{
    json_t *extension = alpi_gltf_extension(node, "EXT_mesh_gpu_instancing");
    json_t *attributes = json_object_get(extension, "attributes");
    bool placed = json_object_get(attributes, "TRANSLATION") != NULL ||
                  json_object_get(attributes, "ROTATION") != NULL ||
                  json_object_get(attributes, "SCALE") != NULL;
    return placed && json_object_get(node, "skin") == NULL ? attributes : NULL;
}

/// Where the values of one attribute go: a member of alpi_gltf_instance.
typedef struct target {
    const char *name;
    uint32_t components;
    size_t offset;
} target;

static const target targets[] = {
    {"TRANSLATION", 3, offsetof(alpi_gltf_instance, translation)},
    {"ROTATION", 4, offsetof(alpi_gltf_instance, rotation)},
    {"SCALE", 3, offsetof(alpi_gltf_instance, scale)},
};
enum { TARGET_COUNT = sizeof targets / sizeof *targets };

/// The number of instances, the same in every attribute.
static alp_result count_instances(const alpi_gltf_document *document, json_t *attributes,
                                  const char *owner, uint32_t *count)
{
    *count = 0;
    bool known = false;
    for (size_t i = 0; i < TARGET_COUNT; i++) {
        size_t accessor;
        alpi_gltf_values values;
        ALP_TRY(
            alpi_gltf_index(document, attributes, targets[i].name, "accessors", owner, &accessor));
        if (accessor == ALPI_GLTF_NONE) {
            continue;
        }
        ALP_TRY(alpi_gltf_accessor_check(document, accessor, &values));
        if (values.components != targets[i].components || (known && values.count != *count)) {
            return alpi_gltf_fail(document, owner,
                                  "its instances' %s (accessor %zu) has %u elements of %u "
                                  "components",
                                  targets[i].name, accessor, values.count, values.components);
        }
        *count = values.count;
        known = true;
    }
    if (*count > ALPI_GLTF_SURFACE_LIMIT) {
        return alpi_fail(document->context, ALP_ERROR_LIMIT,
                         "%s: %s: %u instances, more than the limit of %d", document->path, owner,
                         *count, ALPI_GLTF_SURFACE_LIMIT);
    }
    return ALP_OK;
}

static alp_result fill(const alpi_gltf_document *document, json_t *attributes, const char *owner,
                       const target *to, alpi_gltf_instance *instances)
{
    size_t accessor;
    alpi_gltf_values values;
    ALP_TRY(alpi_gltf_index(document, attributes, to->name, "accessors", owner, &accessor));
    if (accessor == ALPI_GLTF_NONE) {
        return ALP_OK;
    }
    ALP_TRY(alpi_gltf_accessor_read(document, accessor, &values));
    for (uint32_t i = 0; i < values.count; i++) {
        double *place = (double *)(void *)((char *)&instances[i] + to->offset);
        for (uint32_t k = 0; k < to->components; k++) {
            place[k] = (double)alpi_gltf_values_float(&values, i, k);
        }
    }
    alpi_release(document->context, values.bytes);
    return ALP_OK;
}

/// Rotations of bytes are unit only roughly; one that is no quaternion turns nothing.
static uint32_t normalize(alpi_gltf_instance *instances, uint32_t count)
{
    uint32_t bad = 0;
    for (uint32_t i = 0; i < count; i++) {
        double *q = instances[i].rotation;
        double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
        bool good = length > 0.0 && isfinite(length);
        for (int k = 0; k < 4; k++) {
            q[k] = good ? q[k] / length : k == 3;
        }
        bad += !good;
    }
    return bad;
}

/// One that is nowhere, or as large as nothing, is shown as a point: its triangles have no area.
static uint32_t shrink_unplaced(alpi_gltf_instance *instances, uint32_t count)
{
    uint32_t bad = 0;
    for (uint32_t i = 0; i < count; i++) {
        double *t = instances[i].translation, *s = instances[i].scale, sum = 0.0;
        for (int k = 0; k < 3; k++) {
            sum += fabs(t[k]) + fabs(s[k]); // of floats: finite if they are
        }
        if (!isfinite(sum)) {
            memset(t, 0, 3 * sizeof *t);
            memset(s, 0, 3 * sizeof *s);
            bad++;
        }
    }
    return bad;
}

alp_result alpi_gltf_read_instances(const alpi_gltf_document *document, size_t node,
                                    alpi_gltf_instance **instances, uint32_t *count)
{
    json_t *attributes = alpi_gltf_instancing(alpi_gltf_item(document, "nodes", node));
    char owner[ALPI_GLTF_OWNER_SIZE];
    snprintf(owner, sizeof owner, "node %zu", node);
    *instances = NULL;
    *count = 0;
    if (attributes == NULL) {
        return ALP_OK;
    }
    ALP_TRY(count_instances(document, attributes, owner, count));
    alpi_gltf_instance *list = ALPI_NEW(document->context, alpi_gltf_instance, *count);
    if (list == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < *count; i++) {
        list[i] = (alpi_gltf_instance){{0, 0, 0}, {0, 0, 0, 1}, {1, 1, 1}};
    }
    alp_result result = ALP_OK;
    for (size_t i = 0; i < TARGET_COUNT && result == ALP_OK; i++) {
        result = fill(document, attributes, owner, &targets[i], list);
    }
    if (result != ALP_OK) {
        alpi_release(document->context, list);
        return result;
    }
    uint32_t bad = normalize(list, *count);
    if (bad > 0) {
        alpi_warn(document->context, "rotation", owner,
                  "its instances whose rotation is not a quaternion, and that are not rotated: %u",
                  bad);
    }
    bad = shrink_unplaced(list, *count);
    if (bad > 0) {
        alpi_warn(document->context, "bad-coordinates", owner,
                  "its instances left out because their translation or scale is not finite: %u",
                  bad);
    }
    *instances = list;
    return ALP_OK;
}
