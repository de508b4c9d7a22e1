// The place of a surface in a pixel, as a ray finds it: precise however near the camera is.
#include "pixel.glsl"
#include "surface.glsl"

layout(std430, binding = BUFFER_POSITIONS) readonly buffer position_list { float positions[]; };
layout(std430, binding = BUFFER_TRIANGLES) readonly buffer triangle_list { uint triangles[]; };

vec3 corner(uint k)
{
    uint at = 3u * triangles[3u * triangle_index + k];
    return vec3(positions[at], positions[at + 1u], positions[at + 2u]);
}

/// Turns a shading normal by the normal map, as alp_material_info states it.
vec3 map_normal(vec3 n)
{
    material m = materials[material_index];
    vec3 t = vertex_tangent.xyz - dot(vertex_tangent.xyz, n) * n;
    float size = dot(t, t);
    if ((m.flags & MATERIAL_NORMAL_MAP) == 0u || size <= 1e-12) {
        return n;
    }
    t *= inversesqrt(size);
    vec3 b = (vertex_tangent.w < 0.0 ? -1.0 : 1.0) * cross(n, t);
    vec3 c = 2.0 * texture(normal_texture, texture_uv[TEXTURE_NORMAL]).rgb - 1.0;
    vec3 mapped = m.normal_scale * (c.r * t + c.g * b) + c.b * n;
    float square = dot(mapped, mapped);
    return square > 1e-12 ? mapped * inversesqrt(square) : n;
}

/// A shading normal that points below the triangle is replaced by the triangle's.
place find_place()
{
    vec3 ray = ray_of_pixel(), origin = origin_of_pixel();
    vec3 first = corner(0u), across = cross(corner(1u) - first, corner(2u) - first);
    place p;
    p.geometric = normalize(across);
    p.position = origin + dot(first - origin, p.geometric) / dot(ray, p.geometric) * ray;
    float size = dot(vertex_normal, vertex_normal);
    p.normal = size > 1e-12 ? vertex_normal * inversesqrt(size) : p.geometric;
    if (dot(p.normal, p.geometric) <= 0.0) {
        p.normal = p.geometric;
    }
    p.normal = map_normal(p.normal);
    if (dot(ray, p.geometric) > 0.0) {
        p.geometric = -p.geometric;
        p.normal = -p.normal;
    }
    return p;
}
