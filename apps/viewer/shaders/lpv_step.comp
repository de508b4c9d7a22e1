#version 450 core
// One step of light: each cell gathers from its six neighbours.
#include "lpv_grid.glsl"

layout(local_size_x = LPV_GROUP_X, local_size_y = LPV_GROUP_Y, local_size_z = LPV_GROUP_Z) in;

layout(binding = 0) uniform sampler3D light[3];
layout(binding = 3) uniform sampler3D faces[3]; // by the axis that the face lies across
layout(binding = 6) uniform sampler3D colors[3];
layout(rgba32f, binding = 0) writeonly uniform image3D next[3];
layout(rgba32f, binding = 3) uniform image3D sum[3];
layout(location = UNIFORM_LPV_BLOCKED) uniform bool blocked;
layout(location = UNIFORM_LPV_REFLECTS) uniform bool reflects;

/// Shares of light that pass a face and travel on to the five faces of the next cell.
void open_faces(vec4 b, ivec3 axes, float way, out float open[5])
{
    float along = way * b[1 + axes.x];
    float beside = 1.0 - b.x + lpv_read.y * along;
    float first = lpv_read.z * b[1 + axes.y], second = lpv_read.z * b[1 + axes.z];
    open[0] = clamp(1.0 - b.x + along, 0.0, 1.0);
    open[1] = clamp(beside + first, 0.0, 1.0);
    open[2] = clamp(beside - first, 0.0, 1.0);
    open[3] = clamp(beside + second, 0.0, 1.0);
    open[4] = clamp(beside - second, 0.0, 1.0);
}

/// Adds the light that arrives along an axis. Each face's flux F becomes a lobe
/// F/pi (1/4 + n.w/2).
void arrive(vec4 from, ivec3 axes, float way, float open[5], inout vec4 p)
{
    float f[5];
    read_faces(from, axes, way, f);
    for (int i = 0; i < 5; i++) {
        f[i] *= open[i] * (i == 0 ? ALP_LPV_FAR : ALP_LPV_SIDE);
    }
    float sides = (f[1] + f[2]) + (f[3] + f[4]);
    p.x += 0.0795774715 * (f[0] + sides);
    p[1 + axes.x] += 0.1591549431 * way * (f[0] + lpv_give.x * sides);
    p[1 + axes.y] += 0.1591549431 * lpv_give.y * (f[1] - f[2]);
    p[1 + axes.z] += 0.1591549431 * lpv_give.y * (f[3] - f[4]);
}

/// Adds what blockers throw back of the light that leaves along an axis.
void come_back(vec4 own, ivec3 axes, float way, float open[5], float albedo, inout vec4 p)
{
    float f[5];
    read_faces(own, axes, way, f);
    float flux = ALP_LPV_FAR * f[0] * (1.0 - open[0]);
    for (int i = 1; i < 5; i++) {
        flux += ALP_LPV_SIDE * f[i] * (1.0 - open[i]);
    }
    p.x += 0.0795774715 * albedo * flux;
    p[1 + axes.x] -= 0.1591549431 * way * albedo * flux;
}

void main()
{
    ivec3 at = ivec3(gl_GlobalInvocationID);
    int cascade = at.z / grid_size.z, low = cascade * grid_size.z;
    if (any(greaterThanEqual(at, imageSize(next[0])))) {
        return;
    }
    vec4 p[3] = vec4[3](vec4(0.0), vec4(0.0), vec4(0.0));
    for (int d = 0; d < 6; d++) {
        ivec3 axes = axes_of(d / 2), step = ivec3(0);
        float way = d % 2 == 0 ? 1.0 : -1.0;
        step[axes.x] = int(way);
        ivec3 from = at - step;
        bool inside = from.z >= low && from.z < low + grid_size.z &&
                      all(greaterThanEqual(from.xy, ivec2(0))) &&
                      all(lessThan(from.xy, grid_size.xy));
        // Light enters by the low face where it travels by +, and leaves by it by -.
        ivec3 own = at + ivec3(0, 0, cascade), beyond = own + abs(step);
        ivec3 enters = way > 0.0 ? own : beyond, leaves = way > 0.0 ? beyond : own;
        float open[5] = float[5](1.0, 1.0, 1.0, 1.0, 1.0), shut[5];
        vec3 albedo = vec3(0.0);
        if (blocked) {
            open_faces(texelFetch(faces[axes.x], enters, 0), axes, way, open);
        }
        if (reflects) {
            open_faces(texelFetch(faces[axes.x], leaves, 0), axes, way, shut);
            albedo = texelFetch(colors[axes.x], leaves, 0).rgb;
        }
        for (int channel = 0; channel < 3; channel++) {
            if (inside) {
                arrive(texelFetch(light[channel], from, 0), axes, way, open, p[channel]);
            }
            if (reflects) {
                come_back(texelFetch(light[channel], at, 0), axes, way, shut, albedo[channel],
                          p[channel]);
            }
        }
    }
    for (int channel = 0; channel < 3; channel++) {
        imageStore(sum[channel], at, imageLoad(sum[channel], at) + p[channel]);
        imageStore(next[channel], at, scale_light(p[channel]));
    }
}
