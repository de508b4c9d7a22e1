#version 450 core
// One step of light: each cell gathers from its six neighbours.
#include "lpv_grid.glsl"

layout(local_size_x = LPV_GROUP_X, local_size_y = LPV_GROUP_Y, local_size_z = LPV_GROUP_Z) in;

layout(binding = 0) uniform sampler3D light;
layout(binding = 1) uniform sampler3D faces; // first those across x
layout(binding = 2) uniform sampler3D colors;
layout(rgba32f, binding = 0) writeonly uniform image3D next;
layout(rgba32f, binding = 1) uniform image3D sum;
layout(location = UNIFORM_LPV_BLOCKED) uniform bool blocked;
layout(location = UNIFORM_LPV_REFLECTS) uniform bool reflects;

/// Shares of light that pass a face and travel on to the five faces of the next cell.
void open_faces(vec4 b, int axis, float way, out float open[5])
{
    vec3 v = turn(b.yzw, axis);
    float beside = 1.0 - b.x + way * lpv_read.y * v.x;
    vec2 aside = lpv_read.z * v.yz;
    open[0] = clamp(1.0 - b.x + way * v.x, 0.0, 1.0);
    open[1] = clamp(beside + aside.x, 0.0, 1.0);
    open[2] = clamp(beside - aside.x, 0.0, 1.0);
    open[3] = clamp(beside + aside.y, 0.0, 1.0);
    open[4] = clamp(beside - aside.y, 0.0, 1.0);
}

/// Light that arrives along an axis. Each face's flux F becomes a lobe F/pi (1/4 + n.w/2).
vec4 arrive(vec4 from, int axis, float way, float open[5])
{
    float f[5];
    read_faces(from, axis, way, f);
    for (int i = 0; i < 5; i++) {
        f[i] *= open[i] * (i == 0 ? ALP_LPV_FAR : ALP_LPV_SIDE);
    }
    float sides = (f[1] + f[2]) + (f[3] + f[4]);
    vec3 v = vec3(way * (f[0] + lpv_give.x * sides), lpv_give.y * vec2(f[1] - f[2], f[3] - f[4]));
    return vec4(0.0795774715 * (f[0] + sides), 0.1591549431 * turn_back(v, axis));
}

/// Light that blockers reflect, from the light that leaves along an axis.
vec4 come_back(vec4 own, int axis, float way, float open[5], float albedo)
{
    float f[5];
    read_faces(own, axis, way, f);
    float flux = ALP_LPV_FAR * f[0] * (1.0 - open[0]);
    for (int i = 1; i < 5; i++) {
        flux += ALP_LPV_SIDE * f[i] * (1.0 - open[i]);
    }
    return albedo * flux * vec4(0.0795774715, -0.1591549431 * way * vec3(unit_of(axis)));
}

void main()
{
    ivec3 at = ivec3(gl_GlobalInvocationID);
    int cascade = at.z / grid_size.z, low = cascade * grid_size.z;
    if (any(greaterThanEqual(at, ivec3(grid_size.xy, channel_step().z)))) {
        return;
    }
    vec4 p[3] = vec4[3](vec4(0.0), vec4(0.0), vec4(0.0));
    for (int d = 0; d < 6; d++) {
        int axis = d / 2, way = 1 - 2 * (d % 2);
        ivec3 unit = unit_of(axis), from = at - way * unit;
        bool inside = from.z >= low && from.z < low + grid_size.z &&
                      all(greaterThanEqual(from.xy, ivec2(0))) &&
                      all(lessThan(from.xy, grid_size.xy));
        // Light enters by the low face where it travels by +, and leaves by it by -.
        ivec3 own = at + ivec3(0, 0, cascade) + axis * axis_step(), beyond = own + unit;
        ivec3 enters = way > 0 ? own : beyond, leaves = way > 0 ? beyond : own;
        float open[5] = float[5](1.0, 1.0, 1.0, 1.0, 1.0), shut[5];
        vec3 albedo = vec3(0.0);
        if (blocked) {
            open_faces(texelFetch(faces, enters, 0), axis, way, open);
        }
        if (reflects) {
            open_faces(texelFetch(faces, leaves, 0), axis, way, shut);
            albedo = texelFetch(colors, leaves, 0).rgb;
        }
        for (int channel = 0; channel < 3; channel++) {
            ivec3 c = channel * channel_step();
            if (inside) {
                p[channel] += arrive(texelFetch(light, from + c, 0), axis, way, open);
            }
            if (reflects) {
                p[channel] += come_back(texelFetch(light, at + c, 0), axis, way, shut,
                                        albedo[channel]);
            }
        }
    }
    for (int channel = 0; channel < 3; channel++) {
        ivec3 to = at + channel * channel_step();
        imageStore(sum, to, imageLoad(sum, to) + p[channel]);
        imageStore(next, to, scale_light(p[channel]));
    }
}
