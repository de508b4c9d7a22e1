// SPDX-License-Identifier: MIT
// Light probes: light from all directions at points in space, baked for everything that moves.
#ifndef ALPENGLOW_PROBES_H
#define ALPENGLOW_PROBES_H

#include <alpenglow/field.h>

ALP_BEGIN_DECLS

/// Functions of direction that a probe holds.
typedef enum alp_probe_basis {
    ALP_PROBE_SH9 = 0,     ///< nine spherical harmonics of radiance; E errs by 9 % at most
    ALP_PROBE_SH4,         ///< the first four; E errs by 25 % at most
    ALP_PROBE_AMBIENT_CUBE ///< irradiance along ±x, ±y, ±z; E(n) = Σ n_i² E(±axis i)
} alp_probe_basis;

/// How a probe came by its light.
typedef enum alp_probe_state {
    ALP_PROBE_VALID = 0, ///< sampled at its place
    ALP_PROBE_MOVED,     ///< sampled beside its place, which lies in a solid or on a surface
    ALP_PROBE_FILLED,    ///< in a solid or on a surface: mean of its valid neighbours
    ALP_PROBE_INVALID    ///< the same, without such neighbours: black
} alp_probe_state;

/// Probes on a lattice, or at any places. Opaque and immutable.
typedef struct alp_probes alp_probes;

typedef struct alp_probe_options {
    size_t struct_size;
    /// Metres between neighbours, > 0; 0 (default) = about 4,096 probes in the bounds.
    float spacing;
    /// Metres, positions in the scene; all 0 (default) = the bounds of the scene. Each axis gets
    /// ceil(extent / spacing) probes, centred: the outer ones lie up to half a cell inside.
    float bounds_min[3], bounds_max[3];
    /// NULL (default), or [position_count][3] metres: probes at these places, without a lattice.
    /// `spacing` and bounds are not read.
    const float (*positions)[3];
    uint32_t position_count;
    alp_probe_basis basis;
    bool visibility; ///< store distances, against light through walls; default true
    bool gradients;  ///< store the change of each coefficient per metre; not with layers or
                     ///< positions; default false
    /// The light of each lamp and sun is stored apart too, so that a host can dim it; default
    /// false. At most 15 get a layer, in the order of the lights: a warning says so (many-layers).
    bool layers;
    bool direct;   ///< light straight from punctual lamps and suns is in it; default false
    uint32_t rays; ///< of each probe, [384, 1572864], rounded up to 4 × 6 × (4 k)²; default 1536
    alp_lighting_options lighting; ///< beside the lights of the file
    uint32_t bounces;              ///< default ALP_BOUNCES_CONVERGE
    bool one_sided;                ///< rays pass single-sided surfaces from behind; default false
    uint32_t atlas_size;           ///< texels along a page of the radiosity; default 512
    uint64_t seed;
    /// Stages "atlas", "validity", "light", "survey", "moves", "probes", "gradients", "layers",
    /// "fill".
    alp_progress_fn *progress;
    void *progress_user;
} alp_probe_options;
ALP_API alp_probe_options alp_probe_options_default(void);

/// Solves the light of a scene, and samples it at probes.
///
/// A probe traces `rays` rays through a cube about it, in four replicates. In a solid (over a
/// quarter of the sphere shows black backs) or on a surface, it is moved by at most 45 % of a cell,
/// to the nearest free place. Without one, its light is the mean of its valid neighbours.
/// @param probes out, which the caller destroys; NULL on failure
/// @return ALP_OK; INVALID_ARGUMENT (an option out of range, a position that is not finite; nothing
///         lights the scene); LIMIT (too many probes: the message states their memory);
///         OUT_OF_MEMORY; CANCELLED; UNSUPPORTED (the ray tracer fails)
ALP_API ALP_NODISCARD alp_result alp_probes_bake(const alp_scene *scene,
                                                 const alp_probe_options *options,
                                                 alp_probes **probes);
ALP_API void alp_probes_destroy(alp_probes *probes); ///< NULL does nothing

/// Counts and quality of probes.
typedef struct alp_probes_info {
    bool is_list;
    uint32_t count, size[3]; ///< list: size is count, 1, 1
    double origin[3];        ///< metres in the world of the scene's file: place of the first probe
    float spacing[3];        ///< metres; list: 0
    alp_probe_basis basis;
    uint32_t coefficients; ///< of each probe: 9, 4 or 6
    uint32_t layers;
    bool visibility, gradients, direct;
    uint32_t states[4];  ///< probes by alp_probe_state
    float error;         ///< stated: √(mean of squared standard errors of E) / mean E
    float interpolation; ///< estimated: RMS error of E between probes, W·m⁻²; 0 = not known
    float mean;          ///< mean E over probes and normals, W·m⁻²
    uint32_t rays;       ///< of each probe
    uint64_t bytes;      ///< in memory, for look-ups
    uint64_t scene_hash; ///< of the scene that they were baked in
} alp_probes_info;
ALP_API alp_probes_info alp_probes_get_info(const alp_probes *probes);

/// [count][coefficients][3], owned by the probes. SH: radiance, order 1, y, z, x, xy, yz, 3z² − 1,
/// xz, x² − y². Cube: E at +x −x +y −y +z −z. @param layer UINT32_MAX = all light, layers
/// included
ALP_API const float *alp_probes_coefficients(const alp_probes *probes, uint32_t layer);
/// Name of the lamp of a layer, "" past the last; owned by the probes.
ALP_API const char *alp_probes_layer_name(const alp_probes *probes, uint32_t layer);
/// [count] alp_probe_state, owned by the probes.
ALP_API const uint8_t *alp_probes_states(const alp_probes *probes);
/// Distances that probes met, owned by the probes: [count][8][8][2], metres and metres², the mean
/// distance and the mean of its square by direction, in the octahedral map of
/// docs/manual/probe-format.md. NULL without visibility.
ALP_API const float *alp_probes_moments(const alp_probes *probes);
/// Place at which probe `index` was sampled, metres in the world of the scene's file.
ALP_API void alp_probes_position(const alp_probes *probes, uint32_t index, double position[3]);

/// Writes PATH (.probes.json), and beside it .probes.ktx2 with the light and, with visibility,
/// .probes.moments.ktx2. All appear together, or none.
/// @return ALP_OK; INVALID_ARGUMENT (the name of the path); IO (also: a file exists, unless
///         `overwrite`); LIMIT; OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_probes_save(const alp_probes *probes, const char *path,
                                                 bool overwrite);
/// Reads what alp_probes_save wrote.
/// @return ALP_OK; IO; INVALID_DATA (malformed, or a checksum differs); UNSUPPORTED (a newer
///         version); LIMIT; OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_probes_load(alp_context *context, const char *path,
                                                 alp_probes **probes);

/// Writes a lattice for LightProbeGrid of three.js r184 to r187: a module at PATH (.mjs), and its
/// texture (.ktx2) beside it.
/// @param scale factor on the coefficients, > 0
/// @return ALP_OK; INVALID_ARGUMENT; UNSUPPORTED (a list, or an ambient cube); LIMIT (a coefficient
///         beyond half floats: a smaller scale helps); IO; OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_probes_export_three(const alp_probes *probes, const char *path,
                                                         double scale, bool overwrite);

/// How a field reads probes between their places.
typedef enum alp_probe_lookup {
    /// Trilinear weights, times what each probe sees of the position (if it has visibility), times
    /// how far the normal faces it. A list: inverse squares of distances to the nearest four.
    ALP_LOOKUP_OURS = 0,
    /// Trilinear, read half a cell along the normal, no visibility: LightProbeGrid of three.js.
    ALP_LOOKUP_THREE
} alp_probe_lookup;

/// A field that reads probes, which must outlive it.
/// @param origin    NULL, or the origin of the scene whose positions will be given
///                  (alp_scene_info.origin)
/// @param strengths NULL = 1, or [layers] factors of the light of each layer, ≥ 0
/// @return ALP_OK; INVALID_ARGUMENT (a list with THREE); OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_field_create_probes(const alp_probes *probes,
                                                         alp_probe_lookup lookup,
                                                         const double origin[3],
                                                         const float *strengths, alp_field **field);

ALP_END_DECLS

#endif
