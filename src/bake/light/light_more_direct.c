// SPDX-License-Identifier: MIT
// More samples of direct light for the texels that need them.
//
// A texel's variance v, known by h samples, becomes v (h / t)^2p by t of them, p the power that the
// error falls with. Of all ways to bring their sum down to what is wanted, the one with the fewest
// samples has t ∝ s^(1 / (2p + 1)) with s = v h^2p: the noisy ones get more, but not in proportion.
// On a house under a hall's lamps that is 1.7 times fewer than as many for each noisy texel.
#include "bake/layers.h"
#include "bake/light/light.h"
#include "bake/light/light_direct.h"

#include "base/memory.h"
#include "base/random.h"
#include "base/tasks.h"
#include "transport/direct/direct.h"

#include <math.h>

/// Texels get more that have, or are beside one that has, more than this share of the mean squared
/// error that is wanted.
static const double NOISY = 0.25;
/// Texels of which the scale is found: so many are as good as all.
enum { ASKED = 1 << 11 };
enum { TEXELS_PER_RANGE = 1 << 10 };
enum {
    LEAST = ALPI_DIRECT_REPLICATES, // samples: of class 0
    CLASSES = 13,                   // each has twice as many as the one before
    MOST_TIMES = 16                 // of what a texel has already: its variance is a guess
};

/// Texels that get more, and how many; of one call.
typedef struct direct_deal {
    alpi_light_direct *direct;
    const alpi_light_goal *goal;
    uint8_t *marks; // [texels] whether it is noisy, or beside one that is; then its class
    uint32_t *list; // [count] those that get any
    uint32_t *some; // [count] of one class
    uint32_t count;
    double scale; // log2 of t / s^(1 / (2p + 1))
} direct_deal;

// --- which ---------------------------------------------------------------------------------------

static double mean_variance(const alpi_reference_value *v)
{
    return ((double)v->variance[0] + (double)v->variance[1] + (double)v->variance[2]) / 3.0;
}

static double noise_of(const alpi_reference_value *v)
{
    return (double)fmaxf(v->variance[0], fmaxf(v->variance[1], v->variance[2]));
}

double alpi_light_noisy_share(const alpi_light_direct *d, double wanted)
{
    const alpi_light_task *t = d->task;
    uint32_t noisy = 0;
    for (uint32_t i = 0; i < t->count; i++) {
        noisy += noise_of(&d->values[t->order[i]]) > NOISY * wanted * wanted;
    }
    return noisy / fmax(t->count, 1.0);
}

double alpi_light_typical_samples(const alpi_light_direct *d)
{
    double sum = 0.0, weighed = 0.0;
    for (uint32_t i = 0; i < d->task->count; i++) {
        const uint32_t texel = d->task->order[i];
        const double v = mean_variance(&d->values[texel]);
        sum += v;
        weighed += v * d->counts[texel];
    }
    return sum > 0.0 ? weighed / sum : d->most;
}

/// Texels of the 3 × 3 around one, itself among them. @return how many
static int find_around(const alpi_lattice *l, uint32_t texel, uint32_t around[9])
{
    const uint16_t *p = l->texels->pixels[texel];
    int count = 0;
    for (int k = 0; k < 9; k++) {
        const uint32_t n = alpi_lattice_texel(l, l->texels->pages[texel], (int64_t)p[0] + k % 3 - 1,
                                              (int64_t)p[1] + k / 3 - 1);
        if (n != ALPI_NONE) {
            around[count++] = n;
        }
    }
    return count;
}

/// Lists the noisy texels and those beside them: a shadow's edge may hide from the few samples of a
/// texel, and not from all of its neighbours'.
static void list_noisy(direct_deal *deal)
{
    enum { NOISY_ITSELF = 1, BESIDE_NOISY = 2 };
    const alpi_light_task *t = deal->direct->task;
    const double wanted = deal->goal->wanted;
    const uint8_t *among = deal->goal->among;
    for (uint32_t i = 0; i < t->count; i++) {
        const uint32_t texel = t->order[i];
        const bool noisy = noise_of(&deal->direct->values[texel]) > NOISY * wanted * wanted;
        deal->marks[texel] = noisy && (among == NULL || among[texel] != 0) ? NOISY_ITSELF : 0;
    }
    for (uint32_t i = 0; i < t->count; i++) {
        uint32_t around[9];
        const bool noisy = (deal->marks[t->order[i]] & NOISY_ITSELF) != 0;
        const int count = noisy ? find_around(t->lattice, t->order[i], around) : 0;
        for (int k = 0; k < count; k++) {
            deal->marks[around[k]] |= BESIDE_NOISY;
        }
    }
    for (uint32_t i = 0; i < t->count; i++) {
        if (deal->marks[t->order[i]] != 0) {
            deal->list[deal->count++] = t->order[i];
        }
    }
}

// --- how many ------------------------------------------------------------------------------------

/// What tells how many samples a texel gets.
typedef struct texel_need {
    double variance; // mean of the channels, by the samples there are
    double had;      // samples
    double rate;     // log2 of s^(1 / (2p + 1))
} texel_need;

/// The variance that is known of a texel is a guess: it is taken to be like those around it, by as
/// many samples.
static texel_need find_need(const direct_deal *deal, uint32_t texel)
{
    const alpi_light_direct *d = deal->direct;
    uint32_t around[9];
    const int count = find_around(d->task->lattice, texel, around);
    const double had = d->counts[texel];
    double sum = 0.0, known = 0.0;
    for (int k = 0; k < count; k++) {
        const double v = mean_variance(&d->values[around[k]]), by = d->counts[around[k]];
        if (by > 0.0) {
            sum += by == had ? v : v * pow(by / had, 2.0 * d->power);
            known += 1.0;
        }
    }
    texel_need n = {.variance = sum / fmax(known, 1.0), .had = had};
    if (deal->goal->each) { // t as it would bring this texel there
        n.variance = fmax(n.variance, mean_variance(&d->values[texel]));
        n.rate = log2(n.had) + (0.5 * log2(n.variance) - log2(deal->goal->wanted)) / d->power;
    } else {
        n.rate = (log2(n.variance) + 2.0 * d->power * log2(n.had)) / (2.0 * d->power + 1.0);
    }
    return n;
}

/// Samples that a texel gets: a class of them, or −1.
static int class_of(const direct_deal *deal, const texel_need *n)
{
    const double more = exp2(deal->scale + n->rate) - n->had;
    const double most = fmin(MOST_TIMES * n->had, deal->direct->limit - n->had);
    if (!(more >= (deal->goal->each ? 0.0 : 0.5 * LEAST)) || most < LEAST) {
        return -1;
    }
    const double k = fmin(floor(log2(more / LEAST) + 0.5), floor(log2(most / LEAST)));
    return (int)fmin(fmax(k, 0.0), CLASSES - 1);
}

static uint32_t samples_of(int k)
{
    return k < 0 ? 0 : (uint32_t)LEAST << k;
}

/// Some of the listed texels, of which each stands for as many others.
typedef struct asked_needs {
    texel_need needs[ASKED];
    uint32_t count;
    double stands_for; // listed texels, of each
    double low, high;  // scales by which none of them gets any, and all get the most
} asked_needs;

static void ask_some(const direct_deal *deal, asked_needs *asked)
{
    const uint32_t step = deal->count / ASKED + 1, few = (deal->count + step - 1) / step;
    *asked = (asked_needs){.low = HUGE_VAL, .high = -HUGE_VAL};
    for (uint32_t i = 0; i < deal->count; i += step) {
        const texel_need n = find_need(deal, deal->list[i]);
        if (n.variance > 0.0 && isfinite(n.variance)) {
            asked->low = fmin(asked->low, log2(n.had) - n.rate);
            asked->high = fmax(asked->high, log2(n.had * (1.0 + MOST_TIMES)) - n.rate);
            asked->needs[asked->count++] = n;
        }
    }
    asked->stands_for = deal->count / fmax(few, 1.0);
}

/// What the scale leads to: the variance of the listed texels, over all there are.
/// @param samples out: of all together
static double foresee(const direct_deal *deal, const asked_needs *asked, double *samples)
{
    double sum = 0.0;
    *samples = 0.0;
    for (uint32_t i = 0; i < asked->count; i++) {
        const double had = asked->needs[i].had, more = samples_of(class_of(deal, &asked->needs[i]));
        const double left = more > 0.0 ? pow(had / (had + more), 2.0 * deal->direct->power) : 1.0;
        sum += asked->needs[i].variance * left;
        *samples += asked->stands_for * more;
    }
    return sum * asked->stands_for / fmax(deal->direct->task->count, 1.0);
}

/// Mean over all texels of the variance of those that are not listed.
static double mean_of_others(const direct_deal *deal)
{
    const alpi_light_task *t = deal->direct->task;
    double sum = 0.0;
    for (uint32_t i = 0; i < t->count; i++) {
        sum += mean_variance(&deal->direct->values[t->order[i]]);
    }
    for (uint32_t i = 0; i < deal->count; i++) {
        sum -= mean_variance(&deal->direct->values[deal->list[i]]);
    }
    return fmax(sum, 0.0) / fmax(t->count, 1.0);
}

/// The least scale that brings the error down to what is wanted, and a little further, as what is
/// foreseen is a guess; within a number of samples.
static void find_scale(direct_deal *deal)
{
    enum { STEPS = 12 };                // halves of some dozen octaves
    static const double FURTHER = 0.88; // of the squared error
    const alpi_light_goal *goal = deal->goal;
    const double others = mean_of_others(deal);
    asked_needs asked;
    ask_some(deal, &asked);
    double low = asked.low, samples;
    double high = goal->each ? 0.0 : asked.high; // of each: as its rate has it, or less
    for (int i = 0; i < STEPS && asked.count > 0; i++) {
        deal->scale = 0.5 * (low + high);
        const double squared = foresee(deal, &asked, &samples) + others;
        const bool good = !goal->each && squared <= FURTHER * goal->wanted * goal->wanted;
        if (good || samples > goal->most) {
            high = deal->scale;
        } else {
            low = deal->scale;
        }
    }
    deal->scale = high;
    deal->direct->foreseen = sqrt(foresee(deal, &asked, &samples) + others);
}

// --- gathering -----------------------------------------------------------------------------------

/// Direct light of layers is averaged in place: what comes is added to `had / more` times what
/// there is, and the sum, `merged`, made the mean.
static void scale_layers(const direct_deal *deal, uint32_t count, uint32_t more, bool merged)
{
    const alpi_layer_arrays *l = &deal->direct->job->layers.light;
    for (uint32_t layer = 0; layer < l->count; layer++) {
        for (uint32_t i = 0; i < count; i++) {
            const uint32_t t = deal->some[i];
            const double had = deal->direct->counts[t];
            const float factor = (float)(merged ? more / (had + more) : had / more);
            for (int k = 0; k < 3; k++) {
                l->direct[layer][t][k] *= factor;
            }
        }
    }
}

/// Gives the texels of one class their samples.
static alp_result gather(const direct_deal *deal, uint32_t count, uint32_t more)
{
    alpi_light_direct *d = deal->direct;
    const uint64_t seed = alpi_hash64(alpi_hash64(deal->goal->seed) + more);
    alpi_direct_output output = {.values = d->fresh, .directional = d->fresh_directional};
    scale_layers(deal, count, more, false);
    ALP_TRY(alpi_radiosity_direct(d->solution, deal->some, count, more, seed, &d->task->progress,
                                  &output));
    scale_layers(deal, count, more, true);
    d->job->report.rays += output.rays;
    d->drawn += (double)count * more;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t t = deal->some[i];
        const double had = d->counts[t];
        alpi_light_merge(&d->values[t], &d->fresh[t], had, more);
        if (d->solution->directional != NULL) {
            const double all = had + more;
            alpi_directional_mix(&d->solution->directional[t], (float)(had / all),
                                 &d->fresh_directional[t], (float)(more / all));
        }
        d->counts[t] += more;
        d->most = d->counts[t] > d->most ? d->counts[t] : d->most;
    }
    return ALP_OK;
}

static alp_result find_classes(void *user, uint32_t begin, uint32_t end, uint32_t worker)
{
    enum { NONE = CLASSES };
    const direct_deal *deal = user;
    (void)worker;
    for (uint32_t i = begin; i < end; i++) {
        const texel_need n = find_need(deal, deal->list[i]);
        const int k = n.variance > 0.0 ? class_of(deal, &n) : -1;
        deal->marks[deal->list[i]] = (uint8_t)(k < 0 ? NONE : k);
    }
    return ALP_OK;
}

static alp_result gather_classes(direct_deal *deal, bool *dealt)
{
    double samples = 0.0;
    const double began = alpi_seconds();
    ALP_TRY(alpi_parallel_for(deal->direct->job->context, deal->count, TEXELS_PER_RANGE,
                              find_classes, deal, NULL));
    for (int k = 0; k < CLASSES; k++) {
        uint32_t count = 0;
        for (uint32_t i = 0; i < deal->count; i++) {
            deal->some[count] = deal->list[i];
            count += deal->marks[deal->list[i]] == k;
        }
        if (count > 0) {
            ALP_TRY(gather(deal, count, samples_of(k)));
            samples += (double)count * samples_of(k);
        }
    }
    *dealt = samples > 0.0;
    if (*dealt) {
        deal->direct->seconds = (alpi_seconds() - began) / samples;
    }
    return ALP_OK;
}

static alp_result run(direct_deal *deal, bool *dealt)
{
    alp_context *context = deal->direct->job->context;
    const uint32_t texels = deal->direct->task->receivers->count;
    ALPI_TRY_NEW(context, deal->marks, texels);
    ALPI_TRY_NEW(context, deal->list, texels);
    list_noisy(deal);
    ALPI_TRY_NEW(context, deal->some, deal->count + 1);
    find_scale(deal);
    return gather_classes(deal, dealt);
}

alp_result alpi_light_more_direct(alpi_light_direct *direct, const alpi_light_goal *goal,
                                  bool *dealt)
{
    direct_deal deal = {.direct = direct, .goal = goal};
    const alp_result result = run(&deal, dealt);
    alpi_release(direct->job->context, deal.marks);
    alpi_release(direct->job->context, deal.list);
    alpi_release(direct->job->context, deal.some);
    return result;
}
