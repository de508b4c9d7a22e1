#version 450 core
// --with lpv: emission + albedo / pi * irradiance of the volume, and light straight from lamps and
// suns. With --gloss surfaces mirror the volume's light.
#include "lights.glsl"
#include "lpv.glsl"

layout(location = UNIFORM_LPV_GLOSS) uniform bool gloss;

/// Schlick's approximation of the share that a surface mirrors: .04 of a dielectric head-on, the
/// base colour of a metal.
vec3 find_fresnel(vec3 albedo, float metal, float cosine)
{
    float dull = 1.0 - clamp(cosine, 0.0, 1.0);
    vec3 ahead = mix(vec3(0.04), albedo, metal);
    return ahead + dull * dull * dull * dull * dull * (1.0 - ahead);
}

void main()
{
    surface s = read_surface(true);
    place p = find_place();
    vec3 e = lpv_irradiance(p.position, p.normal) + direct_irradiance(p);
    vec3 diffuse = s.albedo / ALP_SH_A0 * e;
    if (gloss) {
        vec3 toward = -normalize(ray_of_pixel());
        float cosine = dot(p.normal, toward), metal = clamp(metalness(), 0.0, 1.0);
        vec3 share = find_fresnel(s.albedo, metal, cosine);
        vec3 mirrored = lpv_radiance(p.position, 2.0 * cosine * p.normal - toward);
        diffuse = (1.0 - share) * (1.0 - metal) * diffuse + share * mirrored;
    }
    picture = vec4(s.dark ? vec3(0.0) : s.emission + s.kept * diffuse, 1.0);
}
