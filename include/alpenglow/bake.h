// SPDX-License-Identifier: MIT
// The whole job in one call: atlas, light, maps, files.
#ifndef ALPENGLOW_BAKE_H
#define ALPENGLOW_BAKE_H

#include <alpenglow/atlas.h>
#include <alpenglow/image.h>
#include <alpenglow/light.h>
#include <alpenglow/occlusion.h>

ALP_BEGIN_DECLS

/// What happens to an occlusion map that a material has already.
typedef enum alp_existing_ao {
    ALP_EXISTING_AO_REPLACE = 0,  ///< ours takes its place (default)
    ALP_EXISTING_AO_MULTIPLY = 1, ///< ours times the old one, read at each texel, takes its place
    ALP_EXISTING_AO_KEEP = 2      ///< the material keeps its own
} alp_existing_ao;

/// Where the occlusion of a written asset goes.
typedef enum alp_ao_into {
    /// Maps on the pages of the atlas, read with a coordinate set of their own (default).
    ALP_AO_INTO_SEPARATE = 0,
    /// Into the red channel of the image that a material reads its roughness and metalness from, or
    /// else its occlusion, at that image's size, its other channels unchanged. existing_ao says
    /// what happens to that channel where the material's occlusion map used it; where none did, it
    /// is replaced. A material whose image can not hold the occlusion (it is tiled, several
    /// surfaces lie in one place of it, it has 16 bits, it is no PNG or JPEG) gets a map as above,
    /// with a warning "ao-not-packed". The value of a texel is the mean over up to 8 × 8 points of
    /// the maps, which for materials with a packed image are never multiplied by an older map
    /// themselves.
    ALP_AO_INTO_ORM = 1
} alp_ao_into;

/// How ALP_MAP_LIGHT goes into a written asset, read with the coordinate set that its occlusion map
/// has or would have. The asset then brings its direct and bounced light along: lights that the
/// file holds come on top of it in a viewer, so switch them off there, or bake bounced light alone
/// (ALP_DIRECT_OFF; not with EMISSIVE, which shows no other light). No occlusion map is attached
/// unless ALP_MAP_AO is asked for too: viewers multiply it into the light.
typedef enum alp_lightmap_as {
    ALP_LIGHTMAP_AS_NONE = 0, ///< not at all (default)
    /// The light that leaves each surface, as what the material emits: base colour 0,
    /// emissiveTexture in 8-bit sRGB, KHR_materials_emissive_strength = the brightest texel of the
    /// material. Every viewer shows it. Materials with transmission stay as they are; where alpha
    /// counts, it stays.
    ALP_LIGHTMAP_AS_EMISSIVE,
    /// The vendor extension MOZ_lightmap, in extensionsUsed and never required: texel × intensity,
    /// 8-bit linear; intensity = the brightest texel of the material. What is 1/255 of that or
    /// darker shows steps.
    ALP_LIGHTMAP_AS_MOZ,
    /// Files beside the asset (alp_lightmap_format), which the extras of the materials name:
    /// "lightmap": {"uri", "texCoord", "intensity", "units"}; texel × intensity.
    ALP_LIGHTMAP_AS_EXTRAS,
    /// In the place of an asset three.js Object JSON (`output` ends in .json), which ObjectLoader
    /// opens as it is (r155 or later): surfaces in world space as MeshLambertMaterial, whose colour
    /// has 8 bits of sRGB, with a lightMap of half floats, lightMap × lightMapIntensity = E. Lights
    /// of the file are left out, so are textures of metalness (lightmap-metal), and occlusion.
    ALP_LIGHTMAP_AS_THREE,
    /// The same as a .babylon file and Radiance pictures beside it, OUT.hdr, OUT.1.hdr …, E/π, of
    /// at least 8 × 8 texels: PBRMaterial with useLightmapAsShadowmap and white ambient light.
    ALP_LIGHTMAP_AS_BABYLON
} alp_lightmap_as;

/// What the numbers of light in an asset are; irradiance.exr is always irradiance.
typedef enum alp_light_units {
    ALP_LIGHT_UNITS_AUTO = 0,     ///< RADIANCE with EMISSIVE, else IRRADIANCE (default)
    ALP_LIGHT_IRRADIANCE,         ///< E [W·m⁻²]; what three.js multiplies by albedo / π
    ALP_LIGHT_IRRADIANCE_OVER_PI, ///< E/π; what others multiply by albedo
    /// ρE/π + Lₑ [W·sr⁻¹·m⁻²], what leaves the front of the surface: ρ and Lₑ are means over the
    /// texel of up to 4 × 4 points. What alpha does to it is left to the viewer; cut parts count
    /// for nothing. Not with MOZ, whose readers multiply by the albedo again.
    ALP_LIGHT_RADIANCE
} alp_light_units;

/// Files of ALP_LIGHTMAP_AS_EXTRAS: OUT.light.ktx2, OUT.light.1.ktx2 … Where half floats would not
/// hold the values, all are divided by a power of two, which is the "intensity" of the extras.
typedef enum alp_lightmap_format {
    ALP_LIGHTMAP_KTX2 = 0, ///< RGBA16F, one level, Zstandard; A is coverage (default)
    ALP_LIGHTMAP_EXR,      ///< half RGB, scanlines, ZIP
    ALP_LIGHTMAP_HDR       ///< Radiance RGBE, as bright as it may be
} alp_lightmap_format;

/// Files of `maps_folder`, but for its PNGs. Where half floats would not hold the values of a page,
/// its colours are divided by a power of two, which the file states as "alpenglowScale" (an
/// attribute of EXR, a key of KTX2), with a note (maps-scaled).
typedef enum alp_maps_format {
    ALP_MAPS_EXR = 0,  ///< float RGBA, ZIP (default)
    ALP_MAPS_EXR_HALF, ///< half RGBA, ZIP
    ALP_MAPS_HDR,      ///< Radiance RGBE: no coverage, and no signs: not BENT, SH and DIRECTION
    ALP_MAPS_KTX2      ///< RGBA16F, one level, Zstandard
} alp_maps_format;

/// The attribute that values at vertices are written to (ALP_ATLAS_VERTEX), 16 bits normalised.
typedef enum alp_vertex_attribute {
    /// COLOR_0, which viewers multiply into the base colour: R = G = B = accessibility, A = 1.
    /// Where a primitive has COLOR_0 already, its R, G and B are multiplied, A stays (default).
    ALP_VERTEX_COLOR = 0,
    ALP_VERTEX_OCCLUSION = 1 ///< _OCCLUSION, a scalar for shaders that know it; COLOR_0 stays
} alp_vertex_attribute;

/// What a bake makes: bits of alp_bake_options.maps. See alp_lightmap_map_page for their values.
typedef enum alp_map {
    ALP_MAP_AO = 1,    ///< accessibility: what an asset carries
    ALP_MAP_BENT = 2,  ///< bent normals, from the rays of ALP_MAP_AO
    ALP_MAP_LIGHT = 4, ///< irradiance E [W·m⁻² per channel, linear Rec.709], without albedo,
                       ///< without occlusion maps, not divided by π
    ALP_MAP_OBSCURANCE = 8, ///< coloured obscurance, every texel with rays of its own
    ALP_MAP_DIRECT = 16,    ///< irradiance that comes straight from lights: see ALP_DIRECT_APART
    ALP_MAP_BOUNCED = 32,   ///< irradiance that surfaces reflect: see ALP_DIRECT_APART
    ALP_MAP_SH = 64,        ///< the light of ALP_MAP_LIGHT by direction: spherical harmonics of two
                            ///< bands, four maps; needs ALP_MAP_LIGHT, not ALP_GATHER_PATHS
    ALP_MAP_DIRECTION = 128 ///< the mean direction it comes from; the same
} alp_map;

/// `bounces` of light that goes on as long as it brings anything.
#define ALP_BOUNCES_CONVERGE UINT32_MAX

/// How bounced light is gathered.
typedef enum alp_gather {
    ALP_GATHER_RAYS = 0,     ///< radiosity by stratified cosine rays (default)
    ALP_GATHER_HEMICUBE = 1, ///< radiosity by hemicubes
    ALP_GATHER_PATHS = 2     ///< by the reference path tracer
} alp_gather;

/// Which light ALP_MAP_LIGHT holds.
typedef enum alp_direct {
    ALP_DIRECT_ON = 0,   ///< direct and bounced light (default)
    ALP_DIRECT_OFF = 1,  ///< bounced light alone
    ALP_DIRECT_APART = 2 ///< as ON, and besides ALP_MAP_DIRECT and ALP_MAP_BOUNCED, which add up to
                         ///< it
} alp_direct;

/// How ALP_GATHER_HEMICUBE finds the light that comes straight from emissive surfaces.
typedef enum alp_emitters {
    ALP_EMITTERS_ANALYTIC = 0, ///< by closed forms and rays aimed at them, as RAYS do (default)
    /// By the pixels of each texel's hemicube that see them, as H. Elias' radiosity does: right in
    /// the mean, with the error of the pixels that their edges cross, 4 % of the mean in the
    /// Cornell box at 64 pixels; what falls between pixels is lost to that texel. Lamps, suns and
    /// skies are found as ever. Needs bounces; not with layers or `only`. Cost: the rays of the
    /// hemicubes twice.
    ALP_EMITTERS_COUNTED
} alp_emitters;

/// How ALP_MAP_LIGHT is gathered. Without bounces each light by samples of its own (of more than 64
/// lamps, and suns, one at a time). Blended and transmissive materials filter light on its way, see
/// docs/conventions.md, "Sides".
///
/// RAYS and HEMICUBE: radiosity. Direct light on every texel (RAYS for an error: on every second,
/// and others where it is uneven); its reflections are gathered by blocks of 4 × 4 texels of one
/// chart, pass after pass, until the bounces are done or the others would bring less than a
/// hundredth of the error (5e-5 to 5e-4 of all light; by `samples` and a number of bounces they are
/// done); then every texel gathers the last of them itself.
/// Based on: C. M. Goral, K. E. Torrance, D. P. Greenberg, B. Battaile. Modeling the Interaction of
///           Light Between Diffuse Surfaces. SIGGRAPH 1984;
///           M. F. Cohen, D. P. Greenberg. The Hemi-Cube. SIGGRAPH 1985.
/// Bias: within a block, light that has bounced is taken as even when it bounces again; docs/
/// accuracy.md, "Techniques against the truth".
///
/// PATHS: eight neighbouring texels share what their paths find after the first bounce, without
/// bias. Their errors are then alike: the standard error of a texel holds, that of a mean over many
/// texels is larger than independent texels would have. In scenes with blended or transmissive
/// materials nothing is shared.
/// Based on: P. Bekaert, M. Sbert, J. Halton. Accelerating Path Tracing by Re-Using Paths. EGWR
/// 2002.
typedef struct alp_light_options {
    alp_lighting_options lighting; ///< beside the lights and emissive materials of the scene
    alp_gather gather;
    alp_direct direct; ///< OFF and APART: not with PATHS and not without bounces
    uint32_t bounces;  ///< at most; 0 = direct light alone; default ALP_BOUNCES_CONVERGE
    /// RAYS: wanted relative error, √(mean of squared standard errors) / mean of the map, with the
    /// 99th percentile of its texels' at most four times as much. Rounds of more and more samples
    /// until both are stated, the last of them for the texels that err most. 0 (default): `samples`
    /// in one round; with a time_limit or keep_partial in rounds that double.
    float error;
    uint32_t samples; ///< [1, 65536], default 256. RAYS: rays of a texel, rounded up to a multiple
                      ///< of 32; PATHS: its paths, to a multiple of 16; without bounces rays to
                      ///< each light, to a multiple of 8. HEMICUBE: not read
    /// RAYS: noise of the bounced light is taken off by neighbours in space, never across a wall
    /// (alpenglow bench denoise); then every texel is gathered. Default false.
    bool denoise;
    uint32_t hemicube;     ///< pixels along an edge of a hemicube, even, [2, 1024]; default 64
    alp_emitters emitters; ///< of HEMICUBE, else ANALYTIC
    /// Besides, a map of what each light gives alone, its reflections included: of each lamp and
    /// sun, of each emissive material and of the sky, in this order. See alp_lightmap_layer_page.
    /// Of more than 16, the last is "others", all that are left, with a warning "many-layers"; of
    /// more than 64 lamps, suns or emissive materials all are one layer "lamps", "suns" or
    /// "materials". The map of all light is then their sum: by HEMICUBE that without layers within
    /// rounding. By rays light from surfaces within a texel is taken as even over the texel that
    /// they meet, which without layers it is not (nor where `bounces` is a number), so that it
    /// differs where surfaces meet, and where several rounds are gathered (error) by noise. Its
    /// stated error is that of the whole. Not with PATHS or denoise. Cost: the rays of each round
    /// once more, a look-up of them a layer, and 37 bytes of a texel and layer, 12 more where
    /// materials are double-sided. Where the rays of a round would not fit into the memory that is
    /// left (memory_limit), and in scenes that light passes through, they are traced again for each
    /// layer. Default false.
    bool layers;
} alp_light_options;

/// Values of alp_sampling_options.accuracy that are no accuracy.
#define ALP_ADAPTIVE_OFF 0.0f
#define ALP_ADAPTIVE_AUTO (-1.0f)

/// How many texels are traced, with how many rays, and when a bake stops. ALP_ATLAS_VERTEX: every
/// vertex gets all rays, so that accuracy, error, time_limit and keep_partial must stay as they
/// are.
typedef struct alp_sampling_options {
    /// AUTO (default): texels between traced ones are interpolated where those agree within the
    /// noise; OFF: every texel is traced; in (0, 1): they may differ by 1 − accuracy^distance, the
    /// distance in texels. .5 is a draft, .98 is careful.
    float accuracy;
    /// Wanted relative error: √(mean of squared standard errors) / mean of the map, with the 99th
    /// percentile below four times as much. Rounds of more and more rays until it is reached or
    /// occlusion.samples is. 0 (default): occlusion.samples rays in one round.
    float error;
    /// Seconds after which sampling ends with what it has; 0 = none. Light keeps its whole rounds;
    /// with ALP_MAP_LIGHT occlusion ends after half of them.
    double time_limit;
    /// Bytes that our own allocations may hold during the bake; 0 (default) = nine tenths of the
    /// machine's memory. What the context held before, such as the scene, is not counted, nor is
    /// memory of Embree, jansson, libpng, libjpeg and OpenEXR. A bake that would hold more fails
    /// with LIMIT, and the message names the stage; one whose maps cannot fit fails before its rays
    /// are traced. Light keeps the rays of its blocks in what is left, else it traces them again in
    /// each pass: the bits are the same.
    uint64_t memory_limit;
    /// A cancelled bake ends with what it has instead of with nothing; light has nothing before its
    /// first round ends, and is not denoised any more (a warning "not-denoised").
    bool keep_partial;
} alp_sampling_options;

typedef struct alp_bake_options {
    size_t struct_size;
    alp_atlas_options atlas;         ///< its progress is ignored
    alp_occlusion_options occlusion; ///< its progress is ignored
    alp_light_options light;         ///< for ALP_MAP_LIGHT
    alp_sampling_options sampling;
    /// Bits of alp_map, at least one; default ALP_MAP_AO. An asset needs ALP_MAP_AO, or
    /// ALP_MAP_LIGHT and lightmap_as: glTF has no place for the others. For BENT and OBSCURANCE
    /// occlusion is gathered and reported, and without ALP_MAP_AO not written. ALP_ATLAS_VERTEX:
    /// ALP_MAP_AO alone. OBSCURANCE, and LIGHT but for ALP_GATHER_RAYS with bounces, take no
    /// time_limit and no keep_partial; LIGHT no ao_self; existing_ao changes ALP_MAP_AO alone.
    unsigned maps;
    alp_existing_ao existing_ao; ///< ALP_ATLAS_VERTEX: REPLACE, materials keep their maps
    alp_ao_into ao_into;         ///< ALP_ATLAS_VERTEX: SEPARATE
    /// Anything but NONE needs ALP_MAP_LIGHT and an output, and excludes ALP_AO_INTO_ORM.
    alp_lightmap_as lightmap_as;
    alp_light_units light_units;           ///< of lightmap_as
    alp_lightmap_format lightmap_format;   ///< of EXTRAS, else KTX2
    alp_vertex_attribute vertex_attribute; ///< of ALP_ATLAS_VERTEX, else COLOR
    /// Every object (a node with all primitives of its mesh) is baked as if it were alone, and all
    /// nodes of a mesh share one map; the distance limit is in metres of the one that is baked.
    /// Automatic distance: one fifth of the diagonal of the object's own box. Excludes `occluders`.
    bool ao_self;
    /// Values beside seams are moved, by least squares, so that what both sides show agrees: not
    /// far beyond their standard error, unless the seam itself shows that they are wrong; all
    /// others keep their bits. Every map; layers still add up. Default true. ALP_ATLAS_VERTEX: not
    /// read. Based on: M. Iwanicki. Lighting Technology of The Last of Us. SIGGRAPH 2013 talks.
    bool stitch;
    bool overwrite; ///< default false: an existing file stops the job before it starts
    /// Which surfaces get a map, by name: NULL (default) = all; else patterns with commas between.
    /// A surface is named like its node (like the mesh of a node without a name, "node N" without
    /// either), so all primitives of a node go together. In a pattern * is any characters, ? is one
    /// (of UTF-8), [a-z] one of these, [!a-z] one that is not, \ takes the next character as it is.
    /// Every pattern must match something. Other surfaces come out as they went in, and occlude.
    const char *only;
    /// Which surfaces occlude, by name as in `only`; NULL (default) = all. The others are open.
    const char *occluders;
    /// .glb, .gltf, .obj (occlusion maps, or light as emission) or, of a scene that was read from
    /// COLLADA, .dae (the same); NULL: no asset
    const char *output;
    /// ao.exr, ao.1.exr …, ao.png, ao.error.exr (standard error of each texel) and ao.sampling.png
    /// (red traced, green interpolated), or NULL; made if missing. ALP_MAP_BENT: bent.exr and
    /// bent.png (n · ½ + ½). ALP_MAP_OBSCURANCE: obscurance.exr and .png, linear. ALP_MAP_LIGHT:
    /// irradiance.exr and irradiance.error.exr (standard error of each channel), and of each layer
    /// irradiance.NAME.exr. ALP_MAP_SH: sh.0.exr to sh.3.exr. ALP_MAP_DIRECTION: direction.exr.
    /// ALP_ATLAS_VERTEX: NULL. In other formats .hdr or .ktx2 takes the place of .exr.
    const char *maps_folder;
    alp_maps_format maps_format; ///< of maps_folder, else EXR
    /// Stages in order: "atlas" with its parts "adjacency", "clusters", "charts", "packing" and
    /// "texels"; "build"; "occlusion"; "obscurance"; "light"; "denoise"; "dilation"; "seams";
    /// "write". With ALP_ATLAS_VERTEX "vertices", "build", "occlusion", "detail", "write". Parts of
    /// short work may stay unheard.
    alp_progress_fn *progress;
    void *progress_user;
} alp_bake_options;
ALP_API alp_bake_options alp_bake_options_default(void);

/// Where the light of a radiosity goes: fluxes in W, means of the three channels, over the surfaces
/// that were baked and the backs they see. To the noise of the rays, emitted = absorbed + escaped +
/// behind + unshot.
typedef struct alp_light_energy {
    bool known;      ///< false: no radiosity, or materials let light through
    double emitted;  ///< by surfaces, and what lamps, suns and sky bring to them
    double absorbed; ///< where it arrives
    double escaped;  ///< out of the scene, by the rays that meet nothing
    double behind;   ///< into the black backs of single-sided surfaces, by the rays that meet them
    double unshot;   ///< reflected by the last bounce, and not followed any more
} alp_light_energy;

/// How far apart the values are that a map shows on the two sides of its seams: |difference| of
/// bilinear look-ups, of colours the mean of the channels, over the area-weighted mean of the map.
typedef struct alp_seam_error {
    double mean;                        ///< along all seams; NaN where the map is black
    double p99;                         ///< that 99 % of their length do not exceed
    double stitched_mean, stitched_p99; ///< the same after alp_bake_options.stitch
    /// How far that moved texels beside seams, root mean square and largest: over their standard
    /// errors, of which less than 0.2 % of the map's mean counts as that.
    double change_rms, change_max;
} alp_seam_error;

/// Seams: where a surface goes on across edges of triangles, whole or in part, in one object or
/// from one to the next, and look-ups read other texels on each side. Where shading normals turn by
/// more than 3°, light steps by itself, and nothing is a seam. Edges meet within a tenth of a
/// texel.
typedef struct alp_seam_report {
    uint32_t count; ///< pairs of edges of triangles; 0 with ALP_ATLAS_VERTEX
    double length;  ///< metres
    bool stitched;  ///< as alp_bake_options.stitch asked; else what tells of it is 0
    alp_seam_error ao, obscurance, light; ///< of those that were asked for
} alp_seam_report;

/// What was done.
typedef struct alp_bake_report {
    alp_scene_info scene;
    alp_atlas_info atlas;
    uint32_t vertices;   ///< ALP_ATLAS_VERTEX: of different position or normal; else 0
    float ao_distance;   ///< metres, as used; automatic with ao_self: of the largest object
    uint32_t ao_samples; ///< rays of a traced texel
    uint64_t traced, interpolated, unknown; ///< texels; unknown: cut off before their turn
    uint64_t moved;   ///< texels partly inside other geometry: only the rest of them was gathered
    uint64_t dropped; ///< wholly inside, at the rim: filled like texels of no surface
    /// Stated error of the map: √(mean of squared standard errors) and their 99th percentile, both
    /// over the mean value, of all texels that were sampled, each counting alike; NaN when no round
    /// of rays came to its end.
    double ao_relative_error, ao_p99_error;
    bool cut_off;      ///< by the time limit or by cancelling: another run gives other bits
    bool light_direct; ///< ALP_MAP_LIGHT was asked for without bounces
    double ao_mean;    ///< area-weighted mean accessibility
    double light_mean; ///< mean irradiance over texels and channels, W·m⁻²
    /// √(mean of squared standard errors) over texels and channels, and the 99th percentile of a
    /// texel's, both over light_mean; NaN if dark, and of hemicubes, which do not tell.
    double light_relative_error, light_p99_error;
    uint64_t light_traced, light_interpolated; ///< texels that gathered bounced light, and others
    uint32_t light_passes;                     ///< of radiosity, one a bounce; else 0
    uint32_t light_rounds;                     ///< of radiosity, in which texels sent rays; else 0
    /// Of each of the first 64 passes, the mean change of the light over its mean.
    float light_changes[64];
    alp_light_energy light_energy;
    alp_seam_report seams;
    double seconds_load, seconds_atlas, seconds_build, seconds_bake, seconds_seams, seconds_write;
    double seconds_total;
    /// Rays of occlusion, plus what light took: the rays of direct light, of all passes of
    /// radiosity and of the texels that gathered; of ALP_GATHER_PATHS its paths, each of which is
    /// several rays. A ray that goes on behind a pane is not counted again.
    uint64_t rays;
    /// Of ALP_MAP_LIGHT: rays of a texel that gathered, but of the few that err most and got more;
    /// PATHS: its paths; light_direct: its samples of each light.
    uint32_t light_samples;
    unsigned maps;           ///< that were made: bits of alp_map
    uint32_t surfaces_baked; ///< of scene.surfaces: those of `only`
    uint32_t threads;
    uint64_t seed;
    uint64_t input_hash;
    uint64_t peak_memory_bytes; ///< of our own allocations
} alp_bake_report;

/// What a bake will take, about.
typedef struct alp_bake_work {
    uint64_t texels; ///< from areas: charts are not made
    /// Rays of the bake. With an error to reach they are those of the first round: how many more
    /// rounds follow depends on the scene.
    uint64_t rays;
    bool rays_at_least; ///< an error is to be reached, so that `rays` are the least
    uint64_t bytes;     ///< of the large arrays of the bake, without the scene and kept rays
} alp_bake_work;

/// Estimates the work of a bake from areas and options alone, within milliseconds; rays within a
/// factor of three, mostly. All is 0 with ALP_ATLAS_VERTEX and where there is nothing to bake. Time
/// is not estimated: alp_progress.seconds_left tells it once rays are traced.
/// @param options NULL = default; `maps_folder` is not read
/// @return ALP_OK; INVALID_ARGUMENT (an option of occlusion out of its range, a pattern without a
///         match); OUT_OF_MEMORY; for an `output` that cannot be written, the error of alp_bake
ALP_API ALP_NODISCARD alp_result alp_bake_estimate(const alp_scene *scene,
                                                   const alp_bake_options *options,
                                                   alp_bake_work *work);

/// Maps over the pages of an atlas, or values at vertices.
typedef struct alp_lightmap alp_lightmap;

/// Bakes the maps of a scene that the options ask for and writes them. Every output is written
/// beside its place and renamed, after everything has succeeded: all of them appear, or none. An
/// output that is a link is written where the link leads.
/// @param lightmap NULL, or out: the maps, which the caller destroys before the scene
/// @param report   NULL, or out; seconds_load is 0 (the caller loaded)
/// @return ALP_OK; INVALID_ARGUMENT (a pattern without a match: the message has the names);
///         INVALID_DATA (nothing to bake, or a second UV set that cannot
///         be kept); UNSUPPORTED (an output that is none of .glb, .gltf, .dae, .obj,
///         or that has no place for what is baked); LIMIT (memory_limit, or a time_limit before
///         the first round ended); IO; OUT_OF_MEMORY (the allocator failed); CANCELLED
ALP_API ALP_NODISCARD alp_result alp_bake(const alp_scene *scene, const alp_bake_options *options,
                                          alp_lightmap **lightmap, alp_bake_report *report);

ALP_API void alp_lightmap_destroy(alp_lightmap *lightmap); ///< NULL does nothing
/// How alp_render reads maps of ALP_ATLAS_BLEND from now on; other maps are read as ever. NULL does
/// nothing.
ALP_API void alp_lightmap_set_blend(alp_lightmap *lightmap, alp_blend blend);
ALP_API uint32_t alp_lightmap_page_count(const alp_lightmap *lightmap);
/// A page as floats [height][width][4]: accessibility in R = G = B, coverage in A (1 where a texel
/// is covered, 0 elsewhere; uncovered texels near a chart hold its nearest value). NULL where light
/// alone was baked. Owned by the lightmap.
ALP_API const float *alp_lightmap_page(const alp_lightmap *lightmap, uint32_t page, uint32_t *width,
                                       uint32_t *height);
/// A page of one of the maps that were asked for, laid out like alp_lightmap_page (which is that of
/// ALP_MAP_AO), or NULL.
///
/// ALP_MAP_BENT: RGB = the mean open direction, world space, unit length,
///
///     normalised ∫ (1 − w) ω (n·ω) dω
///
/// with the directions of the occlusion options (uniform ones: without n·ω); the shading normal
/// where nothing is open. With ao_self, directions are those of the instance that was baked.
///
/// ALP_MAP_OBSCURANCE: RGB = (1/π) ∫ [ (1 − w) + w · albedo of the hit ] (n·ω) dω per channel,
/// linear, 0 to 1. Open is 1; single-sided surfaces are black from behind.
/// Based on: A. Méndez, M. Sbert, J. Catà. Real-time Obscurances with Color Bleeding. SCCG 2003.
///
/// ALP_MAP_DIRECTION: RGB = the mean direction of the light, world space, unit length,
///
///     normalised ∫ Y(L) (n·ω) ω dω
///
/// with the luminance Y of radiance L; the shading normal where it is dark.
///
/// ALP_MAP_SH: that of c_00, see alp_lightmap_sh_page.
ALP_API const float *alp_lightmap_map_page(const alp_lightmap *lightmap, alp_map map, uint32_t page,
                                           uint32_t *width, uint32_t *height);
/// A page of one of the four maps of ALP_MAP_SH, laid out the same, or NULL: RGB = the projection
/// of the radiance from the hemisphere above a texel,
///
///     c_lm = ∫ L(ω) Y_lm(ω) dω    [W·m⁻²]
///
/// in real spherical harmonics of world space without the Condon–Shortley sign, index l(l+1)+m:
/// Y = .282095, .488603 y, .488603 z, .488603 x. Irradiance about a normal n near the texel's is
///
///     E(n) ≈ π c_00 Y_00 + (2π/3) (c_1−1 Y_1−1(n) + c_10 Y_10(n) + c_11 Y_11(n))
///
/// Bias: docs/conventions.md, "Light by direction".
/// Based on: R. Ramamoorthi, P. Hanrahan. An Efficient Representation for Irradiance Environment
/// Maps. SIGGRAPH 2001.
/// @param index 0 to 3
ALP_API const float *alp_lightmap_sh_page(const alp_lightmap *lightmap, uint32_t index,
                                          uint32_t page, uint32_t *width, uint32_t *height);

/// Layers of light (alp_light_options.layers), 0 without.
ALP_API uint32_t alp_lightmap_layer_count(const alp_lightmap *lightmap);
/// What a layer is called: its light, its emissive material, "lamp 0" (of the options), "sun" (of
/// the options), "sky" or "others"; fit for the name of a file (dots and what separates are "_", at
/// most 64 bytes), and unlike all others and the names of other maps ("lamp", "lamp 2" …). NULL:
/// there is no such layer. Owned by the lightmap.
ALP_API const char *alp_lightmap_layer_name(const alp_lightmap *lightmap, uint32_t layer);
/// A page of a layer, laid out like alp_lightmap_page, or NULL: E [W·m⁻²] by that light alone.
/// Added up as floats, in order from the first layer on, the layers are ALP_MAP_LIGHT, bit for bit;
/// ALP_MAP_DIRECT and ALP_MAP_BOUNCED add up to it within rounding.
ALP_API const float *alp_lightmap_layer_page(const alp_lightmap *lightmap, uint32_t layer,
                                             uint32_t page, uint32_t *width, uint32_t *height);
/// The atlas the maps are laid out on, NULL with ALP_ATLAS_VERTEX. Owned by the lightmap.
ALP_API const alp_atlas *alp_lightmap_atlas(const alp_lightmap *lightmap);

/// Accessibility at the vertices of one surface, [*count], linear, 0 to 1: what ALP_ATLAS_VERTEX
/// baked, to be interpolated linearly over the triangles. A surface with normals has a value for
/// each vertex of its primitive or mesh, in that order; vertices of one position and one normal
/// have the same value, and those of no usable triangle have 1. A surface whose normals were
/// generated has three values for each triangle, in the order of its corners.
/// @param count NULL, or out: 0 where there are none
/// @return NULL without such values or for a surface that is not there. Owned by the lightmap.
ALP_API const float *alp_lightmap_vertex_values(const alp_lightmap *lightmap, uint32_t surface,
                                                uint32_t *count);

ALP_END_DECLS

#endif
