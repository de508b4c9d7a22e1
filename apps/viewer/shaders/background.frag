#version 450 core
// What lies behind the surfaces: the sky.
#include "camera.glsl"
#include "shared_constants.h"

layout(location = UNIFORM_SKY_KIND) uniform int sky_kind;
layout(location = UNIFORM_SKY_UP) uniform vec3 sky_up;
layout(location = UNIFORM_SKY_DOWN) uniform vec3 sky_down;
layout(location = UNIFORM_SKY_TURN) uniform float sky_turn;
layout(binding = TEXTURE_SKY) uniform sampler2D sky;

layout(location = 0) out vec4 picture;
layout(location = 1) out uint picture_triangle;

void main()
{
    vec2 at = 2.0 * gl_FragCoord.xy / picture_size - 1.0;
    vec3 direction = normalize(camera_forward + at.x * camera_right - at.y * camera_up);
    vec3 light = direction.y >= 0.0 ? sky_up : sky_down;
    picture = vec4(light, 1.0);
    picture_triangle = 0xffffffffu;
}
