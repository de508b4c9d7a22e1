#version 450 core
// Fields of light: emission + albedo / pi * (irradiance of the field + irradiance straight from
// lamps and suns). The field is read at pixels, vertices or objects.
#include "lights.glsl"
#include "place.glsl"
#include "lpv.glsl"
#include "probes.glsl"
#include "ssao.glsl"

layout(binding = TEXTURE_FIELD) uniform sampler2D field_picture; // [pixel] irradiance
layout(std430, binding = BUFFER_FIELD_OBJECTS) readonly buffer field_object_list {
    vec4 field_objects[]; // [surface][9] spherical harmonics of irradiance
};

layout(location = UNIFORM_FIELD_READ) uniform int field_read;
layout(location = UNIFORM_LPV_GLOSS) uniform bool gloss;

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
    case READ_LPV:
        return lpv_irradiance(p.position, p.normal);
    default:
        return texelFetch(field_picture, ivec2(gl_FragCoord.xy), 0).rgb;
    }
}

/// Schlick's approximation of the share that a surface mirrors: .04 of a dielectric head-on, the
/// base colour of a metal.
vec3 find_fresnel(vec3 albedo, float metal, float cosine)
{
    float dull = 1.0 - clamp(cosine, 0.0, 1.0);
    vec3 ahead = mix(vec3(0.04), albedo, metal);
    return ahead + dull * dull * dull * dull * dull * (1.0 - ahead);
}

/// Exchanges a share of diffuse light for the light of the volume along the mirrored ray.
vec3 add_gloss(vec3 diffuse, vec3 albedo, place p)
{
    vec3 toward = -normalize(ray_of_pixel());
    float cosine = dot(p.normal, toward), metal = clamp(metalness(), 0.0, 1.0);
    vec3 share = find_fresnel(albedo, metal, cosine);
    vec3 mirrored = lpv_radiance(p.position, 2.0 * cosine * p.normal - toward);
    return (1.0 - share) * (1.0 - metal) * diffuse + share * mirrored;
}

void main()
{
    surface s = read_surface(true);
    place p = find_place();
    vec3 irradiance = open_share() * field_irradiance(p) + direct_irradiance(p);
    vec3 diffuse = s.albedo / ALP_SH_A0 * irradiance;
    vec3 light = s.emission + s.kept * (gloss ? add_gloss(diffuse, s.albedo, p) : diffuse);
    picture = vec4(s.dark ? vec3(0.0) : light, 1.0);
}
