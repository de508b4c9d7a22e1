#version 450 core
// --with albedo: the albedo of both sides.
#include "surface.glsl"

void main()
{
    picture = vec4(read_surface(true).albedo, 1.0);
}
