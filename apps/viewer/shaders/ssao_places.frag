#version 450 core
// Normals of triangles and distances along the view, for ambient occlusion.
#include "place.glsl"

void main()
{
    read_surface(true);
    place p = find_place();
    picture = vec4(p.geometric, dot(p.position - camera_origin, camera_forward));
}
