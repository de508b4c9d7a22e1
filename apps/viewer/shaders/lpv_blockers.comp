#version 450 core
// Injects the blockers of a map into the view that is being made: B(w) = A/s^2 (1/4 + n.w/2), and
// albedo times opacity.
#include "lpv_places.glsl"

layout(local_size_x = LPV_MAP_GROUP, local_size_y = LPV_MAP_GROUP) in;

layout(std430, binding = BUFFER_LPV_VIEW) buffer view_of_blockers {
    int view[]; // [cascade][z][y][x][LPV_NODE_TERMS], in units of LPV_OPACITY_UNIT
};
layout(location = UNIFORM_LPV_ONLY) uniform bool only; // the grid of the map alone

void main()
{
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, textureSize(map_positions, 0)))) {
        return;
    }
    vec4 position = texelFetch(map_positions, texel, 0), normal = texelFetch(map_normals, texel, 0);
    vec3 albedo = texelFetch(map_albedos, texel, 0).rgb;
    ivec3 ends = grid_size + 1;
    if (normal.a <= 0.0) {
        return;
    }
    int first = max(map_cascade, 0), last = only ? first : cascades - 1;
    for (int c = first; c <= last; c++) {
        grid_place p;
        bool small = position.a > 0.0 && 2.0 * position.a < cell_of(c);
        if (small || !find_place(c, position.xyz, normal.xyz, true, p)) {
            continue;
        }
        float opacity = normal.a / (cell_of(c) * cell_of(c)) / LPV_OPACITY_UNIT;
        for (int number = 0; number < 8; number++) {
            float share;
            ivec3 at = corner_of(p, number, share);
            if (share <= 0.0 || any(lessThan(at, ivec3(0))) || any(greaterThanEqual(at, ends))) {
                continue;
            }
            int node = LPV_NODE_TERMS * (((c * ends.z + at.z) * ends.y + at.y) * ends.x + at.x);
            float scale = min(share * opacity, LPV_OPACITY_MOST / LPV_OPACITY_UNIT);
            ivec4 lobe = ivec4(round(scale * vec4(0.25, 0.5 * normal.xyz)));
            ivec3 color = ivec3(round(0.25 * scale * albedo));
            for (int term = 0; term < 4; term++) {
                atomicAdd(view[node + term], lobe[term]);
            }
            for (int k = 0; k < 3; k++) {
                atomicAdd(view[node + 4 + k], color[k]);
            }
        }
    }
}
