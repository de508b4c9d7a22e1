#version 450 core
// What was injected, to the light that travels first, and to the sum.
#include "lpv_grid.glsl"

layout(local_size_x = LPV_GROUP_X, local_size_y = LPV_GROUP_Y, local_size_z = LPV_GROUP_Z) in;

layout(std430, binding = BUFFER_LPV_INJECTED) readonly buffer injected_light {
    int injected[]; // [cascade][z][y][x][channel][term], in units
};
layout(location = UNIFORM_LPV_UNITS) uniform vec3 units; // of the channels, W/sr
layout(rgba32f, binding = 0) writeonly uniform image3D light;
layout(rgba32f, binding = 1) writeonly uniform image3D sum;

void main()
{
    ivec3 at = ivec3(gl_GlobalInvocationID), size = ivec3(grid_size.xy, channel_step().z);
    if (any(greaterThanEqual(at, size))) {
        return;
    }
    int cell = ((at.z * size.y + at.y) * size.x + at.x) * 12;
    for (int channel = 0; channel < 3; channel++) {
        int first = cell + 4 * channel;
        vec4 p = units[channel] * vec4(injected[first], injected[first + 1], injected[first + 2],
                                       injected[first + 3]);
        imageStore(light, at + channel * channel_step(), scale_light(p));
        imageStore(sum, at + channel * channel_step(), p);
    }
}
