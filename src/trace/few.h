// SPDX-License-Identifier: MIT
// Rays against few triangles: every packet meets all that it may reach. Where these are a dozen or
// two, looking for them in a hierarchy takes longer than meeting them.
#ifndef ALPI_TRACE_FEW_H
#define ALPI_TRACE_FEW_H

#include "trace/trace.h"

enum {
    ALPI_FEW_LIMIT = 64, // triangles at most
    // Measured in rooms of 12 to 60 triangles, for the two ways to be even: rays that are asked
    // whether they are blocked may come near 20 of them, and where they are asked where there may
    // be 50.
    ALPI_FEW_NEAR = 16,
    ALPI_FEW_NEAREST = 48
};

struct alpi_few;

/// The loops, compiled for any machine and for x86-64-v3. No fused operations in either: the same
/// bits.
typedef struct alpi_few_loops {
    /// As alpi_trace_occluded. @param lanes all ones for those that take part, 0 for the others
    void (*occluded)(const struct alpi_few *few, alpi_rays *packets, uint32_t count,
                     const uint32_t lanes[ALPI_PACKET], bool one_sided);
    /// As alpi_trace_nearest.
    void (*nearest)(const struct alpi_few *few, const alpi_rays *rays, uint32_t active,
                    bool one_sided, alpi_hits *hits);
} alpi_few_loops;

extern const alpi_few_loops alpi_few_loops_baseline, alpi_few_loops_v3;

/// Triangles as the loops want them. All of them are solid.
typedef struct alpi_few {
    const alpi_few_loops *loops; // those for this machine
    uint32_t count;
    float slack;  // metres, added to a ray's reach: far more than rounding may add to it
    float extent; // metres: the longest side of the box about all
    float corner[ALPI_FEW_LIMIT][3][3]; // a, b, c
    float normal[ALPI_FEW_LIMIT][3];    // (b − a) × (c − a)
    uint32_t triangle[ALPI_FEW_LIMIT];  // of the scene
    bool single_sided[ALPI_FEW_LIMIT];
    float low[3][ALPI_FEW_LIMIT]; // bounding boxes; past the last triangle: empty ones
    float high[3][ALPI_FEW_LIMIT];
} alpi_few;

/// @param triangles [count] of the scene, usable and solid
/// @param few       out: to be released by its owner; NULL where they are too many, none, or of too
///                  different sizes
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_few_create(const alp_scene *scene, const uint32_t *triangles, uint32_t count,
                           alpi_few **few);

/// Boxes of triangles within `reach` of a point of them, in the mean over their area.
float alpi_few_near(const alpi_few *few, float reach);

#endif
