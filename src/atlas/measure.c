// SPDX-License-Identifier: MIT
// What an atlas holds: covered texels, how full its pages are, and which triangles share texels.
#include "atlas/stages.h"
#include "atlas/stretch.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <math.h>
#include <string.h>

// Texels are kept for alpi_texels_create unless the pages have more than this many: an atlas may be
// asked for only to be told that no machine holds its bake.
static const uint64_t KEEP_LIMIT = 1u << 25;

typedef struct band_overlaps {
    alpi_overlap *pairs;
    size_t count, capacity;
} band_overlaps;

typedef struct tally {
    alp_atlas *atlas;
    uint32_t first_page, end_page; // of this round
    uint32_t words;                // of 64 texels a row
    uint64_t *covered;             // [pages of the round][height][words] a bit for each texel
    uint64_t *wide, *around;       // [height][words] of one page, [words]
    uint8_t *owns;                 // [triangle_count] some texel's point lies on it
    uint64_t texels, taken;        // taken: covered, or within `padding` of a covered one
    uint64_t overlapping;
    bool keeps;
    alpi_texel_chunks chunks;
    uint32_t band_count;
    band_overlaps *overlaps; // [band_count] or NULL
} tally;

static alp_result count_band(void *user, const alpi_band *band)
{
    tally *t = user;
    const size_t height = t->atlas->info.height;
    uint64_t overlapping = 0;
    uint64_t *page = t->covered + (band->page - t->first_page) * height * t->words;
    for (uint32_t y = band->first_row; y < band->end_row; y++) {
        const uint32_t row = y - band->first_row;
        const alpi_cell *cells = band->cells + (size_t)row * band->width;
        for (uint32_t x = band->columns[row][0]; x < band->columns[row][1]; x++) {
            if (cells[x].first_piece == ALPI_NONE) {
                continue;
            }
            page[(size_t)y * t->words + x / 64] |= (uint64_t)1 << (x % 64);
            // Other bands may say the same at the same time.
            __atomic_store_n(&t->owns[cells[x].triangle], 1, __ATOMIC_RELAXED);
            overlapping += cells[x].other != ALPI_NONE;
            if (t->overlaps != NULL && cells[x].other != ALPI_NONE) {
                band_overlaps *o = &t->overlaps[band->index];
                ALP_TRY(alpi_grow(t->atlas->context, (void **)&o->pairs, &o->capacity, o->count + 1,
                                  sizeof *o->pairs));
                o->pairs[o->count++] = (alpi_overlap){cells[x].triangle, cells[x].other};
            }
        }
    }
    __atomic_fetch_add(&t->overlapping, overlapping, __ATOMIC_RELAXED);
    return t->keeps ? alpi_texel_chunk_fill(t->atlas, band, &t->chunks.chunks[band->index])
                    : ALP_OK;
}

// --- utilisation ---------------------------------------------------------------------------------

/// The bits of a row moved by `by` texels, up or down, added to `out`.
static void add_moved(const uint64_t *row, uint32_t words, uint32_t by, bool up, uint64_t *out)
{
    const uint32_t whole = by / 64, bits = by % 64;
    for (uint32_t i = 0; i + whole < words; i++) {
        const uint32_t from = up ? i : i + whole, to = up ? i + whole : i;
        out[to] |= up ? row[from] << bits : row[from] >> bits;
        if (bits != 0 && up && to + 1 < words) {
            out[to + 1] |= row[from] >> (64 - bits);
        } else if (bits != 0 && !up && to > 0) {
            out[to - 1] |= row[from] << (64 - bits);
        }
    }
}

static uint64_t count_bits(const uint64_t *words, uint32_t count)
{
    uint64_t bits = 0;
    for (uint32_t i = 0; i < count; i++) {
        bits += (uint64_t)__builtin_popcountll(words[i]);
    }
    return bits;
}

/// Widens a row by `padding` texels on both sides. What is widened by r is widened by up to r + 1
/// more in one step, also at the row's ends, where one half of it is missing.
static void widen_row(const tally *t, uint64_t *row)
{
    const uint32_t padding = t->atlas->options.padding;
    for (uint32_t reach = 0, step; reach < padding; reach += step) {
        step = reach + 1 < padding - reach ? reach + 1 : padding - reach;
        memcpy(t->around, row, t->words * sizeof *row);
        add_moved(t->around, t->words, step, true, row);
        add_moved(t->around, t->words, step, false, row);
    }
    row[t->words - 1] &= UINT64_MAX >> (t->words * 64 - t->atlas->info.width);
}

/// Counts the covered texels of a page, and those with a covered one within `padding` rows and
/// columns.
static alp_result count_page(tally *t, const uint64_t *page)
{
    const uint32_t height = t->atlas->info.height, padding = t->atlas->options.padding;
    const uint32_t words = t->words;
    memcpy(t->wide, page, (size_t)height * words * sizeof *t->wide);
    for (uint32_t y = 0; y < height; y++) {
        uint64_t *row = t->wide + (size_t)y * words;
        const uint64_t covered = count_bits(row, words);
        t->texels += covered;
        if (covered > 0) {
            widen_row(t, row);
        }
    }
    for (uint32_t y = 0; y < height; y++) {
        ALP_TRY(alpi_tick(t->atlas->context, "texels", y, height));
        const uint32_t first = y > padding ? y - padding : 0;
        memset(t->around, 0, words * sizeof *t->around);
        for (uint32_t v = first; v <= y + padding && v < height; v++) {
            for (uint32_t i = 0; i < words; i++) {
                t->around[i] |= t->wide[(size_t)v * words + i];
            }
        }
        t->taken += count_bits(t->around, words);
    }
    return ALP_OK;
}

// --- rounds --------------------------------------------------------------------------------------

static alp_result run_round(tally *t)
{
    const alp_atlas *atlas = t->atlas;
    const size_t page_words = (size_t)atlas->info.height * t->words;
    const uint32_t pages = t->end_page - t->first_page;
    memset(t->covered, 0, pages * page_words * sizeof *t->covered);
    ALP_TRY(alpi_raster(atlas, t->first_page, t->end_page, count_band, t));
    for (uint32_t p = 0; p < pages; p++) {
        ALP_TRY(count_page(t, t->covered + p * page_words));
    }
    return ALP_OK;
}

static alp_result run_rounds(tally *t, bool wants_overlaps)
{
    const alp_atlas *atlas = t->atlas;
    const uint64_t page_texels = (uint64_t)atlas->info.width * atlas->info.height;
    uint64_t round = KEEP_LIMIT / page_texels;
    round = round < 1 ? 1 : round;
    round = round > atlas->info.pages ? atlas->info.pages : round;
    t->words = (atlas->info.width + 63) / 64;
    t->keeps = page_texels * atlas->info.pages <= KEEP_LIMIT; // then there is one round
    t->band_count = (uint32_t)round * alpi_raster_bands(atlas);
    const size_t page_words = (size_t)atlas->info.height * t->words;
    ALPI_TRY_NEW(atlas->context, t->covered, (size_t)round * page_words);
    ALPI_TRY_NEW(atlas->context, t->wide, page_words);
    ALPI_TRY_NEW(atlas->context, t->around, t->words);
    ALPI_TRY_NEW(atlas->context, t->owns, atlas->scene->triangle_count);
    if (wants_overlaps) { // of one page, so of one round
        ALPI_TRY_NEW(atlas->context, t->overlaps, t->band_count);
    }
    if (t->keeps) {
        ALP_TRY(alpi_texel_chunks_create(atlas, &t->chunks));
    }
    for (uint32_t p = 0; p < atlas->info.pages; p += (uint32_t)round) {
        const uint64_t end = p + round;
        t->first_page = p;
        t->end_page = end < atlas->info.pages ? (uint32_t)end : atlas->info.pages;
        ALP_TRY(run_round(t));
    }
    return ALP_OK;
}

static alp_result keep_texels(tally *t)
{
    alp_atlas *atlas = t->atlas;
    if (!t->keeps) {
        return ALP_OK;
    }
    ALPI_TRY_NEW(atlas->context, atlas->texels, 1);
    return alpi_texels_join(atlas, &t->chunks, atlas->texels);
}

static alp_result read_tally(const tally *t)
{
    alp_atlas *atlas = t->atlas;
    alpi_stretch_facts stretch;
    ALP_TRY(alpi_stretch_measure(atlas, &stretch));
    double room = (double)atlas->info.pages * atlas->info.width * atlas->info.height;
    atlas->info.texels = t->texels;
    atlas->info.utilisation =
        (double)(atlas->info.mode == ALP_ATLAS_KEEP ? t->texels : t->taken) / room;
    atlas->info.texels_per_metre = stretch.texels_per_metre;
    atlas->info.stretch_mean = stretch.mean;
    atlas->info.stretch_worst = stretch.worst;
    atlas->info.density_spread = stretch.spread;
    atlas->info.flipped_triangles = stretch.flipped;
    atlas->info.sliver_triangles = stretch.slivers;
    atlas->info.overlapping_texels = t->overlapping;
    atlas->info.shared_triangles = 0;
    for (uint32_t i = 0; i < atlas->scene->triangle_count; i++) {
        atlas->info.shared_triangles += atlas->scene->triangle_usable[i] && t->owns[i] == 0;
    }
    return ALP_OK;
}

static alp_result join_overlaps(const tally *t, alpi_overlaps *overlaps)
{
    for (uint32_t b = 0; b < t->band_count; b++) {
        overlaps->count += (uint32_t)t->overlaps[b].count;
    }
    ALPI_TRY_NEW(t->atlas->context, overlaps->pairs, overlaps->count);
    uint32_t count = 0;
    for (uint32_t b = 0; b < t->band_count; b++) {
        for (size_t i = 0; i < t->overlaps[b].count; i++) {
            overlaps->pairs[count++] = t->overlaps[b].pairs[i];
        }
    }
    return ALP_OK;
}

alp_result alpi_measure(alp_atlas *atlas, alpi_overlaps *overlaps)
{
    tally t = {.atlas = atlas};
    alp_context *context = atlas->context;
    alp_result result = run_rounds(&t, overlaps != NULL);
    if (overlaps != NULL) {
        *overlaps = (alpi_overlaps){0};
        result = result == ALP_OK ? join_overlaps(&t, overlaps) : result;
    }
    result = result == ALP_OK ? read_tally(&t) : result;
    result = result == ALP_OK ? keep_texels(&t) : result;
    for (uint32_t b = 0; t.overlaps != NULL && b < t.band_count; b++) {
        alpi_release(context, t.overlaps[b].pairs);
    }
    alpi_release(context, t.overlaps);
    alpi_release(context, t.covered);
    alpi_release(context, t.wide);
    alpi_release(context, t.around);
    alpi_release(context, t.owns);
    alpi_texel_chunks_destroy(context, &t.chunks);
    return result;
}
