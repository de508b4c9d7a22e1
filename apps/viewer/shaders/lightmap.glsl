// Maps over the pages of an atlas, as floats.
#include "surface.glsl"

layout(binding = TEXTURE_LIGHTMAP) uniform sampler2DArray lightmap;
layout(std430, binding = BUFFER_MAP_TRIANGLES) readonly buffer map_triangle_list {
    uint map_triangles[]; // page, and in the upper 3 bits which sets count; MAP_NONE
};

layout(location = UNIFORM_MAP_SETS) uniform uint map_sets;
layout(location = UNIFORM_MAP_PAGES) uniform uint map_pages;
layout(location = UNIFORM_MAP_EQUAL) uniform bool map_equal;

/// Bilinear, clamped to the page. Texture units would round the weights to 1/256.
vec3 read_page(vec2 uv, int page)
{
    ivec2 size = textureSize(lightmap, 0).xy;
    vec2 at = uv * vec2(size) - 0.5;
    vec2 low = floor(at), share = at - low;
    ivec2 a = clamp(ivec2(low), ivec2(0), size - 1), b = clamp(ivec2(low) + 1, ivec2(0), size - 1);
    vec3 top = mix(texelFetch(lightmap, ivec3(a.x, a.y, page), 0).rgb,
                   texelFetch(lightmap, ivec3(b.x, a.y, page), 0).rgb, share.x);
    vec3 bottom = mix(texelFetch(lightmap, ivec3(a.x, b.y, page), 0).rgb,
                      texelFetch(lightmap, ivec3(b.x, b.y, page), 0).rgb, share.x);
    return mix(top, bottom, share.y);
}

/// Weights of the three sets of overlapping charts.
vec3 set_weights(uint members)
{
    if (map_equal) {
        vec3 counted = vec3(uvec3(members, members >> 1, members >> 2) & 1u);
        return counted / dot(counted, vec3(1.0));
    }
    vec3 m = normalize(vertex_blend);
    return m * m;
}

bool has_map()
{
    return map_triangles[triangle_index] != MAP_NONE;
}

/// The value of this fragment, which has a map. @param index of a value of several a texel
vec3 read_map(uint index)
{
    uint entry = map_triangles[triangle_index];
    int page = int((entry & MAP_PAGE) + index * map_pages);
    if (map_sets == 1u) {
        return read_page(map_uv[0], page);
    }
    vec3 weights = set_weights(entry >> MAP_SETS_SHIFT);
    return weights.x * read_page(map_uv[0], page) + weights.y * read_page(map_uv[1], page) +
           weights.z * read_page(map_uv[2], page);
}
