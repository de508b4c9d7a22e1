// SPDX-License-Identifier: MIT
// Constants that C and shaders share. This file is valid C, C++, GLSL and HLSL: comments and
// macros of plain numbers. A number is a double in C and a float in a shader.
#ifndef ALPENGLOW_SHARED_CONSTANTS_H
#define ALPENGLOW_SHARED_CONSTANTS_H

// Real spherical harmonics, index l(l+1)+m, without the Condon-Shortley sign.
#define ALP_SH_Y0 0.28209479177387814  // 1
#define ALP_SH_Y1 0.48860251190291992  // y, z, x
#define ALP_SH_Y2 1.09254843059207907  // xy, yz, xz
#define ALP_SH_Y20 0.31539156525252000 // 3zz - 1
#define ALP_SH_Y22 0.54627421529603953 // xx - yy

// Irradiance from radiance, band by band: E = sum A_l c_lm Y_lm(n).
#define ALP_SH_A0 3.14159265358979324 // pi
#define ALP_SH_A1 2.09439510239319549 // 2 pi / 3
#define ALP_SH_A2 0.78539816339744831 // pi / 4

// The same products as R. Ramamoorthi and P. Hanrahan name them (SIGGRAPH 2001):
// E = c1 L22 (xx - yy) + c3 L20 zz + c4 L00 - c5 L20 + 2 c1 (L2-2 xy + L21 xz + L2-1 yz)
//     + 2 c2 (L11 x + L1-1 y + L10 z)
#define ALP_SH_C1 0.42904276540489171
#define ALP_SH_C2 0.51166335397324434
#define ALP_SH_C3 0.74312386830112709
#define ALP_SH_C4 0.88622692545275801
#define ALP_SH_C5 0.24770795610037571

// Light propagation volumes. Intensity of a cell: I(w) = p0 + p.w, two bands of spherical harmonics
// with their constants folded in. A cosine lobe of flux F about n is F/pi (1/4 + 1/2 n.w).
// Solid angles [sr] of the faces of the next cell, from the centre of a cell: the far face, and
// each of four side faces. far + 4 side = 2 pi / 3, so that 6 neighbours have 4 pi.
#define ALP_LPV_FAR 0.40066968464623920
#define ALP_LPV_SIDE 0.42343135443673900
// Direction to the middle of a side face: 2/sqrt(5) along the way to the cell, 1/sqrt(5) aside.
#define ALP_LPV_ALONG 0.89442719099991588
#define ALP_LPV_ASIDE 0.44721359549995794
// Mean direction over the far face, and over a side face along the way and aside: the integral of
// direction over solid angle, divided by it. The sum over the four edges of half the angle that
// each subtends, times the normal of its plane through the centre. The far face has 2 acos(9/11) /
// sqrt(10) / far.
#define ALP_LPV_MEAN_FAR 0.96691526157815616
#define ALP_LPV_MEAN_ALONG 0.79908222172069535
#define ALP_LPV_MEAN_ASIDE 0.51808428587159652
// An even field of radiance L in cells of side s has the sum of intensities 1.5 L s^2.
#define ALP_LPV_GAIN 1.5
// A covered face stops light by the cosine of its angle, so light at a slant gets through in part.
// Opacity is multiplied by this. A wall of one cell lets 3.2 % through with 1 and .0 % with 1.6, at
// .4 rad to the axes 9.0 % and 1.2 %, at .79 rad 15.9 % and 3.9 %.
#define ALP_LPV_OPACITY 1.6
// A virtual light lies half a cell above its surface. Surfaces often lie between two cells, and
// there rounding would choose: a thousandth more makes the choice.
#define ALP_LPV_ABOVE 0.5
#define ALP_LPV_BEYOND 0.001
// A surface is read half a cell above it, for its own cell's half may lie in the wall.
#define ALP_LPV_LIFT 0.5
// Share of half a grid by which its centre lies ahead of the eye.
#define ALP_LPV_AHEAD 0.5
// Shares of half a grid over which it gives way to the next one, of light that is injected and
// read. A finer grid lacks the light from beyond it, and a slow change while the eye moves is not
// seen.
#define ALP_LPV_INJECTION_BORDER 0.15
#define ALP_LPV_READING_BORDER 0.8

// Diffuse albedo: its limit, so that light in closed rooms dies out, and that of a surface without
// a material.
#define ALP_ALBEDO_LIMIT 0.95
#define ALP_ALBEDO_WITHOUT_MATERIAL 0.5

// Texels along a side of the ground map, an ambient model (alpenglow/field.h).
#define ALP_GROUND_MAP_SIDE 64

// Film (alpenglow/film.h). Light above the brightest is cut off before a tone curve. REINHARD and
// FILMIC have these white points where none is given. The background is a byte, encoded as sRGB.
#define ALP_TONE_BRIGHTEST 1e30
#define ALP_REINHARD_WHITE 4.0
#define ALP_FILMIC_WHITE 5.6
#define ALP_FILM_BACKGROUND 96.0
// FILMIC: with x = gain L, x ((F - E) A x + B (C F - E)) / (F (x (A x + B) + D F)).
#define ALP_FILMIC_GAIN 2.0
#define ALP_FILMIC_A 0.15
#define ALP_FILMIC_B 0.50
#define ALP_FILMIC_C 0.10
#define ALP_FILMIC_D 0.20
#define ALP_FILMIC_E 0.02
#define ALP_FILMIC_F 0.30

#endif
