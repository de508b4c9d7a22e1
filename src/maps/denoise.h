// SPDX-License-Identifier: MIT
// Takes noise off light at texels, by neighbours in space: across charts and pages, never across a
// wall.
//
// Around each texel, planes are fitted to the light of its neighbours in the tangent plane (local
// linear regression: no bias at the border of a surface, none from a gradient), over radii that
// grow by 1.7. What a larger radius gives must agree with the texel's own mean and with what
// smaller radii give, up to the noise that is left in both; where it does not, the excess, averaged
// over neighbours, is its bias². The estimates are blended by their squared errors, bias² +
// variance.
// Based on: W. S. Cleveland. Robust Locally Weighted Regression. JASA 74(368), 1979;
//           C. M. Stein. Estimation of the Mean of a Multivariate Normal Distribution. 1981;
//           O. V. Lepskii. On a Problem of Adaptive Estimation in Gaussian White Noise. 1990;
//           F. Rousselle, C. Knaus, M. Zwicker. Adaptive Sampling and Reconstruction using Greedy
//           Error Minimization. SIGGRAPH Asia 2011;
//           B. Moon, N. Carr, S.-E. Yoon. Adaptive Rendering Based on Weighted Local Regression.
//           ACM TOG 33(5), 2014.
#ifndef ALPI_MAPS_DENOISE_H
#define ALPI_MAPS_DENOISE_H

#include "base/tasks.h"
#include "trace/trace.h"

/// Texels with their light, as plain arrays.
typedef struct alpi_denoise_texels {
    uint32_t count;
    const float (*means)[3];     // [count] light
    const float (*variances)[3]; // [count] of each mean, estimated from its samples
    const float (*positions)[3]; // [count] metres, on the surface
    const float (*normals)[3];   // [count] unit, of shading
    const float *sides;          // [count] metres: side of the texel on the surface
    const float (*albedos)[3];   // [count] or NULL. Where the light was multiplied by them: texels
                                 // of other colour then count less. Irradiance needs none
} alpi_denoise_texels;

/// Replaces means by what they and their neighbours say together, with their variance.
///
/// Meant for indirect light, which is smooth. The errors of two texels must be independent of each
/// other (paths that neighbours share look like signal, and stay). Linear in the means but for the
/// choice of the radius. A neighbour has a side half to twice as large, a normal within 45°, lies
/// within a side of the texel's plane and eight sides of it, and in sight: a ray between the two,
/// a quarter of a side above both (less below something low), meets nothing of the tracer.
/// Sums run in a fixed order: the same bits for any number of workers.
///
/// - Where no texel within three sides has any variance, means and variances stay bit by bit.
/// - A mean or a variance that is not finite (or a variance below 0) says that nothing is known:
///   the texel takes no part, and gets what its neighbours say. Where nobody says anything, or its
///   position, normal or side is none, it stays as it is.
///
/// @param tracer    of whatever stops light; NULL = nothing stands between texels
/// @param texels    borrowed
/// @param progress  NULL, or who is asked whether to go on
/// @param means     [count][3] out; may be texels->means
/// @param variances [count][3] out: variance that is left, an upper bound where estimates were
///                  blended, + the estimated bias²; may be texels->variances. Errors of neighbours
///                  are no longer independent
/// @return ALP_OK; OUT_OF_MEMORY; CANCELLED: the outputs are none
/// Cost: at most 384 short rays a texel, 200 on one plane; in all 25 to 70 µs of one core, and
/// about 270 bytes while it runs.
alp_result alpi_denoise(alp_context *context, const alpi_tracer *tracer,
                        const alpi_denoise_texels *texels, const alpi_task_progress *progress,
                        float (*means)[3], float (*variances)[3]);

#endif
