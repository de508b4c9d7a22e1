// SPDX-License-Identifier: MIT
// Seconds that this program spends inside Embree. The linker sends every call of ours through here
// (--wrap), so the library is measured as it is.
#ifndef BENCH_EMBREE_CLOCK_H
#define BENCH_EMBREE_CLOCK_H

#include <stdint.h>

/// Sets the calling thread's clock to 0 and lets it run; it costs two readings of the time a call.
void embree_clock_start(void);
/// @param calls out: how many there were
/// @return seconds inside Embree since the start, by the calling thread; with a reading a call
double embree_clock_stop(uint64_t *calls);
/// Seconds that one reading takes.
double embree_clock_reading(void);

#endif
