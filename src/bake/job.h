// SPDX-License-Identifier: MIT
// The job of one bake, shared by the files of this room.
#ifndef ALPI_BAKE_JOB_H
#define ALPI_BAKE_JOB_H

#include "base/file_set.h"
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
    uint64_t kept_limit;                             // bytes that the rays of blocks may take
    alpi_packing packing;
    alpi_light_asset light_asset;
    alpi_layer_plan layers;
    alp_bake_report report;
} alpi_bake_job;

/// Fills only, occluders, originals and report.surfaces_baked.
/// @return ALP_OK; INVALID_ARGUMENT: a pattern that matches nothing, or occluders with ao_self
alp_result alpi_bake_choose(alpi_bake_job *job);

/// Tells the user that a stage begins; false from the user cancels.
alp_result alpi_bake_begin_stage(const alpi_bake_job *job, const char *stage);

/// Occlusion at the texels of the lightmap, stored in it; fills the report.
alp_result alpi_bake_occlusion(alpi_bake_job *job);

/// Room for what the maps besides occlusion need while they are gathered, and its end.
alp_result alpi_bake_begin_side_maps(alpi_bake_job *job);
void alpi_bake_end_side_maps(alpi_bake_job *job);
/// Coloured obscurance of the texels in `order`, if it was asked for; `samples` rays each. The
/// stage of `progress` is set here.
alp_result alpi_bake_obscurance(alpi_bake_job *job, const alpi_occlusion_setup *setup,
                                const alpi_receivers *receivers, const uint32_t *order,
                                uint32_t order_count, uint32_t samples,
                                const alpi_task_progress *progress);
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

/// Bytes of ours that a bake with these options on this atlas holds at its peak, the scene and the
/// tracer apart.
uint64_t alpi_bake_memory(const alp_atlas_info *atlas, const alp_scene *scene,
                          const alp_bake_options *options);
/// LIMIT when that is more than the limit or nine tenths of the machine's memory, even if no rays
/// are kept; sets job->kept_limit.
/// @param more_pieces of texels, beyond one of each
alp_result alpi_bake_check_memory(alpi_bake_job *job, const alp_atlas_info *atlas,
                                  uint64_t more_pieces);

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
/// Bytes that this takes at its peak, of `page` texels, besides the encoded ones.
uint64_t alpi_bake_map_file_memory(const alp_bake_options *options, uint64_t page);

/// Fails before the long work if an output could not be written at its end. Asked for one page
/// before the atlas is made, and for all of them after.
alp_result alpi_bake_check_outputs(const alpi_bake_job *job, uint32_t pages);
/// The same of the asset alone: makes no folder, so that an estimate may ask.
alp_result alpi_bake_check_output(const alpi_bake_job *job, uint32_t pages);
/// Writes maps and asset; nothing appears at its place before everything is encoded.
alp_result alpi_bake_write_outputs(alpi_bake_job *job);

/// Decides which images occlusion is packed into, and says why not where it is not.
alp_result alpi_bake_plan_packing(alpi_bake_job *job);
/// Makes those images from the finished maps.
alp_result alpi_bake_pack_images(alpi_bake_job *job);
void alpi_bake_release_packing(alpi_bake_job *job);
/// Bytes that making them takes at its peak, besides the encoded ones.
uint64_t alpi_bake_packing_memory(const alpi_bake_job *job);
/// Whether the occlusion of a triangle is packed into an image.
bool alpi_bake_is_packed(const alpi_bake_job *job, uint32_t triangle);

/// Encodes the pages of light as they go into the asset, if they are to.
alp_result alpi_bake_make_light_asset(alpi_bake_job *job);
void alpi_bake_release_light_asset(alpi_bake_job *job);
/// Bytes that making it takes at its peak, besides the encoded ones.
uint64_t alpi_bake_light_asset_memory(const alp_atlas_info *atlas, const alp_scene *scene,
                                      const alp_bake_options *options);
/// Fails if one of its files could not be written.
alp_result alpi_bake_check_viewer_file(const alpi_bake_job *job, uint32_t pages);
/// It, and the pictures that it names.
alp_result alpi_bake_add_viewer_file(const alpi_bake_job *job, alpi_file_set *files);
/// ".png", ".ktx2" …
const char *alpi_bake_light_ending(const alp_bake_options *options);
/// "irradiance" …
const char *alpi_bake_light_units_name(const alp_bake_options *options);

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
