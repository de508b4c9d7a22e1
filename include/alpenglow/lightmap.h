// SPDX-License-Identifier: MIT
// Maps of light and occlusion on surfaces: pages over an atlas, or values at vertices.
#ifndef ALPENGLOW_LIGHTMAP_H
#define ALPENGLOW_LIGHTMAP_H

#include <alpenglow/atlas.h>

ALP_BEGIN_DECLS

/// Maps that a bake makes: bits of alp_bake_options.maps. See alp_lightmap_map_page for their
/// values.
typedef enum alp_map {
    ALP_MAP_AO = 1,   ///< accessibility, the occlusion map of an asset
    ALP_MAP_BENT = 2, ///< bent normals, from the rays of ALP_MAP_AO
    /// Irradiance E [W·m⁻² per channel, linear Rec.709]: without albedo, without occlusion maps,
    /// not divided by π.
    ALP_MAP_LIGHT = 4,
    ALP_MAP_OBSCURANCE = 8, ///< coloured obscurance; every texel traces its own rays
    ALP_MAP_DIRECT = 16,    ///< irradiance straight from lights: see ALP_DIRECT_APART
    ALP_MAP_BOUNCED = 32,   ///< irradiance that surfaces reflect: see ALP_DIRECT_APART
    /// ALP_MAP_LIGHT by direction: spherical harmonics of two bands, four maps. Needs
    /// ALP_MAP_LIGHT; not with ALP_GATHER_PATHS.
    ALP_MAP_SH = 64,
    /// Mean direction of ALP_MAP_LIGHT. Needs ALP_MAP_LIGHT; not with ALP_GATHER_PATHS.
    ALP_MAP_DIRECTION = 128,
    /// Light probes (alpenglow/probes.h), with the light that ALP_MAP_LIGHT solves, which it needs.
    ALP_MAP_PROBES = 256
} alp_map;

/// Special values of alp_sampling_options.accuracy.
#define ALP_ADAPTIVE_OFF 0.0f
#define ALP_ADAPTIVE_AUTO (-1.0f)

/// Maps over the pages of an atlas, or values at vertices. Opaque; made by alp_bake. Destroy it
/// before its scene. Pages are [height][width][4] floats, owned by the lightmap. `width` and
/// `height` may be NULL.
typedef struct alp_lightmap alp_lightmap;

ALP_API void alp_lightmap_destroy(alp_lightmap *lightmap); ///< NULL does nothing
/// Sets the weights by which alp_render reads maps of ALP_ATLAS_BLEND. Other maps ignore it. NULL
/// does nothing.
ALP_API void alp_lightmap_set_blend(alp_lightmap *lightmap, alp_blend blend);
/// Number of pages; 0 with ALP_ATLAS_VERTEX.
ALP_API uint32_t alp_lightmap_page_count(const alp_lightmap *lightmap);
/// A page of ALP_MAP_AO: accessibility in R = G = B, coverage in A. A is 1 if a texel is covered,
/// else 0. Uncovered texels hold the value of the nearest covered texel. NULL if occlusion was not
/// baked, or past the last page.
ALP_API const float *alp_lightmap_page(const alp_lightmap *lightmap, uint32_t page, uint32_t *width,
                                       uint32_t *height);
/// A page of one map, laid out like alp_lightmap_page. NULL if the bake did not make the map.
///
/// ALP_MAP_AO: accessibility, R = G = B.
///
/// ALP_MAP_LIGHT, ALP_MAP_DIRECT, ALP_MAP_BOUNCED: RGB = irradiance [W·m⁻²].
///
/// ALP_MAP_BENT: RGB = the mean open direction, world space, unit length,
///
///     normalised ∫ (1 − w) ω (n·ω) dω
///
/// over the directions of the occlusion options; without (n·ω) for uniform ones. If nothing is
/// open, it is the shading normal. With ao_self, directions are those of the instance that was
/// baked.
///
/// ALP_MAP_OBSCURANCE: RGB = (1/π) ∫ [ (1 − w) + w · albedo of the hit ] (n·ω) dω per channel,
/// linear, 0 to 1. Open is 1. Single-sided surfaces are black from behind.
/// Based on: A. Méndez, M. Sbert, J. Catà. Real-time Obscurances with Color Bleeding. SCCG 2003.
///
/// ALP_MAP_DIRECTION: RGB = the mean direction of the light, world space, unit length,
///
///     normalised ∫ Y(L) (n·ω) ω dω
///
/// with the luminance Y of radiance L. Without light, it is the shading normal.
///
/// ALP_MAP_SH: the page of c_00, see alp_lightmap_sh_page.
ALP_API const float *alp_lightmap_map_page(const alp_lightmap *lightmap, alp_map map, uint32_t page,
                                           uint32_t *width, uint32_t *height);
/// A page of one of the four maps of ALP_MAP_SH, laid out the same, or NULL. RGB = the projection
/// of the radiance from the hemisphere above a texel,
///
///     c_lm = ∫ L(ω) Y_lm(ω) dω    [W·m⁻²]
///
/// in real spherical harmonics of world space without the Condon–Shortley sign, index l(l+1)+m:
/// Y = .282095, .488603 y, .488603 z, .488603 x. Irradiance about a normal n near the texel's is
///
///     E(n) ≈ π c_00 Y_00 + (2π/3) (c_1−1 Y_1−1(n) + c_10 Y_10(n) + c_11 Y_11(n))
///
/// Bias: docs/conventions.md, "Light maps".
/// Based on: R. Ramamoorthi, P. Hanrahan. An Efficient Representation for Irradiance Environment
/// Maps. SIGGRAPH 2001.
/// @param index 0 to 3
ALP_API const float *alp_lightmap_sh_page(const alp_lightmap *lightmap, uint32_t index,
                                          uint32_t page, uint32_t *width, uint32_t *height);

/// Number of layers of light (alp_light_options.layers); 0 without them.
ALP_API uint32_t alp_lightmap_layer_count(const alp_lightmap *lightmap);
/// Name of a layer: its light or emissive material, "lamp 0" or "sun" (of the options), "sky" or
/// "others". It is valid in a file name: dots and separators become "_", at most 64 bytes. It
/// differs from all other layers and maps: "lamp", "lamp 2" and so on. NULL past the last layer.
/// Owned by the lightmap.
ALP_API const char *alp_lightmap_layer_name(const alp_lightmap *lightmap, uint32_t layer);
/// A page of a layer, laid out like alp_lightmap_page, or NULL: E [W·m⁻²] by that light alone.
/// Summed as floats from the first layer on, the layers are ALP_MAP_LIGHT bit for bit.
/// ALP_MAP_DIRECT and ALP_MAP_BOUNCED sum to it within rounding.
ALP_API const float *alp_lightmap_layer_page(const alp_lightmap *lightmap, uint32_t layer,
                                             uint32_t page, uint32_t *width, uint32_t *height);
/// The atlas of the maps; NULL with ALP_ATLAS_VERTEX. Owned by the lightmap.
ALP_API const alp_atlas *alp_lightmap_atlas(const alp_lightmap *lightmap);

/// Accessibility at the vertices of one surface, [*count], linear, 0 to 1: the result of
/// ALP_ATLAS_VERTEX. Interpolate it linearly over the triangles. A surface with normals has one
/// value for each vertex of its primitive or mesh, in that order. Vertices of one position and one
/// normal have the same value. Vertices without a usable triangle have 1. A surface with generated
/// normals has three values for each triangle, in the order of its corners.
/// @param count NULL, or out: number of values; 0 without any
/// @return NULL without such values or without such a surface. Owned by the lightmap.
ALP_API const float *alp_lightmap_vertex_values(const alp_lightmap *lightmap, uint32_t surface,
                                                uint32_t *count);

ALP_END_DECLS

#endif
