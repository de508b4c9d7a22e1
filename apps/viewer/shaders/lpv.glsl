// Reads light propagation at surfaces, along mirrored rays and in air: as lpv_field.c of the
// library.
#include "lpv_cascades.glsl"

layout(binding = TEXTURE_LPV_SUM) uniform sampler3D lpv_sum;

/// Trilinear mean of the cells round a point, / 1.5 s^2: radiance L(w) = p.x + p.yzw . w of light
/// that travels along w. Beyond the grid its edge. By texel fetches, for texture units round
/// weights to 1/256.
void read_grid(int cascade, vec3 position, out vec4 light[3])
{
    float cell = cell_of(cascade);
    vec3 at = clamp(position / cell - corners[cascade] - 0.5, vec3(0.0), vec3(grid_size - 1));
    ivec3 low = ivec3(at), step = ivec3(lessThan(low + 1, grid_size));
    vec3 part = at - vec3(low);
    for (int channel = 0; channel < 3; channel++) {
        light[channel] = vec4(0.0);
    }
    for (int corner = 0; corner < 8; corner++) {
        ivec3 upper = ivec3(corner, corner >> 1, corner >> 2) & 1;
        vec3 share = mix(1.0 - part, part, equal(upper, ivec3(1)));
        ivec3 from = low + upper * step + ivec3(0, 0, cascade * grid_size.z);
        for (int channel = 0; channel < 3; channel++) {
            light[channel] += share.x * share.y * share.z / (ALP_LPV_GAIN * cell * cell) *
                              texelFetch(lpv_sum, from + channel * channel_step(), 0);
        }
    }
}

/// Shares of the grids at a point: the finest first, the coarsest takes the rest.
float grid_share(int cascade, vec3 position, inout float left)
{
    float share = cascade + 1 == cascades
                      ? left
                      : left * share_of(cascade, position, ALP_LPV_READING_BORDER);
    left -= share;
    return share;
}

/// Light that fades along the normal comes from the surface itself or through it. Its share that
/// counts: 1 + cos of the angle between the light and its change over a cell along the normal.
float find_damping(vec4 here, vec4 change)
{
    float size = dot(here, here), small = 0.3;
    if (lpv_by_angle || size <= 0.0) { // accurate light needs no damping
        return 1.0;
    }
    return clamp(1.0 + dot(here, change) / (sqrt(size * dot(change, change)) + small * size), 0.0,
                 1.0);
}

/// E at a surface.
vec3 lpv_irradiance(vec3 position, vec3 normal)
{
    vec3 sum = vec3(0.0);
    float left = 1.0;
    for (int c = 0; c < cascades; c++) {
        float share = grid_share(c, position, left);
        if (share > 0.0) {
            vec3 half_cell = 0.5 * cell_of(c) * normal, at = position + 2.0 * ALP_LPV_LIFT * half_cell;
            vec4 here[3], below[3], above[3];
            read_grid(c, at, here);
            read_grid(c, at - half_cell, below);
            read_grid(c, at + half_cell, above);
            for (int k = 0; k < 3; k++) {
                float e = 3.14159265 * (here[k].x - 2.0 / 3.0 * dot(here[k].yzw, normal));
                sum[k] += share * find_damping(here[k], above[k] - below[k]) * max(e, 0.0);
            }
        }
    }
    return sum;
}

/// Light of all grids at a point.
void read_volume(vec3 position, out vec4 light[3])
{
    float left = 1.0;
    light[0] = light[1] = light[2] = vec4(0.0);
    for (int c = 0; c < cascades; c++) {
        float share = grid_share(c, position, left);
        vec4 own[3];
        if (share > 0.0) {
            read_grid(c, position, own);
            for (int k = 0; k < 3; k++) {
                light[k] += share * own[k];
            }
        }
    }
}

/// Radiance that arrives from a direction: intensities along the way, four cells far.
vec3 lpv_radiance(vec3 position, vec3 direction)
{
    float left = 1.0, cell = 0.0, weights = 0.0;
    vec3 sum = vec3(0.0);
    for (int c = 0; c < cascades; c++) {
        cell += grid_share(c, position, left) * cell_of(c);
    }
    for (int i = 1; i <= 4; i++) {
        vec4 light[3];
        float weight = 1.0 / float(i * i);
        read_volume(position + float(i) * cell * direction, light);
        for (int k = 0; k < 3; k++) {
            sum[k] += weight * max(light[k].x - dot(light[k].yzw, direction), 0.0);
        }
        weights += weight;
    }
    return sum / weights;
}

/// Fluence: the integral of radiance over all directions.
vec3 lpv_fluence(vec3 position)
{
    vec4 light[3];
    read_volume(position, light);
    return 4.0 * 3.14159265 * max(vec3(light[0].x, light[1].x, light[2].x), 0.0);
}
