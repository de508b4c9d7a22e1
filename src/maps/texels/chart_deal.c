// SPDX-License-Identifier: MIT
// A counting sort by chart.
#include "maps/texels/chart_deal.h"

#include "base/memory.h"

#include <string.h>

alp_result alpi_chart_deal_open(alp_context *context, const uint32_t *charts,
                                const uint32_t *texels, uint32_t texel_count, alpi_chart_deal *deal)
{
    uint32_t first = UINT32_MAX, last = 0;
    for (uint32_t i = 0; i < texel_count; i++) {
        const uint32_t chart = charts[texels[i]];
        first = chart < first ? chart : first;
        last = chart > last ? chart : last;
    }
    *deal = (alpi_chart_deal){.context = context,
                              .charts = charts,
                              .first = first,
                              .count = texel_count > 0 ? last - first + 1 : 0};
    deal->places = ALPI_NEW(context, uint32_t, deal->count);
    return deal->places != NULL ? ALP_OK : ALP_ERROR_OUT_OF_MEMORY;
}

void alpi_chart_deal_close(alpi_chart_deal *deal)
{
    if (deal->context != NULL) {
        alpi_release(deal->context, deal->places);
    }
    *deal = (alpi_chart_deal){0};
}

void alpi_chart_deal_clear(alpi_chart_deal *deal)
{
    memset(deal->places, 0, deal->count * sizeof *deal->places);
}

uint32_t alpi_chart_deal_start(alpi_chart_deal *deal)
{
    uint32_t sum = 0;
    for (uint32_t c = 0; c < deal->count; c++) {
        const uint32_t texels = deal->places[c];
        deal->places[c] = sum;
        sum += texels;
    }
    return sum;
}
