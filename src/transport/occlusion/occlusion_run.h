// SPDX-License-Identifier: MIT
// Which samples of a sequence go together. A packet holds eight samples of one receiver that leave
// in nearly the same direction, whatever its neighbours do: samples that follow each other are cut
// into eight parts, one for each lane. A part is cut into blocks, each of which leaves from a point
// of its own; a block is put in the order of its directions, along a Morton curve over the square
// that they are warped from, and blocks in the order of where their first one is on the curve.
// Of a scrambled (0,2)-sequence, a block of 2^k samples has exactly one in each of the 2^k cells
// that the curve goes through, and 2^j such blocks one in each of these cells' 2^j parts: which,
// the place of one of them tells of all, for a scrambling flips digits of all samples in a cell
// alike. So sample n of block b of every lane is in one cell of 2^(j + k). Digital shifts only
// change the cells' order: it is the same for every receiver. Where parts are no powers of two,
// packets are wider, and right all the same.
// Measured beside packets of one sample of eight neighbouring texels, which neighbours of a
// lattice, four texels apart, are too far from each other for: whole bakes of five scenes take 4 to
// 27 % less time; where all texels are traced, from 8 % less (cornell) to about a tenth more
// (teapot-room).
//
// Based on: C. Kollig, A. Keller. Efficient Multidimensional Sampling. CGF 21(3), 2002.
#ifndef ALPI_TRANSPORT_OCCLUSION_RUN_H
#define ALPI_TRANSPORT_OCCLUSION_RUN_H

#include "transport/occlusion/occlusion.h"

enum {
    ALPI_CHUNK_SAMPLES = 1024, // of which all points are placed at once
    ALPI_CHUNK_GROUPS = ALPI_CHUNK_SAMPLES / (ALPI_PACKET * ALPI_SAMPLES_PER_POINT),
    ALPI_CHUNK_PLACES = ALPI_CHUNK_GROUPS * ALPI_PACKET
};

/// Eight samples, 32-bit fractions: two for the direction, one for the distance.
typedef struct alpi_sample_packet {
    uint32_t u[ALPI_PACKET], v[ALPI_PACKET], w[ALPI_PACKET];
} alpi_sample_packet;

/// Samples that are dealt to packets together: first those that leave from the first group of
/// points, a block of each, then those of the second.
typedef struct alpi_sample_chunk {
    uint32_t first_packet, packet_count; // of the run's
    uint32_t last;                       // bit i: lane i takes part in the last packet; in all
                                         // others all do
    uint32_t block;                      // packets of a group; the last one may have fewer
    uint32_t groups;                     // of eight points
    uint32_t first_place, place_count;   // of the setup's: point p of the receiver
    uint8_t place[ALPI_CHUNK_GROUPS][ALPI_PACKET]; // of each point, counted from the first
    uint8_t quarter[ALPI_PACKET];                  // of each lane's samples
} alpi_sample_chunk;

typedef struct alpi_sample_run {
    alp_context *context;
    alpi_sample_packet *packets;
    alpi_sample_chunk *chunks;
    uint32_t chunk_count;
} alpi_sample_run;

/// Samples [first, first + count); parted and total as of alpi_occlusion_add: which quarter a
/// sample counts in.
typedef struct alpi_sample_range {
    uint32_t first, count, parted, total;
} alpi_sample_range;

/// Some samples of a setup. @param extended whether receivers have more points than one
/// @return ALP_OK; OUT_OF_MEMORY
alp_result alpi_sample_run_create(const alpi_occlusion_setup *setup, bool extended,
                                  const alpi_sample_range *range, alpi_sample_run *run);
void alpi_sample_run_destroy(alpi_sample_run *run);

#endif
