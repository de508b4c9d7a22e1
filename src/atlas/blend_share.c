// SPDX-License-Identifier: MIT
// Weights of overlapping charts at a point of a triangle.
#include "atlas/blend.h"

void alpi_blend_weights(const alp_atlas *atlas, uint32_t triangle, float b1, float b2,
                        float weights[3])
{
    alpi_surface_weights(atlas->scene, atlas->world_axes, triangle, b1, b2, weights);
}

float alpi_blend_share(const alp_atlas *atlas, uint32_t face, const float barycentrics[2])
{
    const uint32_t triangle = atlas->face_triangles[face];
    const uint8_t members = atlas->set_members[triangle];
    float weights[3], share = 0.0f;
    alpi_blend_weights(atlas, triangle, barycentrics[0], barycentrics[1], weights);
    for (int k = 0; k < 3; k++) { // sets that it is not in are read from its first face
        const bool is_in = (members >> k & 1u) != 0;
        share += (is_in ? atlas->face_axes[face] == k : face == triangle) ? weights[k] : 0.0f;
    }
    return share;
}
