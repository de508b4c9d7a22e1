#version 450 core
// The places at which the processor reads a field: positions, and normals on the camera's side.
#include "place.glsl"

void main()
{
    read_surface(true);
    place p = find_place();
    picture = vec4(p.position, 1.0);
    picture_through = vec4(p.normal, 0.0);
}
