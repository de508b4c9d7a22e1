// SPDX-License-Identifier: MIT
// How the light of a bake is computed: the choices that follow from its options.
#ifndef ALPI_BAKE_LIGHT_SETTINGS_H
#define ALPI_BAKE_LIGHT_SETTINGS_H

#include "bake/job.h"
#include "maps/radiosity/radiosity.h"
#include "transport/gather/cosine_rays.h"
#include "transport/gather/hemicube.h"

enum {
    /// Replicates of a texel's rays. Their spread gives the noise.
    ALPI_LIGHT_REPLICATES = 4,
    /// The fewest rays of the first round: with 32 the teapot room states .82 of its error, with 64
    /// .90 (`alpenglow bench truth`, for 4 %).
    ALPI_LIGHT_FIRST_RAYS = 64,
    /// Texels of the pilot (light_plan.c).
    ALPI_LIGHT_PILOT_TEXELS = 256
};

typedef struct alpi_light_settings {
    bool in_rounds;          // for an error, a time limit, or a user who may end the bake
    bool adaptive;           // rounds of all texels interpolate between traced texels
    bool piloted;            // a pilot plans the first round
    uint32_t patch_rays;     // rays of a patch, or pixels of its hemicube
    uint32_t direct_samples; // of each light at a texel, in the first round
    uint32_t own_direct;     // the same on an atlas of the whole scene (--only)
    uint32_t most_rays;      // of a texel
    double tolerance;        // share of the light that bounce passes may leave out
    double ray_limit;        // rays of light in all; HUGE_VAL: any number
    double pass_ray_limit;   // rays of the bounce passes; 0: any number
} alpi_light_settings;

/// @param texels of the map   @param lit those with light of their own
alpi_light_settings alpi_light_choose(const alpi_bake_job *job, uint64_t texels, uint32_t lit);
/// Whether light is gathered in rounds.
bool alpi_light_is_in_rounds(const alp_bake_options *options);

/// How patches gather, and how texels do.
typedef struct alpi_light_gatherers {
    alpi_cosine_rays patch_rays;
    alpi_hemicube *patch_cube, *texel_cube; // NULL: cosine rays
    alpi_hemicube_options patch_cubes, texel_cubes;
    alpi_gatherer patches, texels; // texels: by hemicubes alone
    bool counted;                  // emissive surfaces bring the light that hemicubes count, and
    alp_scene dark;                // direct light is sampled in the scene without them
} alpi_light_gatherers;

/// @param gatherers out: points into itself; cleared by alpi_light_gatherers_clear in any case
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_light_gatherers_create(const alpi_bake_job *job,
                                       const alpi_light_settings *settings,
                                       alpi_light_gatherers *gatherers);
void alpi_light_gatherers_clear(alpi_light_gatherers *gatherers);

/// The sky split. A sky without bright spots is gathered by the rays of bounced light; its bright
/// spots are sampled as direct light, with all other lights. Panes would mix the two.
typedef struct alpi_light_sources {
    const alpi_lighting *gathered; // rays that leave the scene find its sky, if the sky is split
    const alpi_lighting *sampled;  // direct light
    const alpi_lighting *near;     // direct light of near rays (light_gather.c)
    alpi_lighting *soft, *spots;   // owned; NULL: the sky is not split
} alpi_light_sources;

/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_light_split_sky(const alpi_bake_job *job, const alpi_lighting *lighting,
                                const alpi_tracer *tracer, alpi_light_sources *sources);
void alpi_light_sources_clear(alp_context *context, alpi_light_sources *sources);

#endif
