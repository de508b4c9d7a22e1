#version 450 core
// Turns the injected light into the light that travels first, and into the sum.
#include "lpv_grid.glsl"

layout(local_size_x = LPV_GROUP_X, local_size_y = LPV_GROUP_Y, local_size_z = LPV_GROUP_Z) in;

layout(binding = 0) uniform sampler3D injected;
layout(rgba32f, binding = 0) writeonly uniform image3D light;
layout(rgba32f, binding = 1) writeonly uniform image3D sum;

void main()
{
    ivec3 at = ivec3(gl_GlobalInvocationID), size = ivec3(grid_size.xy, 3 * channel_step().z);
    if (any(greaterThanEqual(at, size))) {
        return;
    }
    vec4 p = texelFetch(injected, at, 0);
    imageStore(light, at, scale_light(p));
    imageStore(sum, at, p);
}
