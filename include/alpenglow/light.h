// SPDX-License-Identifier: MIT
// Light that a scene gets beside what is in its file: a sky, a sun and lamps; and a look at what it
// does.
#ifndef ALPENGLOW_LIGHT_H
#define ALPENGLOW_LIGHT_H

#include <alpenglow/image.h>
#include <alpenglow/scene.h>

ALP_BEGIN_DECLS

/// `bounces` of light that goes on as long as it brings anything.
#define ALP_BOUNCES_CONVERGE UINT32_MAX

typedef enum alp_sky_kind {
    ALP_SKY_NONE = 0,       ///< black
    ALP_SKY_CONSTANT = 1,   ///< radiance `up` from everywhere
    ALP_SKY_HEMISPHERE = 2, ///< `up` from above the horizon, `down` from below it
    ALP_SKY_IMAGE = 3,      ///< equirectangular `image`
    /// An analytic clear sky about the sun of these options, without the sun's disk, in absolute
    /// units: its luminance in cd/m² (some thousand) is the radiance's number. Below the horizon an
    /// even ground of albedo 0.2 lit by this sky alone. A sun below the horizon lets it fade, by
    /// ten for every 3°, with a warning (sun-below-horizon); below −18° it is black.
    /// Preetham, Shirley, Smits: A Practical Analytic Model for Daylight. SIGGRAPH 1999.
    ALP_SKY_CLEAR = 4
} alp_sky_kind;

/// The sky: radiance [W·sr⁻¹·m⁻² per channel, linear Rec.709] by direction.
typedef struct alp_sky_options {
    alp_sky_kind kind;      ///< default NONE
    float up[3], down[3];   ///< radiance, [0, 1e30]; default 1 and 0
    const alp_image *image; ///< float, 3 or 4 channels, twice as wide as high; borrowed until the
                            ///< lighting is made. Row 0 is up (+Y); the middle column looks along
                            ///< −Z, columns to its right towards +X. Negative values and NaN count
                            ///< as 0, infinite ones (beyond 1e30 too) as its brightest, with a
                            ///< warning (sky-image). Alpha is not looked at
    float turn;      ///< of the image, radians about +Y, counter-clockwise seen from above;
                     ///< default 0. The clear sky turns with the sun's azimuth
    float strength;  ///< factor on all of it, [0, 1e30], and no radiance may become more
                     ///< than 1e30; default 1
    float turbidity; ///< of the clear sky, [1.7, 10]: 2 clear, 3 usual, 6 hazy; default 3
} alp_sky_options;

/// A sun: a disk of even radiance at infinity.
typedef struct alp_sun_options {
    float azimuth;     ///< radians from +Z towards +X
    float elevation;   ///< radians above the horizon, [−π/2, π/2]
    float illuminance; ///< E⊥ on a surface that faces it, lux per channel; 0 (default) = no sun
    float color[3];    ///< factor per channel, ≥ 0; default 1
    float size; ///< radians, full angle, [0, π/2]; default 0.0093 (0.53°); below 2e-4 = a point
} alp_sun_options;

/// A lamp without extent, as a point or spot light of KHR_lights_punctual without a range: on a
/// surface that faces it at distance d, E = intensity × color / d², of a spot times
/// clamp((cosθ − cos outer) / max(.001, cos inner − cos outer))², θ from its axis.
typedef struct alp_lamp {
    alp_light_kind kind; ///< POINT (default) or SPOT; a DIRECTIONAL one is a sun
    float position[3];   ///< metres, each coordinate in [−1e15, 1e15]; default 0
    float direction[3];  ///< of a spot, where its light travels: any length but 0; default −Z.
                         ///< A point does not read what is of a spot
    float intensity;     ///< candela, [0, 1e20]; 0 (default) gives nothing
    float color[3];      ///< factor per channel, linear, [0, 1e10]; default 1
    float inner_cone;    ///< of a spot, radians from its axis: full light inside; default 0
    float outer_cone; ///< of a spot, radians from its axis: none outside, 0 ≤ inner < outer ≤ π/2;
                      ///< default π/4
} alp_lamp;
ALP_API alp_lamp alp_lamp_default(void);

/// Values out of range, NaN and infinity are INVALID_ARGUMENT where the options are used, and the
/// context's message names the value.
typedef struct alp_lighting_options {
    size_t struct_size;
    alp_sky_options sky;
    alp_sun_options sun;
    float file_sun_size;   ///< radians, full angle of the directional lights of the file; default 0
    const alp_lamp *lamps; ///< [lamp_count], borrowed during the call; NULL (default) where none.
                           ///< Messages call them "lamp 0" and so on
    uint32_t lamp_count;   ///< [0, 1000000]; default 0
} alp_lighting_options;
ALP_API alp_lighting_options alp_lighting_options_default(void);

/// Tells the context's log what will surprise who lights this scene so, by rays:
///   no-light          nothing gives light at all
///   light-inside      a point or spot light whose rays meet (95 % of them, of 128) the backs of
///                     single-sided surfaces first, so that it lights nothing: it lies inside
///                     something or behind a wall. What is double-sided, blended or transmissive
///                     does not count
///   light-on-surface  one that lies in a surface and lights both its sides
///   closed-room       from a quarter of the surface, or more, no way leads out by any number of
///                     bounces between front sides, and the scene has no lamp or emissive surface:
///                     sky and sun do not get in. By 16 random walks of 64 bounces from each of 512
///                     points, which find most openings of a thousandth of the walls
/// alp_bake (irradiance) and alp_render (REFERENCE) tell the same.
/// @param lighting as of a bake; NULL = the lights of the file alone
/// @param progress NULL, or asked whether to go on
/// @return ALP_OK, whatever was found; INVALID_ARGUMENT; OUT_OF_MEMORY; UNSUPPORTED (the ray
/// tracer fails); CANCELLED
/// Cost: the acceleration structure, which the scene keeps, 256 rays a light, and half a million
/// for rooms, at most.
ALP_API ALP_NODISCARD alp_result alp_scene_examine(const alp_scene *scene,
                                                   const alp_lighting_options *lighting,
                                                   alp_progress_fn *progress, void *progress_user);

ALP_END_DECLS

#endif
