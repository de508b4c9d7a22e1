// SPDX-License-Identifier: MIT
#include "maps/radiosity/radiosity.h"

#include "base/memory.h"
#include "base/tasks.h"
#include "maps/radiosity/acceleration.h"
#include "transport/gather/kept_rays.h"

#include <math.h>
#include <string.h>

enum { TEXELS_PER_RANGE = 4096 };
// Changes of single numbers of 24 bits: what is smaller is rounding.
static const double LEAST_CHANGE = 1e-7;

typedef struct solver {
    alpi_radiosity *r;
    alpi_gather_scene from;
    alpi_receivers blocks;
    alpi_kept_rays kept;
    uint32_t *new_receivers;             // [sides × blocks]
    alpi_reference_value *layer_bounced; // [sides × blocks] with layers
    double first_light;                  // that no pass changes: W, over the receivers and channels
    double change, former;               // mean change over mean light of the last two passes
    bool mixes;                          // passes mix the light of those before
    alpi_acceleration acceleration;
    alpi_task_progress progress;
} solver;

double alpi_radiosity_tolerance(uint32_t bounces)
{
    return bounces > ALPI_RADIOSITY_PASS_LIMIT ? 5e-4 : 0.0;
}

alpi_radiosity_options alpi_radiosity_options_default(void)
{
    return (alpi_radiosity_options){.bounces = UINT32_MAX,
                                    .tolerance = alpi_radiosity_tolerance(UINT32_MAX),
                                    .blocks = {.spacing = 4},
                                    .direct_samples = 16,
                                    .kept_limit = 1ull << 30};
}

static size_t sides_of(const alpi_patches *p)
{
    return p->two_sided ? 2 : 1;
}

alpi_gather_scene alpi_radiosity_scene(const alpi_radiosity *radiosity)
{
    const alpi_radiosity_options *o = &radiosity->options;
    return (alpi_gather_scene){.scene = o->scene,
                               .tracer = o->tracer,
                               .lighting = o->lighting,
                               .filter = o->filter,
                               .light = alpi_patches_light(&radiosity->patches),
                               .sky = o->direct != o->lighting};
}

// --- direct light --------------------------------------------------------------------------------

/// @param directional [texels] out, or NULL
static alp_result gather_direct(const solver *s, const uint32_t *list, uint32_t count,
                                alpi_directional *directional)
{
    const alpi_radiosity_options *o = &s->r->options;
    alpi_direct_output output = {.values = s->r->direct, .directional = directional};
    const alp_result result =
        alpi_radiosity_direct(s->r, list, count, o->direct_samples, o->seed, &s->progress, &output);
    s->r->rays += output.rays;
    s->r->direct_draw = output.draw;
    return result;
}

/// Direct light on the backs of some blocks, the listed receivers.
static alp_result light_backs(const solver *s, const uint32_t *blocks, uint32_t count)
{
    const alpi_patches *p = &s->r->patches;
    uint32_t *list = ALPI_NEW(p->context, uint32_t, p->texels->count);
    uint32_t texels = 0;
    if (list == NULL) {
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t b = blocks[i] - p->block_count;
        for (uint32_t k = p->block_first[b]; k < p->block_first[b + 1]; k++) {
            list[texels++] = p->texels->count + p->block_texels[k];
        }
    }
    const alp_result result = gather_direct(s, list, texels, NULL);
    alpi_release(p->context, list);
    return result;
}

// --- rays ----------------------------------------------------------------------------------------

static alpi_gather_job job_of(const solver *s, const uint32_t *list, uint32_t count)
{
    return (alpi_gather_job){.context = s->r->options.context,
                             .from = &s->from,
                             .gatherer = s->r->options.gatherer,
                             .receivers = &s->blocks,
                             .list = list,
                             .count = count,
                             .values = s->r->bounced,
                             .skies = s->r->skies,
                             .lost = s->r->lost};
}

/// The first look around of the listed receivers: what the sky brings, which backs are seen, what
/// lies in solids, and the rays themselves where they are kept.
static alp_result look_around(solver *s, const uint32_t *list, uint32_t count)
{
    const alpi_gather_job job = job_of(s, list, count);
    const alpi_patches *p = &s->r->patches;
    if (!s->r->kept && !p->two_sided && !s->from.sky && p->texels->valid == NULL) {
        return ALP_OK;
    }
    s->r->rays += (uint64_t)count * job.gatherer->packet_count * ALPI_PACKET;
    return s->r->kept ? alpi_kept_rays_trace(&job, &s->progress, &s->kept)
                      : alpi_gather_irradiance(&job, &s->progress);
}

/// Calls all backs of double-sided materials seen.
static void see_backs(const solver *s)
{
    const alpi_patches *p = &s->r->patches;
    for (uint32_t b = 0; b < p->block_count && p->two_sided; b++) {
        for (uint32_t k = p->block_first[b]; k < p->block_first[b + 1]; k++) {
            const uint32_t triangle = p->texels->triangles[p->block_texels[k]];
            if (alpi_surface_is_double_sided(p->scene, triangle)) {
                p->seen_backs[b] = ALPI_BACK_SEEN;
            }
        }
    }
}

/// Calls the backs of double-sided emitters seen: the energy that leaves them is counted by their
/// rays.
static void see_shining_backs(const solver *s)
{
    const alpi_patches *p = &s->r->patches;
    for (uint32_t b = 0; b < p->block_count && p->two_sided; b++) {
        for (uint32_t k = p->block_first[b]; k < p->block_first[b + 1]; k++) {
            const uint32_t t = p->block_texels[k];
            if (p->emissions[t] > 0.0f &&
                alpi_surface_is_double_sided(p->scene, p->texels->triangles[t])) {
                p->seen_backs[b] = ALPI_BACK_SEEN;
            }
        }
    }
}

/// Adds the backs that were seen since to the receivers. @return how many
static uint32_t add_seen_backs(solver *s)
{
    const alpi_patches *p = &s->r->patches;
    uint32_t count = 0;
    for (uint32_t b = 0; b < p->block_count && p->two_sided; b++) {
        if (p->seen_backs[b] == ALPI_BACK_SEEN) {
            p->seen_backs[b] = ALPI_BACK_LIT;
            s->new_receivers[count] = p->block_count + b;
            s->r->receivers[s->r->receiver_count++] = s->new_receivers[count++];
        }
    }
    return count;
}

/// Makes room for the rays of all who may gather, where they may be kept.
static alp_result reserve_rays(solver *s)
{
    alpi_radiosity *r = s->r;
    const alpi_radiosity_options *o = &r->options;
    const uint32_t room = r->patches.block_count * (uint32_t)sides_of(&r->patches);
    const uint64_t each = alpi_kept_rays_size(o->gatherer);
    r->kept = alpi_gather_meets_cells(&s->from) &&
              each * room <= alpi_kept_rays_limit(o->context, o->kept_limit);
    return r->kept ? alpi_kept_rays_reserve(o->context, o->gatherer, room, &s->kept) : ALP_OK;
}

/// Fronts gather, and shining backs.
static void start_receivers(solver *s)
{
    alpi_radiosity *r = s->r;
    const alpi_patches *p = &r->patches;
    for (uint32_t b = 0; b < p->block_count; b++) {
        r->receivers[b] = b;
    }
    r->receiver_count = p->block_count;
    see_shining_backs(s);
    if (r->options.backs) {
        see_backs(s);
    }
}

/// Finds who gathers: those who do already, and the backs that any of those who gather sees. The
/// rays of all are kept where there is room for them.
static alp_result find_receivers(solver *s)
{
    alpi_radiosity *r = s->r;
    const alpi_patches *p = &r->patches;
    ALP_TRY(reserve_rays(s));
    ALP_TRY(look_around(s, r->receivers, r->receiver_count));
    for (uint32_t count = add_seen_backs(s); count > 0; count = add_seen_backs(s)) {
        ALP_TRY(light_backs(s, s->new_receivers, count));
        ALP_TRY(look_around(s, s->new_receivers, count));
    }
    s->from.sky = false; // its light is known now
    memset(r->bounced, 0, (size_t)p->block_count * sides_of(p) * sizeof *r->bounced);
    return ALP_OK;
}

// --- passes --------------------------------------------------------------------------------------

/// Light that cells are lit by.
typedef struct shown_light {
    const alpi_radiosity *radiosity;
    uint32_t layer;                       // ALPI_NONE: all
    const alpi_reference_value *gathered; // [texels] by fronts, or NULL: as blocks did
} shown_light;

static void light_cell(const shown_light *s, uint32_t texel, alpi_side side)
{
    static const float none[3] = {0.0f, 0.0f, 0.0f};
    const alpi_radiosity *r = s->radiosity;
    const alpi_patches *p = &r->patches;
    const alpi_light_layers *layers = r->options.layers;
    const size_t back = side == ALPI_BACK ? 1 : 0;
    const size_t block = back * p->block_count + p->blocks[texel];
    const size_t place = back * p->texels->count + texel;
    const bool all = s->layer == ALPI_NONE;
    const float *bounced = all ? r->before[block] : layers->before[s->layer][block];
    const float *sky = all || s->layer == layers->sky ? r->skies[block] : none;
    const float *direct = all ? r->direct[place].mean : layers->direct[s->layer][place];
    const bool hidden = (p->texels->flags[texel] & ALPI_TEXEL_HIDDEN) != 0; // gathers nothing
    if (s->gathered != NULL && side == ALPI_FRONT && !hidden) {
        sky = none;
        bounced = s->gathered[texel].mean;
    }
    float *cell = p->cells[alpi_patches_cell(p, texel, side)];
    const float scale = (float)(1.0 / ALPI_PI) *
                        (back == 0 ? alpi_radiosity_brighter(r, texel, p->blocks[texel]) : 1.0f);
    for (int k = 0; k < 3; k++) {
        cell[k] = p->reflectances[texel][k] * scale * (direct[k] + sky[k] + bounced[k]);
    }
}

/// Radiance of all patches, by their direct light and what was gathered before. Backs that nobody
/// sees are black; they stay as they are once their direct light is forgotten.
static alp_result light_cells(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const shown_light *s = user;
    const alpi_patches *p = &s->radiosity->patches;
    for (uint32_t t = begin; t < end; t++) {
        const uint32_t block = p->blocks[t];
        if (block == ALPI_NONE) {
            continue;
        }
        light_cell(s, t, ALPI_FRONT);
        if (p->two_sided && !s->radiosity->backs_dropped && p->seen_backs[block] == ALPI_BACK_LIT) {
            light_cell(s, t, ALPI_BACK);
        }
    }
    return ALP_OK;
}

alp_result alpi_radiosity_show(const alpi_radiosity *radiosity, uint32_t layer,
                               const alpi_reference_value *gathered,
                               const alpi_task_progress *progress)
{
    shown_light shown = {radiosity, layer, gathered};
    return alpi_parallel_for(radiosity->options.context, radiosity->patches.texels->count,
                             TEXELS_PER_RANGE, light_cells, &shown, progress);
}

/// What the receivers gather of the light in the cells now.
static alp_result gather_pass(const solver *s, alpi_reference_value *values)
{
    alpi_radiosity *r = s->r;
    alpi_gather_job job = job_of(s, r->receivers, r->receiver_count);
    job.values = values;
    job.skies = NULL; // known
    if (r->kept) {
        return alpi_kept_rays_gather(&job, &s->kept, &s->progress);
    }
    r->rays += (uint64_t)job.count * job.gatherer->packet_count * ALPI_PACKET;
    return alpi_gather_irradiance(&job, &s->progress);
}

/// Takes over what was gathered.
static void keep_means(const alpi_radiosity *r, const alpi_reference_value *values,
                       float (*before)[3])
{
    for (uint32_t i = 0; i < r->receiver_count; i++) {
        memcpy(before[r->receivers[i]], values[r->receivers[i]].mean, sizeof *before);
    }
}

static double sum_of(const float v[3])
{
    return (double)v[0] + (double)v[1] + (double)v[2];
}

static uint32_t block_of(const alpi_patches *p, uint32_t receiver, size_t *back)
{
    *back = receiver >= p->block_count ? 1 : 0;
    return *back ? receiver - p->block_count : receiver;
}

/// Sums light that no pass changes, direct and the sky's: area integrals of irradiance.
static void sum_first_light(const void *user, uint32_t begin, uint32_t end,
                            double sums[ALPI_SUM_LIMIT])
{
    const alpi_radiosity *r = user;
    const alpi_patches *p = &r->patches;
    for (uint32_t i = begin; i < end; i++) {
        size_t back;
        const uint32_t b = block_of(p, r->receivers[i], &back);
        sums[0] += p->block_areas[b] * sum_of(r->skies[r->receivers[i]]);
        for (uint32_t k = p->block_first[b]; k < p->block_first[b + 1]; k++) {
            const uint32_t t = p->block_texels[k];
            sums[0] += (double)alpi_texels_area(p->texels, t) *
                       sum_of(r->direct[back * p->texels->count + t].mean);
        }
    }
}

/// Sums |Eₖ − Eₖ₋₁| and Eₖ over the receivers, by area.
static void sum_changes(const void *user, uint32_t begin, uint32_t end, double sums[ALPI_SUM_LIMIT])
{
    const alpi_radiosity *r = user;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t receiver = r->receivers[i];
        size_t back;
        const double area = r->patches.block_areas[block_of(&r->patches, receiver, &back)];
        for (int k = 0; k < 3; k++) {
            const double change =
                (double)r->bounced[receiver].mean[k] - (double)r->before[receiver][k];
            sums[0] += area * fabs(change);
        }
        sums[1] += area * sum_of(r->bounced[receiver].mean);
    }
}

static alp_result pass(solver *s)
{
    alpi_radiosity *r = s->r;
    double sums[ALPI_SUM_LIMIT] = {0.0};
    keep_means(r, r->bounced, r->before);
    ALP_TRY(alpi_radiosity_show(r, ALPI_NONE, NULL, &s->progress));
    ALP_TRY(gather_pass(s, r->bounced));
    ALP_TRY(alpi_parallel_sum(r->options.context, r->receiver_count, sum_changes, r, &s->progress,
                              sums));
    const double light = s->first_light + sums[1];
    s->former = s->change;
    s->change = light > 0.0 ? sums[0] / light : 0.0;
    if (r->passes < ALPI_RADIOSITY_CHANGES) {
        r->changes[r->passes] = (float)s->change;
    }
    r->passes++;
    return ALP_OK;
}

/// What all later passes would add, over all light, if each adds in proportion to the one before as
/// the last two did. Mixed passes are in no proportion: there every pass is taken to add .95 of the
/// one before, as in a closed room of the lightest material.
static double left_over(const solver *s)
{
    static const double MIXED_RATIO = 0.95;
    if (s->r->passes > 0 && s->change <= LEAST_CHANGE) {
        return 0.0;
    }
    if (s->r->passes < 2) {
        return HUGE_VAL;
    }
    const double last = s->former > 0.0 ? fmin(s->change / s->former, 0.999) : 0.999;
    const double ratio = s->mixes ? MIXED_RATIO : last;
    return s->change * ratio / (1.0 - ratio);
}

/// Whether the rays of the next pass would go beyond the limit. A few passes are always traced.
static bool is_spent(const solver *s, uint64_t rays_before)
{
    enum { FEWEST_PASSES = 6 };
    const alpi_radiosity *r = s->r;
    const double each = (double)(r->rays - rays_before);
    return r->options.ray_limit > 0.0 && r->passes >= FEWEST_PASSES &&
           (double)r->rays + each > r->options.ray_limit;
}

/// Until what is left is no more than the tolerance, or all bounces that are asked for are in. A
/// number of bounces, and layers, which take as many passes each, want passes as they are.
static alp_result run_passes(solver *s)
{
    const alpi_radiosity_options *o = &s->r->options;
    const bool all = o->bounces >= ALPI_RADIOSITY_PASS_LIMIT;
    const uint32_t limit = all ? ALPI_RADIOSITY_PASS_LIMIT : o->bounces;
    double sums[ALPI_SUM_LIMIT] = {0.0};
    ALP_TRY(alpi_parallel_sum(o->context, s->r->receiver_count, sum_first_light, s->r, &s->progress,
                              sums));
    s->first_light = sums[0];
    const bool anew =
        !alpi_gather_meets_cells(&s->from); // by the scene, not by the memory there is
    s->mixes = all && anew && o->layers == NULL;
    if (s->mixes) {
        ALP_TRY(alpi_acceleration_create(
            o->context, sides_of(&s->r->patches) * s->r->patches.block_count, &s->acceleration));
    }
    uint64_t rays_before = s->r->rays;
    while (s->r->passes < limit && left_over(s) > o->tolerance) {
        if (anew && is_spent(s, rays_before)) {
            s->r->missing = left_over(s);
            break;
        }
        if (s->mixes && s->r->passes > 1) {
            ALP_TRY(alpi_acceleration_mix(&s->acceleration, s->r, &s->progress));
        }
        rays_before = s->r->rays;
        ALP_TRY(pass(s));
    }
    return ALP_OK;
}

/// The passes of the whole again for each layer, without the last, which is the texels' own. As
/// many for all: what is left out of the whole is left out of each.
static alp_result run_layers(solver *s)
{
    const alpi_radiosity *r = s->r;
    const alpi_light_layers *layers = r->options.layers;
    if (layers == NULL) {
        return ALP_OK;
    }
    ALPI_TRY_NEW(r->options.context, s->layer_bounced,
                 sides_of(&r->patches) * r->patches.block_count);
    for (uint32_t layer = 0; layer < layers->count; layer++) {
        for (uint32_t passes = 1; passes < r->passes; passes++) {
            ALP_TRY(alpi_radiosity_show(r, layer, NULL, &s->progress));
            ALP_TRY(gather_pass(s, s->layer_bounced));
            keep_means(r, s->layer_bounced, layers->before[layer]);
        }
    }
    return alpi_radiosity_show(r, ALPI_NONE, NULL, &s->progress);
}

// --- all of it -----------------------------------------------------------------------------------

static alp_result allocate(solver *s)
{
    alpi_radiosity *r = s->r;
    const alpi_patches *p = &r->patches;
    alp_context *context = r->options.context;
    const size_t blocks = sides_of(p) * p->block_count;
    ALPI_TRY_NEW(context, r->direct, sides_of(p) * p->texels->count);
    if (r->options.directional) {
        ALPI_TRY_NEW(context, r->directional, p->texels->count);
    }
    ALPI_TRY_NEW(context, r->bounced, blocks);
    ALPI_TRY_NEW(context, r->before, blocks);
    ALPI_TRY_NEW(context, r->skies, blocks);
    ALPI_TRY_NEW(context, r->lost, blocks);
    ALPI_TRY_NEW(context, r->receivers, blocks);
    ALPI_TRY_NEW(context, s->new_receivers, blocks);
    return r->options.layers == NULL
               ? ALP_OK
               : alpi_light_layers_reserve(r->options.layers, sides_of(p) * p->texels->count,
                                           blocks, p->texels->count);
}

/// Direct light of backs has become what they reflect, and is not asked for again, but by layers.
static alp_result drop_backs(alpi_radiosity *r)
{
    const alpi_patches *p = &r->patches;
    if (p->two_sided && r->options.layers == NULL) {
        void *fronts =
            alpi_reallocate(r->options.context, r->direct, p->texels->count, sizeof *r->direct);
        if (fronts == NULL) {
            return ALP_ERROR_OUT_OF_MEMORY;
        }
        r->direct = fronts;
        r->backs_dropped = true;
    }
    return ALP_OK;
}

static alp_result solve(solver *s, const uint32_t *order, uint32_t count)
{
    ALP_TRY(allocate(s));
    const double began = alpi_seconds();
    ALP_TRY(gather_direct(s, order, count, s->r->directional));
    s->r->direct_seconds = alpi_seconds() - began;
    s->from = alpi_radiosity_scene(s->r);
    s->blocks = alpi_patches_block_receivers(&s->r->patches);
    start_receivers(s);
    ALP_TRY(find_receivers(s));
    ALP_TRY(run_passes(s));
    ALP_TRY(alpi_radiosity_find_energy(s->r, &s->progress));
    return run_layers(s);
}

alp_result alpi_radiosity_solve(const alpi_radiosity_options *options, const alpi_lattice *lattice,
                                const alp_atlas *atlas, const uint32_t *order, uint32_t count,
                                const alpi_task_progress *progress, alpi_radiosity *radiosity)
{
    *radiosity = (alpi_radiosity){.options = *options};
    solver s = {.r = radiosity};
    s.progress = progress != NULL ? *progress : (alpi_task_progress){0};
    ALP_TRY(
        alpi_patches_create(lattice, atlas, order, count, &options->blocks, &radiosity->patches));
    alp_result result = solve(&s, order, count);
    alpi_kept_rays_destroy(&s.kept);
    alpi_acceleration_destroy(options->context, &s.acceleration);
    alpi_release(options->context, s.new_receivers);
    alpi_release(options->context, s.layer_bounced);
    result = result == ALP_OK ? drop_backs(radiosity) : result;
    if (result != ALP_OK) {
        alpi_radiosity_destroy(radiosity);
    }
    return result;
}

void alpi_radiosity_settle(alpi_radiosity *radiosity, bool shown_again)
{
    alp_context *context = radiosity->options.context;
    if (radiosity->options.layers != NULL) {
        return;
    }
    alpi_patches_settle(&radiosity->patches, shown_again);
    alpi_release(context, radiosity->bounced);
    alpi_release(context, radiosity->receivers);
    radiosity->bounced = NULL;
    radiosity->receivers = NULL;
    if (!shown_again) {
        alpi_release(context, radiosity->before);
        alpi_release(context, radiosity->skies);
        alpi_release(context, radiosity->lost);
        radiosity->before = radiosity->skies = NULL;
        radiosity->lost = NULL;
    }
}

void alpi_radiosity_destroy(alpi_radiosity *radiosity)
{
    alp_context *context = radiosity->options.context;
    if (context == NULL) {
        return;
    }
    alpi_patches_destroy(&radiosity->patches);
    alpi_release(context, radiosity->direct);
    alpi_release(context, radiosity->directional);
    alpi_release(context, radiosity->bounced);
    alpi_release(context, radiosity->before);
    alpi_release(context, radiosity->skies);
    alpi_release(context, radiosity->lost);
    alpi_release(context, radiosity->receivers);
    *radiosity = (alpi_radiosity){0};
}
