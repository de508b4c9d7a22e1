// SPDX-License-Identifier: MIT
// What a bake will need, known as soon as the atlas is: better a message now than a killed process
// after an hour.
#include "bake/bake_memory.h"
#include "bake/files/light_units.h"
#include "bake/files/map_files.h"
#include "bake/files/pack_orm.h"
#include "bake/layers.h"
#include "bake/light/light.h"

#include "atlas/face_shapes.h"
#include "maps/radiosity/bounced_map.h"

#include <math.h>
#include <unistd.h>

enum {
    BYTES_PER_TEXEL = 60,    // alpi_texels 51 and a piece 8, state 1
    LATTICE_BYTES = 9,       // of each texel, and until maps are stored
    GRID_BYTES = 4,          // of each texel of a page, the same
    ERROR_BYTES = 4,         // of occlusion
    VECTOR_BYTES = 12,       // of each map beside occlusion and light
    BYTES_PER_TRIANGLE = 32, // of the atlas: coordinates 24, page 4, chart 4
    // While rays are sent: sums 20, marks 1, inside 2, near 1, dropped 1, order 4, list 4. The
    // packets of a worker, 25 KiB, are on its stack.
    RAY_BYTES_PER_TEXEL = 33,
    RAY_BYTES_OF_VECTORS = 12,  // of sums, if a map beside occlusion is made
    OBJECT_BYTES_PER_TEXEL = 4, // the texels dealt out to objects
    BYTES_PER_SAMPLE = 3 * 13,  // sequence 12, places 1: of the map and of two held-out estimates
    BYTES_OF_PROBES = 8192 * 44,
    PAGE_BYTES = 16,     // of each map when it is stored: float RGBA
    BYTES_TO_DILATE = 5, // of one page at a time: filled 1, queue 4
    FILE_BYTES = 8,      // of each map in a folder, about, in a page's texels
    FILE_GROWTH = 16,    // of the one that is being made, beside what its format takes
    // Of each texel that look-ups at seams read: its place 12 and its four weights 64, as lists
    // grow, samples 16, and what says how it moves 8. And of each channel that is stitched.
    SEAM_BYTES = 100,
    SEAM_BYTES_PER_CHANNEL = 41,
    SEAM_BYTES_PER_TRIANGLE = 12, // neighbours
    SEAM_PLACE_BYTES = 4,         // of each texel of a page
    // Light by direction: kept, and of direct light while that is gathered and in rounds. One map
    // at a time when it is stored.
    DIRECTIONAL_BYTES_PER_TEXEL = sizeof(alpi_directional)
};

// Of light, while it is gathered and nothing of occlusion's rays is left but near 1, dropped 1 and
// order 4. Where a bake holds the most is while it solves, or in its rounds; each lets go of what
// the other needs.
enum {
    LIGHT_BYTES_PER_TEXEL = 6,
    VALUE_BYTES = 24, // mean and variance; of direct light, of each side
    TAKEN_BYTES = 28, // means, errors, and errors of all channels
    APART_BYTES = 24, // direct and bounced light
    CELL_BYTES = 16,  // of each side
    // alpi_patches: reflectances 12, emissions 4, blocks 4 and their texels and ends 8
    PATCH_BYTES_PER_TEXEL = 28,
    PLACE_BYTES = 8,               // of each texel of a page
    LIGHT_BYTES_PER_TRIANGLE = 32, // where its points are on its page
    BACK_BYTES = 4,                // of two-sided scenes: a list, then blocks
    // Of each side of a block: bounced 24, before 12, skies 12, lost 8, lists 8.
    SIDE_BLOCK_BYTES = 64,
    BLOCK_BYTES = 13, // first texel 4, area 8, seen 1
    // Of those, what later rounds show again with better direct light: reflectances 12 and blocks
    // 4, which two-sided scenes have anyway; of each side of a block before 12, skies 12 and
    // lost 8.
    SHOWN_BYTES_PER_TEXEL = 12,
    SHOWN_BLOCK_BYTES_PER_TEXEL = 4,
    SHOWN_SIDE_BLOCK_BYTES = 32,
    GATHER_BYTES = 26, // values, states 1, marks 1
    LEVEL_BYTES = 4,   // where those of occlusion may not be written over
    SKY_BYTES = 12,    // a soft sky's part of the values, and of those of later rounds
    // Of later rounds: fresh 24, counts 4, lists 8, noisy 1, halves of samples 1, between 1;
    // rays of each 4, the worst 5.
    ROUND_BYTES = 48,
    // Texels held out, with what they found in a round; and in all rounds; and probes.
    HELD_OUT_BYTES = sizeof(alpi_held_out) +
                     (ALPI_HELD_OUT + ALPI_BOUNCED_PROBES) * sizeof(alpi_reference_value),
    BAND_BYTES_PER_TEXEL = 16,     // a list 4, pooled variances 12; both of a band alone, which has
    BAND_BYTES = 5 << 18,          // so many at most
    PASS_BYTES_PER_TEXEL = 4,      // before, and instead of rounds: the order by passes
    PASS_BYTES = 1 << 18,          // and a list
    DENOISE_BYTES_PER_TEXEL = 256, // in place of later rounds, measured
    SPACING = 4                    // texels along a block
};

/// Blocks where surfaces meet all around each chart, as those of builtin:cornell do: single texels
/// there, in proportion to the length of its edges. Measured at five sizes of page.
static uint64_t count_blocks(const alp_atlas_info *atlas)
{
    const double texels = (double)atlas->texels, charts = fmax(atlas->charts, 1.0);
    const double edges = 8.0 * sqrt(texels * charts);
    return (uint64_t)fmin(texels / (SPACING * SPACING) + edges, texels);
}

/// Blocks of charts of the mean size that are by themselves, most of them: squares of the page that
/// a chart has a part in, and as many again where something is near.
static uint64_t count_least_blocks(const alp_atlas_info *atlas)
{
    const double charts = fmax(atlas->charts, 1.0);
    const double edge = sqrt((double)atlas->texels / charts) / SPACING + 1.0;
    const double blocks = 2.0 * charts * edge * edge;
    return (uint64_t)fmin(blocks, (double)count_blocks(atlas));
}

/// Bytes that are held while light is gathered, beside what is kept all the time.
typedef struct light_memory {
    uint64_t solve, rounds;
    uint64_t kept; // rays of blocks, while it is solved, if they are kept
} light_memory;

static uint64_t larger(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

static bool has_occlusion(const alp_bake_options *options)
{
    return (options->maps & (ALP_MAP_AO | ALP_MAP_BENT | ALP_MAP_OBSCURANCE)) != 0;
}

/// Bytes of a texel in the rounds, but for what is left of the solution.
static uint64_t find_round_bytes(const alp_bake_options *options)
{
    const alp_light_options *o = &options->light;
    const bool again = alpi_light_has_rounds(options), apart = o->direct == ALP_DIRECT_APART;
    const uint64_t sky = o->lighting.sky.kind != ALP_SKY_NONE ? SKY_BYTES : 0u;
    const uint64_t levels = has_occlusion(options) ? LEVEL_BYTES : 0u;
    const uint64_t later = again ? ROUND_BYTES + sky : levels;
    return GATHER_BYTES + VALUE_BYTES + sky + // the second are those of direct light
           larger(larger(o->denoise ? DENOISE_BYTES_PER_TEXEL : 0u, later),
                  apart ? APART_BYTES : 0u);
}

/// What rays look places up in.
static uint64_t find_places(const alp_atlas_info *atlas, const alp_scene *scene)
{
    return PLACE_BYTES * (uint64_t)atlas->width * atlas->height * atlas->pages +
           LIGHT_BYTES_PER_TRIANGLE * (uint64_t)scene->triangle_count;
}

/// What stays of the solution in the rounds, but for texels' direct light and places.
static uint64_t find_settled(const alp_atlas_info *atlas, const alp_bake_options *options,
                             uint64_t sides)
{
    uint64_t of_texel = LIGHT_BYTES_PER_TEXEL + CELL_BYTES * sides;
    of_texel += sides > 1 ? BACK_BYTES : 0u;
    uint64_t of_blocks = 0;
    if (alpi_light_has_rounds(options) && options->only == NULL) {
        of_texel += SHOWN_BYTES_PER_TEXEL + (sides > 1 ? 0u : SHOWN_BLOCK_BYTES_PER_TEXEL);
        of_blocks = SHOWN_SIDE_BLOCK_BYTES * sides * count_blocks(atlas);
    }
    return of_texel * atlas->texels + of_blocks;
}

static light_memory find_light_memory(const alp_atlas_info *atlas, const alp_scene *scene,
                                      const alp_bake_options *options)
{
    const uint64_t texels = atlas->texels, taken = VALUE_BYTES + TAKEN_BYTES;
    light_memory m = {0, (LIGHT_BYTES_PER_TEXEL + taken) * texels, 0};
    const alp_light_options *o = &options->light;
    if (o->bounces == 0 || o->gather == ALP_GATHER_PATHS) {
        return m;
    }
    const uint64_t sides = alpi_patches_are_two_sided(scene) ? 2 : 1;
    const uint64_t blocks = count_blocks(atlas);
    const uint64_t back = sides > 1 ? BACK_BYTES : 0u;
    const uint64_t places = find_places(atlas, scene);
    const uint64_t of_texel =
        LIGHT_BYTES_PER_TEXEL + CELL_BYTES * sides + back + PATCH_BYTES_PER_TEXEL;
    const uint64_t of_blocks = (SIDE_BLOCK_BYTES * sides + BLOCK_BYTES) * blocks;
    const uint64_t solution = of_texel * texels + places + of_blocks;
    const uint64_t most = BAND_BYTES, bands = BAND_BYTES_PER_TEXEL * texels;
    const uint64_t passes =
        alpi_light_has_rounds(options) ? 0u : PASS_BYTES + PASS_BYTES_PER_TEXEL * texels;
    m.kept = (uint64_t)sqrt((double)blocks * (double)count_least_blocks(atlas)) * sides *
             alpi_light_block_rays(o, texels) * sizeof(uint32_t);
    m.solve = solution + VALUE_BYTES * sides * texels; // of direct light
    m.rounds = larger(m.rounds, find_round_bytes(options) * texels +
                                    larger(bands < most ? bands : most, passes) + HELD_OUT_BYTES +
                                    (o->layers ? solution + VALUE_BYTES * (sides - 1) * texels
                                               : places + find_settled(atlas, options, sides)));
    if (sides > 1) { // direct light of backs goes by a copy of that of fronts
        m.rounds = larger(m.rounds, m.solve + VALUE_BYTES * texels);
    }
    if (o->emitters == ALP_EMITTERS_COUNTED) { // what is added to direct light
        m.solve += VALUE_BYTES * sides * texels;
    }
    return m;
}

/// Values of maps beside occlusion and light, each until it is stored.
static uint64_t find_vectors(const alp_atlas_info *atlas, const alp_bake_options *options)
{
    return VECTOR_BYTES * atlas->texels *
           (((options->maps & ALP_MAP_BENT) != 0 ? 1u : 0u) +
            ((options->maps & ALP_MAP_OBSCURANCE) != 0 ? 1u : 0u));
}

/// What texels of a face share; of blended charts, of which only the most is known.
static uint64_t find_shapes(const alp_atlas_info *atlas, const alp_scene *scene,
                            const alp_bake_options *options)
{
    const uint64_t most = atlas->texels / ALPI_TEXELS_PER_FACE_SHAPE;
    const bool blend = options->atlas.mode == ALP_ATLAS_BLEND;
    const uint64_t faces = (blend ? 3u : 1u) * (uint64_t)scene->triangle_count;
    const uint64_t kept = faces <= most ? faces : blend ? most : 0u;
    return sizeof(alpi_face_shape) * kept;
}

/// What is held until all maps are stored.
static uint64_t find_kept(const alp_atlas_info *atlas, const alp_scene *scene,
                          const alp_bake_options *options)
{
    const uint64_t pages = (uint64_t)atlas->width * atlas->height * atlas->pages;
    return (BYTES_PER_TEXEL + LATTICE_BYTES + (has_occlusion(options) ? ERROR_BYTES : 0u)) *
               atlas->texels +
           GRID_BYTES * pages + BYTES_PER_TRIANGLE * (uint64_t)scene->triangle_count +
           find_shapes(atlas, scene, options);
}

static uint64_t count_directional(const alp_bake_options *options)
{
    return ((options->maps & ALP_MAP_SH) != 0 ? 4u : 0u) +
           ((options->maps & ALP_MAP_DIRECTION) != 0 ? 1u : 0u);
}

/// Maps of floats.
static uint64_t count_maps(const alp_bake_options *options)
{
    const bool apart = options->light.direct == ALP_DIRECT_APART;
    return (has_occlusion(options) ? 1u : 0u) + ((options->maps & ALP_MAP_BENT) != 0 ? 1u : 0u) +
           ((options->maps & ALP_MAP_OBSCURANCE) != 0 ? 1u : 0u) +
           ((options->maps & ALP_MAP_LIGHT) != 0 ? apart ? 4u : 2u : 0u) + // and its errors
           count_directional(options);
}

/// Light by direction while it is gathered: of the map, of direct light, and of later rounds.
static uint64_t find_directional(const alp_atlas_info *atlas, const alp_bake_options *options)
{
    const bool counted = options->light.emitters == ALP_EMITTERS_COUNTED;
    const uint64_t arrays = alpi_light_has_rounds(options) || counted ? 3u : 2u;
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
    return find_kept(&around, scene, options) + find_light_memory(&around, scene, options).solve;
}

/// While maps are stored, and while they are written, when the lattice is gone.
static uint64_t find_stored(const alp_atlas_info *atlas, const alp_scene *scene,
                            const alp_bake_options *options)
{
    const uint64_t page = (uint64_t)atlas->width * atlas->height, pages = page * atlas->pages;
    const uint64_t maps = count_maps(options), kept = find_kept(atlas, scene, options);
    const bool directional = count_directional(options) > 0;
    const uint64_t stored = PAGE_BYTES * maps * pages + BYTES_TO_DILATE * page +
                            (directional ? VECTOR_BYTES * atlas->texels : 0u) +
                            find_directional(atlas, options);
    const uint64_t files = options->maps_folder != NULL ? FILE_BYTES * maps * pages : 0u;
    const uint64_t file =
        files > 0 ? FILE_GROWTH * page + alpi_bake_map_file_memory(options, page) : 0u;
    const uint64_t written = (PAGE_BYTES * maps - GRID_BYTES) * pages + files +
                             larger(file, alpi_bake_light_asset_memory(atlas, scene, options));
    return kept + larger(stored, written - LATTICE_BYTES * atlas->texels);
}

/// Texels that look-ups at seams read: at most about so many on the built-in scenes at 512², of few
/// charts as of 700.
static uint64_t count_seam_texels(const alp_atlas_info *atlas)
{
    const double texels = (double)atlas->texels, charts = fmax(atlas->charts, 1.0);
    return (uint64_t)fmin(16.0 * sqrt(texels) + sqrt(texels * charts), texels);
}

/// While seams are looked for and stitched, when all maps are stored and the lattice is gone.
static uint64_t find_seams(const alp_atlas_info *atlas, const alp_scene *scene,
                           const alp_bake_options *options)
{
    const uint64_t pages = (uint64_t)atlas->width * atlas->height * atlas->pages;
    const uint64_t channels = !options->stitch                               ? 0u
                              : (options->maps & ~(uint32_t)ALP_MAP_AO) != 0 ? 3u
                                                                             : 1u;
    return find_kept(atlas, scene, options) - LATTICE_BYTES * atlas->texels - GRID_BYTES * pages +
           PAGE_BYTES * count_maps(options) * pages + SEAM_PLACE_BYTES * pages +
           SEAM_BYTES_PER_TRIANGLE * (uint64_t)scene->triangle_count +
           (SEAM_BYTES + SEAM_BYTES_PER_CHANNEL * channels) * count_seam_texels(atlas);
}

/// @param rays of the blocks that are kept, or UINT64_MAX: as many as there are
static uint64_t find_memory(const alp_atlas_info *atlas, const alp_scene *scene,
                            const alp_bake_options *options, uint64_t kept_rays)
{
    uint64_t of_texel = RAY_BYTES_PER_TEXEL;
    const bool vectors = (options->maps & (ALP_MAP_BENT | ALP_MAP_OBSCURANCE)) != 0;
    of_texel += vectors ? RAY_BYTES_OF_VECTORS : 0u;
    of_texel += options->ao_self ? OBJECT_BYTES_PER_TEXEL : 0u;
    uint64_t most =
        of_texel * atlas->texels + BYTES_OF_PROBES +
        (has_occlusion(options) ? (uint64_t)BYTES_PER_SAMPLE * options->occlusion.samples : 0);
    if ((options->maps & ALP_MAP_LIGHT) != 0) {
        const light_memory m = find_light_memory(atlas, scene, options);
        const uint64_t solve = m.solve + (m.kept < kept_rays ? m.kept : kept_rays);
        most = larger(most, larger(solve, m.rounds));
    }
    return larger(find_kept(atlas, scene, options) + find_vectors(atlas, options) +
                      find_directional(atlas, options) + find_around(atlas, scene, options) + most,
                  larger(find_stored(atlas, scene, options), find_seams(atlas, scene, options)));
}

uint64_t alpi_bake_memory(const alp_atlas_info *atlas, const alp_scene *scene,
                          const alp_bake_options *options)
{
    return find_memory(atlas, scene, options, UINT64_MAX);
}

/// What is left of the limit for rays that are kept, beside all else that is held then.
/// @param limit  what all of it may take, but for pieces of texels
static uint64_t find_kept_limit(const alpi_bake_job *job, const alp_atlas_info *atlas, double limit)
{
    if ((job->options.maps & ALP_MAP_LIGHT) == 0) {
        return 0;
    }
    const light_memory m = find_light_memory(atlas, job->scene, &job->options);
    const bool layers = job->options.light.layers; // they keep rays in the rounds too
    const double held = (double)(layers ? larger(m.solve, m.rounds) : m.solve) +
                        (double)find_kept(atlas, job->scene, &job->options) +
                        (double)find_vectors(atlas, &job->options) +
                        (double)find_directional(atlas, &job->options) +
                        (double)find_around(atlas, job->scene, &job->options) +
                        (double)alpi_bake_layers_memory(job, atlas);
    return limit > held ? (uint64_t)(limit - held) : 0;
}

/// As few digits as a message wants, and not too little.
static double round_up(double number)
{
    const double unit = pow(10.0, floor(log10(number)) - 2.0);
    return ceil(number / unit) * unit;
}

alp_result alpi_bake_check_memory(alpi_bake_job *job, const alp_atlas_info *atlas,
                                  uint64_t more_pieces)
{
    enum { PIECE_BYTES = 8 };
    const double pieces = (double)PIECE_BYTES * (double)more_pieces;
    long pages = sysconf(_SC_PHYS_PAGES), page_size = sysconf(_SC_PAGESIZE);
    const double needed = (double)find_memory(atlas, job->scene, &job->options, 0) + pieces +
                          (double)alpi_bake_packing_memory(job) +
                          (double)alpi_bake_layers_memory(job, atlas);
    double present = (double)pages * (double)page_size;
    const uint64_t limit = job->options.sampling.memory_limit;
    if (limit > 0 && needed > (double)limit) {
        return alpi_fail(job->context, ALP_ERROR_LIMIT,
                         "%s: %llu texels need %.3g MiB, the limit is %.3g MiB; use a smaller size "
                         "or fewer texels per metre, or allow more",
                         job->scene->name, (unsigned long long)atlas->texels,
                         round_up(needed / 0x1p20), (double)limit / 0x1p20);
    }
    if (pages > 0 && page_size > 0 && needed > 0.9 * present) {
        return alpi_fail(job->context, ALP_ERROR_LIMIT,
                         "%s: %llu texels need %.1f GiB of the machine's %.1f GiB; use a smaller "
                         "size or fewer texels per metre",
                         job->scene->name, (unsigned long long)atlas->texels, needed / 0x1p30,
                         present / 0x1p30);
    }
    const double most = limit > 0 ? (double)limit : pages > 0 ? 0.9 * present : 0x1p62;
    job->kept_limit = find_kept_limit(job, atlas, most - pieces);
    return ALP_OK;
}
