#version 450 core
// Fields of light: emission + albedo / pi * (irradiance of the field + irradiance straight from
// lamps and suns). The field is read at pixels, vertices or objects.
#include "lights.glsl"
#include "probes.glsl"

layout(binding = TEXTURE_FIELD) uniform sampler2D field_picture; // [pixel] irradiance
layout(std430, binding = BUFFER_FIELD_OBJECTS) readonly buffer field_object_list {
    vec4 field_objects[]; // [surface][9] spherical harmonics of irradiance
};

layout(location = UNIFORM_FIELD_READ) uniform int field_read;

in vec3 vertex_irradiance[2]; // of fronts and backs

vec3 coefficient(uint l)
{
    return field_objects[9u * surface_index + l].rgb;
}

/// By the nine coefficients of the object.
vec3 object_irradiance(vec3 n)
{
    vec3 e = ALP_SH_Y0 * coefficient(0u);
    e += ALP_SH_Y1 * (n.y * coefficient(1u) + n.z * coefficient(2u) + n.x * coefficient(3u));
    e += ALP_SH_Y2 * (n.x * n.y * coefficient(4u) + n.y * n.z * coefficient(5u) +
                      n.x * n.z * coefficient(7u));
    e += ALP_SH_Y20 * (3.0 * n.z * n.z - 1.0) * coefficient(6u);
    e += ALP_SH_Y22 * (n.x * n.x - n.y * n.y) * coefficient(8u);
    return max(e, vec3(0.0));
}

vec3 field_irradiance(place p)
{
    switch (field_read) {
    case READ_VERTEX:
        return vertex_irradiance[gl_FrontFacing ? 0 : 1];
    case READ_PROBES:
        return alpenglowProbeIrradiance(p.position, p.normal);
    case READ_OBJECT:
        return object_irradiance(p.normal);
    default:
        return texelFetch(field_picture, ivec2(gl_FragCoord.xy), 0).rgb;
    }
}

void main()
{
    surface s = read_surface(true);
    place p = find_place();
    vec3 irradiance = field_irradiance(p) + direct_irradiance(p);
    vec3 light = s.emission + s.kept * s.albedo / ALP_SH_A0 * irradiance;
    picture = vec4(s.dark ? vec3(0.0) : light, 1.0);
}
