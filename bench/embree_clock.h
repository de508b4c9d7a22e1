// SPDX-License-Identifier: MIT
// Seconds that this program spends inside Embree, and what it asks there. The linker sends every
// call of ours through here (--wrap), so the library is measured as it is.
#ifndef BENCH_EMBREE_CLOCK_H
#define BENCH_EMBREE_CLOCK_H

#include "trace/trace.h"

/// Sets the calling thread's clock to 0 and lets it run; it costs two readings of the time a call.
void embree_clock_start(void);
/// @param calls out: how many there were
/// @return seconds inside Embree since the start, by the calling thread; with a reading a call
double embree_clock_stop(uint64_t *calls);
/// Seconds that one reading takes.
double embree_clock_reading(void);

typedef enum embree_call_kind { EMBREE_NEAREST, EMBREE_OCCLUDED, EMBREE_STREAM } embree_call_kind;
/// A packet as a call got it; that of a stream with those of its call behind it.
typedef struct embree_packet {
    alpi_rays rays;
    _Alignas(32) int valid[ALPI_PACKET];
    embree_call_kind kind;
    uint32_t count; // of the call's packets; 0: behind the first
    bool coherent;
} embree_packet;

/// Every so many blocks of 64 calls are kept whole, as long as there is room.
enum { EMBREE_RECORD_BLOCK = 64 };
typedef struct embree_record {
    embree_packet *packets; // [capacity]
    uint32_t count, capacity, every;
    uint64_t calls, seen; // calls, and packets of all of them
} embree_record;
/// From now on calls are recorded there; NULL: no more. While one thread alone calls.
void embree_record_to(embree_record *record);

#endif
