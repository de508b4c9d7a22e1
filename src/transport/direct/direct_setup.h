// SPDX-License-Identifier: MIT
// What direct light is gathered from: all light of a scene, sorted by how it is asked.
#ifndef ALPI_TRANSPORT_DIRECT_SETUP_H
#define ALPI_TRANSPORT_DIRECT_SETUP_H

#include "scene/lights/lighting_punctual.h"
#include "scene/lights/lighting_suns.h"
#include "transport/direct/direct.h"
#include "transport/direct/direct_emitters.h"
#include "transport/direct/direct_polygons.h"

/// A part of each light up to the limit and as many materials, or one of many; and the sky.
enum { ALPI_DIRECT_PART_LIMIT = 3 * ALPI_DIRECT_LIGHT_LIMIT + 1 };

struct alpi_direct {
    alpi_direct_options options;
    uint32_t samples; // of each light, a multiple of the replicates
    alpi_direct_part parts[ALPI_DIRECT_PART_LIMIT];
    uint32_t part_count;
    alpi_light *lights;       // [alpi_lighting_light_count]; names are borrowed
    uint32_t *light_parts;    // of each of them, ALPI_NONE: it gives nothing
    uint32_t *lamps;          // [lamp_count] lights without size
    uint32_t lamp_count;      // of `lamps`
    bool lamps_drawn;         // one at a time, from `drawn`
    alpi_punctual drawn;      // of `lamps`, where lamps_drawn
    alpi_sun *suns;           // [sun_count]
    uint32_t sun_count;       // of `suns`
    bool suns_drawn;          // one at a time
    uint32_t *material_parts; // [scene.material_count], ALPI_NONE: it emits nothing
    alpi_polygon polygons[ALPI_POLYGON_LIMIT]; // [polygon_count] all emitters, if there are any
    uint32_t polygon_count;
    alpi_direct_emitters emitters; // others
    const alpi_sky *sky;           // NULL: none
    uint32_t sky_part;
    bool sky_drawn; // it is uneven: directions to it are drawn
    bool sky_met;   // by cosine-distributed rays too
    bool sky_spots; // it is all spots, and neither: see direct_spots.h
};

/// The most rays that a block may take, of eight receivers or so many if they are fewer; a shorter
/// block never takes more. @param extended see alpi_receivers
double alpi_direct_most_rays(const alpi_direct *direct, bool extended, uint32_t receivers);

/// Whether there is light besides that of polygons.
static inline bool alpi_direct_has_others(const alpi_direct *d)
{
    return d->lamp_count > 0 || d->sun_count > 0 || d->emitters.all.count > 0 || d->sky != NULL;
}

/// Writes one part of a receiver to the parts and groups of an output.
void alpi_direct_put_part(const alpi_direct_output *output, uint32_t part_count, uint32_t part,
                          uint32_t receiver, const alpi_reference_value *value);

#endif
