#version 450 core
// --with lightmap: emission + albedo / pi * irradiance, from pages of floats.
#include "lightmap.glsl"

void main()
{
    surface s = read_surface(true);
    vec3 light = s.emission + s.kept * s.albedo / ALP_SH_A0 * (has_map() ? read_map(0u) : vec3(0.0));
    picture = vec4(s.dark ? vec3(0.0) : light, 1.0);
}
