// SPDX-License-Identifier: MIT
// A scene as a host draws it: triangles, materials and images, as arrays and plain values.
#ifndef ALPENGLOW_GEOMETRY_H
#define ALPENGLOW_GEOMETRY_H

#include <alpenglow/image.h>
#include <alpenglow/scene.h>

ALP_BEGIN_DECLS

/// Number of slots that texture coordinates are kept in: TEXCOORD_0 to TEXCOORD_3 of a glTF, and
/// two more that overlapping charts may have.
#define ALP_UV_SETS 6

/// Vertices and triangles of a scene. The arrays belong to the scene and live as long as it does. A
/// vertex belongs to one surface. Triangles of a surface are adjacent, in the order of surfaces.
typedef struct alp_geometry {
    uint32_t vertex_count, triangle_count;
    const float (*positions)[3]; ///< [vertex_count] metres, world, finite
    const float (*normals)[3];   ///< [vertex_count] unit, world
    /// [slot][vertex_count] coordinates, v = 0 at the top row of an image. NULL where no surface
    /// has the slot; zeros where one surface lacks it.
    const float (*uvs[ALP_UV_SETS])[2];
    const float (*colors)[4];          ///< [vertex_count] linear RGBA, [0, 1]; NULL: all are 1
    const uint32_t (*triangles)[3];    ///< [triangle_count] vertices, counter-clockwise outside
    const uint32_t *triangle_surfaces; ///< [triangle_count] surface of each
    const bool *triangle_usable;       ///< [triangle_count] false: without area, not drawn
} alp_geometry;
/// @param scene NULL gives zeros
ALP_API alp_geometry alp_scene_get_geometry(const alp_scene *scene);

/// How a texture continues beyond [0, 1].
typedef enum alp_wrap {
    ALP_WRAP_REPEAT = 0,
    ALP_WRAP_CLAMP = 1, ///< to the edge
    ALP_WRAP_MIRROR = 2 ///< repeated, every other one mirrored
} alp_wrap;

/// A texture as a material reads it. It is read bilinearly, without mip levels, at
///   (u', v') = transform · (u, v, 1)
/// with (u, v) of `uv_slot`; (0, 0) where the surface lacks the slot. Missing channels of the image
/// are filled: grey to RGB, alpha 1. If alp_scene_get_image gives NULL, the value is 1 in all
/// channels, and the material has no normal map.
///
/// A blended texture is the sum over k of w_k · (its value at the coordinates of slots[k]), on
/// surfaces that have all three slots (alp_surface_info.uv_slots). With the unit world normal n:
///   w_k = m_k², m = normalize(n · axes[0], n · axes[1], n · axes[2])
/// with alp_surface_info.axes. Each vertex normal is transformed and normalised before it is
/// interpolated; m is the normalised sum. On other surfaces it is read at `uv_slot`.
typedef struct alp_texture_info {
    uint32_t image;        ///< for alp_scene_get_image; ALP_NONE = no texture
    uint32_t uv_slot;      ///< < ALP_UV_SETS
    alp_wrap wrap_u;       ///< along u'
    alp_wrap wrap_v;       ///< along v'
    float transform[2][3]; ///< rows of u' and v'; KHR_texture_transform
    bool blended;
    uint8_t slots[3]; ///< of a blended texture; the first is uv_slot
} alp_texture_info;

typedef enum alp_alpha_mode {
    ALP_ALPHA_OPAQUE = 0, ///< alpha is ignored
    ALP_ALPHA_MASK = 1,   ///< points with alpha < alpha_cutoff are holes
    ALP_ALPHA_BLEND = 2   ///< covers what is behind it by alpha
} alp_alpha_mode;

/// A material. Each value is a factor times its texture, which is 1 where there is none. Red, green
/// and blue of an "sRGB" texture are decoded before they are filtered, float images too. Bytes
/// stand for value / 255. V is the vertex colour (alp_geometry.colors), T the texture.
///
/// Diffuse albedo, by which every technique reflects irradiance E as radiance E · albedo / π:
///   albedo = clamp(base_color.rgb · V.rgb · T.rgb, 0, .95)
/// With ALP_METALS_BLACK (alp_scene_set_metals) the product is multiplied by 1 − metalness before
/// it is clamped. The albedo of a surface without a material is .5 in each channel.
typedef struct alp_material_info {
    const char *name;    ///< "" without one; owned by the scene
    float base_color[4]; ///< linear RGBA, [0, 1]; alpha = base_color.a · V.a · T.a
    alp_texture_info base_color_texture; ///< sRGB, alpha
    float metallic;                      ///< [0, 1]; metalness = metallic · T.b
    alp_texture_info metallic_texture;   ///< linear, blue channel
    float emission[3]; ///< radiance, W·sr⁻¹·m⁻²: emission · T.rgb, · alpha with ALP_ALPHA_BLEND
    alp_texture_info emission_texture;  ///< sRGB
    alp_texture_info occlusion_texture; ///< linear, red channel
    float occlusion_strength;           ///< [0, 1]; accessibility = 1 + strength · (T.r − 1)
    alp_alpha_mode alpha_mode;
    float alpha_cutoff;                    ///< of ALP_ALPHA_MASK
    bool double_sided;                     ///< false: back faces are culled
    float transmission;                    ///< [0, 1]; share that passes: transmission · T.r
    alp_texture_info transmission_texture; ///< linear, red channel
    /// Linear, in the tangent frame (t, b, n) of alp_scene_make_tangents. With s = normal_scale and
    /// c = 2 T.rgb − 1 the shading normal is normalize(s · c.r · t + s · c.g · b + c.b · n).
    alp_texture_info normal_texture; ///< its image is there after alp_scene_load_normal_maps
    float normal_scale;              ///< [−1000, 1000]
} alp_material_info;
/// @param index < materials; else, as for a surface without a material: base colour .5, an empty
///        name and no texture
ALP_API alp_material_info alp_scene_get_material(const alp_scene *scene, uint32_t index);

/// An image of the scene, owned by it. alp_image_pixels gives its pixels.
/// @param index < images
/// @return NULL for no such image, one that could not be read (a warning said so when it was
///         loaded), one that no material reads, and a normal map that is not loaded yet
ALP_API const alp_image *alp_scene_get_image(const alp_scene *scene, uint32_t index);

/// Loads the images of normal maps, which light does not need: alp_scene_load leaves them out, so
/// that a bake spends neither time nor memory on them. One that cannot be read costs a warning
/// ("image"); its material is drawn without. A second call loads nothing again. Normal maps are
/// those of glTF, and of OBJ where a library says `norm`. A scene by alp_scene_simplify has none.
/// Not during another call with the scene. Pictures and bakes of the library do not change.
/// @return ALP_OK; INVALID_ARGUMENT (NULL); OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_scene_load_normal_maps(alp_scene *scene);

/// Computes the tangent of each vertex for normal maps. A tangent t is unit, perpendicular to the
/// vertex normal n, and points along +u' of the normal texture, after its transform. The bitangent
/// is b = w · cross(n, t), which points along −v', up in the image. w is 1, or −1 where the image
/// is seen mirrored.
///
/// It is the mean over the usable triangles of the vertex, weighted by their angle there. Vertices
/// are not divided: where mirrored halves share one, the larger angle decides w. TANGENT of a glTF
/// is not read. Without a normal texture or its coordinates t is any perpendicular, and w is 1.
/// @param tangents out, [vertex_count][4]: t and w
/// @return ALP_OK; INVALID_ARGUMENT (NULL)
ALP_API ALP_NODISCARD alp_result alp_scene_make_tangents(const alp_scene *scene,
                                                         float (*tangents)[4]);

ALP_END_DECLS

#endif
