// SPDX-License-Identifier: MIT
// The job of one bake, shared by the files of this room.
#ifndef ALPI_BAKE_JOB_H
#define ALPI_BAKE_JOB_H

#include "base/file_set.h"
#include "base/memory.h"
#include "maps/lightmap.h"
#include "maps/radiosity/light_layers.h"
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

/// What --ao-into orm comes to: which materials read their occlusion from which image.
typedef struct alpi_packing {
    uint32_t count;
    alpi_pack_target *targets;  // [count], as many as images at most
    uint32_t *material_targets; // [materials] index into targets, ALPI_NONE = a separate map; or
                                // NULL: all
} alpi_packing;

/// Light as it goes into the asset: all zero while there is none.
typedef struct alpi_light_asset {
    uint8_t **files;    // [pages of the lightmap] encoded
    size_t *file_sizes; // [pages]
    float *scales; // [materials + 1] what 1 in them stands for; last: surfaces without material
    float scale;   // the largest of those that are used
} alpi_light_asset;

/// Layers of light: none unless they are asked for.
typedef struct alpi_layer_plan {
    alpi_light_layers light;       // room is made where light is gathered
    char *names[ALPI_LAYER_LIMIT]; // [light.count] unlike, and fit for names of files
    uint32_t *part_layers;         // [parts of direct light] the layer of each
    uint32_t sky;                  // its layer; ALPI_NONE: there is none
} alpi_layer_plan;

typedef struct alpi_bake_job {
    const alp_scene *scene;
    alp_context *context;
    alp_bake_options options;
    bool *only, *occluders; // [surface_count] those of the patterns, NULL = all
    uint32_t *originals;    // [surface_count] of alpi_scene_instances; NULL unless ao_self
    alp_lightmap *lightmap;
    float (*bent)[3], (*obscurance)[3];              // [texels] while sampling; NULL: not asked for
    float (*irradiance)[3], (*irradiance_errors)[3]; // [texels] once they are known
    float (*direct)[3], (*bounced)[3];               // the same, apart, both or none
    alpi_directional *directional;                   // [texels] while sampling; NULL: not asked for
    alpi_scratch scratch;                            // while sampling
    alpi_validity validity;                          // while sampling
    double sampling_began;                           // alpi_seconds()
    const char *stage;                               // that allocates now
    uint64_t memory_limit; // bytes that the bake may hold, all that was held before apart; 0: any
    alpi_budget budget;    // of the context, before the bake
    alpi_packing packing;
    alpi_light_asset light_asset;
    alpi_layer_plan layers;
    alp_bake_report report;
} alpi_bake_job;

/// Fills only, occluders, originals and report.surfaces_baked.
/// @return ALP_OK; INVALID_ARGUMENT: a pattern that matches nothing, or occluders with ao_self
alp_result alpi_bake_choose(alpi_bake_job *job);

/// Tells the user that a stage begins; false from the user cancels.
alp_result alpi_bake_begin_stage(alpi_bake_job *job, const char *stage);

/// Occlusion at the texels of the lightmap, stored in it; fills the report.
alp_result alpi_bake_occlusion(alpi_bake_job *job);

/// Refuses maps that have no meaning together with the other options.
alp_result alpi_bake_check_maps(const alpi_bake_job *job);
/// Room for what the maps besides occlusion need while they are gathered, and its end.
alp_result alpi_bake_begin_side_maps(alpi_bake_job *job);
void alpi_bake_end_side_maps(alpi_bake_job *job);
/// Coloured obscurance of the texels in `order`, if it was asked for; `samples` rays each. The
/// stage of `progress` is set here.
alp_result alpi_bake_obscurance(alpi_bake_job *job, const alpi_occlusion_setup *setup,
                                const alpi_receivers *receivers, const uint32_t *order,
                                uint32_t order_count, uint32_t samples,
                                const alpi_task_progress *progress);
/// Whether direct and bounced light get maps of their own.
bool alpi_bake_lights_apart(const alpi_bake_job *job);
/// Whether any map is asked for that needs occlusion.
bool alpi_bake_wants_occlusion(const alpi_bake_job *job);
/// Irradiance of the texels in `order`, if it was asked for; fills the report. The stage of
/// `progress` is set here.
alp_result alpi_bake_irradiance(alpi_bake_job *job, const alpi_tracer *tracer,
                                const alpi_receivers *receivers, const uint32_t *order,
                                uint32_t count, const alpi_lattice *lattice,
                                const alpi_task_progress *progress);
/// Stores them in the lightmap, whose states are known.
alp_result alpi_bake_store_side_maps(alpi_bake_job *job);

/// Measures the seams of the stored maps, and stitches these if that is asked for; fills the
/// report.
alp_result alpi_bake_seams(alpi_bake_job *job);

/// Keeps the allocations of the bake within options.sampling.memory_limit, or nine tenths of the
/// machine's memory.
void alpi_bake_begin_budget(alpi_bake_job *job);
/// Puts the context's own budget back. @return the result of the bake; LIMIT, with a message that
/// names the stage, in place of OUT_OF_MEMORY where the budget refused an allocation
alp_result alpi_bake_end_budget(alpi_bake_job *job, alp_result result);
/// Bytes that the large arrays of a bake on this atlas take at its peak, and the stage in which
/// they do. Small arrays and kept rays are left out: the bake needs somewhat more.
typedef struct alpi_memory_forecast {
    const char *stage;
    uint64_t bytes;
} alpi_memory_forecast;
alpi_memory_forecast alpi_bake_forecast_memory(const alpi_bake_job *job,
                                               const alp_atlas_info *atlas);
/// LIMIT when that is more than the bake may hold: better now than after an hour of rays.
alp_result alpi_bake_check_memory(const alpi_bake_job *job, const alp_atlas_info *atlas);

/// Refuses a format that cannot hold the maps.
alp_result alpi_bake_check_maps_format(const alpi_bake_job *job);
/// ".exr" …: of maps that are no PNGs.
const char *alpi_bake_map_ending(const alp_bake_options *options);
/// A file of the maps folder on its way there.
typedef struct alpi_map_file {
    uint8_t *bytes; // released by who keeps it
    size_t size;
} alpi_map_file;
/// Encodes a page of a map, a float image of four channels; says where it had to be scaled.
/// @param name of the map, for that
alp_result alpi_bake_encode_map(const alpi_bake_job *job, const alp_image *image, const char *name,
                                uint32_t page, alpi_map_file *file);

/// Fails before the long work if an output could not be written at its end. Asked for one page
/// before the atlas is made, and for all of them after.
alp_result alpi_bake_check_outputs(const alpi_bake_job *job, uint32_t pages);
/// The same of the asset alone: makes no folder, so that an estimate may ask.
alp_result alpi_bake_check_output(const alpi_bake_job *job, uint32_t pages);
/// Whether the asset is made anew from the scene in world space, instead of from the file it is of.
bool alpi_bake_exports(const alpi_bake_job *job);
/// Writes maps and asset; nothing appears at its place before everything is encoded.
alp_result alpi_bake_write_outputs(alpi_bake_job *job);

/// Decides which images occlusion is packed into, and says why not where it is not.
alp_result alpi_bake_plan_packing(alpi_bake_job *job);
/// Makes those images from the finished maps.
alp_result alpi_bake_pack_images(alpi_bake_job *job);
void alpi_bake_release_packing(alpi_bake_job *job);
/// Whether the occlusion of a triangle is packed into an image.
bool alpi_bake_is_packed(const alpi_bake_job *job, uint32_t triangle);

/// Refuses choices of light in an asset that have no meaning.
alp_result alpi_bake_check_light_asset(const alpi_bake_job *job);
/// Encodes the pages of light as they go into the asset, if they are to.
alp_result alpi_bake_make_light_asset(alpi_bake_job *job);
void alpi_bake_release_light_asset(alpi_bake_job *job);
/// Whether a viewer's own file is written in the place of an asset (viewer_file.c).
bool alpi_bake_is_viewer_file(const alp_bake_options *options);
/// Its ending, and that all its files can be written.
alp_result alpi_bake_check_viewer_file(const alpi_bake_job *job, uint32_t pages);
/// It, and the pictures that it names.
alp_result alpi_bake_add_viewer_file(const alpi_bake_job *job, alpi_file_set *files);
/// ".png", ".ktx2" …
const char *alpi_bake_light_ending(const alp_bake_options *options);
/// "irradiance" …
const char *alpi_bake_light_units(const alp_bake_options *options);

/// Refuses what has no meaning together with the choice of values at vertices or of maps.
alp_result alpi_bake_check_vertex_options(const alpi_bake_job *job);
/// The whole job of ALP_ATLAS_VERTEX, after the options were checked.
alp_result alpi_bake_vertices(alpi_bake_job *job);

/// The object that goes to asset.extras.alpenglow, as text that the caller releases; NULL without
/// memory.
char *alpi_bake_make_extras(const alpi_bake_job *job);
/// A warning when nearly nothing is open.
void alpi_bake_warn_of_darkness(const alpi_bake_job *job);

/// Multiplies each value by the occlusion map that the texel's material has already; not those that
/// are packed, which are multiplied where they go to.
void alpi_bake_multiply_existing(const alpi_bake_job *job, float *accessibility);

#endif
