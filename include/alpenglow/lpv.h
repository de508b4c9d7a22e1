// SPDX-License-Identifier: MIT
// Light propagation volumes: light that surfaces reflect, found in milliseconds and with no
// precomputation. Lamps and geometry may move in every frame.
//
// The light that a lamp's surfaces reflect first is injected into a grid of cells. It travels from
// cell to cell, and the sum of what passed is the light in space. A host hands in its reflective
// shadow maps and its view of the scene:
//
//     alp_lpv_follow(lpv, eye, forward);                     // each frame
//     alp_lpv_begin(lpv);
//     alp_lpv_add_light(lpv, ALP_LPV_ALL_CASCADES, &map);       // of each lamp
//     alp_lpv_add_blockers(lpv, ALP_LPV_ALL_CASCADES, &map);    // of each view
//     alp_lpv_propagate(lpv);
//     alp_field_irradiance(field, count, positions, normals, irradiance);
//
// Or alp_lpv_light_scene does begin, add_light, add_blockers and propagate, with rays through a
// scene.
// One thread calls what changes a volume. Between changes any number of threads may read it.
// Based on: A. Kaplanyan, C. Dachsbacher. Cascaded Light Propagation Volumes for Real-Time Indirect
//           Illumination. I3D 2010.
// Departures in all modes: a step keeps all light, and surfaces are read half a cell above, beyond
// cells that lie half in a wall. ACCURATE does not damp light, which blackens walls near lit
// floors.
#ifndef ALPENGLOW_LPV_H
#define ALPENGLOW_LPV_H

#include <alpenglow/field.h>

ALP_BEGIN_DECLS

typedef struct alp_lpv alp_lpv; ///< opaque

/// How light goes from a cell to the next one, through the five faces that it has there.
typedef enum alp_lpv_mode {
    /// Light keeps the direction in which it travelled. Blockers stop light by its angle, 1.6
    /// times.
    ALP_LPV_ACCURATE = 0,
    /// The paper: light leaves the next cell along the normal of the face that it met. Views of
    /// blockers are merged by the maximum of each coefficient. Light on surfaces that falls along
    /// their normal is damped.
    ALP_LPV_CONFORMANCE,
    /// An older proposal: as CONFORMANCE, with the mean of the intensity over each face in place
    /// of the intensity towards its middle.
    ALP_LPV_TRANSFER,
    ALP_LPV_MODE_COUNT
} alp_lpv_mode;

typedef struct alp_lpv_options {
    size_t struct_size;
    uint32_t size[3]; ///< cells of each grid along x, y, z, [1, 512]; default 32
    double cell;      ///< metres of a cell of the finest grid, [1e-6, 1e12]; default 0.25
    double centre[3]; ///< metres: the centre of the grids at first; default 0
    /// Grids inside each other, [1, 8]; default 1. The cells of each are twice as large as those
    /// of the one before.
    uint32_t cascades;
    /// Steps that light travels, [1, 4096]; 0 (default): the longest side of a single grid, 8 with
    /// cascades
    uint32_t iterations;
    alp_lpv_mode mode;
    bool blockers; ///< light is stopped by surfaces; default true
    /// 1: what lamps' first surfaces reflect. ALP_BOUNCES_CONVERGE (default): blockers reflect
    /// light again, as often as the iterations allow. No other value is taken.
    uint32_t bounces;
    uint64_t memory_limit; ///< bytes that the volume may hold; 0 (default): no limit
} alp_lpv_options;
ALP_API alp_lpv_options alp_lpv_options_default(void);

/// Bytes that a volume of these options holds: about 200 a cell. With blockers 140 more for each
/// corner of cells. Beside them the volume keeps 32 bytes for each surfel of its largest call, and
/// alp_lpv_light_scene takes 56 bytes for each texel of a map, or point, while it adds them.
ALP_API uint64_t alp_lpv_memory(const alp_lpv_options *options);

/// @param options NULL = defaults
/// @return ALP_OK; INVALID_ARGUMENT (an option out of range); LIMIT (more than `memory_limit`; the
///         message states both); OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_lpv_create(alp_context *context,
                                                const alp_lpv_options *options, alp_lpv **lpv);
/// NULL does nothing. Fields of the volume must have been destroyed.
ALP_API void alp_lpv_destroy(alp_lpv *lpv);

/// Options whose grids hold a scene: the coarsest reaches a cell beyond its bounds.
/// @param scene   @param grid cells along each side   @param cascades [1, 8]
ALP_API alp_lpv_options alp_lpv_options_for_scene(const alp_scene *scene, uint32_t grid,
                                                  uint32_t cascades);

/// Options whose grids hold a scene from where a viewer is: with alp_lpv_follow to the same place
/// the coarsest reaches a cell beyond its bounds.
/// @param eye     metres; `centre` is the nearest place in the bounds, to be followed
/// @param forward any length; 0: the grids lie round the eye
ALP_API alp_lpv_options alp_lpv_options_for_view(const alp_scene *scene, uint32_t grid,
                                                 uint32_t cascades, const double eye[3],
                                                 const double forward[3]);

/// Moves the grids, by whole cells, so that the eye looks into the larger part of each.
/// @param eye metres   @param forward any length; 0: the grids are centred at the eye
/// @return ALP_OK; INVALID_ARGUMENT (not finite, or beyond 2^40 cells: nothing changes)
ALP_API ALP_NODISCARD alp_result alp_lpv_follow(alp_lpv *lpv, const double eye[3],
                                                const double forward[3]);

/// Place of a grid, for hosts that run a volume on a graphics card.
typedef struct alp_lpv_placement {
    double cell;       ///< metres
    int64_t corner[3]; ///< of cell 0, 0, 0, in cells from the origin
    double centre[3];  ///< metres, before rounding to whole cells: grids fade about it
} alp_lpv_placement;
/// Places a grid as alp_lpv_follow does.
/// @param options of a volume   @param cascade 0 the finest   @param eye metres
/// @param forward unit, or 0: the grid is centred at the eye   @param placement out
ALP_API void alp_lpv_place(const alp_lpv_options *options, uint32_t cascade, const double eye[3],
                           const double forward[3], alp_lpv_placement *placement);

/// Takes all light and blockers out. The light of the last propagation stays until the next.
ALP_API void alp_lpv_begin(alp_lpv *lpv);
/// The same, but the blockers of the last frame stay and count as one view more.
ALP_API void alp_lpv_begin_with_last_blockers(alp_lpv *lpv);

/// Small parts of surfaces: texels of a reflective shadow map or of a camera's picture. Arrays are
/// borrowed during the call. Elements are left out and counted if a value is not finite, a normal
/// not unit, an albedo above 1, or a flux or area so large that sums would not fit a float.
typedef struct alp_lpv_surfels {
    uint32_t count;
    const float (*positions)[3]; ///< metres
    const float (*normals)[3];   ///< unit, on the lit side
    /// [W per channel] that each reflects or emits: of a sun albedo × E⊥ × area of the map / texels
    /// (no cosine: the map's texel is seen along the sun's way); of a lamp albedo × I × solid angle
    const float (*flux)[3];
    const float *areas;       ///< m² of the surface; for blockers
    const float (*albedo)[3]; ///< [0, 1], for blockers; NULL: 0.5
    const float *radii; ///< metres of the bounding sphere of the object; 0, or NULL: any object.
                        ///< An object smaller than a cell is left out of that grid.
} alp_lpv_surfels;

/// Grids that take light.
#define ALP_LPV_ALL_CASCADES UINT32_MAX
/// Injects light: each surfel is a virtual point light half a cell above its surface.
/// @param cascade the grid that the map was made for, 0 the finest. Its light enters that grid and
///        coarser ones. At the end of a grid its map fades, and the next map takes over. The last
///        cell of the coarsest of several grids fades too, so that nothing jumps when grids move.
///        ALP_LPV_ALL_CASCADES: the map holds all light of its lamp.
/// @return ALP_OK; INVALID_ARGUMENT (no positions, normals or flux; no such cascade)
ALP_API ALP_NODISCARD alp_result alp_lpv_add_light(alp_lpv *lpv, uint32_t cascade,
                                                   const alp_lpv_surfels *surfels);
/// Injects blockers. One call is one view: views are merged, as they show the same surfaces.
/// @param cascade the grid that the view was made for, which it enters alone, or
///        ALP_LPV_ALL_CASCADES
/// @return ALP_OK; INVALID_ARGUMENT (no positions, normals or areas; no such cascade; the volume
/// has
///         no blockers)
ALP_API ALP_NODISCARD alp_result alp_lpv_add_blockers(alp_lpv *lpv, uint32_t cascade,
                                                      const alp_lpv_surfels *surfels);
/// Lets light travel. Cost: about 20 ns a cell and step on one core, 40 with blockers, 60 with
/// bounces too.
/// @return ALP_OK; OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_lpv_propagate(alp_lpv *lpv);

/// E of the volume, as of any field: the light that was injected. Light straight from lamps and
/// the sky are not in it.
///     E = (π p0 − 2π/3 p·n) / (1.5 s²),   I(ω) = p0 + p·ω the sum of intensities, s the cell
/// The field reads what the volume holds at the time. Destroy it before the volume.
/// @return ALP_OK; OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_field_create_lpv(const alp_lpv *lpv, alp_field **field);

/// Radiance that arrives from directions, as a mirror or a dull metal sees it: intensities along
/// the way, four cells far, the nearest first.
/// @param positions [count][3] metres   @param directions [count][3] unit, from the position
/// @param radiance  [count][3] out, W·sr⁻¹·m⁻² ≥ 0
ALP_API void alp_lpv_radiance(const alp_lpv *lpv, uint32_t count, const float (*positions)[3],
                              const float (*directions)[3], float (*radiance)[3]);
/// Fluence ∫ L dω [W·m⁻²] at points: what air scatters, × its coefficient / 4π for each metre.
/// @param positions [count][3] metres   @param fluence [count][3] out, ≥ 0
ALP_API void alp_lpv_fluence(const alp_lpv *lpv, uint32_t count, const float (*positions)[3],
                             float (*fluence)[3]);

typedef struct alp_lpv_scene_options {
    size_t struct_size;
    alp_lighting_options lighting; ///< beside the lights of the file; a sky is left out
    uint32_t map_size;             ///< texels along the side of a map, [4, 4096]; default 256
    /// Points on the surfaces that block light, spread by area, [1, 16777216]; default 65536.
    /// 0: the maps and `camera` are the views of blockers.
    uint32_t points;
    const alp_camera *camera; ///< a view of blockers, or NULL; borrowed during the call
    float camera_aspect;      ///< width / height of that view, [1e-5, 1e5]; default 1
    uint64_t seed;
} alp_lpv_scene_options;
ALP_API alp_lpv_scene_options alp_lpv_scene_options_default(void);

/// Seconds and counts of a call of alp_lpv_light_scene.
typedef struct alp_lpv_report {
    size_t struct_size;
    double trace, inject, block, propagate; ///< seconds of each stage
    uint64_t rays;                          ///< of the maps
    uint64_t lit;                           ///< texels and points that send light
    uint64_t lights;                        ///< those that a grid holds: virtual point lights
    double flux[3];                         ///< W injected into the coarsest grid
} alp_lpv_report;

/// Traces a reflective shadow map of each lamp and sun, and of emissive surfaces, injects them and
/// propagates: begin, add_light, add_blockers, propagate.
/// A sun has a map for each grid; other lights one map. Glass counts as opaque.
/// @param options NULL = defaults   @param report out, or NULL
/// @return ALP_OK; INVALID_ARGUMENT (an option out of range; a camera without place, direction or
///         angle; nothing lights the scene); OUT_OF_MEMORY; UNSUPPORTED (the ray tracer fails)
ALP_API ALP_NODISCARD alp_result alp_lpv_light_scene(alp_lpv *lpv, const alp_scene *scene,
                                                     const alp_lpv_scene_options *options,
                                                     alp_lpv_report *report);

/// Surfels of a scene that stay while lamps move, for hosts that run a volume on a graphics card.
typedef struct alp_lpv_collection alp_lpv_collection; ///< opaque
typedef enum alp_lpv_source {
    /// Half of the surfels are points of emissive surfaces, with the flux that they emit. The other
    /// half are what this light meets first, with the flux that is reflected there.
    ALP_LPV_EMITTERS = 0,
    ALP_LPV_POINTS ///< points of all surfaces, spread by area; they block
} alp_lpv_source;
/// Collects surfels, as alp_lpv_light_scene does in each frame.
/// @param count [2, 16777216]; without emissive surfaces EMITTERS has none
/// @return ALP_OK; INVALID_ARGUMENT (count); OUT_OF_MEMORY; UNSUPPORTED (the ray tracer fails)
ALP_API ALP_NODISCARD alp_result alp_lpv_collect(const alp_scene *scene, alp_lpv_source source,
                                                 uint32_t count, uint64_t seed,
                                                 alp_lpv_collection **collection);
ALP_API void alp_lpv_collection_destroy(alp_lpv_collection *collection); ///< NULL does nothing
/// Its arrays belong to the collection. Elements without a hit have neither flux nor area.
ALP_API alp_lpv_surfels alp_lpv_collection_surfels(const alp_lpv_collection *collection);

/// A grid and its sums, for pictures and tests.
typedef struct alp_lpv_grid {
    uint32_t size[3];
    double cell;      ///< metres
    double corner[3]; ///< metres, of the cell 0, 0, 0
    /// [z][y][channel × 4 + coefficient][x]: p0, px, py, pz of the sum of intensities, W·sr⁻¹.
    const float *intensities;
} alp_lpv_grid;
/// @param cascade below alp_lpv_options.cascades
/// @param grid    out; valid until the next change. Its array belongs to the volume.
ALP_API void alp_lpv_get_grid(const alp_lpv *lpv, uint32_t cascade, alp_lpv_grid *grid);
/// Steps of a propagation: alp_lpv_options.iterations, or the number that 0 stands for.
ALP_API uint32_t alp_lpv_iterations(const alp_lpv *lpv);
/// Elements of surfels since `begin` that were left out for their values.
ALP_API uint64_t alp_lpv_skipped(const alp_lpv *lpv);

ALP_END_DECLS

#endif
