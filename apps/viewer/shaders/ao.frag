#version 450 core
// --with ao: accessibility from a baked map. Backs of single-sided surfaces are left out.
#include "lightmap.glsl"

void main()
{
    surface s = read_surface(false);
    if (s.dark) {
        discard;
    }
    picture = vec4(vec3(has_map() ? read_map(0u).r : 1.0), 1.0);
}
