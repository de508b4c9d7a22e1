#version 450 core
// Ambient occlusion by 16 points around each pixel's place. A point is occluded if the picture shows
// a surface before it that rises above the plane of the place.
#include "shared_constants.h"
#include "ssao_seen.glsl"

const int POINTS = 16;

layout(location = 0) out float share;

/// The share that the surface of a pixel occludes of light from behind it.
float occlusion_by(ivec2 pixel, vec3 place, vec3 normal, float point_distance)
{
    float distance = texelFetch(seen, pixel, 0).a;
    vec3 way = position_of(pixel, distance) - place;
    bool before = distance > 0.0 && distance < 0.9999 * point_distance;
    bool above = dot(way, normal) > 0.01 * radius + 1e-5 * point_distance;
    // Surfaces far before the place have nothing to do with it. They fade out.
    return before && above ? clamp(2.0 - length(way) / radius, 0.0, 1.0) : 0.0;
}

float occlusion_of_point(vec3 point, vec3 place, vec3 normal)
{
    float distance = dot(point, camera_forward);
    vec2 at = vec2(dot(point, camera_right) / dot(camera_right, camera_right),
                   -dot(point, camera_up) / dot(camera_up, camera_up));
    ivec2 pixel = ivec2(floor((0.5 + 0.5 * at / distance) * picture_size));
    bool inside = distance > 0.0 && all(greaterThanEqual(pixel, ivec2(0))) &&
                  all(lessThan(pixel, ivec2(picture_size)));
    return inside ? occlusion_by(pixel, place, normal, distance) : 0.0;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 here = texelFetch(seen, pixel, 0);
    vec3 normal = here.xyz, place = position_of(pixel, here.a);
    vec3 side = abs(normal.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
    vec3 right = normalize(cross(side, normal)), ahead = cross(normal, right);
    // 4 x 4 pixels have different points, which the blur adds. Steps are irrational, so that points
    // spread evenly over heights, angles and distances.
    int tile = 4 * (pixel.y & 3) + (pixel.x & 3);
    float sum = 0.0;
    for (int i = 0; i < POINTS; i++) {
        float k = float(i) + float(tile) / 16.0, square = k / float(POINTS);
        float angle = 2.0 * ALP_SH_A0 * fract(0.618034 * (k + 5.0 * float(tile)));
        vec3 across = cos(angle) * right + sin(angle) * ahead;
        vec3 direction = sqrt(square) * across + sqrt(1.0 - square) * normal;
        float distance = radius * fract(0.754878 * float(i) + 0.569840 * float(tile) + 0.5);
        sum += occlusion_of_point(place + distance * direction, place, normal);
    }
    share = here.a > 0.0 ? 1.0 - sum / float(POINTS) : 1.0;
}
