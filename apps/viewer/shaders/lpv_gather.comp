#version 450 core
// Adds the light of a map, which was counted in its own units, to that of the maps before, and
// clears the counts.
#include "lpv_grid.glsl"

layout(local_size_x = LPV_GROUP_X, local_size_y = LPV_GROUP_Y, local_size_z = LPV_GROUP_Z) in;

layout(std430, binding = BUFFER_LPV_COUNTS) buffer light_counts {
    int counts[]; // [cascade][z][y][x][channel][term], in units
};
layout(location = UNIFORM_LPV_UNITS) uniform vec3 units; // of the channels, W/sr
layout(rgba32f, binding = 0) uniform image3D injected;

void main()
{
    ivec3 at = ivec3(gl_GlobalInvocationID), size = ivec3(grid_size.xy, channel_step().z);
    if (any(greaterThanEqual(at, size))) {
        return;
    }
    int cell = ((at.z * size.y + at.y) * size.x + at.x) * 12;
    for (int channel = 0; channel < 3; channel++) {
        int first = cell + 4 * channel;
        ivec4 p = ivec4(counts[first], counts[first + 1], counts[first + 2], counts[first + 3]);
        if (p != ivec4(0)) {
            ivec3 to = at + channel * channel_step();
            imageStore(injected, to, imageLoad(injected, to) + units[channel] * vec4(p));
            for (int term = 0; term < 4; term++) {
                counts[first + term] = 0;
            }
        }
    }
}
