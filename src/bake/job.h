// SPDX-License-Identifier: MIT
// The job of one bake: its options, what the stages make of them, and the report.
#ifndef ALPI_BAKE_JOB_H
#define ALPI_BAKE_JOB_H

#include "base/memory.h"
#include "base/tasks.h"
#include "maps/lightmap.h"
#include "maps/radiosity/layer_arrays.h"
#include "maps/texels/lattice.h"
#include "maps/texels/scratch.h"
#include "maps/texels/validity.h"
#include "transport/directional.h"
#include "transport/occlusion/occlusion.h"

#include <alpenglow/bake.h>

/// An image of the scene that occlusion is packed into.
typedef struct alpi_pack_target {
    uint32_t image; // of the scene
    uint8_t *png;   // owned, NULL until it is made
    size_t png_size;
} alpi_pack_target;

/// The plan of --ao-into orm: which materials read their occlusion from which image.
typedef struct alpi_packing {
    uint32_t count;
    alpi_pack_target *targets;  // [count], as many as images at most
    uint32_t *material_targets; // [materials] index into targets, ALPI_NONE = a separate map; or
                                // NULL: all
} alpi_packing;

/// Light in the form that goes into the asset; all zero while there is none.
typedef struct alpi_light_asset {
    uint8_t **files;    // [pages of the lightmap] encoded
    size_t *file_sizes; // [pages]
    float *scales; // [materials + 1] the value that 1 stands for; last: surfaces without material
    float scale;   // the largest of those that are used
} alpi_light_asset;

/// The layers of light; none unless the options ask for them.
typedef struct alpi_layer_plan {
    alpi_layer_arrays light;       // room is made where light is gathered
    char *names[ALPI_LAYER_LIMIT]; // [light.count] unlike, and fit for names of files
    uint32_t *part_layers;         // [parts of direct light] the layer of each
    uint32_t sky;                  // its layer; ALPI_NONE: there is none
} alpi_layer_plan;

/// A group of texels that the same surfaces occlude. The whole scene is one object; with ao_self
/// every node with its primitives is one.
typedef struct alpi_object {
    const uint32_t *texels; // [texel_count] in the order of the lattice
    uint32_t texel_count;
    uint32_t first_surface, surface_count; // in alpi_objects.surfaces; 0: the scene's occluders
    float distance;                        // limit in metres, INFINITY = none
    const uint32_t *valid; // [valid_count] texels that get a value of their own, in the same order
    uint32_t valid_count;
    uint32_t samples; // that a traced texel took for occlusion
} alpi_object;

typedef struct alpi_objects {
    alp_context *context;
    uint32_t count;
    alpi_object *items;
    uint32_t *surfaces; // of the objects, one after the other
    uint32_t *texels;   // of the objects, one after the other; NULL: those of the order
    bool *marks;        // [scene surfaces] all false between calls
} alpi_objects;

/// State that the stages from receivers to store share. alpi_bake_receivers opens it,
/// alpi_bake_store closes it; where a stage fails, alpi_gathering_close does.
typedef struct alpi_gathering {
    double began; // alpi_seconds()
    alpi_lattice lattice;
    alpi_objects objects;
    uint32_t *valid; // [valid_count] of the objects, one after the other
    uint32_t valid_count;
    alpi_scratch scratch; // sums of rays; light releases it
    alpi_validity validity;
    const alpi_object *open; // the object that the next three belong to; NULL: none
    alpi_tracer *tracer, *owned;
    alpi_occlusion_setup setup;
} alpi_gathering;

typedef struct alpi_bake_job {
    const alp_scene *scene;
    alp_context *context;
    alp_bake_options options;
    // Choose fills these.
    bool *only, *occluders; // [surface_count] those of the patterns, NULL = all
    uint32_t *originals;    // [surface_count] of alpi_scene_instances; NULL unless ao_self
    alpi_packing packing;
    alpi_layer_plan layers;
    // Atlas fills these.
    alp_lightmap *lightmap;
    alpi_watch told;       // progress of the caller, while a checkpoint notes it
    const char *stage;     // that allocates now
    uint64_t memory_limit; // bytes that the bake may hold beside those held before it; 0: any
    uint64_t held;         // bytes before the bake
    alpi_budget budget;    // of the context, before the bake
    // The stages that gather fill these, and store moves them to the pages of the lightmap. All are
    // [texels], and NULL unless a map needs them.
    alpi_gathering gathering;
    float (*bent)[3], (*obscurance)[3];
    float (*irradiance)[3], (*irradiance_errors)[3];
    float (*direct)[3], (*bounced)[3]; // both or none
    alpi_directional *directional;
    alp_probes *probes; // or NULL
    // Write fills this.
    alpi_light_asset light_asset;
    alp_bake_report report;
} alpi_bake_job;

/// Tells the user that a stage begins.
/// @return ALP_OK; CANCELLED: the user said no
alp_result alpi_bake_begin_stage(alpi_bake_job *job, const char *stage);

/// Warns where nearly nothing is open.
void alpi_bake_warn_of_darkness(const alpi_bake_job *job);

#endif
