// SPDX-License-Identifier: MIT
// Radiosity: light that surfaces reflect, bounce by bounce.
//
// On every patch x with direct light E₀ and reflectance ρ, bounce pass k gathers
//
//     Eₖ(x) = ∫ ρ/π (E₀ + Eₖ₋₁) cosθ dω    over the surfaces that x sees, with no E at pass 0
//
// so that E₀ + Eₖ is the light after k bounces. alpi_direct computes direct light, which has sharp
// edges. A sky without bright spots is soft: the gathered rays that leave the scene measure it.
// Based on: C. M. Goral, K. E. Torrance, D. P. Greenberg, B. Battaile. Modeling the Interaction of
//           Light Between Diffuse Surfaces. SIGGRAPH 1984; H. Elias. Radiosity.
#ifndef ALPI_MAPS_RADIOSITY_H
#define ALPI_MAPS_RADIOSITY_H

#include "maps/radiosity/layer_arrays.h"
#include "maps/radiosity/patches.h"
#include "transport/direct/direct.h"

enum { ALPI_RADIOSITY_PASS_LIMIT = 1024, ALPI_RADIOSITY_CHANGES = 64 };

typedef struct alpi_radiosity_options { // all pointers are borrowed
    alp_context *context;
    const alp_scene *scene;
    const alpi_tracer *tracer;
    const alpi_lighting *lighting; // all light
    const alpi_lighting *direct; // light of alpi_direct: all, or all but a soft sky (then the scene
                                 // has no panes)
    const alp_scene *direct_scene; // scene whose emissive surfaces are direct light; NULL: `scene`
    const alpi_gatherer *counted;  // measures the emissive surfaces that `direct_scene` lacks, at
                                   // each texel (counted_emitters.h); NULL: there are none
    alpi_trace_filter filter;
    const alpi_gatherer *gatherer; // of patches
    uint32_t bounces;              // limit, ≥ 1; above PASS_LIMIT: until the tolerance is met
    double tolerance;         // passes end when later ones would add a smaller share of all light
    double ray_limit;         // of the passes, if panes prevent that rays are kept; 0: none
    const uint8_t *proximity; // [texels] of alpi_patches_create
    uint32_t direct_samples;  // of each light at each texel
    bool directional;         // also computes the direction of direct light
    uint64_t kept_limit;      // bytes of kept rays, within the budget; if they need more, each pass
                              // traces its rays again
    bool backs;               // true: all backs of double-sided materials gather; false: those that
                              // the rays of other receivers meet, enough for light on fronts
    uint64_t seed;
    alpi_layer_arrays *layers; // NULL, or filled, except `bounced`
} alpi_radiosity_options;

/// Options for bakes and pictures, without scene, tracer, lighting, filter, gatherer and seed.
alpi_radiosity_options alpi_radiosity_options_default(void);
/// The tolerance if no error is stated. A limited number of bounces is computed completely.
double alpi_radiosity_tolerance(uint32_t bounces);
enum { ALPI_RADIOSITY_PATCH_RAYS = 64 }; // cosine rays of a patch

/// Energy balance: fluxes in W, means of the channels, integrals over the areas of the receivers.
/// Within the noise of the rays, emitted = absorbed + escaped + lost_behind + unshot.
typedef struct alpi_energy {
    double emitted; // by surfaces, plus direct light of lamps, suns and sky
    double absorbed;
    double escaped;     // out of the scene, by the rays that hit nothing
    double lost_behind; // into black backs of surfaces, by the rays that hit them
    double unshot;      // reflected by the last bounce and gathered no more
    bool known;         // false: the scene has panes, so rays were not counted
} alpi_energy;

typedef struct alpi_radiosity {
    alpi_radiosity_options options;
    const alpi_receivers *texels;  // receivers of later direct light; NULL: those of the patches
    alpi_patches patches;          // cells hold the light that the last bounce gathers
    alpi_reference_value *direct;  // [texels] fronts: E₀ with its variance, without a soft sky
    alpi_directional *directional; // [texels] of direct light on fronts, or NULL
    float (*skies)[3];             // [sides × patches] E of a soft sky
    alpi_reference_value *bounced; // [sides × patches] E of the last pass
    float (*before)[3];            // [sides × patches] E of the pass before
    float (*lost)[2];              // [sides × patches] see alpi_gather_job
    uint32_t *receivers;           // [receiver_count] patches that gather: fronts, seen backs
    uint32_t receiver_count;
    uint32_t passes;
    float changes[ALPI_RADIOSITY_CHANGES]; // |Eₖ − Eₖ₋₁| over all light, by area; first passes only
    bool kept;                             // rays were traced once
    double missing;     // if ray_limit ended the passes: estimated share of later bounces; else 0
    bool backs_dropped; // direct light of backs was freed
    uint64_t rays;
    double direct_seconds; // time of direct light
    double direct_draw;    // see alpi_direct_output
    alpi_energy energy;
} alpi_radiosity;

/// Solves for the patches of an atlas.
/// @param order [count] texels with light of their own, neighbours together
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_radiosity_solve(const alpi_radiosity_options *options, const alpi_lattice *lattice,
                                const alp_atlas *atlas, const uint32_t *order, uint32_t count,
                                const alpi_task_progress *progress, alpi_radiosity *radiosity);
void alpi_radiosity_destroy(alpi_radiosity *radiosity);
/// Frees all that only solving needs. The last bounce can still be gathered, and direct light
/// sampled again. With layers, nothing is freed.
/// @param relit whether alpi_radiosity_relight will be called: its data stay too
void alpi_radiosity_trim(alpi_radiosity *radiosity, bool relit);

/// Writes the light of one layer into the cells, as the last bounce gathers it; ALPI_NONE: of all
/// layers, as after alpi_radiosity_solve, with the direct light of now.
/// @param gathered NULL, or [texels] light that the fronts of texels gathered themselves, with the
///                 soft sky; it replaces the coarser light of patches
/// @return ALP_OK; CANCELLED
alp_result alpi_radiosity_relight(const alpi_radiosity *radiosity, uint32_t layer,
                                  const alpi_reference_value *gathered,
                                  const alpi_task_progress *progress);

/// Direct light of listed texels (fronts, then backs), by new samples. Adds that of each layer to
/// the layer's own.
/// @param output [sides × texels] of those listed
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_radiosity_direct(const alpi_radiosity *radiosity, const uint32_t *list,
                                 uint32_t count, uint32_t samples, uint64_t seed,
                                 const alpi_task_progress *progress, alpi_direct_output *output);

/// The scene from which other receivers gather the last bounce.
alpi_gather_scene alpi_radiosity_scene(const alpi_radiosity *radiosity);

/// Light on the visible part of a texel's front over its mean light, 1 to 4. A texel that lies
/// partly in a solid has dark points that no ray meets. Rays that end on backs of surfaces, in
/// excess of those of the neighbours, measure the hidden share.
/// @param patch of the texel
float alpi_radiosity_visible_gain(const alpi_radiosity *radiosity, uint32_t texel, uint32_t patch);
/// Fills radiosity->energy from the last pass. @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_radiosity_measure_energy(alpi_radiosity *radiosity,
                                         const alpi_task_progress *progress);

#endif
