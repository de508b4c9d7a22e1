// SPDX-License-Identifier: MIT
// The occlusion kernel with a pen in the place of the tracer.
#include "recorded_rays.h"

#include <string.h>

static ray_record *record_in_use;

void ray_record_use(ray_record *record)
{
    record_in_use = record;
}

static void write_down(const alpi_tracer *tracer, const alpi_rays *packets, uint32_t count,
                       uint32_t active, alpi_trace_filter filter, alpi_rays_spread spread)
{
    (void)tracer;
    (void)active;
    (void)filter;
    (void)spread;
    ray_record *r = record_in_use;
    const uint32_t room = r->capacity - r->count;
    const uint32_t kept = count < room ? count : room;
    memcpy(r->packets + r->count, packets, kept * sizeof *packets);
    r->count += kept;
}

/// Packets are written down one by one, whatever the tracer takes.
static bool takes_pairs(const alpi_tracer *tracer)
{
    (void)tracer;
    return false;
}

#define alpi_trace_occluded write_down
#define alpi_tracer_takes_pairs takes_pairs
#define ALPI_VARIANT(name) bench_recording_kernel
#include "transport/occlusion/occlusion_kernel_body.h"
