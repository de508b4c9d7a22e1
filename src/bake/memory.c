// SPDX-License-Identifier: MIT
// What a bake will need, known as soon as the atlas is: better a message now than a killed process
// after an hour.
#include "bake/layers.h"
#include "bake/light.h"

#include <math.h>
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
    LATTICE_BYTES = 14,        // of a texel's 73: gone when files are written, as are side maps
    // Of each map beside occlusion.
    SIDE_BYTES_PER_TEXEL = 12,
    // Light by direction: kept, and of direct light while that is gathered and in rounds. One map
    // at a time when it is stored.
    DIRECTIONAL_BYTES_PER_TEXEL = sizeof(alpi_directional),
    SIDE_BYTES_PER_PAGE_TEXEL = 16, // its pages are made when it is stored
    BYTES_PER_TRIANGLE = 32         // of the atlas: coordinates 24, page 4, chart 4
};

// Of light, while it is gathered and nothing of occlusion's rays is left but near 1, dropped 1 and
// order 4.
enum {
    LIGHT_BYTES_PER_TEXEL = 30, // and mean and variance 24
    // alpi_patches: stand-ins 4, reflectances 12, emissions 12, blocks 4 and their texels, ends,
    // firsts and areas 20
    PATCH_BYTES_PER_TEXEL = 52,
    CELL_BYTES = 16,   // of each side
    DIRECT_BYTES = 24, // of each side, and of one once it is solved
    BACK_BYTES = 5,    // of two-sided scenes: seen 1, a list 4
    BLOCK_BYTES = 64,  // of each side of a block: bounced 24, before 12, skies 12, lost 8, lists 8
    // alpi_bounced_map: marks 1, list 4, values 4, variances 12; and skies 12, states 1
    GATHER_BYTES_PER_TEXEL = 34,
    ROUND_BYTES_PER_TEXEL = 46,    // of later rounds: fresh 24 + 12, counts 4, list 4, marks 2
    DENOISE_BYTES_PER_TEXEL = 256, // in their place, measured
    SPACING = 4                    // texels along a block
};

/// Blocks of charts of the mean size: squares of the page that a chart has a part in. Where
/// surfaces meet they are smaller: about twice as many in all.
static double count_blocks(const alp_atlas_info *atlas)
{
    const double charts = fmax(atlas->charts, 1.0);
    const double edge = sqrt((double)atlas->texels / charts) / SPACING + 1.0;
    return fmin(2.0 * charts * edge * edge, (double)atlas->texels);
}

/// Bytes that are held while light is gathered, beside what is kept all the time.
typedef struct light_memory {
    uint64_t solve, rounds;
    uint64_t kept; // rays of blocks, while it is solved, if they are kept
} light_memory;

static light_memory find_light_memory(const alp_atlas_info *atlas, const alp_scene *scene,
                                      const alp_bake_options *options)
{
    const uint64_t texels = atlas->texels;
    light_memory m = {LIGHT_BYTES_PER_TEXEL * texels, LIGHT_BYTES_PER_TEXEL * texels, 0};
    const alp_light_options *o = &options->light;
    if (o->bounces == 0 || o->gather == ALP_GATHER_PATHS) {
        return m;
    }
    const uint64_t sides = alpi_patches_are_two_sided(scene) ? 2 : 1;
    const uint64_t blocks = (uint64_t)((double)sides * count_blocks(atlas));
    const uint64_t solution = (PATCH_BYTES_PER_TEXEL + CELL_BYTES * sides) * texels +
                              BLOCK_BYTES * blocks + (sides > 1 ? BACK_BYTES * texels : 0);
    const uint64_t later = o->denoise                       ? DENOISE_BYTES_PER_TEXEL
                           : alpi_light_has_rounds(options) ? ROUND_BYTES_PER_TEXEL
                                                            : 0;
    m.solve += solution + DIRECT_BYTES * sides * texels;
    m.rounds += solution + (DIRECT_BYTES + GATHER_BYTES_PER_TEXEL + later) * texels;
    m.kept = blocks * alpi_light_block_rays(o, texels) * sizeof(uint32_t);
    return m;
}

/// What is held for the whole of the bake.
static uint64_t find_kept(const alp_atlas_info *atlas, const alp_scene *scene, uint64_t sides)
{
    const uint64_t pages = (uint64_t)atlas->width * atlas->height * atlas->pages;
    return (BYTES_PER_TEXEL + SIDE_BYTES_PER_TEXEL * sides) * atlas->texels +
           BYTES_PER_PAGE_TEXEL * pages + BYTES_PER_TRIANGLE * (uint64_t)scene->triangle_count;
}

static uint64_t count_sides(const alp_bake_options *options)
{
    const bool apart = options->light.direct == ALP_DIRECT_APART;
    return ((options->maps & ALP_MAP_BENT) != 0 ? 1u : 0u) +
           ((options->maps & ALP_MAP_OBSCURANCE) != 0 ? 1u : 0u) +
           ((options->maps & ALP_MAP_LIGHT) != 0 ? apart ? 4u : 2u : 0u); // and its errors
}

static uint64_t count_directional(const alp_bake_options *options)
{
    return ((options->maps & ALP_MAP_SH) != 0 ? 4u : 0u) +
           ((options->maps & ALP_MAP_DIRECTION) != 0 ? 1u : 0u);
}

/// Light by direction while it is gathered: of the map, of direct light, and of later rounds.
static uint64_t find_directional(const alp_atlas_info *atlas, const alp_bake_options *options)
{
    const uint64_t arrays = alpi_light_has_rounds(options) ? 3u : 2u;
    return count_directional(options) > 0 ? arrays * DIRECTIONAL_BYTES_PER_TEXEL * atlas->texels
                                          : 0u;
}

/// Where only some surfaces are baked: the solution of the whole scene, on a page of its own.
static uint64_t find_around(const alp_atlas_info *atlas, const alp_scene *scene,
                            const alp_bake_options *options)
{
    if (options->only == NULL || (options->maps & ALP_MAP_LIGHT) == 0 ||
        options->light.gather == ALP_GATHER_PATHS || options->light.bounces == 0) {
        return 0;
    }
    alp_atlas_info around = *atlas;
    around.width = around.height = options->atlas.size;
    around.pages = 1;
    around.texels = (uint64_t)around.width * around.height;
    return find_kept(&around, scene, 0) + find_light_memory(&around, scene, options).solve;
}

/// @param rays of the blocks that are kept, or UINT64_MAX: as many as there are
static uint64_t find_memory(const alp_atlas_info *atlas, const alp_scene *scene,
                            const alp_bake_options *options, uint64_t kept_rays)
{
    const uint64_t page = (uint64_t)atlas->width * atlas->height, pages = page * atlas->pages;
    const uint64_t sides = count_sides(options);
    const uint64_t directional = count_directional(options);
    uint64_t of_texel = RAY_BYTES_PER_TEXEL;
    const bool vectors = (options->maps & (ALP_MAP_BENT | ALP_MAP_OBSCURANCE)) != 0;
    of_texel += vectors ? RAY_BYTES_OF_VECTORS : 0u;
    of_texel += options->ao_self ? OBJECT_BYTES_PER_TEXEL : 0u;
    uint64_t rays = of_texel * atlas->texels + BYTES_OF_PROBES +
                    (uint64_t)BYTES_PER_SAMPLE * options->occlusion.samples;
    if ((options->maps & ALP_MAP_LIGHT) != 0) {
        const light_memory m = find_light_memory(atlas, scene, options);
        const uint64_t solve = m.solve + (m.kept < kept_rays ? m.kept : kept_rays);
        const uint64_t gather = solve > m.rounds ? solve : m.rounds;
        rays = rays > gather ? rays : gather;
    }
    const uint64_t stored = SIDE_BYTES_PER_PAGE_TEXEL * (sides + directional) * pages;
    const uint64_t store = stored + (directional > 0 ? SIDE_BYTES_PER_TEXEL * atlas->texels : 0u) +
                           BYTES_TO_DILATE * page;
    const uint64_t write = stored + alpi_bake_light_asset_memory(atlas, scene, options);
    const uint64_t gone = (SIDE_BYTES_PER_TEXEL * sides + LATTICE_BYTES) * atlas->texels;
    uint64_t most = rays > store ? rays : store;
    most = write > most + gone ? write - gone : most;
    return find_kept(atlas, scene, sides) + find_directional(atlas, options) +
           find_around(atlas, scene, options) + most;
}

uint64_t alpi_bake_memory(const alp_atlas_info *atlas, const alp_scene *scene,
                          const alp_bake_options *options)
{
    return find_memory(atlas, scene, options, UINT64_MAX);
}

/// What is left of the limit for rays that are kept, beside all else that is held then.
static uint64_t find_kept_limit(const alpi_bake_job *job, const alp_atlas_info *atlas, double limit)
{
    if ((job->options.maps & ALP_MAP_LIGHT) == 0) {
        return 0;
    }
    const light_memory m = find_light_memory(atlas, job->scene, &job->options);
    const double held = (double)m.solve +
                        (double)find_kept(atlas, job->scene, count_sides(&job->options)) +
                        (double)find_directional(atlas, &job->options) +
                        (double)find_around(atlas, job->scene, &job->options) +
                        (double)alpi_bake_layers_memory(job, atlas);
    return limit > held ? (uint64_t)(limit - held) : 0;
}

alp_result alpi_bake_check_memory(alpi_bake_job *job, const alp_atlas_info *atlas)
{
    long pages = sysconf(_SC_PHYS_PAGES), page_size = sysconf(_SC_PAGESIZE);
    const double needed = (double)find_memory(atlas, job->scene, &job->options, 0) +
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
    job->kept_limit = find_kept_limit(job, atlas,
                                      limit > 0   ? (double)limit
                                      : pages > 0 ? 0.9 * present
                                                  : 0x1p62);
    return ALP_OK;
}
