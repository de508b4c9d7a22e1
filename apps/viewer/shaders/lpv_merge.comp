#version 450 core
// Adds a view to the merged blockers, and clears it. Views show the same surfaces. A view without
// surface at a node does not count there.
#include "lpv_grid.glsl"

layout(local_size_x = LPV_GROUP_X, local_size_y = LPV_GROUP_Y, local_size_z = LPV_GROUP_Z) in;

layout(std430, binding = BUFFER_LPV_VIEW) buffer view_of_blockers { int view[]; };
layout(rgba32f, binding = 0) uniform image3D opacities;
layout(rgba32f, binding = 1) uniform image3D albedos;

void main()
{
    ivec3 at = ivec3(gl_GlobalInvocationID), size = ivec3(grid_size.xy + 1, axis_step().z);
    if (any(greaterThanEqual(at, size))) {
        return;
    }
    int node = LPV_NODE_TERMS * ((at.z * size.y + at.y) * size.x + at.x);
    float terms[LPV_NODE_TERMS];
    for (int t = 0; t < LPV_NODE_TERMS; t++) {
        terms[t] = LPV_OPACITY_UNIT * float(view[node + t]);
        view[node + t] = 0;
    }
    vec4 b = vec4(terms[0], terms[1], terms[2], terms[3]);
    vec4 color = vec4(terms[4], terms[5], terms[6], 0.0);
    vec4 kept = imageLoad(opacities, at), kept_color = imageLoad(albedos, at);
    if (!lpv_by_angle && b.x > 0.0 && kept.x > 0.0) { // as the paper does
        b = max(b, kept);
        color = max(color, kept_color);
    } else if (b.x <= kept.x) { // the view with more surface has the node
        return;
    }
    imageStore(opacities, at, b);
    imageStore(albedos, at, color);
}
