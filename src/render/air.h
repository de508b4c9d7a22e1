// SPDX-License-Identifier: MIT
// A medium between camera and surfaces, which scatters light: mist, and shafts of light in it.
#ifndef ALPI_RENDER_AIR_H
#define ALPI_RENDER_AIR_H

#include "render/field_light.h"
#include "transport/gather/gather.h"

#include <alpenglow/lpv.h>

/// A medium that fills the bounds of the scene, scatters into all directions alike and absorbs
/// nothing.
typedef struct alpi_air {
    const alpi_field_light *light; // its lamps shine into the medium, with shadows
    const alp_lpv *lpv;            // all other light in it
    float scattering;              // coefficient S, 1/m; 0: there is no medium
} alpi_air;

/// Light that the medium scatters into rays, up to the surfaces that they meet, through panes. It
/// is dimmed on its way to the camera alone. Panes tint the light of the medium behind them by
/// c(t).
///     scattered = ∫ S e^(−S t) c(t) fluence / 4π dt
/// @param rays  unit directions   @param lanes bit i: lane i
/// @param key   of the pixel's random numbers   @param first sample of lane 0
/// @param scattered out; 0 of other lanes
void alpi_air_along(const alpi_air *air, const alpi_rays *rays, uint32_t lanes, uint32_t key,
                    uint32_t first, vec3 scattered[ALPI_PACKET]);

/// How the medium dims light of surfaces and sky: by e^(−S T) over T metres.
/// @param air borrowed
alpi_medium alpi_air_medium(const alpi_air *air);

#endif
