#version 450 core
// Nodes to the low faces of cells: opacity, and the albedo of what blocks there.
#include "lpv_grid.glsl"

layout(local_size_x = LPV_GROUP_X, local_size_y = LPV_GROUP_Y, local_size_z = LPV_GROUP_Z) in;

// Nodes lie at the corners of cells: one more along each axis.
layout(binding = 0) uniform sampler3D opacities; // B(w) = p.x + p.yzw . w
layout(binding = 1) uniform sampler3D albedos;   // times p.x
// By the axis that the face lies across.
layout(rgba32f, binding = 0) writeonly uniform image3D faces[3];  // p.x, and along the three axes
layout(rgba32f, binding = 3) writeonly uniform image3D colors[3]; // albedo

void main()
{
    ivec3 at = ivec3(gl_GlobalInvocationID), size = imageSize(faces[0]);
    if (any(greaterThanEqual(at, size))) {
        return;
    }
    int z = at.z % (grid_size.z + 1);
    for (int axis = 0; axis < 3; axis++) {
        vec4 b = vec4(0.0);
        vec3 color = vec3(0.0);
        for (int corner = 0; corner < 4; corner++) {
            ivec3 step = ivec3(0), axes = axes_of(axis);
            step[axes.y] = corner & 1;
            step[axes.z] = corner >> 1;
            // Faces beyond the last cell of another axis belong to no cell.
            step *= ivec3(lessThan(ivec3(at.xy, z), grid_size));
            b += texelFetch(opacities, at + step, 0);
            color += texelFetch(albedos, at + step, 0).rgb;
        }
        float sum = b.x;
        if (lpv_by_angle) { // surfaces of one orientation stop A n.w, and the rest half of all
            b.yzw *= 0.5 * lpv_opacity;
            b.x = max(0.5 * (lpv_opacity * sum - length(b.yzw)), 0.0);
        } else {
            b *= 0.25 * lpv_opacity;
        }
        imageStore(faces[axis], at, b);
        imageStore(colors[axis], at, vec4(sum > 0.0 ? color / sum : vec3(0.0), 0.0));
    }
}
