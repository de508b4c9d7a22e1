// SPDX-License-Identifier: MIT
// Maps of light and occlusion on surfaces: pages over an atlas, or values at vertices.
#ifndef ALPENGLOW_LIGHTMAP_H
#define ALPENGLOW_LIGHTMAP_H

#include <alpenglow/atlas.h>

ALP_BEGIN_DECLS

/// What a bake makes: bits of alp_bake_options.maps. See alp_lightmap_map_page for their values.
typedef enum alp_map {
    ALP_MAP_AO = 1,    ///< accessibility: what an asset carries
    ALP_MAP_BENT = 2,  ///< bent normals, from the rays of ALP_MAP_AO
    ALP_MAP_LIGHT = 4, ///< irradiance E [W·m⁻² per channel, linear Rec.709], without albedo,
                       ///< without occlusion maps, not divided by π
    ALP_MAP_OBSCURANCE = 8, ///< coloured obscurance, every texel with rays of its own
    ALP_MAP_DIRECT = 16,    ///< irradiance that comes straight from lights: see ALP_DIRECT_APART
    ALP_MAP_BOUNCED = 32,   ///< irradiance that surfaces reflect: see ALP_DIRECT_APART
    ALP_MAP_SH = 64,        ///< the light of ALP_MAP_LIGHT by direction: spherical harmonics of two
                            ///< bands, four maps; needs ALP_MAP_LIGHT, not ALP_GATHER_PATHS
    ALP_MAP_DIRECTION = 128 ///< the mean direction it comes from; the same
} alp_map;

/// Values of alp_sampling_options.accuracy that are no accuracy.
#define ALP_ADAPTIVE_OFF 0.0f
#define ALP_ADAPTIVE_AUTO (-1.0f)

/// Maps over the pages of an atlas, or values at vertices.
typedef struct alp_lightmap alp_lightmap;

ALP_API void alp_lightmap_destroy(alp_lightmap *lightmap); ///< NULL does nothing
/// How alp_render reads maps of ALP_ATLAS_BLEND from now on; other maps are read as ever. NULL does
/// nothing.
ALP_API void alp_lightmap_set_blend(alp_lightmap *lightmap, alp_blend blend);
ALP_API uint32_t alp_lightmap_page_count(const alp_lightmap *lightmap);
/// A page as floats [height][width][4]: accessibility in R = G = B, coverage in A (1 where a texel
/// is covered, 0 elsewhere; uncovered texels near a chart hold its nearest value). NULL where light
/// alone was baked. Owned by the lightmap.
ALP_API const float *alp_lightmap_page(const alp_lightmap *lightmap, uint32_t page, uint32_t *width,
                                       uint32_t *height);
/// A page of one of the maps that were asked for, laid out like alp_lightmap_page (which is that of
/// ALP_MAP_AO), or NULL.
///
/// ALP_MAP_BENT: RGB = the mean open direction, world space, unit length,
///
///     normalised ∫ (1 − w) ω (n·ω) dω
///
/// with the directions of the occlusion options (uniform ones: without n·ω); the shading normal
/// where nothing is open. With ao_self, directions are those of the instance that was baked.
///
/// ALP_MAP_OBSCURANCE: RGB = (1/π) ∫ [ (1 − w) + w · albedo of the hit ] (n·ω) dω per channel,
/// linear, 0 to 1. Open is 1; single-sided surfaces are black from behind.
/// Based on: A. Méndez, M. Sbert, J. Catà. Real-time Obscurances with Color Bleeding. SCCG 2003.
///
/// ALP_MAP_DIRECTION: RGB = the mean direction of the light, world space, unit length,
///
///     normalised ∫ Y(L) (n·ω) ω dω
///
/// with the luminance Y of radiance L; the shading normal where it is dark.
///
/// ALP_MAP_SH: that of c_00, see alp_lightmap_sh_page.
ALP_API const float *alp_lightmap_map_page(const alp_lightmap *lightmap, alp_map map, uint32_t page,
                                           uint32_t *width, uint32_t *height);
/// A page of one of the four maps of ALP_MAP_SH, laid out the same, or NULL: RGB = the projection
/// of the radiance from the hemisphere above a texel,
///
///     c_lm = ∫ L(ω) Y_lm(ω) dω    [W·m⁻²]
///
/// in real spherical harmonics of world space without the Condon–Shortley sign, index l(l+1)+m:
/// Y = .282095, .488603 y, .488603 z, .488603 x. Irradiance about a normal n near the texel's is
///
///     E(n) ≈ π c_00 Y_00 + (2π/3) (c_1−1 Y_1−1(n) + c_10 Y_10(n) + c_11 Y_11(n))
///
/// Bias: docs/conventions.md, "Light by direction".
/// Based on: R. Ramamoorthi, P. Hanrahan. An Efficient Representation for Irradiance Environment
/// Maps. SIGGRAPH 2001.
/// @param index 0 to 3
ALP_API const float *alp_lightmap_sh_page(const alp_lightmap *lightmap, uint32_t index,
                                          uint32_t page, uint32_t *width, uint32_t *height);

/// Layers of light (alp_light_options.layers), 0 without.
ALP_API uint32_t alp_lightmap_layer_count(const alp_lightmap *lightmap);
/// What a layer is called: its light, its emissive material, "lamp 0" (of the options), "sun" (of
/// the options), "sky" or "others"; fit for the name of a file (dots and what separates are "_", at
/// most 64 bytes), and unlike all others and the names of other maps ("lamp", "lamp 2" …). NULL:
/// there is no such layer. Owned by the lightmap.
ALP_API const char *alp_lightmap_layer_name(const alp_lightmap *lightmap, uint32_t layer);
/// A page of a layer, laid out like alp_lightmap_page, or NULL: E [W·m⁻²] by that light alone.
/// Added up as floats, in order from the first layer on, the layers are ALP_MAP_LIGHT, bit for bit;
/// ALP_MAP_DIRECT and ALP_MAP_BOUNCED add up to it within rounding.
ALP_API const float *alp_lightmap_layer_page(const alp_lightmap *lightmap, uint32_t layer,
                                             uint32_t page, uint32_t *width, uint32_t *height);
/// The atlas the maps are laid out on, NULL with ALP_ATLAS_VERTEX. Owned by the lightmap.
ALP_API const alp_atlas *alp_lightmap_atlas(const alp_lightmap *lightmap);

/// Accessibility at the vertices of one surface, [*count], linear, 0 to 1: what ALP_ATLAS_VERTEX
/// baked, to be interpolated linearly over the triangles. A surface with normals has a value for
/// each vertex of its primitive or mesh, in that order; vertices of one position and one normal
/// have the same value, and those of no usable triangle have 1. A surface whose normals were
/// generated has three values for each triangle, in the order of its corners.
/// @param count NULL, or out: 0 where there are none
/// @return NULL without such values or for a surface that is not there. Owned by the lightmap.
ALP_API const float *alp_lightmap_vertex_values(const alp_lightmap *lightmap, uint32_t surface,
                                                uint32_t *count);

ALP_END_DECLS

#endif
