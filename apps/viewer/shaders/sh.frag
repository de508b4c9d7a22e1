#version 450 core
// --with sh: emission + albedo / pi * irradiance at the shading normal, from a light map by
// direction. Backs of double-sided surfaces have the light of their fronts.
#include "lightmap.glsl"
#include "place.glsl"

/// alp_lightmap_sh_page.
vec3 sh_irradiance(vec3 n)
{
    vec3 linear = n.y * read_map(1u) + n.z * read_map(2u) + n.x * read_map(3u);
    return max(ALP_SH_A0 * ALP_SH_Y0 * read_map(0u) + ALP_SH_A1 * ALP_SH_Y1 * linear, vec3(0.0));
}

void main()
{
    surface s = read_surface(true);
    vec3 n = find_place().normal;
    vec3 e = has_map() ? sh_irradiance(gl_FrontFacing ? n : -n) : vec3(0.0);
    vec3 light = s.emission + s.kept * s.albedo / ALP_SH_A0 * e;
    picture = vec4(s.dark ? vec3(0.0) : light, 1.0);
}
