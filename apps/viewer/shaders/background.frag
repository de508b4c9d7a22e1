#version 450 core
// Sky and disks of suns behind the surfaces, and the alpha of the picture.
#include "camera.glsl"
#include "shared_constants.h"

struct sun {
    vec4 toward;   // unit; a: the square of the chord from the middle of the disk to its rim
    vec4 radiance;
};

layout(std430, binding = BUFFER_SUNS) readonly buffer sun_list { sun suns[]; };
layout(binding = TEXTURE_PICTURE) uniform sampler2D surfaces_light;
layout(binding = TEXTURE_LEFT) uniform sampler2D surfaces_left;
layout(binding = TEXTURE_SKY) uniform sampler2D sky;

layout(location = UNIFORM_SKY_KIND) uniform int sky_kind;
layout(location = UNIFORM_SKY_UP) uniform vec3 sky_up;
layout(location = UNIFORM_SKY_DOWN) uniform vec3 sky_down;
layout(location = UNIFORM_SKY_TURN) uniform float sky_turn;
layout(location = UNIFORM_SUN_COUNT) uniform uint sun_count;

layout(location = 0) out vec4 picture;

/// Bilinear in azimuth and polar angle. It wraps around, and is clamped at the poles.
vec3 read_sky(vec3 direction)
{
    ivec2 size = textureSize(sky, 0);
    float around = fract(atan(direction.x, -direction.z) / (2.0 * ALP_SH_A0) + 0.5 + sky_turn);
    float down = atan(length(direction.xz), direction.y) / ALP_SH_A0;
    vec2 at = vec2(around, down) * vec2(size) - 0.5, low = floor(at), share = at - low;
    ivec2 a = ivec2((int(low.x) + size.x) % size.x, clamp(int(low.y), 0, size.y - 1));
    ivec2 b = ivec2((int(low.x) + 1) % size.x, clamp(int(low.y) + 1, 0, size.y - 1));
    vec3 top = mix(texelFetch(sky, a, 0).rgb, texelFetch(sky, ivec2(b.x, a.y), 0).rgb, share.x);
    vec3 bottom = mix(texelFetch(sky, ivec2(a.x, b.y), 0).rgb, texelFetch(sky, b, 0).rgb, share.x);
    return mix(top, bottom, share.y);
}

vec3 background(vec3 direction)
{
    vec3 light = sky_kind == SKY_IMAGE ? read_sky(direction)
                 : direction.y >= 0.0  ? sky_up
                                       : sky_down;
    for (uint i = 0u; i < sun_count; i++) {
        vec3 chord = direction - suns[i].toward.xyz;
        light += dot(chord, chord) <= suns[i].toward.a ? suns[i].radiance.rgb : vec3(0.0);
    }
    return light;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 at = 2.0 * gl_FragCoord.xy / picture_size - 1.0;
    vec3 direction = normalize(camera_forward + at.x * camera_right - at.y * camera_up);
    vec3 left = texelFetch(surfaces_left, pixel, 0).rgb, behind = left * background(direction);
    bool lit = behind.r + behind.g + behind.b > 0.0;
    float alpha = sky_kind != SKY_NONE || lit ? 1.0 : 1.0 - (left.r + left.g + left.b) / 3.0;
    vec3 light = texelFetch(surfaces_light, pixel, 0).rgb + behind;
    picture = vec4(alpha > 0.0 ? light / alpha : vec3(0.0), alpha);
}
