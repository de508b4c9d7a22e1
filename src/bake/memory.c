// SPDX-License-Identifier: MIT
// What a bake will need, known as soon as the atlas is: better a message now than a killed process
// after an hour.
#include "bake/job.h"

#include <unistd.h>

enum {
    // alpi_texels 49, a piece 8, lattice 9, error 4, state 1, sums 20, lists 5
    BYTES_PER_TEXEL = 96,
    BYTES_PER_PAGE_TEXEL = 20,      // of every page: float RGBA, grid 4
    BYTES_PER_BENT_TEXEL = 24,      // sum 12, normal 12
    BYTES_PER_SIDE_PAGE_TEXEL = 16, // float RGBA of one more map
    BYTES_PER_OBSCURANCE_TEXEL = 12,
    BYTES_TO_DILATE = 5 // of one page at a time: filled 1, queue 4
};

uint64_t alpi_bake_memory(const alp_atlas_info *atlas, unsigned maps)
{
    uint64_t page = (uint64_t)atlas->width * atlas->height;
    uint64_t of_texel = BYTES_PER_TEXEL, of_pages = BYTES_PER_PAGE_TEXEL;
    if ((maps & ALP_MAP_BENT) != 0) {
        of_texel += BYTES_PER_BENT_TEXEL;
        of_pages += BYTES_PER_SIDE_PAGE_TEXEL;
    }
    if ((maps & ALP_MAP_OBSCURANCE) != 0) { // its sums come after those of occlusion
        of_texel += BYTES_PER_OBSCURANCE_TEXEL;
        of_pages += BYTES_PER_SIDE_PAGE_TEXEL;
    }
    return of_texel * atlas->texels + of_pages * page * atlas->pages + BYTES_TO_DILATE * page;
}

alp_result alpi_bake_check_memory(const alpi_bake_job *job, const alp_atlas_info *atlas)
{
    long pages = sysconf(_SC_PHYS_PAGES), page_size = sysconf(_SC_PAGESIZE);
    double needed = (double)alpi_bake_memory(atlas, job->options.maps);
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
