#version 450 core
// Injects the light of a map: each surfel is a cosine lobe of flux F, F/pi (1/4 + n.w/2), half a
// cell above its surface. Whole numbers are added, so that sums do not depend on their order.
#include "lpv_places.glsl"

layout(local_size_x = LPV_MAP_GROUP, local_size_y = LPV_MAP_GROUP) in;

layout(std430, binding = BUFFER_LPV_COUNTS) buffer light_counts {
    int counts[]; // [cascade][z][y][x][channel][term], in units
};
layout(location = UNIFORM_LPV_UNITS) uniform vec3 units;

void main()
{
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, textureSize(map_positions, 0)))) {
        return;
    }
    vec4 position = texelFetch(map_positions, texel, 0), normal = texelFetch(map_normals, texel, 0);
    vec3 flux = texelFetch(map_flux, texel, 0).rgb;
    if (max(flux.r, max(flux.g, flux.b)) <= 0.0) {
        return;
    }
    for (int c = max(map_cascade, 0); c < cascades; c++) {
        grid_place p;
        bool small = position.a > 0.0 && 2.0 * position.a < cell_of(c);
        if (small || !find_place(c, position.xyz, normal.xyz, false, p)) {
            continue;
        }
        vec3 scale = light_share(c, position.xyz) / 3.14159265 * flux / units;
        for (int number = 0; number < 8; number++) {
            float share;
            ivec3 at = corner_of(p, number, share);
            if (share <= 0.0) {
                continue;
            }
            int cell = ((c * grid_size.z + at.z) * grid_size.y + at.y) * grid_size.x + at.x;
            for (int channel = 0; channel < 3; channel++) {
                ivec4 lobe = ivec4(round(share * scale[channel] *
                                         vec4(0.25, 0.5 * normal.xyz)));
                int first = 12 * cell + 4 * channel;
                for (int term = 0; term < 4; term++) {
                    atomicAdd(counts[first + term], lobe[term]);
                }
            }
        }
    }
}
