// SPDX-License-Identifier: MIT
// Light that a scene gets beside what is in its file: a sky and a sun.
#ifndef ALPENGLOW_LIGHT_H
#define ALPENGLOW_LIGHT_H

#include <alpenglow/image.h>

ALP_BEGIN_DECLS

typedef enum alp_sky_kind {
    ALP_SKY_NONE = 0,       ///< black
    ALP_SKY_CONSTANT = 1,   ///< radiance `up` from everywhere
    ALP_SKY_HEMISPHERE = 2, ///< `down` + (`up` − `down`)(1 + d·y)/2 in direction d
    ALP_SKY_IMAGE = 3,      ///< equirectangular `image`
    ALP_SKY_CLEAR = 4       ///< an analytic clear sky about the sun of these options
} alp_sky_kind;

/// The sky: radiance [W·sr⁻¹·m⁻² per channel, linear Rec.709] by direction.
typedef struct alp_sky_options {
    alp_sky_kind kind;    ///< default NONE
    float up[3], down[3]; ///< radiance, ≥ 0; default 1 and 0
    const alp_image
        *image;      ///< float, 3 or 4 channels, twice as wide as high; borrowed until the
                     ///< lighting is made. Row 0 is up (+Y); the middle column looks along −Z
    float turn;      ///< radians about +Y, counter-clockwise seen from above; default 0
    float strength;  ///< factor on all of it, ≥ 0; default 1
    float turbidity; ///< of the clear sky, [1.7, 10]; default 3
} alp_sky_options;

/// A sun: a disk of even radiance at infinity.
typedef struct alp_sun_options {
    float azimuth;     ///< radians from +Z towards +X
    float elevation;   ///< radians above the horizon, [−π/2, π/2]
    float illuminance; ///< E⊥ on a surface that faces it, lux per channel; 0 (default) = no sun
    float color[3];    ///< factor per channel, ≥ 0; default 1
    float size;        ///< radians, full angle, [0, π/2]; default 0.0093 (0.53°); 0 = a point
} alp_sun_options;

typedef struct alp_lighting_options {
    size_t struct_size;
    alp_sky_options sky;
    alp_sun_options sun;
    float file_sun_size; ///< radians, full angle of the directional lights of the file; default 0
} alp_lighting_options;
ALP_API alp_lighting_options alp_lighting_options_default(void);

ALP_END_DECLS

#endif
