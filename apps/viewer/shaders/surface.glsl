// A point of a surface, in a fragment shader.
#include "materials.glsl"
#include "shared_constants.h"

layout(binding = TEXTURE_BASE_COLOR) uniform sampler2D base_color_texture;
layout(binding = TEXTURE_METALLIC) uniform sampler2D metallic_texture;
layout(binding = TEXTURE_EMISSION) uniform sampler2D emission_texture;
layout(binding = TEXTURE_TRANSMISSION) uniform sampler2D transmission_texture;

layout(location = UNIFORM_METALS) uniform bool metals_black;

in vec3 vertex_normal;
in vec3 vertex_blend;
in vec4 vertex_color;
in vec2 texture_uv[TEXTURE_USES];
in vec2 map_uv[3];
flat in uint triangle_index;

layout(location = 0) out vec4 picture; // radiance, and 1
layout(location = 1) out uint picture_triangle;

struct surface {
    vec3 albedo;   // diffuse
    vec3 emission; // radiance
    bool dark;     // the back of a single-sided surface, which sends no light
};

vec4 base_color()
{
    return materials[material_index].base_color *
           texture(base_color_texture, texture_uv[TEXTURE_BASE_COLOR]) * vertex_color;
}

vec3 albedo_of(vec4 color)
{
    material m = materials[material_index];
    if ((m.flags & 2u) == 0u) {
        return vec3(ALP_ALBEDO_WITHOUT_MATERIAL);
    }
    float metalness = m.metallic * texture(metallic_texture, texture_uv[TEXTURE_METALLIC]).b;
    return clamp(color.rgb * (metals_black ? 1.0 - metalness : 1.0), 0.0, ALP_ALBEDO_LIMIT);
}

/// Reads the surface of this fragment. Fragments in holes end here.
/// @param cut_blended whether blended surfaces have holes below alpha 1/2
surface read_surface(bool cut_blended)
{
    material m = materials[material_index];
    vec4 color = base_color();
    float cutoff = m.alpha_mode == ALPHA_MASK                    ? m.emission.a
                   : m.alpha_mode == ALPHA_BLEND && cut_blended ? 0.5
                                                                : -1.0;
    if (m.alpha_mode != ALPHA_OPAQUE && color.a < cutoff) {
        discard;
    }
    vec3 emitted = texture(emission_texture, texture_uv[TEXTURE_EMISSION]).rgb;
    float covered = m.alpha_mode == ALPHA_BLEND ? clamp(color.a, 0.0, 1.0) : 1.0;
    surface s;
    s.albedo = albedo_of(color);
    s.emission = m.emission.rgb * emitted * covered;
    s.dark = !gl_FrontFacing && (m.flags & 1u) == 0u;
    picture_triangle = triangle_index;
    return s;
}
