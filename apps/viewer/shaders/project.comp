#version 450 core
// Projects eight rows of a face of a cube map to nine spherical harmonics of radiance. Additions
// have a fixed order, so that the result is the same in each run.
#include "bindings.h"
#include "shared_constants.h"

const int LANES = 64, ROWS = 8;
layout(local_size_x = LANES) in;

layout(binding = TEXTURE_PICTURE) uniform sampler2DArray faces;
layout(std430, binding = BUFFER_SH_PARTS) writeonly buffer part_list {
    float parts[]; // [part][9][3]
};

shared float lane_sums[27][LANES];

/// Directions of faces, as alp_cube_face has them.
vec3 direction_of(vec2 at, int face)
{
    switch (face) {
    case 0:
        return vec3(1.0, -at.y, -at.x);
    case 1:
        return vec3(-1.0, -at.y, at.x);
    case 2:
        return vec3(at.x, 1.0, at.y);
    case 3:
        return vec3(at.x, -1.0, -at.y);
    case 4:
        return vec3(at.x, -at.y, 1.0);
    default:
        return vec3(-at.x, -at.y, -1.0);
    }
}

void add_basis(vec3 d, float weight, inout float sums[9])
{
    sums[0] += weight * ALP_SH_Y0;
    sums[1] += weight * ALP_SH_Y1 * d.y;
    sums[2] += weight * ALP_SH_Y1 * d.z;
    sums[3] += weight * ALP_SH_Y1 * d.x;
    sums[4] += weight * ALP_SH_Y2 * d.x * d.y;
    sums[5] += weight * ALP_SH_Y2 * d.y * d.z;
    sums[6] += weight * ALP_SH_Y20 * (3.0 * d.z * d.z - 1.0);
    sums[7] += weight * ALP_SH_Y2 * d.x * d.z;
    sums[8] += weight * ALP_SH_Y22 * (d.x * d.x - d.y * d.y);
}

/// Integrals of the basis over the solid angle of a texel, by 3 x 3 points of Gauss: dw =
/// ds dt / (1 + s^2 + t^2)^(3/2). In faces of 16 x 16 texels their error is that of floats.
void integrate_basis(ivec2 texel, int face, int side, out float sums[9])
{
    const float nodes[3] = float[3](-0.774596669, 0.0, 0.774596669);
    const float weights[3] = float[3](0.277777778, 0.444444444, 0.277777778);
    float width = 2.0 / float(side);
    sums = float[9](0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for (int i = 0; i < 9; i++) {
        vec2 inside = 0.5 + 0.5 * vec2(nodes[i % 3], nodes[i / 3]);
        vec3 d = direction_of(width * (vec2(texel) + inside) - 1.0, face);
        float near = inversesqrt(dot(d, d));
        float area = width * width * weights[i % 3] * weights[i / 3];
        add_basis(near * d, area * near * near * near, sums);
    }
}

/// Adds the sums of all lanes into lane 0.
void add_lanes(uint lane)
{
    for (uint half_count = uint(LANES) / 2u; half_count > 0u; half_count /= 2u) {
        barrier();
        for (int k = 0; k < 27 && lane < half_count; k++) {
            lane_sums[k][lane] += lane_sums[k][lane + half_count];
        }
    }
    barrier();
}

void main()
{
    int side = textureSize(faces, 0).x, face = int(gl_WorkGroupID.y);
    int first = int(gl_WorkGroupID.x) * ROWS;
    uint lane = gl_LocalInvocationID.x;
    vec3 sums[9];
    for (int k = 0; k < 9; k++) {
        sums[k] = vec3(0.0);
    }
    for (int i = int(lane); i < ROWS * side; i += LANES) {
        ivec2 texel = ivec2(i % side, first + i / side);
        if (texel.y < side) {
            vec4 light = texelFetch(faces, ivec3(texel, face), 0);
            float basis[9];
            integrate_basis(texel, face, side, basis);
            for (int k = 0; k < 9; k++) {
                sums[k] += basis[k] * light.a * light.rgb;
            }
        }
    }
    for (int k = 0; k < 27; k++) {
        lane_sums[k][lane] = sums[k / 3][k % 3];
    }
    add_lanes(lane);
    uint part = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (lane < 27u) {
        parts[27u * part + lane] = lane_sums[lane][0];
    }
}
