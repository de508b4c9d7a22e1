// SPDX-License-Identifier: MIT
// The very rays that our loop sends: its kernel compiled once more with a tracer that writes
// packets down. And the natural loop: eight samples of one point in a packet.
#ifndef BENCH_RECORDED_RAYS_H
#define BENCH_RECORDED_RAYS_H

#include "transport/occlusion/occlusion_kernel.h"

/// Where packets go; set `user` of one thread at a time. Packets beyond the capacity are dropped.
typedef struct ray_record {
    alpi_rays *packets;
    uint32_t count, capacity;
} ray_record;
void ray_record_use(ray_record *record);

/// Writes every packet to the record in use and reports its rays as free.
alpi_occlusion_kernel bench_recording_kernel;

/// The natural loop over the first `count` samples (at most 1024) of each receiver of a list: every
/// point of a receiver sends its directions eight at a time. Adds up the free rays of each.
typedef struct natural_loop {
    const alpi_occlusion_setup *setup;
    const alpi_receivers *receivers;
    const uint32_t *list;
    uint32_t count;
    uint32_t *open; // [receivers]
} natural_loop;
/// An alpi_task_fn over the list; `user` is a natural_loop.
alp_result natural_loop_range(void *user, uint32_t begin, uint32_t end, uint32_t worker);

#endif
