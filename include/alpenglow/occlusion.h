// SPDX-License-Identifier: MIT
// Ambient occlusion at points: how much of the sky above a surface is open.
#ifndef ALPENGLOW_OCCLUSION_H
#define ALPENGLOW_OCCLUSION_H

#include <alpenglow/scene.h>

ALP_BEGIN_DECLS

/// How much a hit at t = distance / limit occludes: w(t), 0 beyond the limit.
typedef enum alp_falloff {
    ALP_FALLOFF_NONE = 0,   ///< 1
    ALP_FALLOFF_LINEAR = 1, ///< 1 − t
    ALP_FALLOFF_SMOOTH = 2, ///< (1 − t)² (1 + 2t)
    ALP_FALLOFF_EXP = 3     ///< (e^(−4t) − e^(−4)) / (1 − e^(−4))
} alp_falloff;

typedef enum alp_distribution {
    ALP_DISTRIBUTION_COSINE = 0,
    ALP_DISTRIBUTION_UNIFORM = 1
} alp_distribution;

typedef struct alp_occlusion_options {
    size_t struct_size;
    uint32_t samples; ///< rays per receiver, [1, 2^20], rounded up to a multiple of 4; default 512
    float distance;   ///< metres, > 0; INFINITY = no limit; 0 (default) = auto: 20 % of
                      ///< the diagonal of the scene's bounding box
    alp_falloff falloff; ///< default SMOOTH; with no limit only NONE has a meaning
    float cone;          ///< half-angle about the normal, radians, (0, π/2]; default π/2
    alp_distribution distribution; ///< default COSINE
    bool one_sided; ///< true: single-sided materials are open from behind; default false
    uint64_t seed;  ///< default 0
    alp_progress_fn *progress;
    void *progress_user;
} alp_occlusion_options;
ALP_API alp_occlusion_options alp_occlusion_options_default(void);

/// The distance limit that options give in a scene, metres (resolves 0 = auto).
ALP_API float alp_occlusion_distance(const alp_scene *scene, const alp_occlusion_options *options);

/// Accessibility at points: 1 is open, 0 is closed.
///
///     A(p) = 1 − E[w(t)],   directions in the cone about n, cosine-distributed or uniform
///
/// which for w = 1 and the full hemisphere is (1/π) ∫ V(p, ω) (n·ω) dω. An open point is exactly 1,
/// unless its shading normal leans away from the geometric one: directions below its own surface
/// are closed, a share of (1 − cos δ)/2 for a lean of δ, a full cosine hemisphere and a flat
/// surface. Owen-scrambled Sobol' samples keyed by (seed, index of the point, sample): unbiased
/// over seeds, the same bits for any number of workers.
/// @param positions         [count][3] metres; a ray starts a few float steps along the geometric
/// normal
/// @param geometric_normals [count][3] unit, side from which the surface is seen; NULL = shading
/// normals
/// @param shading_normals   [count][3] unit: axis of the hemisphere
/// @param accessibility     [count] out, [0, 1]; written only on ALP_OK
/// @return ALP_OK; INVALID_ARGUMENT (NULL, options); INVALID_DATA (a position or normal not finite
/// or
///         not unit to 1e-3); OUT_OF_MEMORY; CANCELLED
/// Cost: count × samples rays; the first call on a scene builds its acceleration structure.
/// Based on: Zhukov, Iones, Kronin. An Ambient Light Illumination Model. EGWR 1998.
ALP_API ALP_NODISCARD alp_result alp_occlusion_at_points(
    const alp_scene *scene, uint32_t count, const float *positions, const float *geometric_normals,
    const float *shading_normals, const alp_occlusion_options *options, float *accessibility);

/// Bent normals: the mean open direction at points, from the rays of alp_occlusion_at_points.
///
///     normalised ∫ (1 − w) ω (n·ω) dω,   uniform distribution: without (n·ω)
///
/// @param bent_normals [count][3] out: world space, unit length; the shading normal where nothing
/// is
///                     open; written only on ALP_OK
/// Other parameters and results: as alp_occlusion_at_points.
/// Based on: H. Landis. Production-Ready Global Illumination. SIGGRAPH 2002 course 16.
ALP_API ALP_NODISCARD alp_result alp_bent_normals_at_points(
    const alp_scene *scene, uint32_t count, const float *positions, const float *geometric_normals,
    const float *shading_normals, const alp_occlusion_options *options, float *bent_normals);

/// Coloured obscurance at points: occlusion through which the colour of near surfaces bleeds.
///
///     W = (1/π) ∫ [ (1 − w) + w · albedo of the hit ] (n·ω) dω     per channel
///
/// The directions of alp_occlusion_at_points, asked for what they hit: about two to four times the
/// time. A single-sided surface is black from behind. Unbiased.
/// @param obscurance [count][3] out: linear RGB, [0, 1], 1 is open; written only on ALP_OK
/// Other parameters and results: as alp_occlusion_at_points.
/// Based on: A. Méndez, M. Sbert, J. Catà. Real-time Obscurances with Color Bleeding. SCCG 2003.
ALP_API ALP_NODISCARD alp_result alp_obscurance_at_points(
    const alp_scene *scene, uint32_t count, const float *positions, const float *geometric_normals,
    const float *shading_normals, const alp_occlusion_options *options, float *obscurance);

ALP_END_DECLS

#endif
