// SPDX-License-Identifier: MIT
// Lights beside those of the file: sky, sun and lamps. And a check of the light of a scene.
#ifndef ALPENGLOW_LIGHT_H
#define ALPENGLOW_LIGHT_H

#include <alpenglow/image.h>
#include <alpenglow/scene.h>

ALP_BEGIN_DECLS

/// `bounces` without a limit: light bounces until the rest no longer matters.
#define ALP_BOUNCES_CONVERGE UINT32_MAX

typedef enum alp_sky_kind {
    ALP_SKY_NONE = 0,       ///< black
    ALP_SKY_CONSTANT = 1,   ///< radiance `up` from every direction
    ALP_SKY_HEMISPHERE = 2, ///< `up` from above the horizon, `down` from below it
    ALP_SKY_IMAGE = 3,      ///< equirectangular `image`
    /// An analytic clear sky around the sun of these options, without the sun's disk. Radiance is
    /// the number of its luminance in cd/m², some thousand. Below the horizon lies an even ground
    /// of albedo 0.2, lit by this sky alone. With the sun below the horizon it fades tenfold every
    /// 3°, with a warning (sun-below-horizon). With the sun below −18° it is black. Based on:
    /// Preetham, Shirley, Smits. A Practical Analytic Model for Daylight. SIGGRAPH 1999.
    ALP_SKY_CLEAR = 4
} alp_sky_kind;

/// The sky: radiance [W·sr⁻¹·m⁻² per channel, linear Rec.709] by direction.
typedef struct alp_sky_options {
    alp_sky_kind kind;    ///< default NONE
    float up[3], down[3]; ///< radiance, [0, 1e30]; default 1 and 0
    /// Float image of 3 or 4 channels, twice as wide as high, borrowed until the lighting is made.
    /// Row 0 is up (+Y). The middle column is −Z, and columns to its right turn towards +X. Alpha
    /// is ignored. With a warning (sky-image), negative values and NaN count as 0; infinite ones
    /// and those above 1e30 count as its brightest value.
    const alp_image *image;
    float turn;      ///< turn of the image, radians about +Y, counter-clockwise from above; default
                     ///< 0. The clear sky turns with the sun's azimuth instead.
    float strength;  ///< factor on the radiance, [0, 1e30]; default 1. The product may not exceed
                     ///< 1e30.
    float turbidity; ///< haze of the clear sky, [1.7, 10]: 2 clear, 3 usual, 6 hazy; default 3
} alp_sky_options;

/// A sun: a disk of even radiance at infinity.
typedef struct alp_sun_options {
    float azimuth;     ///< radians from +Z towards +X
    float elevation;   ///< radians above the horizon, [−π/2, π/2]
    float illuminance; ///< E⊥ on a surface that faces it, lux per channel; 0 (default) = no sun
    float color[3];    ///< factor per channel, ≥ 0; default 1
    float size; ///< radians, full angle, [0, π/2]; default 0.0093 (0.53°); below 2e-4 = a point
} alp_sun_options;

/// A lamp without extent: a point or spot light of KHR_lights_punctual without a range. On a
/// surface that faces it at distance d, E = intensity × color / d². A spot multiplies this by
///
///     clamp((cosθ − cos outer) / max(.001, cos inner − cos outer))²,   θ from its axis
///
/// A point ignores the fields of a spot.
typedef struct alp_lamp {
    alp_light_kind kind; ///< POINT (default) or SPOT. A DIRECTIONAL light is a sun: use it instead.
    float position[3];   ///< metres, each coordinate in [−1e15, 1e15]; default 0
    float direction[3];  ///< spot: direction in which light travels, any length but 0; default −Z
    float intensity;     ///< candela, [0, 1e20]; 0 (default) gives no light
    float color[3];      ///< factor per channel, linear, [0, 1e10]; default 1
    float inner_cone;    ///< spot: radians from its axis, full light inside; default 0
    float outer_cone;    ///< spot: radians from its axis, no light outside; default π/4.
                         ///< 0 ≤ inner < outer ≤ π/2
} alp_lamp;
ALP_API alp_lamp alp_lamp_default(void);

/// Lights beside those of the file. Values out of range, NaN and infinity are INVALID_ARGUMENT in
/// the call that uses the options. The context's message names the value.
typedef struct alp_lighting_options {
    size_t struct_size;
    alp_sky_options sky;
    alp_sun_options sun;
    float file_sun_size;   ///< radians, full angle of the file's directional lights; default 0
    const alp_lamp *lamps; ///< [lamp_count], borrowed during the call; NULL (default) without
                           ///< lamps. Messages name them "lamp 0" and so on.
    uint32_t lamp_count;   ///< [0, 1000000]; default 0
} alp_lighting_options;
ALP_API alp_lighting_options alp_lighting_options_default(void);

/// Radiance [W·sr⁻¹·m⁻²] of a sky by direction, for hosts that draw it. The disks of suns are not
/// part of it. Their radiance is E⊥ / (π sin²(size / 2)).
/// @param directions [count][3] unit   @param radiance [count][3] out
/// @return ALP_OK; INVALID_ARGUMENT (NULL; an option out of range; a sky image of the wrong kind or
///         shape); OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_sky_radiance(alp_context *context,
                                                  const alp_lighting_options *lighting,
                                                  uint32_t count, const float (*directions)[3],
                                                  float (*radiance)[3]);

/// Checks the light of a scene by rays, and warns through the context's log:
///   no-light          There is no light at all.
///   light-inside      A point or spot light lies inside something or behind a wall, and lights
///                     nothing: 95 % of those of its 128 rays that hit first meet the back of a
///                     single-sided surface.
///                     Double-sided, blended and transmissive surfaces do not count.
///   light-on-surface  A point or spot light lies in a surface and lights both its sides.
///   closed-room       Sky and sun do not reach a quarter of the surface or more, by any number of
///                     bounces between front sides. Reported only if the scene has no lamp and no
///                     emissive surface. Method: 16 random walks of 64 bounces from 512 points.
///                     They find most openings of a thousandth of the walls.
/// alp_bake (irradiance) and alp_render (REFERENCE, RADIOSITY, HEMICUBE) give the same warnings,
/// but refuse a scene without light.
/// @param lighting as of a bake; NULL = the lights of the file alone
/// @param progress NULL, or called to learn whether to go on
/// @return ALP_OK, with or without warnings; INVALID_ARGUMENT; OUT_OF_MEMORY; UNSUPPORTED (the ray
///         tracer fails); CANCELLED
/// Cost: the acceleration structure, which the scene keeps; up to 192 rays a light; up to half a
/// million rays for rooms.
ALP_API ALP_NODISCARD alp_result alp_scene_examine(const alp_scene *scene,
                                                   const alp_lighting_options *lighting,
                                                   alp_progress_fn *progress, void *progress_user);

ALP_END_DECLS

#endif
