// SPDX-License-Identifier: MIT
// Ambient occlusion by rays: accessibility A = 1 − E[w(t)] over directions in a cone about the
// shading normal, t = distance of the hit over the distance limit. Based on: Zhukov, Iones, Kronin.
// An Ambient Light Illumination Model. EGWR 1998;
//           I. R. Hafthorsson. Ambient Occlusion Using Ray-tracing and Texture Blending. DTU 2007.
#include "transport/occlusion/occlusion.h"

#include "base/memory.h"
#include "base/random.h"
#include "transport/occlusion/falloff.h"
#include "transport/occlusion/occlusion_kernel.h"

#include <math.h>
#include <string.h>

enum { SAMPLE_LIMIT = 1 << 20, STREAM_SEQUENCE = 2 };

alp_occlusion_options alp_occlusion_options_default(void)
{
    return (alp_occlusion_options){.struct_size = sizeof(alp_occlusion_options),
                                   .samples = 512,
                                   .falloff = ALP_FALLOFF_SMOOTH,
                                   .cone = (float)(ALPI_PI / 2.0)};
}

float alp_occlusion_distance(const alp_scene *scene, const alp_occlusion_options *options)
{
    if (scene == NULL || options == NULL || options->distance != 0.0f) {
        return options ? options->distance : 0.0f;
    }
    return ALPI_OCCLUSION_AUTO_SHARE * vec3_length(vec3_sub(scene->bounds_max, scene->bounds_min));
}

alp_result alpi_occlusion_check(const alp_scene *scene, const alp_occlusion_options *o)
{
    alp_context *context = scene->context;
    const alp_result code = ALP_ERROR_INVALID_ARGUMENT;
    if (o->struct_size != sizeof *o) {
        return alpi_fail(context, code, "occlusion options are not from _default()");
    }
    if (o->samples < 1 || o->samples > SAMPLE_LIMIT) {
        return alpi_fail(context, code, "occlusion: %u samples, need 1 to %d", o->samples,
                         SAMPLE_LIMIT);
    }
    if (!(o->distance >= 0.0f)) {
        return alpi_fail(context, code, "occlusion: distance %g m, need > 0, or 0 for automatic",
                         (double)o->distance);
    }
    if (!(o->cone > 0.0f) || o->cone > (float)(ALPI_PI / 2.0) * 1.000001f) {
        return alpi_fail(context, code, "occlusion: cone half-angle %g rad, need (0, pi/2]",
                         (double)o->cone);
    }
    if (alpi_falloff_name(o->falloff) == NULL || (int)o->distribution < ALP_DISTRIBUTION_COSINE ||
        o->distribution > ALP_DISTRIBUTION_UNIFORM) {
        return alpi_fail(context, code, "occlusion: unknown fall-off or distribution");
    }
    return ALP_OK;
}

// --- sample sequences ----------------------------------------------------------------------------

/// Third Sobol' dimension: primitive polynomial x² + x + 1, m = 1, 3.
/// S. Joe, F. Y. Kuo: Constructing Sobol Sequences with Better Two-Dimensional Projections. 2008.
static void sobol_2_directions(uint32_t v[32])
{
    v[0] = 1u << 31;
    v[1] = 3u << 30;
    for (int j = 2; j < 32; j++) {
        v[j] = v[j - 1] ^ v[j - 2] ^ (v[j - 2] >> 2);
    }
}

static uint32_t sobol_2(const uint32_t v[32], uint32_t index)
{
    uint32_t x = 0;
    for (; index != 0; index &= index - 1) {
        x ^= v[__builtin_ctz(index)];
    }
    return x;
}

/// Owen-scrambled Sobol' in three dimensions.
static void fill_samples(uint64_t seed, uint32_t count, uint32_t (*samples)[3])
{
    const uint32_t key = alpi_random_key(seed, 0, STREAM_SEQUENCE);
    const uint32_t keys[3] = {alpi_hash32(key ^ 0x02e5be93u), alpi_hash32(key ^ 0x967a889bu),
                              alpi_hash32(key ^ 0x368cc8b7u)};
    uint32_t directions[32];
    sobol_2_directions(directions);
    for (uint32_t s = 0; s < count; s++) {
        samples[s][0] = alpi_reverse_bits(alpi_owen_hash(s, keys[0]));
        samples[s][1] = alpi_reverse_bits(alpi_owen_hash(alpi_sobol_1_reversed(s), keys[1]));
        samples[s][2] = alpi_owen_scramble(sobol_2(directions, s), keys[2]);
    }
}

/// Places in a receiver, block by block of the sequence: Sobol' in two dimensions with its index
/// shuffled (Owen), or they would depend on the directions of their block.
static void fill_places(uint64_t seed, uint32_t count, uint32_t (*places)[2])
{
    const uint32_t key = alpi_random_key(seed, 1, STREAM_SEQUENCE);
    const uint32_t keys[3] = {alpi_hash32(key ^ 0x02e5be93u), alpi_hash32(key ^ 0x967a889bu),
                              alpi_hash32(key ^ 0x68bc21ebu)};
    for (uint32_t s = 0; s < count; s++) {
        const uint32_t index = alpi_owen_scramble(s, keys[2]);
        places[s][0] = alpi_reverse_bits(alpi_owen_hash(index, keys[0]));
        places[s][1] = alpi_reverse_bits(alpi_owen_hash(alpi_sobol_1_reversed(index), keys[1]));
    }
}

/// The sequences of a setup of so many samples.
static alp_result make_sequences(alpi_occlusion_setup *setup)
{
    // Samples that begin within a block are of one more point, and a group of points is of eight,
    // whether its lanes need them all or not.
    const uint32_t places = setup->samples / ALPI_SAMPLES_PER_POINT + 2 + ALPI_PACKET;
    setup->sequence = alpi_allocate(setup->context, setup->samples, sizeof *setup->sequence);
    setup->places = alpi_allocate(setup->context, places, sizeof *setup->places);
    if (setup->sequence == NULL || setup->places == NULL) {
        alpi_occlusion_release(setup);
        return ALP_ERROR_OUT_OF_MEMORY;
    }
    fill_samples(setup->options.seed, setup->samples, setup->sequence);
    fill_places(setup->options.seed, places, setup->places);
    return ALP_OK;
}

alp_result alpi_occlusion_prepare(const alp_scene *scene, const alpi_tracer *tracer,
                                  const alp_occlusion_options *options, alpi_occlusion_setup *setup)
{
    const bool hemisphere = options->cone >= (float)(ALPI_PI / 2.0) * 0.999999f;
    *setup = (alpi_occlusion_setup){
        .context = scene->context,
        .scene = scene,
        .tracer = tracer,
        .kernel = ALPI_COMPILED_FOR(scene->context, alpi_occlusion_kernel),
        .options = *options,
        .distance = alp_occlusion_distance(scene, options),
        .cone_sin = hemisphere ? 1.0f : sinf(options->cone),
        .cone_cos = hemisphere ? 0.0f : cosf(options->cone),
        .filter = {.one_sided = options->one_sided},
        .samples = (options->samples + ALPI_QUARTERS - 1) / ALPI_QUARTERS * ALPI_QUARTERS,
    };
    alpi_occlusion_be_quick(setup, false);
    setup->falloff = isinf(setup->distance) ? ALP_FALLOFF_NONE : options->falloff;
    return make_sequences(setup);
}

void alpi_occlusion_be_quick(alpi_occlusion_setup *setup, bool quick)
{
    setup->filter.quick = quick;
    setup->spread = alpi_tracer_random_spread(setup->tracer, setup->filter);
}

alp_result alpi_occlusion_prepare_again(const alpi_occlusion_setup *setup, uint64_t seed,
                                        alpi_occlusion_setup *other)
{
    *other = *setup;
    other->options.seed = seed;
    return make_sequences(other);
}

void alpi_occlusion_release(alpi_occlusion_setup *setup)
{
    alpi_release(setup->context, setup->sequence);
    alpi_release(setup->context, setup->places);
    setup->sequence = NULL;
    setup->places = NULL;
}
