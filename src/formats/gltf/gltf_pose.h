// SPDX-License-Identifier: MIT
// Skins and morph targets, which move vertices before the transform of their node.
#ifndef ALPI_FORMATS_GLTF_POSE_H
#define ALPI_FORMATS_GLTF_POSE_H

#include "formats/gltf/gltf_read.h"

typedef struct alpi_gltf_pose {
    mat4 *joints; // [joint_count] of mesh space to the world; NULL = no skin
    uint32_t joint_count;
    double *weights; // [weight_count] of morph targets, not all 0; NULL = none
    uint32_t weight_count;
} alpi_gltf_pose;

/// The pose of a node's mesh. A skin whose joints are not all in the scene is left out, with a
/// warning if `tell`.
alp_result alpi_gltf_pose_create(alpi_gltf_reader *reader, uint32_t node, bool tell,
                                 alpi_gltf_pose *pose);
void alpi_gltf_pose_destroy(alpi_gltf_reader *reader, alpi_gltf_pose *pose);

/// A primitive whose vertices are to be posed.
typedef struct alpi_gltf_posed {
    json_t *primitive;
    const char *owner;
    uint32_t vertex_count;
    const mat4 *world; // of the node: places what no skin does
    bool normals;      // NORMAL, else POSITION
    size_t accessor;   // of it
} alpi_gltf_posed;
/// Its positions or unit normals in the world; released by the caller.
alp_result alpi_gltf_pose_vertices(alpi_gltf_reader *reader, const alpi_gltf_pose *pose,
                                   const alpi_gltf_posed *posed, float (**vertices)[3]);

#endif
