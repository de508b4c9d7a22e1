// SPDX-License-Identifier: MIT
// Animations of a glTF: its list for the scene, and where one of them places the nodes.
#ifndef ALPI_FORMATS_GLTF_ANIMATION_H
#define ALPI_FORMATS_GLTF_ANIMATION_H

#include "formats/gltf/gltf_read.h"

/// Members of a node.
typedef enum alpi_gltf_member {
    ALPI_GLTF_TRANSLATION = 0,
    ALPI_GLTF_ROTATION,
    ALPI_GLTF_SCALE,
    ALPI_GLTF_WEIGHTS, // of morph targets
    ALPI_GLTF_MEMBER_COUNT
} alpi_gltf_member;

/// A moment of an animation, for a node: members that it sets.
typedef struct alpi_gltf_moment {
    bool set[ALPI_GLTF_MEMBER_COUNT];
    double translation[3], rotation[4], scale[3]; // rotation: unit
    double *weights;                              // [weight_count]
    uint32_t weight_count;
} alpi_gltf_moment;

/// Lists the animations in reader.scene. A channel with a fault costs a warning and is left out.
alp_result alpi_gltf_read_animations(alpi_gltf_reader *reader);
/// Fills reader.moments with a moment of animation `index` of the document. Warns as above.
alp_result alpi_gltf_read_moments(alpi_gltf_reader *reader, size_t index, double seconds);
void alpi_gltf_release_moments(alpi_gltf_reader *reader);

#endif
