#version 450 core
// --with constant and other ambient models: emission + albedo / pi * (irradiance of the model,
// where the screen shows it open, + irradiance straight from lamps and suns).
#include "ambient.glsl"
#include "lights.glsl"
#include "place.glsl"
#include "ssao.glsl"

void main()
{
    surface s = read_surface(true);
    place p = find_place();
    vec3 irradiance = open_share() * ambient_irradiance(p) + direct_irradiance(p);
    vec3 light = s.emission + s.kept * s.albedo / ALP_SH_A0 * irradiance;
    picture = vec4(s.dark ? vec3(0.0) : light, 1.0);
}
