// SPDX-License-Identifier: MIT
// Seams of a lightmap: places where two look-ups of one point of a surface read different texels,
// and how far apart what they read is.
#ifndef ALPI_MAPS_SEAMS_H
#define ALPI_MAPS_SEAMS_H

#include "maps/lightmap.h"
#include "trace/trace.h"

/// Samples along all seams, two or more to a texel of the finer side. What the two sides of sample
/// s read differs by Σ weights[i] · texels[i] over i in [first[s], first[s + 1]).
typedef struct alpi_seams {
    alp_context *context;
    uint32_t count;   // pairs of edges of triangles
    uint32_t blocked; // samples that something stands on, which are none of those below
    double length;    // metres
    uint32_t sample_count;
    float *lengths;           // [samples] metres that each stands for
    float *spans;             // [samples] the same in texels of the finer side, ½ at most
    uint32_t *pairs;          // [samples] the pair of edges; neighbours along it follow each other
    uint32_t (*triangles)[2]; // [samples] of the two sides
    uint32_t *first;          // [samples + 1]
    uint32_t *texels;         // [first[samples]] places in `pixels`
    float *weights;           // [first[samples]] of one side, less those of the other
    uint32_t pixel_count;
    size_t *pixels;   // [pixel_count] (page · height + y) · width + x: in any footprint
    uint32_t *owners; // [pixel_count] the covered texel of known value; ALPI_NONE: a gap's
} alpi_seams;

/// Finds the seams of a lightmap with an atlas: of meshes and between objects that touch, see
/// seam_edges.h. There is none where the shading normals of the two sides are more than 3° apart,
/// where something stands between the sides (seam_sight.h), or where a side reads hidden texels
/// alone.
/// @param tracer NULL: nothing stands between sides
/// @return ALP_OK; OUT_OF_MEMORY; LIMIT (2^32 texels of footprints); CANCELLED by who watches
alp_result alpi_seams_create(const alp_lightmap *lightmap, const alpi_tracer *tracer,
                             alpi_seams *seams);
void alpi_seams_destroy(alpi_seams *seams);

/// |difference| over the seams, each sample counting by its length; of colours the mean of the
/// channels. Absolute, 0 without seams.
typedef struct alpi_seam_step {
    double mean, p99;
} alpi_seam_step;
/// @param pages [page_count] of the lightmap's size
alp_result alpi_seams_measure(const alp_lightmap *lightmap, const alpi_seams *seams,
                              float *const *pages, alpi_seam_step *error);

/// What the sides of a sample read differs by, in each channel.
void alpi_seams_difference(const alp_lightmap *lightmap, const alpi_seams *seams, uint32_t sample,
                           float *const *pages, double difference[3]);

/// Mean of a map over the surface, of channels together; texels of unknown value do not count.
double alpi_seams_map_mean(const alp_lightmap *lightmap, float *const *pages);

#endif
