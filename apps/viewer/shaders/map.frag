#version 450 core
// A reflective shadow map: what each texel of a light's view sees, and the flux that is reflected
// there. Materials with glass are opaque, as in the library's maps.
#include "lights.glsl"
#include "place.glsl"

layout(location = UNIFORM_MAP_LIGHT) uniform uint map_light; // MAP_NO_LIGHT: no flux

layout(location = 3) out vec4 surfel_position; // metres; 0: the radius of the object is not known
layout(location = 4) out vec4 surfel_normal;   // unit; area in square metres
layout(location = 5) out vec4 surfel_flux;     // W
layout(location = 6) out vec4 surfel_albedo;

/// Area across the way that a texel sees at a distance along its ray.
float area_of(vec3 ray, float distance)
{
    vec2 side = 2.0 / picture_size;
    float rectangle = length(camera_right) * side.x * length(camera_up) * side.y;
    float size = length(ray);
    return camera_parallel ? rectangle : rectangle * distance * distance / (size * size * size);
}

void main()
{
    surface s = read_surface(false);
    place p = find_place();
    vec3 ray = ray_of_pixel(), toward;
    float across = area_of(ray, length(p.position - camera_origin));
    // Areas seen at a smaller cosine would be a few huge surfels.
    float cosine = max(abs(dot(normalize(ray), p.geometric)), 0.02);
    vec3 arriving = map_light == MAP_NO_LIGHT ? vec3(0.0)
                                              : light_at(lights[map_light], p.position, toward);
    vec3 albedo = s.dark ? vec3(0.0) : s.albedo;
    surfel_position = vec4(p.position, 0.0);
    surfel_normal = vec4(p.normal, across / cosine);
    surfel_flux = vec4(across * albedo * arriving, 0.0);
    surfel_albedo = vec4(albedo, 0.0);
}
