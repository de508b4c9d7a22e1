// SPDX-License-Identifier: MIT
#include "transport/occlusion/occlusion_run.h"

#include "base/memory.h"

typedef struct run_maker {
    const alpi_occlusion_setup *setup;
    bool extended;
    uint32_t parted, quarter; // the quarters' first sample and length, from `parted` on
    alpi_sample_run *run;
    uint32_t packet_count; // made
} run_maker;

/// The quarter of a sample. @param end out: the first sample after it
static uint32_t find_quarter(const run_maker *m, uint32_t sample, uint32_t *end)
{
    const bool early = sample < m->parted;
    const uint32_t first = early ? 0 : m->parted;
    const uint32_t length = early ? m->parted / ALPI_QUARTERS : m->quarter;
    const uint32_t quarter = (sample - first) / length;
    *end = first + (quarter + 1) * length;
    return quarter;
}

/// First sample of a lane's part.
static uint32_t part_of(uint32_t first, uint32_t end, uint32_t lane)
{
    return first + (uint32_t)((uint64_t)(end - first) * lane / ALPI_PACKET);
}

/// Whether each lane's part of [first, end) lies in one quarter.
static bool parts_fit(const run_maker *m, uint32_t first, uint32_t end)
{
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        const uint32_t from = part_of(first, end, i), to = part_of(first, end, i + 1);
        uint32_t quarter_end;
        (void)find_quarter(m, from, &quarter_end);
        if (to > quarter_end) {
            return false;
        }
    }
    return true;
}

/// Every second bit of the leading 16, so that two of them make a place on the Morton curve.
static uint32_t spread_leading(uint32_t fraction)
{
    uint32_t x = fraction >> 16;
    x = (x | x << 8) & 0x00ff00ffu;
    x = (x | x << 4) & 0x0f0f0f0fu;
    x = (x | x << 2) & 0x33333333u;
    return (x | x << 1) & 0x55555555u;
}

/// Items are place on the curve << 32 | number; they are few, so by insertion.
static void insert(uint64_t item, uint32_t count, uint64_t *sorted)
{
    for (; count > 0 && sorted[count - 1] > item; count--) {
        sorted[count] = sorted[count - 1];
    }
    sorted[count] = item;
}

/// Samples [first, first + count) in the order of their directions.
static void sort_block(const uint32_t (*samples)[3], uint32_t first, uint32_t count,
                       uint64_t *sorted)
{
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t *s = samples[first + k];
        const uint32_t along = spread_leading(s[0]) << 1 | spread_leading(s[1]);
        insert((uint64_t)along << 32 | (first + k), k, sorted);
    }
}

/// Puts a lane's part into packets. Where it is one shorter than others, its first sample is in the
/// last packet again, which leaves it out.
static void fill_lane(const run_maker *m, alpi_sample_chunk *chunk, uint32_t lane, uint32_t first,
                      uint32_t part)
{
    const uint32_t(*samples)[3] = (const uint32_t(*)[3])m->setup->sequence;
    const uint32_t whole = part / chunk->block; // blocks; what is left over comes last
    alpi_sample_packet *packet = m->run->packets + chunk->first_packet;
    uint64_t sorted[ALPI_CHUNK_SAMPLES / ALPI_PACKET] = {0}, order[ALPI_CHUNK_GROUPS] = {0};
    for (uint32_t b = 0; b < chunk->groups; b++) {
        const uint32_t at = b * chunk->block;
        const uint32_t count = b < whole ? chunk->block : at < part ? part - at : 0;
        sort_block(samples, first + at, count, &sorted[at]);
        insert(b < whole ? sorted[at] >> 32 << 32 | b : UINT64_MAX << 32 | b, b, order);
    }
    for (uint32_t k = 0; k < chunk->packet_count; k++, packet++) {
        const uint32_t from = (uint32_t)order[k / chunk->block] * chunk->block + k % chunk->block;
        const uint32_t *s = samples[k < part ? (uint32_t)sorted[from] : first];
        packet->u[lane] = s[0];
        packet->v[lane] = s[1];
        packet->w[lane] = s[2];
    }
    for (uint32_t g = 0; g < chunk->groups; g++) {
        const uint32_t place = lane * chunk->groups + (uint32_t)order[g];
        chunk->place[g][lane] =
            (uint8_t)(chunk->place_count < ALPI_PACKET ? lane * chunk->place_count / ALPI_PACKET
                                                       : place);
    }
}

/// Deals samples [first, end) to packets.
static void deal(run_maker *m, uint32_t first, uint32_t end, alpi_sample_chunk *chunk)
{
    const uint32_t count = (end - first + ALPI_PACKET - 1) / ALPI_PACKET;
    const uint32_t block = m->extended ? ALPI_SAMPLES_PER_POINT : ALPI_CHUNK_SAMPLES;
    const uint32_t groups = (count + block - 1) / block;
    uint32_t places = 1; // for up to eight lanes each
    while (places < ALPI_PACKET && places * block < end - first) {
        places *= 2;
    }
    *chunk =
        (alpi_sample_chunk){.first_packet = m->packet_count,
                            .packet_count = count,
                            .block = block,
                            .groups = groups,
                            .first_place = m->extended ? first / block : 0,
                            .place_count = places < ALPI_PACKET ? places : groups * ALPI_PACKET};
    for (uint32_t i = 0; i < ALPI_PACKET; i++) {
        const uint32_t from = part_of(first, end, i), part = part_of(first, end, i + 1) - from;
        uint32_t quarter_end;
        chunk->quarter[i] = (uint8_t)find_quarter(m, from, &quarter_end);
        chunk->last |= (part == count ? 1u : 0u) << i;
        fill_lane(m, chunk, i, from, part);
    }
    m->packet_count += count;
}

alp_result alpi_sample_run_create(const alpi_occlusion_setup *setup, bool extended,
                                  const alpi_sample_range *range, alpi_sample_run *run)
{
    const uint32_t first = range->first, count = range->count;
    // Chunks end where their samples do, or where a quarter does that no lane's part may leave.
    const uint32_t limit = count / ALPI_CHUNK_SAMPLES + 1 + 2 * ALPI_QUARTERS;
    run_maker m = {setup, extended, range->parted, (range->total - range->parted) / ALPI_QUARTERS,
                   run,   0};
    *run = (alpi_sample_run){.context = setup->context};
    run->packets = ALPI_NEW(setup->context, alpi_sample_packet, count / ALPI_PACKET + limit);
    run->chunks = ALPI_NEW(setup->context, alpi_sample_chunk, limit);
    if (run->packets == NULL || run->chunks == NULL) {
        alpi_sample_run_destroy(run);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t at = first; at < first + count;) {
        const uint32_t left = first + count - at;
        uint32_t end = at + (left < ALPI_CHUNK_SAMPLES ? left : ALPI_CHUNK_SAMPLES);
        if (!parts_fit(&m, at, end)) {
            uint32_t quarter_end;
            (void)find_quarter(&m, at, &quarter_end);
            end = quarter_end < end ? quarter_end : end;
        }
        deal(&m, at, end, &run->chunks[run->chunk_count++]);
        at = end;
    }
    return ALP_OK;
}

void alpi_sample_run_destroy(alpi_sample_run *run)
{
    if (run->context != NULL) {
        alpi_release(run->context, run->packets);
        alpi_release(run->context, run->chunks);
    }
    *run = (alpi_sample_run){0};
}
