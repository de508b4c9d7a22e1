// A point of a surface, in a fragment shader.
#include "materials.glsl"
#include "shared_constants.h"

layout(binding = TEXTURE_BASE_COLOR) uniform sampler2D base_color_texture;
layout(binding = TEXTURE_METALLIC) uniform sampler2D metallic_texture;
layout(binding = TEXTURE_EMISSION) uniform sampler2D emission_texture;
layout(binding = TEXTURE_TRANSMISSION) uniform sampler2D transmission_texture;
layout(binding = TEXTURE_NORMAL) uniform sampler2D normal_texture;

layout(location = UNIFORM_METALS) uniform bool metals_black;
layout(location = UNIFORM_FIRST_TRIANGLE) uniform uint first_triangle;

in vec3 vertex_normal;
in vec4 vertex_tangent; // w: sign of the bitangent
in vec3 vertex_blend;
in vec4 vertex_color;
in vec2 texture_uv[TEXTURE_USES];
in vec2 map_uv[3];
flat in uint triangle_index;

layout(binding = TEXTURE_DEPTH) uniform sampler2D peeled_depth;
layout(binding = TEXTURE_OPAQUE_DEPTH) uniform sampler2D opaque_depth;
layout(location = UNIFORM_PEELED) uniform int peeled;

layout(location = 0) out vec4 picture; // radiance
layout(location = 1) out uint picture_triangle;
layout(location = 2) out vec4 picture_through; // share of light from behind that goes through

struct surface {
    vec3 albedo;   // diffuse
    vec3 emission; // radiance
    vec3 through;  // share of light from behind that goes straight through
    float kept;    // share of light that is reflected by the albedo
    bool dark;     // the back of a single-sided surface, which sends no light
};

vec4 base_color()
{
    return materials[material_index].base_color *
           texture(base_color_texture, texture_uv[TEXTURE_BASE_COLOR]) * vertex_color;
}

float metalness()
{
    return materials[material_index].metallic *
           texture(metallic_texture, texture_uv[TEXTURE_METALLIC]).b;
}

vec3 albedo_of(vec4 color)
{
    if ((materials[material_index].flags & MATERIAL_EXISTS) == 0u) {
        return vec3(ALP_ALBEDO_WITHOUT_MATERIAL);
    }
    return clamp(color.rgb * (metals_black ? 1.0 - metalness() : 1.0), 0.0, ALP_ALBEDO_LIMIT);
}

/// Light through a pane: (1 - a) lerp(1, c, a) + a t c.
void add_pane(float a, vec3 color, inout surface s)
{
    float t = materials[material_index].transmission;
    if (t > 0.0) {
        t = clamp(t * texture(transmission_texture, texture_uv[TEXTURE_TRANSMISSION]).r, 0.0, 1.0) *
            (1.0 - clamp(metalness(), 0.0, 1.0));
    }
    vec3 c = clamp(color, 0.0, 1.0);
    s.through = (1.0 - a) * (1.0 - a + a * c) + a * t * c;
    s.kept = a * (1.0 - t);
}

/// Ends fragments in holes, and those of other layers.
/// @param cut_blended whether blended surfaces have holes below alpha 1/2
void cut(float alpha, bool cut_blended)
{
    material m = materials[material_index];
    float cutoff = m.alpha_mode == ALPHA_MASK                   ? m.emission.a
                   : m.alpha_mode == ALPHA_BLEND && cut_blended ? 0.5
                                                                : -1.0;
    if (m.alpha_mode != ALPHA_OPAQUE && alpha < cutoff) {
        discard;
    }
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if ((peeled & PEEL_BEHIND) != 0 && gl_FragCoord.z >= texelFetch(peeled_depth, pixel, 0).r) {
        discard;
    }
    if ((peeled & PEEL_BEFORE) != 0 && gl_FragCoord.z < texelFetch(opaque_depth, pixel, 0).r) {
        discard;
    }
}

/// Reads the surface of this fragment.
/// @param panes whether light goes through; else blended surfaces are cut, and others opaque
surface read_surface(bool panes)
{
    material m = materials[material_index];
    vec4 color = base_color();
    cut(color.a, !panes);
    float covered = m.alpha_mode == ALPHA_BLEND ? clamp(color.a, 0.0, 1.0) : 1.0;
    vec3 emitted = texture(emission_texture, texture_uv[TEXTURE_EMISSION]).rgb;
    surface s;
    s.albedo = albedo_of(color);
    s.emission = m.emission.rgb * emitted * covered;
    s.through = vec3(0.0);
    s.kept = 1.0;
    if (panes) {
        add_pane(covered, color.rgb, s);
    }
    s.dark = !gl_FrontFacing && (m.flags & MATERIAL_DOUBLE_SIDED) == 0u;
    picture_triangle = first_triangle + triangle_index;
    picture_through = vec4(s.through, 1.0);
    return s;
}
