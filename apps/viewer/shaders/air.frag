#version 450 core
// --media: mist in the bounds of the scene, which scatters the light of the volume and of lamps
// into all directions alike. Along the ray of a pixel,
//     L = integral of S e^(-S t) F(t) / 4 pi dt + e^(-S T) Lsurface,   F the fluence,
// by 32 steps of equal shares of what is scattered.
#include "lights.glsl"
#include "lpv.glsl"

layout(location = UNIFORM_AIR_SCATTERING) uniform float scattering; // 1/metre
layout(location = UNIFORM_AIR_LOW) uniform vec3 bounds_low;         // metres
layout(location = UNIFORM_AIR_HIGH) uniform vec3 bounds_high;

layout(binding = TEXTURE_OPAQUE_DEPTH) uniform sampler2D opaque_depth;

layout(location = 0) out vec4 scattered_light; // alpha: the share that is scattered
layout(location = 1) out vec4 left;            // of light from behind; by alpha too

const int steps = 32;

/// Fluence of lamps and suns. A point in air has no side.
vec3 lamp_fluence(vec3 position)
{
    vec3 sum = vec3(0.0);
    place p = place(position, vec3(0.0), vec3(0.0));
    for (uint i = 0u; i < light_count; i++) {
        vec3 toward, arriving = light_at(lights[i], position, toward);
        sum += find_visibility(lights[i], p) * arriving;
    }
    return sum;
}

void main()
{
    vec3 ray = ray_of_pixel(), way = normalize(ray);
    float depth = texelFetch(opaque_depth, ivec2(gl_FragCoord.xy), 0).r;
    float end = depth > 0.0 ? camera_near / depth * length(ray) : 1e30;
    vec3 a = (bounds_low - camera_origin) / way, b = (bounds_high - camera_origin) / way;
    vec3 enter = min(a, b), leave = max(a, b);
    float begin = max(max(enter.x, enter.y), max(enter.z, 0.0));
    end = min(min(leave.x, leave.y), min(leave.z, end));
    float scattered = end > begin ? 1.0 - exp(-scattering * (end - begin)) : 0.0;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < steps && scattered > 0.0; i++) {
        float share = (float(i) + 0.5) / float(steps);
        float t = begin - log(1.0 - share * scattered) / scattering;
        vec3 position = camera_origin + t * way;
        sum += lpv_fluence(position) + lamp_fluence(position);
    }
    scattered_light = vec4(scattered / (4.0 * ALP_SH_A0 * float(steps)) * sum, scattered);
    left = vec4(0.0, 0.0, 0.0, scattered);
}
