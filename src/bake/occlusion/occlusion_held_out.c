// SPDX-License-Identifier: MIT
#include "bake/occlusion/occlusion_held_out.h"

#include "bake/occlusion/occlusion_samples.h"
#include "base/memory.h"
#include "base/random.h"

// Random numbers of the two estimates, unlike the map's.
static const uint64_t SEEDS[2] = {0x70726f6265000001u, 0x70726f6265000002u};
enum { STREAM_CHOICE = 3 };

static void choose(const alpi_occlusion_task *task, alpi_occlusion_held_out *h)
{
    const double stride = (double)task->count / h->count;
    for (uint32_t i = 0; i < h->count; i++) {
        const uint32_t key = alpi_random_key(task->setup->options.seed, i, STREAM_CHOICE);
        const uint32_t at = (uint32_t)(stride * ((double)i + (double)alpi_unit_float(key)));
        h->texels[i] = task->order[at < task->count ? at : task->count - 1];
    }
}

static void list_by_chart(alpi_occlusion_held_out *h, alpi_chart_deal *deal)
{
    alpi_chart_deal_clear(deal);
    for (uint32_t i = 0; i < h->count; i++) {
        alpi_chart_deal_count(deal, h->texels[i]);
    }
    (void)alpi_chart_deal_start(deal);
    for (uint32_t i = 0; i < h->count; i++) {
        h->list[alpi_chart_deal_place(deal, h->texels[i])] = i;
    }
}

static alp_result create(const alpi_occlusion_task *task, alpi_occlusion_held_out *h)
{
    ALPI_TRY_NEW(h->context, h->texels, h->count);
    ALPI_TRY_NEW(h->context, h->list, h->count);
    for (int k = 0; k < 2; k++) {
        const uint64_t seed = task->setup->options.seed ^ SEEDS[k];
        ALP_TRY(alpi_occlusion_prepare_again(task->setup, seed, &h->setups[k]));
        ALP_TRY(alpi_occlusion_sums_create(h->context, h->count, false, &h->sums[k]));
    }
    return ALP_OK;
}

alp_result alpi_occlusion_held_out_create(const alpi_occlusion_task *task, uint32_t count,
                                          alpi_chart_deal *deal, alpi_occlusion_held_out *held_out)
{
    *held_out = (alpi_occlusion_held_out){.context = task->setup->context,
                                          .receivers = task->receivers,
                                          .count = count < task->count ? count : task->count};
    const alp_result result = create(task, held_out);
    if (result != ALP_OK) {
        alpi_occlusion_held_out_destroy(held_out);
        return result;
    }
    choose(task, held_out);
    list_by_chart(held_out, deal);
    return ALP_OK;
}

void alpi_occlusion_held_out_destroy(alpi_occlusion_held_out *held_out)
{
    if (held_out->context == NULL) {
        return;
    }
    for (int k = 0; k < 2; k++) {
        if (held_out->setups[k].context != NULL) {
            alpi_occlusion_release(&held_out->setups[k]);
        }
        alpi_occlusion_sums_destroy(held_out->context, &held_out->sums[k]);
    }
    alpi_release(held_out->context, held_out->texels);
    alpi_release(held_out->context, held_out->list);
    *held_out = (alpi_occlusion_held_out){0};
}

static void place(const void *user, uint32_t receiver, uint32_t count, const float (*square)[2],
                  alpi_receiver_point *points)
{
    const alpi_occlusion_held_out *h = user;
    h->receivers->place(h->receivers->user, h->texels[receiver], count, square, points);
}

alp_result alpi_occlusion_held_out_trace(alpi_occlusion_held_out *held_out, uint32_t before,
                                         uint32_t samples, const alpi_task_progress *progress)
{
    alpi_occlusion_held_out *h = held_out;
    const alpi_receivers receivers = {
        .count = h->count, .extended = h->receivers->extended, .place = place, .user = h};
    for (int k = 0; k < 2; k++) {
        if (before > 0) {
            alpi_occlusion_extend_quarters(&h->sums[k], h->list, h->count, before, samples);
        }
        ALP_TRY(alpi_occlusion_add(&h->setups[k], &receivers, h->list, h->count, before,
                                   samples - before, samples, progress, &h->sums[k]));
    }
    return ALP_OK;
}
