// SPDX-License-Identifier: MIT
// Radiosity: light that goes from surface to surface until nothing is left of it.
//
// On every patch x, with direct light E₀ and reflectance ρ, pass k gathers
//
//     Eₖ(x) = ∫ ρ/π (E₀ + Eₖ₋₁) cosθ dω    over the surfaces that x sees, E at pass 0 = 0
//
// so that E₀ + Eₖ is the light after k bounces. Direct light is apart: it has edges, and better
// ways to find it (alpi_direct). Only a soft sky's is left to the rays that leave the scene, which
// are many, and miss no light of a sky without bright spots.
// Based on: C. M. Goral, K. E. Torrance, D. P. Greenberg, B. Battaile. Modeling the Interaction of
//           Light Between Diffuse Surfaces. SIGGRAPH 1984; H. Elias. Radiosity.
#ifndef ALPI_MAPS_RADIOSITY_H
#define ALPI_MAPS_RADIOSITY_H

#include "maps/radiosity/light_layers.h"
#include "maps/radiosity/patches.h"
#include "transport/direct/direct.h"

enum { ALPI_RADIOSITY_PASS_LIMIT = 1024, ALPI_RADIOSITY_CHANGES = 64 };

typedef struct alpi_radiosity_options {
    alp_context *context;
    const alp_scene *scene;
    const alpi_tracer *tracer;
    const alpi_lighting *lighting; // all light
    const alpi_lighting *direct;   // that alpi_direct looks for: all of it, or all but a soft sky
                                   // (then no panes)
    const alp_scene *direct_scene; // whose emissive surfaces it looks for; NULL: those of `scene`
    const alpi_gatherer *counted;  // sees the emissive surfaces that it does not, at each texel;
                                   // NULL: there are none
    alpi_trace_filter filter;
    const alpi_gatherer *gatherer; // how blocks gather; all borrowed
    uint32_t bounces;              // ≥ 1, at most; above PASS_LIMIT: as many as it takes
    double tolerance; // passes end where those that are left would bring less, over all light
    double ray_limit; // of the passes where rays cannot be kept, for panes; 0: none
    alpi_block_rule blocks;
    uint32_t direct_samples; // of each light at each texel
    bool directional;        // direct light is wanted by its direction
    uint64_t kept_limit; // bytes that kept rays may take, within the budget; where they need more,
                         // rays are traced every pass
    bool backs; // all backs of double-sided materials gather; else those alone that some other who
                // gathers sees: enough for light on fronts
    uint64_t seed;
    alpi_light_layers *layers; // NULL, or filled, but for what the texels gather
} alpi_radiosity_options;

/// Options for bakes and pictures alike, without scene, tracer, lighting, filter, gatherer and
/// seed.
alpi_radiosity_options alpi_radiosity_options_default(void);
/// Of a solution for no error in particular: of a number of bounces none is left out.
double alpi_radiosity_tolerance(uint32_t bounces);
enum { ALPI_RADIOSITY_BLOCK_RAYS = 64 }; // of cosine rays that gather for blocks

/// Where the light goes: fluxes in W, means of the three channels, area integrals over the patches
/// that were gathered for. They close to the noise of the rays:
/// emitted = absorbed + escaped + lost_behind + unshot.
typedef struct alpi_energy {
    double emitted;  // by surfaces, and what lamps, suns and sky bring directly
    double received; // of it, directly
    double absorbed;
    double escaped;     // out of the scene, counted by the rays that meet nothing
    double lost_behind; // into black backs of surfaces, by the rays that meet them
    double unshot;      // reflected by the last bounce and not gathered any more
    bool known;         // false: panes let light through, and rays are not counted
} alpi_energy;

typedef struct alpi_radiosity {
    alpi_radiosity_options options;
    const alpi_receivers *texels;  // whose direct light is asked for again; NULL: of the patches
    alpi_patches patches;          // cells hold what the last bounce wanted brings
    alpi_reference_value *direct;  // [texels] of fronts: E₀ with its variance, a soft sky apart
    alpi_directional *directional; // [texels] of direct light on fronts, or NULL
    float (*skies)[3];             // [sides × blocks] E of a soft sky
    alpi_reference_value *bounced; // [sides × blocks] E of the last pass
    float (*before)[3];            // [sides × blocks] of the one before
    float (*lost)[2];              // [sides × blocks] see alpi_gather_job
    uint32_t *receivers;           // [receiver_count] blocks that gather: fronts, seen backs
    uint32_t receiver_count;
    uint32_t passes;
    float
        changes[ALPI_RADIOSITY_CHANGES]; // |Eₖ − Eₖ₋₁| over all light, by area; of the first passes
    bool kept;                           // rays were traced once
    double missing;                      // light of later bounces over all light, about, where the
                                         // passes ended by ray_limit; else 0
    bool backs_dropped;                  // direct light of backs is known no more
    uint64_t rays;
    double direct_seconds; // that direct light took
    double direct_draw;    // see alpi_direct_output
    alpi_energy energy;
} alpi_radiosity;

/// Light of what rays can meet of a texel's front, over that of all its points; 1 to 4. Where other
/// geometry covers a part of it, finer than validity tells, some points lie in that: they are dark
/// and nothing meets them. How many is told by the rays that end on backs of surfaces, more than
/// those of the texels beside do.
/// @param block of the texel
float alpi_radiosity_brighter(const alpi_radiosity *radiosity, uint32_t texel, uint32_t block);
/// Fills radiosity->energy, by what blocks gathered last. @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_radiosity_find_energy(alpi_radiosity *radiosity,
                                      const alpi_task_progress *progress);

/// Solves for the patches of an atlas.
/// @param order [count] texels with light of their own, neighbours together
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_radiosity_solve(const alpi_radiosity_options *options, const alpi_lattice *lattice,
                                const alp_atlas *atlas, const uint32_t *order, uint32_t count,
                                const alpi_task_progress *progress, alpi_radiosity *radiosity);
void alpi_radiosity_destroy(alpi_radiosity *radiosity);
/// Lets go of what only solving takes: what is left gives direct light by other samples, and is
/// looked at by who gathers the last bounce. With layers, which are shown one by one, all stays.
/// @param shown_again whether alpi_radiosity_show will be called: what it takes stays too
void alpi_radiosity_settle(alpi_radiosity *radiosity, bool shown_again);

/// Puts the light of one layer into the cells, as it goes into the last bounce; ALPI_NONE: of all
/// of them, which is there after solving, by the direct light of then.
/// @param gathered NULL, or [texels] what fronts have gathered by rays of their own, the soft sky's
///                 included, in the place of what blocks did, which have one value for all of their
///                 texels
/// @return ALP_OK; CANCELLED
alp_result alpi_radiosity_show(const alpi_radiosity *radiosity, uint32_t layer,
                               const alpi_reference_value *gathered,
                               const alpi_task_progress *progress);

/// Direct light of listed texels (fronts, then backs) as the solution's own, by other samples. That
/// of each layer is added to what it has.
/// @param output [sides × texels] of those listed
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED
alp_result alpi_radiosity_direct(const alpi_radiosity *radiosity, const uint32_t *list,
                                 uint32_t count, uint32_t samples, uint64_t seed,
                                 const alpi_task_progress *progress, alpi_direct_output *output);

/// What gatherers look at to find the light of the last bounce at other receivers.
alpi_gather_scene alpi_radiosity_scene(const alpi_radiosity *radiosity);

#endif
