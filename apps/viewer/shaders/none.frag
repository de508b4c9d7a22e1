#version 450 core
// --with none: emission alone.
#include "surface.glsl"

void main()
{
    surface s = read_surface(true);
    picture = vec4(s.dark ? vec3(0.0) : s.emission, 1.0);
}
