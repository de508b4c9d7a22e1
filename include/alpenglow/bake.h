// SPDX-License-Identifier: MIT
// The whole job in one call: atlas, occlusion, light, maps and files.
#ifndef ALPENGLOW_BAKE_H
#define ALPENGLOW_BAKE_H

#include <alpenglow/atlas.h>
#include <alpenglow/checkpoint.h>
#include <alpenglow/image.h>
#include <alpenglow/light.h>
#include <alpenglow/lightmap.h>
#include <alpenglow/occlusion.h>
#include <alpenglow/probes.h>

ALP_BEGIN_DECLS

/// Treatment of an occlusion map that a material already has.
typedef enum alp_existing_ao {
    ALP_EXISTING_AO_REPLACE = 0,  ///< the new map replaces it (default)
    ALP_EXISTING_AO_MULTIPLY = 1, ///< new times old, read at each texel, replaces it
    ALP_EXISTING_AO_KEEP = 2      ///< the material keeps its own map
} alp_existing_ao;

/// Destination of the occlusion in a written asset.
typedef enum alp_ao_into {
    /// Maps on the pages of the atlas, with their own coordinate set (default).
    ALP_AO_INTO_SEPARATE = 0,
    /// The red channel of an image that the material has: that of roughness and metalness, else
    /// that of occlusion. The image keeps its size and its other channels. If the channel is in use
    /// as an occlusion map, existing_ao applies; else the occlusion replaces it.
    ///
    /// Some images cannot hold the occlusion: tiled ones, those with several surfaces in one place,
    /// those of 16 bits, and those that are no PNG or JPEG. Their materials get a separate map,
    /// with a warning (ao-not-packed). A texel is the mean over up to 8 × 8 points of the maps.
    /// With a packed image, the maps themselves are never multiplied by an older map.
    ALP_AO_INTO_ORM = 1
} alp_ao_into;

/// Form of ALP_MAP_LIGHT in a written asset. It uses the coordinate set that the occlusion map has
/// or would have. The asset then holds its direct and bounced light, and a viewer adds the file's
/// lights to it. Switch those off in the viewer, or bake bounced light alone (ALP_DIRECT_OFF, not
/// with EMISSIVE). An occlusion map is attached only with ALP_MAP_AO: viewers multiply it into the
/// light.
typedef enum alp_lightmap_as {
    ALP_LIGHTMAP_AS_NONE = 0, ///< none (default)
    /// The material emits the light that leaves its surface: base colour 0, emissiveTexture in
    /// 8-bit sRGB. KHR_materials_emissive_strength is the brightest texel of the material. Every
    /// viewer can display it. Materials with transmission stay unchanged; alpha is kept if it has
    /// an effect.
    ALP_LIGHTMAP_AS_EMISSIVE,
    /// The vendor extension MOZ_lightmap, in extensionsUsed and never required. The value is
    /// texel × intensity, 8-bit linear; intensity is the brightest texel of the material. Values
    /// of 1/255 of it or darker have visible steps.
    ALP_LIGHTMAP_AS_MOZ,
    /// Files beside the asset (alp_lightmap_format). Extras of the materials name them: "lightmap":
    /// {"uri", "texCoord", "intensity", "units"}. The value is texel × intensity.
    ALP_LIGHTMAP_AS_EXTRAS,
    /// Instead of an asset: a three.js Object JSON (`output` ends in .json) for ObjectLoader, r155
    /// or later. Surfaces are in world space with MeshLambertMaterial, whose colour has 8 bits of
    /// sRGB. The lightMap has half floats; lightMap × lightMapIntensity = E. Lights of the file
    /// and textures of occlusion are left out; if metals are black, so are textures of metalness
    /// (lightmap-metal).
    ALP_LIGHTMAP_AS_THREE,
    /// Instead of an asset: a .babylon file. Its light is E/π in Radiance pictures beside it,
    /// OUT.hdr, OUT.1.hdr …, of at least 8 × 8 texels. Materials are PBRMaterial with
    /// useLightmapAsShadowmap and white ambient light. Otherwise as THREE.
    ALP_LIGHTMAP_AS_BABYLON
} alp_lightmap_as;

/// Units of light in an asset. irradiance.exr is always irradiance.
typedef enum alp_light_units {
    ALP_LIGHT_UNITS_AUTO = 0,     ///< RADIANCE with EMISSIVE, else IRRADIANCE (default)
    ALP_LIGHT_IRRADIANCE,         ///< E [W·m⁻²]; three.js multiplies it by albedo / π
    ALP_LIGHT_IRRADIANCE_OVER_PI, ///< E/π; other viewers multiply it by albedo
    /// ρE/π + Lₑ [W·sr⁻¹·m⁻²], the light that leaves the front of the surface. ρ and Lₑ are means
    /// over up to 4 × 4 points of the texel, without points that alpha cuts away. The viewer
    /// applies alpha. Not with MOZ, whose readers multiply by the albedo again.
    ALP_LIGHT_RADIANCE
} alp_light_units;

/// Format of the files of ALP_LIGHTMAP_AS_EXTRAS: OUT.light.ktx2, OUT.light.1.ktx2 and so on. If
/// half floats cannot hold the values, all are divided by a power of two, the "intensity" of the
/// extras.
typedef enum alp_lightmap_format {
    ALP_LIGHTMAP_KTX2 = 0, ///< RGBA16F, one level, Zstandard; A is coverage (default)
    ALP_LIGHTMAP_EXR,      ///< half RGB, scanlines, ZIP
    ALP_LIGHTMAP_HDR       ///< Radiance RGBE, never scaled
} alp_lightmap_format;

/// Format of the files of `maps_folder`, its PNGs apart. If half floats cannot hold the values of a
/// page, its colours are divided by a power of two, with a note (maps-scaled). The file states it
/// as "alpenglowScale": an attribute of EXR, a key of KTX2.
typedef enum alp_maps_format {
    ALP_MAPS_EXR = 0,  ///< float RGBA, ZIP (default)
    ALP_MAPS_EXR_HALF, ///< half RGBA, ZIP
    ALP_MAPS_HDR,      ///< Radiance RGBE, without coverage; not with BENT, SH and DIRECTION, whose
                       ///< values have signs
    ALP_MAPS_KTX2      ///< RGBA16F, one level, Zstandard
} alp_maps_format;

/// Attribute of the values at vertices (ALP_ATLAS_VERTEX), 16 bits normalised.
typedef enum alp_vertex_attribute {
    /// COLOR_0, which viewers multiply into the base colour: R = G = B = accessibility, A = 1. If
    /// the primitive already has COLOR_0, its R, G and B are multiplied and A stays (default).
    ALP_VERTEX_COLOR = 0,
    ALP_VERTEX_OCCLUSION = 1 ///< _OCCLUSION, a scalar for custom shaders; COLOR_0 stays
} alp_vertex_attribute;

/// Method of gathering bounced light.
typedef enum alp_gather {
    ALP_GATHER_RAYS = 0,     ///< radiosity by stratified cosine rays (default)
    ALP_GATHER_HEMICUBE = 1, ///< radiosity by hemicubes
    ALP_GATHER_PATHS = 2     ///< the reference path tracer
} alp_gather;

/// Direct light in ALP_MAP_LIGHT.
typedef enum alp_direct {
    ALP_DIRECT_ON = 0,   ///< direct and bounced light (default)
    ALP_DIRECT_OFF = 1,  ///< bounced light alone
    ALP_DIRECT_APART = 2 ///< as ON, with ALP_MAP_DIRECT and ALP_MAP_BOUNCED, which add up to it
} alp_direct;

/// Method by which ALP_GATHER_HEMICUBE samples light straight from emissive surfaces.
typedef enum alp_emitters {
    ALP_EMITTERS_ANALYTIC = 0, ///< closed forms and rays aimed at them, as RAYS does (default)
    /// The pixels of each texel's hemicube that see them. Unbiased, with the error of the pixels
    /// that their edges cross: 4 % of the mean in the Cornell box at 64 pixels. A texel loses
    /// emitters that fall between pixels. Lamps, suns and skies are sampled as with ANALYTIC. Needs
    /// bounces; not with layers or `only`. Cost: the rays of the hemicubes twice.
    /// Based on: H. Elias. Radiosity.
    ALP_EMITTERS_COUNTED
} alp_emitters;

/// Options of ALP_MAP_LIGHT. Blended and transmissive materials filter light: docs/conventions.md,
/// "Sides and panes". Without bounces, each light gets its own samples. More than 64 lamps, or
/// suns, share the samples of one and are drawn in proportion to their light.
///
/// RAYS and HEMICUBE solve a radiosity. Direct light is computed at every texel. Patches of 4 × 4
/// texels of one chart gather its reflections, one pass for each bounce. Passes end with the last
/// bounce, or when further bounces would add less than a hundredth of the error (5e-5 to 5e-4 of
/// all light). With `samples` and a number of bounces, all bounces are computed. Then every texel
/// gathers the last bounce itself. Bias: within a patch, light that has bounced counts as even when
/// it bounces again. See docs/measured/accuracy.md.
/// Based on: C. M. Goral, K. E. Torrance, D. P. Greenberg, B. Battaile. Modeling the Interaction of
///           Light Between Diffuse Surfaces. SIGGRAPH 1984;
///           M. F. Cohen, D. P. Greenberg. The Hemi-Cube. SIGGRAPH 1985.
///
/// PATHS: eight neighbouring texels share the hits of their paths after the first bounce, without
/// bias. So their errors are correlated. The standard error of a texel holds; that of a mean over
/// many texels is larger than for independent texels. Scenes with blended or transmissive materials
/// share nothing.
/// Based on: P. Bekaert, M. Sbert, J. Halton. Accelerating Path Tracing by Re-Using Paths. EGWR
/// 2002.
typedef struct alp_light_options {
    alp_lighting_options lighting; ///< lights beside those and the emissive materials of the scene
    alp_gather gather;
    alp_direct direct; ///< OFF and APART: not with PATHS and not without bounces
    uint32_t bounces;  ///< at most; 0 = direct light alone; default ALP_BOUNCES_CONVERGE
    /// RAYS: wanted relative error, √(mean of squared standard errors) / mean of the map. The mean
    /// counts as more where surfaces emit more than 1,500 times of it: see
    /// alp_bake_report.light_scale. The 99th percentile of texels' errors must be at most four
    /// times as much. Rounds of more and more samples run until both are reached; the last are for
    /// the texels with the largest errors. 0 (default): `samples` in one round; with a time_limit
    /// or keep_partial in rounds that double.
    float error;
    /// With an error: the rays of the texels are limited too, and with panes those of the
    /// passes, each by a number that depends on the scene and its texels alone: 1,024 a texel of at
    /// least 2¹⁷, times ∛(2¹⁴ / T) for T > 2¹⁴ triangles, half of that with alpha masks. The bake
    /// then ends with the error that it has (ray-limit). Default false.
    bool bounded;
    /// [1, 65536], default 256. RAYS: rays of a texel, rounded up to a multiple of 32. PATHS: paths
    /// of a texel, to a multiple of 16. Without bounces: rays to each light, to a multiple of 8.
    /// HEMICUBE ignores it.
    uint32_t samples;
    /// RAYS: filters the noise of bounced light over neighbours in space, never across a wall.
    /// Every texel is then gathered. Measure it with `alpenglow bench denoise`. Default false.
    bool denoise;
    uint32_t hemicube;     ///< pixels along an edge of a hemicube, even, [2, 1024]; default 64
    alp_emitters emitters; ///< HEMICUBE; else ANALYTIC
    /// Adds a map of the light of each lamp and sun, each emissive material and the sky, in this
    /// order, its reflections included. See alp_lightmap_layer_page. Not with PATHS or denoise.
    /// Default false.
    ///
    /// Beyond 16 layers, the last is "others", the sum of the rest, with a warning (many-layers).
    /// More than 64 lamps, suns or emissive materials become one layer "lamps", "suns" or
    /// "materials".
    ///
    /// The map of all light is the sum of the layers; its stated error is that of the whole. For
    /// HEMICUBE it equals the map without layers within rounding. For RAYS it differs by noise
    /// after several rounds (error). It also differs if surfaces meet: light from surfaces within a
    /// texel counts as even over the texel that it meets. Without layers that holds only if
    /// `bounces` is a number.
    ///
    /// Cost: the rays of each round once more, one read of them for each layer, and memory: 37
    /// bytes for each texel and layer, 12 more with double-sided materials. Rays are traced again
    /// for each layer if memory_limit has no room for those of a round, or if light passes through
    /// materials.
    bool layers;
} alp_light_options;

/// Number of texels traced, their rays, and the end of a bake. With ALP_ATLAS_VERTEX every vertex
/// gets all rays: accuracy, error, time_limit and keep_partial must be default.
typedef struct alp_sampling_options {
    /// ALP_ADAPTIVE_AUTO (default): texels between traced ones are interpolated if those agree
    /// within the noise. ALP_ADAPTIVE_OFF: every texel is traced. In (0, 1): they may differ by 1 −
    /// accuracy^distance, distance in texels. .5 is a draft, .98 is careful.
    float accuracy;
    /// Wanted relative error of occlusion: √(mean of squared standard errors) / mean of the map,
    /// with the 99th percentile below four times as much. Rounds of more and more rays run until
    /// it, or occlusion.samples, is reached. 0 (default): occlusion.samples rays in one round.
    float error;
    /// Seconds after which sampling ends with its results so far; 0 = none. Light keeps its whole
    /// rounds. With ALP_MAP_LIGHT, occlusion ends after half of the time.
    double time_limit;
    /// Bytes that our own allocations may hold during the bake; 0 (default) = nine tenths of the
    /// machine's memory. Allocations made before, such as the scene, do not count. Neither does
    /// memory of Embree, jansson, libpng, libjpeg and OpenEXR. A bake that would hold more fails
    /// with LIMIT, and the message names the stage. Maps that cannot fit fail before any ray is
    /// traced. Light keeps the rays of its patches in the rest, or traces them again in each pass:
    /// the bits are the same. Ranks use the lowest limit of all.
    uint64_t memory_limit;
    /// true: a cancelled bake ends with its results so far. Light has none before its first round
    /// ends, and is then not denoised, with a warning (not-denoised). Default false: no result.
    bool keep_partial;
} alp_sampling_options;

typedef struct alp_bake_options {
    size_t struct_size;
    alp_atlas_options atlas;         ///< its progress is ignored
    alp_occlusion_options occlusion; ///< its progress is ignored
    alp_light_options light;         ///< of ALP_MAP_LIGHT
    alp_sampling_options sampling;
    /// Bits of alp_map, at least one; default ALP_MAP_AO.
    ///   An output needs AO, or LIGHT and lightmap_as: glTF has no place for other maps.
    ///   BENT and OBSCURANCE gather and report occlusion too; without AO it is not written.
    ///   OBSCURANCE takes no time_limit and no keep_partial.
    ///   LIGHT takes them with ALP_GATHER_RAYS and bounces only. It takes no ao_self and no
    ///   occluders.
    ///   PROBES needs LIGHT and maps_folder.
    ///   ALP_ATLAS_VERTEX: AO alone.
    unsigned maps;
    alp_existing_ao existing_ao; ///< of AO; ALP_ATLAS_VERTEX: REPLACE, materials keep their maps
    alp_ao_into ao_into;         ///< ALP_ATLAS_VERTEX: SEPARATE
    /// All but NONE need ALP_MAP_LIGHT and an output, and exclude ALP_AO_INTO_ORM.
    alp_lightmap_as lightmap_as;
    alp_light_units light_units;           ///< of lightmap_as; AUTO with NONE, THREE and BABYLON
    alp_lightmap_format lightmap_format;   ///< of EXTRAS; else KTX2
    alp_vertex_attribute vertex_attribute; ///< of ALP_ATLAS_VERTEX; else COLOR
    /// true: bakes every object (a node with all primitives of its mesh) as if it were alone. All
    /// nodes of a mesh share one map. The distance limit is in metres of the node that is baked; if
    /// automatic, it is one fifth of the diagonal of the object's own box. Not with `occluders` or
    /// ALP_ATLAS_VERTEX. Default false.
    bool ao_self;
    /// true: changes values beside seams of every map, by least squares, so that both sides agree.
    /// Places where light jumps far beyond noise, the rest of the seam and all change along it keep
    /// their values. A change stays near the standard error, unless the seam itself proves a larger
    /// one. All other values keep their bits; layers still add up. ALP_ATLAS_VERTEX ignores it.
    /// Default true. Based on: M. Iwanicki. Lighting Technology of The Last of Us. SIGGRAPH 2013
    /// talks.
    bool stitch;
    bool overwrite; ///< default false: an existing file stops the job before it starts
    /// Names of the surfaces that get a map: patterns with commas between. NULL (default) = all.
    /// Each pattern must match. Other surfaces are written unchanged, and occlude. Not with
    /// ALP_ATLAS_VERTEX.
    ///
    /// A surface has the name of its node, so all primitives of a node go together. A node without
    /// a name has that of its mesh, else "node N". In a pattern, * matches any characters, ? one
    /// character (of UTF-8), [a-z] one of a set, [!a-z] one outside it. \ makes the next literal.
    const char *only;
    /// Names of the surfaces that occlude, as in `only`. NULL (default) = all. Others do not block
    /// rays.
    const char *occluders;
    /// Asset to write; NULL: none. .glb, .gltf; .obj (occlusion maps, or light as emission); .dae
    /// (the same, if the scene was read from COLLADA); .json and .babylon (see alp_lightmap_as).
    const char *output;
    /// Folder of maps, made if missing; NULL: none. ALP_ATLAS_VERTEX: NULL.
    ///   AO           ao.exr, ao.1.exr …; ao.png; ao.error.exr (standard error of each texel);
    ///                ao.sampling.png (red traced, green interpolated, blue unknown)
    ///   BENT         bent.exr and bent.png (n · ½ + ½)
    ///   OBSCURANCE   obscurance.exr and .png, linear
    ///   LIGHT        irradiance.exr, irradiance.error.exr (standard error of each channel),
    ///                irradiance.NAME.exr for each layer
    ///   SH           sh.0.exr to sh.3.exr
    ///   DIRECTION    direction.exr
    ///   PROBES       scene.probes.json, scene.probes.ktx2, scene.probes.moments.ktx2
    /// Other formats have .hdr or .ktx2 instead of .exr.
    const char *maps_folder;
    /// PROBES: NULL (default) = alp_probe_options_default(). Its lighting, bounces, one_sided, seed
    /// and progress are those of the bake; it has no layers.
    const alp_probe_options *probes;
    /// Folder that keeps finished work, and the part of a shard. Default: none. It excludes
    /// sampling.time_limit. With a folder, CANCELLED keeps the work so far, and the same bake goes
    /// on from it. See checkpoint.h.
    alp_checkpoint_options checkpoint;
    alp_maps_format maps_format; ///< of maps_folder; else EXR
    /// Stages in order: "atlas" with its parts "adjacency", "clusters", "charts", "packing" and
    /// "texels"; "build"; "occlusion"; "obscurance"; "light"; "probes"; "denoise"; "dilation";
    /// "seams"; "write". With ALP_ATLAS_VERTEX: "vertices", "build", "occlusion", "detail",
    /// "write". Short stages may be skipped.
    alp_progress_fn *progress;
    void *progress_user;
} alp_bake_options;
ALP_API alp_bake_options alp_bake_options_default(void);

/// Energy balance of a radiosity: fluxes in W, means of the three channels, over the surfaces that
/// were baked and the backs that they see. To the noise of the rays, emitted = absorbed + escaped +
/// behind + unshot.
typedef struct alp_light_energy {
    bool known;      ///< false: no radiosity, or materials that let light through
    double emitted;  ///< emitted by surfaces, and received from lamps, suns and sky
    double absorbed; ///< absorbed by surfaces
    double escaped;  ///< lost by rays that leave the scene
    double behind;   ///< lost to black backs of single-sided surfaces
    double unshot;   ///< reflected by the last bounce, and not followed further
} alp_light_energy;

/// Difference of a map across its seams: |difference| of bilinear reads on both sides, over the
/// area-weighted mean of the map. Colours count as the mean of their channels.
typedef struct alp_seam_error {
    double mean;                        ///< along all seams; NaN for a black map
    double p99;                         ///< bound for 99 % of their length
    double stitched_mean, stitched_p99; ///< the same after alp_bake_options.stitch
    /// Change by stitching of texels beside seams, in units of their standard error: root mean
    /// square and largest. A standard error counts as at least 0.2 % of the map's mean.
    double change_rms, change_max;
} alp_seam_error;

/// Seams: edges of triangles across which a surface continues but reads other texels, within one
/// object or between two. Shading normals that differ by more than 3° make no seam, because light
/// itself has a step there. Nor do places where a wall or another thing stands within a texel of
/// the edge. Edges must meet within a tenth of a texel.
typedef struct alp_seam_report {
    uint32_t count; ///< pairs of edges of triangles; 0 with ALP_ATLAS_VERTEX
    double length;  ///< metres
    bool stitched;  ///< alp_bake_options.stitch; if false, the fields of stitching are 0
    alp_seam_error ao, obscurance, light; ///< of the maps that were baked
} alp_seam_report;

/// Figures of a bake.
typedef struct alp_bake_report {
    alp_scene_info scene;
    alp_atlas_info atlas;
    uint32_t vertices;   ///< ALP_ATLAS_VERTEX: number of different positions and normals; else 0
    float ao_distance;   ///< metres, as used; automatic with ao_self: of the largest object
    uint32_t ao_samples; ///< rays of a traced texel
    uint64_t traced, interpolated, unknown; ///< texels; unknown: the bake ended before their turn
    uint64_t moved;   ///< texels partly inside other geometry; only their rest was gathered
    uint64_t dropped; ///< texels wholly inside, at the rim; filled like uncovered texels
    /// Stated error of the map over its mean: √(mean of squared standard errors), and their 99th
    /// percentile. All sampled texels have equal weight. NaN if no round of rays ended.
    double ao_relative_error, ao_p99_error;
    bool cut_off;      ///< by the time limit or by cancelling: another run gives other bits
    bool light_direct; ///< ALP_MAP_LIGHT without bounces
    double ao_mean;    ///< area-weighted mean accessibility
    double light_mean; ///< mean irradiance over texels and channels, W·m⁻²
    /// Light that the errors below are relative to, W·m⁻²: E + max(0, M − 1500 E) for E =
    /// light_mean and M the root mean square over texels of π times the radiance that surfaces
    /// emit.
    double light_scale;
    /// √(mean of squared standard errors) over texels and channels, and the 99th percentile of a
    /// texel's, both over light_scale. NaN in the dark, and for hemicubes, which have no estimate.
    double light_relative_error, light_p99_error;
    uint64_t light_traced, light_interpolated; ///< texels that gathered bounced light, and others
    uint32_t light_passes;                     ///< of radiosity; else 0
    uint32_t light_rounds;                     ///< of radiosity, rounds of texels' rays; else 0
    bool light_bounded; ///< the limit of rays ended light before its error, see `bounded`
    /// Mean change of the light in each of the first 64 passes, over its mean.
    float light_changes[64];
    alp_light_energy light_energy;
    alp_seam_report seams;
    double seconds_load, seconds_atlas, seconds_build, seconds_bake, seconds_seams, seconds_write;
    double seconds_total;
    /// Rays of occlusion and light. Light: the rays of direct light, of all passes of radiosity and
    /// of the texels that gathered. ALP_GATHER_PATHS: paths, each of several rays. A ray that
    /// continues behind a pane counts once.
    uint64_t rays;
    /// ALP_MAP_LIGHT: rays of a texel that gathered, without the extra rays of the worst texels.
    /// PATHS: paths of a texel. light_direct: samples of each light.
    uint32_t light_samples;
    unsigned maps; ///< maps that were made: bits of alp_map
    /// Tiles of an earlier process were read from the checkpoint. False for a merge, and with
    /// ranks.
    bool resumed;
    bool shard_done; ///< the tiles of a shard are in its folder; no output was written
    /// shard_done: share of seconds_total outside the loops that shards split, [0, 1]. Every shard
    /// repeats this work: charts, receivers, direct light and all passes of the whole scene. It
    /// rises when the shard resumes, for its own tiles are then read. Else 0.
    double shard_repeated_share;
    /// Tiles of the loops that trace rays, of a tenth to some milliseconds each: those that this
    /// process ran, and those that it read from the checkpoint or received from other ranks. 0
    /// without checkpoint and ranks.
    uint64_t tiles_run, tiles_read;
    uint32_t surfaces_baked; ///< number of scene.surfaces that got a map, see `only`
    uint32_t threads;
    uint64_t seed;
    uint64_t input_hash;
    uint64_t peak_memory_bytes; ///< of our own allocations
} alp_bake_report;

/// Work of a bake, estimated before it.
typedef struct alp_bake_work {
    uint64_t texels; ///< from areas, without making charts
    /// Rays of the bake. With an error to reach they are those of the first round: the scene
    /// decides how many further rounds follow.
    uint64_t rays;
    bool rays_at_least; ///< an error is to be reached, so that `rays` are the least
    uint64_t bytes;     ///< large arrays of the bake, without the scene and kept rays
} alp_bake_work;

/// Estimates the work of a bake from areas and options, within milliseconds. Rays are mostly within
/// a factor of three. All fields are 0 with ALP_ATLAS_VERTEX, or if nothing can be baked. Time is
/// not estimated: alp_progress.seconds_left has it once rays are traced.
/// @param options NULL = defaults; `maps_folder` is ignored
/// @return ALP_OK; INVALID_ARGUMENT (an option of occlusion out of its range, a pattern without a
///         match); OUT_OF_MEMORY; the errors of alp_bake for an `output` that cannot be written
ALP_API ALP_NODISCARD alp_result alp_bake_estimate(const alp_scene *scene,
                                                   const alp_bake_options *options,
                                                   alp_bake_work *work);

/// Bakes maps of a scene and writes them. Every output is written under a temporary name and
/// renamed after everything has succeeded: either all outputs appear or none. An output that is a
/// symbolic link is written to the target of the link.
/// @param options  NULL = defaults
/// @param lightmap NULL, or out: the maps, which the caller destroys before the scene
/// @param report   NULL, or out; seconds_load is 0, because the caller loaded the scene
/// @return ALP_OK; INVALID_ARGUMENT (options out of range or excluding each other; ALP_MAP_LIGHT
///         of a scene without lamp, emission and sky; a pattern without a match: the message has
///         the names); INVALID_DATA (nothing to bake, or a second UV set that cannot be kept);
///         UNSUPPORTED (an output of another format, or one without a place for these maps);
///         LIMIT; IO; OUT_OF_MEMORY; CANCELLED
ALP_API ALP_NODISCARD alp_result alp_bake(const alp_scene *scene, const alp_bake_options *options,
                                          alp_lightmap **lightmap, alp_bake_report *report);

ALP_END_DECLS

#endif
