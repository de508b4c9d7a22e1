// The ray of the camera through a pixel, and what it sees.
#include "camera.glsl"

struct place {
    vec3 position;  // metres
    vec3 geometric; // unit normal of the triangle, on the side of the camera
    vec3 normal;    // unit normal that shades, on the same side but for normal maps
};

/// The way of the camera's ray through this pixel; not unit.
vec3 ray_of_pixel()
{
    vec2 at = 2.0 * gl_FragCoord.xy / picture_size - 1.0;
    return camera_parallel ? camera_forward
                           : camera_forward + at.x * camera_right - at.y * camera_up;
}

vec3 origin_of_pixel()
{
    vec2 at = 2.0 * gl_FragCoord.xy / picture_size - 1.0;
    return camera_parallel ? camera_origin + at.x * camera_right - at.y * camera_up
                           : camera_origin;
}
