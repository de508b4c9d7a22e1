// The shading normal of a fragment, as a field is read with it by render.
#include "surface.glsl"

layout(std430, binding = BUFFER_POSITIONS) readonly buffer position_list { float positions[]; };
layout(std430, binding = BUFFER_TRIANGLES) readonly buffer triangle_list { uint triangles[]; };

vec3 corner(uint k)
{
    uint at = 3u * triangles[3u * triangle_index + k];
    return vec3(positions[at], positions[at + 1u], positions[at + 2u]);
}

/// Of the side that the corners run round counter-clockwise.
vec3 geometric_normal()
{
    vec3 a = corner(0u);
    return normalize(cross(corner(1u) - a, corner(2u) - a));
}

/// Of the side that is seen, of length 1.
vec3 shading_normal()
{
    vec3 geometric = geometric_normal();
    float square = dot(vertex_normal, vertex_normal);
    vec3 n = square > 1e-12 ? vertex_normal * inversesqrt(square) : geometric;
    n = dot(n, geometric) > 0.0 ? n : geometric;
    return gl_FrontFacing ? n : -n;
}
