#version 450 core
// --media: mist in the bounds of the scene, which scatters the light of the volume and of lamps
// into all directions alike. Along the ray of a pixel, between two layers of surfaces t0 < t1,
//     L = integral of S e^(-S (t - t0)) F(t) / 4 pi dt + e^(-S (t1 - t0)) Lbehind,   F the fluence,
// by 32 steps of equal shares of the scattered light. Blending adds the first output to the light
// so far.
#include "lights.glsl"
#include "lpv.glsl"

layout(location = UNIFORM_AIR_SCATTERING) uniform float scattering; // 1/metre
layout(location = UNIFORM_AIR_LOW) uniform vec3 bounds_low;         // metres
layout(location = UNIFORM_AIR_HIGH) uniform vec3 bounds_high;

layout(location = UNIFORM_PEELED) uniform int peeled; // PEEL_BEHIND: there is a layer before

layout(binding = TEXTURE_DEPTH) uniform sampler2D depth_before;
layout(binding = TEXTURE_LAYER_DEPTH) uniform sampler2D layer_depth;
layout(binding = TEXTURE_OPAQUE_DEPTH) uniform sampler2D opaque_depth;
layout(binding = TEXTURE_LEFT) uniform sampler2D left_before; // share of light from behind

layout(location = 0) out vec4 scattered_light;
layout(location = 1) out vec4 left;

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

/// Metres along the ray up to a depth; far away where no surface is.
float find_distance(float depth, vec3 ray)
{
    return depth > 0.0 ? camera_near / depth * length(ray) : 1e30;
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
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 ray = ray_of_pixel(), way = normalize(ray), before = texelFetch(left_before, at, 0).rgb;
    float end = find_distance(max(texelFetch(layer_depth, at, 0).r,
                                  texelFetch(opaque_depth, at, 0).r), ray);
    bool behind = (peeled & PEEL_BEHIND) != 0;
    vec2 span = vec2(behind ? find_distance(texelFetch(depth_before, at, 0).r, ray) : 0.0, end);
    span = clip(way, span);
    float begin = span.x;
    float scattered = span.y > begin ? 1.0 - exp(-scattering * (span.y - begin)) : 0.0;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < steps && scattered > 0.0; i++) {
        float share = (float(i) + 0.5) / float(steps);
        float t = begin - log(1.0 - share * scattered) / scattering;
        vec3 position = camera_origin + t * way;
        sum += lpv_fluence(position) + lamp_fluence(position);
    }
    scattered_light = vec4(scattered / (4.0 * ALP_SH_A0 * float(steps)) * before * sum, 0.0);
    left = vec4((1.0 - scattered) * before, 1.0);
}
