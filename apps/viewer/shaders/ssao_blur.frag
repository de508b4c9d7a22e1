#version 450 core
// Mean of 4 x 4 pixels that lie in the plane of this one: it keeps edges.
#include "ssao_seen.glsl"

layout(binding = TEXTURE_SSAO) uniform sampler2D noisy;

layout(location = 0) out float share;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy), last = ivec2(picture_size) - 1;
    vec4 here = texelFetch(seen, pixel, 0);
    vec3 place = position_of(pixel, here.a);
    vec2 sum = vec2(0.0); // of shares, and of pixels
    for (int i = 0; i < 16; i++) {
        ivec2 at = clamp(pixel + ivec2(i % 4, i / 4) - 2, ivec2(0), last);
        vec4 there = texelFetch(seen, at, 0);
        float height = dot(position_of(at, there.a) - place, here.xyz);
        bool alike = there.a > 0.0 && dot(there.xyz, here.xyz) > 0.9 && abs(height) < 0.1 * radius;
        sum += alike ? vec2(texelFetch(noisy, at, 0).r, 1.0) : vec2(0.0);
    }
    share = sum.y > 0.0 ? sum.x / sum.y : 1.0;
}
