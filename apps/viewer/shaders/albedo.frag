#version 450 core
// --with albedo: the albedo of both sides.
#include "surface.glsl"

void main()
{
    picture = vec4(read_surface(false).albedo, 1.0);
}
