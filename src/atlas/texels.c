// SPDX-License-Identifier: MIT
// The covered texels of an atlas as arrays: joined from what the bands of its pages hold.
#include "atlas/blend.h"
#include "atlas/face_shapes.h"
#include "atlas/stages.h"

#include "base/memory.h"
#include "base/tasks.h"

#include <string.h>

typedef struct join_job {
    const alp_atlas *atlas;
    alpi_texel_chunks *chunks;
    uint32_t *first_texel, *first_piece; // [chunks]
    alpi_texels *texels;
} join_job;

static alp_result allocate(alp_context *context, uint32_t pages, uint32_t pieces, alpi_texels *t)
{
    ALPI_TRY_NEW(context, t->pages, t->count);
    ALPI_TRY_NEW(context, t->pixels, t->count);
    ALPI_TRY_NEW(context, t->triangles, t->count);
    ALPI_TRY_NEW(context, t->barycentrics, t->count);
    ALPI_TRY_NEW(context, t->normals, t->count);
    ALPI_TRY_NEW(context, t->areas, t->count);
    ALPI_TRY_NEW(context, t->coverages, t->count);
    ALPI_TRY_NEW(context, t->charts, t->count);
    ALPI_TRY_NEW(context, t->flags, t->count);
    ALPI_TRY_NEW(context, t->page_first, (size_t)pages + 1);
    ALPI_TRY_NEW(context, t->piece_first, (size_t)t->count + 1);
    ALPI_TRY_NEW(context, t->piece_triangles, pieces);
    ALPI_TRY_NEW(context, t->piece_ends, pieces);
    return ALP_OK;
}

static void copy_record(const alp_atlas *atlas, const alpi_texel_record *record, uint32_t i,
                        alpi_texels *t)
{
    t->pixels[i][0] = record->x;
    t->pixels[i][1] = record->y;
    t->triangles[i] = record->triangle;
    t->charts[i] = atlas->triangle_charts[record->triangle];
    memcpy(t->barycentrics[i], record->barycentrics, sizeof record->barycentrics);
    memcpy(t->normals[i], record->normal, sizeof record->normal);
    t->areas[i] = record->area;
    t->coverages[i] = record->coverage;
}

static alp_result join_chunks(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const join_job *job = user;
    alpi_texels *t = job->texels;
    for (uint32_t c = begin; c < end; c++) {
        alpi_texel_chunk *chunk = &job->chunks->chunks[c];
        uint32_t piece = job->first_piece[c];
        for (uint32_t k = 0; k < chunk->texel_count; k++) {
            const uint32_t i = job->first_texel[c] + k;
            copy_record(job->atlas, &chunk->records[k], i, t);
            t->pages[i] = chunk->page;
            t->piece_first[i] = piece;
            piece += chunk->records[k].piece_count;
        }
        if (chunk->piece_count > 0) {
            memcpy(t->piece_triangles + job->first_piece[c], chunk->piece_triangles,
                   chunk->piece_count * sizeof *t->piece_triangles);
            memcpy(t->piece_ends + job->first_piece[c], chunk->piece_ends,
                   chunk->piece_count * sizeof *t->piece_ends);
        }
        alpi_release(job->atlas->context, chunk->records); // so that little is held twice
        alpi_release(job->atlas->context, chunk->piece_triangles);
        alpi_release(job->atlas->context, chunk->piece_ends);
        *chunk = (alpi_texel_chunk){0};
    }
    return ALP_OK;
}

static alp_result too_many(const alp_atlas *atlas)
{
    return alpi_fail(atlas->context, ALP_ERROR_LIMIT,
                     "%s: the texels or the pieces of triangles in them are more than 2^32; use "
                     "fewer texels per metre",
                     atlas->scene->name);
}

static alp_result join(join_job *job)
{
    const alp_atlas *atlas = job->atlas;
    alpi_texels *t = job->texels;
    const uint32_t chunk_count = job->chunks->count, bands = alpi_raster_bands(atlas);
    ALPI_TRY_NEW(atlas->context, job->first_texel, chunk_count);
    ALPI_TRY_NEW(atlas->context, job->first_piece, chunk_count);
    uint64_t texels = 0, pieces = 0;
    for (uint32_t c = 0; c < chunk_count; c++) {
        job->first_texel[c] = (uint32_t)texels;
        job->first_piece[c] = (uint32_t)pieces;
        texels += job->chunks->chunks[c].texel_count;
        pieces += job->chunks->chunks[c].piece_count;
    }
    if (texels >= UINT32_MAX || pieces >= UINT32_MAX) {
        return too_many(atlas);
    }
    t->count = (uint32_t)texels;
    t->atlas = atlas;
    ALP_TRY(allocate(atlas->context, atlas->info.pages, (uint32_t)pieces, t));
    for (uint32_t p = 0; p < atlas->info.pages; p++) {
        t->page_first[p] = job->first_texel[(size_t)p * bands];
    }
    t->page_first[atlas->info.pages] = t->count;
    t->piece_first[t->count] = (uint32_t)pieces;
    return alpi_parallel_for(atlas->context, chunk_count, 1, join_chunks, job, NULL);
}

alp_result alpi_texels_join(const alp_atlas *atlas, alpi_texel_chunks *chunks, alpi_texels *texels)
{
    join_job job = {.atlas = atlas, .chunks = chunks, .texels = texels};
    *texels = (alpi_texels){0};
    alp_result result = join(&job);
    alpi_release(atlas->context, job.first_texel);
    alpi_release(atlas->context, job.first_piece);
    if (result != ALP_OK) {
        alpi_texels_destroy(atlas->context, texels);
    }
    return result;
}

typedef struct fill_job {
    const alp_atlas *atlas;
    alpi_texel_chunks chunks;
} fill_job;

static alp_result fill_band(void *user, const alpi_band *band)
{
    const fill_job *job = user;
    return alpi_texel_chunk_fill(job->atlas, band, &job->chunks.chunks[band->index]);
}

/// From the faces that the raster found to their triangles.
static alp_result find_triangles(const alp_atlas *atlas, alpi_texels *texels)
{
    texels->faces = texels->triangles;
    if (atlas->face_triangles == NULL) {
        return ALP_OK;
    }
    texels->triangles = NULL;
    ALPI_TRY_NEW(atlas->context, texels->triangles, texels->count);
    ALPI_TRY_NEW(atlas->context, texels->shares, texels->count);
    for (uint32_t i = 0; i < texels->count; i++) {
        texels->triangles[i] = atlas->face_triangles[texels->faces[i]];
        texels->shares[i] = alpi_blend_share(atlas, texels->faces[i], texels->barycentrics[i]);
    }
    return ALP_OK;
}

static alp_result make_texels(const alp_atlas *atlas, alpi_texels *texels)
{
    if (atlas->texels != NULL && atlas->texels->atlas != NULL) {
        *texels = *atlas->texels;
        *atlas->texels = (alpi_texels){0}; // taken
        return ALP_OK;
    }
    fill_job job = {.atlas = atlas};
    alp_result result = alpi_texel_chunks_create(atlas, &job.chunks);
    if (result == ALP_OK) {
        result = alpi_raster(atlas, 0, atlas->info.pages, fill_band, &job);
    }
    if (result == ALP_OK) {
        result = alpi_texels_join(atlas, &job.chunks, texels);
    }
    alpi_texel_chunks_destroy(atlas->context, &job.chunks);
    return result;
}

alp_result alpi_texels_create(const alp_atlas *atlas, alpi_texels *texels)
{
    *texels = (alpi_texels){0};
    alp_result result = make_texels(atlas, texels);
    if (result == ALP_OK) {
        result = find_triangles(atlas, texels);
    }
    if (result == ALP_OK) {
        result = alpi_face_shapes_make(texels);
    }
    if (result != ALP_OK) {
        alpi_texels_destroy(atlas->context, texels);
    }
    return result;
}

void alpi_texels_destroy(alp_context *context, alpi_texels *texels)
{
    alpi_release(context, texels->pages);
    alpi_release(context, texels->pixels);
    if (texels->faces != texels->triangles) {
        alpi_release(context, texels->faces);
    }
    alpi_release(context, texels->triangles);
    alpi_release(context, texels->barycentrics);
    alpi_release(context, texels->normals);
    alpi_release(context, texels->areas);
    alpi_release(context, texels->shares);
    alpi_release(context, texels->coverages);
    alpi_release(context, texels->charts);
    alpi_release(context, texels->page_first);
    alpi_release(context, texels->flags);
    alpi_release(context, texels->valid);
    alpi_release(context, texels->piece_first);
    alpi_release(context, texels->piece_triangles);
    alpi_release(context, texels->piece_ends);
    alpi_release(context, texels->shapes);
    *texels = (alpi_texels){0};
}
