#version 450 core
// Where a field is read on the processor: positions, and the normals that meet the camera.
#include "normals.glsl"

void main()
{
    read_surface(true);
    picture = vec4(vertex_position, 1.0);
    picture_through = vec4(shading_normal(), 0.0);
}
