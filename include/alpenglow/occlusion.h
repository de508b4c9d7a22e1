// SPDX-License-Identifier: MIT
// Ambient occlusion, bent normals and obscurance at points.
#ifndef ALPENGLOW_OCCLUSION_H
#define ALPENGLOW_OCCLUSION_H

#include <alpenglow/scene.h>

ALP_BEGIN_DECLS

/// Occlusion w(t) by a hit at t = distance / limit; 0 beyond the limit.
typedef enum alp_falloff {
    ALP_FALLOFF_NONE = 0,   ///< 1
    ALP_FALLOFF_LINEAR = 1, ///< 1 − t
    ALP_FALLOFF_SMOOTH = 2, ///< (1 − t)² (1 + 2t)
    ALP_FALLOFF_EXP = 3     ///< (e^(−4t) − e^(−4)) / (1 − e^(−4))
} alp_falloff;

/// Distribution of the rays' directions in the cone.
typedef enum alp_distribution {
    ALP_DISTRIBUTION_COSINE = 0,
    ALP_DISTRIBUTION_UNIFORM = 1
} alp_distribution;

typedef struct alp_occlusion_options {
    size_t struct_size;
    uint32_t samples; ///< rays per receiver, [1, 2^20], rounded up to a multiple of 4; default 512
    float distance;   ///< limit in metres, > 0; INFINITY = none. 0 (default) = automatic: 20 % of
                      ///< the diagonal of the scene's bounding box.
    alp_falloff falloff; ///< default SMOOTH; without a limit it counts as NONE
    float cone;          ///< half-angle about the normal, radians, (0, π/2]; default π/2
    alp_distribution distribution; ///< default COSINE
    bool one_sided; ///< true: backs of single-sided materials do not occlude; default false
    uint64_t seed;  ///< default 0
    alp_progress_fn *progress;
    void *progress_user;
} alp_occlusion_options;
ALP_API alp_occlusion_options alp_occlusion_options_default(void);

/// The distance limit in metres that the options give in a scene. It resolves 0 = automatic.
ALP_API float alp_occlusion_distance(const alp_scene *scene, const alp_occlusion_options *options);

/// Accessibility at points: 1 is open, 0 is closed.
///
///     A(p) = 1 − E[w(t)],   directions in the cone about n, cosine-distributed or uniform
///
/// For w = 1 and the full hemisphere this is (1/π) ∫ V(p, ω) (n·ω) dω. An open point is exactly 1
/// if its two normals agree. Directions below the geometric surface are closed. A shading normal
/// that leans by δ, with a full cosine hemisphere on a flat surface, closes a share of (1 − cos
/// δ)/2.
///
/// Owen-scrambled Sobol' samples are keyed by (seed, index of the point, sample). The result is
/// unbiased over seeds, and the same bits for any number of workers.
/// @param positions         [count][3] metres; a ray starts a few float steps along the geometric
///                          normal
/// @param geometric_normals [count][3] unit, on the visible side; NULL = shading normals
/// @param shading_normals   [count][3] unit: axis of the hemisphere
/// @param accessibility     [count] out, [0, 1]; written only on ALP_OK
/// @return ALP_OK; INVALID_ARGUMENT (NULL, options); INVALID_DATA (a position or normal is not
///         finite, or a normal not unit to 1e-3); OUT_OF_MEMORY; CANCELLED
/// Cost: count × samples rays; the first call on a scene builds its acceleration structure.
/// Based on: Zhukov, Iones, Kronin. An Ambient Light Illumination Model. EGWR 1998.
ALP_API ALP_NODISCARD alp_result alp_occlusion_at_points(
    const alp_scene *scene, uint32_t count, const float *positions, const float *geometric_normals,
    const float *shading_normals, const alp_occlusion_options *options, float *accessibility);

/// Bent normals at points: the mean open direction, from the rays of alp_occlusion_at_points.
///
///     normalised ∫ (1 − w) ω (n·ω) dω,   uniform distribution: without (n·ω)
///
/// @param bent_normals [count][3] out: world space, unit length; the shading normal if nothing is
///                     open; written only on ALP_OK
/// Other parameters and results: as alp_occlusion_at_points.
/// Based on: H. Landis. Production-Ready Global Illumination. SIGGRAPH 2002 course 16.
ALP_API ALP_NODISCARD alp_result alp_bent_normals_at_points(
    const alp_scene *scene, uint32_t count, const float *positions, const float *geometric_normals,
    const float *shading_normals, const alp_occlusion_options *options, float *bent_normals);

/// Coloured obscurance at points: occlusion in which near surfaces add their colour.
///
///     W = (1/π) ∫ [ (1 − w) + w · albedo of the hit ] (n·ω) dω     per channel
///
/// It traces the directions of alp_occlusion_at_points to their nearest hits. A single-sided
/// surface is black from behind. Unbiased.
/// @param obscurance [count][3] out: linear RGB, [0, 1], 1 is open; written only on ALP_OK
/// Other parameters and results: as alp_occlusion_at_points.
/// Cost: about two to four times that of alp_occlusion_at_points.
/// Based on: A. Méndez, M. Sbert, J. Catà. Real-time Obscurances with Color Bleeding. SCCG 2003.
ALP_API ALP_NODISCARD alp_result alp_obscurance_at_points(
    const alp_scene *scene, uint32_t count, const float *positions, const float *geometric_normals,
    const float *shading_normals, const alp_occlusion_options *options, float *obscurance);

ALP_END_DECLS

#endif
