// SPDX-License-Identifier: MIT
// Spherical harmonics of light: projection of environments, irradiance, conversion to and from the
// conventions of other programs.
//
// The basis is real, index l(l+1)+m, without the Condon–Shortley sign, in a right-handed frame with
// +Y up:
//
//     Y = .282095 | .488603 (y, z, x) | 1.092548 (xy, yz), .315392 (3z² − 1), 1.092548 xz,
//         .546274 (x² − y²)
//
// A set of nine coefficients holds radiance L: c = ∫ L(ω) Y(ω) dω, in W·m⁻² per channel. It is
// neither convolved with a cosine nor divided by π. Constant radiance 1 has c₀ = 2√π.
#ifndef ALPENGLOW_SH_H
#define ALPENGLOW_SH_H

#include <alpenglow/image.h>

ALP_BEGIN_DECLS

/// Nine coefficients of radiance for R, G and B. All zero is darkness.
typedef struct alp_sh9 {
    float c[9][3];
} alp_sh9;

// --- projection ----------------------------------------------------------------------------------

/// Projects an equirectangular image of radiance:
///
///     c = Σ L(texel) ∫ Y(ω) dω over the texel
///
/// The integrals are exact, and those of 1 sum to 4π. Row 0 is up (+Y). The middle column is −Z,
/// and columns to its right turn towards +X. Alpha is ignored. With a warning (sky-image), negative
/// values and NaN count as 0; infinite ones and those above 1e30 count as the brightest value.
/// Any number of workers gives the same bits.
/// @param image    float, 3 or 4 channels, twice as wide as high
/// @param radiance out; written only on ALP_OK
/// @return ALP_OK; INVALID_ARGUMENT (NULL, or an image of another kind); OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_sh_project_image(const alp_image *image, alp_sh9 *radiance);

/// Faces of a cube map, in the order and orientation of OpenGL, Direct3D and Vulkan. With s to the
/// right, t downwards, both in [−1, 1], a face holds these directions:
///
///     +X (1, −t, −s)   −X (−1, −t, s)   +Y (s, 1, t)   −Y (s, −1, −t)   +Z (s, −t, 1)
///     −Z (−s, −t, −1)
typedef enum alp_cube_face {
    ALP_CUBE_POSITIVE_X = 0,
    ALP_CUBE_NEGATIVE_X = 1,
    ALP_CUBE_POSITIVE_Y = 2,
    ALP_CUBE_NEGATIVE_Y = 3,
    ALP_CUBE_POSITIVE_Z = 4,
    ALP_CUBE_NEGATIVE_Z = 5
} alp_cube_face;

/// Projection of cube maps of one size. It holds the integrals of the basis over each texel, and
/// the sums of the cube map that is being added. One thread at a time may use it.
typedef struct alp_sh_projection alp_sh_projection;

/// Makes a projection for faces of size × size texels. It takes 9 size² bytes and some time, so
/// keep it for the next cube map.
/// @param size       [1, 4096]
/// @param projection out; NULL on failure. Destroy it before the context.
/// @return ALP_OK; INVALID_ARGUMENT; OUT_OF_MEMORY
ALP_API ALP_NODISCARD alp_result alp_sh_projection_create(alp_context *context, uint32_t size,
                                                          alp_sh_projection **projection);
ALP_API void alp_sh_projection_destroy(alp_sh_projection *projection); ///< NULL does nothing

/// Adds some rows of a face, so that the work can spread over several frames. Faces and rows come
/// in any order, each row once.
/// @param pixels [row_count][size][3] radiance, linear; row first_row first. Values must be finite.
/// @return ALP_OK; INVALID_ARGUMENT (NULL, no such face or rows, a row that was added before)
ALP_API ALP_NODISCARD alp_result alp_sh_projection_add(alp_sh_projection *projection,
                                                       alp_cube_face face, uint32_t first_row,
                                                       uint32_t row_count, const float *pixels);

/// Gives the coefficients of the rows that were added, and empties the sums for the next cube map.
/// @param radiance out; written only on ALP_OK
/// @return ALP_OK; INVALID_ARGUMENT (NULL, or rows are missing: the sums stay)
ALP_API ALP_NODISCARD alp_result alp_sh_projection_finish(alp_sh_projection *projection,
                                                          alp_sh9 *radiance);

/// Projects a whole cube map: add of each face, then finish. Sums that were begun are dropped.
/// @param faces each [size][size][3], in the order of alp_cube_face
/// @param radiance out; written only on ALP_OK
/// @return ALP_OK; INVALID_ARGUMENT
ALP_API ALP_NODISCARD alp_result alp_sh_project_cube(alp_sh_projection *projection,
                                                     const float *const faces[6],
                                                     alp_sh9 *radiance);

// --- lights --------------------------------------------------------------------------------------

/// Adds light from one direction: c += E Y(d).
/// @param direction  unit vector towards the light
/// @param irradiance of a surface that faces the light, W·m⁻² per channel
ALP_API void alp_sh_add_directional(alp_sh9 *radiance, const float direction[3],
                                    const float irradiance[3]);
/// Adds a point light: a directional light of irradiance I / r².
/// @param offset    from the point of the coefficients to the light, metres, r > 0; 0 adds nothing
/// @param intensity I, W·sr⁻¹ per channel
ALP_API void alp_sh_add_point(alp_sh9 *radiance, const float offset[3], const float intensity[3]);
/// Adds a disk of even radiance in the sky: the cone of directions around d with a half angle.
/// @param half_angle radians, [0, π]; π is the whole sphere
/// @param disk       radiance, W·sr⁻¹·m⁻² per channel
ALP_API void alp_sh_add_disk(alp_sh9 *radiance, const float direction[3], double half_angle,
                             const float disk[3]);
/// Adds a sky of two halves: radiance `up` around the direction, `down` around its opposite.
ALP_API void alp_sh_add_hemisphere(alp_sh9 *radiance, const float direction[3], const float up[3],
                                   const float down[3]);

// --- read-out ------------------------------------------------------------------------------------

/// Ways to read irradiance from nine coefficients.
typedef enum alp_sh_reading {
    ALP_SH_CLAMPED = 0, ///< max(0, E)
    ALP_SH_LINEAR = 1,  ///< E, which can be negative opposite to a small bright light
    /// Bands 0 and 1 alone, never negative, channel by channel. With r = |c₁| / (√3 c₀),
    /// q = (1 + n·c₁/|c₁|) / 2, p = 1 + 2r and a = (1 − r) / (1 + r):
    /// E = (√π/2) c₀ (a + (1 − a) (p + 1) qᵖ). 0 for c₀ ≤ 0; r is held to [0, 1].
    ALP_SH_TWO_BANDS = 2
} alp_sh_reading;

/// Irradiance of a plane, W·m⁻² per channel:
///
///     E(n) = Σ A_l c_lm Y_lm(n),   A = π, 2π/3, π/4
///
/// For one directional light with E = 1 the largest error is 3/32 (.0938), the mean one .0307.
/// @param normal     unit vector
/// @param irradiance out; may not alias normal
/// Based on: R. Ramamoorthi, P. Hanrahan. An Efficient Representation for Irradiance Environment
/// Maps. SIGGRAPH 2001. The two bands: Geomerics. Reconstructing Diffuse Lighting
/// from Spherical Harmonic Data. 2015.
ALP_API void alp_sh_irradiance(const alp_sh9 *radiance, const float normal[3],
                               alp_sh_reading reading, float irradiance[3]);

/// Twelve vectors for a shader. Vectors 4k to 4k + 3 are the columns of the symmetric matrix M of
/// channel k, and E = nᵗ M n with n = (x, y, z, 1). It equals ALP_SH_LINEAR up to rounding:
///
///     float e = dot(n, mat4(v[0], v[1], v[2], v[3]) * n); // red; then v[4]…, v[8]…
ALP_API void alp_sh_shader_vectors(const alp_sh9 *radiance, float vectors[12][4]);
/// The same read-out in C. @param vectors [12][4]   @param irradiance out
ALP_API void alp_sh_shader_irradiance(const float *vectors, const float normal[3],
                                      float irradiance[3]);

/// Draws irradiance as an equirectangular image in the layout of alp_sh_project_image, three float
/// channels. Each pixel is E at its centre.
/// @param width  [2, 16384], even; the height is half of it
/// @param image  out, which the caller destroys; NULL on failure
/// @return ALP_OK; INVALID_ARGUMENT; OUT_OF_MEMORY
/// Based on: G. King. Real-Time Computation of Dynamic Irradiance Environment Maps. GPU Gems 2,
/// 2005.
ALP_API ALP_NODISCARD alp_result alp_sh_irradiance_image(alp_context *context,
                                                         const alp_sh9 *radiance,
                                                         alp_sh_reading reading, uint32_t width,
                                                         alp_image **image);

// --- operations ----------------------------------------------------------------------------------

/// Turns light: rotated(R ω) = radiance(ω). A mirror may be part of R.
/// @param rotation orthonormal, column-major: the images of x, y and z
/// @param rotated  out; may be `radiance`
ALP_API void alp_sh_rotate(const alp_sh9 *radiance, const float rotation[9], alp_sh9 *rotated);

/// Windows against ringing: factors by band l, less than 1 above band 0.
typedef enum alp_sh_window_kind {
    ALP_SH_HANNING = 0, ///< (1 + cos(π l / w)) / 2
    ALP_SH_SINC4 = 1    ///< (sin(π l / w) / (π l / w))⁴
} alp_sh_window_kind;
/// Multiplies band l by its factor; bands from w on become 0.
/// @param width w, > 0; 4 is mild. SINC4 with 3 leaves no E below 0, whatever the lights.
ALP_API void alp_sh_window(alp_sh9 *radiance, alp_sh_window_kind kind, double width);

/// The product of radiance with a cosine lobe, L(ω) max(0, n·ω), projected again. Its c₀ is
/// E(n) / (2√π), exactly for the L that nine coefficients describe.
/// @param normal  unit vector   @param product out; may be `radiance`
ALP_API void alp_sh_multiply_cosine(const alp_sh9 *radiance, const float normal[3],
                                    alp_sh9 *product);

// --- conventions ---------------------------------------------------------------------------------

/// Other programs' numbers for the same light. All are in our axes; docs/conventions.md has an
/// example of each.
typedef enum alp_sh_convention {
    ALP_SH_THREE = 0, ///< three.js LightProbe and LightProbeGrid: c itself
    ALP_SH_FILAMENT = 1, ///< irradiance(3, sh), sh.txt: E/π = Σ v (1, y, z, x, xy, yz, 3z² − 1, xz,
                         ///< x² − y²)
    ALP_SH_GLTF = 2,        ///< EXT_lights_image_based: A_l c, odd m negated (Condon–Shortley)
    ALP_SH_GODOT = 3,       ///< LightmapGIData: c / π
    ALP_SH_UNITY = 4,       ///< SphericalHarmonicsL2: numbers as of FILAMENT. Unity's frame is
                            ///< left-handed: mirror one axis with alp_sh_rotate first.
    ALP_SH_AMBIENT_CUBE = 5 ///< six values: E of +x, −x, +y, −y, +z, −z, clamped at 0
} alp_sh_convention;

/// Rows of a convention: 9, or 6 of the ambient cube; 0 for an unknown one.
ALP_API uint32_t alp_sh_row_count(alp_sh_convention convention);
/// Converts to a convention.
/// @param values out: [alp_sh_row_count][3]
/// @return ALP_OK; INVALID_ARGUMENT (NULL or an unknown convention; nothing is written)
ALP_API ALP_NODISCARD alp_result alp_sh_convert(const alp_sh9 *radiance,
                                                alp_sh_convention convention, float values[][3]);
/// Converts from a convention. An ambient cube gives coefficients whose E at its six directions is
/// the cube's; those of xy, yz and xz are 0.
/// @param values [alp_sh_row_count][3]   @param radiance out   @return as alp_sh_convert
ALP_API ALP_NODISCARD alp_result alp_sh_from(alp_sh_convention convention, const float *values,
                                             alp_sh9 *radiance);
/// Irradiance from an ambient cube: E = Σ n_i² C, with the value of the side that n_i points to.
/// For a directional light with E = 1 whose cube is exact, the largest error is .25 to .42.
/// @param cube [6][3]
/// Based on: J. Mitchell, G. McTaggart, C. Green. Shading in Valve's Source Engine. SIGGRAPH 2006.
ALP_API void alp_sh_ambient_cube_irradiance(const float *cube, const float normal[3],
                                            float irradiance[3]);

ALP_END_DECLS

#endif
