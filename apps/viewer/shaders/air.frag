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

/// Clips a part of the ray to the bounds of the scene.
/// @param way unit   @param span begin and end, metres
vec2 clip(vec3 way, vec2 span)
{
    for (int k = 0; k < 3; k++) {
        float at = camera_origin[k];
        if (way[k] == 0.0) { // a division gives no number where the camera is on a bound
            span.y = at < bounds_low[k] || at > bounds_high[k] ? 0.0 : span.y;
        } else {
            float a = (bounds_low[k] - at) / way[k], b = (bounds_high[k] - at) / way[k];
            span = vec2(max(span.x, min(a, b)), min(span.y, max(a, b)));
        }
    }
    return span;
}

void main()
{
    vec3 ray = ray_of_pixel(), way = normalize(ray);
    float depth = texelFetch(opaque_depth, ivec2(gl_FragCoord.xy), 0).r;
    vec2 span = clip(way, vec2(0.0, depth > 0.0 ? camera_near / depth * length(ray) : 1e30));
    float begin = span.x;
    float scattered = span.y > begin ? 1.0 - exp(-scattering * (span.y - begin)) : 0.0;
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
