// SPDX-License-Identifier: MIT
// Light in space: irradiance at any position and normal, and the reference to hold it to.
//
// Every field holds the same light: sky, emissive surfaces, and all light that surfaces reflect.
// Light straight from punctual lamps and suns stays out by default, because a host adds it with
// its own shadows.
#ifndef ALPENGLOW_FIELD_H
#define ALPENGLOW_FIELD_H

#include <alpenglow/light.h>
#include <alpenglow/scene.h>
#include <alpenglow/shared_constants.h>

ALP_BEGIN_DECLS

/// Irradiance E(p, n) [W·m⁻² per channel, linear Rec.709] of a model of light. Opaque and
/// immutable. Destroy it before its scene.
typedef struct alp_field alp_field;

ALP_API void alp_field_destroy(alp_field *field); ///< NULL does nothing

/// Evaluates a field.
/// @param positions  [count][3] metres, positions in the scene
/// @param normals    [count][3] unit
/// @param irradiance [count][3] out: E ≥ 0. 0 at positions and normals that are not finite.
/// May be called by any number of threads at once. It allocates nothing and does not fail.
ALP_API void alp_field_irradiance(const alp_field *field, uint32_t count,
                                  const float (*positions)[3], const float (*normals)[3],
                                  float (*irradiance)[3]);

/// Expected error of a field at points: root mean square over the channels, W·m⁻².
///   ambient models  that at the points which they were fitted at, the same everywhere
///   probes          √(noise² + f² (v² + (.03 E)²)). v is the RMS change of E within a quarter of
///                   a cell along the axes. f is measured at points that took no part in the bake.
///   a list          its noise alone
/// @param errors [count] out; 0 where it is not known
/// May be called by any number of threads at once. It allocates nothing and does not fail.
ALP_API void alp_field_errors(const alp_field *field, uint32_t count, const float (*positions)[3],
                              const float (*normals)[3], float *errors);

/// Classic models of ambient light: a few colours for the whole scene. All are linear in their
/// colours, which are fitted to the scene's light by least squares.
typedef enum alp_ambient_model {
    ALP_AMBIENT_CONSTANT = 0, ///< E = c
    ALP_AMBIENT_HEMISPHERE,   ///< E = up (1 + n·y)/2 + down (1 − n·y)/2
    /// E = up (1 + n·y)/2 + (down + s g(x, z)) (1 − n·y)/2. The ground map g holds the radiosity B
    /// of the first front side below the top of the scene, in 64 × 64 texels over its bounds. The
    /// factor s is fitted for each channel.
    ALP_AMBIENT_GROUND_MAP,
    ALP_AMBIENT_CUBE,        ///< E = Σ n_i² c(±axis i), six colours
    ALP_AMBIENT_ENVIRONMENT, ///< E = Σ A_l c_lm Y_lm(n), nine coefficients
    ALP_AMBIENT_COUNT
} alp_ambient_model;

typedef struct alp_ambient_options {
    size_t struct_size;
    alp_ambient_model model;
    alp_lighting_options lighting; ///< beside the lights of the file
    uint32_t bounces;              ///< default ALP_BOUNCES_CONVERGE
    bool direct;      ///< light straight from punctual lamps and suns is in E; default false
    uint32_t points;  ///< random free points with random normals to fit at, [16, 1000000]; default
                      ///< 1024
    uint32_t samples; ///< paths of the reference at each, [1, 65536]; default 256
    uint64_t seed;
    alp_progress_fn *progress; ///< stage "fit"
    void *progress_user;
} alp_ambient_options;
ALP_API alp_ambient_options alp_ambient_options_default(void);

/// Fits a model to the light of a scene.
/// @param field out, which the caller destroys; NULL on failure
/// @return ALP_OK; INVALID_ARGUMENT (an option out of range; nothing lights the scene; no free
///         point was found); OUT_OF_MEMORY; CANCELLED
ALP_API ALP_NODISCARD alp_result alp_field_create_ambient(const alp_scene *scene,
                                                          const alp_ambient_options *options,
                                                          alp_field **field);

/// Number of colours of a model, at most.
#define ALP_AMBIENT_COLORS 9

/// The colours of an ambient model, for hosts that evaluate it themselves. E is that of the model's
/// formula, or 0 where the formula is below 0.
typedef struct alp_ambient_info {
    alp_ambient_model model;
    uint32_t color_count; ///< of `colors`: 1, 2, 3, 6 or 9, in the order of the models
    /// CONSTANT: c. HEMISPHERE: up, down. GROUND_MAP: up, down, s. CUBE: c(+x), c(−x), c(+y),
    /// c(−y), c(+z), c(−z). ENVIRONMENT: c_lm at index l (l + 1) + m (alpenglow/sh.h).
    float colors[ALP_AMBIENT_COLORS][3];
    /// GROUND_MAP, else NULL: [ALP_GROUND_MAP_SIDE][ALP_GROUND_MAP_SIDE] texels of g by row and
    /// column [W·m⁻²], valid while the field lives. g(x, z) is bilinear between the centres of
    /// texels, and clamped beyond them. The centre of the first texel is at column and row 0.5.
    const float (*ground)[3];
    float ground_low[2];   ///< column = (x − ground_low[0]) ground_scale[0]
    float ground_scale[2]; ///< row = (z − ground_low[1]) ground_scale[1]
} alp_ambient_info;
/// @param field of alp_field_create_ambient, else (also NULL) a zeroed struct
ALP_API alp_ambient_info alp_field_get_ambient(const alp_field *field);

/// The truth at points: path tracing of the light that fields hold.
typedef struct alp_reference_options {
    size_t struct_size;
    alp_lighting_options lighting;
    uint32_t bounces; ///< default ALP_BOUNCES_CONVERGE
    uint32_t samples; ///< paths of each point, [1, 1048576], rounded up to a multiple of 16;
                      ///< default 1024
    bool direct;      ///< as in alp_ambient_options; default false
    uint64_t seed;
    alp_progress_fn *progress; ///< stage "reference"
    void *progress_user;
} alp_reference_options;
ALP_API alp_reference_options alp_reference_options_default(void);

/// Traces the reference at points.
/// @param irradiance [count][3] out: E [W·m⁻²], unbiased
/// @param errors     [count][3] out, or NULL: standard error of each
/// @return ALP_OK; INVALID_ARGUMENT (an option out of range; nothing lights the scene; a position
///         or normal that is not finite, or a normal that is 0: the message names its index);
///         OUT_OF_MEMORY; CANCELLED
ALP_API ALP_NODISCARD alp_result
alp_reference_irradiance(const alp_scene *scene, const alp_reference_options *options,
                         uint32_t count, const float (*positions)[3], const float (*normals)[3],
                         float (*irradiance)[3], float (*errors)[3]);

/// Random points in the free air of a scene, with random normals: points inside its bounds from
/// which at most a quarter of the sphere shows black backs of surfaces.
/// @param positions, normals [count][3] out
/// @return ALP_OK; INVALID_ARGUMENT (no free point was found); OUT_OF_MEMORY; CANCELLED
ALP_API ALP_NODISCARD alp_result alp_scene_free_points(const alp_scene *scene, uint64_t seed,
                                                       uint32_t count, float (*positions)[3],
                                                       float (*normals)[3]);
/// The same inside the part of the bounds that lies in a ball.
/// @param centre metres   @param radius metres, > 0
/// @return as alp_scene_free_points; INVALID_ARGUMENT also if the ball lies outside of the bounds
ALP_API ALP_NODISCARD alp_result alp_scene_free_points_near(const alp_scene *scene,
                                                            const float centre[3], float radius,
                                                            uint64_t seed, uint32_t count,
                                                            float (*positions)[3],
                                                            float (*normals)[3]);

ALP_END_DECLS

#endif
