#version 450 core
// Where a field is read on the processor: positions, and normals on the side of the camera.
#include "place.glsl"

void main()
{
    read_surface(true);
    place p = find_place();
    picture = vec4(p.position, 1.0);
    picture_through = vec4(p.normal, 0.0);
}
