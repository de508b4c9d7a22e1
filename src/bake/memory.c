// SPDX-License-Identifier: MIT
// What a bake will need, known as soon as the atlas is: better a message now than a killed process
// after an hour.
#include "bake/layers.h"

#include <unistd.h>

enum {
    // alpi_texels 51 and a piece 8, lattice 9, error 4, state 1
    BYTES_PER_TEXEL = 73,
    // While rays are sent: sums 20, marks 1, inside 2, near 1, dropped 1, order 4, list 4. The
    // packets of a worker, 25 KiB, are on its stack.
    RAY_BYTES_PER_TEXEL = 33,
    RAY_BYTES_OF_VECTORS = 12,  // of sums, if a map beside occlusion is made
    OBJECT_BYTES_PER_TEXEL = 4, // the texels dealt out to objects
    BYTES_PER_SAMPLE = 3 * 13,  // sequence 12, places 1: of the map and of two held-out estimates
    BYTES_OF_PROBES = 8192 * 44,
    BYTES_PER_PAGE_TEXEL = 20, // of every page: float RGBA, grid 4
    BYTES_TO_DILATE = 5,       // of one page at a time: filled 1, queue 4
    // Of each map beside occlusion.
    SIDE_BYTES_PER_TEXEL = 12,
    LIGHT_BYTES_PER_TEXEL = 28, // while paths are traced: mean and variance, and an error
    // Light by direction: kept, and of direct light while that is gathered and in rounds. One map
    // at a time when it is stored.
    DIRECTIONAL_BYTES_PER_TEXEL = sizeof(alpi_directional),
    SIDE_BYTES_PER_PAGE_TEXEL = 16 // its pages are made when it is stored
};

uint64_t alpi_bake_memory(const alp_atlas_info *atlas, const alp_bake_options *options)
{
    const uint64_t page = (uint64_t)atlas->width * atlas->height, pages = page * atlas->pages;
    const uint64_t sides = ((options->maps & ALP_MAP_BENT) != 0 ? 1u : 0u) +
                           ((options->maps & ALP_MAP_OBSCURANCE) != 0 ? 1u : 0u) +
                           ((options->maps & ALP_MAP_LIGHT) != 0 ? 2u : 0u); // and its errors
    const uint64_t directional = ((options->maps & ALP_MAP_SH) != 0 ? 4u : 0u) +
                                 ((options->maps & ALP_MAP_DIRECTION) != 0 ? 1u : 0u);
    uint64_t kept = (BYTES_PER_TEXEL + SIDE_BYTES_PER_TEXEL * sides) * atlas->texels;
    kept += directional > 0 ? DIRECTIONAL_BYTES_PER_TEXEL * atlas->texels : 0u;
    uint64_t of_texel = RAY_BYTES_PER_TEXEL;
    of_texel += (options->maps & ALP_MAP_LIGHT) != 0 ? LIGHT_BYTES_PER_TEXEL : 0u;
    const bool vectors = (options->maps & (ALP_MAP_BENT | ALP_MAP_OBSCURANCE)) != 0;
    of_texel += vectors ? RAY_BYTES_OF_VECTORS : 0u;
    of_texel += directional > 0 ? (options->light.error > 0.0f ? 2u : 1u) *
                                      (uint64_t)DIRECTIONAL_BYTES_PER_TEXEL
                                : 0u;
    of_texel += options->ao_self ? OBJECT_BYTES_PER_TEXEL : 0u;
    const uint64_t rays = of_texel * atlas->texels + BYTES_OF_PROBES +
                          (uint64_t)BYTES_PER_SAMPLE * options->occlusion.samples;
    const uint64_t store = SIDE_BYTES_PER_PAGE_TEXEL * (sides + directional) * pages +
                           (directional > 0 ? SIDE_BYTES_PER_TEXEL * atlas->texels : 0u) +
                           BYTES_TO_DILATE * page;
    const uint64_t light = alpi_bake_light_asset_memory(atlas, options);
    const uint64_t most = rays > store ? rays : store;
    return kept + (most > store + light ? most : store + light) + BYTES_PER_PAGE_TEXEL * pages;
}

alp_result alpi_bake_check_memory(const alpi_bake_job *job, const alp_atlas_info *atlas)
{
    long pages = sysconf(_SC_PHYS_PAGES), page_size = sysconf(_SC_PAGESIZE);
    const double needed = (double)alpi_bake_memory(atlas, &job->options) +
                          (double)alpi_bake_packing_memory(job) +
                          (double)alpi_bake_layers_memory(job, atlas);
    double present = (double)pages * (double)page_size;
    const uint64_t limit = job->options.sampling.memory_limit;
    if (limit > 0 && needed > (double)limit) {
        return alpi_fail(job->context, ALP_ERROR_LIMIT,
                         "%s: %llu texels need %.3g MiB, the limit is %.3g MiB; use a smaller size "
                         "or fewer texels per metre, or allow more",
                         job->scene->name, (unsigned long long)atlas->texels, needed / 0x1p20,
                         (double)limit / 0x1p20);
    }
    if (pages > 0 && page_size > 0 && needed > 0.9 * present) {
        return alpi_fail(job->context, ALP_ERROR_LIMIT,
                         "%s: %llu texels need %.1f GiB of the machine's %.1f GiB; use a smaller "
                         "size or fewer texels per metre",
                         job->scene->name, (unsigned long long)atlas->texels, needed / 0x1p30,
                         present / 0x1p30);
    }
    return ALP_OK;
}
