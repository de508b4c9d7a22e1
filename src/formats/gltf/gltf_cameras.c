// SPDX-License-Identifier: MIT
// Perspective cameras of the scene's nodes. glTF cameras look along their −Z with +Y up.
#include "formats/gltf/gltf_read.h"

#include "base/memory.h"
#include "formats/gltf/gltf_tree.h"

#include <stdio.h>
#include <string.h>

/// *usable is false for what is skipped.
static alp_result read_camera(const alpi_gltf_reader *reader, size_t index, const mat4 *world,
                              alp_camera *camera, bool *usable)
{
    char owner[ALPI_GLTF_OWNER_SIZE];
    snprintf(owner, sizeof owner, "camera %zu", index);
    json_t *object = alpi_gltf_item(reader->document, "cameras", index);
    const char *type = alpi_gltf_text(object, "type");
    *usable = type != NULL && strcmp(type, "perspective") == 0;
    if (!*usable) {
        alpi_note(reader->context, "camera", owner, "left out: only perspective cameras are read");
        return ALP_OK;
    }
    double fov = -1.0;
    ALP_TRY(alpi_gltf_number(reader->document, json_object_get(object, "perspective"), "yfov",
                             owner, &fov));
    vec3 zero = {0.0f, 0.0f, 0.0f};
    vec3 origin = mat4_transform_point(world, zero);
    vec3 forward =
        vec3_normalize_or(mat4_transform_direction(world, (vec3){0.0f, 0.0f, -1.0f}), zero);
    vec3 up = vec3_normalize_or(mat4_transform_direction(world, (vec3){0.0f, 1.0f, 0.0f}), zero);
    vec3 target = vec3_add(origin, forward);
    *usable = fov > 0.0 && fov < ALPI_PI && vec3_is_finite(target) &&
              vec3_length(vec3_sub(target, origin)) > 0.5f && // far away a step of 1 m rounds off
              vec3_length(vec3_cross(forward, up)) > 1e-4f;
    if (!*usable) {
        alpi_warn(reader->context, "camera", owner,
                  "left out: its field of view or its node's transform cannot be used");
        return ALP_OK;
    }
    vec3_store(camera->position, origin);
    vec3_store(camera->target, target);
    vec3_store(camera->up, up);
    camera->vertical_fov = (float)fov;
    return ALP_OK;
}

alp_result alpi_gltf_read_cameras(alpi_gltf_reader *reader)
{
    alp_scene *scene = reader->scene;
    ALPI_TRY_NEW(reader->context, scene->cameras, reader->order_count);
    for (uint32_t i = 0; i < reader->order_count; i++) {
        uint32_t node = reader->order[i];
        char owner[ALPI_GLTF_OWNER_SIZE];
        snprintf(owner, sizeof owner, "node %u", node);
        size_t index;
        ALP_TRY(alpi_gltf_index(reader->document, alpi_gltf_item(reader->document, "nodes", node),
                                "camera", "cameras", owner, &index));
        bool usable = false;
        if (index != ALPI_GLTF_NONE) {
            ALP_TRY(read_camera(reader, index, &reader->world[node],
                                &scene->cameras[scene->camera_count], &usable));
        }
        scene->camera_count += usable;
    }
    return ALP_OK;
}
