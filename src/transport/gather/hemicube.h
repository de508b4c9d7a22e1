// SPDX-License-Identifier: MIT
// The hemicube: half a cube about a point, whose pixels stand for all that the point sees.
//
// Five faces at distance 1 along the normal (forward) and across it (right, up, left, down): a
// front of n × n pixels and four halves of n × n/2. A pixel's weight is its form factor, so that E
// = π Σ weight · L with one ray through the centre of each. Based on: M. F. Cohen, D. P. Greenberg.
// The Hemi-Cube: A Radiosity Solution for Complex
//           Environments. SIGGRAPH 1985.
//
// The faces lie in one picture of 2n × 2n pixels, the cross that the cube unfolds to, with the
// front in its middle as the point sees it; its corners belong to no face:
//
//              ┌──────┐
//              │  up  │
//        ┌─────┼──────┼─────┐
//        │left │front │right│
//        └─────┼──────┼─────┘
//              │ down │
//              └──────┘
#ifndef ALPI_TRANSPORT_HEMICUBE_H
#define ALPI_TRANSPORT_HEMICUBE_H

#include "transport/gather/gather.h"

/// Pixels along an edge: even, so that the halves are whole pixels. At the limit 3 million rays.
enum { ALPI_HEMICUBE_LEAST = 2, ALPI_HEMICUBE_MOST = 1024 };

/// Neighbouring pixels of one face, up to 4 × 2, whose rays are traced together.
typedef struct alpi_hemicube_packet {
    float x[ALPI_PACKET], y[ALPI_PACKET], z[ALPI_PACKET]; // unit: right, up and forward
    uint16_t column[ALPI_PACKET], row[ALPI_PACKET];       // in the cross
    uint32_t active;                                      // bit i: there is a pixel
} alpi_hemicube_packet;

/// How the cube stands: orthonormal, and right is to the right of who looks forward with up above.
typedef struct alpi_hemicube_frame {
    vec3 right, up, forward;
} alpi_hemicube_frame;

/// Aims the rays of a packet from a point. Those below the surface itself, where shading is smooth,
/// meet it from above and get its own light, as in the reference.
typedef void alpi_hemicube_aim_fn(const alpi_hemicube_packet *packet, vec3 start,
                                  const alpi_hemicube_frame *frame, alpi_rays *rays);
/// For any machine and for x86-64-v3: the same bits.
alpi_hemicube_aim_fn alpi_hemicube_aim_baseline, alpi_hemicube_aim_v3;

typedef struct alpi_hemicube {
    alp_context *context;
    alpi_hemicube_aim_fn *aim;
    uint32_t resolution; // n
    uint32_t packet_count;
    alpi_hemicube_packet *packets;
    float (*weights)[ALPI_PACKET]; // [packet_count] form factors, 0 where there is no pixel
} alpi_hemicube;                   // immutable, for all threads

/// @param resolution n, even, from LEAST to MOST
/// @return ALP_OK; INVALID_ARGUMENT (no such resolution); OUT_OF_MEMORY
/// Cost: 3 n² pixels of 20 bytes; an eighth of the weights is computed, the rest is mirrored.
alp_result alpi_hemicube_create(alp_context *context, uint32_t resolution, alpi_hemicube **cube);
void alpi_hemicube_destroy(alpi_hemicube *cube); // NULL does nothing

/// The exact form factor of a pixel of the cross, 0 in its corners. Over all pixels they make 1. No
/// cosines at the pixel's centre, whose sum is 1.00013 at n = 64: corner differences of the closed
/// forms of rectangles parallel and perpendicular to the receiver, so that light that is the same
/// over a pixel, and all light that is the same everywhere, counts exactly.
double alpi_hemicube_weight(uint32_t resolution, uint32_t column, uint32_t row);
/// Through the centre of a pixel of the cross, on its face: (±1, y, z), (x, ±1, z) or (x, y, 1).
/// @return false: a corner of the cross, which belongs to no face
bool alpi_hemicube_pixel(uint32_t resolution, uint32_t column, uint32_t row, double local[3]);

/// @param turn radians about the normal, from right towards up
alpi_hemicube_frame alpi_hemicube_frame_about(vec3 normal, float turn);
/// With +Y above as far as the normal lets it, for pictures; −Z above where it looks straight up or
/// down.
alpi_hemicube_frame alpi_hemicube_frame_upright(vec3 normal);

typedef struct alpi_hemicube_options {
    alp_context *context; // of the loop that runs, if any: it may be cancelled
    alpi_gather_scene from;
    const alpi_hemicube *cube;
    bool turned; // about the normal, by an angle of each receiver's own: what pixels are too coarse
                 // for then becomes noise in place of bands along the faces' edges
    bool scattered; // at a random point of each receiver, not at its middle: right in the mean over
                    // many large receivers
    uint64_t seed;
} alpi_hemicube_options;

/// Irradiance E [W·m⁻²] = π Σ weight · L at a point, about its shading normal.
/// @param receiver key of the turn
/// @return ALP_OK; CANCELLED
/// Cost: 3 n² rays. Bias: light with edges counts by whole pixels, so that the error is at most the
/// weights of those that the edges cross; light without edges by the values at the centres, an
/// error of order 1/n². No variance unless turned.
alp_result alpi_hemicube_gather(const alpi_hemicube_options *options,
                                const alpi_receiver_point *point, uint64_t receiver,
                                float irradiance[3]);
/// The same with a given frame of the cube, whose `forward` need not be the shading normal.
alp_result alpi_hemicube_gather_in(const alpi_hemicube_options *options,
                                   const alpi_receiver_point *point,
                                   const alpi_hemicube_frame *frame, float irradiance[3]);

/// Gathers at one point of each receiver. The options are borrowed.
alpi_gatherer alpi_hemicube_gatherer(const alpi_hemicube_options *options);

/// Radiance along the rays of one packet, before weights; for pictures.
void alpi_hemicube_trace(const alpi_hemicube_options *options, const alpi_receiver_point *point,
                         const alpi_hemicube_frame *frame, uint32_t packet,
                         vec3 radiance[ALPI_PACKET]);

#endif
