// The surfaces of a picture as ambient occlusion sees them. Positions are relative to the camera.
#include "camera.glsl"

layout(location = UNIFORM_SSAO_RADIUS) uniform float radius; // metres
layout(binding = TEXTURE_PICTURE) uniform sampler2D seen; // normal, and distance; 0 without one

vec3 position_of(ivec2 pixel, float distance)
{
    vec2 at = 2.0 * (vec2(pixel) + 0.5) / picture_size - 1.0;
    return distance * (camera_forward + at.x * camera_right - at.y * camera_up);
}
