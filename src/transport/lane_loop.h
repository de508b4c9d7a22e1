// SPDX-License-Identifier: MIT
// The loop over the eight lanes of a packet, and random numbers in it. A kernel's inner loops are
// all of this form: the compiler turns each into a few vector instructions (gcc -fopt-info-vec
// lists them).
#ifndef ALPI_TRANSPORT_LANE_LOOP_H
#define ALPI_TRANSPORT_LANE_LOOP_H

#include "trace/trace.h"

// gcc must not unroll the loop first: a loop of eight would no longer be seen as one.
#ifdef __clang__ // vectorises it unasked, and warns about the request in a build without
                 // optimisation
#define ALPI_EACH_LANE for (int i = 0; i < ALPI_PACKET; i++)
#else
#define ALPI_EACH_LANE                                                                             \
    _Pragma("GCC ivdep") _Pragma("GCC unroll 1") for (int i = 0; i < ALPI_PACKET; i++)
#endif

/// A number in [0, 1) from the upper 24 bits: exact.
static inline float alpi_lane_unit(uint32_t bits)
{
    return (float)(int32_t)(bits >> 8) * 0x1p-24f;
}

#endif
