// SPDX-License-Identifier: MIT
// Adds samples of direct light to the texels that need them.
//
// A texel's variance v, measured with h samples, becomes v (h / t)^2p with t of them; the error
// falls with the power p of the samples. The fewest samples that bring the sum of all variances to
// a wanted one are t ∝ s^(1 / (2p + 1)), s = v h^2p. Noisy texels get more, but less than in
// proportion. On a house under a hall's lamps these are 1.7 times fewer samples than equal numbers
// for all noisy texels.
#include "bake/light/light_samples.h"

#include "bake/light/light_layers.h"
#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "transport/direct/direct.h"

#include <math.h>

/// A texel is noisy above this share of the wanted mean squared error.
static const double NOISY = 0.25;
enum {
    TEXELS_PER_RANGE = 1 << 10,
    SAMPLE_TEXELS = 1 << 11,        // enough to find the scale
    LEAST = ALPI_DIRECT_REPLICATES, // samples of class 0
    CLASSES = 13,                   // each has twice the samples of the one before
    MOST_TIMES = 16                 // samples over those before: the variance is a guess
};

// --- all texels alike ----------------------------------------------------------------------------

alp_result alpi_light_sample_all(alpi_light_bake *light)
{
    alpi_bake_job *job = light->job;
    const alp_bake_options *o = &job->options;
    const uint32_t texels = light->receivers->count;
    const alpi_direct_options options = {
        .context = job->context,
        .scene = job->scene,
        .tracer = light->tracer,
        .lighting = light->lighting,
        .filter = {.one_sided = o->occlusion.one_sided},
        .samples = o->light.samples,
        .seed = o->occlusion.seed,
    };
    ALPI_TRY_NEW(job->context, light->values, texels);
    alpi_direct *direct = NULL;
    alpi_direct_output output = {.values = light->values, .directional = light->directional};
    alpi_layer_arrays *layers = alpi_light_start_layers(job, false);
    if (layers != NULL) {
        ALP_TRY(alpi_layer_arrays_reserve(layers, texels, 0, texels));
        output.groups = layers->direct;
        output.part_groups = layers->part_layers;
    }
    ALP_TRY(alpi_direct_create(&options, &direct));
    const alp_result result = alpi_direct_irradiance(direct, light->receivers, light->order,
                                                     light->count, &light->progress, &output);
    alpi_light_sum_layers(light, NULL, true);
    job->report.light_samples = alpi_direct_samples(direct);
    job->report.rays += output.rays;
    alpi_direct_destroy(direct);
    return result;
}

void alpi_light_merge(alpi_reference_value *v, const alpi_reference_value *fresh, double had,
                      double more)
{
    const float a = (float)(had / (had + more)), b = (float)(more / (had + more));
    for (int k = 0; k < 3; k++) {
        v->mean[k] = a * v->mean[k] + b * fresh->mean[k];
        v->variance[k] = a * a * v->variance[k] + b * b * fresh->variance[k];
    }
}

double alpi_light_power(double power, double predicted, double measured)
{
    const double least = 0.5, most = 0.75;
    const bool shown = predicted > 0.0 && predicted < 0.9 && measured > 0.0;
    return shown ? fmin(fmax(power * log(measured) / log(predicted), least), most) : power;
}

// --- which texels --------------------------------------------------------------------------------

/// The texels that get more samples, during one call.
typedef struct share_job {
    alpi_light_rounds *rounds;
    const alpi_light_goal *goal;
    uint8_t *marks; // [texels] whether it is noisy, or beside a noisy one; then its class
    uint32_t *list; // [count] those that may get samples
    uint32_t *some; // [count] those of one class
    uint32_t count;
    double scale; // log2 of t / s^(1 / (2p + 1))
} share_job;

static double mean_variance(const alpi_reference_value *v)
{
    return ((double)v->variance[0] + (double)v->variance[1] + (double)v->variance[2]) / 3.0;
}

static double noise_of(const alpi_reference_value *v)
{
    return (double)fmaxf(v->variance[0], fmaxf(v->variance[1], v->variance[2]));
}

double alpi_light_noisy_share(const alpi_light_rounds *r, double wanted)
{
    uint32_t noisy = 0;
    for (uint32_t i = 0; i < r->light->count; i++) {
        noisy += noise_of(&r->solution->direct[r->light->order[i]]) > NOISY * wanted * wanted;
    }
    return noisy / fmax(r->light->count, 1.0);
}

double alpi_light_typical(const alpi_reference_value *values, const uint32_t *counts,
                          const uint32_t *list, uint32_t count, double otherwise)
{
    double sum = 0.0, weighed = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const double v = mean_variance(&values[list[i]]);
        sum += v;
        weighed += v * counts[list[i]];
    }
    return sum > 0.0 ? weighed / sum : otherwise;
}

double alpi_light_typical_samples(const alpi_light_rounds *r)
{
    return alpi_light_typical(r->solution->direct, r->direct.counts, r->light->order,
                              r->light->count, r->direct.most);
}

/// Lists the noisy texels and their neighbours. The few samples of one texel may miss a shadow's
/// edge that those of a neighbour found.
static void list_noisy(share_job *job)
{
    enum { NOISY_ITSELF = 1, BESIDE_NOISY = 2 };
    const alpi_light_bake *t = job->rounds->light;
    const double wanted = job->goal->wanted;
    const uint8_t *among = job->goal->among;
    for (uint32_t i = 0; i < t->count; i++) {
        const uint32_t texel = t->order[i];
        const bool noisy =
            noise_of(&job->rounds->solution->direct[texel]) > NOISY * wanted * wanted;
        job->marks[texel] = noisy && (among == NULL || among[texel] != 0) ? NOISY_ITSELF : 0;
    }
    for (uint32_t i = 0; i < t->count; i++) {
        uint32_t around[ALPI_AROUND_LIMIT];
        const bool noisy = (job->marks[t->order[i]] & NOISY_ITSELF) != 0;
        const uint32_t count = noisy ? alpi_lattice_around(t->lattice, t->order[i], around) : 0;
        for (uint32_t k = 0; k < count; k++) {
            job->marks[around[k]] |= BESIDE_NOISY;
        }
    }
    for (uint32_t i = 0; i < t->count; i++) {
        if (job->marks[t->order[i]] != 0) {
            job->list[job->count++] = t->order[i];
        }
    }
}

// --- how many ------------------------------------------------------------------------------------

/// How many samples a texel needs.
typedef struct texel_need {
    double variance; // mean of the channels
    double had;      // samples
    double rate;     // log2 of s^(1 / (2p + 1))
} texel_need;

/// The variance of one texel is a guess: this is the mean of its neighbours', scaled to as many
/// samples.
static texel_need find_need(const share_job *job, uint32_t texel)
{
    const alpi_light_direct *d = &job->rounds->direct;
    const alpi_reference_value *values = job->rounds->solution->direct;
    uint32_t around[ALPI_AROUND_LIMIT];
    const uint32_t count = alpi_lattice_around(job->rounds->light->lattice, texel, around);
    const double had = d->counts[texel];
    double sum = 0.0, known = 0.0;
    for (uint32_t k = 0; k < count; k++) {
        const double v = mean_variance(&values[around[k]]), by = d->counts[around[k]];
        if (by > 0.0) {
            sum += by == had ? v : v * pow(by / had, 2.0 * d->power);
            known += 1.0;
        }
    }
    texel_need n = {.variance = sum / fmax(known, 1.0), .had = had};
    if (job->goal->each) { // t brings this texel to the wanted error
        n.variance = fmax(n.variance, mean_variance(&values[texel]));
        n.rate = log2(n.had) + (0.5 * log2(n.variance) - log2(job->goal->wanted)) / d->power;
    } else {
        n.rate = (log2(n.variance) + 2.0 * d->power * log2(n.had)) / (2.0 * d->power + 1.0);
    }
    return n;
}

/// Class of the samples that a texel gets; −1: none.
static int class_of(const share_job *job, const texel_need *n)
{
    const double more = exp2(job->scale + n->rate) - n->had;
    const double most = fmin(MOST_TIMES * n->had, job->rounds->light->settings.most_rays - n->had);
    if (!(more >= (job->goal->each ? 0.0 : 0.5 * LEAST)) || most < LEAST) {
        return -1;
    }
    const double k = fmin(floor(log2(more / LEAST) + 0.5), floor(log2(most / LEAST)));
    return (int)fmin(fmax(k, 0.0), CLASSES - 1);
}

static uint32_t samples_of(int k)
{
    return k < 0 ? 0 : (uint32_t)LEAST << k;
}

/// The needs of some listed texels. Each stands for as many others.
typedef struct need_sample {
    texel_need needs[SAMPLE_TEXELS];
    uint32_t count;
    double stands_for; // listed texels
    double low, high;  // scales with which no texel gets any, and all get the most
} need_sample;

static void sample_needs(const share_job *job, need_sample *sample)
{
    const uint32_t step = job->count / SAMPLE_TEXELS + 1, few = (job->count + step - 1) / step;
    *sample = (need_sample){.low = HUGE_VAL, .high = -HUGE_VAL};
    for (uint32_t i = 0; i < job->count; i += step) {
        const texel_need n = find_need(job, job->list[i]);
        if (n.variance > 0.0 && isfinite(n.variance)) {
            sample->low = fmin(sample->low, log2(n.had) - n.rate);
            sample->high = fmax(sample->high, log2(n.had * (1.0 + MOST_TIMES)) - n.rate);
            sample->needs[sample->count++] = n;
        }
    }
    sample->stands_for = job->count / fmax(few, 1.0);
}

/// Predicts the variance of the listed texels with the scale, as a sum over the number of all
/// texels.
/// @param samples out: of all texels
static double predict(const share_job *job, const need_sample *sample, double *samples)
{
    double sum = 0.0;
    *samples = 0.0;
    for (uint32_t i = 0; i < sample->count; i++) {
        const double had = sample->needs[i].had,
                     more = samples_of(class_of(job, &sample->needs[i]));
        const double left =
            more > 0.0 ? pow(had / (had + more), 2.0 * job->rounds->direct.power) : 1.0;
        sum += sample->needs[i].variance * left;
        *samples += sample->stands_for * more;
    }
    return sum * sample->stands_for / fmax(job->rounds->light->count, 1.0);
}

/// Mean over all texels of the variance of those that are not listed.
static double mean_of_others(const share_job *job)
{
    const alpi_light_bake *t = job->rounds->light;
    double sum = 0.0;
    for (uint32_t i = 0; i < t->count; i++) {
        sum += mean_variance(&job->rounds->solution->direct[t->order[i]]);
    }
    for (uint32_t i = 0; i < job->count; i++) {
        sum -= mean_variance(&job->rounds->solution->direct[job->list[i]]);
    }
    return fmax(sum, 0.0) / fmax(t->count, 1.0);
}

/// Finds the least scale that reaches a little less than the wanted error, within a number of
/// samples.
static void find_scale(share_job *job)
{
    enum { STEPS = 12 };                // bisections
    static const double FURTHER = 0.88; // of the squared error
    const alpi_light_goal *goal = job->goal;
    const double others = mean_of_others(job);
    need_sample sample;
    sample_needs(job, &sample);
    double low = sample.low, samples;
    double high = goal->each ? 0.0 : sample.high; // each: by its own rate, or less
    for (int i = 0; i < STEPS && sample.count > 0; i++) {
        job->scale = 0.5 * (low + high);
        const double squared = predict(job, &sample, &samples) + others;
        const bool good = !goal->each && squared <= FURTHER * goal->wanted * goal->wanted;
        if (good || samples > goal->most) {
            high = job->scale;
        } else {
            low = job->scale;
        }
    }
    job->scale = high;
    job->rounds->direct.predicted = sqrt(predict(job, &sample, &samples) + others);
}

// --- sampling ------------------------------------------------------------------------------------

/// Samples the texels of one class.
static alp_result sample_class(const share_job *job, uint32_t count, uint32_t more)
{
    alpi_light_rounds *r = job->rounds;
    alpi_light_direct *d = &r->direct;
    const alpi_radiosity *solution = r->solution;
    const uint64_t seed = alpi_hash64(alpi_hash64(job->goal->seed) + more);
    alpi_direct_output output = {.values = r->fresh.values, .directional = r->fresh.directional};
    alpi_light_scale_layers(r, job->some, count, more, false);
    ALP_TRY(alpi_radiosity_direct(solution, job->some, count, more, seed, &r->light->progress,
                                  &output));
    alpi_light_scale_layers(r, job->some, count, more, true);
    r->light->job->report.rays += output.rays;
    d->drawn += (double)count * more;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t t = job->some[i];
        const double had = d->counts[t], all = had + more;
        alpi_light_merge(&solution->direct[t], &r->fresh.values[t], had, more);
        if (solution->directional != NULL) {
            alpi_directional_mix(&solution->directional[t], (float)(had / all),
                                 &r->fresh.directional[t], (float)(more / all));
        }
        d->counts[t] += more;
        d->most = d->counts[t] > d->most ? d->counts[t] : d->most;
    }
    return ALP_OK;
}

static alp_result find_classes(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    enum { NONE = CLASSES };
    const share_job *job = user;
    (void)worker;
    for (uint32_t i = begin; i < end; i++) {
        const texel_need n = find_need(job, job->list[i]);
        const int k = n.variance > 0.0 ? class_of(job, &n) : -1;
        job->marks[job->list[i]] = (uint8_t)(k < 0 ? NONE : k);
    }
    return ALP_OK;
}

/// Samples of the texels of each class.
static double count_samples(const share_job *job, double samples[CLASSES])
{
    double sum = 0.0;
    for (int k = 0; k < CLASSES; k++) {
        samples[k] = 0.0;
    }
    for (uint32_t i = 0; i < job->count; i++) {
        const uint8_t k = job->marks[job->list[i]];
        if (k < CLASSES) {
            samples[k] += samples_of(k);
            sum += samples_of(k);
        }
    }
    return sum;
}

static alp_result sample_classes(share_job *job, bool *added)
{
    const double began = alpi_seconds();
    ALP_TRY(alpi_parallel_for(job->rounds->light->job->context, job->count, TEXELS_PER_RANGE,
                              find_classes, job, NULL));
    double of_class[CLASSES];
    const double samples = count_samples(job, of_class);
    double left = samples;
    for (int k = 0; k < CLASSES; k++) {
        uint32_t count = 0;
        for (uint32_t i = 0; i < job->count; i++) {
            job->some[count] = job->list[i];
            count += job->marks[job->list[i]] == k;
        }
        if (count > 0) {
            alpi_light_clock_loop(job->rounds->light->clock, of_class[k] / left);
            ALP_TRY(sample_class(job, count, samples_of(k)));
            left -= of_class[k];
        }
    }
    *added = samples > 0.0;
    if (*added) {
        job->rounds->direct.seconds = (alpi_seconds() - began) / samples;
    }
    return ALP_OK;
}

static alp_result run(share_job *job, bool *added)
{
    alp_context *context = job->rounds->light->job->context;
    const uint32_t texels = job->rounds->light->receivers->count;
    ALPI_TRY_NEW(context, job->marks, texels);
    ALPI_TRY_NEW(context, job->list, texels);
    list_noisy(job);
    ALPI_TRY_NEW(context, job->some, job->count + 1);
    find_scale(job);
    return sample_classes(job, added);
}

alp_result alpi_light_add_samples(alpi_light_rounds *rounds, const alpi_light_goal *goal,
                                  bool *added)
{
    alp_context *context = rounds->light->job->context;
    share_job job = {.rounds = rounds, .goal = goal};
    const alp_result result = run(&job, added);
    alpi_release(context, job.marks);
    alpi_release(context, job.list);
    alpi_release(context, job.some);
    return result;
}
