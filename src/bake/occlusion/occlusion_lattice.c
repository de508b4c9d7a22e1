// SPDX-License-Identifier: MIT
// Which texels of a round are traced, and which are interpolated between them (lattice.h).
#include "bake/occlusion/occlusion_lattice.h"

#include "bake/occlusion/occlusion_error.h"
#include "bake/occlusion/occlusion_samples.h"
#include "base/tiles/tiles.h"
#include "maps/texels/validity.h"

#include <math.h>
#include <string.h>

enum { FLOOD_ROUNDS = 4 };

// Limits of interpolation over the noise: the bend of a stencil, the difference between its texels,
// and the kink at a texel beside a traced one. Chosen on cornell, teapot-room and torus-plane.
// Twice the bend traces a tenth fewer texels, and interpolated ones get three times darker. Twice
// the others loses small shadows.
static const float BEND_LIMIT = 1.0f, SPREAD_LIMIT = 40.0f, KINK_LIMIT = 2.0f;
// Shares of them near another surface. They give the same error as tracing all of it there, in
// three quarters of the time on cornell.
static const float NEAR_SPREAD = 0.1f, NEAR_BEND = 0.5f;

// --- rules ---------------------------------------------------------------------------------------

static bool is_untraced(const alpi_occlusion_task *task, uint32_t texel)
{
    return task->lattice->states[texel] != ALPI_TEXEL_TRACED;
}

/// Untraced texels that touch another surface, and every second of every second row near one: a
/// contact shadow may be smaller than the lattice.
/// Ward's criterion: light changes over the distance to the surfaces around. G. J. Ward,
/// F. M. Rubinstein, R. D. Clear. A Ray Tracing Solution for Diffuse Interreflection. SIGGRAPH
/// 1988.
static bool is_untraced_near(const alpi_occlusion_task *task, uint32_t texel)
{
    const uint8_t proximity = task->proximity != NULL ? task->proximity[texel] : ALPI_FAR;
    const bool coarse = alpi_lattice_is_coarse(task->lattice->texels->pixels[texel]);
    return is_untraced(task, texel) &&
           (proximity == ALPI_TOUCHING || (proximity == ALPI_NEAR && coarse));
}

// --- interpolation -------------------------------------------------------------------------------

static alpi_lattice_judge start_interpolation(const alpi_occlusion_state *state)
{
    return (alpi_lattice_judge){.lattice = state->task->lattice,
                                .order = state->task->order,
                                .proximity = state->task->proximity,
                                .marked = state->marked,
                                .near_spread = NEAR_SPREAD,
                                .near_bend = NEAR_BEND};
}

static alp_result interpolate_range(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    alpi_lattice_judge_range(user, begin, end);
    return ALP_OK;
}

/// Interpolates texels of a level that are smooth, and marks the others.
static alp_result interpolate(alpi_occlusion_state *state, alpi_lattice_judge *judge,
                              uint32_t level)
{
    judge->level = level;
    return alpi_occlusion_for_texels(&state->clock, interpolate_range, judge);
}

static void update(void *user, uint32_t texel, const alpi_stencil *stencil)
{
    const alpi_lattice *lattice = user;
    lattice->values[texel] = alpi_lattice_interpolate(lattice, stencil);
}

/// Interpolates again, as texels of some stencils were traced since.
static alp_result update_interpolated(alpi_occlusion_state *state)
{
    const alpi_occlusion_task *task = state->task;
    const alpi_task_progress progress = alpi_occlusion_progress_of_texels(&state->clock);
    return alpi_lattice_for_stencils(task->lattice, task->order, task->count, update, task->lattice,
                                     &progress);
}

/// Limits of a level that interpolates over `spacing` texels: by the noise, or Elias'
/// accuracy^spacing for values in [0, 1], which limits differences alone.
static void set_limits(alpi_lattice_judge *judge, float accuracy, float noise, float spacing)
{
    const bool automatic = accuracy < 0.0f;
    judge->spread = automatic ? SPREAD_LIMIT * noise : 1.0f - powf(accuracy, spacing);
    judge->bend = automatic ? BEND_LIMIT * noise : HUGE_VALF;
    judge->kink = automatic ? KINK_LIMIT * noise : 0.5f * (1.0f - accuracy);
}

/// Follows small details from traced texels: traces interpolated ones with a kink beside them.
static alp_result trace_kinks(alpi_occlusion_state *state, alpi_lattice_judge *judge)
{
    uint32_t count = 1, traced = 0;
    judge->flood = true;
    for (int round = 0; round < FLOOD_ROUNDS && count > 0; round++) {
        ALP_TRY(interpolate(state, judge, 0));
        ALP_TRY(alpi_occlusion_trace_marked(state, &count));
        traced += count;
    }
    return traced > 0 ? update_interpolated(state) : ALP_OK;
}

alp_result alpi_occlusion_trace_lattice(alpi_occlusion_state *state)
{
    alpi_lattice_judge judge = start_interpolation(state);
    uint32_t count = 0;
    float noise = 0.0f;
    ALP_TRY(alpi_occlusion_mark(state, is_untraced_near));
    ALP_TRY(interpolate(state, &judge, 0)); // marks all of level 0: it has no stencils
    ALP_TRY(alpi_occlusion_trace_marked(state, &count));
    ALP_TRY(alpi_occlusion_measure_noise(state, &noise, &count));
    for (uint32_t level = 1; level < ALPI_LATTICE_LEVELS; level++) {
        set_limits(&judge, state->task->accuracy, noise, 2.0f * (float)alpi_lattice_reach(level));
        ALP_TRY(interpolate(state, &judge, level));
        ALP_TRY(alpi_occlusion_trace_marked(state, &count));
    }
    return trace_kinks(state, &judge);
}

alp_result alpi_occlusion_trace_all(alpi_occlusion_state *state)
{
    uint32_t count = 0;
    alp_context *context = state->task->setup->context;
    ALP_TRY(alpi_occlusion_mark(state, is_untraced));
    (void)alpi_tiles_set_kind(context, ALPI_TILES_SPLIT);
    const alp_result result = alpi_occlusion_trace_marked(state, &count);
    (void)alpi_tiles_set_kind(context, ALPI_TILES_WHOLE);
    return result;
}

alp_result alpi_occlusion_fill_gaps(alpi_occlusion_state *state)
{
    alpi_lattice_judge judge = start_interpolation(state);
    judge.spread = judge.bend = HUGE_VALF;
    memset(state->marked, 0, judge.lattice->texels->count);
    for (uint32_t level = 1; level < ALPI_LATTICE_LEVELS; level++) {
        ALP_TRY(interpolate(state, &judge, level));
    }
    return ALP_OK;
}
