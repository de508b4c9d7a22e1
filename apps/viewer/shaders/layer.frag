#version 450 core
// Puts a layer of surfaces behind those before it. Blending adds the first output to the light so
// far.
#include "bindings.h"

layout(binding = TEXTURE_PICTURE) uniform sampler2D layer;
layout(binding = TEXTURE_THROUGH) uniform sampler2D layer_through;
layout(binding = TEXTURE_LEFT) uniform sampler2D left_before; // what is left of light from behind

layout(location = 0) out vec4 light;
layout(location = 1) out vec4 left;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 before = texelFetch(left_before, at, 0).rgb;
    light = vec4(before * texelFetch(layer, at, 0).rgb, 0.0);
    left = vec4(before * texelFetch(layer_through, at, 0).rgb, 1.0);
}
