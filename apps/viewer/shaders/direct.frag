#version 450 core
// --with direct: emission + albedo / pi * irradiance straight from lamps and suns.
#include "lights.glsl"
#include "place.glsl"

void main()
{
    surface s = read_surface(true);
    vec3 light = s.emission + s.kept * s.albedo / ALP_SH_A0 * direct_irradiance(find_place());
    picture = vec4(s.dark ? vec3(0.0) : light, 1.0);
}
