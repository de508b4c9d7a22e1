// Ambient models: E by the normal, of the ground map by the place too. The formulas are those of
// alp_ambient_model (alpenglow/field.h).
#include "place.glsl"
#include "shared_constants.h"

layout(std430, binding = BUFFER_AMBIENT) readonly buffer ambient_model {
    vec4 ambient_colors[9];
    vec4 ground_place;   // low x, low z, and texels a metre along x and z
    vec4 ground_texels[]; // [side][side] radiosity
};

layout(location = UNIFORM_AMBIENT) uniform int ambient_kind; // an alp_ambient_model

// An alp_ambient_model.
const int AMBIENT_CONSTANT = 0, AMBIENT_HEMISPHERE = 1, AMBIENT_GROUND_MAP = 2, AMBIENT_CUBE = 3;

/// Bilinear; positions beyond the bounds read the nearest texel.
vec3 read_ground(vec2 position)
{
    const int side = ALP_GROUND_MAP_SIDE;
    vec2 at = clamp((position - ground_place.xy) * ground_place.zw - 0.5, 0.0, float(side - 1));
    ivec2 cell = min(ivec2(at), side - 2);
    vec2 share = at - vec2(cell);
    int i = cell.y * side + cell.x;
    vec3 near = mix(ground_texels[i].rgb, ground_texels[i + 1].rgb, share.x);
    vec3 far = mix(ground_texels[i + side].rgb, ground_texels[i + side + 1].rgb, share.x);
    return mix(near, far, share.y);
}

vec3 read_cube(vec3 n)
{
    vec3 square = n * n;
    return square.x * ambient_colors[n.x > 0.0 ? 0 : 1].rgb +
           square.y * ambient_colors[n.y > 0.0 ? 2 : 3].rgb +
           square.z * ambient_colors[n.z > 0.0 ? 4 : 5].rgb;
}

vec3 read_harmonics(vec3 n)
{
    float weights[9] = float[9](
        ALP_SH_A0 * ALP_SH_Y0, ALP_SH_A1 * ALP_SH_Y1 * n.y, ALP_SH_A1 * ALP_SH_Y1 * n.z,
        ALP_SH_A1 * ALP_SH_Y1 * n.x, ALP_SH_A2 * ALP_SH_Y2 * n.x * n.y,
        ALP_SH_A2 * ALP_SH_Y2 * n.y * n.z, ALP_SH_A2 * ALP_SH_Y20 * (3.0 * n.z * n.z - 1.0),
        ALP_SH_A2 * ALP_SH_Y2 * n.x * n.z, ALP_SH_A2 * ALP_SH_Y22 * (n.x * n.x - n.y * n.y));
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 9; i++) {
        sum += weights[i] * ambient_colors[i].rgb;
    }
    return sum;
}

vec3 ambient_irradiance(place p)
{
    float up = 0.5 * (1.0 + p.normal.y), down = 0.5 * (1.0 - p.normal.y);
    vec3 sky = up * ambient_colors[0].rgb + down * ambient_colors[1].rgb;
    vec3 e = ambient_kind == AMBIENT_CONSTANT     ? ambient_colors[0].rgb
             : ambient_kind == AMBIENT_HEMISPHERE ? sky
             : ambient_kind == AMBIENT_GROUND_MAP
                 ? sky + down * ambient_colors[2].rgb * read_ground(p.position.xz)
             : ambient_kind == AMBIENT_CUBE ? read_cube(p.normal)
                                            : read_harmonics(p.normal);
    return max(e, 0.0);
}
