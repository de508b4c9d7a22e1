#version 450 core
// Nodes to the low faces of cells: opacity, and the albedo of what blocks there.
#include "lpv_grid.glsl"

layout(local_size_x = LPV_GROUP_X, local_size_y = LPV_GROUP_Y, local_size_z = LPV_GROUP_Z) in;

// Nodes lie at the corners of cells: one more along each axis.
layout(binding = 0) uniform sampler3D opacities; // B(w) = p.x + p.yzw . w
layout(binding = 1) uniform sampler3D albedos;   // times p.x
layout(rgba32f, binding = 0) writeonly uniform image3D faces; // p.x, and along the three axes
layout(rgba32f, binding = 1) writeonly uniform image3D colors; // albedo

void main()
{
    ivec3 at = ivec3(gl_GlobalInvocationID), size = ivec3(grid_size.xy + 1, axis_step().z);
    if (any(greaterThanEqual(at, size))) {
        return;
    }
    int z = at.z % (grid_size.z + 1);
    for (int axis = 0; axis < 3; axis++) {
        vec4 b = vec4(0.0);
        vec3 color = vec3(0.0);
        for (int corner = 0; corner < 4; corner++) {
            ivec3 step = (corner & 1) * unit_of((axis + 1) % 3) +
                         (corner >> 1) * unit_of((axis + 2) % 3);
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
        imageStore(faces, at + axis * axis_step(), b);
        imageStore(colors, at + axis * axis_step(),
                   vec4(sum > 0.0 ? color / sum : vec3(0.0), 0.0));
    }
}
