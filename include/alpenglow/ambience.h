// SPDX-License-Identifier: MIT
// Live light in space: a volume of spherical harmonics that follows the camera and the sun.
//
// Light is sampled at anchors, points of a lattice that is finer near the camera. A host either
// lets rays sample them (alp_ambience_sampler), or renders cube faces itself:
//
//     alp_ambience_update(ambience, time);                 // each frame
//     while (alp_ambience_next(ambience, &camera, &request) == ALP_OK && request.id != 0) {
//         … render the six faces at request.position …
//         alp_ambience_submit_faces(ambience, request.id, 16, faces);
//     }
//     const alp_ambience_snapshot *now = alp_ambience_begin_read(ambience);
//     alp_ambience_irradiance(now, count, positions, normals, irradiance);
//     alp_ambience_end_read(ambience, now);
//
// Any thread may submit and read: begin_read, the look-ups and end_read. All other functions are
// called by one thread at a time, get_info, invalidate and set_lighting too.
// Based on: C. Nilsson, A. Jansson. Ljussättning i realtid med dynamisk ambiansvolym (Real-time
//           lighting with a dynamic ambience volume). Master's thesis, Chalmers, 2006.
#ifndef ALPENGLOW_AMBIENCE_H
#define ALPENGLOW_AMBIENCE_H

#include <alpenglow/field.h>
#include <alpenglow/sh.h>

ALP_BEGIN_DECLS

typedef struct alp_ambience alp_ambience;                   ///< opaque
typedef struct alp_ambience_snapshot alp_ambience_snapshot; ///< one frame's light, immutable

/// How the light between anchors is interpolated.
typedef enum alp_ambience_lookup {
    /// Level by level, the eight anchors of the lattice round the point, by trilinear weight ×
    /// confidence. The next coarser level provides the confidence that is missing to 1.
    ALP_AMBIENCE_OURS = 0,
    /// The rule of 2006: the nearest anchor of each octant round the node of the point, weighed by
    /// distance. Coarser levels count only without any anchor there. Jumps in space and time.
    ALP_AMBIENCE_CONFORMANCE
} alp_ambience_lookup;

typedef struct alp_ambience_options {
    size_t struct_size;
    double centre[3]; ///< metres: the centre of the root; default 0, 0, 0
    double size;      ///< metres along an edge of the root, > 0; default 243. It grows beyond.
    uint32_t depth;   ///< levels below the root, [1, 10]; default 5: cells of size / 3^depth
    /// Anchors of a plane in place of a volume: nodes have 9 children. Positions are read along x
    /// and z; y is that of `height` + `above`. Default false.
    bool flat;
    double above; ///< flat: metres of the anchors above the ground, ≥ 0; default 1.5
    /// flat: height of the ground [m] at x, z. NULL (default): 0, or the scene of the sampler
    double (*height)(void *user, double x, double z);
    void *height_user;
    double lifetime; ///< seconds that an anchor's light is valid, > 0; default 6
    double fade;     ///< seconds that new light takes to replace old, at least, ≥ 0; default 1
    uint32_t anchor_limit; ///< anchors that may be held, [64, 1048576]; default 8192
    bool visibility;       ///< distances are kept against light through walls; default true
    alp_ambience_lookup lookup;
} alp_ambience_options;
ALP_API alp_ambience_options alp_ambience_options_default(void);

/// @param options NULL = defaults
/// @return ALP_OK; INVALID_ARGUMENT (an option out of range); OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_ambience_create(alp_context *context,
                                                     const alp_ambience_options *options,
                                                     alp_ambience **ambience);
/// NULL does nothing. Snapshots must have been given back, and fields destroyed.
ALP_API void alp_ambience_destroy(alp_ambience *ambience);

/// Moves to a time: fades new light in and expired light out, prunes branches without light, and
/// publishes a snapshot. Light that comes before time moves counts at once. So do answers that the
/// first move of time takes, if readers had no light before. If the first light of a volume comes
/// later, all light fades in from black within 3.3 seconds.
/// @param time seconds, finite, not before the last
/// @return ALP_OK; INVALID_ARGUMENT (nothing changes); OUT_OF_MEMORY (the old snapshot stays);
///         LIMIT (readers and fields hold all of 16 snapshots: the old one stays)
ALP_API ALP_NODISCARD alp_result alp_ambience_update(alp_ambience *ambience, double time);

/// The camera, its motion and the objects round it.
typedef struct alp_ambience_camera {
    double position[3]; ///< metres
    double velocity[3]; ///< metres per second
    double forward[3];  ///< where it looks, any length; 0 = not known
    double vfov;        ///< radians of its vertical field of view; 0 = not known
    /// Objects that ambience lights: anchors round them come first. [object_count][4]: centre and
    /// radius, metres. May be NULL.
    const double (*objects)[4];
    uint32_t object_count;
    /// A path that is known: [path_count][4] time, x, y, z, in the order of time. NULL: the
    /// position is predicted from velocity.
    const double (*path)[4];
    uint32_t path_count;
} alp_ambience_camera;

/// A place whose light is wanted.
typedef struct alp_ambience_request {
    uint64_t id;        ///< 0: nothing is wanted
    double position[3]; ///< metres
    double cell;        ///< metres between anchors there
    bool renewal;       ///< it has light, which gets old
    bool relight;       ///< only the lighting changed since its rays were traced
} alp_ambience_request;

/// Chooses the next anchor to sample: missing ones round the camera first, coarse before fine, then
/// those whose light gets old. A request that is not answered within a lifetime is void.
/// @return ALP_OK (request->id = 0: nothing is wanted); INVALID_ARGUMENT (camera not finite);
///         OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_ambience_next(alp_ambience *ambience,
                                                   const alp_ambience_camera *camera,
                                                   alp_ambience_request *request);
/// Light at a request. It fades in from the next update on. From any thread. It comes without
/// distances: a new anchor sees all points that read it, and an old one keeps those it has.
/// @param radiance c_lm [W·m⁻²]
/// @return ALP_OK; INVALID_ARGUMENT (not finite; the request is not open: answered, or void)
ALP_API ALP_NODISCARD alp_result alp_ambience_submit(alp_ambience *ambience, uint64_t id,
                                                     const alp_sh9 *radiance);
/// The same from six faces of a cube map. A host that renders one face a frame adds each face by
/// alp_sh_projection_add. It then submits the sum by alp_ambience_submit.
/// @param faces +x −x +y −y +z −z, of side × side pixels of radiance, as alp_sh_project_cube reads
ALP_API ALP_NODISCARD alp_result alp_ambience_submit_faces(alp_ambience *ambience, uint64_t id,
                                                           uint32_t side,
                                                           const float *const faces[6]);
/// Says that a request lies in a solid: it gets no light.
ALP_API ALP_NODISCARD alp_result alp_ambience_submit_solid(alp_ambience *ambience, uint64_t id);
/// All light is out of date: lamps moved (`traced` false: rays need not be traced again), or
/// geometry changed (true). Within a box, metres; NULL = everywhere. Answers to requests that are
/// open now fade in, and are wanted once more.
ALP_API void alp_ambience_invalidate(alp_ambience *ambience, bool traced, const double box_min[3],
                                     const double box_max[3]);

/// The snapshot of the last update. Takes no lock and does not wait. From any thread.
/// @return never NULL; give it back by alp_ambience_end_read
ALP_API const alp_ambience_snapshot *alp_ambience_begin_read(alp_ambience *ambience);
ALP_API void alp_ambience_end_read(alp_ambience *ambience, const alp_ambience_snapshot *snapshot);

/// E(p, n) [W·m⁻²] at points. Allocates nothing; any number of threads.
/// @param positions [count][3] metres   @param normals [count][3] unit
/// @param irradiance [count][3] out: ≥ 0; 0 at points that are not finite, and without any light
ALP_API void alp_ambience_irradiance(const alp_ambience_snapshot *snapshot, uint32_t count,
                                     const double (*positions)[3], const float (*normals)[3],
                                     float (*irradiance)[3]);
/// Radiance at a point as spherical harmonics; alp_sh_shader_vectors makes 12 vectors of it. From
/// here anchors are seen or not from the point itself, since a normal is not known.
/// alp_ambience_irradiance sees them from a quarter of their cell above the surface. On surfaces
/// the two differ: pass a point that far above it, or light from behind it may count.
ALP_API void alp_ambience_coefficients(const alp_ambience_snapshot *snapshot,
                                       const double position[3], alp_sh9 *radiance);

/// Light of an object that is larger than a cell: a look-up at the middle of each side of its box,
/// with the side's normal. So each side gets the light of the air that it faces.
/// alp_sh_ambient_cube_irradiance blends the sides: E(n) = Σ n_i² C.
/// @param box_min, box_max metres   @param cube [6][3] out: E of +x −x +y −y +z −z; 0 for a side
/// that is not finite
/// Based on: the thesis above, 12.2 (large objects).
ALP_API void alp_ambience_object_cube(const alp_ambience_snapshot *snapshot,
                                      const double box_min[3], const double box_max[3],
                                      float cube[6][3]);
/// Light at the corners of a patch of terrain. Patches that share a corner, with its normal, get
/// the same light there.
/// @param corners    [4][3] metres, at (u, v) = (0, 0), (1, 0), (0, 1), (1, 1)
/// @param normals    [4][3] unit
/// @param irradiance [4][3] out: E; 0 at corners that are not finite
ALP_API void alp_ambience_patch(const alp_ambience_snapshot *snapshot, const double corners[4][3],
                                const float normals[4][3], float irradiance[4][3]);
/// E on a patch, bilinear between its corners. On a border that two patches share, both give the
/// same bits for the same u or v along it.
/// @param u, v [0, 1]; held to it   @param e [3] out
ALP_API void alp_ambience_patch_irradiance(const float irradiance[4][3], float u, float v,
                                           float e[3]);

typedef struct alp_ambience_info {
    uint32_t anchors;          ///< that hold light
    uint32_t solids;           ///< that lie in solids
    uint32_t nodes;            ///< of the graph
    uint32_t levels;           ///< of the graph, the root included
    uint32_t open;             ///< requests that are not answered
    uint64_t bytes;            ///< the graph, all anchors and snapshots
    uint64_t bytes_visibility; ///< of these: distances
    uint64_t bytes_hits;       ///< of these: kept hits
    double time;               ///< of the last update
    double cell;               ///< metres between anchors of the finest level that holds light
} alp_ambience_info;
ALP_API alp_ambience_info alp_ambience_get_info(const alp_ambience *ambience);

// --- sampling by rays ----------------------------------------------------------------------------

/// Samples anchors with rays through a scene. Light that bounces more than once comes from the
/// volume itself.
typedef struct alp_ambience_sampler alp_ambience_sampler;

typedef struct alp_ambience_sampler_options {
    size_t struct_size;
    alp_lighting_options lighting; ///< beside the lights of the file
    uint32_t face;       ///< rays along an edge of a face, multiple of 4, [4, 64]; default 16
    uint32_t first_face; ///< the same of an anchor's first sample; default 8
    bool bounces;        ///< light that bounces more than once; default true
    bool direct;         ///< light straight from punctual lamps and suns is in it; default false
    bool keep_hits;      ///< hits are kept, to relight them; default true
    /// UINT32_MAX (default): all light. Else a lamp or sun, whose light alone the volume holds:
    /// those of the file first, then those of the options, then their sun.
    uint32_t light;
    /// Metres: rays meet a copy of the scene that alp_scene_simplify makes with this error. 0
    /// (default): the scene itself. A pixel of a face of 16 × 16 is 1 m wide at 10 m. It pays
    /// where triangles are many, and errs most in narrow rooms. Measured at 200 random free points
    /// in sun and sky, against the scene itself:
    ///
    ///     scene                        detail   triangles           samples/s   mean |E′ − E|/E
    ///     terrain                      1 m       59,896 →  8,919    × 1.20       2.1 %
    ///     terrain                      .25 m     59,896 → 18,821    × 1.10        .6 %
    ///     terrain,triangles=1000000    1 m      999,402 → 33,382    × 1.82       2.9 %
    ///     zdm2 (game level)            1 m       57,638 →  7,601    × 1.05      10 %
    ///     zdm2                         .25 m     57,638 → 10,526    × 1.03       3.9 %
    float detail;
    uint64_t seed;
} alp_ambience_sampler_options;
ALP_API alp_ambience_sampler_options alp_ambience_sampler_options_default(void);

/// Moves the centre of the volume by .4 of the finest cell, unless it was updated before. Floors
/// and walls often lie at whole metres, and anchors on surfaces count as solid. On a floor at y = 0
/// the error was twice as large without it. A volume has one sampler at a time.
/// @return ALP_OK; INVALID_ARGUMENT (an option out of range; nothing lights the scene; no such
///         lamp: the message says how many there are; the volume has a sampler); OUT_OF_MEMORY;
///         UNSUPPORTED (the ray tracer fails)
ALP_API ALP_NODISCARD alp_result alp_ambience_sampler_create(
    alp_ambience *ambience, const alp_scene *scene, const alp_ambience_sampler_options *options,
    alp_ambience_sampler **sampler);
/// NULL does nothing. Before the ambience and the scene.
ALP_API void alp_ambience_sampler_destroy(alp_ambience_sampler *sampler);
/// Changes the light: a sun moved, or a lamp was switched. Anchors are relit, old ones first.
ALP_API ALP_NODISCARD alp_result alp_ambience_sampler_set_lighting(
    alp_ambience_sampler *sampler, const alp_lighting_options *lighting);

/// Sets black spheres that stop rays and shadow rays of the sampler: objects that move.
/// Anchors within four radii of a sphere that changed are relit. Others, and shadows that fall
/// farther, follow with the next renewal. A ray that starts in a sphere passes it, so anchors in an
/// object have the light of the air. Distances that anchors keep are those of the scene.
/// @param spheres [count][4] centre and radius > 0, metres; copied   @param count [0, 16]
/// @return ALP_OK; INVALID_ARGUMENT (nothing changes)
ALP_API ALP_NODISCARD alp_result alp_ambience_sampler_set_occluders(alp_ambience_sampler *sampler,
                                                                    const double (*spheres)[4],
                                                                    uint32_t count);

/// Work of one call.
typedef struct alp_ambience_work {
    uint32_t samples; ///< anchors that were traced and lit
    uint32_t relit;   ///< anchors whose kept hits were relit
    uint64_t rays;
    double seconds;
} alp_ambience_work;

/// Samples the anchors that alp_ambience_next wants, on all workers of the context.
/// @param samples      work, in anchors sampled by all rays; relighting costs a half, the first
///                     sample of an anchor a quarter
/// @param milliseconds 0, or stop after about so long: then light depends on the clock
/// @param work         NULL, or out
/// @return as alp_ambience_next
ALP_API ALP_NODISCARD alp_result alp_ambience_sample(alp_ambience_sampler *sampler,
                                                     const alp_ambience_camera *camera,
                                                     uint32_t samples, double milliseconds,
                                                     alp_ambience_work *work);

/// Fills all windows round a camera, before time moves: behind a loading screen. Without it, light
/// of the first seconds fades in, and bounces arrive with renewals.
/// @param time    as of alp_ambience_update; the first, or before it
/// @param bounces times that all anchors are lit; 5 are enough for most scenes
/// @return as alp_ambience_sample; INVALID_ARGUMENT also if time has moved, or `time` is
///         not that of the first update
ALP_API ALP_NODISCARD alp_result alp_ambience_sampler_warm(alp_ambience_sampler *sampler,
                                                           const alp_ambience_camera *camera,
                                                           double time, uint32_t bounces);

/// A field that reads the snapshot of the last update, and keeps it until it is destroyed.
/// @return ALP_OK; OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_field_create_ambience(alp_ambience *ambience,
                                                           alp_field **field);

/// A field of lamps that a host dims or switches: E = E_all + Σ (strength − 1) E_layer, at least 0.
/// Each layer is a volume of the light of one lamp (alp_ambience_sampler_options.light). Volumes of
/// the same options, anchors and ages add up within about .2 %. While light fades, they also differ
/// by fades of their own lengths. The field reads the snapshots of the last updates, and keeps them
/// until it is destroyed.
/// @param layers    [count]   @param strengths [count] finite, ≥ 0: 0 = off, 1 = as lit
/// @return ALP_OK; INVALID_ARGUMENT (a volume is NULL, or a strength out of range); OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_field_create_ambience_layers(alp_ambience *all,
                                                                  alp_ambience *const *layers,
                                                                  const float *strengths,
                                                                  uint32_t count,
                                                                  alp_field **field);

ALP_END_DECLS

#endif
