#version 450 core
// Corners of triangles, fetched by number: vertex 3 t + k is corner k of triangle t.
#include "camera.glsl"
#include "materials.glsl"

layout(std430, binding = BUFFER_POSITIONS) readonly buffer position_list { float positions[]; };
layout(std430, binding = BUFFER_NORMALS) readonly buffer normal_list { float normals[]; };
layout(std430, binding = BUFFER_COLORS) readonly buffer color_list { vec4 colors[]; };
layout(std430, binding = BUFFER_UVS) readonly buffer uv_list { vec2 uvs[]; };
layout(std430, binding = BUFFER_TRIANGLES) readonly buffer triangle_list { uint triangles[]; };
layout(std430, binding = BUFFER_MAP_UVS) readonly buffer map_uv_list { vec2 map_uvs[]; };

layout(std430, binding = BUFFER_TANGENTS) readonly buffer tangent_list { vec4 tangents[]; };

layout(location = UNIFORM_VERTICES) uniform uint vertex_count;
layout(location = UNIFORM_COLORED) uniform bool colored;
layout(location = UNIFORM_AXES) uniform vec3 axes[3];
layout(location = UNIFORM_MAP_SETS) uniform uint map_sets;

layout(std430, binding = BUFFER_FIELD_VERTICES) readonly buffer field_vertex_list {
    float field_vertices[]; // [front, back][vertex][3]
};

layout(location = UNIFORM_FIELD_READ) uniform int field_read;

out vec3 vertex_irradiance[2]; // of fronts and backs
out vec3 vertex_normal;
out vec4 vertex_tangent;
out vec3 vertex_blend; // the normal in the frame of the object
out vec4 vertex_color;
out vec2 texture_uv[TEXTURE_USES];
out vec2 map_uv[3];
flat out uint triangle_index;

vec3 three(uint vertex, bool normal)
{
    uint at = 3u * vertex;
    return normal ? vec3(normals[at], normals[at + 1u], normals[at + 2u])
                  : vec3(positions[at], positions[at + 1u], positions[at + 2u]);
}

vec2 read_uv(uint use, uint vertex)
{
    uint slot = materials[material_index].slots[use];
    vec2 uv = slot == NO_SLOT ? vec2(0.0) : uvs[slot * vertex_count + vertex];
    vec3 row_u = materials[material_index].rows[2u * use].xyz;
    vec3 row_v = materials[material_index].rows[2u * use + 1u].xyz;
    return vec2(dot(row_u, vec3(uv, 1.0)), dot(row_v, vec3(uv, 1.0)));
}

/// @param side 0 front, 1 back
vec3 read_field(uint side, uint vertex)
{
    uint at = 3u * (side * vertex_count + vertex);
    return vec3(field_vertices[at], field_vertices[at + 1u], field_vertices[at + 2u]);
}

void main()
{
    uint corner = uint(gl_VertexID) % 3u;
    triangle_index = uint(gl_VertexID) / 3u;
    uint vertex = triangles[gl_VertexID];
    vec3 from_camera = three(vertex, false) - camera_origin;
    float depth = dot(from_camera, camera_forward);
    // Depth is near / distance: float depths are then exact everywhere, and there is no far plane.
    vec2 at = vec2(dot(from_camera, camera_right) / dot(camera_right, camera_right),
                   dot(from_camera, camera_up) / dot(camera_up, camera_up));
    gl_Position = camera_parallel ? vec4(at, 1.0 - depth * camera_near, 1.0)
                                  : vec4(at, camera_near, depth);
    vertex_normal = three(vertex, true);
    vertex_tangent = vertex < uint(tangents.length()) ? tangents[vertex] : vec4(0.0);
    vertex_blend = normalize(vec3(dot(vertex_normal, axes[0]), dot(vertex_normal, axes[1]),
                                  dot(vertex_normal, axes[2])));
    for (uint side = 0u; side < 2u; side++) {
        vertex_irradiance[side] =
            field_read == READ_VERTEX ? read_field(side, vertex) : vec3(0.0);
    }
    vertex_color = colored ? colors[vertex] : vec4(1.0);
    for (uint use = 0u; use < TEXTURE_USES; use++) {
        texture_uv[use] = read_uv(use, vertex);
    }
    for (uint set = 0u; set < 3u; set++) {
        map_uv[set] = set < map_sets ? map_uvs[3u * (map_sets * triangle_index + set) + corner]
                                     : vec2(0.0);
    }
}
